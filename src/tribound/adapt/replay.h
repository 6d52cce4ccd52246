#pragma once

/// @file replay.h
/// A load path followed again and again, from its first step, on meshes that are fine enough for all of its
/// steps (method section 12.4): no history is ever carried from one mesh to another.

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "tribound/adapt/load_path.h"
#include "tribound/adapt/loop.h"
#include "tribound/adapt/path_program.h"

namespace tribound::adapt
{

/// A pass: the path on one mesh.
template <int dim>
struct PassView
{
  int number;  ///< from 0, on the given mesh
  /// The number of the step with the largest bound, over the path's largest ||sigma|| as all of them are.
  int worst;
  const certify::Bound& bound;      ///< its
  const certify::Verdict& verdict;  ///< the worst of its steps
  const LoadStep<dim>* step;        ///< that step; null where it was before a restart, or is not kept
};

/// Where a run over a path is after a load step.
template <int dim>
struct ReplayState
{
  int pass = 0;
  PathProgress<dim> progress;  ///< without its positions
  SavedPath<dim> path;         ///< the last step, and before it the positions of `progress`
  std::optional<certify::FriedrichsConstant> friedrichs;
  // Of the steps of the pass so far.
  std::vector<certify::BoundComponents> cells;  ///< of own cells, from the step with the largest bound there
  certify::Bound worst;                         ///< the largest
  int worst_step = 0;                           ///< its number
  certify::Verdict verdict{certify::RunStatus::certified, {}};

  /// A step of the pass: whether it has the largest bound so far, and the worst verdict.
  bool note_worst(const LoadStep<dim>& step);
  void note_verdict(const LoadStep<dim>& step);
  /// Notes where the path is, for a state that is told.
  void note(const LoadPath<dim>& of);
  /// Brings a path on the same mesh there, for a run that goes on. Throws as LoadPath::recall().
  void recall(LoadPath<dim>& on);
};

/// What replay() and transfer() tell; functions that are empty are not called.
template <int dim>
struct ReplayObserver
{
  StepObserver newton{};
  std::function<void(int pass, const Grid<dim>&)> begins{};  ///< before anything is solved on the mesh
  std::function<void(const LoadStep<dim>&)> step{};
  std::function<void(const ReplayState<dim>&)> state{};  ///< after each step; costs copies
  std::function<void(const PathEnd&)> path_end{};        ///< of a pass, whatever came of it
  std::function<void(const PassView<dim>&)> complete{};
  /// Of a pass after the first; false where the one before does not hold any more, as after a restart.
  std::function<bool()> given_up{};
  /// Of transfer(), in the place of another pass: the last step solved on `left` has been solved again on the
  /// finer mesh, on which the path goes on.
  std::function<void(const PassView<dim>& left, const Grid<dim>& finer)> finer{};
};

/// Follows the program on the mesh that `first` begins with, and again, with its own steps, on finer
/// ones while the bound of any step is above `options.tolerance` of the path's largest ||sigma(u_h)||: cells
/// are marked by the largest of their bounds over the steps, by strategy.mark, within strategy.stop and
/// strategy.limit; the rest of `strategy` is not used. A pass that cannot be followed to its end leaves the
/// one before as the last; the first one leaves the steps that it has come to, and the verdict says where it
/// ended. Throws as LoadPath does. With `from` it goes on after the load step where another run was, and
/// `first` is a path on its mesh.
template <int dim>
[[nodiscard]] certify::Verdict replay(std::unique_ptr<LoadPath<dim>> first, const PathProgram& program,
                                      const Strategy<dim>& strategy, const ReplayObserver<dim>& observer,
                                      const ReplayState<dim>* from = nullptr);

}  // namespace tribound::adapt
