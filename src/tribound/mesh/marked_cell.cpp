#include "tribound/mesh/marked_cell.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tribound/mesh/geometry.h"

namespace tribound::mesh
{

namespace
{

constexpr std::uint8_t type_of(int a, int b, bool second_in_plane)
{
  return static_cast<std::uint8_t>(a + 3 * b + (second_in_plane ? 9 : 0));
}

/// a or b of the type.
constexpr int marked_opposite_to(std::uint8_t type, int facet)
{
  return facet == 0 ? type % 3 : type / 3 % 3;
}

constexpr bool second_in_plane(std::uint8_t type)
{
  return type >= 9;
}

/// The marked edges of the facets 0 and 1 meet in a vertex, and so span a plane with the refinement edge.
constexpr bool in_plane(std::uint8_t type)
{
  return marked_opposite_to(type, 0) == marked_opposite_to(type, 1) && marked_opposite_to(type, 0) != 0;
}

/// The squared distance, computed in one way only, whatever the compiler does, since lengths are compared.
template <int dim>
double squared_distance(const Point<dim>& x, const Point<dim>& y)
{
  double sum = 0;
  for (int i = 0; i < dim; ++i) sum = std::fma(x[i] - y[i], x[i] - y[i], sum);
  return sum;
}

/// The longest of the edges between the vertices; among equally long ones the last in the lexicographic order
/// of the coordinates of its ends, lower end first.
template <int dim, std::size_t n>
std::array<Index, 2> longest_edge(std::span<const Point<dim>> points, const std::array<Index, n>& vertices)
{
  std::array<Index, 2> longest{};
  double longest_squared = -1;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
    {
      std::array edge{vertices[i], vertices[j]};
      const double squared = squared_distance(points[edge[0]], points[edge[1]]);
      if (squared < longest_squared) continue;
      if (comes_before(points[edge[1]], points[edge[0]])) std::swap(edge[0], edge[1]);
      const int first_different = edge[0] == longest[0] ? 1 : 0;
      if (squared == longest_squared &&
          comes_before(points[edge[first_different]], points[longest[first_different]]))
        continue;
      longest = edge;
      longest_squared = squared;
    }
  return longest;
}

}  // namespace

template <int dim>
std::array<Index, dim> marked_facet(const MarkedCell<dim>& cell, int local)
{
  auto facet = facet_vertices(cell.vertices, local);
  if (dim == 3 && local < 2)
  {
    const auto apex = facet.begin() + marked_opposite_to(cell.type, local);
    std::rotate(apex, apex + 1, facet.end());
  }
  return facet;
}

template <int dim>
MarkedCell<dim> child(const MarkedCell<dim>& parent, int kept, Index middle)
{
  const std::array<Index, dim> shared = marked_facet(parent, 1 - kept);
  MarkedCell<dim> result{{}, 0};
  std::copy(shared.begin(), shared.end(), result.vertices.begin());
  result.vertices[dim] = middle;

  // Transpositions from the parent with `middle` in the place of the vertex lost: to the end, then the apex
  // of the shared facet to the place before it.
  int n_transpositions = dim - (1 - kept);
  if constexpr (dim == 3) n_transpositions += 2 - marked_opposite_to(parent.type, 1 - kept);
  if (n_transpositions % 2 != 0) std::swap(result.vertices[0], result.vertices[1]);

  if constexpr (dim == 3)
  {
    constexpr int opposite_middle = 2;
    constexpr int from_middle = 1;
    if (!second_in_plane(parent.type))
      result.type = type_of(opposite_middle, opposite_middle, in_plane(parent.type));
    else
    {
      const Index common = parent.vertices[marked_opposite_to(parent.type, 0) == 2 ? 2 : 3];
      result.type = result.vertices[0] == common ? type_of(opposite_middle, from_middle, false)
                                                 : type_of(from_middle, opposite_middle, false);
    }
  }
  return result;
}

template <int dim>
MarkedCell<dim> longest_edges_marked(std::span<const Point<dim>> points, const Cell<dim>& cell)
{
  MarkedCell<dim> result{cell, 0};
  auto& vertices = result.vertices;
  const std::array<Index, 2> refinement_edge = longest_edge(points, cell);
  bool odd = false;
  for (int end = 0; end < 2; ++end)
  {
    const auto found = std::find(vertices.begin(), vertices.end(), refinement_edge[end]);
    odd ^= found != vertices.begin() + end;
    std::swap(vertices[end], *found);
  }
  if (odd) std::swap(vertices[0], vertices[1]);

  if constexpr (dim == 3)
  {
    const auto apex = [&](int local)
    {
      const auto facet = facet_vertices(vertices, local);
      const auto marked = longest_edge(points, facet);
      const auto opposite =
          std::ranges::find_if(facet, [&](Index v) { return std::ranges::find(marked, v) == marked.end(); });
      return static_cast<int>(opposite - facet.begin());
    };
    result.type = type_of(apex(0), apex(1), false);
  }
  return result;
}

template std::array<Index, 2> marked_facet<2>(const MarkedCell<2>&, int);
template std::array<Index, 3> marked_facet<3>(const MarkedCell<3>&, int);
template MarkedCell<2> child(const MarkedCell<2>&, int, Index);
template MarkedCell<3> child(const MarkedCell<3>&, int, Index);
template MarkedCell<2> longest_edges_marked<2>(std::span<const Point<2>>, const Cell<2>&);
template MarkedCell<3> longest_edges_marked<3>(std::span<const Point<3>>, const Cell<3>&);

}  // namespace tribound::mesh
