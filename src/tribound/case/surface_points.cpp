#include "tribound/case/surface_points.h"

#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

namespace tribound::case_file
{

namespace
{

template <int dim, class Function>
problem::Field field_of(Function function, const Where& where)
{
  problem::FieldFunction field;
  field.values = [function = std::move(function)](std::span<const double> x, [[maybe_unused]] int d,
                                                  std::span<double> values)
  {
    assert(d == dim);
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = function(Point<dim>(x.subspan(i * dim, dim).data()));
  };
  return problem::Field(std::move(field), where);
}

/// The components of a vector function.
template <int dim, class Function>
problem::NormalField direction_of(const Function& function, const Where& where)
{
  std::vector<problem::Field> components;
  components.reserve(dim);
  for (int i = 0; i < dim; ++i)
    components.push_back(field_of<dim>([=](const Point<dim>& x) { return function(x)[i]; }, where));
  return problem::NormalField(std::move(components));
}

std::vector<problem::Field> fields(const std::vector<std::string>& texts, const Where& where)
{
  std::vector<problem::Field> result;
  result.reserve(texts.size());
  for (const std::string& text : texts) result.emplace_back(text, where, "a surface");
  return result;
}

template <int dim>
Point<dim> at(const std::vector<problem::Field>& components, const Point<dim>& x)
{
  Point<dim> result;
  for (int i = 0; i < dim; ++i) result[i] = components[i](x);
  return result;
}

template <int dim>
Point<dim> on_shape(const PointGeometry<dim>& geometry, const Point<dim>& x)
{
  return geometry.shape ? geometry.shape->closest(x) : x;
}

/// The foot of x. Gap and components of a direction are evaluated in turn, each at the same many points, so
/// every thread caches some feet.
template <int dim>
typename mesh::QuadraticSurface<dim>::Foot foot_of(
    const std::shared_ptr<const mesh::QuadraticSurface<dim>>& shape, const Point<dim>& x)
{
  struct Known
  {
    std::shared_ptr<const mesh::QuadraticSurface<dim>> shape{};  ///< kept alive: keeps its address unique
    Point<dim> x;
    typename mesh::QuadraticSurface<dim>::Foot foot;
  };
  constexpr std::size_t n_known = 1024;
  static thread_local std::vector<Known> known(n_known);
  std::size_t hash = 0;
  for (const double c : x) hash = 31 * hash + std::hash<double>()(c);
  Known& slot = known[hash % n_known];
  if (slot.shape != shape || slot.x != x) slot = {shape, x, shape->foot(x)};
  return slot.foot;
}

}  // namespace

template <int dim>
SurfacePoints<dim> points_of(const problem::Surface& surface, const Where& where)
{
  const auto vector_of = [](std::vector<problem::Field> components)
  { return [components = std::move(components)](const Point<dim>& x) { return at<dim>(components, x); }; };
  return {.distance = [distance = problem::Field(surface.distance, where)](const Point<dim>& x)
          { return distance(x); },
          .normal = vector_of(fields(surface.normal, where)),
          .closest = vector_of(fields(surface.closest, where))};
}

SurfacePoints<3> points_of(std::shared_ptr<const mesh::TriangulatedSurface> triangles, double sign,
                           const Point<3>& shift)
{
  const auto nearest = [triangles = std::move(triangles), shift](const Point<3>& x)
  { return triangles->nearest(x - shift); };
  return {.distance = [nearest, sign](const Point<3>& x) { return sign * nearest(x).distance; },
          .normal = [nearest, sign](const Point<3>& x) -> Point<3> { return sign * nearest(x).normal; },
          .closest = [nearest, shift](const Point<3>& x) -> Point<3> { return nearest(x).point + shift; }};
}

template <int dim>
SurfacePoints<dim> points_on(const std::shared_ptr<const mesh::QuadraticSurface<dim>>& shape)
{
  const auto closest = [shape](const Point<dim>& x)
  { return shape->value(mesh::QuadraticSurface<dim>::Nodal::point, x); };
  return {
      .distance = [shape, closest](const Point<dim>& x) { return (x - closest(x)).dot(shape->normal(x)); },
      .normal = [shape](const Point<dim>& x) { return shape->normal(x); },
      .closest = closest};
}

template <int dim>
SurfacePoints<dim> points_around(const std::shared_ptr<const mesh::QuadraticSurface<dim>>& shape)
{
  return {.distance = [shape](const Point<dim>& x) { return foot_of<dim>(shape, x).distance; },
          .normal = [shape](const Point<dim>& x) { return foot_of<dim>(shape, x).normal; },
          .closest = [shape](const Point<dim>& x) { return foot_of<dim>(shape, x).point; }};
}

template <int dim>
problem::Field gap_of(const PointGeometry<dim>& geometry)
{
  return field_of<dim>([geometry](const Point<dim>& x)
                       { return geometry.obstacle->distance(on_shape(geometry, x)); },
                       geometry.where);
}

template <int dim>
problem::NormalField direction_of_obstacle(const PointGeometry<dim>& geometry)
{
  return direction_of<dim>([geometry](const Point<dim>& x) -> Point<dim>
                           { return -geometry.obstacle->normal(on_shape(geometry, x)); },
                           geometry.where);
}

template <int dim>
problem::NormalField direction_of_shape(const PointGeometry<dim>& geometry)
{
  return direction_of<dim>(
      [geometry](const Point<dim>& x) -> Point<dim> { return geometry.shape->normal(x); }, geometry.where);
}

template <int dim>
problem::Field distance_of_shape(const PointGeometry<dim>& geometry)
{
  return field_of<dim>([geometry](const Point<dim>& x) { return geometry.shape->distance(x); },
                       geometry.where);
}

template SurfacePoints<2> points_of(const problem::Surface&, const Where&);
template SurfacePoints<2> points_on(const std::shared_ptr<const mesh::QuadraticSurface<2>>&);
template SurfacePoints<2> points_around(const std::shared_ptr<const mesh::QuadraticSurface<2>>&);
template problem::Field gap_of(const PointGeometry<2>&);
template problem::NormalField direction_of_obstacle(const PointGeometry<2>&);
template problem::NormalField direction_of_shape(const PointGeometry<2>&);
template problem::Field distance_of_shape(const PointGeometry<2>&);
template SurfacePoints<3> points_of(const problem::Surface&, const Where&);
template SurfacePoints<3> points_on(const std::shared_ptr<const mesh::QuadraticSurface<3>>&);
template SurfacePoints<3> points_around(const std::shared_ptr<const mesh::QuadraticSurface<3>>&);
template problem::Field gap_of(const PointGeometry<3>&);
template problem::NormalField direction_of_obstacle(const PointGeometry<3>&);
template problem::NormalField direction_of_shape(const PointGeometry<3>&);
template problem::Field distance_of_shape(const PointGeometry<3>&);

}  // namespace tribound::case_file
