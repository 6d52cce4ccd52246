#include "tribound/fem/nested.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "tribound/fem/evaluation.h"

namespace tribound::fem
{

namespace
{

/// u at points of a cell, given in reference coordinates.
template <int dim>
std::vector<Point<dim>> values_in(const LagrangeSpace<dim>& space, Index cell, std::span<const double> u,
                                  std::span<const Point<dim>> points)
{
  const Tabulation<dim> table = space.basis().tabulate(points);
  std::vector<Point<dim>> values;
  values.reserve(points.size());
  for (int q = 0; q < table.n_points; ++q)
    values.push_back(value_at<dim>(space.cell_nodes(cell), u, table.values_at(q)));
  return values;
}

/// Appends u at the nodes of a cell.
template <int dim>
void append_values(const LagrangeSpace<dim>& space, Index cell, std::span<const double> u,
                   std::vector<double>& values)
{
  for (const Index node : space.cell_nodes(cell))
    values.insert(values.end(), u.begin() + dim * node, u.begin() + dim * (node + 1));
}

/// The point of a cell with these reference coordinates.
template <int dim>
Point<dim> point_in(const mesh::CellRecord<dim>& cell, const Point<dim>& xhat)
{
  const Point<dim> origin = cell.vertices[0].point();
  Point<dim> x = origin;
  for (int j = 0; j < dim; ++j) x += xhat[j] * (cell.vertices[j + 1].point() - origin);
  return x;
}

}  // namespace

template <int dim>
std::vector<double> nested_interpolant(const LagrangeSpace<dim>& coarse, std::span<const double> u,
                                       std::span<const Index> parent, const LagrangeSpace<dim>& fine)
{
  assert(u.size() == static_cast<std::size_t>(coarse.n_dofs()));
  assert(parent.size() == static_cast<std::size_t>(fine.mesh().n_cells()));
  std::vector<double> result(fine.n_dofs(), 0.0);
  std::vector<char> done(fine.n_nodes(), 0);  // once per node: tabulation is what costs
  std::vector<Index> nodes;
  std::vector<Point<dim>> in_parent;
  for (Index c = 0; c < fine.mesh().n_cells(); ++c)
  {
    const mesh::CellMap<dim> map = mesh::cell_map(fine.mesh(), c);
    const mesh::CellMap<dim> parent_map = mesh::cell_map(coarse.mesh(), parent[c]);
    nodes.clear();
    in_parent.clear();
    for (int i = 0; i < fine.basis().n_nodes(); ++i)
    {
      const Index node = fine.cell_nodes(c)[i];
      if (done[node] != 0) continue;
      done[node] = 1;
      nodes.push_back(node);
      in_parent.push_back(reference_point(parent_map, map(fine.basis().node_point(i))));
    }
    const std::vector<Point<dim>> values = values_in<dim>(coarse, parent[c], u, in_parent);
    for (std::size_t q = 0; q < nodes.size(); ++q)
      std::ranges::copy(values[q], result.begin() + static_cast<std::ptrdiff_t>(dim) * nodes[q]);
  }
  return result;
}

template <int dim>
std::vector<double> nested_values(const LagrangeSpace<dim>& coarse, std::span<const double> u,
                                  std::span<const mesh::CellRecord<dim>> cells, std::span<const Index> parent)
{
  const int n = coarse.basis().n_nodes();
  const std::vector<Point<dim>> reference = coarse.basis().node_points();
  const mesh::Partition<dim>* partition = coarse.mesh().partition();
  std::vector<Point<dim>> in_parent(n);
  std::vector<double> values;
  values.reserve(cells.size() * n * dim);
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    if (partition && cells[c].name == partition->names[parent[c]])  // the same cell
    {
      append_values<dim>(coarse, parent[c], u, values);
      continue;
    }
    const mesh::CellMap<dim> map = mesh::cell_map(coarse.mesh(), parent[c]);
    for (int i = 0; i < n; ++i) in_parent[i] = reference_point(map, point_in<dim>(cells[c], reference[i]));
    for (const Point<dim>& value : values_in<dim>(coarse, parent[c], u, in_parent))
      values.insert(values.end(), value.begin(), value.end());
  }
  return values;
}

