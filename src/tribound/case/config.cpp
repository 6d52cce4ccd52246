#include "tribound/case/config.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "tribound/case/axisymmetry.h"
#include "tribound/case/geometry_reader.h"
#include "tribound/case/group_reader.h"
#include "tribound/case/history_reader.h"
#include "tribound/case/method_reader.h"
#include "tribound/case/node.h"
#include "tribound/case/parameters.h"
#include "tribound/case/physics.h"
#include "tribound/case/probe_reader.h"
#include "tribound/case/quantity_reader.h"
#include "tribound/case/region_reader.h"
#include "tribound/case/surface_reader.h"
#include "tribound/case/table_reader.h"
#include "tribound/fem/degree.h"
#include "tribound/mesh/box.h"
#include "tribound/mesh/import/read.h"

namespace tribound::case_file
{

namespace
{

constexpr auto mesh_hint =
    "file = \"block.msh\", or box = { lower = [0, 0], upper = [2, 1], cells = [4, 2] }";

const Options<mesh::BoxMesh>& box_options()
{
  using Box = mesh::BoxMesh;
  static const Options<Box> options(
      "mesh.box",
      {option<&Box::lower>("lower", numbers(), mesh_hint), option<&Box::upper>("upper", numbers(), mesh_hint),
       option<&Box::cells>(
           "cells",
           vector_of(integer_from(1, "the number of cells in this direction"), "one number per dimension"),
           mesh_hint)});
  return options;
}

const Options<mesh::ImportOptions>& import_options()
{
  using Import = mesh::ImportOptions;
  static const Options<Import> options(
      "mesh",
      {option<&Import::size>("size", number_in(positive, "the largest edge, in the unit of the geometry")),
       option<&Import::merge>("merge", number_in(positive, "a distance far below the smallest edge")),
       option<&Import::ignore_elements>("ignore_elements", truth()),
       option<&Import::region_array>("region_array", text("the name of an array of cells", 1)),
       option<&Import::boundaries>(
           "boundaries",
           array_of(text({}, 1), 1, "the sets that become boundaries, as [\"top\", \"base\"]"))});
  return options;
}

const Table& mesh_table()
{
  static const Table boxes{.name = "mesh.boxes", .named = keys_of(box_options().table())};
  static const Table table = [&]
  {
    Table with_options{.name = "mesh",
                       .keys = std::vector<Key>{{"file", text(mesh_hint, 1)},
                                                {"box", keys_of(box_options().table())},
                                                {"boxes", keys_of(boxes)}} +
                               import_options().table().keys,
                       .one_of = {"file", "box", "boxes"}};
    for (const Key& key : import_options().table().keys)
      with_options.relations.push_back({.key = key.name, .needs = {"file"}});
    return with_options;
  }();
  return table;
}

mesh::BoxMesh read_box(const Node& node)
{
  mesh::BoxMesh box{.lower = {}, .upper = {}, .cells = {}, .where = node.where};
  box_options().read(node, box);
  mesh::require_valid(box);
  return box;
}

/// One box for each name.
mesh::Boxes read_boxes(const Node& node)
{
  constexpr auto hint =
      "one box for each body: boxes.upper = { lower = [0, 1], upper = [2, 2], cells = [4, 2] }";
  const auto* table = std::get_if<Node::Table>(&node.value);
  if (table == nullptr) fail_type(node, "a table", hint);
  if (table->empty()) throw InputError(node.where, "is empty", hint);
  mesh::Boxes boxes;
  for (const Entry& entry : *table)
  {
    boxes.push_back({entry.name, read_box(entry.node)});
    if (boxes.back().box.lower.size() != boxes.front().box.lower.size())
      throw InputError(entry.where, "has another dimension than the first box",
                       "the boxes of a case are all 2D or all 3D");
  }
  return boxes;
}

mesh::MeshSource read_mesh_source(const Node& node, const std::filesystem::path& case_directory)
{
  const TableReader table(node, mesh_table());
  const std::string hint = fmt::format("one of them: {}", mesh_hint);
  const std::string key = table.only(hint);
  if (key.empty()) throw InputError(node.where, "neither file nor box is given", hint);
  const Node& given = table.require(key);
  for (const Key& option : import_options().table().keys)
    if (const Node* node = table.find(option.name); node != nullptr && key != "file")
      throw InputError(node->where, "goes with a mesh from a file", "take it out beside a box");
  if (key == "boxes") return read_boxes(given);
  if (key == "box") return read_box(given);
  mesh::MeshFile file{case_directory / table.get<std::string>(key), given.where};
  import_options().read(table, file.options);
  return file;
}

const Table& units_table()
{
  constexpr auto both = "[units] names both: length = \"mm\", force = \"N\"; stresses follow";
  static const Table table{.name = "units",
                           .keys = {{"length", one_of(problem::length_names()), both},
                                    {"force", one_of(problem::force_names()), both}}};
  return table;
}

problem::Units read_units(const Node& node)
{
  const TableReader table(node, units_table());
  const auto name = [&table](std::string_view key)
  {
    const std::vector<std::string>& names = table.key_of(key).value.words;
    return names[to_choice(table.require(key), names)];
  };
  return {name("length"), name("force")};
}

/// The document as a case file in the output directory; paths are relative to that directory.
io::EffectiveCase effective_case(Node document, const Config& config, std::span<const std::string> overrides)
{
  auto& tables = std::get<Node::Table>(document.value);
  const auto from_there = [&config](const std::filesystem::path& file)
  {
    std::error_code unknown;
    const std::filesystem::path path = std::filesystem::absolute(file, unknown);
    const std::filesystem::path relative =
        std::filesystem::relative(path, std::filesystem::absolute(config.output.directory, unknown), unknown);
    return (unknown || relative.empty() ? path : relative).string();
  };
  const auto table = [](Node::Table& parent, std::string_view key) -> Node::Table&
  { return std::get<Node::Table>(find(parent, key)->node.value); };
  if (const auto* file = std::get_if<mesh::MeshFile>(&config.mesh))
    find(table(tables, "mesh"), "file")->node.value = from_there(file->path);
  for (const auto& [kind, surfaces] : {std::pair("obstacle", &config.obstacles), {"shape", &config.shapes}})
    for (const SurfaceConfig& surface : *surfaces)
      if (surface.kind == SurfaceConfig::Kind::surface)
        find(table(table(tables, kind), surface.name), "surface")->node.value = from_there(surface.file);
  if (find(tables, "output") == nullptr) tables.push_back({"output", {}, {Node::Table{}, {}}});
  auto& output = std::get<Node::Table>(find(tables, "output")->node.value);
  if (find(output, "directory") == nullptr)
    output.insert(output.begin(), {"directory", {}, {config.output.directory.string(), {}}});
  return {to_toml(document), {overrides.begin(), overrides.end()}};
}

Config read_document(const Node& document, std::string file)
{
  const TableReader root(document, case_table());
  Config config;
  const std::filesystem::path case_directory = std::filesystem::path(file).parent_path();
  config.file = std::move(file);
  root.read("title", config.title);
  root.read("purpose", config.purpose);
  root.read("not_covered", config.not_covered);
  root.read("degree", config.method.degree);
  if (const Node* node = root.find("units")) config.units = read_units(*node);
  config.mesh = read_mesh_source(root.require("mesh"), case_directory);
  config.materials = read_materials(root.require("material"));
  config.groups = read_groups(root.find("boundary"), root.require("material"));
  if (const Node* node = root.find("load")) config.loads = read_loads(*node);
  if (const Node* node = root.find("boundary")) config.boundaries = read_boundaries(*node);
  if (const Node* node = root.find("contact")) config.contacts = read_contacts(*node);
  if (const Node* node = root.find("obstacle")) config.obstacles = read_obstacles(*node, case_directory);
  if (const Node* node = root.find("shape")) config.shapes = read_shapes(*node, case_directory);
  check_surfaces(config);
  if (const Node* node = root.find("quantity")) config.quantities = read_quantities(*node);
  if (const Node* node = root.find("probe")) config.probes = read_probes(*node);
  if (const Node* node = root.find("section")) config.sections = read_sections(*node);
  read_load_steps(root, config);
  config.output.directory = default_directory(config.file);
  read_method(root, config);
  check_load_steps(root, config);
  check_error_bars(root, config);
  read_model(root, config);
  return config;
}

bool has_function(const Node& node)
{
  if (const auto* table = std::get_if<Node::Table>(&node.value))
    return std::ranges::any_of(*table, [](const Entry& entry) { return has_function(entry.node); });
  if (const auto* array = std::get_if<Node::Array>(&node.value))
    return std::ranges::any_of(*array, has_function);
  return std::holds_alternative<problem::FieldFunction>(node.value);
}

}  // namespace

const Table& case_table()
{
  const auto tables = [](const Table& table) { return array_of(keys_of(table), 0, {}); };
  static const Table table{
      .name = "",
      .keys =
          std::vector<Key>{{"title", text()},
                           {"purpose", text()},
                           {"degree", integer_from(1, "the polynomial degree p", fem::max_degree)},
                           model_key(),
                           {"units", keys_of(units_table())},
                           {"parameters", keys_of(parameters_table())},
                           {"mesh", keys_of(mesh_table()), fmt::format("[mesh] with {}", mesh_hint)},
                           {"material", keys_of(material_table()), "[material] with E = 210e9 and nu = 0.3"},
                           {"load", keys_of(load_table())},
                           {"boundary", keys_of(boundaries_table())},
                           {"contact", tables(pair_table())},
                           {"obstacle", keys_of(obstacles_table())},
                           {"shape", keys_of(shapes_table())},
                           {"quantity", tables(quantity_table())},
                           {"probe", keys_of(probes_table())},
                           {"section", keys_of(sections_table())},
                           {"history", keys_of(history_table())},
                           {"not_covered", array_of(text("what the case leaves out", 1), 0,
                                                    "not_covered = [\"creep of the concrete\"]")}} +
          method_keys(),
      .refused = point_loads()};
  return table;
}

std::filesystem::path default_directory(const std::filesystem::path& case_file)
{
  return std::filesystem::path("out") / case_file.stem();
}

std::vector<std::filesystem::path> files_of(const Config& config)
{
  std::vector<std::filesystem::path> files;
  if (const auto* file = std::get_if<mesh::MeshFile>(&config.mesh)) files.push_back(file->path);
  for (const auto* surfaces : {&config.obstacles, &config.shapes})
    for (const SurfaceConfig& surface : *surfaces)
      if (surface.kind == SurfaceConfig::Kind::surface) files.push_back(surface.file);
  return files;
}

mesh::FindSeams find_seams(const Config& config)
{
  return [&config](std::span<const std::string> boundary_names)
  {
    mesh::Seams seams;
    seams.has_axis = config.is_axisymmetric;
    for (const ContactConfig& contact : config.contacts)
    {
      const auto require = [&](const std::string& name)
      { (void)problem::group_number(name, boundary_names, contact.where, "boundary"); };
      std::ranges::for_each(contact.slave, require);
      if (!contact.joint.empty())
      {
        seams.joints.push_back(contact.joint);
        continue;
      }
      std::ranges::for_each(contact.master, require);
      seams.interfaces.push_back({{contact.slave, contact.master}});
    }
    return seams;
  };
}

std::string friction_name(const Config& config)
{
  std::string text;
  for (const std::string_view law : problem::law_names)
    if (std::ranges::any_of(config.boundaries, [&](const BoundaryConfig& boundary)
                            { return boundary.contact && name(boundary.contact->law) == law; }) ||
        std::ranges::any_of(config.contacts,
                            [&](const ContactConfig& contact) { return name(contact.contact.law) == law; }))
      text += (text.empty() ? "" : "+") + std::string(law);
  return text;
}

Config make_config(Node document, std::string name, std::span<const std::string> overrides)
{
  for (const std::string& assignment : overrides)
    apply_override(document, parameter_assignment(document, assignment));
  // The document itself has no position.
  document.where.line = document.where.column = 0;
  Config config = read_document(with_values(document, read_parameters(document)), std::move(name));
  if (config.output.checkpoints != Checkpoints::none && has_function(document))
    throw InputError({.file = config.file, .key = "output.checkpoint"},
                     "goes with data that a file can hold, but the case has functions of a program",
                     "formulas in their place, or no checkpoints");
  config.effective = effective_case(std::move(document), config, overrides);
  return config;
}

Config parse_config(std::string_view text, std::string name, std::span<const std::string> overrides)
{
  Node document = parse_toml(text, name);
  return make_config(std::move(document), std::move(name), overrides);
}

Config read_config(const std::filesystem::path& file, std::span<const std::string> overrides)
{
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file))
    throw InputError({.file = file.string()},
                     stream ? "is a directory" : fmt::format("cannot be read: {}", std::strerror(errno)),
                     "the path of a case file, such as examples/01_tresca_block/case.toml");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return parse_config(text, file.string(), overrides);
}

}  // namespace tribound::case_file
