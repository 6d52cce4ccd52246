#include "tribound/io/fields/tensor_field.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "tribound/certify/equilibrate/stress_tabulation.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/doctor/load_facts.h"
#include "tribound/fem/evaluation.h"
#include "tribound/mesh/geometry.h"

namespace tribound::io
{

double out_of_plane_ratio(const problem::Material& material)
{
  if (material.plane == problem::PlaneModel::stress) return 0.0;
  return material.lambda / (2.0 * (material.lambda + material.mu));
}

double added_around_axis(const problem::Material& material, double hoop_strain)
{
  return doctor::elastic_constants(material, 3).E * hoop_strain;
}

template <int dim>
bool has_out_of_plane_rest(const problem::Region<dim>& region)
{
  return dim == 2 && region.has_initial_stress();
}

template <int dim>
double out_of_plane_rest(const problem::Problem<dim>& problem, int region, const Point<dim>& x)
{
  if (!has_out_of_plane_rest(problem.regions()[region])) return 0;
  return problem.initial_stress_zz(region, x) -
         out_of_plane_ratio(problem.material(region)) * problem.initial_stress(region, x).trace();
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
std::vector<Tensor<dim>> values_at(const TensorField<dim>& field, const fem::LagrangeBasis<dim>& basis,
                                   Index cell, std::span<const Point<dim>> points)
{
  std::vector<Tensor<dim>> nodal(basis.n_nodes());
  field.at_nodes(cell, nodal);
  const fem::Tabulation<dim> table = basis.tabulate(points);
  std::vector<Tensor<dim>> values(points.size(), Tensor<dim>::Zero());
  for (int q = 0; q < table.n_points; ++q)
    for (int i = 0; i < table.n_nodes; ++i) values[q] += table.values_at(q)[i] * nodal[i];
  return values;
}

template <int dim>
Point<dim> inside(const mesh::CellMap<dim>& map, const Point<dim>& xhat)
{
  constexpr double inwards = 1e-9;
  return map(Point<dim>((1 - inwards) * xhat + Point<dim>::Constant(inwards / (dim + 1))));
}

namespace
{

/// u at the nodes of cells.
template <int dim>
class AtNodes
{
 public:
  AtNodes(const fem::LagrangeSpace<dim>& space, std::span<const double> u)
      : space_(&space), u_(u), table_(space.basis().tabulate(space.basis().node_points()))
  {
  }

  [[nodiscard]] int size() const { return table_.n_points; }
  [[nodiscard]] Tensor<dim> gradient(Index cell, int i, const mesh::CellMap<dim>& map) const
  {
    return fem::gradient_at<dim>(space_->cell_nodes(cell), u_, table_.gradients_at(i), map.inverse_transpose);
  }
  /// u_r / r, on the axis its limit; `gradient` is that of u.
  [[nodiscard]] double hoop(Index cell, int i, const Tensor<dim>& gradient) const
  {
    const mesh::Mesh<dim>& mesh = space_->mesh();
    double r = 0;  // without rounding on the axis
    for (int v = 0; v <= dim; ++v)
      r += space_->basis().node(i)[v] * mesh.vertex(mesh.cell(cell)[v])[0] / space_->degree();
    return contact::hoop_strain(r, u_[static_cast<std::size_t>(dim) * space_->cell_nodes(cell)[i]],
                                gradient(0, 0));
  }

 private:
  const fem::LagrangeSpace<dim>* space_;
  std::span<const double> u_;
  fem::Tabulation<dim> table_;
};

}  // namespace

template <int dim>
TensorField<dim> stress_field(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                              std::span<const double> u)
{
  const auto nodes = std::make_shared<const AtNodes<dim>>(space, u);
  TensorField<dim> field{
      "stress", [&problem, &space, nodes](Index cell, std::span<Tensor<dim>> values)
      {
        const int region = space.mesh().region(cell);
        const problem::Material& material = problem.material(region);
        const mesh::CellMap<dim> map = mesh::cell_map(space.mesh(), cell);
        for (int i = 0; i < nodes->size(); ++i)
        {
          const Tensor<dim> gradient = nodes->gradient(cell, i, map);
          values[i] = problem.is_axisymmetric()
                          ? contact::sigma<dim>(material, gradient, nodes->hoop(cell, i, gradient))
                          : contact::sigma<dim>(material, gradient);
          if (problem.regions()[region].has_initial_stress())
            values[i] += problem.initial_stress(region, inside(map, space.basis().node_points()[i]));
        }
      }};
  if (problem.is_axisymmetric())
    field.hoop = [&problem, &space, nodes](Index cell, std::span<double> values)
    {
      const problem::Material& material = problem.material(space.mesh().region(cell));
      const mesh::CellMap<dim> map = mesh::cell_map(space.mesh(), cell);
      for (int i = 0; i < nodes->size(); ++i)
        values[i] = added_around_axis(material, nodes->hoop(cell, i, nodes->gradient(cell, i, map)));
    };
  return field;
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
void symmetric_at_nodes(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                        const TensorField<dim>& field, Index cell, std::span<std::array<double, 6>> values)
{
  const int region = space.mesh().region(cell);
  const double ratio = out_of_plane_ratio(problem.material(region));
  const mesh::CellMap<dim> map = mesh::cell_map(space.mesh(), cell);
  const std::vector<Point<dim>> nodes = space.basis().node_points();
  std::vector<Tensor<dim>> tensors(nodes.size());
  field.at_nodes(cell, tensors);
  const std::vector<double> hoop = field.hoop_at_nodes(cell, space.basis().n_nodes());
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    values[i] = symmetric_part<dim>(tensors[i], ratio);
    values[i][2] += hoop[i] + out_of_plane_rest(problem, region, map(nodes[i]));
  }
}

template Point<2> inside(const mesh::CellMap<2>&, const Point<2>&);
template Point<3> inside(const mesh::CellMap<3>&, const Point<3>&);
template bool has_out_of_plane_rest(const problem::Region<2>&);
template bool has_out_of_plane_rest(const problem::Region<3>&);
template double out_of_plane_rest(const problem::Problem<2>&, int, const Point<2>&);
template double out_of_plane_rest(const problem::Problem<3>&, int, const Point<3>&);
template std::array<double, 6> symmetric_part(const Tensor<2>&, double);
template std::array<double, 6> symmetric_part(const Tensor<3>&, double);
template void symmetric_at_nodes(const problem::Problem<2>&, const fem::LagrangeSpace<2>&,
                                 const TensorField<2>&, Index, std::span<std::array<double, 6>>);
template void symmetric_at_nodes(const problem::Problem<3>&, const fem::LagrangeSpace<3>&,
                                 const TensorField<3>&, Index, std::span<std::array<double, 6>>);
template TensorField<2> stress_field(const problem::Problem<2>&, const fem::LagrangeSpace<2>&,
                                     std::span<const double>);
template TensorField<3> stress_field(const problem::Problem<3>&, const fem::LagrangeSpace<3>&,
                                     std::span<const double>);
template TensorField<2> equilibrated_stress_field(const fem::LagrangeSpace<2>&, const certify::Stress<2>&);
template TensorField<3> equilibrated_stress_field(const fem::LagrangeSpace<3>&, const certify::Stress<3>&);
template std::vector<Tensor<2>> values_at(const TensorField<2>&, const fem::LagrangeBasis<2>&, Index,
                                          std::span<const Point<2>>);
template std::vector<Tensor<3>> values_at(const TensorField<3>&, const fem::LagrangeBasis<3>&, Index,
                                          std::span<const Point<3>>);

}  // namespace tribound::io
