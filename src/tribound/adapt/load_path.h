#pragma once

/// @file load_path.h
/// Load steps one after the other on one mesh (method section 12): loads and other data follow a load factor
/// t, the contact boundary remembers.

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/adapt/bordered.h"
#include "tribound/adapt/level.h"
#include "tribound/adapt/path_measure.h"
#include "tribound/adapt/saved_path.h"
#include "tribound/base/clock.h"
#include "tribound/contact/nitsche/crack_tip.h"

namespace tribound::adapt
{

/// The problem at one t, discretised.
template <int dim>
struct DiscreteAtTime
{
  DiscreteAtTime(const problem::Problem<dim>& general, double load_factor,
                 std::shared_ptr<const Grid<dim>> grid, const Method& method,
                 std::shared_ptr<const contact::ContactHistory<dim>> history);

  double t;
  problem::Problem<dim> problem;
  Discretisation<dim> discrete;
};

/// A committed load step.
template <int dim>
struct LoadStep
{
  int number = 0;  ///< from 1
  double t = 0;
  int cuts = 0;                 ///< how often its size was halved
  std::string control{"load"};  ///< what was given: "load" is t; else Control::name
  /// What Newton's method at t began with, where this is not the displacement of the step before.
  std::vector<double> start{};
  int passes = 1;  ///< solutions until the crack did not grow any more
  /// By number of Problem::contacts(): with the largest distance of the steps so far.
  std::vector<contact::CrackTip> crack_tips;
  std::shared_ptr<const DiscreteAtTime<dim>> at;
  CertifiedLevel<dim> level;
  certify::Verdict verdict;
  double largest_sigma = 0;    ///< of ||sigma(u_h)|| over the path so far, which the verdict is relative to
  double reference_force = 0;  ///< NewtonOptions::reference_force that it was solved with
  /// At the contact points of the form: what the step has committed.
  std::vector<problem::InterfaceResponse<dim>> responses;
  /// a(u, phi_i) - (t + p_w n, phi_i)_C: loads, reactions and the pressure of water, by degree of freedom.
  std::vector<double> forces;
  double work = 0;     ///< of them since the step before, by the trapezoidal rule; energy
  double seconds = 0;  ///< wall time, attempts that failed included

  [[nodiscard]] std::shared_ptr<const Discretisation<dim>> discrete() const { return {at, &at->discrete}; }
};

/// a(u, phi_i) - contact_load_i: LoadStep::forces where contact_load_i = (t + p_w n, phi_i)_C.
template <int dim>
[[nodiscard]] std::vector<double> forces_on(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                            std::span<const double> contact_load);

/// What steps are allowed to do.
struct PathOptions
{
  int few_steps = 12;       ///< of Newton's method: the next step may be larger
  double growth = 1.4;      ///< by this factor, up to the distance to the next target
  double smallest = 1e-6;   ///< step, over the first one of its target
  double tolerance = 0.01;  ///< of the verdict
  int full_steps = 20;      ///< Method::full_steps
  /// Whether steps have a bound; else the problem is known to be well posed, and what only a whole mesh tells
  /// of it is not asked.
  bool certifies = true;
};

/// Where a path is between two values of t that are given.
struct LoadProgress
{
  double whole = 0;  ///< from where it began to the value; 0: it has not begun
  double size = 0;   ///< of the next step
  int cuts = 0;      ///< of that step
};

/// A step along which not t but C(u) is given.
template <int dim>
struct Control
{
  std::string name;                 ///< "damage", "zone" or "displacement"
  const PathMeasure<dim>& measure;  ///< C
  double increment = 0;             ///< of C(u)
  double last_increment = 0;        ///< of the step before; 0: it was none of this measure
  double largest_change = 0;        ///< of t
  std::optional<double> failed{};   ///< t at which Newton's method has failed from where the step begins
  int cuts = 0;
};

/// Follows a load path. The first step of all starts from scratch, every other from the displacement of the
/// one before; what a step commits is the jump of its resolvent, once it has converged (method section 12.2).
/// With an adaptive stopping criterion what it commits has the linearisation error of the step; the bound
/// does not cover what earlier steps have left. Keeps references to problem, method and stop. On a mesh that
/// is shared out all ranks call its members together.
template <int dim>
class LoadPath
{
 public:
  /// Throws InputError for a problem that is not well posed (check_rigid_motions) and where an interface
  /// softens faster than gamma allows (check_interfaces), or for the regularised variant. `whole`: as Levels
  /// has it.
  LoadPath(const problem::Problem<dim>& problem, const Method& method, const PathOptions& options,
           mesh::Mesh<dim> mesh, const std::atomic<bool>* stop = nullptr,
           std::shared_ptr<const mesh::Mesh<dim>> whole = nullptr);
  /// The same path on a refinement of the mesh of `coarser`, where the problem is known to be well posed.
  LoadPath(const LoadPath& coarser, mesh::Mesh<dim> mesh);

  /// What the first step, at t, does before anything is solved, and its discretisation; throws what it would
  /// of bad input.
  const Discretisation<dim>& prepare(double t);

  using Observer = std::function<void(const LoadStep<dim>&)>;

  /// Steps up to t, in one or, where Newton's method fails and they may be cut, more steps; `observer` sees
  /// each that is committed, when `progress` says how to go on from there. Not empty: why it ended before;
  /// the last committed step stays.
  [[nodiscard]] std::string advance(double t, const Observer& observer, const StepObserver& step,
                                    bool may_cut, LoadProgress& progress);
  [[nodiscard]] std::string advance(double t, const Observer& observer = {}, const StepObserver& step = {},
                                    bool may_cut = true)
  {
    LoadProgress progress;
    return advance(t, observer, step, may_cut, progress);
  }

