#include "tribound/mesh/quadratic_surface.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "tribound/mesh/describe.h"

namespace tribound::mesh
{

namespace
{

/// The symmetric bilinear form Q(l, m) with Q(l, l) = sum_a N_a(l) q_a where the l_i add up to 1.
template <int dim>
Point<dim> polar_form(const std::array<Point<dim>, n_facet_nodes<dim>>& q, const std::array<double, dim>& l,
                      const std::array<double, dim>& m)
{
  Point<dim> sum = Point<dim>::Zero();
  for (int i = 0; i < dim; ++i) sum += (2 * l[i] * m[i] - (l[i] + m[i]) / 2) * q[i];
  constexpr auto& edges = local_edges<dim - 1>;
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    const auto [i, j] = edges[e];
    sum += 2 * (l[i] * m[j] + l[j] * m[i]) * q[dim + e];
  }
  return sum;
}

/// Node a of a facet.
template <int dim>
std::array<double, dim> node_place(int a)
{
  std::array<double, dim> place{};
  if (a < dim)
    place[a] = 1;
  else
    for (const int i : local_edges<dim - 1>[a - dim]) place[i] = 0.5;
  return place;
}

/// Weight of a facet at a node with these tangents: 1 in 2D and on edges, where every facet has the same.
template <int dim>
double weight(int node, const std::array<Point<dim>, dim - 1>& tangents)
{
  if (dim == 2 || node >= dim) return 1;
  // Towards the two other vertices: from vertex 0 they are the tangents, from others one is turned round.
  const Point<dim>& s = tangents[0];
  const Point<dim>& t = tangents[dim - 2];
  const Point<dim> a = node == 0 ? s : node == 1 ? Point<dim>(-s) : Point<dim>(-t);
  const Point<dim> b = node == 0 ? t : node == 1 ? Point<dim>(t - s) : Point<dim>(s - t);
  return std::acos(std::clamp(a.dot(b) / (a.norm() * b.norm()), -1.0, 1.0));
}

/// Whether the polynomial with these nodes is nowhere perpendicular to `direction`, by its Bernstein
/// coefficients.
template <int dim>
bool stays_along(const std::array<Point<dim>, n_facet_nodes<dim>>& q, const Point<dim>& direction)
{
  for (int i = 0; i < dim; ++i)
    for (int j = i; j < dim; ++j)
      if (!(polar_form<dim>(q, node_place<dim>(i), node_place<dim>(j)).dot(direction) > 0)) return false;
  return true;
}

template <int dim>
[[noreturn]] void throw_at(const Where& where, const Point<dim>& a, const Point<dim>& b,
                           std::string_view problem)
{
  throw InputError(where,
                   fmt::format("the second-order facet from {} to {} {}", describe(a), describe(b), problem),
                   "mesh finer there, or give corners of the body to boundaries of their own");
}

}  // namespace

template <int dim>
QuadraticSurface<dim>::QuadraticSurface(const QuadraticFacets& facets, std::span<const int> tags,
                                        const Where& where)
{
  std::vector<Index> nodes;
  std::vector<BoundingBox<dim>> boxes;
  for (std::size_t f = 0; f < facets.tags.size(); ++f)
  {
    if (std::ranges::find(tags, facets.tags[f]) == tags.end()) continue;
    Facet facet;
    for (int a = 0; a < n_nodes; ++a)
    {
      nodes.push_back(facets.nodes[f * n_nodes + a]);
      facet.nodal[0][a] = Point<dim>(&facets.points[nodes.back() * dim]);
    }
    std::array<Point<dim>, dim> vertices;
    std::copy_n(facet.nodal[0].begin(), dim, vertices.begin());
    const auto jacobian = facet_map<dim>(vertices).jacobian;
    facet.inverse = (jacobian.transpose() * jacobian).inverse() * jacobian.transpose();
    facet.size = diameter<dim>(vertices);
    facets_.push_back(facet);
    boxes.push_back(bounding_box<dim>(vertices));
    curved_boxes_.push_back(QuadraticPiece<dim>(facet.nodal[0], Point<dim>::Zero()).box());
  }
  if (facets_.empty())
    throw InputError(where, "the boundary has no facets of second order", "a mesh of order 2");
  find_normals(nodes, where);
  find_rim(nodes);
  tree_ = BoxTree<dim>(boxes);
  curved_tree_ = BoxTree<dim>(curved_boxes_);
}

template <int dim>
void QuadraticSurface<dim>::find_normals(std::span<const Index> nodes, const Where& where)
{
  std::vector<Point<dim>> sums(std::ranges::max(nodes) + 1, Point<dim>::Zero());
  const auto straight = [](const Facet& facet)
  {
    std::array<Point<dim>, dim - 1> edges;
    for (int i = 1; i < dim; ++i) edges[i - 1] = facet.vertex(i) - facet.vertex(0);
    return normal_of<dim>(edges);
  };
  for (std::size_t f = 0; f < facets_.size(); ++f)
    for (int a = 0; a < n_nodes; ++a)
    {
      const Facet& facet = facets_[f];
      const auto tangents = facet.tangents(node_place<dim>(a));
      const Point<dim> normal = normal_of<dim>(tangents);
      if (!(normal.dot(straight(facet)) > 0)) throw_at<dim>(where, facet.vertex(0), facet.vertex(1), "folds");
      sums[nodes[f * n_nodes + a]] += weight<dim>(a, tangents) * normal.normalized();
    }
  for (std::size_t f = 0; f < facets_.size(); ++f)
  {
    Facet& facet = facets_[f];
    for (int a = 0; a < n_nodes; ++a) facet.nodal[1][a] = sums[nodes[f * n_nodes + a]].normalized();
    if (!stays_along<dim>(facet.nodal[1], straight(facet)))
      throw_at<dim>(where, facet.vertex(0), facet.vertex(1), "turns too far to have a normal");
  }
}

