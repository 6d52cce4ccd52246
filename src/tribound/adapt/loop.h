#pragma once

/// @file loop.h
/// The adaptive algorithm, method section 6: solve, certify, mark, bisect, until the bound is below the
/// tolerance or the budget is used up.

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "tribound/adapt/level.h"
#include "tribound/adapt/mark.h"
#include "tribound/certify/bound/certificate.h"

namespace tribound::adapt
{

/// How far to go.
struct AdaptOptions
{
  double tolerance = 0.01;  ///< of eta_tot / ||sigma(u_h)||
  MarkingOptions marking{};
  int max_levels = 30;
  long max_dofs = 2'000'000;
  std::optional<long> max_cells{};     ///< no limit where absent
  std::optional<double> max_time{};    ///< seconds; no limit where absent
  std::optional<double> max_memory{};  ///< GB (1e9 bytes); nine tenths of the machine's where absent
};

/// A level that is complete.
template <int dim>
struct LevelView
{
  int number;  ///< from 0, the given mesh
  const Discretisation<dim>& discrete;
  const CertifiedLevel<dim>& level;
  const certify::Verdict& verdict;                   ///< what holds after it
  double seconds;                                    ///< wall time of the level, refinement included
  std::shared_ptr<const Discretisation<dim>> owner;  ///< of `discrete`, for those who keep it
};

/// What the loop tells while it runs.
template <int dim>
struct LoopObserver
{
  StepObserver step;
  /// Of the last level a second time, if Newton's method has converged on it after the first.
  std::function<void(const LevelView<dim>&)> level;
};

/// What a run may take of the machine's memory.
struct MemoryLimit
{
  double bytes = 0;        ///< 0: not known
  bool from_case = false;  ///< adapt.max_memory; else nine tenths of the machine
};

[[nodiscard]] MemoryLimit memory_limit(const AdaptOptions& options);

/// The memory that a level is expected to take at most, in bytes: `before` the process had before the first
/// level and `peak` after one with 1 / `growth` of its unknowns.
[[nodiscard]] double expected_memory(double before, double peak, double growth, int dim);

/// Adapts the mesh from that of `first`, Newton starting from the solution carried to each new mesh, until
/// bound <= adapt.tolerance * ||sigma(u_h)|| or a limit of [adapt] is reached, or `stop` becomes true.
///
/// On the last level Newton's method goes on to newton.tolerance (newton.finish), which changes the
/// displacement by less than its bound, but contact forces visibly; where it fails or the run is interrupted
/// the level stays as it is.
///
/// The verdict is that of the last level of which the observer was told. Should a later level fail, or
/// violate an identity or run out of memory, the one before it keeps its certificate: the verdict is then
/// `budget` and says what happened. Throws SolveError when the first level cannot be solved, and InputError
/// for data that are not valid on a finer mesh.
template <int dim>
[[nodiscard]] certify::Verdict adapt(const problem::Problem<dim>& problem, const Method& method,
                                     const AdaptOptions& options, std::unique_ptr<Discretisation<dim>> first,
                                     const LoopObserver<dim>& observer, const std::atomic<bool>& stop);

}  // namespace tribound::adapt