  /// One step under control, after two steps at least: u and t are found together from several extrapolations
  /// of these (Bordered), then t stays and Newton's method of all other steps has the last word, so that its
  /// iterates are certified as ever. Not empty: why there is none; the last committed step stays.
  [[nodiscard]] std::string follow(const Control<dim>& control, const Observer& observer = {},
                                   const StepObserver& step = {});

  /// Where it is, to come back to.
  struct Position
  {
    std::shared_ptr<const LoadStep<dim>> last;
    PathPoint before_last;
    std::shared_ptr<const contact::ContactHistory<dim>> history;
    double reference_force = 0;  ///< largest of the committed steps
    double largest_sigma = 0;    ///< ||sigma|| of the committed steps
    std::vector<double> tips{};  ///< of cracks, by number of Problem::contacts(); they never shrink
  };
  [[nodiscard]] Position position() const { return position_; }
  /// Positions one after the other, the newest first, to be recalled by another run. All ranks together.
  [[nodiscard]] static SavedPath<dim> save(std::span<const Position> positions);
  /// Goes to the newest position that another run on this mesh has saved, and returns all of them. What the
  /// traction is there follows from u, and is not t^k of the last iterate. Throws InputError where the
  /// contact points of the mesh are others.
  std::vector<Position> recall(const SavedPath<dim>& saved,
                               const std::optional<certify::FriedrichsConstant>& friedrichs);
  /// On the mesh of its last step, or on `grid` where it has none.
  void go_back(Position position, std::shared_ptr<const Grid<dim>> grid = nullptr);
  /// The step that follows, which has been solved on a coarser mesh, at its t on this one from `start`, which
  /// is its displacement, or from the step before. Not empty: why there is none; the last committed step
  /// stays. A step under control has its t from the coarser mesh, and near a peak there may be no solution,
  /// or one on another branch: one that differs by more than half the stress is none.
  [[nodiscard]] std::string repeat(const LoadStep<dim>& step, const std::vector<double>& start,
                                   const StepObserver& newton = {});
  /// Not empty: it is to end here.
  [[nodiscard]] std::string interruption() const;

  /// The last committed step; null before the first.
  [[nodiscard]] const std::shared_ptr<const LoadStep<dim>>& last() const { return position_.last; }
  [[nodiscard]] const Grid<dim>& grid() const { return *grid_; }
  [[nodiscard]] const PathOptions& options() const { return options_; }
  /// C_F, where it is known.
  [[nodiscard]] const std::optional<certify::FriedrichsConstant>& friedrichs() const { return friedrichs_; }
  [[nodiscard]] const problem::Problem<dim>& problem() const { return problem_; }
  [[nodiscard]] const Method& method() const { return method_; }

 private:
  /// Finds t and what Newton's method there begins with, where the crack has its tips; `point`: what the
  /// search begins with; `steps`: those it takes. Not empty: why there is nothing to be found.
  using Search = std::function<std::string(std::span<const double> tips, PathPoint& point,
                                           std::vector<solve::NewtonStep>& steps)>;
  /// A step to t, or to what `search` finds.
  struct Attempt
  {
    double t;
    int cuts = 0;
    std::string control{"load"};
    std::vector<double> start{};  ///< of the search
    Search search{};
    /// Not empty: why this solution is none for the path; may be empty.
    std::function<std::string(const contact::NitscheForm<dim>&, std::span<const double> u)> fault{};
  };
  [[nodiscard]] std::string try_step(const Attempt& attempt, const StepObserver& observer);
  /// Solves and certifies the step with the crack as far as it has come, and again until it does not grow.
  void solve_with_crack(LoadStep<dim>& step, const Attempt& attempt, const StepObserver& observer);
  /// Whether a crack that carries pressure has grown beyond `tips`, which then follow.
  [[nodiscard]] bool crack_grows(LoadStep<dim>& step, std::vector<double>& tips) const;
  [[nodiscard]] std::string try_control(const Control<dim>& control, double theta,
                                        const StepObserver& observer);
  /// Its failure, or that of a matrix.
  [[nodiscard]] std::string guarded(const std::function<std::string()>& step) const;
  [[nodiscard]] std::shared_ptr<const DiscreteAtTime<dim>> at_time(double t,
                                                                   std::span<const double> tips) const;
  [[nodiscard]] Method method_of_step() const;
  [[nodiscard]] certify::Verdict judge(const CertifiedLevel<dim>& level) const;
  void commit(std::shared_ptr<LoadStep<dim>> step);
  /// Loads, reactions and what they do.
  void account(LoadStep<dim>& step);
  /// What the steps after it remember.
  [[nodiscard]] std::shared_ptr<const contact::ContactHistory<dim>> history_after(
      const LoadStep<dim>& step) const;
  [[nodiscard]] Position recall(const SavedStep<dim>& saved, PathPoint before) const;
  /// What only a whole mesh tells, at the first step.
  void check(const DiscreteAtTime<dim>& at);

  const problem::Problem<dim>& problem_;
  const Method& method_;
  PathOptions options_;
  std::shared_ptr<const Grid<dim>> grid_;
  const std::atomic<bool>* stop_;
  std::shared_ptr<const mesh::Mesh<dim>> whole_;  ///< until the first step
  bool is_well_posed_ = false;
  std::shared_ptr<DiscreteAtTime<dim>> prepared_;  ///< the first step
  Position position_;
  std::shared_ptr<Bordered<dim>> bordered_;  ///< from the first step under control on
  std::optional<certify::FriedrichsConstant> friedrichs_;
  std::shared_ptr<solve::Equilibrium<dim>> equilibrium_;  ///< with factors, which all steps share
  Clock::time_point begin_;                               ///< of the step in work
};

}  // namespace tribound::adapt
