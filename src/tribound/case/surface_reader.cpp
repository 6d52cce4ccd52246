#include "tribound/case/surface_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace tribound::case_file
{

namespace
{

using Kind = SurfaceConfig::Kind;

constexpr auto point_hint = "one number per dimension, such as [0, -1]";
constexpr auto vector_hint = "a direction, such as [0, 1]";

const Options<SurfaceConfig>& plane_options()
{
  using S = SurfaceConfig;
  static const Options<S> options(
      "obstacle.NAME.plane",
      {option<&S::point>("point", numbers(point_hint), "a point of the plane: point = [0, 0]"),
       option<&S::direction>("normal", direction(vector_hint),
                             "the direction out of the obstacle, or out of the body: normal = [0, 1]")});
  return options;
}

const Options<SurfaceConfig>& circle_options()
{
  using S = SurfaceConfig;
  static const Options<S> options(
      "obstacle.NAME.circle",
      {option<&S::point>("centre", numbers(point_hint), "its centre: centre = [0, 1]"),
       option<&S::radius>("radius", number_in(positive, "a length greater than 0, such as 1"), "radius = 1"),
       option<&S::inside>("inside", truth())});
  return options;
}

const Options<SurfaceConfig>& cylinder_options()
{
  using S = SurfaceConfig;
  static const Options<S> options(
      "obstacle.NAME.cylinder",
      {option<&S::point>("centre", numbers(point_hint), "a point of the axis: centre = [0, 0, 1]"),
       option<&S::direction>("axis", direction(vector_hint), "the direction of its axis: axis = [0, 1, 0]"),
       option<&S::radius>("radius", number_in(positive, "a length greater than 0, such as 1"), "radius = 1"),
       option<&S::inside>("inside", truth())});
  return options;
}

/// The keys that give the kind of a surface, in the order of Kind.
constexpr std::array kind_names = {"plane", "circle", "sphere", "cylinder", "distance", "surface", "mesh"};

Value kind_value(Kind kind)
{
  switch (kind)
  {
    case Kind::plane:
      return keys_of(plane_options().table());
    case Kind::circle:
    case Kind::sphere:
      return keys_of(circle_options().table());
    case Kind::cylinder:
      return keys_of(cylinder_options().table());
    case Kind::distance:
      return formula();
    case Kind::surface:
      break;
    case Kind::mesh:
      return one_of({"order2"});
  }
  return text();
}

Table surface_table(bool is_obstacle)
{
  Table table{.name = is_obstacle ? "obstacle.NAME" : "shape.NAME",
              .relations = {{.key = "side", .needs = {"surface"}}}};
  for (std::size_t i = 0; i < kind_names.size(); ++i)
  {
    const auto kind = static_cast<Kind>(i);
    if (kind == (is_obstacle ? Kind::mesh : Kind::distance)) continue;
    table.keys.push_back({kind_names[i], kind_value(kind)});
    table.one_of.emplace_back(kind_names[i]);
  }
  table.keys.push_back({"side", one_of({"outside", "inside", "front", "back"})});
  table.keys.push_back({"translate", numbers(point_hint)});
  if (!is_obstacle) table.relations.push_back({.key = "mesh", .excludes = {"translate"}});
  return table;
}

const Table& one_table(bool is_obstacle)
{
  static const Table obstacle = surface_table(true);
  static const Table shape = surface_table(false);
  return is_obstacle ? obstacle : shape;
}

std::string read_formula(const Node& node)
{
  std::string text = to_text(node);
  (void)to_field(node);  // checks it like any formula
  return text;
}

/// The file of a surface, and the side of the body.
void read_triangles(const Node& node, const TableReader& table, bool is_obstacle,
                    const std::filesystem::path& case_directory, SurfaceConfig& surface)
{
  surface.file = case_directory / to_text(node);
  surface.side = is_obstacle ? SurfaceConfig::Side::outside : SurfaceConfig::Side::inside;
  table.read("side", surface.side);
}

SurfaceConfig read_surface(const Entry& entry, bool is_obstacle, const std::filesystem::path& case_directory)
{
  const TableReader table(entry.node, one_table(is_obstacle));
  SurfaceConfig surface{.name = entry.name, .where = entry.where};
  const std::string hint = fmt::format("one of them: {}", fmt::join(one_table(is_obstacle).one_of, ", "));
  const std::string given = table.only(hint, "another surface");
  if (given.empty()) throw InputError(entry.where, "does not define a surface", hint);
  surface.kind = static_cast<Kind>(std::ranges::find(kind_names, given) - kind_names.begin());
  const Node* found = table.find(given);
  surface.kind_where = found->where;
  switch (surface.kind)
  {
    case Kind::plane:
      plane_options().read(*found, surface);
      break;
    case Kind::circle:
    case Kind::sphere:
      circle_options().read(*found, surface);
      break;
    case Kind::cylinder:
      cylinder_options().read(*found, surface);
      break;
    case Kind::distance:
      surface.distance = read_formula(*found);
      if (problem::Field(surface.distance, found->where).uses_time())
        throw InputError(found->where, "contains the load factor t, but obstacles do not move",
                         "a gap that names t, such as gap = \"0.1*t\", in place of the obstacle");
      break;
    case Kind::surface:
      read_triangles(*found, table, is_obstacle, case_directory, surface);
      break;
    case Kind::mesh:
      (void)to_choice(*found, table.key_of(given).value.words);
      if (const Node* translate = table.excluded_by(given))
        throw InputError(translate->where, "moves the surface of the body itself",
                         "drop translate: the nodes of the mesh are where the body is");
      break;
  }
  if (const Node* side = table.find("side"); side != nullptr && surface.kind != Kind::surface)
    throw InputError(side->where, "stands beside another surface than one from a file",
                     "inside = true of a circle, sphere or cylinder; the normal of a plane");
  table.read("translate", surface.translate);
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

}  // namespace

const Table& obstacles_table()
{
  static const Table table{.name = "obstacle", .named = keys_of(one_table(true))};
  return table;
}

const Table& shapes_table()
{
  static const Table table{.name = "shape", .named = keys_of(one_table(false))};
  return table;
}

std::vector<SurfaceConfig> read_obstacles(const Node& node, const std::filesystem::path& case_directory)
{
  return read_surfaces(node, true, case_directory);
}

std::vector<SurfaceConfig> read_shapes(const Node& node, const std::filesystem::path& case_directory)
{
  return read_surfaces(node, false, case_directory);
}

}  // namespace tribound::case_file