template <int dim>
auto QuadraticSurface<dim>::Facet::barycentric(const Point<dim>& x) const -> Barycentric
{
  const Point<dim - 1> rest = inverse * (x - vertex(0));
  Barycentric lambda;
  lambda[0] = 1 - rest.sum();
  std::copy_n(rest.begin(), dim - 1, lambda.begin() + 1);
  return lambda;
}

template <int dim>
double QuadraticSurface<dim>::Facet::square_distance(const Point<dim>& x) const
{
  const Barycentric lambda = barycentric(x);
  Point<dim> inside = Point<dim>::Zero();
  double sum = 0;
  for (int i = 0; i < dim; ++i)
  {
    inside += std::max(0.0, lambda[i]) * vertex(i);
    sum += std::max(0.0, lambda[i]);
  }
  return (inside / sum - x).squaredNorm();
}

template <int dim>
auto QuadraticSurface<dim>::Facet::tangents(const Barycentric& at) const -> std::array<Point<dim>, dim - 1>
{
  std::array<Point<dim>, dim - 1> result;
  for (int i = 1; i < dim; ++i)
  {
    // d/dt Q(l + t d, l + t d) = 2 Q(l, l + d) - 2 Q(l, l), d from vertex 0 to vertex i
    Barycentric ahead = at;
    ahead[0] -= 1;
    ahead[i] += 1;
    result[i - 1] = 2 * (polar_form<dim>(nodal[0], at, ahead) - polar_form<dim>(nodal[0], at, at));
  }
  return result;
}

template <int dim>
auto QuadraticSurface<dim>::nearest(const Point<dim>& x) const -> const Facet&
{
  double best = std::numeric_limits<double>::infinity();
  std::size_t found = 0;
  tree_.traverse([&](const BoundingBox<dim>& box) { return mesh::square_distance(box, x) < best; },
                 [&](std::size_t f)
                 {
                   const double square = facets_[f].square_distance(x);
                   // Of equally near ones the first, however the tree is traversed.
                   if (square > best || (square == best && f > found)) return;
                   best = square;
                   found = f;
                 });
  return facets_[found];
}

template <int dim>
Point<dim> QuadraticSurface<dim>::value(Nodal what, const Point<dim>& x) const
{
  const Facet& facet = nearest(x);
  return facet.at(what, facet.barycentric(x));
}

template <int dim>
Point<dim> QuadraticSurface<dim>::Facet::at(Nodal what, const Barycentric& lambda) const
{
  return polar_form<dim>(nodal[static_cast<int>(what)], lambda, lambda);
}

// With B_ij = Q(v_i, v_j), v_i the vertices, and c their mean, for xi and x in the convex hull K:
// Q(xi, xi) is a mean of the B_ij; the first derivative 2 Q(xi, x) - 2 Q(xi, c) one of 2 B_ij - 2 Q(v_i, c);
// half the second, Q(x, x) - 2 Q(x, c) + Q(c, c), one of B_ij - Q(v_i, c) - Q(v_j, c) + Q(c, c).
template <int dim>
std::array<std::array<problem::Enclosure, 3>, dim> QuadraticSurface<dim>::enclose(
    Nodal what, std::span<const double> vertices) const
{
  const std::size_t n = vertices.size() / dim;
  Point<dim> centre = Point<dim>::Zero();
  for (std::size_t i = 0; i < n; ++i) centre += Point<dim>(&vertices[i * dim]) / static_cast<double>(n);
  const Facet& facet = nearest(centre);
  const Values& q = facet.nodal[static_cast<int>(what)];
  std::vector<Barycentric> places;
  for (std::size_t i = 0; i < n; ++i) places.push_back(facet.barycentric(Point<dim>(&vertices[i * dim])));
  const Barycentric c = facet.barycentric(centre);

  Point<dim> far = Point<dim>::Zero();  // the largest coordinates, for rounding errors
  for (const Point<dim>& node : q) far = far.cwiseMax(node.cwiseAbs());
  constexpr double margin = 64 * std::numeric_limits<double>::epsilon();
  const double of_places = 1 + centre.norm() / facet.size;

  std::array<std::array<problem::Enclosure, 3>, dim> result;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (auto& component : result) component.fill({infinity, -infinity});
  const auto add = [&](int order, const Point<dim>& value)
  {
    for (int k = 0; k < dim; ++k)
    {
      problem::Enclosure& enclosure = result[k][order];
      const double rounding = margin * far[k] * of_places;
      enclosure.lower = std::min(enclosure.lower, value[k] - rounding);
      enclosure.upper = std::max(enclosure.upper, value[k] + rounding);
    }
  };
  const Point<dim> at_centre = polar_form<dim>(q, c, c);
  for (const Barycentric& a : places)
    for (const Barycentric& b : places)
    {
      const Point<dim> both = polar_form<dim>(q, a, b);
      const Point<dim> first = polar_form<dim>(q, a, c);
      add(0, both);
      add(1, 2 * (both - first));
      add(2, both - first - polar_form<dim>(q, b, c) + at_centre);
    }
  return result;
}

template class QuadraticSurface<2>;
template class QuadraticSurface<3>;

}  // namespace tribound::mesh
