#include "tribound/mesh/bisect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "tribound/mesh/marked_cell.h"
#include "tribound/mesh/middles.h"
#include "tribound/mesh/shared_vertices.h"

namespace tribound::mesh
{

namespace
{

/// The own cells of the original mesh as roots of binary trees; the leaves are those of the bisected mesh.
template <int dim>
class Forest
{
 public:
  Forest(const Mesh<dim>& mesh, std::span<const TwinFacets<dim>> twins)
      : mesh_(&mesh),
        points_(mesh.vertices().begin(), mesh.vertices().end()),
        ancestry_(mesh.ancestry()),
        middles_(mesh.n_vertices()),
        opposite_(mesh, twins),
        queued_(mesh.n_owned_cells(), 0)
  {
    if (mesh.partition()) shared_.emplace(*mesh.partition(), twins);
    ancestry_.n_vertices.push_back(mesh.n_vertices());
    nodes_.reserve(mesh.n_owned_cells());
    for (Index c = 0; c < mesh.n_owned_cells(); ++c)
      nodes_.push_back({.cell = marked_cell<dim>(points_, mesh.cells(), mesh.bisection_types(), c)});
  }

  /// Asks for `times` bisections of a root.
  void demand(Index root, int times) { nodes_[root].due = times; }

  /// Performs the bisections due, and bisects every leaf with a halved edge, until none is left. This ends:
  /// all cells of a conforming mesh, bisected dim times each, form a conforming one [AMP00], so that no leaf
  /// gets below the next multiple of dim. The order does not change the result.
  void close()
  {
    for (Index root = 0; root < mesh_->n_owned_cells(); ++root)
      if (nodes_[root].due > 0) enqueue(root);
    const auto halve_as_told = [this](Index a, Index b)
    {
      const bool is_passed_on = !opposite_.of(a, b).empty();
      if (middles_.find(a, b) < 0) halve_edge(a, b, is_passed_on);
    };
    do together([this] { refine_queued(); });
    while (shared_ && shared_->exchange(halve_as_told));
  }

  /// The leaves as a mesh, and the root of each in `parent`.
  [[nodiscard]] MeshData<dim> leaves(std::vector<Index>& parent) const
  {
    MeshData<dim> data{mesh_->labels()};
    data.vertices = points_;
    const std::size_t n_leaves = (nodes_.size() + mesh_->n_cells()) / 2;
    data.cells.reserve(n_leaves);
    data.regions.reserve(n_leaves);
    data.bisection_types.reserve(n_leaves);
    parent.reserve(n_leaves);
    for (Index root = 0; root < mesh_->n_cells(); ++root)
    {
      add_leaves(root, data);
      data.regions.resize(data.cells.size(), mesh_->region(root));
      parent.resize(data.cells.size(), root);
    }
    for (const auto& [cell, local, tag] : mesh_->boundary())
    {
      if (tag < 0) continue;
      const auto& root = nodes_[cell].cell;
      const auto opposite = std::ranges::find(root.vertices, mesh_->cell(cell)[local]);
      const auto root_local = static_cast<int>(opposite - root.vertices.begin());
      add_facets({marked_facet(root, root_local), tag}, data.facets);
    }
    data.ancestry = ancestry_;
    return data;
  }

  /// The leaves as records that travel, and the root of each in `parent`.
  [[nodiscard]] std::vector<CellRecord<dim>> records(std::vector<Index>& parent) const
  {
    std::vector<CellRecord<dim>> result;
    const std::vector<CellTags<dim>> tags = cell_tags<dim>(mesh_->n_cells(), mesh_->boundary());
    for (Index root = 0; root < mesh_->n_owned_cells(); ++root)
    {
      add_records(root, mesh_->partition()->names[root], tags[root], mesh_->region(root), result);
      parent.resize(result.size(), root);
    }
    return result;
  }

 private:
  struct Node
  {
    MarkedCell<dim> cell;
    Index first_child = -1;  ///< the second is behind it; -1: a leaf
    Index due = 0;           ///< bisections asked for
  };

  [[nodiscard]] bool has_middle(const Cell<dim>& cell) const
  {
    return std::ranges::any_of(
        local_edges<dim>, [&](const auto& edge) { return middles_.find(cell[edge[0]], cell[edge[1]]) >= 0; });
  }

