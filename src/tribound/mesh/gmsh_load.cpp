#include "tribound/mesh/gmsh_load.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <string_view>
#include <utility>

#include "tribound/mesh/describe.h"
#include "tribound/mesh/gmsh_elements.h"
#include "tribound/mesh/gmsh_geometry.h"
#include "tribound/mesh/gmsh_library.h"
#include "tribound/mesh/gmsh_session.h"

namespace tribound::mesh
{

namespace
{

/// Gmsh's entities of one dimension, in words.
std::string_view entity_word(int dim)
{
  constexpr std::array<std::string_view, 4> words = {"point", "curve", "surface", "volume"};
  return words[dim];
}

/// The physical groups of one dimension: their names, and the group of every entity that is in one.
struct Groups
{
  std::vector<std::string> names;
  std::map<int, int> of_entity;  ///< entity tag -> position in names
};

Groups read_groups(const Where& where, int dim)
{
  Groups groups;
  for (const gmsh::Entity& physical : gmsh::physical_groups(dim))
  {
    std::string name = gmsh::physical_name(physical);
    if (name.empty()) name = std::to_string(physical.second);
    const auto known = std::find(groups.names.begin(), groups.names.end(), name);
    const int group = static_cast<int>(known - groups.names.begin());
    if (known == groups.names.end()) groups.names.push_back(name);

    for (const int entity : gmsh::entities_of(physical))
    {
      const auto [entry, is_new] = groups.of_entity.try_emplace(std::abs(entity), group);
      if (is_new || entry->second == group) continue;
      throw InputError(
          where,
          fmt::format("{} {} is in two physical groups, \"{}\" and \"{}\"", entity_word(dim),
                      std::abs(entity), groups.names[entry->second], name),
          "every region and every part of the boundary has one name; in .msh files of version 1 and 2, "
          "elements of different groups also need different elementary tags");
    }
  }
  return groups;
}

/// Entities of a CAD geometry or numbers of properties as groups, where the format has no others.
class EntityGroups
{
 public:
  EntityGroups(const std::filesystem::path& file, int mesh_dim, std::vector<std::string>& notes)
      : file_(file), mesh_dim_(mesh_dim), notes_(notes)
  {
  }

  [[nodiscard]] Groups read(int dim) const
  {
    Groups groups;
    std::size_t n_between = 0;
    for (const gmsh::Entity& entity : gmsh::entities(dim))
    {
      if (has_named_entities(file_) && dim < mesh_dim_ && gmsh::n_bounded(entity) != 1)
      {
        n_between += gmsh::n_bounded(entity) > 1 ? 1 : 0;
        continue;
      }
      groups.of_entity.emplace(entity.second, static_cast<int>(groups.names.size()));
      groups.names.push_back(name_of(entity, groups.names));
    }
    if (n_between > 0)
      notes_.push_back(
          fmt::format("{}: {}s between two {}s, which are joined there and are no boundaries: {}",
                      file_.string(), entity_word(dim), entity_word(mesh_dim_), n_between));
    return groups;
  }

 private:
  /// The last part of its label, such as "bolt" of "Shapes/part/bolt", if no other has it; "face7".
  [[nodiscard]] std::string name_of(const gmsh::Entity& entity, std::span<const std::string> taken) const
  {
    constexpr std::array<std::string_view, 4> words = {"point", "edge", "face", "solid"};
    std::string number = std::to_string(entity.second);
    if (!has_named_entities(file_)) return number;
    const std::string label = gmsh::entity_name(entity);
    std::string name = label.substr(label.rfind('/') + 1);
    if (name.empty() || name.starts_with("Open CASCADE"))  // its writer names what has no name
      return std::string(words[entity.first]) + number;
    if (std::ranges::find(taken, name) != taken.end()) name += "_" + number;
    return name;
  }

