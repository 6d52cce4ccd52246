#pragma once

/// @file quadratic_surface.h
/// The surface made of second-order facets: as a map from the straight facets with the same vertices, and its
/// distance from any point.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/base/types.h"
#include "tribound/mesh/box_tree.h"
#include "tribound/mesh/quadratic_facets.h"
#include "tribound/mesh/quadratic_piece.h"
#include "tribound/problem/formula.h"

namespace tribound::mesh
{

/// X(x) = sum_a N_a(lambda(x)) X_a, lambda the barycentric coordinates of x in the straight facet, X_a its
/// nodes, N_a the Lagrange basis functions of degree 2: continuous from the polygon onto the curve or
/// surface. Several threads may use one object at once.
template <int dim>
class QuadraticSurface
{
 public:
  /// What is interpolated between the nodes.
  enum class Nodal
  {
    point,  ///< X
    normal  ///< n: at nodes of length 1, the mean of the normals of the facets there, in 3D weighted by
            ///< angles
  };

  /// The facets of the groups `tags`. Throws InputError at `where`: no facet, nodes so far off that a facet
  /// folds, normals that turn so far on a facet that n might be 0.
  QuadraticSurface(const QuadraticFacets& facets, std::span<const int> tags, const Where& where);

  /// X or n, of the straight facet that is nearest to x.
  [[nodiscard]] Point<dim> value(Nodal what, const Point<dim>& x) const;
  /// n / |n|: out of the body, continuous.
  [[nodiscard]] Point<dim> normal(const Point<dim>& x) const { return value(Nodal::normal, x).normalized(); }

  /// The nearest point of the facets to a point.
  struct Foot
  {
    Point<dim> point;
    double distance;    ///< signed: > 0 outside of the body
    Point<dim> normal;  ///< n / |n| there
  };
  /// The point y of the curved facets that is nearest to x: among all points, up to rounding, by bounds that
  /// rule out the others. The distance is |x - y| with the sign of (x - y).m, m the normal of the facet, or n
  /// where facets meet. On the rim, where x - y need not be along a normal, it is (x - y).m itself, the
  /// distance from the plane that continues the facet. Continuous where y is and does not pass a corner of
  /// the rim.
  [[nodiscard]] Foot foot(const Point<dim>& x) const;

  /// For each component, what problem::Formula::enclose gives for a formula over the convex hull of
  /// `vertices` (dim coordinates each), which is part of one straight facet; further coefficients are 0.
  [[nodiscard]] std::array<std::array<problem::Enclosure, 3>, dim> enclose(
      Nodal what, std::span<const double> vertices) const;

 private:
  static constexpr int n_nodes = n_facet_nodes<dim>;
  using Barycentric = std::array<double, dim>;
  using Values = std::array<Point<dim>, n_nodes>;

  struct Facet
  {
    std::array<Values, 2> nodal;  ///< by Nodal
    /// lambda_1, ... = inverse (x - first vertex).
    Eigen::Matrix<double, dim - 1, dim> inverse;
    double size;                       ///< the longest edge
    std::array<bool, n_nodes> is_rim;  ///< nodes, those on edges for the edge: no facet on the other side

    [[nodiscard]] const Point<dim>& vertex(int i) const { return nodal[0][i]; }
    [[nodiscard]] Barycentric barycentric(const Point<dim>& x) const;
    /// An upper bound of the squared distance of x.
    [[nodiscard]] double square_distance(const Point<dim>& x) const;
    [[nodiscard]] std::array<Point<dim>, dim - 1> tangents(const Barycentric& at) const;
    [[nodiscard]] Point<dim> at(Nodal what, const Barycentric& lambda) const;
  };

  struct Place
  {
    std::size_t facet;
    Barycentric lambda;
    double square;  ///< of the distance
  };

  void find_normals(std::span<const Index> nodes, const Where& where);
  void find_rim(std::span<const Index> nodes);
  [[nodiscard]] const Facet& nearest(const Point<dim>& x) const;
  [[nodiscard]] Place nearest_node(const Point<dim>& x) const;
  static void search(const QuadraticPiece<dim>& piece, std::size_t facet, int depth, Place& best);

  std::vector<Facet> facets_;
  BoxTree<dim> tree_{{}};         ///< of the straight facets
  BoxTree<dim> curved_tree_{{}};  ///< of the curved ones
  std::vector<BoundingBox<dim>> curved_boxes_;
};

}  // namespace tribound::mesh