  /// Work that may fail, and then fails on all ranks.
  template <class Work>
  void together(const Work& work) const
  {
    if (shared_)
      mesh_->partition()->ranks.together(work);
    else
      work();
  }

  void refine_queued()
  {
    for (std::size_t next = 0; next < queue_.size(); ++next)
    {
      const Index root = queue_[next];
      queued_[root] = 0;
      refine(root);
    }
    queue_.clear();
  }

  void enqueue(Index root)
  {
    if (queued_[root] != 0) return;
    queued_[root] = 1;
    queue_.push_back(root);
  }

  /// Bisects the leaves below a node where they have to be.
  void refine(Index n)
  {
    if (nodes_[n].first_child < 0)
    {
      if (nodes_[n].due == 0 && !has_middle(nodes_[n].cell.vertices)) return;
      cut(n);
    }
    refine(nodes_[n].first_child);
    refine(nodes_[n].first_child + 1);
  }

  void cut(Index n)
  {
    if (nodes_.size() + 2 > std::numeric_limits<Index>::max())
      throw InputError(mesh_->source(), "bisected further, the mesh has too many cells for 32-bit numbers",
                       "limit the refinement: adapt.max_cells, adapt.max_dofs");
    const Node node = nodes_[n];
    const Index a = node.cell.vertices[0];
    const Index b = node.cell.vertices[1];
    Index middle = middles_.find(a, b);
    if (middle < 0) middle = halve_edge(a, b, true);
    nodes_[n].first_child = static_cast<Index>(nodes_.size());
    for (int kept = 0; kept < 2; ++kept)
      nodes_.push_back({.cell = child(node.cell, kept, middle), .due = std::max(node.due - 1, 0)});
  }

  /// Makes the middle of an edge, and those of the opposite edges, and queues the roots that contain it:
  /// those that contain both ends, since they are convex. `is_news`: other ranks do not know of it.
  Index halve_edge(Index a, Index b, bool is_news)
  {
    if (shared_) shared_->add_middle(a, b, is_news);
    points_.push_back(0.5 * (points_[a] + points_[b]));
    ancestry_.halved_edges.push_back({a, b});
    common_.clear();
    std::ranges::set_intersection(roots_at(a), roots_at(b), std::back_inserter(common_));
    while (!common_.empty() && common_.back() >= mesh_->n_owned_cells()) common_.pop_back();  // ghosts
    roots_.insert(roots_.end(), common_.begin(), common_.end());
    roots_end_.push_back(roots_.size());
    for (const Index root : common_) enqueue(root);
    const Index middle = middles_.add(a, b);
    for (const auto& [c, d, side] : opposite_.of(a, b))
      if (const Index there = middles_.find(c, d); there >= 0)
        opposite_.link(middle, side, there);
      else
        halve_edge(c, d, true);  // links both
    return middle;
  }

  /// The roots that contain the vertex, ascending.
  [[nodiscard]] std::span<const Index> roots_at(Index v) const
  {
    const Topology<dim>& topology = mesh_->topology();
    if (v < mesh_->n_vertices())
      return std::span(topology.vertex_cells)
          .subspan(topology.vertex_cells_begin[v],
                   topology.vertex_cells_begin[v + 1] - topology.vertex_cells_begin[v]);
    const Index middle = v - mesh_->n_vertices();
    const std::size_t begin = middle == 0 ? 0 : roots_end_[middle - 1];
    return std::span(roots_).subspan(begin, roots_end_[middle] - begin);
  }

  void add_leaves(Index n, MeshData<dim>& data) const
  {
    const auto& [cell, first_child, due] = nodes_[n];
    if (first_child < 0)
    {
      data.cells.push_back(cell.vertices);
      data.bisection_types.push_back(cell.type);
      return;
    }
    add_leaves(first_child, data);
    add_leaves(first_child + 1, data);
  }

  void add_records(Index n, const CellName& name, const CellTags<dim>& tags, int region,
                   std::vector<CellRecord<dim>>& records) const
  {
    const Node& node = nodes_[n];
    if (node.first_child < 0)
    {
      CellRecord<dim>& record = records.emplace_back();
      record.name = name;
      record.tags = tags;
      record.region = region;
      record.bisection_type = node.cell.type;
      for (int i = 0; i <= dim; ++i) record.vertices[i] = shared_->name(node.cell.vertices[i]);
      return;
    }
    if (name.depth == CellName::max_depth)
      throw InputError(mesh_->source(),
                       fmt::format("a cell is bisected more than {} times", CellName::max_depth),
                       "limit the refinement: adapt.max_levels, adapt.max_dofs");
    for (int kept = 0; kept < 2; ++kept)
    {
      const Index child = node.first_child + kept;
      add_records(child, name.child(kept),
                  child_tags(node.cell.vertices, tags, kept, nodes_[child].cell.vertices), region, records);
    }
  }

