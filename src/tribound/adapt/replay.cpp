#include "tribound/adapt/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <utility>
#include <vector>

#include "tribound/adapt/finer.h"
#include "tribound/base/rank_failure.h"

namespace tribound::adapt
{

namespace
{

/// The accumulated results of the steps of a pass.
template <int dim>
class Pass
{
 public:
  explicit Pass(int number) { state_.pass = number; }
  /// A pass that continues.
  Pass(const ReplayState<dim>& from, LoadPath<dim>& path) : state_(from) { state_.recall(path); }

  void add(const LoadStep<dim>& step)
  {
    const std::vector<certify::BoundComponents>& cells = step.level.estimate.cells;
    if (state_.cells.empty()) state_.cells.resize(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (cells[i].total_sharp() > state_.cells[i].total_sharp()) state_.cells[i] = cells[i];
    state_.note_worst(step);
    state_.note_verdict(step);
  }

  [[nodiscard]] bool holds() const { return certify::is_bound(state_.verdict.status); }
  [[nodiscard]] const certify::Verdict& verdict() const { return state_.verdict; }
  [[nodiscard]] PassView<dim> view() const
  {
    return {state_.pass, state_.worst_step, state_.worst, state_.verdict, nullptr};
  }
  [[nodiscard]] PathProgress<dim>& progress() { return state_.progress; }

  /// With the largest bound of every cell over all steps, for marking.
  [[nodiscard]] CertifiedLevel<dim> to_mark() const
  {
    CertifiedLevel<dim> level;
    level.estimate = {state_.worst, state_.cells};
    return level;
  }
  /// The state with the path as it is now.
  [[nodiscard]] const ReplayState<dim>& state(const LoadPath<dim>& path)
  {
    state_.note(path);
    return state_;
  }

 private:
  ReplayState<dim> state_;
};

/// Follows the program, and adds its steps to the pass.
template <int dim>
PathEnd go_through(const PathProgram& program, LoadPath<dim>& path, const ReplayObserver<dim>& observer,
                   Pass<dim>& pass)
{
  const auto committed = [&](const LoadStep<dim>& step)
  {
    pass.add(step);
    if (observer.step) observer.step(step);
    if (observer.state) observer.state(pass.state(path));
  };
  PathEnd end;
  try
  {
    end = follow<dim>(path, program, committed, observer.newton, pass.progress());
  }
  catch (const std::bad_alloc&)
  {
    require_all_failed(path.grid().mesh.ranks(), "out of memory");
    end.failure = "out of memory";
  }
  if (observer.path_end) observer.path_end(end);
  return end;
}

/// Moves the path to the next mesh, or says why there is none.
template <int dim>
std::string refine(std::unique_ptr<LoadPath<dim>>& path, const LevelView<dim>& view,
                   const Strategy<dim>& strategy)
{
  const fem::LagrangeSpace<dim>& space = path->grid().space;
  const std::vector<Index> marked = strategy.mark(view);
  const Finer<dim> finer = finer_mesh<dim>(space, {}, marked, {.twins = view.discrete.twins()});
  NextMesh next{.cells = finer.n_cells, .ranks = space.mesh().ranks()};
  if (strategy.limit)
    if (std::string why = strategy.limit(next); !why.empty()) return why;
  auto on_next = std::make_unique<LoadPath<dim>>(*path, finer.mesh());
  next.dofs = on_next->grid().space.n_global_dofs();
  next.growth = static_cast<double>(*next.dofs) / static_cast<double>(space.n_global_dofs());
  if (strategy.limit)
    if (std::string why = strategy.limit(next); !why.empty()) return why;
  path = std::move(on_next);
  return {};
}

}  // namespace

template <int dim>
bool ReplayState<dim>::note_worst(const LoadStep<dim>& step)
{
  if (worst_step > 0 && step.level.estimate.total_sharp <= worst.total_sharp) return false;
  worst = step.level.estimate.bound();
  worst_step = step.number;
  return true;
}

template <int dim>
void ReplayState<dim>::note_verdict(const LoadStep<dim>& step)
{
  if (step.verdict.status > verdict.status)
    verdict = {step.verdict.status,
               fmt::format("load step {} at t = {:.9g}: {}", step.number, step.t, step.verdict.reason)};
}

template <int dim>
void ReplayState<dim>::note(const LoadPath<dim>& of)
{
  std::vector<typename LoadPath<dim>::Position> positions = progress.positions;
  positions.push_back(of.position());
  std::ranges::reverse(positions);
  path = LoadPath<dim>::save(positions);
  friedrichs = of.friedrichs();
}

template <int dim>
void ReplayState<dim>::recall(LoadPath<dim>& on)
{
  progress.positions = on.recall(path, friedrichs);
  std::ranges::reverse(progress.positions);
  progress.positions.pop_back();
}

template <int dim>
certify::Verdict replay(std::unique_ptr<LoadPath<dim>> first, const PathProgram& program,
                        const Strategy<dim>& strategy, const ReplayObserver<dim>& observer,
                        const ReplayState<dim>* from)
{
  std::unique_ptr<LoadPath<dim>> path = std::move(first);
  certify::Verdict verdict{certify::RunStatus::budget, {}};
  const int first_pass = from ? from->pass : 0;
  for (int number = first_pass;; ++number)
  {
    if (observer.begins) observer.begins(number, path->grid());
    Pass<dim> pass = from && number == first_pass ? Pass<dim>(*from, *path) : Pass<dim>(number);
    const std::string why = go_through(program, *path, observer, pass).failure;
    if (!why.empty() || !pass.holds())
    {
      if (number == 0 || (observer.given_up && !observer.given_up()))
        return why.empty() ? pass.verdict() : certify::Verdict{certify::RunStatus::failed, why};
      verdict.reason +=
          fmt::format("{}this is pass {}, pass {} failed: {}", verdict.reason.empty() ? "" : "; ", number - 1,
                      number, why.empty() ? pass.verdict().reason : why);
      return verdict;
    }
    verdict = pass.verdict();
    if (observer.complete) observer.complete(pass.view());
    if (verdict.status == certify::RunStatus::certified) return verdict;
    const std::shared_ptr<const Discretisation<dim>> discrete = path->last()->discrete();
    const CertifiedLevel<dim> to_mark = pass.to_mark();
    const LevelView<dim> view{number, *discrete, to_mark, verdict, 0, discrete};
    std::string end = strategy.stop ? strategy.stop(view) : std::string();
    if (end.empty()) end = refine(path, view, strategy);
    if (end.empty()) continue;
    verdict.reason += "; " + end;
    return verdict;
  }
}

template struct ReplayState<2>;
template struct ReplayState<3>;
template certify::Verdict replay(std::unique_ptr<LoadPath<2>>, const PathProgram&, const Strategy<2>&,
                                 const ReplayObserver<2>&, const ReplayState<2>*);
template certify::Verdict replay(std::unique_ptr<LoadPath<3>>, const PathProgram&, const Strategy<3>&,
                                 const ReplayObserver<3>&, const ReplayState<3>*);

}  // namespace tribound::adapt
