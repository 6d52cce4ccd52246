#include "tribound/mesh/import/face_centres.h"

#include <algorithm>
#include <iterator>

namespace tribound::mesh
{

void order_face_centres(ElementBlock& block, std::span<const Point<3>> x)
{
  const ShapeTable& table = table_of(block.type.shape);
  const int first = table.n_corners + table.n_edges;
  if (table.dim < 3 || block.type.n_nodes <= first + 1) return;
  for (std::size_t e = 0; e < block.size(); ++e)
  {
    const auto nodes = std::span(block.nodes).subspan(e * block.type.n_nodes, block.type.n_nodes);
    auto rest = nodes.subspan(first);
    for (int f = 0; f < table.n_faces; ++f)
    {
      if (table.faces[f].n < 4) continue;
      Point<3> middle = Point<3>::Zero();
      for (const int c : table.faces[f].span()) middle += x[nodes[c]] / 4;
      const auto nearest =
          std::ranges::min_element(rest, {}, [&](Index node) { return (x[node] - middle).squaredNorm(); });
      std::iter_swap(rest.begin(), nearest);
      rest = rest.subspan(1);
    }
  }
}

}  // namespace tribound::mesh