  /// The last facet of a child is the parent's facet opposite to the lost vertex. The facet opposite to the
  /// kept vertex is inside; the others are halves of the parent's.
  static CellTags<dim> child_tags(const Cell<dim>& parent, const CellTags<dim>& tags, int kept,
                                  const Cell<dim>& child)
  {
    CellTags<dim> result;
    for (int i = 0; i < dim; ++i)
      result[i] = child[i] == parent[kept] ? facet_inside
                                           : tags[std::ranges::find(parent, child[i]) - parent.begin()];
    result[dim] = tags[1 - kept];
    return result;
  }

  /// The pieces of a facet, marked edge first. As in cells, the halves of a face are marked opposite to the
  /// new vertex.
  void add_facets(const TaggedFacet<dim>& facet, std::vector<TaggedFacet<dim>>& pieces) const
  {
    const Index middle = middles_.find(facet.vertices[0], facet.vertices[1]);
    if (middle < 0)
    {
      pieces.push_back(facet);
      return;
    }
    for (int kept = 0; kept < 2; ++kept)
    {
      TaggedFacet<dim> half = facet;
      half.vertices[0] = facet.vertices[kept];
      if constexpr (dim == 3) half.vertices[1] = facet.vertices[2];
      half.vertices[dim - 1] = middle;
      add_facets(half, pieces);
    }
  }

  const Mesh<dim>* mesh_;
  std::vector<Point<dim>> points_;
  Ancestry ancestry_;  ///< of the bisected mesh
  std::vector<Node> nodes_;
  Middles middles_;
  OppositeEdges<dim> opposite_;
  std::vector<Index> roots_;                   ///< that contain each middle, one middle behind the other
  std::vector<std::size_t> roots_end_;         ///< per middle
  std::vector<Index> common_;                  ///< working space
  std::vector<Index> queue_;                   ///< roots to be processed, in this order
  std::vector<char> queued_;                   ///< per root
  std::optional<SharedVertices<dim>> shared_;  ///< of a mesh that is shared out
};

/// Given as a value, so that it is gone when the mesh is built.
template <int dim>
Forest<dim> closed_forest(const Mesh<dim>& mesh, std::span<const Index> marked, int times,
                          std::span<const TwinFacets<dim>> twins)
{
  assert(times >= 1);
  Forest<dim> forest(mesh, twins);
  for (const Index c : marked)
  {
    assert(c >= 0 && c < mesh.n_owned_cells());
    forest.demand(c, times);
  }
  forest.close();
  return forest;
}

}  // namespace

template <int dim>
Bisected<dim> bisect(const Mesh<dim>& mesh, std::span<const Index> marked, int times,
                     std::span<const TwinFacets<dim>> twins)
{
  std::vector<Index> parent;
  MeshData<dim> data = closed_forest(mesh, marked, times, twins).leaves(parent);
  return {Mesh<dim>(std::move(data)), std::move(parent)};
}

template <int dim>
BisectedPart<dim> bisect_part(const Mesh<dim>& mesh, std::span<const Index> marked, int times,
                              std::span<const TwinFacets<dim>> twins)
{
  assert(mesh.partition());
  const Forest<dim> forest = closed_forest(mesh, marked, times, twins);
  BisectedPart<dim> result;
  mesh.partition()->ranks.together([&] { result.cells = forest.records(result.parent); });
  return result;
}

template Bisected<2> bisect(const Mesh<2>&, std::span<const Index>, int, std::span<const TwinFacets<2>>);
template Bisected<3> bisect(const Mesh<3>&, std::span<const Index>, int, std::span<const TwinFacets<3>>);
template BisectedPart<2> bisect_part(const Mesh<2>&, std::span<const Index>, int,
                                     std::span<const TwinFacets<2>>);
template BisectedPart<3> bisect_part(const Mesh<3>&, std::span<const Index>, int,
                                     std::span<const TwinFacets<3>>);

}  // namespace tribound::mesh
