#include "tribound/contact/nitsche/datum.h"

#include <algorithm>

namespace tribound::contact
{

template <int dim, int n>
Point<n> Datum<dim, n>::operator()(const Point<dim>& x) const
{
  Point<n> f = Point<n>::Zero();
  for (const auto& [value, direction] : terms) f += (*value)(x)*direction;
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
template struct Datum<2, 3>;
template struct Datum<3>;
template struct Datum<3, 6>;

}  // namespace tribound::contact
