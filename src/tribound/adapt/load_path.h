#pragma once

/// @file load_path.h
/// Successive load steps on one mesh (method section 12): loads and other data depend on a load factor t, and
/// the contact boundary has a history.

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tribound/adapt/bordered.h"
#include "tribound/adapt/error_bars.h"
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
  int cuts = 0;                 ///< how often the step size was halved
  std::string control{"load"};  ///< the prescribed quantity: "load" is t; else Control::name
  /// Initial displacement of Newton's method at t, where it is not that of the previous step.
  std::vector<double> start{};
  int passes = 1;  ///< solutions until the crack stopped growing
  /// Indexed as Problem::contacts(), with the largest distance over the steps so far.
  std::vector<contact::CrackTip> crack_tips;
  std::shared_ptr<const DiscreteAtTime<dim>> at;
  CertifiedLevel<dim> level;
  certify::Verdict verdict;
  double largest_sigma = 0;    ///< largest ||sigma(u_h)|| over the path so far; the verdict is relative to it
  double reference_force = 0;  ///< NewtonOptions::reference_force of its solution
  /// The committed responses, at the contact points of the form.
  std::vector<problem::InterfaceResponse<dim>> responses;
  /// a(u, phi_i) - (t + p_w n, phi_i)_C: loads, reactions, springs and the pressure of water, by degree of
  /// freedom.
  std::vector<double> forces;
  double work = 0;     ///< of these forces since the previous step, by the trapezoidal rule; energy
  double seconds = 0;  ///< wall time, failed attempts included

  [[nodiscard]] std::shared_ptr<const Discretisation<dim>> discrete() const { return {at, &at->discrete}; }
};

/// a(u, phi_i) - contact_load_i: LoadStep::forces where contact_load_i = (t + p_w n, phi_i)_C.
template <int dim>
[[nodiscard]] std::vector<double> forces_on(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                            std::span<const double> contact_load);

/// Options of the steps.
struct PathOptions
{
  int few_steps = 12;       ///< most steps of Newton's method after which the load step may grow
  double growth = 1.4;      ///< by this factor, up to the distance to the next target
  double smallest = 1e-6;   ///< step, over the first one of its target
  double tolerance = 0.01;  ///< of the verdict
  int full_steps = 20;      ///< Method::full_steps
  /// Whether steps have a bound. Otherwise the problem is known to be well posed, and checks that need the
  /// whole mesh are skipped.
  bool certifies = true;
};

/// The position of a path between two prescribed values of t.
struct LoadProgress
{
  double whole = 0;  ///< distance from its beginning to the value; 0: it has not begun
  double size = 0;   ///< of the next step
  int cuts = 0;      ///< of that step
};

/// A step along which C(u) is prescribed, not t.
template <int dim>
struct Control
{
  std::string name;                 ///< "damage", "zone" or "displacement"
  const PathMeasure<dim>& measure;  ///< C
  double increment = 0;             ///< of C(u)
  double last_increment = 0;        ///< of the previous step; 0: that had another measure
  double largest_change = 0;        ///< of t
  std::optional<double> failed{};   ///< t at which Newton's method has failed from the start of this step
  int cuts = 0;
};

/// Follows a load path. The very first step starts from scratch, every other from the displacement of the
/// previous one. A step that has converged commits the jump of its resolvent (method section 12.2). With an
/// adaptive stopping criterion, this contains the linearisation error of the step; the bound does not cover
/// the errors of earlier steps in the history. Keeps references to problem, method and stop. On a distributed
/// mesh all ranks call its members together.
template <int dim>
class LoadPath
{
 public:
  /// Throws InputError for a problem that is not well posed (check_rigid_motions), where an interface softens
  /// faster than gamma allows (check_interfaces), and for the regularised variant. `whole`: as for Levels.
  LoadPath(const problem::Problem<dim>& problem, const Method& method, const PathOptions& options,
           mesh::Mesh<dim> mesh, const std::atomic<bool>* stop = nullptr,
           std::shared_ptr<const mesh::Mesh<dim>> whole = nullptr);
  /// The same path on a refinement of the mesh of `coarser`, where the problem is known to be well posed.
  LoadPath(const LoadPath& coarser, mesh::Mesh<dim> mesh);

  /// Error bars of every step besides the bound of the residual: the distance from the exact solution of that
  /// step after the computed ones before it. The requirements and the choice of levels in `bars` do not
  /// apply, only whether there are any.
  void ask_for(const ErrorBars& bars, std::vector<problem::Quantity<dim>> quantities = {})
  {
    has_error_bars_ = bars.levels != EnergyLevels::off;
    quantities_ = std::move(quantities);
  }

  /// The part of the first step, at t, that precedes any solution. Returns its discretisation; throws on
  /// invalid input as that step would.
  const Discretisation<dim>& prepare(double t);

  using Observer = std::function<void(const LoadStep<dim>&)>;

  /// Steps up to t, in one step or, where Newton's method fails and `may_cut` allows, in several. `observer`
  /// sees each committed step; `progress` then says how to continue from there. Returns why the path ended
  /// before t, empty on success; the last committed step stays.
  [[nodiscard]] std::string advance(double t, const Observer& observer, const StepObserver& step,
                                    bool may_cut, LoadProgress& progress);
  [[nodiscard]] std::string advance(double t, const Observer& observer = {}, const StepObserver& step = {},
                                    bool may_cut = true)
  {
    LoadProgress progress;
    return advance(t, observer, step, may_cut, progress);
  }

