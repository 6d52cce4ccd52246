#pragma once

/// @file loop.h
/// The adaptive algorithm, method section 6: solve, certify, mark, bisect, until the bound is below the
/// tolerance or the budget is used up.

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tribound/adapt/levels.h"
#include "tribound/adapt/mark.h"
#include "tribound/certify/bound/certificate.h"

namespace tribound::adapt
{

/// The contributions by which cells are marked.
enum class ErrorMeasure
{
  residual,  ///< eta_tot, unless there is a goal
  energy     ///< the bound in the energy norm, where there is one; else the residual
};

/// When to stop, and how to mark.
struct AdaptOptions
{
  double tolerance = 0.01;  ///< of eta_tot / ||sigma(u_h)||
  MarkingOptions marking{};
  ErrorMeasure measure = ErrorMeasure::residual;  ///< what marks cells
  ErrorBars bars{};
  int max_levels = 30;
  long max_dofs = 2'000'000;
  std::optional<long> max_cells{};     ///< no limit where absent
  std::optional<double> max_time{};    ///< seconds; no limit where absent
  std::optional<double> max_memory{};  ///< GB (1e9 bytes); nine tenths of the machine's where absent
};

/// Callbacks of the running loop; empty functions are not called.
template <int dim>
struct LoopObserver
{
  StepObserver step{};
  /// Called a second time for the last level, if Newton's method has converged or error bars have been
  /// computed after the first call.
  std::function<void(const LevelView<dim>&)> level{};
  /// Called for the next mesh, before anything is solved on it.
  std::function<void(const Levels<dim>&)> refined{};
};

/// The replaceable parts of the loop; all but `mark` may be empty.
template <int dim>
struct Strategy
{
  Marker<dim> mark;
  /// Why a level is the last although its bound exceeds the tolerance; empty: it is not the last.
  std::function<std::string(const LevelView<dim>&)> stop;
  MeshLimit limit;
  std::optional<int> last_level{};  ///< the level after which `stop` ends the loop in any case
  LoopObserver<dim> observer{};
};

/// Marking and limits according to the options, and no observer. The clock of max_time starts now.
/// `interrupt` becoming true is a limit, too.
template <int dim>
[[nodiscard]] Strategy<dim> make_strategy(const AdaptOptions& options,
                                          const std::atomic<bool>* interrupt = nullptr);

/// The memory limit of a run.
struct MemoryLimit
{
  double bytes = 0;        ///< 0: not known
  bool from_case = false;  ///< adapt.max_memory; else nine tenths of the machine
};

[[nodiscard]] MemoryLimit memory_limit(const AdaptOptions& options);

/// The most memory that a level is expected to take, in bytes. `before`: that of the process before the first
/// level; `peak`: the peak on a level with 1 / `growth` of its unknowns.
[[nodiscard]] double expected_memory(double before, double peak, double growth, int dim);

/// Advances and refines until a level is certified, or cannot be certified, or a limit is reached.
///
/// On the last level Newton's method goes on to newton.tolerance (newton.finish). This changes the
/// displacement by less than its bound, but contact forces visibly. If it fails or the run is interrupted,
/// the level stays as it is. Error bars, if requested, are those of the final iterate.
///
/// The verdict is that of the last level passed to the observer. If a later level fails, violates an identity
/// or runs out of memory, the previous one keeps its certificate; the verdict is then `budget` and says what
/// happened. Throws SolveError when the first level cannot be solved, and InputError for data that are
/// invalid on a finer mesh.
template <int dim>
[[nodiscard]] certify::Verdict adapt(Levels<dim>& levels, const Strategy<dim>& strategy);

/// The same from the mesh of `first`, with the strategy given by the options. Throws InputError for a problem
/// that is not well posed, see Levels.
template <int dim>
[[nodiscard]] certify::Verdict adapt(const problem::Problem<dim>& problem, const Method& method,
                                     const AdaptOptions& options, std::unique_ptr<Discretisation<dim>> first,
                                     const LoopObserver<dim>& observer, const std::atomic<bool>& interrupt);

}  // namespace tribound::adapt
