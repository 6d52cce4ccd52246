#include "tribound/mesh/cut_facets.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "tribound/mesh/marked_cell.h"

namespace tribound::mesh
{

namespace
{

/// A part of a cell, with its vertices in the order of the cell.
struct Piece
{
  Cell<2> vertices;
  CellTags<2> tags;
  CellName name;
};

/// All own cells in pieces.
class Pieces
{
 public:
  Pieces(const Mesh<2>& mesh, std::span<const FacetCuts> cuts)
      : mesh_(mesh), points_(mesh.vertices().begin(), mesh.vertices().end())
  {
    const Partition<2>* const partition = mesh.partition();
    if (partition) names_ = partition->vertices;
    const std::vector<CellTags<2>> tags = cell_tags<2>(mesh.n_cells(), mesh.boundary());
    std::vector<const FacetCuts*> ordered;
    for (const FacetCuts& facet : cuts) ordered.push_back(&facet);
    std::ranges::stable_sort(ordered, {}, &FacetCuts::cell);
    auto next = ordered.begin();
    for (Index c = 0; c < mesh.n_owned_cells(); ++c)
    {
      std::vector<Piece> pieces{{mesh.cell(c), tags[c], partition ? partition->names[c] : CellName{}}};
      for (; next != ordered.end() && (*next)->cell == c; ++next) cut(**next, pieces);
      std::ranges::move(pieces, std::back_inserter(pieces_));
      parent_.resize(pieces_.size(), c);
    }
  }

  [[nodiscard]] Bisected<2> mesh()
  {
    MeshData<2> data{mesh_.labels()};
    for (std::size_t k = 0; k < pieces_.size(); ++k)
    {
      const Piece& piece = pieces_[k];
      const MarkedCell<2> marked = this->marked(k);
      data.cells.push_back(marked.vertices);
      data.bisection_types.push_back(marked.type);
      data.regions.push_back(mesh_.region(parent_[k]));
      for (int i = 0; i < 3; ++i)
        if (piece.tags[i] >= 0) data.facets.push_back({facet_vertices(piece.vertices, i), piece.tags[i]});
    }
    data.vertices = std::move(points_);
    return {Mesh<2>(std::move(data)), std::move(parent_)};
  }

  [[nodiscard]] BisectedPart<2> part()
  {
    BisectedPart<2> result;
    for (std::size_t k = 0; k < pieces_.size(); ++k)
    {
      const Piece& piece = pieces_[k];
      const MarkedCell<2> marked = this->marked(k);
      CellRecord<2>& record = result.cells.emplace_back();
      record.name = piece.name;
      record.region = mesh_.region(parent_[k]);
      record.bisection_type = marked.type;
      for (int i = 0; i < 3; ++i)
      {
        record.vertices[i] = names_[marked.vertices[i]];
        record.tags[i] = piece.tags[local(piece, marked.vertices[i])];
      }
    }
    result.parent = std::move(parent_);
    return result;
  }

 private:
  /// Piece k as bisection continues with it; whole cells are as before.
  [[nodiscard]] MarkedCell<2> marked(std::size_t k) const
  {
    const Cell<2>& vertices = pieces_[k].vertices;
    return vertices == mesh_.cell(parent_[k])
               ? marked_cell<2>(points_, mesh_.cells(), mesh_.bisection_types(), parent_[k])
               : longest_edges_marked<2>(points_, vertices);
  }
  /// The number of a vertex in a piece; 3 if it has none there.
  [[nodiscard]] static std::size_t local(const Piece& piece, Index v)
  {
    return std::ranges::find(piece.vertices, v) - piece.vertices.begin();
  }
  /// One half of a piece whose facet is cut at `middle`: the one that keeps the end `kept` of the facet.
  [[nodiscard]] Piece half(const Piece& whole, Index kept, Index lost, Index middle, int number) const
  {
    if (mesh_.partition() && whole.name.depth == CellName::max_depth)
      throw InputError(mesh_.source(), fmt::format("a cell is cut more than {} times", CellName::max_depth),
                       "limit the refinement: adapt.max_levels, adapt.max_dofs");
    Piece result = whole;
    if (mesh_.partition()) result.name = whole.name.child(number);
    result.vertices[local(whole, lost)] = middle;
    result.tags[local(whole, kept)] = facet_inside;
    return result;
  }
  /// Cuts the piece that has the facet, then the remaining part with the next cut, and so on.
  void cut(const FacetCuts& facet, std::vector<Piece>& pieces)
  {
    const std::array<Index, 2> ends = facet_vertices(mesh_.cell(facet.cell), facet.local);
    const Index last = ends[1];
    const Point<2> a = mesh_.vertex(ends[0]);
    const Point<2> b = mesh_.vertex(last);
    Index left = ends[0];
    for (const double at : facet.at)
    {
      const Index middle = static_cast<Index>(points_.size());
      points_.push_back((1 - at) * a + at * b);
      if (mesh_.partition())
        names_.push_back(vertex_name<2>(points_.back(), mix(hash(names_[left]) + hash(names_[last]))));
      const auto has_facet = [&](const Piece& piece)
      { return local(piece, left) < piece.vertices.size() && local(piece, last) < piece.vertices.size(); };
      const auto place = std::ranges::find_if(pieces, has_facet);
      const Piece whole = *place;
      *place = half(whole, left, last, middle, 0);
      pieces.insert(place + 1, half(whole, last, left, middle, 1));
      left = middle;
    }
  }

  const Mesh<2>& mesh_;
  std::vector<Point<2>> points_;
  std::vector<VertexName<2>> names_;  ///< of a mesh that is shared out
  std::vector<Piece> pieces_;
  std::vector<Index> parent_;  ///< per piece
};

}  // namespace

Bisected<2> cut_facets(const Mesh<2>& mesh, std::span<const FacetCuts> cuts)
{
  return Pieces(mesh, cuts).mesh();
}

BisectedPart<2> cut_facets_part(const Mesh<2>& mesh, std::span<const FacetCuts> cuts)
{
  BisectedPart<2> result;
  mesh.ranks().together([&] { result = Pieces(mesh, cuts).part(); });
  return result;
}

}  // namespace tribound::mesh
