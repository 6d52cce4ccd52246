#include "tribound/mesh/bisect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <limits>
#include <utility>

#include "tribound/mesh/marked_cell.h"

namespace tribound::mesh
{

namespace
{

/// The middles of edges, found by their ends. A list of edges at the end with the larger number: an edge that
/// bisection makes has its newer end there, so that the lists stay short.
class Middles
{
 public:
  explicit Middles(Index n_vertices) : first_(n_vertices, -1), n_vertices_(n_vertices) {}

  /// The vertex in the middle of the edge, or -1 when it is whole.
  [[nodiscard]] Index find(Index a, Index b) const
  {
    if (a < b) std::swap(a, b);
    Index middle = first_[a];
    while (middle >= 0 && edges_[middle - n_vertices_].lower_end != b)
      middle = edges_[middle - n_vertices_].next;
    return middle;
  }

  /// Gives the edge a middle: the vertex next in number.
  Index add(Index a, Index b)
  {
    if (a < b) std::swap(a, b);
    const auto middle = static_cast<Index>(first_.size());
    edges_.push_back({b, first_[a]});
    first_[a] = middle;
    first_.push_back(-1);
    return middle;
  }

 private:
  struct Edge
  {
    Index lower_end;
    Index next;  ///< middle of the next edge with the same larger end, or -1
  };

  std::vector<Index> first_;  ///< per vertex: middle of an edge whose larger end it is, or -1
  std::vector<Edge> edges_;   ///< by number of the middle
  Index n_vertices_;          ///< without the middles
};

/// The cells of the original mesh as roots of binary trees; the leaves are the cells of the bisected mesh.
template <int dim>
class Forest
{
 public:
  explicit Forest(const Mesh<dim>& mesh)
      : mesh_(&mesh),
        points_(mesh.vertices().begin(), mesh.vertices().end()),
        ancestry_(mesh.ancestry()),
        middles_(mesh.n_vertices()),
        queued_(mesh.n_cells(), 0)
  {
    ancestry_.n_vertices.push_back(mesh.n_vertices());
    nodes_.reserve(mesh.n_cells());
    const auto types = mesh.bisection_types();
    for (Index c = 0; c < mesh.n_cells(); ++c)
      nodes_.push_back({.cell = types.empty() ? longest_edges_marked<dim>(points_, mesh.cell(c))
                                              : MarkedCell<dim>{mesh.cell(c), types[c]}});
  }

  /// Asks for `times` bisections of a root.
  void demand(Index root, int times) { nodes_[root].due = times; }

  /// Bisects what is due, and every leaf with an edge that has a middle, until there is none. This ends:
  /// bisected dim times each, all cells of a conforming mesh make a conforming one [AMP00], so that no leaf
  /// gets below the next multiple of dim. The order does not change the result.
  void close()
  {
    for (Index root = 0; root < mesh_->n_cells(); ++root)
      if (nodes_[root].due > 0) enqueue(root);
    for (std::size_t next = 0; next < queue_.size(); ++next)
    {
      const Index root = queue_[next];
      queued_[root] = 0;
      refine(root);
    }
  }

  /// The leaves as a mesh, and the root of each in `parent`.
  [[nodiscard]] MeshData<dim> leaves(std::vector<Index>& parent) const
  {
    MeshData<dim> data;
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
    data.region_names.assign(mesh_->region_names().begin(), mesh_->region_names().end());
    data.boundary_names.assign(mesh_->boundary_names().begin(), mesh_->boundary_names().end());
    data.source = mesh_->source();
    data.ancestry = ancestry_;
    return data;
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
    if (middle < 0) middle = halve_edge(a, b);
    nodes_[n].first_child = static_cast<Index>(nodes_.size());
    for (int kept = 0; kept < 2; ++kept)
      nodes_.push_back({.cell = child(node.cell, kept, middle), .due = std::max(node.due - 1, 0)});
  }

  /// Makes the middle of an edge and queues the roots that contain the edge: those that contain both ends,
  /// since they are convex.
  Index halve_edge(Index a, Index b)
  {
    points_.push_back(0.5 * (points_[a] + points_[b]));
    ancestry_.halved_edges.push_back({a, b});
    common_.clear();
    std::ranges::set_intersection(roots_at(a), roots_at(b), std::back_inserter(common_));
    roots_.insert(roots_.end(), common_.begin(), common_.end());
    roots_end_.push_back(roots_.size());
    for (const Index root : common_) enqueue(root);
    return middles_.add(a, b);
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

  /// The pieces of a facet with its marked edge in front: like cells, the halves of a face are marked
  /// opposite to the new vertex.
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
  std::vector<Index> roots_;            ///< that contain each middle, one middle behind the other
  std::vector<std::size_t> roots_end_;  ///< per middle
  std::vector<Index> common_;           ///< working space
  std::vector<Index> queue_;            ///< roots to look at, in the order of their turns
  std::vector<char> queued_;            ///< per root
};

/// In a scope of its own, so that the forest is gone when the mesh is built.
template <int dim>
MeshData<dim> bisected_data(const Mesh<dim>& mesh, std::span<const Index> marked, int times,
                            std::vector<Index>& parent)
{
  Forest<dim> forest(mesh);
  for (const Index c : marked)
  {
    assert(c >= 0 && c < mesh.n_cells());
    forest.demand(c, times);
  }
  forest.close();
  return forest.leaves(parent);
}

}  // namespace

template <int dim>
Bisected<dim> bisect(const Mesh<dim>& mesh, std::span<const Index> marked, int times)
{
  assert(times >= 1);
  std::vector<Index> parent;
  MeshData<dim> data = bisected_data(mesh, marked, times, parent);
  return {Mesh<dim>(std::move(data)), std::move(parent)};
}

template Bisected<2> bisect(const Mesh<2>&, std::span<const Index>, int);
template Bisected<3> bisect(const Mesh<3>&, std::span<const Index>, int);

}  // namespace tribound::mesh