  /// One step under control, after at least two steps. First u and t are found together from several
  /// extrapolations of these (Bordered). Then t is fixed and the usual Newton's method follows, so that its
  /// iterates are certified as always. Returns why there is no such step, empty on success; the last
  /// committed step stays.
  [[nodiscard]] std::string follow(const Control<dim>& control, const Observer& observer = {},
                                   const StepObserver& step = {});

  /// The position of the path, to return to it.
  struct Position
  {
    std::shared_ptr<const LoadStep<dim>> last;
    PathPoint before_last;
    std::shared_ptr<const contact::ContactHistory<dim>> history;
    double reference_force = 0;  ///< over the committed steps
    double largest_sigma = 0;    ///< of ||sigma|| over the committed steps
    std::vector<double> tips{};  ///< of cracks, indexed as Problem::contacts(); they never shrink
  };
  [[nodiscard]] Position position() const { return position_; }
  /// Saves successive positions, the newest first, for another run to restore. All ranks call it together.
  [[nodiscard]] static SavedPath<dim> save(std::span<const Position> positions);
  /// Goes to the newest position that another run on this mesh has saved, and returns all of them. The
  /// traction there follows from u, and is not t^k of the last iterate. Throws InputError where the mesh has
  /// other contact points.
  std::vector<Position> recall(const SavedPath<dim>& saved,
                               const std::optional<certify::FriedrichsConstant>& friedrichs);
  /// Returns to a position on the mesh of its last step, or on `grid` where it has none.
  void go_back(Position position, std::shared_ptr<const Grid<dim>> grid = nullptr);
  /// Solves the next step, already solved on a coarser mesh, at the same t on this mesh: from `start`, which
  /// is its displacement, or from the previous step. Returns why there is no solution, empty on success; the
  /// last committed step stays. A step under control takes its t from the coarser mesh, and near a peak there
  /// may be no solution, or one on another branch. A solution that differs by more than half the stress is
  /// rejected.
  [[nodiscard]] std::string repeat(const LoadStep<dim>& step, const std::vector<double>& start,
                                   const StepObserver& newton = {});
  /// Why the path should stop here; empty: it should not.
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
  /// Finds t and the starting point of Newton's method there, for a crack with these tips. `point`: the start
  /// of the search; `steps`: those of the search. Returns why the search failed; empty on success.
  using Search = std::function<std::string(std::span<const double> tips, PathPoint& point,
                                           std::vector<solve::NewtonStep>& steps)>;
  /// A step to t, or to the point that `search` finds.
  struct Attempt
  {
    double t;
    int cuts = 0;
    std::string control{"load"};
    std::vector<double> start{};  ///< the displacement that the step starts from
    Search search{};
    /// Returns why this solution is not acceptable for the path, empty if it is; may be an empty function.
    std::function<std::string(const contact::NitscheForm<dim>&, std::span<const double> u)> fault{};
  };
  [[nodiscard]] std::string try_step(const Attempt& attempt, const StepObserver& observer);
  /// Solves and certifies the step with the current crack, and again until the crack does not grow.
  void solve_with_crack(LoadStep<dim>& step, const Attempt& attempt, const StepObserver& observer);
  /// Whether a crack that carries pressure has grown beyond `tips`, which are updated.
  [[nodiscard]] bool crack_grows(LoadStep<dim>& step, std::vector<double>& tips) const;
  [[nodiscard]] std::string try_control(const Control<dim>& control, double theta,
                                        const StepObserver& observer);
  /// The failure of the step, or of a matrix.
  [[nodiscard]] std::string guarded(const std::function<std::string()>& step) const;
  [[nodiscard]] std::shared_ptr<const DiscreteAtTime<dim>> at_time(double t,
                                                                   std::span<const double> tips) const;
  [[nodiscard]] Method method_of_step() const;
  [[nodiscard]] certify::Verdict judge(const CertifiedLevel<dim>& level) const;
  void commit(std::shared_ptr<LoadStep<dim>> step);
  void bound_energy(LoadStep<dim>& step) const;
  /// Computes loads, reactions and their work.
  void account(LoadStep<dim>& step);
  /// The history for the next steps.
  [[nodiscard]] std::shared_ptr<const contact::ContactHistory<dim>> history_after(
      const LoadStep<dim>& step) const;
  [[nodiscard]] Position recall(const SavedStep<dim>& saved, PathPoint before) const;
  /// Checks at the first step that need the whole mesh.
  void check(const DiscreteAtTime<dim>& at);

  const problem::Problem<dim>& problem_;
  const Method& method_;
  PathOptions options_;
  std::shared_ptr<const Grid<dim>> grid_;
  const std::atomic<bool>* stop_;
  std::shared_ptr<const mesh::Mesh<dim>> whole_;  ///< until the first step
  bool is_well_posed_ = false;
  bool has_error_bars_ = false;
  std::vector<problem::Quantity<dim>> quantities_;
  std::shared_ptr<DiscreteAtTime<dim>> prepared_;  ///< the first step
  Position position_;
  std::shared_ptr<Bordered<dim>> bordered_;  ///< since the first step under control
  std::optional<certify::FriedrichsConstant> friedrichs_;
  std::shared_ptr<solve::Equilibrium<dim>> equilibrium_;  ///< with factors, which all steps share
  Clock::time_point begin_;                               ///< of the current step
};

}  // namespace tribound::adapt
