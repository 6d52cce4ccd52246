#include "tribound/mesh/import/coincident_nodes.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <vector>

#include "tribound/mesh/import/cell_sets.h"

namespace tribound::mesh
{

std::size_t n_coincident(const ImportedMesh& mesh)
{
  const std::vector<Index> set_of_cell = set_of_cells(mesh);
  std::vector<Index> set_of_node(mesh.nodes.size(), -1);
  std::size_t cell = 0;
  for (const ElementBlock& block : mesh.cells)
    for (std::size_t e = 0; e < block.size(); ++e, ++cell)
      for (const Index node : block.element(e)) set_of_node[node] = std::max(set_of_cell[cell], 0);

  std::vector<Index> order(mesh.nodes.size());
  std::iota(order.begin(), order.end(), 0);
  std::erase_if(order, [&](Index node) { return set_of_node[node] < 0; });
  const auto key = [&](Index node)
  {
    const Point<3>& x = mesh.nodes[node];
    return std::tuple(x[0], x[1], x[2], set_of_node[node]);
  };
  std::ranges::sort(order, {}, key);
  std::size_t n = 0;
  for (std::size_t i = 0; i < order.size(); ++i)
    n += (i > 0 && key(order[i - 1]) == key(order[i])) ||
                 (i + 1 < order.size() && key(order[i]) == key(order[i + 1]))
             ? 1
             : 0;
  return n;
}

}  // namespace tribound::mesh
