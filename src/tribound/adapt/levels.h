#pragma once

/// @file levels.h
/// One mesh after another: what the adaptive algorithm keeps, and the steps it is made of.

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tribound/adapt/error_bars.h"
#include "tribound/adapt/level.h"

namespace tribound::adapt
{

/// A level that is complete.
template <int dim>
struct LevelView
{
  int number;  ///< from 0, the given mesh
  const Discretisation<dim>& discrete;
  const CertifiedLevel<dim>& level;
  const certify::Verdict& verdict;  ///< what holds after it
  double seconds;                   ///< wall time spent on the level so far, refinement included
  std::shared_ptr<const Discretisation<dim>> owner;  ///< of `discrete`, for those who keep it
};

/// The next mesh, before anything is solved on it.
struct NextMesh
{
  std::int64_t cells;                  ///< of all ranks
  std::optional<std::int64_t> dofs{};  ///< free ones; absent while only the mesh is there
  double growth = 1;                   ///< of the free ones against the mesh before, where they are known
  Ranks ranks{};                       ///< which decide together
};

/// What a level starts from beside its mesh and the solution that was carried there.
struct LevelStart
{
  int level = 0;                     ///< its number
  double delta = 0;                  ///< of the regularised variant
  double accuracy = 0;               ///< of the data, DataAccuracy::absolute
  std::optional<double> expected{};  ///< of solve_and_certify()
  std::optional<certify::FriedrichsConstant> friedrichs{};
};

/// The cells of a level to bisect, ascending; on several ranks own ones.
template <int dim>
using Marker = std::function<std::vector<Index>(const LevelView<dim>&)>;

/// Why a mesh is not to be solved on; empty: it may be.
using MeshLimit = std::function<std::string(const NextMesh&)>;

/// Solves and certifies on a mesh, refines it, carries the solution over, and goes back to the level before
/// where a finer one fails. Which cells are refined and when it ends is up to the caller: adapt() or a loop
/// of one's own.
///
///     adapt::Levels<2> levels(problem, method, 0.01, std::move(first));
///     while (levels.advance().empty() && levels.verdict().status == certify::RunStatus::budget)
///       if (!levels.refine(my_marking).empty()) break;
///
/// On a mesh that is shared out all ranks call its members together; what the caller adds has to be the same
/// on all of them. `stop` may become true on any.
///
/// Keeps references to problem, method and stop.
template <int dim>
class Levels
{
 public:
  /// On the mesh of `first`. A level whose bound is at most tolerance * ||sigma(u_h)|| is certified. Newton's
  /// method is left when `stop` becomes true, on the first level only after it has been solved. Throws
  /// InputError where the problem is not well posed: a rigid motion is left free, or contact cannot balance
  /// the loads (check_rigid_motions). `whole`: where the mesh is shared out, on the first rank the whole one
  /// or another with the same bodies, supports and C_F, which is let go of.
  Levels(const problem::Problem<dim>& problem, const Method& method, double tolerance,
         std::unique_ptr<Discretisation<dim>> first, const std::atomic<bool>* stop = nullptr,
         std::shared_ptr<const mesh::Mesh<dim>> whole = nullptr);

  /// Goes on with a level that another run has come to, on the mesh of `first`, from the solution `u` there.
  /// `whole`: as above, of the mesh that the other run began with.
  Levels(const problem::Problem<dim>& problem, const Method& method, double tolerance,
         std::unique_ptr<Discretisation<dim>> first, const LevelStart& start, std::vector<double> u,
         const std::atomic<bool>* stop = nullptr, std::shared_ptr<const mesh::Mesh<dim>> whole = nullptr);

  /// What is bounded beside the residual, and what is demanded of it: a level on which this is not met is not
  /// `certified`. Before the first advance().
  void ask_for(ErrorBars bars, std::vector<problem::Quantity<dim>> quantities = {})
  {
    bars_ = std::move(bars);
    quantities_ = std::move(quantities);
  }
  [[nodiscard]] const ErrorBars& bars() const { return bars_; }

