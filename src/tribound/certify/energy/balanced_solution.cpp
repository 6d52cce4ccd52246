#include "tribound/certify/energy/balanced_solution.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "tribound/contact/nitsche/elasticity.h"

namespace tribound::certify
{

namespace
{

/// For each node of the richer space, once: visit(node, node of the space, value of its basis function
/// there).
template <int dim, class Visit>
void for_each_inclusion(const fem::LagrangeSpace<dim>& space, const fem::LagrangeSpace<dim>& richer,
                        const Visit& visit)
{
  const std::vector<Point<dim>> points = richer.basis().node_points();
  const fem::Tabulation<dim> table = space.basis().tabulate(points);
  std::vector<char> visited(richer.n_nodes(), 0);
  for (Index c = 0; c < richer.mesh().n_cells(); ++c)
    for (int j = 0; j < richer.basis().n_nodes(); ++j)
    {
      const Index node = richer.cell_nodes(c)[j];
      if (std::exchange(visited[node], 1) != 0) continue;
      for (int i = 0; i < space.basis().n_nodes(); ++i)
        visit(node, space.cell_nodes(c)[i], table.values_at(j)[i]);
    }
}

/// A spring at each degree of freedom, given as a row, as stiff as the body is there. As many as there are
/// free motions to stop: when the load does no work in these, neither does any spring.
template <int dim>
void add_springs(algebra::SparseRows& rows, const fem::LagrangeSpace<dim>& space,
                 std::span<const Index> supports)
{
  for (const Index row : supports)
  {
    const Index column = dim * space.owned_node(row / dim) + row % dim;
    const auto first = rows.columns.begin() + rows.begin[row];
    const auto found = std::lower_bound(first, rows.columns.begin() + rows.begin[row + 1], column);
    rows.values[found - rows.columns.begin()] *= 2;
  }
}

}  // namespace

template <int dim>
std::vector<double> raised(const fem::LagrangeSpace<dim>& space, std::span<const double> u,
                           const fem::LagrangeSpace<dim>& richer)
{
  std::vector<double> result(richer.n_dofs(), 0.0);
  for_each_inclusion(space, richer,
                     [&](Index rich, Index node, double value)
                     {
                       for (int a = 0; a < dim; ++a) result[dim * rich + a] += value * u[dim * node + a];
                     });
  return result;
}

template <int dim>
std::vector<double> balanced_solution(const contact::NitscheForm<dim>& rich,
                                      const fem::LagrangeSpace<dim>& space, std::span<const double> start,
                                      std::span<const Point<dim>> t, const FreeMotions<dim>& motions,
                                      const algebra::SolverOptions& solver)
{
  const fem::Constraints constraints = fem::dirichlet(rich.problem(), space);
  std::vector<double> load(rich.load().begin(), rich.load().end());
  rich.add_contact_load(t, load);
  std::vector<double> r(space.n_dofs(), 0.0);
  for_each_inclusion(space, rich.space(),
                     [&](Index richer, Index node, double value)
                     {
                       for (int a = 0; a < dim; ++a) r[dim * node + a] += value * load[dim * richer + a];
                     });
  const std::vector<double> internal = contact::apply_stiffness(rich.problem(), space, start);
  const double scale = space.norm(r) + space.norm(internal);
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = constraints.fixed[i] ? 0 : r[i] - internal[i];
  algebra::SparseRows rows = contact::stiffness(rich.problem(), space, constraints);
  if (motions.size() > 0) add_springs<dim>(rows, space, motions.supports(space));
  const algebra::SparseMatrix matrix(dim, std::move(rows), space.numbers());
  algebra::LinearSolver linear(solver, space, algebra::MatrixKind::positive_definite);
  constexpr double tight = 1e-12;
  std::vector<double> u(space.n_dofs(), 0.0);
  (void)linear.solve(matrix, r, tight * scale, u);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = constraints.fixed[i] ? start[i] : start[i] + u[i];
  return &space == &rich.space() ? u : raised(space, std::span<const double>(u), rich.space());
}

template std::vector<double> raised(const fem::LagrangeSpace<2>&, std::span<const double>,
                                    const fem::LagrangeSpace<2>&);
template std::vector<double> raised(const fem::LagrangeSpace<3>&, std::span<const double>,
                                    const fem::LagrangeSpace<3>&);
template std::vector<double> balanced_solution(const contact::NitscheForm<2>&, const fem::LagrangeSpace<2>&,
                                               std::span<const double>, std::span<const Point<2>>,
                                               const FreeMotions<2>&, const algebra::SolverOptions&);
template std::vector<double> balanced_solution(const contact::NitscheForm<3>&, const fem::LagrangeSpace<3>&,
                                               std::span<const double>, std::span<const Point<3>>,
                                               const FreeMotions<3>&, const algebra::SolverOptions&);

}  // namespace tribound::certify
