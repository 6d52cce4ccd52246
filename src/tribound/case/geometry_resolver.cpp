#include "tribound/case/geometry_resolver.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "tribound/case/quadratic_geometry.h"
#include "tribound/case/surface_points.h"
#include "tribound/problem/surface.h"

namespace tribound::case_file
{

namespace
{

using Kind = SurfaceConfig::Kind;
using Normal = GeometryConfig::Normal;

template <int dim>
void check_length(const std::vector<double>& vector, const SurfaceConfig& surface)
{
  if (vector.size() != dim)
    throw InputError(surface.kind_where,
                     fmt::format("has {} coordinates, but the mesh is {}D", vector.size(), dim),
                     fmt::format("give {}", dim));
}

template <int dim>
void check_dimension(const SurfaceConfig& surface)
{
  const auto fail = [&](std::string_view what, std::string_view hint)
  { throw InputError(surface.kind_where, fmt::format("a {} in a {}D case", what, dim), std::string(hint)); };
  if (dim == 3 && surface.kind == Kind::circle) fail("circle", "a sphere or a cylinder");
  if (dim == 2 && surface.kind == Kind::sphere) fail("sphere", "a circle");
  if (dim == 2 && surface.kind == Kind::cylinder) fail("cylinder", "a circle");
  if (dim == 2 && surface.kind == Kind::surface) fail("surface", "a plane, a circle or a distance");
  if (surface.kind == Kind::distance)
  {
    if (dim == 2 && problem::Field(surface.distance, surface.kind_where).uses_z())
      throw InputError(surface.kind_where, "uses z in a 2D case", "only x and y vary");
  }
  else if (surface.kind != Kind::surface && surface.kind != Kind::mesh)
    check_length<dim>(surface.point, surface);
  if (!surface.direction.empty()) check_length<dim>(surface.direction, surface);
  if (!surface.translate.empty() && surface.translate.size() != dim)
    throw InputError(
        surface.where,
        fmt::format("translate has {} components, but the mesh is {}D", surface.translate.size(), dim),
        fmt::format("give {}", dim));
}

/// phi > 0 where the body is, for an obstacle; outside of the body, for a shape.
template <int dim>
problem::Surface make_surface(const SurfaceConfig& config, bool is_obstacle)
{
  check_dimension<dim>(config);
  const problem::Positive side =
      config.inside == is_obstacle ? problem::Positive::inside : problem::Positive::outside;
  problem::Surface surface;
  switch (config.kind)
  {
    case Kind::plane:
      surface = problem::plane(config.point, config.direction);
      break;
    case Kind::circle:
    case Kind::sphere:
      surface = problem::sphere(config.point, config.radius, side);
      break;
    case Kind::cylinder:
      surface = problem::cylinder(config.point, config.direction, config.radius, side);
      break;
    case Kind::distance:
      surface = problem::implicit(config.distance, dim, config.kind_where);
      break;
    case Kind::surface:  // they have no formulas
    case Kind::mesh:
      break;
  }
  return config.translate.empty() ? surface : problem::moved(surface, config.translate, config.kind_where);
}

/// The same of any surface in space.
SurfacePoints make_points(const SurfaceConfig& config, bool is_obstacle)
{
  using Side = SurfaceConfig::Side;
  if (config.kind != Kind::surface) return points_of(make_surface<3>(config, is_obstacle), config.kind_where);
  check_dimension<3>(config);
  auto triangles =
      std::make_shared<const mesh::TriangulatedSurface>(mesh::read_stl(config.file, config.kind_where));
  const bool of_open = config.side == Side::front || config.side == Side::back;
  if (triangles->is_closed() == of_open)
    throw InputError(
        config.kind_where,
        of_open ? "the surface is closed" : "the surface is open: it has edges with one triangle",
        of_open ? "side = \"outside\" or \"inside\", where the body is"
                : "close it, or side = \"front\" if the body is where the normals of the triangles "
                  "point to, \"back\" otherwise");
  const bool along_normals = config.side == Side::outside || config.side == Side::front;
  const Point<3> shift =
      config.translate.empty() ? Point<3>(Point<3>::Zero()) : Point<3>(config.translate.data());
  return points_of(std::move(triangles), along_normals == is_obstacle ? 1.0 : -1.0, shift);
}

const SurfaceConfig& named(const std::vector<SurfaceConfig>& surfaces, const std::string& name)
{
  return *std::ranges::find(surfaces, name, &SurfaceConfig::name);
}

/// In words, for the certificate.
std::string words(const GeometryConfig& geometry)
{
  std::string text;
  const auto add = [&](std::string_view what, const std::string& name)
  {
    if (!name.empty()) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", what, name);
  };
  add("obstacle", geometry.obstacle);
  add("shape", geometry.shape);
  if (geometry.master_shape != geometry.shape) add("shape of the master", geometry.master_shape);
  return text;
}

template <int dim>
void check_direction(const GeometryConfig& geometry)
{
  if (geometry.direction.size() != dim)
    throw InputError(geometry.normal_where,
                     fmt::format("has {} components, but the mesh is {}D", geometry.direction.size(), dim),
                     fmt::format("give {}", dim));
  for (const std::string& component : geometry.direction)
    if (dim == 2 && problem::Field(component, geometry.normal_where).uses_z())
      throw InputError(geometry.normal_where, "uses z in a 2D case", "only x and y vary");
}

problem::Field distance_of_shape(const problem::ContactGeometry& geometry)
{
  return {geometry.shape->distance, geometry.where};
}

/// Gap and direction from `surfaces`, by formulas or points.
template <int dim, class Geometry>
void apply(const GeometryConfig& config, const Geometry& surfaces, problem::Contact& contact)
{
  if (surfaces.shape) contact.true_surface = distance_of_shape(surfaces);
  const bool both = !config.shape.empty() && !config.master_shape.empty();
  const bool on_one_surface = both && config.shape == config.master_shape;
  if (on_one_surface)
    contact.gap = problem::Field(0.0, config.where);
  else if (!config.obstacle.empty() || both)
    contact.gap = gap_of(surfaces);

  Normal normal = config.normal;
  if (normal == Normal::standard)
    normal = surfaces.obstacle ? Normal::obstacle : surfaces.shape ? Normal::shape : Normal::facet;
  if (normal == Normal::obstacle && on_one_surface) normal = Normal::shape;
  if (normal == Normal::obstacle)
    contact.normal = direction_of_obstacle(surfaces);
  else if (normal == Normal::shape)
    contact.normal = direction_of_shape(surfaces);
  else if (normal == Normal::given)
  {
    check_direction<dim>(config);
    contact.normal = problem::direction_along(config.direction, config.normal_where);
  }
}

/// The surfaces of a contact: make(surface, whether it is an obstacle). A master is to its slave what an
/// obstacle is, with the same normal.
template <class Geometry, class Make>
Geometry gather(const Config& config, const GeometryConfig& geometry, const Make& make)
{
  Geometry surfaces{.where = geometry.where};
  if (!geometry.obstacle.empty()) surfaces.obstacle = make(named(config.obstacles, geometry.obstacle), true);
  if (!geometry.shape.empty()) surfaces.shape = make(named(config.shapes, geometry.shape), false);
  if (!geometry.master_shape.empty())
    surfaces.obstacle = make(named(config.shapes, geometry.master_shape), false);
  return surfaces;
}

/// Whether one of the surfaces is of the kind.
bool has_kind(const Config& config, const GeometryConfig& geometry, Kind kind)
{
  const auto is_made_of = [kind](const std::vector<SurfaceConfig>& surfaces, const std::string& name)
  { return !name.empty() && named(surfaces, name).kind == kind; };
  return is_made_of(config.obstacles, geometry.obstacle) || is_made_of(config.shapes, geometry.shape) ||
         is_made_of(config.shapes, geometry.master_shape);
}

/// The shape of the facets of the mesh.
template <int dim>
auto make_quadratic(const SurfaceConfig& shape, const ContactFacets& facets)
{
  if (facets.quadratic == nullptr)
    throw InputError(shape.kind_where, "the mesh has no second-order facets",
                     "a mesh file of order 2 (gmsh -order 2, Mesh.ElementOrder = 2), or the shape as one of "
                     "plane, circle, sphere, cylinder, surface");
  return std::make_shared<const mesh::QuadraticSurface<dim>>(*facets.quadratic, facets.tags,
                                                             shape.kind_where);
}

/// The same with the shape of the mesh and formulas for what it touches.
template <int dim>
void apply_quadratic(const Config& config, const GeometryConfig& geometry, const ContactFacets& facets,
                     problem::Contact& contact)
{
  QuadraticGeometry<dim> surfaces{.shape = make_quadratic<dim>(named(config.shapes, geometry.shape), facets),
                                  .where = geometry.where};
  if (!geometry.obstacle.empty())
    surfaces.obstacle = make_surface<dim>(named(config.obstacles, geometry.obstacle), true);
  else if (!geometry.master_shape.empty() && geometry.master_shape != geometry.shape)
    surfaces.obstacle = make_surface<dim>(named(config.shapes, geometry.master_shape), false);
  apply<dim>(geometry, surfaces, contact);
}

/// A master with a shape of its own needs distances from it.
void check_master(const Config& config, const GeometryConfig& geometry)
{
  if (geometry.master_shape.empty() || geometry.master_shape == geometry.shape) return;
  if (named(config.shapes, geometry.master_shape).kind != Kind::mesh) return;
  throw InputError(
      geometry.master_shape_where,
      fmt::format("\"{}\" cannot be the shape of the master alone: the gap is the distance of other points "
                  "from it, and second-order facets only say where their own points are",
                  geometry.master_shape),
      "exchange slave and master, or give the master's shape as one of plane, circle, sphere, cylinder, "
      "surface");
}

}  // namespace

template <int dim>
void apply_geometry(const Config& config, const GeometryConfig& geometry, const ContactFacets& facets,
                    problem::Contact& contact)
{
  contact.geometry = words(geometry);
  check_master(config, geometry);
  if constexpr (dim == 3)
    if (has_kind(config, geometry, Kind::surface))
    {
      const auto make = [&](const SurfaceConfig& surface, bool is_obstacle)
      {
        return surface.kind == Kind::mesh ? points_of(make_quadratic<3>(surface, facets))
                                          : make_points(surface, is_obstacle);
      };
      return apply<3>(geometry, gather<PointGeometry>(config, geometry, make), contact);
    }
  if (has_kind(config, geometry, Kind::mesh)) return apply_quadratic<dim>(config, geometry, facets, contact);
  apply<dim>(geometry, gather<problem::ContactGeometry>(config, geometry, make_surface<dim>), contact);
}

template void apply_geometry<2>(const Config&, const GeometryConfig&, const ContactFacets&,
                                problem::Contact&);
template void apply_geometry<3>(const Config&, const GeometryConfig&, const ContactFacets&,
                                problem::Contact&);

}  // namespace tribound::case_file
