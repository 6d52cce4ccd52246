#include "tribound/mesh/import/frd_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace tribound::mesh
{

namespace
{

/// The edges between bottom and top come before those of the top; in decks and VTK it is the other way round.
constexpr std::array hexahedron_20 = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15};
constexpr std::array prism_15 = {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11};

struct FrdType
{
  int number;
  ElementType type;
  std::span<const int> order;  ///< place in the file of each node of ElementType; empty: the same
};

const std::array<FrdType, 10> frd_types = {{{1, {Shape::hexahedron, 8}, {}},
                                            {2, {Shape::prism, 6}, {}},
                                            {3, {Shape::tetrahedron, 4}, {}},
                                            {4, {Shape::hexahedron, 20}, hexahedron_20},
                                            {5, {Shape::prism, 15}, prism_15},
                                            {6, {Shape::tetrahedron, 10}, {}},
                                            {7, {Shape::triangle, 3}, {}},
                                            {8, {Shape::triangle, 6}, {}},
                                            {9, {Shape::quadrilateral, 4}, {}},
                                            {10, {Shape::quadrilateral, 8}, {}}}};

}  // namespace

Index FrdMesh::node(std::int64_t number, std::string_view of) const
{
  const auto found = node_of_number_.find(number);
  if (found == node_of_number_.end())
    records_.fail(
        fmt::format("node {} of {} does not exist: the file has {} nodes", number, of, mesh_.nodes.size()));
  return found->second;
}

void FrdMesh::read_nodes()
{
  if (!mesh_.nodes.empty())
    records_.fail("the file has a second mesh", "results on one mesh: of one calculation");
  const std::size_t width = records_.width_of_numbers();
  for (records_.next_in("nodes"); records_.key() != "-3"; records_.next_in("nodes"))
  {
    if (records_.key() != "-1") records_.fail("a node begins with -1");
    const std::int64_t label = records_.integer(FrdRecords::n_key, width, "the number of a node");
    const auto x = [&](std::size_t i)
    { return records_.number(FrdRecords::n_key + width + 12 * i, "a coordinate"); };
    const Point<3> position(x(0), x(1), x(2));
    if (!position.allFinite()) records_.fail(fmt::format("node {} has no finite coordinates", label));
    if (!node_of_number_.try_emplace(label, static_cast<Index>(mesh_.nodes.size())).second)
      records_.fail(fmt::format("node {} is there twice", label));
    mesh_.nodes.push_back(position);
    mesh_.node_numbers.push_back(label);
  }
}

void FrdMesh::read_elements()
{
  if (!mesh_.cells.empty()) records_.fail("the file has a second mesh", "results on one mesh");
  const std::size_t width = records_.width_of_numbers();
  for (records_.next_in("elements"); records_.key() != "-3"; records_.next_in("elements"))
    read_element(width);
}

void FrdMesh::read_element(std::size_t width)
{
  if (records_.key() != "-1") records_.fail("an element begins with -1");
  const std::int64_t label = records_.integer(FrdRecords::n_key, width, "the number of an element");
  const std::int64_t number_of_type =
      records_.integer(FrdRecords::n_key + width, 5, "the type of an element");
  if (number_of_type == 11 || number_of_type == 12)
    records_.fail(fmt::format("element {} is a beam", label), "beams have no counterpart: leave them out");
  const auto type = std::ranges::find(frd_types, number_of_type, &FrdType::number);
  if (type == frd_types.end())
    records_.fail(fmt::format("element {} is of type {}, which is not read", label, number_of_type),
                  "types 1 to 10");
  auto block = std::ranges::find(mesh_.cells, type->type, &ElementBlock::type);
  if (block == mesh_.cells.end()) block = mesh_.cells.insert(block, ElementBlock{.type = type->type});
  std::vector<Index> nodes;
  const std::size_t n_per_line = width == 5 ? 15 : 10;
  const std::string name = fmt::format("element {}", label);
  for (int i = 0; i < type->type.n_nodes; ++i)
  {
    const std::size_t place = static_cast<std::size_t>(i) % n_per_line;
    if (place == 0) records_.next_in("elements");
    if (records_.key() != "-2") records_.fail(fmt::format("the nodes of {} begin with -2", name));
    nodes.push_back(
        node(records_.integer(FrdRecords::n_key + width * place, width, "the number of a node"), name));
  }
  for (int i = 0; i < type->type.n_nodes; ++i)
    block->nodes.push_back(nodes[type->order.empty() ? i : type->order[i]]);
  block->numbers.push_back(label);
}

/// Plane elements are those of plane problems; shells have the same numbers.
void FrdMesh::check() const
{
  if (mesh_.cells.empty()) throw InputError(records_.where(), "the file has no elements", damaged_frd);
  const auto is_plane = [](const ElementBlock& block) { return table_of(block.type.shape).dim == 2; };
  const auto plane = std::ranges::find_if(mesh_.cells, is_plane);
  if (plane == mesh_.cells.end()) return;
  const double z = mesh_.nodes[plane->nodes[0]][2];
  double size = 0;
  bool is_flat = std::ranges::all_of(mesh_.cells, is_plane);
  for (const Point<3>& x : mesh_.nodes) size = std::max(size, x.lpNorm<Eigen::Infinity>());
  for (const ElementBlock& block : mesh_.cells)
    for (const Index v : block.nodes) is_flat = is_flat && std::abs(mesh_.nodes[v][2] - z) <= 1e-5 * size;
  if (!is_flat)
    throw InputError(records_.where(), fmt::format("element {} is a shell", plane->numbers[0]),
                     "shells have no counterpart: solids only, or in 2D plane elements only");
}

}  // namespace tribound::mesh
