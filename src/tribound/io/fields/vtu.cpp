#include "tribound/io/fields/vtu.h"

#include <fmt/format.h>

#include <cassert>
#include <cstdint>

#include "tribound/base/error.h"
#include "tribound/io/fields/vtk_nodes.h"
#include "tribound/io/file/vtu_file.h"
#include "tribound/mesh/geometry.h"

namespace tribound::io
{

namespace
{

/// The data common to all arrays of a level file.
template <int dim>
struct Level
{
  const problem::Problem<dim>& problem;
  const fem::LagrangeSpace<dim>& space;
  std::span<const double> u;
  std::vector<int> order = vtk_order<dim>(space.basis());
  std::vector<Point<dim>> points = vtk_points<dim>(space.degree());

  [[nodiscard]] Index n_cells() const { return space.mesh().n_owned_cells(); }
  [[nodiscard]] std::uint64_t n_points() const { return order.size() * n_cells(); }

  /// Calls use(sigma) for the nodes of all cells in turn, sigma in the order of symmetric_part().
  void for_each_tensor(const TensorField<dim>& field, const auto& use) const
  {
    std::vector<std::array<double, 6>> values(order.size());
    for (Index c = 0; c < n_cells(); ++c)
    {
      symmetric_at_nodes<dim>(problem, space, field, c, values);
      for (const int i : order) use(values[i]);
    }
  }

  [[nodiscard]] VtuArray coordinates() const
  {
    return vtu_array<double>("Points", 3, n_points(),
                             [this](const auto& put)
                             {
                               for (Index c = 0; c < n_cells(); ++c)
                               {
                                 const mesh::CellMap<dim> map = mesh::cell_map(space.mesh(), c);
                                 for (const Point<dim>& xhat : points) put_vector<dim>(put, map(xhat));
                               }
                             });
  }

  [[nodiscard]] VtuArray displacement() const
  {
    return vtu_array<double>("displacement", 3, n_points(),
                             [this](const auto& put)
                             {
                               for (Index c = 0; c < n_cells(); ++c)
                                 for (const int i : order)
                                 {
                                   const auto node = static_cast<std::size_t>(space.cell_nodes(c)[i]);
                                   put_vector<dim>(put, Point<dim>(u.data() + dim * node));
                                 }
                             });
  }

  [[nodiscard]] VtuArray tensor(const TensorField<dim>& field) const
  {
    return vtu_array<float>(field.name, 6, n_points(),
                            [this, &field](const auto& put)
                            {
                              this->for_each_tensor(field,
                                                    [&put](const std::array<double, 6>& sigma)
                                                    {
                                                      for (const double s : sigma) put(s);
                                                    });
                            });
  }

  [[nodiscard]] VtuArray principal(const TensorField<dim>& stress) const
  {
    return vtu_array<float>("principal_stresses", 3, n_points(),
                            [this, &stress](const auto& put)
                            {
                              this->for_each_tensor(stress,
                                                    [&put](const std::array<double, 6>& sigma)
                                                    {
                                                      for (const double s : principal_stresses(sigma)) put(s);
                                                    });
                            });
  }

  [[nodiscard]] VtuArray equivalent(const TensorField<dim>& stress) const
  {
    return vtu_array<float>("von_mises", 1, n_points(),
                            [this, &stress](const auto& put) {
                              this->for_each_tensor(stress, [&put](const std::array<double, 6>& sigma)
                                                    { put(von_mises(sigma)); });
                            });
  }

  [[nodiscard]] VtuArray region() const
  {
    return vtu_array<std::int32_t>("region", 1, n_cells(),
                                   [this](const auto& put)
                                   {
                                     for (Index c = 0; c < n_cells(); ++c) put(space.mesh().region(c));
                                   });
  }
};

}  // namespace

template <int dim>
void write_level_vtu(const LevelFiles& files, const SeriesPlace& place, const problem::Problem<dim>& problem,
                     const fem::LagrangeSpace<dim>& space, std::span<const double> u,
                     std::span<const CellField> cell_fields, std::span<const TensorField<dim>> tensors)
{
  const Level<dim> data{problem, space, u};
  const TensorField<dim> stress = stress_field(problem, space, u);

  VtuGrid grid;
  grid.time = place.number;
  grid.load_factor = place.load_factor;
  grid.n_cells = data.n_cells();
  grid.n_points = data.n_points();
  grid.points = {data.coordinates()};
  grid.cells = disjoint_cells(grid.n_cells, data.order.size(), vtk_lagrange_type<dim>);
  grid.point_data = {data.displacement(), data.tensor(stress), data.principal(stress),
                     data.equivalent(stress)};
  for (const TensorField<dim>& field : tensors) grid.point_data.push_back(data.tensor(field));
  grid.cell_data = {data.region()};
  for (const CellField& field : cell_fields)
  {
    assert(field.values.size() == grid.n_cells);
    grid.cell_data.push_back(vtu_array<double>(field.name, 1, grid.n_cells,
                                               [&field](const auto& put)
                                               {
                                                 for (const double value : field.values) put(value);
                                               }));
  }
  write_vtu(files.own, grid);
  if (!files.list.empty()) write_vtu_list(files.list, grid, files.pieces);
}

template void write_level_vtu(const LevelFiles&, const SeriesPlace&, const problem::Problem<2>&,
                              const fem::LagrangeSpace<2>&, std::span<const double>,
                              std::span<const CellField>, std::span<const TensorField<2>>);
template void write_level_vtu(const LevelFiles&, const SeriesPlace&, const problem::Problem<3>&,
                              const fem::LagrangeSpace<3>&, std::span<const double>,
                              std::span<const CellField>, std::span<const TensorField<3>>);
}  // namespace tribound::io
