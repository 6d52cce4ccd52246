#include "tribound/case/geometry_resolver.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "tribound/case/dimension.h"
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
void check_vector(const std::vector<double>& vector, const SurfaceConfig& surface)
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
    check_vector<dim>(surface.point, surface);
  if (!surface.direction.empty()) check_vector<dim>(surface.direction, surface);
  if (!surface.translate.empty() && surface.translate.size() != dim)
    throw InputError(
        surface.where,
        fmt::format("translate has {} components, but the mesh is {}D", surface.translate.size(), dim),
        fmt::format("give {}", dim));
}

/// For an obstacle, phi > 0 on the side of the body; for a shape, phi > 0 outside the body.
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
    case Kind::surface:  // these have no formulas
    case Kind::mesh:
      break;
  }
  return config.translate.empty() ? surface : problem::moved(surface, config.translate, config.kind_where);
}

/// Triangles from a file.
SurfacePoints<3> make_triangles(const SurfaceConfig& config, bool is_obstacle)
{
  using Side = SurfaceConfig::Side;
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

/// The same for any surface except facets of the mesh.
template <int dim>
SurfacePoints<dim> make_points(const SurfaceConfig& config, bool is_obstacle)
{
  if constexpr (dim == 3)
    if (config.kind == Kind::surface) return make_triangles(config, is_obstacle);
  return points_of<dim>(make_surface<dim>(config, is_obstacle), config.kind_where);
}

const SurfaceConfig& named(const std::vector<SurfaceConfig>& surfaces, const std::string& name)
{
  return *std::ranges::find(surfaces, name, &SurfaceConfig::name);
}

/// A description for the certificate.
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
  check_length<dim>(geometry.direction.size(), geometry.normal_where);
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

enum class Role
{
  obstacle,
  slave,  ///< or the body on an obstacle
  master
};

/// The surfaces of a contact: make(surface, role). A master is to its slave like an obstacle, with the same
/// normal.
template <class Geometry, class Make>
Geometry gather(const Config& config, const GeometryConfig& geometry, const Make& make)
{
  Geometry surfaces{.where = geometry.where};
  if (!geometry.obstacle.empty())
    surfaces.obstacle = make(named(config.obstacles, geometry.obstacle), Role::obstacle);
  if (!geometry.shape.empty()) surfaces.shape = make(named(config.shapes, geometry.shape), Role::slave);
  if (!geometry.master_shape.empty())
    surfaces.obstacle = make(named(config.shapes, geometry.master_shape), Role::master);
  return surfaces;
}

bool is_of_kind(const std::vector<SurfaceConfig>& surfaces, const std::string& name, Kind kind)
{
  return !name.empty() && named(surfaces, name).kind == kind;
}

/// Whether distances from one of the surfaces have no formula.
bool needs_points(const Config& config, const GeometryConfig& geometry)
{
  return is_of_kind(config.obstacles, geometry.obstacle, Kind::surface) ||
         is_of_kind(config.shapes, geometry.shape, Kind::surface) ||
         is_of_kind(config.shapes, geometry.master_shape, Kind::surface) ||
         (geometry.master_shape != geometry.shape &&
          is_of_kind(config.shapes, geometry.master_shape, Kind::mesh));
}

/// The shape of the facets of the groups `tags`.
template <int dim>
auto make_quadratic(const SurfaceConfig& shape, const mesh::QuadraticFacets* facets,
                    std::span<const int> tags)
{
  if (facets == nullptr || facets->tags.empty())
    throw InputError(shape.kind_where, "the mesh has no second-order facets",
                     "a mesh file of order 2 (Mesh.ElementOrder = 2), or the shape as one of "
                     "plane, circle, sphere, cylinder, surface");
  return std::make_shared<const mesh::QuadraticSurface<dim>>(*facets, tags, shape.kind_where);
}

/// Gap and direction by points.
template <int dim>
void apply_points(const Config& config, const GeometryConfig& geometry, const ContactFacets& facets,
                  problem::Contact& contact)
{
  const auto make = [&](const SurfaceConfig& surface, Role role)
  {
    if (surface.kind != Kind::mesh) return make_points<dim>(surface, role == Role::obstacle);
    if (role == Role::master)
      return points_around<dim>(make_quadratic<dim>(surface, facets.quadratic, facets.master_tags));
    return points_on<dim>(make_quadratic<dim>(surface, facets.quadratic, facets.tags));
  };
  apply<dim>(geometry, gather<PointGeometry<dim>>(config, geometry, make), contact);
}

/// Gap and direction by the shape of the mesh, and formulas for the opposite surface.
template <int dim>
void apply_quadratic(const Config& config, const GeometryConfig& geometry, const ContactFacets& facets,
                     problem::Contact& contact)
{
  QuadraticGeometry<dim> surfaces{
      .shape = make_quadratic<dim>(named(config.shapes, geometry.shape), facets.quadratic, facets.tags),
      .where = geometry.where};
  if (!geometry.obstacle.empty())
    surfaces.obstacle = make_surface<dim>(named(config.obstacles, geometry.obstacle), true);
  else if (!geometry.master_shape.empty() && geometry.master_shape != geometry.shape)
    surfaces.obstacle = make_surface<dim>(named(config.shapes, geometry.master_shape), false);
  apply<dim>(geometry, surfaces, contact);
}

}  // namespace

template <int dim>
void apply_geometry(const Config& config, const GeometryConfig& geometry, const ContactFacets& facets,
                    problem::Contact& contact)
{
  contact.geometry = words(geometry);
  if (needs_points(config, geometry)) return apply_points<dim>(config, geometry, facets, contact);
  if (is_of_kind(config.shapes, geometry.shape, Kind::mesh))
    return apply_quadratic<dim>(config, geometry, facets, contact);
  const auto make = [](const SurfaceConfig& surface, Role role)
  { return make_surface<dim>(surface, role == Role::obstacle); };
  apply<dim>(geometry, gather<problem::ContactGeometry>(config, geometry, make), contact);
}

template void apply_geometry<2>(const Config&, const GeometryConfig&, const ContactFacets&,
                                problem::Contact&);
template void apply_geometry<3>(const Config&, const GeometryConfig&, const ContactFacets&,
                                problem::Contact&);

}  // namespace tribound::case_file
