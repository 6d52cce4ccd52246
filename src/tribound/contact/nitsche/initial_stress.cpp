#include "tribound/contact/nitsche/initial_stress.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

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
    acts_.push_back(datum.terms.empty() ? 0 : 1);
    const bool is_constant =
        std::ranges::all_of(datum.terms, [](const auto& term) { return term.value->is_constant(); });
    if (is_constant && acts_.back() != 0) of_region_[r] = {one * tensor_of<dim>(datum(Point<dim>::Zero()))};
  }
}

template <int dim>
void InitialStress<dim>::represent(const problem::Problem<dim>& problem, int degree, double density,
                                   int max_parts)
{
  const auto varies = [this](Index cell) { return acts_on(cell) && of_region_[mesh_->region(cell)].empty(); };
  bool any = false;
  for (Index c = 0; c < mesh_->n_cells() && !any; ++c) any = varies(c);
  if (!any) return;
  const DatumMoments<dim, dim, problem::n_symmetric<dim>> moments(degree, degree);
  of_cell_.resize(mesh_->n_cells());
  remainders_.resize(mesh_->n_cells());
  parallel_for(of_cell_.size(),
               [&](std::size_t i)
               {
                 const auto c = static_cast<Index>(i);
                 if (!varies(c)) return;
                 const SimplexMap<dim, dim> map = simplex_map(*mesh_, c);
                 const auto found = moments(initial_stress_datum(problem, mesh_->region(c)), map, {1, 0},
                                            density * std::sqrt(map.measure), max_parts);
                 double missed = 0;
                 for (const auto& part : found.parts)
                   missed += 4 * part.remainder.squaredNorm() * map.measure * fem::fraction<dim>(part.part);
                 remainders_[i] = {found.oscillation, std::sqrt(missed)};
                 of_cell_[i].reserve(found.moments.size());
                 for (const auto& entries : found.moments) of_cell_[i].push_back(tensor_of<dim>(entries));
                 if (!found.is_subdivided() || c >= mesh_->n_owned_cells()) return;
#pragma omp critical(tribound_initial_stress)
                 {
                   ++subdivided_;
                   parts_ += static_cast<std::int64_t>(found.parts.size());
                 }
               });
}

template <int dim>
std::span<const Tensor<dim>> InitialStress<dim>::coefficients(Index cell) const
{
  if (!acts_on(cell)) return {};
  const std::vector<Tensor<dim>>& constant = of_region_[mesh_->region(cell)];
  return constant.empty() ? of_cell_[cell] : constant;
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

/// |f - I f| <= (1 + Lambda) |f - P| for every P of degree p. Nodes are on the boundary of the segment, and
/// it may itself be where a formula jumps: the values on all sides count.
template <int dim>
double initial_traction_deviation(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
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

template Datum<2, 3> initial_stress_datum(const problem::Problem<2>&, int);
template Datum<3, 6> initial_stress_datum(const problem::Problem<3>&, int);
template class InitialStress<2>;
template class InitialStress<3>;
template Point<2> initial_traction(const problem::Problem<2>&, const mesh::Mesh<2>&, const ContactSegment<2>&,
                                   const Point<1>&);
template Point<3> initial_traction(const problem::Problem<3>&, const mesh::Mesh<3>&, const ContactSegment<3>&,
                                   const Point<2>&);
template double initial_traction_deviation(const problem::Problem<2>&, const mesh::Mesh<2>&,
                                           const ContactSegment<2>&, int);
template double initial_traction_deviation(const problem::Problem<3>&, const mesh::Mesh<3>&,
                                           const ContactSegment<3>&, int);

}  // namespace tribound::contact
