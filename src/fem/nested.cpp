#include "fem/nested.h"

#include <cassert>

namespace tribound
{

template <int dim>
std::vector<double> nested_interpolant(const LagrangeSpace<dim>& coarse, std::span<const double> u,
                                       std::span<const Index> parent, const LagrangeSpace<dim>& fine)
{
  assert(u.size() == static_cast<std::size_t>(coarse.n_dofs()));
  assert(parent.size() == static_cast<std::size_t>(fine.mesh().n_cells()));
  const int n = fine.basis().n_nodes();
  std::vector<double> result(fine.n_dofs(), 0.0);
  std::vector<Point<dim>> in_parent(n);
  for (Index c = 0; c < fine.mesh().n_cells(); ++c)
  {
    const CellMap<dim> map = cell_map(fine.mesh(), c);
    const CellMap<dim> parent_map = cell_map(coarse.mesh(), parent[c]);
    for (int i = 0; i < n; ++i) in_parent[i] = reference_point(parent_map, map(fine.basis().node_point(i)));
    const Tabulation<dim> table = coarse.basis().tabulate(in_parent);
    const std::span<const Index> nodes = coarse.cell_nodes(parent[c]);
    for (int i = 0; i < n; ++i)
      for (int a = 0; a < dim; ++a)
      {
        double value = 0;
        for (int j = 0; j < table.n_nodes; ++j) value += table.values_at(i)[j] * u[dim * nodes[j] + a];
        result[dim * fine.cell_nodes(c)[i] + a] = value;
      }
  }
  return result;
}

template <int dim>
std::vector<double> nested_interpolant(const LagrangeSpace<dim>& coarse, std::span<const double> u,
                                       const Refined<dim>& refined, const LagrangeSpace<dim>& fine)
{
  std::vector<Index> parent(fine.mesh().n_cells());
  for (Index c = 0; c < fine.mesh().n_cells(); ++c) parent[c] = refined.ancestor(c);
  return nested_interpolant<dim>(coarse, u, parent, fine);
}

template std::vector<double> nested_interpolant(const LagrangeSpace<2>&, std::span<const double>,
                                                std::span<const Index>, const LagrangeSpace<2>&);
template std::vector<double> nested_interpolant(const LagrangeSpace<3>&, std::span<const double>,
                                                std::span<const Index>, const LagrangeSpace<3>&);
template std::vector<double> nested_interpolant(const LagrangeSpace<2>&, std::span<const double>,
                                                const Refined<2>&, const LagrangeSpace<2>&);
template std::vector<double> nested_interpolant(const LagrangeSpace<3>&, std::span<const double>,
                                                const Refined<3>&, const LagrangeSpace<3>&);

}  // namespace tribound
