/// @file quadratic_foot.cpp
/// Nearest points of second-order facets: branch and bound over parts of them.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "tribound/mesh/quadratic_surface.h"

namespace tribound::mesh
{

namespace
{

/// Relative, for squared distances: parts that are nearer by no more than rounding are not searched.
constexpr double rounding = 1e-13;

/// Bernstein coefficients of a part differ from values by the square of its size: 2^-52.
constexpr int greatest_depth = 26;

/// The node of the vertex or edge on which l lies; none inside of the facet (in 2D: between its ends).
template <int dim>
std::optional<int> node_of(const std::array<double, dim>& l)
{
  for (int i = 0; i < dim; ++i)
    if (std::ranges::count(l, 0.0) == dim - 1 && l[i] != 0) return i;
  if constexpr (dim == 3)
    for (std::size_t e = 0; e < local_edges<2>.size(); ++e)
      if (l[2 - e] == 0) return static_cast<int>(3 + e);  // edge e lies opposite vertex 2 - e
  return std::nullopt;
}

}  // namespace

/// The rim has the nodes of one facet only, in 3D those on edges; a vertex is on it if one of its edges is.
template <int dim>
void QuadraticSurface<dim>::find_rim(std::span<const Index> nodes)
{
  std::vector<int> n_facets(std::ranges::max(nodes) + 1, 0);
  for (const Index node : nodes) ++n_facets[node];
  std::vector<bool> is_rim(n_facets.size(), false);
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    const auto a = static_cast<int>(i % n_nodes);
    const bool is_vertex = a < dim;
    if (n_facets[nodes[i]] > 1 || is_vertex != (dim == 2)) continue;
    is_rim[nodes[i]] = true;
    if (!is_vertex)
      for (const int vertex : local_edges<dim - 1>[a - dim]) is_rim[nodes[i - a + vertex]] = true;
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) facets_[i / n_nodes].is_rim[i % n_nodes] = is_rim[nodes[i]];
}

/// A distance to start with.
template <int dim>
auto QuadraticSurface<dim>::nearest_node(const Point<dim>& x) const -> Place
{
  Place best{0, {}, std::numeric_limits<double>::infinity()};
  curved_tree_.traverse([&](const BoundingBox<dim>& box)
                        { return mesh::square_distance(box, x) < best.square; },
                        [&](std::size_t f)
                        {
                          for (int i = 0; i < dim; ++i)
                          {
                            const double square = (facets_[f].vertex(i) - x).squaredNorm();
                            if (square >= best.square) continue;
                            best = {f, {}, square};
                            best.lambda[i] = 1;
                          }
                        });
  return best;
}

/// Looks for nearer points than the best in a part of a facet.
template <int dim>
void QuadraticSurface<dim>::search(const QuadraticPiece<dim>& piece, std::size_t facet, int depth,
                                   Place& best)
{
  if (piece.lower_bound() >= (1 - rounding) * best.square) return;
  const bool is_convex = piece.is_convex();
  const Barycentric there = piece.minimiser();
  const double square = piece.polar(there, there).squaredNorm();
  if (square < best.square) best = {facet, piece.place(there), square};
  if (is_convex || depth == greatest_depth) return;
  for (const QuadraticPiece<dim>& child : piece.children()) search(child, facet, depth + 1, best);
}

template <int dim>
auto QuadraticSurface<dim>::foot(const Point<dim>& x) const -> Foot
{
  Place best = nearest_node(x);
  const auto may_be_nearer = [&](const BoundingBox<dim>& box)
  { return mesh::square_distance(box, x) < best.square; };
  curved_tree_.traverse(may_be_nearer,
                        [&](std::size_t f)
                        {
                          if (may_be_nearer(curved_boxes_[f]))
                            search(QuadraticPiece<dim>(facets_[f].nodal[0], x), f, 0, best);
                        });
  const Facet& facet = facets_[best.facet];
  const Point<dim> point = facet.at(Nodal::point, best.lambda);
  const Point<dim> normal = facet.at(Nodal::normal, best.lambda).normalized();
  const Point<dim> of_facet = normal_of<dim>(facet.tangents(best.lambda)).normalized();
  const Point<dim> off = x - point;
  const std::optional<int> node = node_of<dim>(best.lambda);
  if (node && facet.is_rim[*node]) return {point, off.dot(of_facet), normal};
  return {point, std::copysign(off.norm(), off.dot(node ? normal : of_facet)), normal};
}

template auto QuadraticSurface<2>::foot(const Point<2>&) const -> Foot;
template void QuadraticSurface<2>::find_rim(std::span<const Index>);
template auto QuadraticSurface<3>::foot(const Point<3>&) const -> Foot;
template void QuadraticSurface<3>::find_rim(std::span<const Index>);

}  // namespace tribound::mesh
