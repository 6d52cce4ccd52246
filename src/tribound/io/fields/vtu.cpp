#include "tribound/io/fields/vtu.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>

#include "tribound/base/error.h"
#include "tribound/certify/equilibrate/stress_tabulation.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/fem/evaluation.h"
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
    std::vector<Tensor<dim>> values(order.size());
    for (Index c = 0; c < n_cells(); ++c)
    {
      field.at_nodes(c, values);
      const double ratio = out_of_plane_ratio(problem.material(space.mesh().region(c)));
      for (const int i : order) use(symmetric_part<dim>(values[i], ratio));
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

double out_of_plane_ratio(const problem::Material& material)
{
  if (material.plane == problem::PlaneModel::stress) return 0.0;
  return material.lambda / (2.0 * (material.lambda + material.mu));
}

template <int dim>
std::array<double, 6> symmetric_part(const Tensor<dim>& s, double ratio)
{
  const double xy = 0.5 * (s(0, 1) + s(1, 0));
  if constexpr (dim == 2)
    return {s(0, 0), s(1, 1), ratio * (s(0, 0) + s(1, 1)), xy, 0.0, 0.0};
  else
    return {s(0, 0), s(1, 1), s(2, 2), xy, 0.5 * (s(1, 2) + s(2, 1)), 0.5 * (s(0, 2) + s(2, 0))};
}

double von_mises(const std::array<double, 6>& sigma)
{
  const auto& [xx, yy, zz, xy, yz, xz] = sigma;
  const double normal = (xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx);
  return std::sqrt(0.5 * normal + 3.0 * (xy * xy + yz * yz + xz * xz));
}

std::array<double, 3> principal_stresses(const std::array<double, 6>& sigma)
{
  const auto& [xx, yy, zz, xy, yz, xz] = sigma;
  if (yz == 0 && xz == 0)  // as in 2D
  {
    const double middle = 0.5 * (xx + yy);
    const double radius = std::sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
    std::array<double, 3> values = {middle + radius, middle - radius, zz};
    std::ranges::sort(values, std::greater());
    return values;
  }
  Eigen::Matrix3d matrix;
  matrix << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(matrix, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d& values = solver.eigenvalues();
  return {values[2], values[1], values[0]};
}

template <int dim>
TensorField<dim> stress_field(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                              std::span<const double> u)
{
  const auto tabulation =
      std::make_shared<const fem::Tabulation<dim>>(space.basis().tabulate(space.basis().node_points()));
  return {"stress", [&problem, &space, u, tabulation](Index cell, std::span<Tensor<dim>> values)
          {
            const problem::Material& material = problem.material(space.mesh().region(cell));
            const mesh::CellMap<dim> map = mesh::cell_map(space.mesh(), cell);
            for (int i = 0; i < tabulation->n_points; ++i)
              values[i] = contact::sigma<dim>(
                  material, fem::gradient_at<dim>(space.cell_nodes(cell), u, tabulation->gradients_at(i),
                                                  map.inverse_transpose));
          }};
}

template <int dim>
TensorField<dim> equilibrated_stress_field(const fem::LagrangeSpace<dim>& space,
                                           const certify::Stress<dim>& stress)
{
  const auto table =
      std::make_shared<const certify::StressTabulation<dim>>(stress.degree, space.basis().node_points());
  const auto block = std::make_shared<std::vector<double>>(stress.block_size());
  const auto entries =
      std::make_shared<std::vector<double>>(static_cast<std::size_t>(dim) * dim * table->n_points());
  return {"equilibrated_stress",
          [&space, &stress, table, block, entries](Index cell, std::span<Tensor<dim>> values)
          {
            std::ranges::copy(stress.dis_in(cell), block->begin());
            for (const std::span<const double> part : {stress.lin_in(cell), stress.reg_in(cell)})
              for (std::size_t i = 0; i < part.size(); ++i) (*block)[i] += part[i];
            table->evaluate(certify::make_sorted_cell(space.mesh(), cell), *block, *entries);
            for (int i = 0; i < table->n_points(); ++i)
              for (int r = 0; r < dim; ++r)
                for (int c = 0; c < dim; ++c)
                  values[i](r, c) = (*entries)[(dim * r + c) * table->n_points() + i];
          }};
}

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

template std::array<double, 6> symmetric_part(const Tensor<2>&, double);
template std::array<double, 6> symmetric_part(const Tensor<3>&, double);
template TensorField<2> stress_field(const problem::Problem<2>&, const fem::LagrangeSpace<2>&,
                                     std::span<const double>);
template TensorField<3> stress_field(const problem::Problem<3>&, const fem::LagrangeSpace<3>&,
                                     std::span<const double>);
template TensorField<2> equilibrated_stress_field(const fem::LagrangeSpace<2>&, const certify::Stress<2>&);
template TensorField<3> equilibrated_stress_field(const fem::LagrangeSpace<3>&, const certify::Stress<3>&);
template void write_level_vtu(const LevelFiles&, const SeriesPlace&, const problem::Problem<2>&,
                              const fem::LagrangeSpace<2>&, std::span<const double>,
                              std::span<const CellField>, std::span<const TensorField<2>>);
template void write_level_vtu(const LevelFiles&, const SeriesPlace&, const problem::Problem<3>&,
                              const fem::LagrangeSpace<3>&, std::span<const double>,
                              std::span<const CellField>, std::span<const TensorField<3>>);
}  // namespace tribound::io
