#include "tribound/case/quadratic_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <string>
#include <utility>
#include <vector>

#include "tribound/problem/formula.h"

namespace tribound::case_file
{

namespace
{

template <int dim>
using Surface = mesh::QuadraticSurface<dim>;

/// The formula at X(x), or at n(x).
template <int dim>
problem::Field composed(const std::string& text, typename Surface<dim>::Nodal what,
                        std::shared_ptr<const Surface<dim>> surface, const Where& where)
{
  problem::Field plain(text, where);
  if (plain.is_constant()) return plain;
  const problem::Formula formula(text, where);
  problem::FieldFunction field;
  // The degree holds on each facet, and no integral extends over more than one.
  if (formula.degree() != problem::Formula::not_polynomial) field.degree = 2 * formula.degree();
  field.values =
      [formula, what, surface](std::span<const double> x, [[maybe_unused]] int d, std::span<double> values)
  {
    assert(d == dim);
    std::vector<double> at(x.size());
    for (std::size_t i = 0; i < x.size(); i += dim)
      std::ranges::copy(surface->value(what, Point<dim>(&x[i])), at.begin() + static_cast<std::ptrdiff_t>(i));
    formula.evaluate(at, dim, values);
  };
  field.enclose = [formula, what, surface = std::move(surface)](std::span<const double> vertices, int,
                                                                std::span<problem::Enclosure> coefficients)
  { formula.enclose_composed(surface->enclose(what, vertices), coefficients); };
  return problem::Field(std::move(field), where);
}

}  // namespace

template <int dim>
problem::Field gap_of(const QuadraticGeometry<dim>& geometry)
{
  return composed<dim>(geometry.obstacle->distance, Surface<dim>::Nodal::point, geometry.shape,
                       geometry.where);
}

template <int dim>
problem::NormalField direction_of_obstacle(const QuadraticGeometry<dim>& geometry)
{
  std::vector<problem::Field> components;
  components.reserve(dim);
  for (const std::string& n : geometry.obstacle->normal)
    components.push_back(
        composed<dim>(fmt::format("(-{})", n), Surface<dim>::Nodal::point, geometry.shape, geometry.where));
  return problem::NormalField(std::move(components));
}

template <int dim>
problem::NormalField direction_of_shape(const QuadraticGeometry<dim>& geometry)
{
  constexpr const char* length = dim == 2 ? "sqrt(x^2+y^2)" : "sqrt(x^2+y^2+z^2)";
  constexpr std::array names = {'x', 'y', 'z'};
  std::vector<problem::Field> components;
  components.reserve(dim);
  for (int i = 0; i < dim; ++i)
    components.push_back(composed<dim>(fmt::format("{}/{}", names[i], length), Surface<dim>::Nodal::normal,
                                       geometry.shape, geometry.where));
  return problem::NormalField(std::move(components));
}

template <int dim>
problem::Field distance_of_shape(const QuadraticGeometry<dim>& geometry)
{
  problem::FieldFunction field;
  field.values = [shape = geometry.shape](std::span<const double> x, int, std::span<double> values)
  {
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      const Point<dim> at(&x[i * dim]);
      values[i] = (at - shape->value(Surface<dim>::Nodal::point, at)).dot(shape->normal(at));
    }
  };
  return problem::Field(std::move(field), geometry.where);
}

template problem::Field gap_of(const QuadraticGeometry<2>&);
template problem::Field gap_of(const QuadraticGeometry<3>&);
template problem::NormalField direction_of_obstacle(const QuadraticGeometry<2>&);
template problem::NormalField direction_of_obstacle(const QuadraticGeometry<3>&);
template problem::NormalField direction_of_shape(const QuadraticGeometry<2>&);
template problem::NormalField direction_of_shape(const QuadraticGeometry<3>&);
template problem::Field distance_of_shape(const QuadraticGeometry<2>&);
template problem::Field distance_of_shape(const QuadraticGeometry<3>&);

}  // namespace tribound::case_file
