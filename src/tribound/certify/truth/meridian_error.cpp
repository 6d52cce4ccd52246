#include "tribound/certify/truth/meridian_error.h"

#include <algorithm>
#include <array>
#include <vector>

#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/meridian_rules.h"
#include "tribound/fem/nested.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

namespace
{

/// A strain, or a stress.
struct Meridional
{
  Tensor<2> plane;  ///< of a strain: the gradient
  double hoop;

  Meridional operator+(const Meridional& other) const { return {plane + other.plane, hoop + other.hoop}; }
  Meridional operator-(const Meridional& other) const { return {plane - other.plane, hoop - other.hoop}; }
  [[nodiscard]] double product(const Meridional& other) const
  {
    return plane.cwiseProduct(other.plane).sum() + hoop * other.hoop;
  }
};

Meridional stress_of(const problem::Material& material, const Meridional& strain)
{
  return {contact::sigma<2>(material, strain.plane, strain.hoop),
          contact::hoop_stress(material, strain.plane, strain.hoop)};
}

/// s : C^-1 s with the three-dimensional compliance.
double compliance_square(const problem::Material& material, const Meridional& s)
{
  const double trace = s.plane.trace() + s.hoop;
  const double share = material.lambda / (2 * material.mu + 3 * material.lambda);
  return (s.product(s) - share * trace * trace) / (2 * material.mu);
}

/// A cell of a space, and points in it that are those of a rule on a part of it.
class CellPoints
{
 public:
  CellPoints(const fem::LagrangeSpace<2>& space, Index cell, std::span<const Point<2>> points)
      : space_(space), cell_(cell), map_(mesh::cell_map(space.mesh(), cell))
  {
    std::vector<Point<2>> in_cell;
    for (const Point<2>& x : points) in_cell.push_back(fem::reference_point(map_, x));
    table_ = space.basis().tabulate(in_cell);
  }

  [[nodiscard]] Meridional strain(std::span<const double> u, int q, double r) const
  {
    const std::span<const Index> nodes = space_.cell_nodes(cell_);
    return {fem::gradient_at<2>(nodes, u, table_.gradients_at(q), map_.inverse_transpose),
            fem::value_at<2>(nodes, u, table_.values_at(q))[0] / r};
  }
  /// By its values at the nodes of the cells.
  [[nodiscard]] Meridional stress(std::span<const Tensor<2>> s, std::span<const double> hoop, int q) const
  {
    Meridional result{Tensor<2>::Zero(), 0};
    const std::size_t first = static_cast<std::size_t>(table_.n_nodes) * cell_;
    for (int i = 0; i < table_.n_nodes; ++i)
    {
      result.plane += table_.values_at(q)[i] * s[first + i];
      result.hoop += table_.values_at(q)[i] * hoop[first + i];
    }
    return result;
  }

