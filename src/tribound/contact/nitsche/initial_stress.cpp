#include "tribound/contact/nitsche/initial_stress.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "tribound/base/error.h"
#include "tribound/base/parallel.h"
#include "tribound/contact/nitsche/datum_moments.h"
#include "tribound/fem/degree.h"
#include "tribound/fem/polynomials.h"
#include "tribound/problem/formula.h"

namespace tribound::contact
{

namespace
{

template <int dim>
using SymmetricEntries = Point<problem::n_symmetric<dim>>;

/// The size of entry i among the entries whose squares add up to that of the tensor.
template <int dim>
double entry_size(int i)
{
  return i < dim ? 1 : std::numbers::sqrt2;
}

template <int dim>
Tensor<dim> tensor_of(const SymmetricEntries<dim>& entries)
{
  Tensor<dim> result = Tensor<dim>::Zero();
  for (int i = 0; i < problem::n_symmetric<dim>; ++i)
    result += entries[i] / entry_size<dim>(i) * problem::symmetric_unit<dim>(i);
  return result;
}

/// Not less than the largest sum_i |theta_i| for equidistant nodes on segments and triangles.
double lebesgue_constant(int degree)
{
  constexpr std::array constants = {1.0, 1.0, 1.67, 2.28, 3.48};
  static_assert(constants.size() == fem::max_degree + 1);
  return constants[degree];
}

}  // namespace

template <int dim>
Datum<dim, problem::n_symmetric<dim>> initial_stress_datum(const problem::Problem<dim>& problem, int region)
{
  const problem::Region<dim>& r = problem.regions()[region];
  SymmetricEntries<dim> identity = SymmetricEntries<dim>::Zero();
  identity.template head<dim>().setOnes();
  const double beta = thermal_modulus(r.material);
  Datum<dim, problem::n_symmetric<dim>> datum;
  if (beta != 0 && !r.temperature.is_zero()) datum.terms.push_back({&r.temperature, -beta * identity});
  if (beta != 0 && !r.reference_temperature.is_zero())
    datum.terms.push_back({&r.reference_temperature, beta * identity});
  for (int i = 0; i < problem::n_symmetric<dim>; ++i)
    if (!r.initial_stress[i].is_zero())
      datum.terms.push_back({&r.initial_stress[i], entry_size<dim>(i) * SymmetricEntries<dim>::Unit(i)});
  return datum;
}

template <int dim>
Datum<dim, 1> initial_hoop_datum(const problem::Problem<dim>& problem, int region)
{
  if (!problem.is_axisymmetric()) return {};
  const problem::Region<dim>& r = problem.regions()[region];
  const double beta = thermal_modulus(r.material);
  Datum<dim, 1> datum;
  if (beta != 0 && !r.temperature.is_zero()) datum.terms.push_back({&r.temperature, Point<1>(-beta)});
  if (beta != 0 && !r.reference_temperature.is_zero())
    datum.terms.push_back({&r.reference_temperature, Point<1>(beta)});
  if (!r.initial_stress_zz.is_zero()) datum.terms.push_back({&r.initial_stress_zz, Point<1>(1.0)});
  return datum;
}

double StressRemainder::added_to(double norm) const
{
  return std::hypot(norm + projection, oscillation);
}

template <int dim>
InitialStress<dim>::InitialStress(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                  int degree, double density, int max_parts)
    : mesh_(&mesh)
{
  if (!problem.has_initial_stress()) return;
  represent_constants(problem);
  represent(problem, degree, density, max_parts);
}

template <int dim>
void InitialStress<dim>::represent_constants(const problem::Problem<dim>& problem)
{
  const double one = 1 / std::sqrt(dim == 2 ? 2.0 : 6.0);  // of the orthonormal basis
  of_region_.resize(problem.regions().size());
  for (std::size_t r = 0; r < of_region_.size(); ++r)
  {
    const Datum<dim, problem::n_symmetric<dim>> datum = initial_stress_datum(problem, static_cast<int>(r));
    const Datum<dim, 1> hoop = initial_hoop_datum(problem, static_cast<int>(r));
    acts_.push_back(datum.terms.empty() && hoop.terms.empty() ? 0 : 1);
    const auto is_constant = [](const auto& term) { return term.value->is_constant(); };
    if (acts_.back() == 0 || !std::ranges::all_of(datum.terms, is_constant) ||
        !std::ranges::all_of(hoop.terms, is_constant))
      continue;
    of_region_[r].plane = {one * tensor_of<dim>(datum(Point<dim>::Zero()))};
    if (problem.is_axisymmetric()) of_region_[r].hoop = {one * hoop(Point<dim>::Zero())[0]};
  }
}

template <int dim>
void InitialStress<dim>::represent(const problem::Problem<dim>& problem, int degree, double density,
                                   int max_parts)
{
  const auto varies = [this](Index cell)
  { return acts_on(cell) && of_region_[mesh_->region(cell)].plane.empty(); };
  bool any = false;
  for (Index c = 0; c < mesh_->n_cells() && !any; ++c) any = varies(c);
  if (!any) return;
  const DatumMoments<dim, dim, problem::n_symmetric<dim>> moments(
      degree, degree + (problem.is_axisymmetric() ? 1 : 0));
  std::optional<DatumMoments<dim, dim, 1>> around_axis;
  if (problem.is_axisymmetric()) around_axis.emplace(degree, degree + 1);
  of_cell_.resize(mesh_->n_cells());
  remainders_.resize(mesh_->n_cells());
  parallel_for(of_cell_.size(),
               [&](std::size_t i)
               {
                 const auto c = static_cast<Index>(i);
                 if (!varies(c)) return;
                 const int region = mesh_->region(c);
                 represent(moments, initial_stress_datum(problem, region), c, density, max_parts,
                           [&](const auto& entries)
                           { of_cell_[i].plane.push_back(tensor_of<dim>(entries)); });
                 if (around_axis)
                   represent(*around_axis, initial_hoop_datum(problem, region), c, density, max_parts,
                             [&](const auto& entry) { of_cell_[i].hoop.push_back(entry[0]); });
               });
}

template <int dim>
template <class Moments, class Datum, class Set>
void InitialStress<dim>::represent(const Moments& moments, const Datum& datum, Index cell, double density,
                                   int max_parts, const Set& set)
{
  const SimplexMap<dim, dim> map = simplex_map(*mesh_, cell);
  const auto found = moments(datum, map, {1, 0}, density * std::sqrt(map.measure), max_parts);
  double missed = 0;
  for (const auto& part : found.parts)
    missed += 4 * part.remainder.squaredNorm() * map.measure * fem::fraction<dim>(part.part);
  StressRemainder& remainder = remainders_[cell];
  remainder = {std::hypot(remainder.oscillation, found.oscillation),
               std::hypot(remainder.projection, std::sqrt(missed))};
  std::ranges::for_each(found.moments, set);
  if (!found.is_subdivided() || cell >= mesh_->n_owned_cells()) return;
#pragma omp critical(tribound_initial_stress)
  {
    ++subdivided_;
    parts_ += static_cast<std::int64_t>(found.parts.size());
  }
}

template <int dim>
auto InitialStress<dim>::of(Index cell) const -> const Coefficients&
{
  static const Coefficients none;
  if (!acts_on(cell)) return none;
  const Coefficients& constant = of_region_[mesh_->region(cell)];
  return constant.plane.empty() ? of_cell_[cell] : constant;
}

template <int dim>
Point<dim> initial_traction(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                            const ContactSegment<dim>& segment, const Point<dim - 1>& s)
{
  Point<dim> sum = Point<dim>::Zero();
  segment.for_each_side(
      [&](const SegmentSide<dim>& side)
      {
        const int region = mesh.region(side.facet.cell);
        if (problem.regions()[region].has_initial_stress())
          sum += problem.initial_stress(region, simplex_map(mesh, side)(s)) * side.stress_direction;
      });
  return sum;
}

namespace
{

/// An upper bound of |f - I f| <= (1 + Lambda) |f - P| for f = {sigma_0} and every P of degree p. Nodes are
/// on the boundary of the segment, and it may itself be where a formula jumps: the values on all sides count.
template <int dim>
double interpolation_error(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                           const ContactSegment<dim>& segment, int degree)
{
  std::array<problem::Enclosure, fem::max_degree + 2> storage;
  const auto taylor = std::span(storage).first(degree + 2);
  double distance = 0;
  segment.for_each_side(
      [&](const SegmentSide<dim>& side)
      {
        const SimplexMap<dim - 1, dim> map = simplex_map(mesh, side);
        const std::array<double, dim* dim> vertices =
            corner_coordinates(map, fem::reference_simplex<dim - 1>());
        for (const auto& [value, direction] :
             initial_stress_datum(problem, mesh.region(side.facet.cell)).terms)
        {
          if (value->degree() <= degree || !value->is_enclosed()) continue;
          value->enclose(vertices, dim, taylor, problem::Sides::around);
          const double remainder = problem::distance_from_polynomials(taylor, degree + 1);
          if (!std::isfinite(remainder))
            throw InputError(value->where(), "may be unbounded on a boundary in contact",
                             "bound it there, such as 1/max(x, 1e-12) for 1/x");
          distance += remainder * (tensor_of<dim>(direction) * side.stress_direction).norm();
        }
      });
  return (1 + lebesgue_constant(degree)) * distance;
}

/// The Lipschitz constants of laws with a history are not known: for them the interpolation must be exact.
template <int dim>
[[noreturn]] void refuse_memory(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                                const ContactSegment<dim>& segment)
{
  Where where;
  segment.for_each_side(
      [&](const SegmentSide<dim>& side)
      {
        for (const auto& term : initial_stress_datum(problem, space.mesh().region(side.facet.cell)).terms)
          if (term.value->degree() > space.degree()) where = term.value->where();
      });
  throw InputError(
      where,
      fmt::format("is no polynomial of degree {} on the interface \"{}\", whose law has a history",
                  space.degree(), space.mesh().boundary_names()[segment.slave.facet.tag]),
      "a polynomial of no higher degree there");
}

}  // namespace

template <int dim>
InitialTractions<dim>::InitialTractions(const problem::Problem<dim>& problem,
                                        const fem::LagrangeSpace<dim>& space,
                                        std::span<const ContactSegment<dim>> segments,
                                        std::span<const Point<dim - 1>> points)
    : nodes_(space.degree(), points), degree_(space.degree())
{
  if (!problem.has_initial_stress()) return;
  at_nodes_.reserve(segments.size() * nodes_.nodes().size());
  deviations_.reserve(segments.size());
  for (const ContactSegment<dim>& segment : segments)
  {
    for (const Point<dim - 1>& s : nodes_.nodes())
      at_nodes_.push_back(initial_traction(problem, space.mesh(), segment, s));
    deviations_.push_back(interpolation_error(problem, space.mesh(), segment, degree_));
    if (deviations_.back() > 0 && problem::has_memory(segment.contact->law))
      refuse_memory(problem, space, segment);
  }
}

template <int dim>
Eigen::Matrix<double, dim, Eigen::Dynamic> InitialTractions<dim>::at_points(std::size_t k) const
{
  const auto values = nodes_.values();
  if (empty()) return Eigen::Matrix<double, dim, Eigen::Dynamic>::Zero(dim, values.cols());
  return Eigen::Map<const Eigen::Matrix<double, dim, Eigen::Dynamic>>(at_nodes_[k * values.rows()].data(),
                                                                      dim, values.rows()) *
         values;
}

template <int dim>
std::vector<Point<dim>> InitialTractions<dim>::at(std::size_t k, std::span<const Point<dim - 1>> s) const
{
  std::vector<Point<dim>> result(s.size(), Point<dim>::Zero());
  if (empty()) return result;
  const fem::Tabulation<dim - 1> theta = fem::LagrangeBasis<dim - 1>(degree_).tabulate(s);
  for (int q = 0; q < theta.n_points; ++q)
    for (int l = 0; l < theta.n_nodes; ++l)
      result[q] += theta.values_at(q)[l] * at_nodes_[k * theta.n_nodes + l];
  return result;
}

template Datum<2, 3> initial_stress_datum(const problem::Problem<2>&, int);
template Datum<3, 6> initial_stress_datum(const problem::Problem<3>&, int);
template Datum<2, 1> initial_hoop_datum(const problem::Problem<2>&, int);
template Datum<3, 1> initial_hoop_datum(const problem::Problem<3>&, int);
template class InitialStress<2>;
template class InitialStress<3>;
template Point<2> initial_traction(const problem::Problem<2>&, const mesh::Mesh<2>&, const ContactSegment<2>&,
                                   const Point<1>&);
template Point<3> initial_traction(const problem::Problem<3>&, const mesh::Mesh<3>&, const ContactSegment<3>&,
                                   const Point<2>&);
template class InitialTractions<2>;
template class InitialTractions<3>;

}  // namespace tribound::contact
