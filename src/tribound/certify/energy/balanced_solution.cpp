#include "tribound/certify/energy/balanced_solution.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstddef>
#include <utility>

#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/contact/support/rigid_modes.h"
#include "tribound/mesh/bodies.h"
#include "tribound/mesh/geometry.h"

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

}  // namespace

template <int dim>
bool held_by_conditions(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh)
{
  constexpr int n = contact::RigidModes<dim>::n_modes;
  using Gram = Eigen::Matrix<double, n, n>;
  const mesh::Bodies bodies = mesh::number_bodies(mesh);
  const mesh::BoundingBox<dim> box = mesh::box_around(mesh);
  const contact::RigidModes<dim> modes{.centre = box.lower, .size = box.diagonal()};
  std::vector<double> grams(static_cast<std::size_t>(bodies.n) * n * n, 0.0);
  for (const mesh::BoundaryFacet& facet : mesh.owned_boundary())
  {
    const auto& boundary = problem.boundary(facet.tag);
    if (!boundary.fixes_any()) continue;
    Eigen::Map<Gram> gram(&grams[static_cast<std::size_t>(bodies.of_cell[facet.cell]) * n * n]);
    for (const Index v : mesh::facet_vertices(mesh.cell(facet.cell), facet.local))
    {
      const auto motions = modes.at(mesh.vertex(v));
      for (int c = 0; c < dim; ++c)
        if (boundary.fixes(c)) gram += motions.row(c).transpose() * motions.row(c);
    }
  }
  mesh.ranks().sum(std::span(grams));
  constexpr double threshold = 1e-10;
  for (int b = 0; b < bodies.n; ++b)
  {
    const Eigen::Map<const Gram> gram(&grams[static_cast<std::size_t>(b) * n * n]);
    const Eigen::SelfAdjointEigenSolver<Gram> eigen(gram);
    if (!(eigen.eigenvalues()[0] > threshold * eigen.eigenvalues()[n - 1])) return false;
  }
  return true;
}

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
                                      std::span<const Point<dim>> t, const algebra::SolverOptions& solver)
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
  const algebra::SparseMatrix matrix(dim, contact::stiffness(rich.problem(), space, constraints),
                                     space.numbers());
  algebra::LinearSolver linear(solver, space, algebra::MatrixKind::positive_definite);
  constexpr double tight = 1e-12;
  std::vector<double> u(space.n_dofs(), 0.0);
  (void)linear.solve(matrix, r, tight * scale, u);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = constraints.fixed[i] ? start[i] : start[i] + u[i];
  return &space == &rich.space() ? u : raised(space, std::span<const double>(u), rich.space());
}

template bool held_by_conditions(const problem::Problem<2>&, const mesh::Mesh<2>&);
template bool held_by_conditions(const problem::Problem<3>&, const mesh::Mesh<3>&);
template std::vector<double> raised(const fem::LagrangeSpace<2>&, std::span<const double>,
                                    const fem::LagrangeSpace<2>&);
template std::vector<double> raised(const fem::LagrangeSpace<3>&, std::span<const double>,
                                    const fem::LagrangeSpace<3>&);
template std::vector<double> balanced_solution(const contact::NitscheForm<2>&, const fem::LagrangeSpace<2>&,
                                               std::span<const double>, std::span<const Point<2>>,
                                               const algebra::SolverOptions&);
template std::vector<double> balanced_solution(const contact::NitscheForm<3>&, const fem::LagrangeSpace<3>&,
                                               std::span<const double>, std::span<const Point<3>>,
                                               const algebra::SolverOptions&);

}  // namespace tribound::certify
