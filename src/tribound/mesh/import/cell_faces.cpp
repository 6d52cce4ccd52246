#include "tribound/mesh/import/cell_faces.h"

#include <algorithm>

namespace tribound::mesh
{

FaceKey key_of(std::span<const Index> corners)
{
  FaceKey key = {-1, -1, -1, -1};
  std::ranges::copy(corners, key.begin());
  std::ranges::sort(key);
  return key;
}

FaceNodes nodes_of(std::span<const ElementBlock> cells, const CellFace& face)
{
  const ElementBlock& block = cells[face.block];
  const FaceElement local = face_element(block.type, face.face);
  FaceNodes result{local.type, {}};
  for (int i = 0; i < local.type.n_nodes; ++i) result.nodes[i] = block.element(face.element)[local.nodes[i]];
  return result;
}

void append(std::vector<ElementBlock>& facets, const FaceNodes& face, std::int64_t number)
{
  auto block = std::ranges::find(facets, face.type, &ElementBlock::type);
  if (block == facets.end()) block = facets.insert(facets.end(), {.type = face.type});
  block->nodes.insert(block->nodes.end(), face.span().begin(), face.span().end());
  block->numbers.push_back(number);
}

CellFaces::CellFaces(std::span<const ElementBlock> cells, std::span<const char> is_marked)
{
  for (std::size_t b = 0; b < cells.size(); ++b)
  {
    const ShapeTable& table = table_of(cells[b].type.shape);
    for (std::size_t e = 0; e < cells[b].size(); ++e)
      for (int f = 0; f < table.n_faces; ++f)
      {
        const std::span<const Index> nodes = cells[b].element(e);
        const std::span<const int> local = table.faces[f].span();
        if (!std::ranges::all_of(local, [&](int i) { return is_marked[nodes[i]] != 0; })) continue;
        std::array<Index, 4> corners{};
        std::ranges::transform(local, corners.begin(), [&](int i) { return nodes[i]; });
        faces_.push_back({key_of(std::span<const Index>(corners).first(local.size())), static_cast<int>(b),
                          static_cast<Index>(e), f});
      }
  }
  std::ranges::sort(faces_, {}, &CellFace::key);
}

bool CellFaces::contains(const FaceKey& key) const
{
  return std::ranges::binary_search(faces_, key, {}, &CellFace::key);
}

std::vector<CellFace> CellFaces::outer() const
{
  std::vector<CellFace> result;
  for (std::size_t i = 0; i < faces_.size(); ++i)
    if ((i == 0 || faces_[i - 1].key != faces_[i].key) &&
        (i + 1 == faces_.size() || faces_[i + 1].key != faces_[i].key))
      result.push_back(faces_[i]);
  return result;
}

CellFaces faces_beside(std::span<const ElementBlock> cells, std::size_t n_nodes,
                       std::span<const ElementBlock> facets)
{
  std::vector<char> is_marked(n_nodes, 0);
  for (const ElementBlock& block : facets)
    for (const Index node : block.nodes) is_marked[node] = 1;
  return {cells, is_marked};
}

std::optional<FacetPlace> first_without_cell(std::span<const ElementBlock> cells, std::size_t n_nodes,
                                             std::span<const ElementBlock> facets)
{
  if (facets.empty()) return {};
  const CellFaces faces = faces_beside(cells, n_nodes, facets);
  for (std::size_t b = 0; b < facets.size(); ++b)
    for (std::size_t f = 0; f < facets[b].size(); ++f)
      if (!faces.contains(key_of(facets[b].element(f).first(table_of(facets[b].type.shape).n_corners))))
        return FacetPlace{b, f};
  return {};
}

}  // namespace tribound::mesh
