/// @file own_loop.cpp
/// A program that runs the adaptive loop itself: a load given by a function of the program, a marking that
/// adds the cells in which the contact opens or begins to slip, and its own stopping rule, the friction force
/// on the floor. Exit code 0 if the bound of the last level is valid and the rule was met.

#include <tribound/tribound.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

using namespace tribound;

namespace
{

/// A load on the top that is largest in the middle, q(x) = factor x (2 - x). For a polynomial, the bound only
/// needs its degree.
problem::Field load(double factor)
{
  return problem::Field(
      problem::FieldFunction{.values =
                                 [factor](std::span<const double> x, int dim, std::span<double> values)
                             {
                               for (std::size_t i = 0; i < values.size(); ++i)
                                 values[i] = -factor * x[i * dim] * (2 - x[i * dim]);
                             },
                             .degree = 2});
}

/// Cells whose contact has more than one status: there it opens, or begins to slip.
std::vector<Index> cells_of_change(const contact::NitscheForm<2>& form, std::span<const double> u)
{
  std::vector<Index> cells;
  for (std::size_t k = 0; k < form.segments().size(); ++k)
  {
    const auto states = form.contact_states(u, k);
    const auto differs = [&](const auto& state) { return state.status != states.front().status; };
    if (std::ranges::any_of(states, differs)) cells.push_back(form.segments()[k].slave.facet.cell);
  }
  std::ranges::sort(cells);
  return cells;
}

/// Every cell with at least half of the largest indicator, and the cells of change.
std::vector<Index> mark(const adapt::LevelView<2>& view)
{
  std::vector<double> eta;
  for (const certify::BoundComponents& cell : view.level.estimate.cells) eta.push_back(cell.total_sharp());
  const std::vector<Index> largest = adapt::mark_maximum(eta, 0.5);
  const std::vector<Index> change = cells_of_change(view.discrete.form, view.level.u);
  std::vector<Index> marked;
  std::ranges::set_union(largest, change, std::back_inserter(marked));
  marked.erase(std::unique(marked.begin(), marked.end()), marked.end());
  return marked;
}

/// The force with which the floor holds the block back.
double friction_force(const adapt::LevelView<2>& view)
{
  const contact::NitscheForm<2>& form = view.discrete.form;
  return contact::contact_resultants<2>(form, form.traction(view.level.u)).tangential;
}

/// Refines until the friction force has changed by less than a ten-thousandth on three levels in a row.
bool friction_settles(const problem::Problem<2>& problem, mesh::Mesh<2> mesh)
{
  const adapt::Method method{.degree = 2};
  constexpr double tolerance = 1e-6;  // never reached: the rule below ends the loop
  adapt::Levels<2> levels(problem, method, tolerance,
                          std::make_unique<adapt::Discretisation<2>>(std::move(mesh), problem, method));
  adapt::Strategy<2> strategy = adapt::make_strategy<2>({.max_dofs = 200'000});
  strategy.mark = mark;
  strategy.observer.level = [](const adapt::LevelView<2>& view)
  {
    std::printf("level %2d: %5d cells, bound %6.3f %%, friction %.6f\n", view.number,
                view.discrete.mesh.n_cells(), 100 * view.level.estimate.total_sharp / view.level.norms.sigma,
                friction_force(view));
  };
  int settled = 0;
  strategy.stop = [&, before = 0.0](const adapt::LevelView<2>& view) mutable -> std::string
  {
    const double force = friction_force(view);
    settled = std::abs(force - std::exchange(before, force)) < 1e-4 * std::abs(force) ? settled + 1 : 0;
    return settled == 3 ? "the friction force has settled" : "";
  };
  const certify::Verdict verdict = adapt::adapt(levels, strategy);
  std::printf("%s: %s\n", certify::to_string(verdict.status), verdict.reason.c_str());
  return settled == 3 && certify::is_bound(verdict.status);
}

}  // namespace

int main()
{
  const algebra::Environment environment;  // MPI and PETSc
  try
  {
    mesh::Mesh<2> mesh(mesh::box_mesh<2>({.lower = {0, 0}, .upper = {2, 1}, .cells = {8, 4}}));
    const problem::Problem<2> problem(mesh, {{.name = {}, .material = problem::lame(1.0, 0.3)}},
                                      {problem::with_displacement<2>("left", {0.0, std::nullopt}),
                                       problem::with_traction<2>("top", {0.0, load(0.1)}),
                                       problem::with_contact<2>("bottom", problem::Coulomb(0.2))});
    return friction_settles(problem, std::move(mesh)) ? 0 : 1;
  }
  catch (const InputError& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
  }
  catch (const SolveError& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
  }
  return 1;
}
