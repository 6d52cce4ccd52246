#include "tribound/case/surface_points.h"

#include <functional>
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

SurfacePoints::SurfacePoints(const problem::Surface& surface, const Where& where)
    : formulas_(Formulas{problem::Field(surface.distance, where), fields(surface.normal, where),
                         fields(surface.closest, where)})
{
}

SurfacePoints::SurfacePoints(std::shared_ptr<const mesh::TriangulatedSurface> triangles, double sign,
                             Point<3> shift)
    : triangles_(std::move(triangles)), sign_(sign), shift_(std::move(shift))
{
}

double SurfacePoints::distance(const Point<3>& x) const
{
  return formulas_ ? formulas_->distance(x) : sign_ * triangles_->nearest(x - shift_).distance;
}

Point<3> SurfacePoints::normal(const Point<3>& x) const
{
  return formulas_ ? at(formulas_->normal, x) : Point<3>(sign_ * triangles_->nearest(x - shift_).normal);
}

Point<3> SurfacePoints::closest(const Point<3>& x) const
{
  return formulas_ ? at(formulas_->closest, x) : Point<3>(triangles_->nearest(x - shift_).point + shift_);
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
