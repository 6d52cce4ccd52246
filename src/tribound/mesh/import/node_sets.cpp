#include "tribound/mesh/import/node_sets.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <string_view>
#include <utility>

#include "tribound/mesh/import/cell_faces.h"

namespace tribound::mesh
{

std::vector<Index> bodies_of_nodes(const ImportedMesh& mesh)
{
  std::vector<Index> parent(mesh.nodes.size(), -1);
  const auto root = [&](Index node)
  {
    while (parent[node] != node) node = parent[node] = parent[parent[node]];
    return node;
  };
  for (const ElementBlock& block : mesh.cells)
    for (std::size_t e = 0; e < block.size(); ++e)
      for (const Index node : block.element(e))
      {
        if (parent[node] < 0) parent[node] = node;
        parent[root(node)] = root(block.element(e)[0]);
      }
  for (std::size_t node = 0; node < parent.size(); ++node)
    if (parent[node] >= 0) parent[node] = root(static_cast<Index>(node));
  return parent;
}

WholeBodies::WholeBodies(const ImportedMesh& mesh) : body_(bodies_of_nodes(mesh)), size_(body_.size(), 0)
{
  for (const Index b : body_)
    if (b >= 0) ++size_[b];
}

std::set<Index> WholeBodies::within(std::span<const Index> nodes) const
{
  std::map<Index, Index> count;
  for (const Index node : nodes)
    if (body_[node] >= 0) ++count[body_[node]];
  std::set<Index> result;
  for (const auto& [body, n] : count)
    if (n == size_[body]) result.insert(body);
  return result;
}

SetsOfNodes::SetsOfNodes(std::size_t n_nodes, std::span<const std::span<const Index>> sets)
    : begin_(n_nodes + 1, 0)
{
  for (const auto& set : sets)
    for (const Index node : set) ++begin_[node + 1];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  sets_.resize(begin_.back());
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t s = 0; s < sets.size(); ++s)
    for (const Index node : sets[s]) sets_[next[node]++] = static_cast<Index>(s);
}

std::vector<Index> SetsOfNodes::with_all(std::span<const Index> nodes) const
{
  std::vector<Index> common(of(nodes[0]).begin(), of(nodes[0]).end());
  for (const Index node : nodes.subspan(1))
  {
    std::vector<Index> both;
    std::ranges::set_intersection(common, of(node), std::back_inserter(both));
    common = std::move(both);
    if (common.empty()) break;
  }
  return common;
}

namespace
{

class NodeSetFacets
{
 public:
  NodeSetFacets(ImportedMesh& mesh, std::vector<std::string>& notes) : mesh_(mesh), notes_(notes) {}

  void add()
  {
    for (const FacetSet& set : mesh_.facet_sets) known_.emplace(keys_of(set), set.name);
    leave_out_bodies();
    find_facets();
    for (std::size_t s = 0; s < mesh_.node_sets.size(); ++s) keep(s);
    mesh_.node_sets.clear();
    note("have all nodes of a body", bodies_);
    note("have no outer facet all of whose nodes are in the set", without_facets_);
    note("have the facets of another boundary", copies_);
  }

 private:
  using Keys = std::vector<FaceKey>;

  static Keys keys_of(const FacetSet& set)
  {
    Keys keys;
    for (const ElementBlock& block : set.facets)
      for (std::size_t f = 0; f < block.size(); ++f)
        keys.push_back(key_of(block.element(f).first(table_of(block.type.shape).n_corners)));
    std::ranges::sort(keys);
    return keys;
  }

  void leave_out_bodies()
  {
    const WholeBodies whole(mesh_);
    std::erase_if(mesh_.node_sets,
                  [&](const NodeSet& set)
                  {
                    const bool is_left_out = !set.has_facets && !whole.within(set.nodes).empty();
                    if (is_left_out) bodies_.push_back(set.name);
                    return is_left_out;
                  });
  }

  /// Gives each set the outer facets all of whose nodes are in it.
  void find_facets()
  {
    found_.resize(mesh_.node_sets.size());
    std::vector<std::span<const Index>> nodes_of_sets;
    for (const NodeSet& set : mesh_.node_sets) nodes_of_sets.emplace_back(set.nodes);
    const SetsOfNodes sets(mesh_.nodes.size(), nodes_of_sets);
    std::vector<char> is_marked(mesh_.nodes.size());
    for (std::size_t n = 0; n < is_marked.size(); ++n) is_marked[n] = sets.has(static_cast<Index>(n)) ? 1 : 0;
    for (const CellFace& face : CellFaces(mesh_.cells, is_marked).outer())
    {
      const FaceNodes nodes = nodes_of(mesh_.cells, face);
      for (const Index s : sets.with_all(nodes.span()))
        append(found_[s], nodes, mesh_.cells[face.block].numbers[face.element]);
    }
  }

  void keep(std::size_t s)
  {
    const NodeSet& set = mesh_.node_sets[s];
    FacetSet facets{set.name, std::move(found_[s])};
    if (facets.facets.empty() && set.has_facets)
      throw InputError(mesh_.source,
                       fmt::format("\"{}\" has no facet: no outer facet has all its nodes in it", set.name),
                       "a boundary needs all nodes of its facets, those in the middles of edges, too");
    if (facets.facets.empty())
    {
      without_facets_.push_back(set.name);
      return;
    }
    const auto [same, is_new] = known_.emplace(keys_of(facets), set.name);
    if (is_new)
      mesh_.facet_sets.push_back(std::move(facets));
    else if (same->second != set.name)
      copies_.push_back(fmt::format("{} (as {})", set.name, same->second));
  }

  void note(std::string_view reason, std::span<const std::string> sets)
  {
    constexpr std::size_t most = 8;
    if (sets.empty()) return;
    std::string names = fmt::format("{}", fmt::join(sets.first(std::min(most, sets.size())), ", "));
    if (sets.size() > most) names += fmt::format(" and {} more", sets.size() - most);
    notes_.push_back(fmt::format("node sets that are no boundaries, since they {}: {}", reason, names));
  }

  ImportedMesh& mesh_;
  std::vector<std::string>& notes_;
  std::vector<std::string> bodies_{};
  std::vector<std::string> without_facets_{};
  std::vector<std::string> copies_{};
  std::map<Keys, std::string> known_;               ///< facets of the boundaries so far
  std::vector<std::vector<ElementBlock>> found_{};  ///< per node set
};

}  // namespace

void add_node_sets(ImportedMesh& mesh, std::vector<std::string>& notes)
{
  if (!mesh.node_sets.empty()) NodeSetFacets(mesh, notes).add();
  std::set<std::string> names;
  for (const FacetSet& set : mesh.facet_sets)
    if (!names.insert(set.name).second)
      throw InputError(mesh.source,
                       fmt::format("two sets of different facets have the name \"{}\"", set.name),
                       "rename one of them");
}

}  // namespace tribound::mesh
