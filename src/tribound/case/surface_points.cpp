#include "tribound/case/surface_points.h"

#include <utility>
#include <vector>

namespace tribound::case_file
{

namespace
{

template <class Function>
problem::Field field_of(Function function, const Where& where)
{
  problem::FieldFunction field;
  field.values =
      [function = std::move(function)](std::span<const double> x, int dim, std::span<double> values)
  {
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = function(Point<3>(x.subspan(i * dim, 3).data()));
  };
  return problem::Field(std::move(field), where);
}

/// The components of a vector function.
template <class Function>
problem::NormalField direction_of(const Function& function, const Where& where)
{
  std::vector<problem::Field> components;
  components.reserve(3);
  for (int i = 0; i < 3; ++i)
    components.push_back(field_of([=](const Point<3>& x) { return function(x)[i]; }, where));
  return problem::NormalField(std::move(components));
}

std::vector<problem::Field> fields(const std::vector<std::string>& texts, const Where& where)
{
  std::vector<problem::Field> result;
  result.reserve(texts.size());
  for (const std::string& text : texts) result.emplace_back(text, where, "a surface");
  return result;
}

Point<3> at(const std::vector<problem::Field>& components, const Point<3>& x)
{
  return {components[0](x), components[1](x), components[2](x)};
}

Point<3> on_shape(const PointGeometry& geometry, const Point<3>& x)
{
  return geometry.shape ? geometry.shape->closest(x) : x;
}

}  // namespace

SurfacePoints points_of(const problem::Surface& surface, const Where& where)
{
  const auto vector_of = [](std::vector<problem::Field> components)
  { return [components = std::move(components)](const Point<3>& x) { return at(components, x); }; };
  return {.distance = [distance = problem::Field(surface.distance, where)](const Point<3>& x)
          { return distance(x); },
          .normal = vector_of(fields(surface.normal, where)),
          .closest = vector_of(fields(surface.closest, where))};
}

SurfacePoints points_of(std::shared_ptr<const mesh::TriangulatedSurface> triangles, double sign,
                        const Point<3>& shift)
{
  const auto nearest = [triangles = std::move(triangles), shift](const Point<3>& x)
  { return triangles->nearest(x - shift); };
  return {.distance = [nearest, sign](const Point<3>& x) { return sign * nearest(x).distance; },
          .normal = [nearest, sign](const Point<3>& x) -> Point<3> { return sign * nearest(x).normal; },
          .closest = [nearest, shift](const Point<3>& x) -> Point<3> { return nearest(x).point + shift; }};
}

SurfacePoints points_of(const std::shared_ptr<const mesh::QuadraticSurface<3>>& shape)
{
  const auto closest = [shape](const Point<3>& x)
  { return shape->value(mesh::QuadraticSurface<3>::Nodal::point, x); };
  return {.distance = [shape, closest](const Point<3>& x) { return (x - closest(x)).dot(shape->normal(x)); },
          .normal = [shape](const Point<3>& x) { return shape->normal(x); },
          .closest = closest};
}

problem::Field gap_of(const PointGeometry& geometry)
{
  return field_of([geometry](const Point<3>& x)
                  { return geometry.obstacle->distance(on_shape(geometry, x)); },
                  geometry.where);
}

problem::NormalField direction_of_obstacle(const PointGeometry& geometry)
{
  return direction_of([geometry](const Point<3>& x) -> Point<3>
                      { return -geometry.obstacle->normal(on_shape(geometry, x)); },
                      geometry.where);
}

problem::NormalField direction_of_shape(const PointGeometry& geometry)
{
  return direction_of([geometry](const Point<3>& x) -> Point<3> { return geometry.shape->normal(x); },
                      geometry.where);
}

problem::Field distance_of_shape(const PointGeometry& geometry)
{
  return field_of([geometry](const Point<3>& x) { return geometry.shape->distance(x); }, geometry.where);
}

}  // namespace tribound::case_file
