#include "tribound/io/fields/imported_msh.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "tribound/io/file/atomic_file.h"
#include "tribound/mesh/gmsh_elements.h"
#include "tribound/mesh/import/cell_sets.h"

namespace tribound::io
{

namespace
{

class MshText
{
 public:
  MshText(AtomicFile& file, const mesh::ImportedMesh& mesh) : file_(file), mesh_(mesh)
  {
    number_.assign(mesh.nodes.size(), 0);
    each_block(
        [&](const mesh::ElementBlock& block)
        {
          for (const Index node : block.nodes) number_[node] = 1;
        });
    for (Index& number : number_)
      if (number > 0) number = ++n_nodes_;
  }

  void write()
  {
    add_names();
    add_nodes();
    std::size_t n = 0;
    each_block([&](const mesh::ElementBlock& block) { n += block.size(); });
    add("$Elements\n{}\n", n);
    for (std::size_t s = 0; s < mesh_.facet_sets.size(); ++s)
      for (const mesh::ElementBlock& block : mesh_.facet_sets[s].facets)
        add_elements(block, [s](std::size_t) { return s + 1; });
    const std::vector<Index> region = mesh::set_of_cells(mesh_);
    std::size_t first = 0;
    for (const mesh::ElementBlock& block : mesh_.cells)
    {
      add_elements(block, [&](std::size_t e) { return static_cast<std::size_t>(region[first + e] + 1); });
      first += block.size();
    }
    add("$EndElements\n");
    file_.write(text_);
  }

 private:
  template <class Visit>
  void each_block(const Visit& visit) const
  {
    for (const mesh::FacetSet& set : mesh_.facet_sets) std::ranges::for_each(set.facets, visit);
    std::ranges::for_each(mesh_.cells, visit);
  }

  template <class... Arguments>
  void add(fmt::format_string<Arguments...> format, Arguments&&... arguments)
  {
    constexpr std::size_t enough = 1U << 20U;
    fmt::format_to(std::back_inserter(text_), format, std::forward<Arguments>(arguments)...);
    if (text_.size() < enough) return;
    file_.write(text_);
    text_.clear();
  }

  void add_names()
  {
    const int dim = mesh::table_of(mesh_.cells.front().type.shape).dim;
    add("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{}\n",
        mesh_.facet_sets.size() + mesh_.cell_sets.size());
    for (std::size_t s = 0; s < mesh_.facet_sets.size(); ++s)
      add("{} {} \"{}\"\n", dim - 1, s + 1, mesh_.facet_sets[s].name);
    for (std::size_t s = 0; s < mesh_.cell_sets.size(); ++s)
      add("{} {} \"{}\"\n", dim, s + 1, mesh_.cell_sets[s].name);
    add("$EndPhysicalNames\n");
  }

  void add_nodes()
  {
    add("$Nodes\n{}\n", n_nodes_);
    for (std::size_t i = 0; i < number_.size(); ++i)
      if (const Point<3>& x = mesh_.nodes[i]; number_[i] > 0)
        add("{} {} {} {}\n", number_[i], x[0], x[1], x[2]);
    add("$EndNodes\n");
  }

  /// The elementary entity has the number of the group: in this version an entity is in one group.
  template <class GroupOf>
  void add_elements(const mesh::ElementBlock& block, const GroupOf& group_of)
  {
    const mesh::GmshType type = mesh::to_gmsh(block.type);
    std::vector<Index> nodes(type.order.size());
    for (std::size_t e = 0; e < block.size(); ++e)
    {
      const std::span<const Index> element = block.element(e);
      for (std::size_t i = 0; i < nodes.size(); ++i) nodes[type.order[i]] = number_[element[i]];
      const std::size_t group = group_of(e);
      add("{} {} 2 {} {}", ++n_elements_, type.number, group, std::max<std::size_t>(group, 1));
      for (const Index node : nodes) add(" {}", node);
      add("\n");
    }
  }

  AtomicFile& file_;
  const mesh::ImportedMesh& mesh_;
  std::vector<Index> number_{};  ///< per node, from 1; 0: left out
  Index n_nodes_ = 0;
  std::size_t n_elements_ = 0;
  std::string text_{};
};

/// Of elements the corners alone.
void keep_corners(std::vector<mesh::ElementBlock>& blocks)
{
  for (mesh::ElementBlock& block : blocks)
  {
    const int n_corners = mesh::table_of(block.type.shape).n_corners;
    std::vector<Index> nodes;
    nodes.reserve(block.size() * n_corners);
    for (std::size_t e = 0; e < block.size(); ++e)
      for (const Index node : block.element(e).first(n_corners)) nodes.push_back(node);
    block.nodes = std::move(nodes);
    block.type.n_nodes = n_corners;
  }
}

}  // namespace

void write_msh(const std::filesystem::path& path, const mesh::ImportedMesh& mesh)
{
  assert(mesh.node_sets.empty());
  // A line of the format has 255 characters, and ends a name at the first quotation mark.
  constexpr std::size_t longest = 200;
  const auto check = [&](const std::string& name)
  {
    if (name.size() <= longest && name.find('"') == std::string::npos) return;
    throw InputError({.file = path.string()},
                     fmt::format("a .msh cannot hold the name {} of a group", name.substr(0, longest)),
                     "a name of at most 200 characters, without quotation marks");
  };
  for (const mesh::CellSet& set : mesh.cell_sets) check(set.name);
  for (const mesh::FacetSet& set : mesh.facet_sets) check(set.name);
  AtomicFile file(path);
  if (mesh::has_several_orders(mesh.cells))
  {
    mesh::ImportedMesh corners = mesh;
    keep_corners(corners.cells);
    for (mesh::FacetSet& set : corners.facet_sets) keep_corners(set.facets);
    MshText(file, corners).write();
  }
  else
    MshText(file, mesh).write();
  file.commit();
}

}  // namespace tribound::io
