#include "tribound/adapt/history_check.h"

#include <new>
#include <string>
#include <utility>
#include <vector>

#include "tribound/adapt/finer.h"
#include "tribound/adapt/mark.h"
#include "tribound/base/error.h"
#include "tribound/base/rank_failure.h"

namespace tribound::adapt
{

PathProgram with_half_the_steps(PathProgram program)
{
  std::vector<double> targets;
  targets.reserve(2 * program.targets.size());
  for (const double t : program.targets)
  {
    if (!targets.empty()) targets.push_back((targets.back() + t) / 2);
    targets.push_back(t);
  }
  program.targets = std::move(targets);
  if (program.damage_step) *program.damage_step /= 2;
  program.damage_steps *= 2;
  program.displacement.step /= 2;
  if (program.then) program.then->step /= 2;
  program.max_steps *= 2;
  return program;
}

namespace
{

template <int dim>
PathEnd follow_on_finer(const Grid<dim>& grid, const problem::Problem<dim>& problem, const Method& method,
                        const PathProgram& program, const ReplayObserver<dim>& observer,
                        const std::atomic<bool>* stop)
{
  const std::vector<Index> all = mark_all(grid.mesh.n_owned_cells());
  LoadPath<dim> path(problem, method, {.certifies = false}, finer_mesh<dim>(grid.space, {}, all).mesh(),
                     stop);
  if (observer.begins) observer.begins(0, path.grid());
  return follow<dim>(path, with_half_the_steps(program), observer.step, observer.newton);
}

}  // namespace

template <int dim>
PathEnd follow_finely(const Grid<dim>& grid, const problem::Problem<dim>& problem, Method method,
                      const PathProgram& program, const ReplayObserver<dim>& observer,
                      const std::atomic<bool>* stop)
{
  method.stopping.criterion = Stopping::tolerance;
  std::string failure;
  try
  {
    return follow_on_finer(grid, problem, method, program, observer, stop);
  }
  catch (const InputError& error)  // invalid data at an intermediate t, or on the finer mesh
  {
    failure = InputError(error.where(), error.problem()).what();  // a hint would be a line of its own
  }
  catch (const SolveError& error)
  {
    failure = error.what();
  }
  catch (const std::bad_alloc&)
  {
    failure = "out of memory";
  }
  require_all_failed(grid.mesh.ranks(), failure);
  return {.failure = failure};
}

template PathEnd follow_finely(const Grid<2>&, const problem::Problem<2>&, Method, const PathProgram&,
                               const ReplayObserver<2>&, const std::atomic<bool>*);
template PathEnd follow_finely(const Grid<3>&, const problem::Problem<3>&, Method, const PathProgram&,
                               const ReplayObserver<3>&, const std::atomic<bool>*);

}  // namespace tribound::adapt