 private:
  const fem::LagrangeSpace<2>& space_;
  Index cell_;
  mesh::CellMap<2> map_;
  fem::Tabulation<2> table_;
};

/// Calls use(cell, points in it, points in that of the reference, points, weights) for two cells in one
/// place, at a rule on the smaller one for polynomials of this degree over r; the weights contain r. Returns
/// the largest relative error of such integrals.
template <class Use>
double for_each_overlap(const fem::LagrangeSpace<2>& space, const fem::LagrangeSpace<2>& reference_space,
                        int degree, const Use& use)
{
  const std::vector<mesh::CellPair> pairs = cell_pairs(space.mesh(), reference_space.mesh());
  std::vector<mesh::CellMap<2>> maps;
  std::vector<std::array<double, 3>> radii;
  for (const auto& [cell, reference_cell] : pairs)
  {
    const mesh::CellMap<2> own = mesh::cell_map(space.mesh(), cell);
    const mesh::CellMap<2> reference = mesh::cell_map(reference_space.mesh(), reference_cell);
    const bool is_own = own.det < reference.det;
    maps.push_back(is_own ? own : reference);
    const mesh::Mesh<2>& mesh = is_own ? space.mesh() : reference_space.mesh();
    const mesh::Cell<2>& vertices = mesh.cell(is_own ? cell : reference_cell);
    radii.push_back({mesh.vertex(vertices[0])[0], mesh.vertex(vertices[1])[0], mesh.vertex(vertices[2])[0]});
  }
  const fem::MeridianRules rules(radii, degree);
  double doubt = 0;
  std::vector<Point<2>> points;
  std::vector<double> weights;
  for (std::size_t k = 0; k < pairs.size(); ++k)
  {
    const auto number = static_cast<Index>(k);
    points.clear();
    weights.clear();
    for (const auto& [q, x, dx] : fem::cell_points(maps[k], rules.of_cell(number)))
    {
      points.push_back(x);
      weights.push_back(dx * x[0]);
    }
    use(pairs[k].a, CellPoints(space, pairs[k].a, points), CellPoints(reference_space, pairs[k].b, points),
        std::span<const Point<2>>(points), std::span<const double>(weights));
    doubt = std::max(doubt, rules.relative_error(number));
  }
  return doubt;
}

}  // namespace

LocalError meridian_squares(const problem::Problem<2>& problem, const fem::LagrangeSpace<2>& space,
                            std::span<const double> u, const fem::LagrangeSpace<2>& reference_space,
                            std::span<const double> u_ref)
{
  LocalError error;
  error.energy.resize(space.mesh().n_cells(), 0.0);
  error.stress.resize(space.mesh().n_cells(), 0.0);
  error.doubt = for_each_overlap(
      space, reference_space, 2 * std::max(space.degree(), reference_space.degree()),
      [&](Index cell, const CellPoints& own, const CellPoints& reference, std::span<const Point<2>> points,
          std::span<const double> weights)
      {
        const problem::Material& material = problem.material(space.mesh().region(cell));
        for (int q = 0; q < std::ssize(points); ++q)
        {
          const Meridional strain = own.strain(u, q, points[q][0]);
          const Meridional expected = reference.strain(u_ref, q, points[q][0]);
          const Meridional difference = strain - expected;
          const Meridional stress = stress_of(material, difference);
          error.energy[cell] += weights[q] * stress.product(difference);
          error.stress[cell] += weights[q] * stress.product(stress);
          error.own_energy += weights[q] * stress_of(material, strain).product(strain);
          error.product += weights[q] * stress_of(material, strain).product(expected);
          error.reference_energy += weights[q] * stress_of(material, expected).product(expected);
        }
      });
  return error;
}

StressError meridian_stress_squares(const problem::Problem<2>& problem, const fem::LagrangeSpace<2>& space,
                                    std::span<const Tensor<2>> s, std::span<const double> hoop,
                                    const fem::LagrangeSpace<2>& reference_space,
                                    std::span<const double> u_ref)
{
  StressError error{.cells = std::vector<double>(space.mesh().n_cells(), 0.0)};
  const int of_initial = problem.has_initial_stress() ? 5 : 0;
  error.doubt = for_each_overlap(  // r s has a degree more than s, r C eps(u) that of u
      space, reference_space, 2 * std::max(space.degree() + 1, reference_space.degree()) + of_initial,
      [&](Index cell, const CellPoints& own, const CellPoints& reference, std::span<const Point<2>> points,
          std::span<const double> weights)
      {
        const int region = space.mesh().region(cell);
        const problem::Material& material = problem.material(region);
        for (int q = 0; q < std::ssize(points); ++q)
        {
          const Meridional strain = reference.strain(u_ref, q, points[q][0]);
          const Meridional initial{problem.initial_stress(region, points[q]),
                                   problem.initial_stress_zz(region, points[q])};
          const Meridional difference = own.stress(s, hoop, q) - (stress_of(material, strain) + initial);
          error.cells[cell] += weights[q] * compliance_square(material, difference);
        }
      });
  return error;
}

}  // namespace tribound::certify
