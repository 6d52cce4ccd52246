#include "tribound/problem/spring.h"

#include <algorithm>
#include <functional>

#include "tribound/base/error.h"
#include "tribound/problem/nonnegative.h"

namespace tribound::problem
{

void refuse_time(const Field& stiffness)
{
  if (stiffness.uses_time())
    throw InputError(stiffness.where(),
                     "contains the load factor t, but the stiffness of a spring does not change",
                     "a stiffness without t; the place of rest may move, such as rest = [0, \"-0.01*t\"]");
}

template <int dim>
Tensor<dim> Spring<dim>::stiffness(const Point<dim>& x, const Point<dim>& n) const
{
  return spring_matrix<dim>(nonnegative_at<dim>(normal, x), nonnegative_at<dim>(tangential, x), n);
}

template <int dim>
int Spring<dim>::stiffness_degree() const
{
  return std::min(most_of_stiffness, std::max(normal.degree(), tangential.degree()));
}

namespace
{

/// Whether each field of a spring is of the degree that it may have, or another condition holds.
template <int dim, class Condition>
bool is_of_degree_or(const Spring<dim>& spring, int degree, const Condition& condition)
{
  const int of_rest = degree - spring.stiffness_degree();
  const auto holds = [&](const Field& field, int most)
  { return field.degree() <= most || std::invoke(condition, field); };
  return holds(spring.normal, most_of_stiffness) && holds(spring.tangential, most_of_stiffness) &&
         std::ranges::all_of(spring.rest, [&](const Field& rest) { return holds(rest, of_rest); });
}

}  // namespace

template <int dim>
bool Spring<dim>::is_polynomial(int degree) const
{
  return is_of_degree_or(*this, degree, [](const Field&) { return false; });
}

template <int dim>
bool Spring<dim>::is_enclosed(int degree) const
{
  return is_of_degree_or(*this, degree, &Field::is_enclosed);
}

template struct Spring<2>;
template struct Spring<3>;

}  // namespace tribound::problem