  /// The number of the level that advance() comes to.
  [[nodiscard]] int next_number() const { return number_ + 1; }
  /// What it starts from, and the solution carried there; between refine() and advance().
  [[nodiscard]] LevelStart start() const
  {
    return {number_ + 1, level_.delta, accuracy_, expected_, level_.friedrichs};
  }
  [[nodiscard]] std::span<const double> start_displacement() const { return start_; }

  /// Solves and certifies on the current mesh. Not empty: why this level was given up; the one before is the
  /// last again, without its stress and estimate: finish() may then be called, refine() may not. Throws
  /// SolveError and bad_alloc for the first level. `is_last`: no other level will follow, whatever its bound:
  /// finish() is then made part of it, and bounds that only the stopping criterion needs are left out.
  [[nodiscard]] std::string advance(const StepObserver& observer = {}, bool is_last = false);

  /// Lets Newton's method converge to newton.tolerance on the last level (newton.finish), as far as it does
  /// so without harm; whether it has changed anything.
  bool finish(const StepObserver& observer = {});

  /// Bounds the error of the last level in the energy norm, with the quantities, if it is asked for of any
  /// level and has not been done; whether it has changed anything. A level that has lost its stress to a mesh
  /// that was given up gets it again; without a bound of the residual quantities have their values alone.
  bool bound_energy();

  /// Bisects the cells that `mark` names for the last level and carries the solution to the new mesh, which
  /// becomes the current one. Not empty: why the current one stays: a limit, or there is not the memory.
  [[nodiscard]] std::string refine(const Marker<dim>& mark, const MeshLimit& limit = {});

  /// The last level; not between refine() and advance().
  [[nodiscard]] LevelView<dim> view() const
  {
    return {number_, *current_, level_, verdict_, seconds_, current_};
  }
  [[nodiscard]] const Discretisation<dim>& discrete() const { return *current_; }
  /// What holds on the last level.
  [[nodiscard]] const certify::Verdict& verdict() const { return verdict_; }

 private:
  /// What can be needed later and only a whole mesh tells.
  void ask(const mesh::Mesh<dim>* whole);
  [[nodiscard]] bool interrupted() const { return current_->mesh.ranks().any(stop_ && *stop_); }
  /// Passes the steps on, and leaves Newton's method when the user wants it to end and it may.
  [[nodiscard]] StepObserver watch(const StepObserver& observer, bool interruptible) const;
  /// Nothing where the level did not end: `why` says it.
  [[nodiscard]] std::optional<CertifiedLevel<dim>> solve(const StepObserver& observer, bool is_last,
                                                         std::string& why) const;
  /// Newton's method to its end with one bound; nothing where it does not get there.
  [[nodiscard]] std::optional<CertifiedLevel<dim>> solve_to_the_end(const StepObserver& observer) const;
  /// The stress and estimate of the last level, if they were let go of; false: there is not the memory.
  [[nodiscard]] bool restore_stress();
  /// Of a solution on the last level.
  [[nodiscard]] certify::EnergyBound energy_or_reason();
  /// By the residual alone.
  [[nodiscard]] certify::Verdict judge(const CertifiedLevel<dim>& level) const;
  [[nodiscard]] std::string try_to_advance(const StepObserver& observer, bool is_last);
  [[nodiscard]] std::string try_to_refine(const Marker<dim>& mark, const MeshLimit& limit);

  const problem::Problem<dim>& problem_;
  const Method& method_;
  double tolerance_;
  const std::atomic<bool>* stop_;
  ErrorBars bars_;
  std::vector<problem::Quantity<dim>> quantities_;
  int number_ = -1;  ///< of the last level
  std::shared_ptr<const Discretisation<dim>> current_;
  CertifiedLevel<dim> level_;
  bool has_stress_ = false;  ///< whether it has its stress and estimate
  certify::Verdict verdict_{certify::RunStatus::failed, {}};
  double seconds_ = 0;  ///< spent on the last level

  // For the next level.
  std::shared_ptr<const Discretisation<dim>> discrete_before_;  ///< present between refine() and advance()
  std::vector<double> start_;                                   ///< the solution on the current mesh
  double accuracy_ = 0;                                         ///< of the data there
  RefinementSeconds refinement_;
  double seconds_of_next_ = 0;
  std::optional<double> expected_;  ///< BoundComponents::discretisation() on the current mesh, guessed
};

}  // namespace tribound::adapt
