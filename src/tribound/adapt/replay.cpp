#include "tribound/adapt/replay.h"

#include <fmt/format.h>

#include <new>
#include <utility>
#include <vector>

#include "tribound/adapt/finer.h"
#include "tribound/base/rank_failure.h"

namespace tribound::adapt
{

namespace
{

/// What the steps of a pass add up to.
template <int dim>
class Pass
{
 public:
  explicit Pass(int number) : number_(number) {}

  void add(std::shared_ptr<const LoadStep<dim>> step)
  {
    const std::vector<certify::BoundComponents>& cells = step->level.estimate.cells;
    if (cells_.empty()) cells_.resize(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (cells[i].total_sharp() > cells_[i].total_sharp()) cells_[i] = cells[i];
    if (!worst_ || step->level.estimate.total_sharp > worst_->level.estimate.total_sharp) worst_ = step;
    if (step->verdict.status > verdict_.status)
      verdict_ = {step->verdict.status,
                  fmt::format("load step {} at t = {:.9g}: {}", step->number, step->t, step->verdict.reason)};
  }

  [[nodiscard]] bool holds() const { return certify::is_bound(verdict_.status); }
  [[nodiscard]] const certify::Verdict& verdict() const { return verdict_; }
  [[nodiscard]] PassView<dim> view() const { return {number_, *worst_, verdict_}; }

  /// With the largest bound of every cell over all steps, for those who mark by it.
  [[nodiscard]] CertifiedLevel<dim> to_mark() const
  {
    CertifiedLevel<dim> level;
    level.estimate = {worst_->level.estimate.bound(), cells_};
    return level;
  }
  [[nodiscard]] const std::shared_ptr<const LoadStep<dim>>& worst() const { return worst_; }

 private:
  int number_;
  std::vector<certify::BoundComponents> cells_;
  std::shared_ptr<const LoadStep<dim>> worst_;
  certify::Verdict verdict_{certify::RunStatus::certified, {}};
};

/// Goes through the program, and adds its steps to the pass.
template <int dim>
PathEnd go_through(const PathProgram& program, LoadPath<dim>& path, const ReplayObserver<dim>& observer,
                   Pass<dim>& pass)
{
  const auto committed = [&](const LoadStep<dim>& step)
  {
    pass.add(path.last());
    if (observer.step) observer.step(step);
  };
  PathEnd end;
  try
  {
    end = follow<dim>(path, program, committed, observer.newton);
  }
  catch (const std::bad_alloc&)
  {
    require_all_failed(path.grid().mesh.ranks(), "out of memory");
    end.failure = "out of memory";
  }
  if (observer.path_end) observer.path_end(end);
  return end;
}

/// The path on the next mesh, or why there is none.
template <int dim>
std::string refine(std::unique_ptr<LoadPath<dim>>& path, const LevelView<dim>& view,
                   const Strategy<dim>& strategy)
{
  const fem::LagrangeSpace<dim>& space = path->grid().space;
  const std::vector<Index> marked = strategy.mark(view);
  const Finer<dim> finer = finer_mesh<dim>(space, {}, marked);
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
certify::Verdict replay(std::unique_ptr<LoadPath<dim>> first, const PathProgram& program,
                        const Strategy<dim>& strategy, const ReplayObserver<dim>& observer)
{
  std::unique_ptr<LoadPath<dim>> path = std::move(first);
  certify::Verdict verdict{certify::RunStatus::failed, {}};
  for (int number = 0;; ++number)
  {
    if (observer.begins) observer.begins(number, path->grid());
    Pass<dim> pass(number);
    const std::string why = go_through(program, *path, observer, pass).failure;
    if (!why.empty() || !pass.holds())
    {
      if (number == 0)
        return why.empty() ? pass.verdict() : certify::Verdict{certify::RunStatus::failed, why};
      if (observer.given_up) observer.given_up();
      verdict.reason += fmt::format("; this is pass {}, pass {} failed: {}", number - 1, number,
                                    why.empty() ? pass.verdict().reason : why);
      return verdict;
    }
    verdict = pass.verdict();
    if (observer.complete) observer.complete(pass.view());
    if (verdict.status == certify::RunStatus::certified) return verdict;
    const std::shared_ptr<const Discretisation<dim>> discrete(pass.worst()->at, &pass.worst()->at->discrete);
    const CertifiedLevel<dim> to_mark = pass.to_mark();
    const LevelView<dim> view{number, *discrete, to_mark, verdict, 0, discrete};
    std::string end = strategy.stop ? strategy.stop(view) : std::string();
    if (end.empty()) end = refine(path, view, strategy);
    if (end.empty()) continue;
    verdict.reason += "; " + end;
    return verdict;
  }
}

template certify::Verdict replay(std::unique_ptr<LoadPath<2>>, const PathProgram&, const Strategy<2>&,
                                 const ReplayObserver<2>&);
template certify::Verdict replay(std::unique_ptr<LoadPath<3>>, const PathProgram&, const Strategy<3>&,
                                 const ReplayObserver<3>&);

}  // namespace tribound::adapt
