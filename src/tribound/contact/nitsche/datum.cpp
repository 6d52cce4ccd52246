#include "tribound/contact/nitsche/datum.h"

#include <algorithm>

namespace tribound::contact
{

template <int dim, int n>
std::vector<Point<n>> Datum<dim, n>::operator()(std::span<const Point<dim>> points) const
{
  std::vector<Point<n>> f(points.size(), Point<n>::Zero());
  std::vector<double> values(points.size());
  for (const auto& [value, direction] : terms)
  {
    value->template evaluate<dim>(points, values);
    for (std::size_t i = 0; i < f.size(); ++i) f[i] += values[i] * direction;
  }
  return f;
}

template <int dim, int n>
int Datum<dim, n>::degree() const
{
  int largest = 0;
  for (const Term& term : terms) largest = std::max(largest, term.value->degree());
  return largest;
}

template <int dim, int n>
bool Datum<dim, n>::is_enclosed() const
{
  return std::ranges::all_of(terms, [](const Term& term) { return term.value->is_enclosed(); });
}

template struct Datum<2>;
template struct Datum<2, 1>;
template struct Datum<2, 3>;
template struct Datum<3>;
template struct Datum<3, 1>;
template struct Datum<3, 6>;

}  // namespace tribound::contact
