#include "fem/nested.h"

namespace tribound
{

template <int dim>
std::vector<double> nested_interpolant(const LagrangeSpace<dim>& coarse, std::span<const double> u,
                                       const Refined<dim>& refined, const LagrangeSpace<dim>& fine)
{
  const int n = fine.basis().n_nodes();
  std::vector<double> result(fine.n_dofs(), 0.0);
  std::vector<Point<dim>> in_ancestor(n);
  for (Index c = 0; c < fine.mesh().n_cells(); ++c)
  {
    const Index ancestor = refined.ancestor(c);
    const CellMap<dim> map = cell_map(fine.mesh(), c);
    const CellMap<dim> ancestor_map = cell_map(coarse.mesh(), ancestor);
    for (int i = 0; i < n; ++i)
      in_ancestor[i] = reference_point(ancestor_map, map(fine.basis().node_point(i)));
    const Tabulation<dim> table = coarse.basis().tabulate(in_ancestor);
    const std::span<const Index> nodes = coarse.cell_nodes(ancestor);
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

template std::vector<double> nested_interpolant(const LagrangeSpace<2>&, std::span<const double>,
                                                const Refined<2>&, const LagrangeSpace<2>&);
template std::vector<double> nested_interpolant(const LagrangeSpace<3>&, std::span<const double>,
                                                const Refined<3>&, const LagrangeSpace<3>&);

}  // namespace tribound
