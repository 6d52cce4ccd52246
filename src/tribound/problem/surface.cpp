#include "tribound/problem/surface.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "tribound/problem/formula_calculus.h"

namespace tribound::problem
{

namespace
{

constexpr std::array<char, 3> names = {'x', 'y', 'z'};
constexpr const char* direction_name = "the direction of contact";

std::vector<double> unit(std::span<const double> vector)
{
  double square = 0;
  for (const double v : vector) square += v * v;
  std::vector<double> result;
  for (const double v : vector) result.push_back(v / std::sqrt(square));
  return result;
}

/// a.v for formulas v; terms with a_i = 0 are left out.
std::string dot(std::span<const double> a, std::span<const std::string> v)
{
  std::string sum;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i] != 0) sum += fmt::format("{}({})*{}", sum.empty() ? "" : "+", a[i], v[i]);
  return sum.empty() ? "0" : "(" + sum + ")";
}

std::string length(std::span<const std::string> v)
{
  std::vector<std::string> squares;
  for (const std::string& component : v) squares.push_back(component + "^2");
  return fmt::format("sqrt({})", fmt::join(squares, "+"));
}

/// x - point.
std::vector<std::string> from(std::span<const double> point)
{
  std::vector<std::string> result;
  for (std::size_t i = 0; i < point.size(); ++i)
    result.push_back(fmt::format("({}-({}))", names[i], point[i]));
  return result;
}

/// The surface at distance `radius` from the zeros of w, which points away from them.
Surface round(const std::vector<std::string>& w, double radius, Positive side)
{
  const std::string r = length(w);
  const bool outside = side == Positive::outside;
  Surface surface{.distance =
                      outside ? fmt::format("({}-{})", r, radius) : fmt::format("({}-{})", radius, r)};
  for (std::size_t i = 0; i < w.size(); ++i)
  {
    surface.normal.push_back(fmt::format("({}{}/{})", outside ? "" : "-", w[i], r));
    surface.closest.push_back(fmt::format("({}-{}*(1-{}/{}))", names[i], w[i], radius, r));
  }
  return surface;
}

/// The formula at the point of the shape that is nearest to x.
std::string on_shape(const std::string& formula, const ContactGeometry& geometry)
{
  return geometry.shape ? composed(formula, geometry.shape->closest, geometry.where) : formula;
}

std::string minus(const std::string& formula)
{
  return "(-" + formula + ")";
}

}  // namespace

Surface plane(std::span<const double> point, std::span<const double> normal)
{
  const std::vector<double> n = unit(normal);
  Surface surface{.distance = dot(n, from(point))};
  for (std::size_t i = 0; i < n.size(); ++i)
  {
    surface.normal.push_back(fmt::format("({})", n[i]));
    surface.closest.push_back(fmt::format("({}-({})*{})", names[i], n[i], surface.distance));
  }
  return surface;
}

Surface sphere(std::span<const double> centre, double radius, Positive side)
{
  return round(from(centre), radius, side);
}

Surface cylinder(std::span<const double> centre, std::span<const double> axis, double radius, Positive side)
{
  const std::vector<double> a = unit(axis);
  const std::vector<std::string> w = from(centre);
  const std::string along = dot(a, w);
  std::vector<std::string> away;
  for (std::size_t i = 0; i < a.size(); ++i) away.push_back(fmt::format("({}-({})*{})", w[i], a[i], along));
  return round(away, radius, side);
}

Surface implicit(const std::string& formula, int dim, const Where& where)
{
  const std::vector<std::string> derivatives = gradient(formula, dim, where);
  const std::string size = length(derivatives);
  Surface surface{.distance = fmt::format("(({})/{})", formula, size)};
  for (const std::string& derivative : derivatives)
    surface.normal.push_back(fmt::format("({}/{})", derivative, size));
  return surface;
}

Surface moved(const Surface& surface, std::span<const double> by, const Where& where)
{
  const std::vector<std::string> before = from(by);
  Surface result{.distance = composed(surface.distance, before, where)};
  for (const std::string& n : surface.normal) result.normal.push_back(composed(n, before, where));
  for (std::size_t i = 0; i < surface.closest.size(); ++i)
    result.closest.push_back(fmt::format("({}+({}))", composed(surface.closest[i], before, where), by[i]));
  return result;
}

Field gap_of(const ContactGeometry& geometry)
{
  assert(geometry.obstacle);
  return {on_shape(geometry.obstacle->distance, geometry), geometry.where, "the distance from the obstacle"};
}

NormalField direction_of_obstacle(const ContactGeometry& geometry)
{
  assert(geometry.obstacle);
  std::vector<Field> components;
  for (const std::string& n : geometry.obstacle->normal)
    components.emplace_back(minus(on_shape(n, geometry)), geometry.where, direction_name);
  return NormalField(std::move(components));
}

NormalField direction_of_shape(const ContactGeometry& geometry)
{
  assert(geometry.shape);
  std::vector<Field> components;
  for (const std::string& n : geometry.shape->normal)
    components.emplace_back(n, geometry.where, direction_name);
  return NormalField(std::move(components));
}

NormalField direction_along(std::span<const std::string> components, const Where& where)
{
  std::vector<std::string> v;
  for (const std::string& component : components) v.push_back("(" + component + ")");
  const std::string size = length(v);
  std::vector<Field> result;
  result.reserve(v.size());
  for (const std::string& component : v) result.emplace_back(fmt::format("{}/{}", component, size), where);
  return NormalField(std::move(result));
}

}  // namespace tribound::problem
