#include "tribound/certify/energy/balanced_solution.h"

#include <cstddef>
#include <utility>

#include "tribound/certify/energy/elastic_system.h"

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
                                      const algebra::SolverOptions& solver, ContactSystems<dim>& systems)
{
  std::vector<double> load(rich.load().begin(), rich.load().end());
  rich.add_contact_load(t, load);
  std::vector<double> r(space.n_dofs(), 0.0);
  for_each_inclusion(space, rich.space(),
                     [&](Index richer, Index node, double value)
                     {
                       for (int a = 0; a < dim; ++a) r[dim * node + a] += value * load[dim * richer + a];
                     });
  constexpr double tight = 1e-12;
  if (&space == &rich.space() && motions.size() == 0)
  {
    const std::vector<double> from(start.begin(), start.end());
    return systems.solve(OnContact::free, {&r, 1}, {&from, 1}, tight)[0];
  }
  std::vector<char> fixed = fem::dirichlet(rich.problem(), space).fixed;
  const std::vector<Index> supports =
      motions.size() > 0 ? motions.supports(space, fixed) : std::vector<Index>();
  const ElasticSystem<dim> system(rich.problem(), space, std::move(fixed), solver, {}, supports);
  const std::vector<double> u = system.solve(r, start, tight);
  return &space == &rich.space() ? u : raised(space, u, rich.space());
}

template std::vector<double> raised(const fem::LagrangeSpace<2>&, std::span<const double>,
                                    const fem::LagrangeSpace<2>&);
template std::vector<double> raised(const fem::LagrangeSpace<3>&, std::span<const double>,
                                    const fem::LagrangeSpace<3>&);
template std::vector<double> balanced_solution(const contact::NitscheForm<2>&, const fem::LagrangeSpace<2>&,
                                               std::span<const double>, std::span<const Point<2>>,
                                               const FreeMotions<2>&, const algebra::SolverOptions&,
                                               ContactSystems<2>&);
template std::vector<double> balanced_solution(const contact::NitscheForm<3>&, const fem::LagrangeSpace<3>&,
                                               std::span<const double>, std::span<const Point<3>>,
                                               const FreeMotions<3>&, const algebra::SolverOptions&,
                                               ContactSystems<3>&);

}  // namespace tribound::certify
