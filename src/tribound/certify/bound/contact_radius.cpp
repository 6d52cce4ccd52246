/// The contact terms of axisymmetric problems: the weight r, and quotients by it (method section 19.2).

#include <algorithm>

#include "tribound/certify/bound/contact_pieces.h"
#include "tribound/certify/bound/contact_terms.h"
#include "tribound/certify/bound/radial_projection.h"
#include "tribound/fem/meridian_rules.h"

namespace tribound::certify
{

namespace
{

/// The values of r at the ends of a piece of a segment.
template <int dim>
std::array<double, dim> radii(const contact::NitscheForm<dim>& form, int k, const fem::Part<dim - 1>& piece)
{
  const auto map = contact::simplex_map(form.space().mesh(), form.segments()[k].slave);
  std::array<double, dim> result;
  for (int i = 0; i < dim; ++i) result[i] = map(piece[i])[0];
  return result;
}

}  // namespace

template <int dim>
bool ContactTerms<dim>::is_scaled(int k) const
{
  return form_.problem().is_axisymmetric() &&
         std::ranges::min(radii(form_, k, fem::reference_simplex<dim - 1>())) > 0;
}

template <int dim>
auto ContactTerms<dim>::largest_on(int k, const Piece& piece) const -> Largest
{
  if (!form_.problem().is_axisymmetric()) return {};
  const auto [least, largest] = std::ranges::minmax(radii(form_, k, piece));
  if (!is_scaled(k)) return {.weight = largest, .square_weight = largest};
  const int exact = 2 * form_.n_segment_points() - 1;  // Gauss
  return {largest, largest, 1 / least, fem::inverse_radius_error(least, largest, exact - 2 * (degree_ + 2))};
}

/// r Pi_k t is in P^{p+1}; where m = 1, it is divided by r at the points.
template <int dim>
std::vector<Point<dim>> ContactTerms<dim>::weighted_projection(int k, std::span<const Point<dim>> t) const
{
  std::vector<Point<dim>> result(t.begin(), t.end());
  if constexpr (dim == 2)
  {
    RadialProjection<1> projection(degree_);
    const auto points = form_.contact_points(k);
    for (std::size_t q = 0; q < t.size(); ++q)
    {
      projection.add(std::span(theta_).subspan(q * n_, n_), form_.facet_rule().weights[q] * points[q].x[0]);
      result[q] *= points[q].x[0];
    }
    result = coefficients_of(result);
    projection.apply(result);
    if (is_scaled(k)) return result;
    std::vector<Point<dim>> values(t.size(), Point<dim>::Zero());
    for (std::size_t q = 0; q < t.size(); ++q)
      for (int i = 0; i < n_; ++i) values[q] += theta_[q * n_ + i] / points[q].x[0] * result[i];
    result = coefficients_of(values);
  }
  return result;
}

template <int dim>
void ContactTerms<dim>::resolve_radius(int k, std::vector<Part>& parts) const
{
  constexpr double negligible = 1e-12;
  for (std::size_t i = 0; i < parts.size();)
  {
    if (parts.size() >= max_pieces || largest_on(k, parts[i].data.part).missed <= negligible)
    {
      ++i;
      continue;
    }
    const Part whole = parts[i];
    const auto pieces = halves(whole.data.part);
    for (std::size_t j = 0; j < n_halves; ++j)
    {
      Part half{whole.data, on_half(whole.fields, j), {}};
      half.data.part = pieces[j];
      if (j == 0)
        parts[i] = half;
      else
        parts.push_back(half);
    }
  }
}

template bool ContactTerms<2>::is_scaled(int) const;
template auto ContactTerms<2>::largest_on(int, const Piece&) const -> Largest;
template std::vector<Point<2>> ContactTerms<2>::weighted_projection(int, std::span<const Point<2>>) const;
template void ContactTerms<2>::resolve_radius(int, std::vector<Part>&) const;
template bool ContactTerms<3>::is_scaled(int) const;
template auto ContactTerms<3>::largest_on(int, const Piece&) const -> Largest;
template std::vector<Point<3>> ContactTerms<3>::weighted_projection(int, std::span<const Point<3>>) const;
template void ContactTerms<3>::resolve_radius(int, std::vector<Part>&) const;

}  // namespace tribound::certify
