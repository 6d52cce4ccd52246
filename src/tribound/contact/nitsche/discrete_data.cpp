#include "tribound/contact/nitsche/discrete_data.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tribound/base/parallel.h"
#include "tribound/contact/nitsche/data_effect.h"
#include "tribound/contact/nitsche/given_data.h"
#include "tribound/fem/polynomials.h"
#include "tribound/mesh/geometry.h"
#include "tribound/problem/formula.h"

namespace tribound::contact
{

namespace
{

/// Limit of the values of basis functions for all parts of all cells and facets, and of the bounds of the
/// parts of each: some seconds of one core.
constexpr double all_values = 2e7;
constexpr double fewest_parts = 64;
constexpr double most_parts_of_facet = 4096;

/// A lower bound of the gap on the parts of a segment; -HUGE_VAL if there is none.
template <int dim>
double smallest_gap(const problem::Field& gap, const SimplexMap<dim - 1, dim>& map,
                    const DatumOnSimplex<dim - 1, 3>& found)
{
  double smallest = HUGE_VAL;
  for (const DatumPart<dim - 1, 3>& part : found.parts)
  {
    std::array<problem::Enclosure, 1> range;
    gap.enclose(corner_coordinates(map, part.part), dim, range);
    smallest = std::min(smallest, range[0].bounded() ? range[0].lower : -HUGE_VAL);
  }
  return smallest;
}

/// Beside a kink or a jump, the polynomial with the moments of a gap can be below the smallest gap and would
/// push where nothing touches. This makes it flatter, with the same mean, until that is no longer so at the
/// points of the rule and the corners.
template <int dim>
void limit_gap(const DatumMoments<dim - 1, dim, 3>& method, double smallest, std::span<Point<3>> moments)
{
  std::vector<Point<dim - 1>> points = method.rule().points;
  for (const Point<dim - 1>& corner : fem::reference_simplex<dim - 1>()) points.push_back(corner);
  double lowest = HUGE_VAL;
  for (const Point<dim - 1>& s : points) lowest = std::min(lowest, method.evaluate(moments, s)[0]);
  if (lowest >= smallest) return;
  const double mean = method.evaluate(moments.first(1), points[0])[0];
  constexpr double inside = 1 - 1e-12;  // so that rounding does not push, either
  const double share = std::max(0.0, inside * (mean - smallest) / (mean - lowest));
  for (Point<3>& moment : moments.subspan(1)) moment[0] *= share;
}

}  // namespace

template <int dim>
int data_exactness(const problem::Problem<dim>& problem, int degree)
{
  return fem::data_quadrature_degree(problem.is_axisymmetric() ? degree + 4 : degree);
}

template <int dim>
DiscreteData<dim>::DiscreteData(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh, int degree,
                                Segments segments, const DataAccuracy& accuracy)
    : problem_(problem),
      mesh_(mesh),
      degree_(degree),
      cell_moments_(degree, problem.is_axisymmetric() ? degree + 1 : degree - 1,
                    data_exactness(problem, degree)),
      facet_moments_(degree, degree, data_exactness(problem, degree)),
      contact_moments_(degree, degree, data_exactness(problem, degree)),
      size_(mesh::box_around(mesh).diagonal())
{
  count_formulas(segments);
  const Measures all = measures(segments);
  double allowed = 0;
  if (effort_.formulas > 0)
    allowed = accuracy.absolute ? *accuracy.absolute
                                : accuracy.share * largest_effect<dim>(problem, mesh, segments,
                                                                       facet_rule().points, all.body);
  const double of_each = static_cast<double>(cell_rule().size()) *
                         fem::polynomial_dimension(dim, degree + 1) *
                         static_cast<double>(std::max<std::int64_t>(effort_.formulas, 1));
  max_parts_ = static_cast<int>(std::clamp(all_values / of_each, fewest_parts, most_parts_of_facet));
  mesh.ranks().together(
      [&]
      {
        represent_body_forces(allowed / std::sqrt(all.body));
        represent_tractions(allowed / std::sqrt(all.boundary));
        represent_initial_stress(allowed / std::sqrt(all.body));
        represent_contact(segments, allowed / std::sqrt(all.contact));
      });
  std::array<std::int64_t, 2> cut{effort_.subdivided, effort_.parts};
  mesh.ranks().sum(std::span(cut));
  effort_.subdivided = cut[0];
  effort_.parts = cut[1];
}

template <int dim>
auto DiscreteData<dim>::measures(Segments segments) const -> Measures
{
  std::array<double, 3> sums{};
  for (Index c = 0; c < mesh_.n_owned_cells(); ++c) sums[0] += simplex_map(mesh_, c).measure;
  for (const mesh::BoundaryFacet& facet : mesh_.owned_boundary())
    sums[1] += simplex_map(mesh_, facet).measure;
  for (const ContactSegment<dim>& segment : segments)
    if (is_owned(mesh_, segment)) sums[2] += segment.measure;
  mesh_.ranks().sum(std::span(sums));
  return {sums[0], sums[1], sums[2]};
}

template <int dim>
void DiscreteData<dim>::count_formulas(Segments segments)
{
  const auto add = [&](bool is_load, bool is_enclosed)
  {
    ++effort_.formulas;
    if (is_load) ++effort_.loads;
    if (!is_enclosed) ++effort_.unenclosed;
  };
  const auto count = [&](const auto& datum, bool is_load)
  {
    if (datum.degree() > degree_ + 2) add(is_load, datum.is_enclosed());
  };
  for (Index c = 0; c < mesh_.n_owned_cells(); ++c)
  {
    if (!problem_.body_force_is_constant(mesh_.region(c))) count(body_datum(problem_, mesh_, c), true);
    if (const int region = mesh_.region(c); problem_.regions()[region].has_initial_stress())
    {
      const Datum<dim, 1> hoop = initial_hoop_datum(problem_, region);
      if (const auto datum = initial_stress_datum(problem_, region); datum.degree() >= hoop.degree())
        count(datum, true);
      else
        count(hoop, true);
    }
  }
  for (const mesh::BoundaryFacet& facet : mesh_.owned_boundary())
  {
    count(traction_datum(problem_, mesh_, facet), true);
    const auto& spring = problem_.boundary(facet.tag).spring;
    if (spring && !spring->is_polynomial(degree_ + 2)) add(true, spring->is_enclosed(degree_ + 2));
  }
  for (const ContactSegment<dim>& segment : segments)
  {
    if (!is_owned(mesh_, segment)) continue;
    const Datum<dim, 3> datum = contact_datum(segment);
    count(datum, false);
    if (segment.varying_normal == nullptr) continue;
    const bool counted = datum.degree() > degree_ + 2;
    if (!counted) ++effort_.formulas;
    if (!segment.varying_normal->is_enclosed() && (!counted || datum.is_enclosed())) ++effort_.unenclosed;
  }
  std::array<std::int64_t, 3> sums{effort_.formulas, effort_.loads, effort_.unenclosed};
  mesh_.ranks().sum(std::span(sums));
  effort_.formulas = sums[0];
  effort_.loads = sums[1];
  effort_.unenclosed = sums[2];
}

template <int dim>
template <int k, int n>
void DiscreteData<dim>::keep(Represented<n>& represented, std::size_t index, bool is_owned,
                             DatumOnSimplex<k, n>&& found)
{
  if (!represented.remainders.empty()) represented.remainders[index] = {found.oscillation, found.mean};
  if (!found.is_subdivided()) return;
#pragma omp critical(tribound_discrete_data)
  {
    effort_.subdivided += is_owned ? 1 : 0;
    effort_.parts += is_owned ? static_cast<std::int64_t>(found.parts.size()) : 0;
    represented.moments.emplace(index, std::move(found.moments));
  }
}

template <int dim>
void DiscreteData<dim>::represent_body_forces(double density)
{
  bool varies = false;
  for (std::size_t r = 0; r < problem_.regions().size(); ++r)
    varies = varies || !problem_.body_force_is_constant(static_cast<int>(r));
  if (!varies) return;
  body_.remainders.resize(mesh_.n_cells());
  parallel_for(
      body_.remainders.size(),
      [&](std::size_t i)
      {
        const auto c = static_cast<Index>(i);
        if (problem_.body_force_is_constant(mesh_.region(c))) return;
        const SimplexMap<dim, dim> map = simplex_map(mesh_, c);
        const DatumWeights weights{mesh::cell_diameter(mesh_, c) / 3, size_ / std::sqrt(map.measure)};
        keep(body_, i, c < mesh_.n_owned_cells(),
             cell_moments_(body_datum(problem_, mesh_, c), map, weights, density * std::sqrt(map.measure),
                           max_parts_));
      });
}

template <int dim>
void DiscreteData<dim>::represent_tractions(double density)
{
  const std::span<const mesh::BoundaryFacet> facets = mesh_.boundary();
  if (std::ranges::all_of(facets, [this](const mesh::BoundaryFacet& facet)
                          { return traction_datum(problem_, mesh_, facet).degree() == 0; }))
    return;
  traction_.remainders.resize(facets.size());
  parallel_for(facets.size(),
               [&](std::size_t i)
               {
                 const Datum<dim> datum = traction_datum(problem_, mesh_, facets[i]);
                 if (datum.degree() == 0) return;
                 const SimplexMap<dim - 1, dim> map = simplex_map(mesh_, facets[i]);
                 const DatumWeights weights{std::sqrt(mesh::cell_diameter(mesh_, facets[i].cell)),
                                            size_ / std::sqrt(simplex_map(mesh_, facets[i].cell).measure)};
                 keep(traction_, i, i < mesh_.n_owned_boundary(),
                      facet_moments_(datum, map, weights, density * std::sqrt(map.measure), max_parts_));
               });
}

template <int dim>
void DiscreteData<dim>::represent_initial_stress(double density)
{
  initial_stress_ = std::make_shared<const InitialStress<dim>>(problem_, mesh_, degree_, density, max_parts_);
  effort_.subdivided += initial_stress_->subdivided();
  effort_.parts += initial_stress_->parts();
}

template <int dim>
void DiscreteData<dim>::represent_contact(Segments segments, double density)
{
  contact_density_ = density;
  parallel_for(segments.size(),
               [&](std::size_t k)
               {
                 const ContactSegment<dim>& segment = segments[k];
                 const Datum<dim, 3> datum = contact_datum(segment);
                 if (datum.terms.empty()) return;
                 const SimplexMap<dim - 1, dim> map = simplex_map(mesh_, segment.slave);
                 DatumOnSimplex<dim - 1, 3> found = contact_moments_(
                     datum, map, {std::sqrt(segment.h), 0}, density * std::sqrt(map.measure), max_parts_);
                 for (auto& moment : found.moments) moment[0] /= segment.gamma;
                 if (segment.contact->gap && found.is_subdivided())
                   limit_gap<dim>(contact_moments_, smallest_gap<dim>(*segment.contact->gap, map, found),
                                  found.moments);
                 for (auto& part : found.parts) part.remainder[0] /= segment.gamma;
                 check_signs(segment, found);
                 if (datum.degree() > degree_ + 2)
                 {
                   std::vector<ContactDatumPart<dim>> parts;
                   for (const auto& part : found.parts)
                     parts.push_back({part.part, part.remainder[0], part.remainder[1], part.remainder[2]});
#pragma omp critical(tribound_discrete_data)
                   contact_parts_.emplace(k, std::move(parts));
                 }
                 keep(contact_, k, is_owned(mesh_, segment), std::move(found));
               });
}

/// Throws if the strength or the water pressure is negative at a point of a rule.
template <int dim>
void DiscreteData<dim>::check_signs(const ContactSegment<dim>& segment,
                                    const DatumOnSimplex<dim - 1, 3>& found) const
{
  const SimplexMap<dim - 1, dim> map = simplex_map(mesh_, segment.slave);
  for (const auto& part : found.parts)
    for (int q = 0; q < facet_rule().size(); ++q)
    {
      if (part.values[q][1] >= 0 && part.values[q][2] >= 0) continue;
      const Point<dim> x = map(fem::point_in<dim - 1>(part.part, facet_rule().points[q]));
      (void)problem::strength_at<dim>(segment.contact->law, x);
      (void)problem::water_at<dim>(*segment.contact, x);
    }
}

template <int dim>
void DiscreteData<dim>::body_force(Index cell, std::span<Point<dim>> values) const
{
  if (const auto found = body_.moments.find(cell); found != body_.moments.end())
  {
    cell_moments_.evaluate(found->second, values);
    return;
  }
  const Datum<dim> datum = body_datum(problem_, mesh_, cell);
  const SimplexMap<dim, dim> map = simplex_map(mesh_, cell);
  for (int q = 0; q < cell_rule().size(); ++q) values[q] = datum(map(cell_rule().points[q]));
}

template <int dim>
std::vector<Point<dim>> DiscreteData<dim>::body_polynomial(Index cell) const
{
  const int degree = problem_.body_force_is_constant(mesh_.region(cell)) ? 0 : degree_ + 6;
  std::vector<Point<dim>> values(cell_rule().size());
  body_force(cell, values);
  std::vector<double> theta(fem::polynomial_dimension(dim, degree));
  std::vector<Point<dim>> coefficients(theta.size(), Point<dim>::Zero());
  for (int q = 0; q < cell_rule().size(); ++q)
  {
    fem::orthonormal_values<dim>(degree, cell_rule().points[q], theta);
    for (std::size_t j = 0; j < theta.size(); ++j)
      coefficients[j] += cell_rule().weights[q] * theta[j] * values[q];
  }
  return coefficients;
}

template <int dim>
void DiscreteData<dim>::traction(std::size_t facet, std::span<Point<dim>> values) const
{
  if (const auto found = traction_.moments.find(facet); found != traction_.moments.end())
  {
    facet_moments_.evaluate(found->second, values);
    return;
  }
  const Datum<dim> datum = traction_datum(problem_, mesh_, mesh_.boundary()[facet]);
  const SimplexMap<dim - 1, dim> map = simplex_map(mesh_, mesh_.boundary()[facet]);
  for (int q = 0; q < facet_rule().size(); ++q) values[q] = datum(map(facet_rule().points[q]));
}

template <int dim>
ContactData DiscreteData<dim>::contact(const ContactSegment<dim>& segment, std::size_t k,
                                       const Point<dim - 1>& s) const
{
  const Point<dim> x = simplex_map(mesh_, segment.slave)(s);
  const auto gap = [&] { return segment.gap(s, x, segment.normal_at(x)); };
  const auto found = contact_.moments.find(k);
  if (found == contact_.moments.end())
    return {gap(), problem::strength_at<dim>(segment.contact->law, x),
            problem::water_at<dim>(*segment.contact, x)};
  const Point<3> polynomial = contact_moments_.evaluate(found->second, s);
  // It overshoots at a jump: thresholds are cut to nonnegative values, but water keeps the moments of a load.
  return {segment.contact->gap ? polynomial[0] : gap(), std::max(polynomial[1], 0.0), polynomial[2]};
}

template <int dim>
std::span<const ContactDatumPart<dim>> DiscreteData<dim>::contact_parts(std::size_t segment) const
{
  const auto found = contact_parts_.find(segment);
  return found == contact_parts_.end() ? std::span<const ContactDatumPart<dim>>() : found->second;
}

template int data_exactness(const problem::Problem<2>&, int);
template int data_exactness(const problem::Problem<3>&, int);
template class DiscreteData<2>;
template class DiscreteData<3>;

}  // namespace tribound::contact
