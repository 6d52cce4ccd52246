#pragma once

/// @file tensor_field.h
/// Stresses as fields that are read cell by cell, and the numbers that are shown of them.

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/certify/equilibrate/stress.h"
#include "tribound/fem/space.h"
#include "tribound/mesh/geometry.h"
#include "tribound/problem/problem.h"

namespace tribound::io
{

/// A tensor field that may be discontinuous between cells. `at_nodes(cell, values)` sets its values at the
/// nodes of the cell, in the order of LagrangeSpace::basis(); its symmetric part is written.
template <int dim>
struct TensorField
{
  std::string name;
  std::function<void(Index cell, std::span<Tensor<dim>> values)> at_nodes;
  /// On a meridian: added_around_axis() at the nodes; elsewhere empty.
  std::function<void(Index cell, std::span<double> values)> hoop{};

  /// The values of `hoop`, 0 where it is empty.
  [[nodiscard]] std::vector<double> hoop_at_nodes(Index cell, int n_nodes) const
  {
    std::vector<double> values(n_nodes, 0.0);
    if (hoop) hoop(cell, values);
    return values;
  }
};

/// Its values at points of a cell, given in the reference coordinates of Mesh::cell, by interpolation: exact
/// for a field that is a polynomial of degree p there.
template <int dim>
[[nodiscard]] std::vector<Tensor<dim>> values_at(const TensorField<dim>& field,
                                                 const fem::LagrangeBasis<dim>& basis, Index cell,
                                                 std::span<const Point<dim>> points);

/// A point of a cell, a little inside: a formula that jumps between cells has their branch there.
template <int dim>
[[nodiscard]] Point<dim> inside(const mesh::CellMap<dim>& map, const Point<dim>& xhat);

/// sigma(u_h) as a field, with the initial stress. Keeps references to the arguments.
template <int dim>
[[nodiscard]] TensorField<dim> stress_field(const problem::Problem<dim>& problem,
                                            const fem::LagrangeSpace<dim>& space, std::span<const double> u);

/// sigma_h = sigma_dis + sigma_lin as a field, on a meridian r times the stress. Keeps references to the
/// arguments.
template <int dim>
[[nodiscard]] TensorField<dim> equilibrated_stress_field(const fem::LagrangeSpace<dim>& space,
                                                         const certify::Stress<dim>& stress);

/// sigma_zz / (sigma_xx + sigma_yy) in 2D, zz being the direction around the axis on a meridian: nu = lambda
/// / (2 (lambda + mu)) in plane strain, 0 in plane stress.
[[nodiscard]] double out_of_plane_ratio(const problem::Material& material);
/// E u_r / r: what the hoop stress has on a meridian beside nu (sigma_rr + sigma_zz).
[[nodiscard]] double added_around_axis(const problem::Material& material, double hoop_strain);

/// What the initial stress adds to sigma_zz in 2D, sigma_0,zz - ratio (sigma_0,xx + sigma_0,yy); 0 in 3D.
template <int dim>
[[nodiscard]] double out_of_plane_rest(const problem::Problem<dim>& problem, int region, const Point<dim>& x);
/// Whether that may be anything in the region.
template <int dim>
[[nodiscard]] bool has_out_of_plane_rest(const problem::Region<dim>& region);

/// Symmetric part of s in VTK's order (xx, yy, zz, xy, yz, xz); `ratio`, see out_of_plane_ratio(), gives zz
/// in 2D.
template <int dim>
[[nodiscard]] std::array<double, 6> symmetric_part(const Tensor<dim>& s, double ratio);

/// The symmetric parts of a stress at the nodes of a cell, with what initial stress and hoop strain add to zz
/// in 2D.
template <int dim>
void symmetric_at_nodes(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                        const TensorField<dim>& field, Index cell, std::span<std::array<double, 6>> values);

/// Von Mises stress (3/2 dev sigma : dev sigma)^{1/2} of the symmetric tensor (xx, yy, zz, xy, yz, xz).
[[nodiscard]] double von_mises(const std::array<double, 6>& sigma);

/// Its eigenvalues, the largest first; tension positive.
[[nodiscard]] std::array<double, 3> principal_stresses(const std::array<double, 6>& sigma);

}  // namespace tribound::io