  const std::filesystem::path& file_;
  int mesh_dim_;
  std::vector<std::string>& notes_;
};

void check_groups_filled(const Where& where, int dim, const Groups& groups, std::span<const char> is_filled)
{
  constexpr std::array<std::string_view, 4> elements = {"points", "edges", "faces", "cells"};
  for (std::size_t g = 0; g < groups.names.size(); ++g)
    if (is_filled[g] == 0)
      throw InputError(where, fmt::format("physical group \"{}\" has no {}", groups.names[g], elements[dim]),
                       fmt::format("mesh the {}s of the group, or remove it", entity_word(dim)));
}

bool is_nastran(const std::filesystem::path& file)
{
  return file.extension() == ".bdf" || file.extension() == ".nas";
}

/// The loaded model, entity by entity and type by type.
class GmshReader
{
 public:
  GmshReader(const std::filesystem::path& file, int dim, std::vector<std::string>& notes)
      : dim_(dim),
        is_geometry_(is_geometry(file)),
        has_physical_groups_(!has_named_entities(file) && !is_nastran(file)),
        entity_groups_(file, dim, notes),
        mesh_{.source = {.file = file.string()}}
  {
    check_elements(mesh_.source, dim);
    read_nodes();
  }

  ImportedMesh read()
  {
    read_cells(groups_of(dim_));
    read_facets(groups_of(dim_ - 1));
    drop_points();
    return std::move(mesh_);
  }

 private:
  void read_nodes();
  [[nodiscard]] Groups groups_of(int dim) const
  {
    return has_physical_groups_ ? read_groups(mesh_.source, dim) : entity_groups_.read(dim);
  }
  void read_cells(const Groups& groups);
  void read_facets(const Groups& groups);
  void drop_points();
  /// The elements of one type in an entity.
  [[nodiscard]] ElementBlock read_block(const GmshType& type, int entity) const;
  [[noreturn]] void throw_homeless(std::size_t n, int entity, std::span<const Index> nodes) const;

