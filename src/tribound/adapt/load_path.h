#pragma once

/// @file load_path.h
/// Load steps one after the other on one mesh (method section 12): loads and other data follow a load factor
/// t, the contact boundary remembers.

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tribound/adapt/level.h"
#include "tribound/base/clock.h"

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
  int cuts = 0;  ///< how often its size was halved
  std::shared_ptr<const DiscreteAtTime<dim>> at;
  CertifiedLevel<dim> level;
  certify::Verdict verdict;
  double largest_sigma = 0;    ///< of ||sigma(u_h)|| over the path so far, which the verdict is relative to
  double reference_force = 0;  ///< NewtonOptions::reference_force that it was solved with
  /// At the contact points of the form: what the step has committed.
  std::vector<problem::InterfaceResponse<dim>> responses;
  std::vector<double> forces;  ///< a(u, phi_i) - (t, phi_i)_C: loads and reactions, by degree of freedom
  double work = 0;             ///< of them since the step before, by the trapezoidal rule; energy
  double seconds = 0;          ///< wall time, attempts that failed included
};

/// What steps are allowed to do.
struct PathOptions
{
  int few_steps = 12;       ///< of Newton's method: the next step may be larger
  double growth = 1.4;      ///< by this factor, up to the distance to the next target
  double smallest = 1e-6;   ///< step, over the first one of its target
  double tolerance = 0.01;  ///< of the verdict
  int full_steps = 20;      ///< Method::full_steps
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

  /// What the first step, at t, does before anything is solved; throws what it would of bad input.
  void prepare(double t);

  using Observer = std::function<void(const LoadStep<dim>&)>;

  /// Steps up to t, in one or, where Newton's method fails, more steps; `observer` sees each that is
  /// committed. Not empty: why it ended before; the last committed step stays.
  [[nodiscard]] std::string advance(double t, const Observer& observer = {}, const StepObserver& step = {});

  /// The last committed step; null before the first.
  [[nodiscard]] const std::shared_ptr<const LoadStep<dim>>& last() const { return last_; }
  [[nodiscard]] const Grid<dim>& grid() const { return *grid_; }

 private:
  [[nodiscard]] std::string try_step(double t, int cuts, const StepObserver& observer);
  [[nodiscard]] Method method_of_step() const;
  [[nodiscard]] certify::Verdict judge(const CertifiedLevel<dim>& level) const;
  void commit(std::shared_ptr<LoadStep<dim>> step);
  /// Loads, reactions and what they do.
  void account(LoadStep<dim>& step);
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
  std::shared_ptr<const LoadStep<dim>> last_;
  std::shared_ptr<const contact::ContactHistory<dim>> history_;
  std::optional<certify::FriedrichsConstant> friedrichs_;
  double reference_force_ = 0;  ///< largest of the committed steps
  double largest_sigma_ = 0;    ///< ||sigma|| of the committed steps
  Clock::time_point begin_;     ///< of the step in work
};

}  // namespace tribound::adapt
