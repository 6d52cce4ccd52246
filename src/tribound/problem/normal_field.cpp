#include "tribound/problem/normal_field.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "tribound/base/error.h"
#include "tribound/problem/formula.h"

namespace tribound::problem
{

NormalField::NormalField(std::vector<Field> components) : components_(std::move(components)) {}

template <int dim>
Point<dim> NormalField::operator()(const Point<dim>& x) const
{
  assert(components_.size() == dim);
  Point<dim> n;
  for (int i = 0; i < dim; ++i) n[i] = components_[i](x);
  return checked<dim>(n, x);
}

template <int dim>
void NormalField::evaluate(std::span<const Point<dim>> x, std::span<Point<dim>> n) const
{
  assert(components_.size() == dim && x.size() == n.size());
  std::vector<double> values(x.size());
  for (int i = 0; i < dim; ++i)
  {
    components_[i].evaluate<dim>(x, values);
    for (std::size_t q = 0; q < n.size(); ++q) n[q][i] = values[q];
  }
  for (std::size_t q = 0; q < n.size(); ++q) n[q] = checked<dim>(n[q], x[q]);
}

template <int dim>
Point<dim> NormalField::checked(const Point<dim>& n, const Point<dim>& x) const
{
  constexpr double rounding = 1e-12;  // of a formula that divides a vector by its length
  const double length = n.norm();
  if (std::abs(length - 1) > rounding)
    throw InputError(components_[0].where(),
                     fmt::format("the direction of contact has the length {:.9g} at the point ({:.9g})",
                                 length, fmt::join(x.data(), x.data() + dim, ", ")),
                     "divide it by its length");
  return n / length;
}

bool NormalField::is_constant() const
{
  return std::ranges::all_of(components_, &Field::is_constant);
}

bool NormalField::is_enclosed() const
{
  return std::ranges::all_of(components_, &Field::is_enclosed);
}

NormalDeviation deviation(const NormalField& normal, std::span<const double> vertices, int dim)
{
  NormalDeviation sum;  // of squares
  for (const Field& component : normal.components())
  {
    if (!component.is_enclosed()) continue;
    std::array<Enclosure, 4> taylor;
    component.enclose(vertices, dim, taylor);
    const double degree_1 = distance_from_polynomials(taylor, 2);
    const double degree_2 = std::min(degree_1, taylor[3].magnitude());
    sum.linear += degree_1 * degree_1;
    sum.quadratic += degree_2 * degree_2;
  }
  return {std::min(1.0, std::sqrt(sum.linear)), std::min(1.0, std::sqrt(sum.quadratic))};
}

template Point<2> NormalField::operator()(const Point<2>&) const;
template Point<3> NormalField::operator()(const Point<3>&) const;
template void NormalField::evaluate<2>(std::span<const Point<2>>, std::span<Point<2>>) const;
template void NormalField::evaluate<3>(std::span<const Point<3>>, std::span<Point<3>>) const;

}  // namespace tribound::problem
