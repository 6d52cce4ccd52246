#include "tribound/case/geometry_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

namespace tribound::case_file
{

namespace
{

using Kind = SurfaceConfig::Kind;

/// A key that says what a surface is.
struct KindKey
{
  std::string_view key;
  Kind kind;
};
constexpr std::array kind_keys = {KindKey{"plane", Kind::plane},       KindKey{"circle", Kind::circle},
                                  KindKey{"sphere", Kind::sphere},     KindKey{"cylinder", Kind::cylinder},
                                  KindKey{"distance", Kind::distance}, KindKey{"surface", Kind::surface},
                                  KindKey{"mesh", Kind::mesh}};

/// Whether an obstacle, or a shape, may be given so.
bool may_be(Kind kind, bool is_obstacle)
{
  return kind != (is_obstacle ? Kind::mesh : Kind::distance);
}

constexpr auto point_hint = "one number per dimension, such as [0, -1]";

std::vector<double> read_point(const Node& node)
{
  return to_numbers(node, point_hint);
}

std::vector<double> read_vector(const Node& node)
{
  return to_vector(node, point_hint, "a direction, such as [0, 1]");
}

void read_plane(const Node& node, SurfaceConfig& surface)
{
  const TableReader table(node, {"point", "normal"});
  surface.point = read_point(table.require("point", "a point of the plane: point = [0, 0]"));
  surface.direction = read_vector(
      table.require("normal", "the direction out of the obstacle, or out of the body: normal = [0, 1]"));
}

void read_round(const Node& node, SurfaceConfig& surface)
{
  const bool has_axis = surface.kind == Kind::cylinder;
  const TableReader table(
      node, has_axis ? std::initializer_list<std::string_view>{"centre", "axis", "radius", "inside"}
                     : std::initializer_list<std::string_view>{"centre", "radius", "inside"});
  surface.point = read_point(table.require(
      "centre", has_axis ? "a point of the axis: centre = [0, 0, 1]" : "its centre: centre = [0, 1]"));
  if (has_axis)
    surface.direction = read_vector(table.require("axis", "the direction of its axis: axis = [0, 1, 0]"));
  surface.radius =
      to_number_in(table.require("radius", "radius = 1"), positive, "a length greater than 0, such as 1");
  table.read("inside", surface.inside, to_bool);
}

std::string read_formula(const Node& node)
{
  std::string text = to_text(node);
  (void)to_field(node);  // its mistakes are those of any formula
  return text;
}

/// The file of a surface, and where the body is.
void read_triangles(const Node& node, const TableReader& table, bool is_obstacle,
                    const std::filesystem::path& case_directory, SurfaceConfig& surface)
{
  surface.file = case_directory / to_text(node);
  surface.side = is_obstacle ? SurfaceConfig::Side::outside : SurfaceConfig::Side::inside;
  table.read("side", surface.side, one_of<SurfaceConfig::Side>({"outside", "inside", "front", "back"}));
}

SurfaceConfig read_surface(const Entry& entry, bool is_obstacle, const std::filesystem::path& case_directory)
{
  std::vector<std::string_view> keys;
  for (const KindKey& kind : kind_keys)
    if (may_be(kind.kind, is_obstacle)) keys.push_back(kind.key);
  const std::string hint = fmt::format("one of them: {}", fmt::join(keys, ", "));
  keys.insert(keys.end(), {"side", "translate"});
  const TableReader table(entry.node, keys);
  SurfaceConfig surface{.name = entry.name, .where = entry.where};
  const Node* found = nullptr;
  for (const KindKey& kind : kind_keys)
  {
    const Node* node = may_be(kind.kind, is_obstacle) ? table.find(kind.key) : nullptr;
    if (node == nullptr) continue;
    if (found != nullptr)
      throw InputError(node->where, fmt::format("{} stands beside another surface", kind.key), hint);
    found = node;
    surface.kind = kind.kind;
  }
  if (found == nullptr) throw InputError(entry.where, "says nothing of the surface", hint);
  surface.kind_where = found->where;
  switch (surface.kind)
  {
    case Kind::plane:
      read_plane(*found, surface);
      break;
    case Kind::circle:
    case Kind::sphere:
    case Kind::cylinder:
      read_round(*found, surface);
      break;
    case Kind::distance:
      surface.distance = read_formula(*found);
      if (problem::Field(surface.distance, found->where).uses_time())
        throw InputError(found->where, "names t, the load factor, and obstacles do not move",
                         "a gap that names t, such as gap = \"0.1*t\", in place of the obstacle");
      break;
    case Kind::surface:
      read_triangles(*found, table, is_obstacle, case_directory, surface);
      break;
    case Kind::mesh:
      (void)to_choice(*found, std::vector<std::string>{"order2"});
      if (const Node* translate = table.find("translate"))
        throw InputError(translate->where, "moves the surface of the body itself",
                         "drop translate: the nodes of the mesh are where the body is");
      break;
  }
  if (const Node* side = table.find("side"); side != nullptr && surface.kind != Kind::surface)
    throw InputError(side->where, "stands beside another surface than one from a file",
                     "inside = true of a circle, sphere or cylinder; the normal of a plane");
  table.read("translate", surface.translate, read_point);
  return surface;
}

std::vector<SurfaceConfig> read_surfaces(const Node& node, bool is_obstacle,
                                         const std::filesystem::path& case_directory)
{
  const auto* table = std::get_if<Node::Table>(&node.value);
  if (table == nullptr)
    fail_type(node, "a table",
              is_obstacle ? "one table for each obstacle, such as [obstacle.floor]"
                          : "one table for each shape, such as [shape.hole]");
  std::vector<SurfaceConfig> surfaces;
  for (const Entry& entry : *table) surfaces.push_back(read_surface(entry, is_obstacle, case_directory));
  return surfaces;
}

std::string number_text(const Node& node)
{
  if (const auto* text = std::get_if<std::string>(&node.value)) return *text;
  return fmt::format("{}", to_number(node));
}

/// `normal`: a word of `words`, or formulas.
void read_normal(const TableReader& table,
                 std::span<const std::pair<std::string, GeometryConfig::Normal>> words,
                 GeometryConfig& geometry)
{
  const Node* node = table.find("normal");
  if (node == nullptr) return;
  geometry.normal_where = node->where;
  if (std::holds_alternative<std::string>(node->value))
  {
    std::vector<std::string> names;
    for (const auto& word : words) names.push_back(word.first);
    geometry.normal = words[to_choice(*node, names)].second;
    return;
  }
  geometry.normal = GeometryConfig::Normal::given;
  bool is_zero = true;
  for (const Node& item : to_components(*node, "one number or formula per dimension, out of the body"))
  {
    is_zero = is_zero && to_field(item).is_zero();
    geometry.direction.push_back(number_text(item));
  }
  if (is_zero) throw InputError(node->where, "has no length", "a direction out of the body, such as [0, -1]");
}

void refuse_gap(const TableReader& table, std::string_view why)
{
  if (const Node* gap = table.find("gap"))
    throw InputError(gap->where, fmt::format("stands beside {}", why),
                     "the gap is the distance between these surfaces; drop one of the two");
}

void require_for(const GeometryConfig& geometry, GeometryConfig::Normal normal, const std::string& name,
                 const std::string& hint)
{
  if (geometry.normal == normal && name.empty())
    throw InputError(geometry.normal_where, "there is no such surface here", hint);
}

void check_name(std::span<const SurfaceConfig> surfaces, const std::string& name, const Where& where,
                std::string_view kind)
{
  if (name.empty() || std::ranges::find(surfaces, name, &SurfaceConfig::name) != surfaces.end()) return;
  std::vector<std::string> names;
  for (const SurfaceConfig& surface : surfaces) names.push_back(surface.name);
  const std::string near = closest(name, names);
  throw InputError(
      where, fmt::format("there is no [{}.{}]", kind, name),
      fmt::format("{}the case has {}", near.empty() ? "" : fmt::format("did you mean \"{}\"? ", near),
                  problem::quoted_list(names)));
}

void check_used(std::span<const SurfaceConfig> surfaces, std::span<const std::string> used,
                std::string_view kind)
{
  for (const SurfaceConfig& surface : surfaces)
    if (std::ranges::find(used, surface.name) == used.end())
      throw InputError(surface.where, fmt::format("no contact names this {}", kind),
                       fmt::format("{} = \"{}\" in a contact, or drop the table", kind, surface.name));
}

}  // namespace

std::vector<SurfaceConfig> read_obstacles(const Node& node, const std::filesystem::path& case_directory)
{
  return read_surfaces(node, true, case_directory);
}

std::vector<SurfaceConfig> read_shapes(const Node& node, const std::filesystem::path& case_directory)
{
  return read_surfaces(node, false, case_directory);
}

GeometryConfig read_obstacle_geometry(const TableReader& table)
{
  using Normal = GeometryConfig::Normal;
  GeometryConfig geometry{.where = table.where()};
  const auto read_name = [&](std::string_view key, std::string& name, Where& where)
  {
    if (const Node* node = table.find(key))
    {
      name = to_text(*node);
      where = node->where;
    }
  };
  read_name("obstacle", geometry.obstacle, geometry.obstacle_where);
  read_name("shape", geometry.shape, geometry.shape_where);
  const std::array<std::pair<std::string, Normal>, 3> words = {
      {{"obstacle", Normal::obstacle}, {"facet", Normal::facet}, {"shape", Normal::shape}}};
  read_normal(table, words, geometry);
  require_for(geometry, Normal::obstacle, geometry.obstacle, "name an obstacle: obstacle = \"floor\"");
  require_for(geometry, Normal::shape, geometry.shape, "name a shape: shape = \"hole\"");
  if (!geometry.obstacle.empty()) refuse_gap(table, "an obstacle");
  return geometry;
}

GeometryConfig read_pair_geometry(const TableReader& table)
{
  using Normal = GeometryConfig::Normal;
  GeometryConfig geometry{.where = table.where()};
  if (const Node* node = table.find("shape"))
  {
    if (node->is_table())
    {
      const TableReader sides(*node, {"slave", "master"});
      if (const Node* side = sides.find("slave"))
      {
        geometry.shape = to_text(*side);
        geometry.shape_where = side->where;
      }
      if (const Node* side = sides.find("master"))
      {
        geometry.master_shape = to_text(*side);
        geometry.master_shape_where = side->where;
      }
      if (geometry.shape.empty() && geometry.master_shape.empty())
        throw InputError(node->where, "names no shape", "shape = { slave = \"pin\", master = \"hole\" }");
    }
    else
    {
      geometry.shape = geometry.master_shape = to_text(*node);
      geometry.shape_where = geometry.master_shape_where = node->where;
    }
  }
  const std::array<std::pair<std::string, Normal>, 3> words = {
      {{"facet", Normal::facet}, {"slave", Normal::shape}, {"master", Normal::obstacle}}};
  read_normal(table, words, geometry);
  require_for(geometry, Normal::obstacle, geometry.master_shape,
              "name the shape of the master: shape = { master = \"hole\" }");
  require_for(geometry, Normal::shape, geometry.shape,
              "name the shape of the slave: shape = { slave = \"pin\" }");
  if (!geometry.shape.empty() && !geometry.master_shape.empty())
    refuse_gap(table, "the shapes of both sides");
  return geometry;
}

void check_surfaces(const Config& config)
{
  std::vector<std::string> obstacles;
  std::vector<std::string> shapes;
  const auto check = [&](const GeometryConfig& geometry)
  {
    check_name(config.obstacles, geometry.obstacle, geometry.obstacle_where, "obstacle");
    check_name(config.shapes, geometry.shape, geometry.shape_where, "shape");
    check_name(config.shapes, geometry.master_shape, geometry.master_shape_where, "shape");
    obstacles.push_back(geometry.obstacle);
    shapes.push_back(geometry.shape);
    shapes.push_back(geometry.master_shape);
  };
  for (const BoundaryConfig& boundary : config.boundaries) check(boundary.geometry);
  for (const ContactConfig& contact : config.contacts) check(contact.geometry);
  check_used(config.obstacles, obstacles, "obstacle");
  check_used(config.shapes, shapes, "shape");
}

}  // namespace tribound::case_file
