#include "tribound/case/geometry_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace tribound::case_file
{

namespace
{

std::string number_text(const Node& node)
{
  if (const auto* text = std::get_if<std::string>(&node.value)) return *text;
  return fmt::format("{}", to_number(node));
}

/// The meanings of the words of `normal`, for a contact with an obstacle, a slider and a pair.
constexpr std::array obstacle_normals = {GeometryConfig::Normal::obstacle, GeometryConfig::Normal::facet,
                                         GeometryConfig::Normal::shape};
constexpr std::array slider_normals = {GeometryConfig::Normal::facet, GeometryConfig::Normal::shape};
constexpr std::array pair_normals = {GeometryConfig::Normal::facet, GeometryConfig::Normal::shape,
                                     GeometryConfig::Normal::obstacle};
constexpr auto normal_hint = "one number or formula per dimension, out of the body";

const Table& sides_table()
{
  static const Table table{
      .name = "contact.shape",
      .keys = {{"slave", text("the shape of the slave")}, {"master", text("the shape of the master")}}};
  return table;
}

/// `normal`: a word, with these meanings, or formulas.
void read_normal(const TableReader& table, std::span<const GeometryConfig::Normal> meanings,
                 GeometryConfig& geometry)
{
  const Node* node = table.find("normal");
  if (node == nullptr) return;
  const Value& value = table.key_of("normal").value;
  geometry.normal_where = node->where;
  if (std::holds_alternative<std::string>(node->value))
  {
    geometry.normal = meanings[to_choice(*node, value.words)];
    return;
  }
  geometry.normal = GeometryConfig::Normal::given;
  bool is_zero = true;
  for (const Node& item : to_items(*node, value))
  {
    is_zero = is_zero && to_field(item).is_zero();
    geometry.direction.push_back(number_text(item));
  }
  if (is_zero) throw InputError(node->where, "has no length", "a direction out of the body, such as [0, -1]");
}

void read_name(const TableReader& table, std::string_view key, std::string& name, Where& where)
{
  const Node* node = table.find(key);
  if (node == nullptr) return;
  name = to_text(*node);
  where = node->where;
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

std::vector<Key> obstacle_geometry_keys()
{
  return {{"obstacle", text()},
          {"shape", text()},
          {"normal", data(normal_hint) | one_of({"obstacle", "facet", "shape"})}};
}

std::vector<Key> pair_geometry_keys()
{
  return {{"shape", text() | keys_of(sides_table())},
          {"normal", data(normal_hint) | one_of({"facet", "slave", "master"})}};
}

std::vector<Key> slider_geometry_keys()
{
  return {{"shape", text()}, {"normal", data(normal_hint) | one_of({"facet", "shape"})}};
}

GeometryConfig read_obstacle_geometry(const TableReader& table)
{
  using Normal = GeometryConfig::Normal;
  GeometryConfig geometry{.where = table.where()};
  read_name(table, "obstacle", geometry.obstacle, geometry.obstacle_where);
  read_name(table, "shape", geometry.shape, geometry.shape_where);
  read_normal(table, obstacle_normals, geometry);
  require_for(geometry, Normal::obstacle, geometry.obstacle, "name an obstacle: obstacle = \"floor\"");
  require_for(geometry, Normal::shape, geometry.shape, "name a shape: shape = \"hole\"");
  if (!geometry.obstacle.empty()) refuse_gap(table, "an obstacle");
  return geometry;
}

GeometryConfig read_slider_geometry(const TableReader& table)
{
  GeometryConfig geometry{.where = table.where()};
  read_name(table, "shape", geometry.shape, geometry.shape_where);
  read_normal(table, slider_normals, geometry);
  require_for(geometry, GeometryConfig::Normal::shape, geometry.shape, "name a shape: shape = \"hole\"");
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
      const TableReader sides(*node, sides_table());
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
  read_normal(table, pair_normals, geometry);
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