  int dim_;
  bool is_geometry_;
  bool has_physical_groups_;
  EntityGroups entity_groups_;
  ImportedMesh mesh_;
  std::vector<Index> node_of_tag_{};
};

/// In ascending order of their tags.
void GmshReader::read_nodes()
{
  const auto [tags, x] = gmsh::nodes();
  const std::size_t largest = tags.empty() ? 0 : *std::max_element(tags.begin(), tags.end());
  if (largest > 16 * tags.size() + 1024)  // too sparse for tables indexed by tag
  {
    gmsh::renumber_nodes();
    return read_nodes();
  }
  constexpr Index absent = -1;
  node_of_tag_.assign(largest + 1, absent);
  for (const std::size_t tag : tags) node_of_tag_[tag] = 0;
  mesh_.node_numbers.reserve(tags.size());
  for (std::size_t tag = 0; tag <= largest; ++tag)
  {
    if (node_of_tag_[tag] == absent) continue;
    node_of_tag_[tag] = static_cast<Index>(mesh_.node_numbers.size());
    mesh_.node_numbers.push_back(static_cast<std::int64_t>(tag));
  }
  mesh_.nodes.resize(mesh_.node_numbers.size());
  for (std::size_t i = 0; i < tags.size(); ++i)
    mesh_.nodes[node_of_tag_[tags[i]]] = {x[3 * i], x[3 * i + 1], x[3 * i + 2]};
}

ElementBlock GmshReader::read_block(const GmshType& type, int entity) const
{
  const gmsh::Elements elements = gmsh::elements_in(type.number, entity);
  ElementBlock block{
      type.type, std::vector<Index>(elements.nodes.size()), {elements.tags.begin(), elements.tags.end()}};
  const std::size_t stride = type.order.size();
  for (std::size_t e = 0; e < block.size(); ++e)
    for (std::size_t i = 0; i < stride; ++i)
      block.nodes[e * stride + i] = node_of_tag_[elements.nodes[e * stride + type.order[i]]];
  return block;
}

void GmshReader::throw_homeless(std::size_t n, int entity, std::span<const Index> nodes) const
{
  std::string corners;
  for (const Index node : nodes) corners += (corners.empty() ? "" : ", ") + mesh::describe(mesh_.nodes[node]);
  std::size_t n_cells = 0;
  for (const ElementBlock& block : mesh_.cells) n_cells += block.size();
  throw InputError(
      mesh_.source,
      fmt::format(
          "{} of {} elements are in no physical group; first in {} {}, for example the one with corners {}",
          n, n_cells, entity_word(dim_), entity, corners),
      fmt::format("put every {} into a physical group, or use no groups of {}s at all", entity_word(dim_),
                  entity_word(dim_)));
}

/// All cells; the groups are the regions.
void GmshReader::read_cells(const Groups& groups)
{
  const std::vector<GmshType> types = gmsh_types(mesh_.source, dim_);
  for (const std::string& name : groups.names) mesh_.cell_sets.push_back({name});
  std::vector<char> is_filled(groups.names.size(), 0);
  Index n_cells = 0;
  std::size_t n_homeless = 0;
  std::pair<int, std::vector<Index>> example;
  for (const auto& [_, entity] : gmsh::entities(dim_))
    for (const GmshType& type : types)
    {
      ElementBlock block = read_block(type, entity);
      if (block.nodes.empty()) continue;
      const auto n = static_cast<Index>(block.size());
      if (const auto group = groups.of_entity.find(entity); group != groups.of_entity.end())
      {
        std::vector<Index>& cells = mesh_.cell_sets[group->second].cells;
        cells.resize(cells.size() + n);
        std::iota(cells.end() - n, cells.end(), n_cells);
        is_filled[group->second] = 1;
      }
      else if (!groups.names.empty())
      {
        const auto corners = block.element(0).first(table_of(type.type.shape).n_corners);
        if (n_homeless == 0) example = {entity, {corners.begin(), corners.end()}};
        n_homeless += n;
      }
      n_cells += n;
      mesh_.cells.push_back(std::move(block));
    }
  if (n_homeless > 0) throw_homeless(n_homeless, example.first, example.second);
  check_groups_filled(mesh_.source, dim_, groups, is_filled);
}

/// The facets of the boundary groups.
void GmshReader::read_facets(const Groups& groups)
{
  const std::vector<GmshType> types = gmsh_types(mesh_.source, dim_ - 1);
  for (const std::string& name : groups.names) mesh_.facet_sets.push_back({name});
  std::vector<char> is_filled(groups.names.size(), 0);
  for (const auto& [entity, group] : groups.of_entity)
    for (const GmshType& type : types)
    {
      ElementBlock block = read_block(type, entity);
      if (block.nodes.empty()) continue;
      is_filled[group] = 1;
      mesh_.facet_sets[group].facets.push_back(std::move(block));
    }
  check_groups_filled(mesh_.source, dim_ - 1, groups, is_filled);
}

/// Points of the geometry that no element uses, such as centres of circles, are no nodes that the user has
/// lost: they are left out without a word.
void GmshReader::drop_points()
{
  std::vector<char> is_kept(mesh_.nodes.size(), is_geometry_ ? 0 : 1);
  for (const std::size_t tag : gmsh::nodes(0).tags) is_kept[node_of_tag_[tag]] = 0;
  const auto each_block = [&](const auto& visit)
  {
    for (ElementBlock& block : mesh_.cells) visit(block);
    for (FacetSet& set : mesh_.facet_sets) std::ranges::for_each(set.facets, visit);
  };
  each_block(
      [&](const ElementBlock& block)
      {
        for (const Index node : block.nodes) is_kept[node] = 1;
      });
  std::vector<Index> place(mesh_.nodes.size());
  Index n_kept = 0;
  for (std::size_t node = 0; node < is_kept.size(); ++node)
  {
    if (is_kept[node] == 0) continue;
    mesh_.nodes[n_kept] = mesh_.nodes[node];
    mesh_.node_numbers[n_kept] = mesh_.node_numbers[node];
    place[node] = n_kept++;
  }
  mesh_.nodes.resize(n_kept);
  mesh_.node_numbers.resize(n_kept);
  each_block(
      [&](ElementBlock& block)
      {
        for (Index& node : block.nodes) node = place[node];
      });
}

}  // namespace

ImportedMesh load_gmsh(const MeshFile& source, std::vector<std::string>& notes)
{
  open_in_gmsh(source, notes);
  return GmshReader(source.path, mesh_dimension({.file = source.path.string()}), notes).read();
}

}  // namespace tribound::mesh