template <int dim>
std::vector<double> cell_values(const LagrangeSpace<dim>& space, std::span<const double> u,
                                std::span<const Index> cells)
{
  std::vector<double> values;
  values.reserve(cells.size() * space.basis().n_nodes() * dim);
  for (const Index c : cells) append_values<dim>(space, c, u, values);
  return values;
}

std::vector<double> beside_each_other(std::span<const CellColumn> columns, std::size_t n_cells)
{
  std::vector<double> values;
  for (std::size_t c = 0; c < n_cells; ++c)
    for (const auto& [column, n] : columns)
    {
      const std::span<const double> of_cell = column.subspan(c * n, n);
      values.insert(values.end(), of_cell.begin(), of_cell.end());
    }
  return values;
}

std::vector<double> cell_column(std::span<const double> values, std::size_t width, std::size_t first,
                                std::size_t n_each)
{
  std::vector<double> column;
  column.reserve(values.size() / width * n_each);
  for (std::size_t begin = first; begin < values.size(); begin += width)
  {
    const std::span<const double> of_cell = values.subspan(begin, n_each);
    column.insert(column.end(), of_cell.begin(), of_cell.end());
  }
  return column;
}

template <int dim>
std::vector<double> from_cell_values(const LagrangeSpace<dim>& space, std::span<const Index> cells,
                                     std::span<const double> values)
{
  const std::size_t n = space.basis().n_nodes();
  assert(values.size() == cells.size() * n * dim);
  std::vector<double> result(space.n_dofs(), 0.0);
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::size_t i = 0; i < n; ++i)
      for (int a = 0; a < dim; ++a)
        result[dim * space.cell_nodes(cells[c])[i] + a] = values[(c * n + i) * dim + a];
  space.update(std::span(result));
  return result;
}

template <int dim>
std::vector<double> nested_interpolant(const LagrangeSpace<dim>& coarse, std::span<const double> u,
                                       const mesh::Refined<dim>& refined, const LagrangeSpace<dim>& fine)
{
  std::vector<Index> parent(fine.mesh().n_cells());
  for (Index c = 0; c < fine.mesh().n_cells(); ++c) parent[c] = refined.ancestor(c);
  return nested_interpolant<dim>(coarse, u, parent, fine);
}

template std::vector<double> nested_interpolant(const LagrangeSpace<2>&, std::span<const double>,
                                                std::span<const Index>, const LagrangeSpace<2>&);
template std::vector<double> nested_interpolant(const LagrangeSpace<3>&, std::span<const double>,
                                                std::span<const Index>, const LagrangeSpace<3>&);
template std::vector<double> nested_values(const LagrangeSpace<2>&, std::span<const double>,
                                           std::span<const mesh::CellRecord<2>>, std::span<const Index>);
template std::vector<double> cell_values(const LagrangeSpace<2>&, std::span<const double>,
                                         std::span<const Index>);
template std::vector<double> from_cell_values(const LagrangeSpace<2>&, std::span<const Index>,
                                              std::span<const double>);
template std::vector<double> nested_interpolant(const LagrangeSpace<2>&, std::span<const double>,
                                                const mesh::Refined<2>&, const LagrangeSpace<2>&);
template std::vector<double> nested_values(const LagrangeSpace<3>&, std::span<const double>,
                                           std::span<const mesh::CellRecord<3>>, std::span<const Index>);
template std::vector<double> cell_values(const LagrangeSpace<3>&, std::span<const double>,
                                         std::span<const Index>);
template std::vector<double> from_cell_values(const LagrangeSpace<3>&, std::span<const Index>,
                                              std::span<const double>);
template std::vector<double> nested_interpolant(const LagrangeSpace<3>&, std::span<const double>,
                                                const mesh::Refined<3>&, const LagrangeSpace<3>&);

}  // namespace tribound::fem
