#pragma once

/// @file levels.h
/// The sequence of meshes: the state of the adaptive algorithm, and its steps.

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

/// A complete level.
template <int dim>
struct LevelView
{
  int number;  ///< from 0, the given mesh
  const Discretisation<dim>& discrete;
  const CertifiedLevel<dim>& level;
  const certify::Verdict& verdict;  ///< what holds after it
  double seconds;                   ///< wall time spent on the level so far, refinement included
  std::shared_ptr<const Discretisation<dim>> owner;  ///< of `discrete`, to keep it alive
};

/// The next mesh, before anything is solved on it.
struct NextMesh
{
  std::int64_t cells;                  ///< of all ranks
  std::optional<std::int64_t> dofs{};  ///< free ones; absent while only the mesh is there
  double growth = 1;                   ///< factor of free dofs over the previous mesh, where known
  Ranks ranks{};                       ///< the ranks that decide together
};

/// What a level starts from besides its mesh and the transferred solution.
struct LevelStart
{
  int level = 0;                     ///< its number
  double delta = 0;                  ///< of the regularised variant
  double accuracy = 0;               ///< of the data, DataAccuracy::absolute
  std::optional<double> expected{};  ///< of solve_and_certify()
  bool is_likely_last = false;       ///< by the expected bound and size, no mesh will follow
  std::optional<certify::FriedrichsConstant> friedrichs{};
};

/// The cells of a level to bisect, ascending; on several ranks own ones.
template <int dim>
using Marker = std::function<std::vector<Index>(const LevelView<dim>&)>;

/// The reason not to solve on a mesh; empty: none.
using MeshLimit = std::function<std::string(const NextMesh&)>;

/// Solves and certifies on a mesh, refines it, transfers the solution, and returns to the previous level
/// where a finer one fails. The caller, adapt() or a loop of one's own, decides which cells to refine and
/// when to stop.
///
///     adapt::Levels<2> levels(problem, method, 0.01, std::move(first));
///     while (levels.advance().empty() && levels.verdict().status == certify::RunStatus::budget)
///       if (!levels.refine(my_marking).empty()) break;
///
/// On a distributed mesh all ranks call the members together. What the caller supplies must be the same on
/// all ranks, but `stop` may become true on any of them.
///
/// Keeps references to problem, method and stop.
template <int dim>
class Levels
{
 public:
  /// Starts on the mesh of `first`. A level whose bound is at most tolerance * ||sigma(u_h)|| is certified.
  /// When `stop` becomes true, Newton's method is interrupted, on the first level only once that has been
  /// solved. Throws InputError where the problem is not well posed: a rigid motion is left free, or contact
  /// cannot balance the loads (check_rigid_motions). `whole`: where the mesh is distributed, the whole mesh
  /// on the first rank, or another with the same bodies, supports and C_F; it is not kept.
  Levels(const problem::Problem<dim>& problem, const Method& method, double tolerance,
         std::unique_ptr<Discretisation<dim>> first, const std::atomic<bool>* stop = nullptr,
         std::shared_ptr<const mesh::Mesh<dim>> whole = nullptr);

  /// Continues at a level that another run has reached, on the mesh of `first`, from the solution `u` there.
  /// `whole`: as above, of the initial mesh of the other run.
  Levels(const problem::Problem<dim>& problem, const Method& method, double tolerance,
         std::unique_ptr<Discretisation<dim>> first, const LevelStart& start, std::vector<double> u,
         const std::atomic<bool>* stop = nullptr, std::shared_ptr<const mesh::Mesh<dim>> whole = nullptr);

  /// Error bars to compute besides the bound of the residual, with their requirements. A level that does not
  /// meet these is not `certified`. Call before the first advance().
  void ask_for(ErrorBars bars, std::vector<problem::Quantity<dim>> quantities = {})
  {
    bars_ = std::move(bars);
    quantities_ = std::move(quantities);
  }
  [[nodiscard]] const ErrorBars& bars() const { return bars_; }

  /// The number of the level that advance() reaches next.
  [[nodiscard]] int next_number() const { return number_ + 1; }
  /// What that level starts from, and the transferred solution; between refine() and advance().
  [[nodiscard]] LevelStart start() const
  {
    return {number_ + 1, level_.delta, accuracy_, expected_, is_likely_last_, level_.friedrichs};
  }
  [[nodiscard]] std::span<const double> start_displacement() const { return start_; }

  /// Solves and certifies on the current mesh. Returns why this level was given up, empty on success. On
  /// failure the previous level is the last again, without its stress and estimate: finish() may then be
  /// called, refine() may not. Throws SolveError and bad_alloc for the first level. `is_last`: no other level
  /// will follow, whatever the bound. finish() is then included, and bounds that only the stopping criterion
  /// needs are omitted. The same where that is likely.
  [[nodiscard]] std::string advance(const StepObserver& observer = {}, bool is_last = false);

  /// Lets Newton's method converge to newton.tolerance on the last level (newton.finish), as far as it does
  /// so without harm. Returns whether anything changed.
  bool finish(const StepObserver& observer = {});

  /// Bounds the error of the last level in the energy norm, with the quantities, if this is requested on any
  /// level and not yet done. Returns whether anything changed. If a mesh that was given up cost the level its
  /// stress, this is recomputed. Without a bound of the residual, quantities have only their values.
  bool bound_energy();

  /// Bisects the cells that `mark` selects on the last level and transfers the solution to the new mesh,
  /// which becomes the current one. Returns why the current mesh is kept, a limit or lack of memory; empty on
  /// success.
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
  /// Computes what may be needed later and requires the whole mesh.
  void ask(const mesh::Mesh<dim>* whole);
  [[nodiscard]] bool interrupted() const { return current_->mesh.ranks().any(stop_ && *stop_); }
  /// Passes the steps on, and interrupts Newton's method when the user wants to stop and `interruptible` is
  /// set.
  [[nodiscard]] StepObserver watch(const StepObserver& observer, bool interruptible) const;
  /// Nothing where the level could not be completed: `why` gives the reason.
  [[nodiscard]] std::optional<CertifiedLevel<dim>> solve(const StepObserver& observer, bool is_last,
                                                         std::string& why) const;
  /// Newton's method until convergence with a single bound; nothing where this fails.
  [[nodiscard]] std::optional<CertifiedLevel<dim>> solve_to_the_end(const StepObserver& observer) const;
  /// Recomputes the stress and estimate of the last level if they were released; false: out of memory.
  [[nodiscard]] bool restore_stress();
  /// The energy bound of a solution on the last level.
  [[nodiscard]] certify::EnergyBound energy_or_reason();
  /// The verdict by the residual alone.
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
  double seconds_ = 0;  ///< time spent on the last level

  // For the next level.
  std::shared_ptr<const Discretisation<dim>> discrete_before_;  ///< present between refine() and advance()
  std::vector<double> start_;                                   ///< the solution on the current mesh
  double accuracy_ = 0;                                         ///< of the data on the current mesh
  RefinementSeconds refinement_;
  double seconds_of_next_ = 0;
  std::optional<double> expected_;  ///< BoundComponents::discretisation() expected on the current mesh
  bool is_likely_last_ = false;
};

}  // namespace tribound::adapt
