#include "tribound/case/region_reader.h"

#include <algorithm>
#include <utility>

#include "tribound/case/group_reader.h"

namespace tribound::case_file
{

namespace
{

const Options<MaterialConfig>& material_options()
{
  using M = MaterialConfig;
  static const Options<M> options(
      "material",
      {option<&M::E>("E", number_in(positive, "Young's modulus in the units of stress, such as 210e9"),
                     "Young's modulus, in the units of stress: E = 210e9"),
       option<&M::nu>("nu",
                      number_in({.lower = -1.0, .upper = 0.5},
                                "Poisson's ratio, such as 0.3; nearly incompressible is 0.499, not 0.5"),
                      "Poisson's ratio in (-1, 0.5): nu = 0.3"),
       option<&M::plane>("plane", one_of({"strain", "stress"})),
       option<&M::alpha>("alpha",
                         number_in({.includes_lower = true}, "strain per degree, such as 12e-6 for steel"))});
  return options;
}

MaterialConfig read_material(const TableReader& table, std::string region, problem::PlaneModel plane)
{
  MaterialConfig material{.region = std::move(region), .plane = plane, .where = table.where()};
  material_options().read(table, material);
  (void)to_number_in(table.require("E"), reasonable,
                     "squares of stresses must be numbers, too: take other units");
  return material;
}

const Options<LoadConfig>& load_options()
{
  static const Options<LoadConfig> options(
      "load",
      {option<&LoadConfig::body>("body", data()), option<&LoadConfig::temperature>("temperature", datum()),
       option<&LoadConfig::reference_temperature>("reference_temperature", datum()),
       option<&LoadConfig::initial_stress>(
           "initial_stress", array_of(datum(), 3,
                                      "the entries of a symmetric tensor: [xx, yy, xy], in 3D [xx, yy, zz, "
                                      "xy, yz, xz]"))},
      point_loads());
  return options;
}

LoadConfig read_load(const TableReader& table, std::string region)
{
  LoadConfig load{.region = std::move(region), .body = {}, .where = table.where()};
  load_options().read(table, load);
  if (table.has("reference_temperature"))
    (void)table.require("temperature", "the temperature that is to be compared with it");
  if (load.body.empty() && !load.temperature && load.initial_stress.empty())
    throw InputError(table.where(), "gives no load",
                     "a force per volume, body = [0, -9.81], a temperature or an initial_stress");
  return load;
}

/// Adds to the table a subtable with the same keys for each region.
Table of_regions(const Table& table)
{
  return {.name = table.name, .keys = table.keys, .named = keys_of(table), .refused = table.refused};
}

}  // namespace

const Table& material_table()
{
  static const Table region{.name = "material.NAME", .keys = material_options().table().keys + group_keys()};
  static const Table table{
      .name = "material", .keys = material_options().table().keys, .named = keys_of(region)};
  return table;
}

const Table& load_table()
{
  static const Table table = of_regions(load_options().table());
  return table;
}

std::vector<MaterialConfig> read_materials(const Node& node)
{
  const TableReader table(node, material_table());
  problem::PlaneModel plane = problem::PlaneModel::strain;
  table.read("plane", plane);

  std::vector<MaterialConfig> materials;
  if (table.has("E") || table.has("nu") || table.named().empty())
    materials.push_back(read_material(table, {}, plane));
  for (const Entry* entry : table.named())
    materials.push_back(
        read_material(TableReader(entry->node, *material_table().named->table), entry->name, plane));
  return materials;
}

std::vector<LoadConfig> read_loads(const Node& node)
{
  const TableReader table(node, load_table());
  std::vector<LoadConfig> loads;
  const auto is_given = [&table](const Key& key) { return table.has(key.name); };
  if (std::ranges::any_of(load_options().table().keys, is_given)) loads.push_back(read_load(table, {}));
  for (const Entry* entry : table.named())
    loads.push_back(read_load(TableReader(entry->node, load_options().table()), entry->name));
  return loads;
}

}  // namespace tribound::case_file
