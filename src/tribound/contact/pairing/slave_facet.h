#pragma once

/// @file slave_facet.h
/// One slave facet and the facets of the master that lie opposite to it. Internal to contact/pairing.

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/contact/pairing/pairing.h"
#include "tribound/contact/pairing/polygon.h"
#include "tribound/mesh/box_tree.h"
#include "tribound/mesh/geometry.h"

namespace tribound::contact
{

/// The data of a facet that Pi needs.
template <int dim>
struct FacetShape
{
  /// From these vertices, in ascending local order; `local` is the number of the facet in its cell.
  FacetShape(std::size_t which, const std::array<Point<dim>, dim>& vertices, int local);
  /// Facet number `which` of the boundary.
  FacetShape(const mesh::Mesh<dim>& mesh, std::size_t which);

  [[nodiscard]] Point<dim> centre() const { return map(Point<dim - 1>::Constant(1.0 / dim)); }

  std::size_t number;  ///< the caller's number for it
  mesh::FacetMap<dim> map;
  mesh::FacetGeometry<dim> geometry;
  mesh::BoundingBox<dim> box;
};

/// What a slave facet has in common with a master facet.
template <int dim>
struct Candidate
{
  std::size_t master;             ///< FacetShape::number
  std::array<double, dim> place;  ///< the centre of the master facet
  Polygon<dim> polygon;
  std::vector<Polygon<dim>> visible{};  ///< the parts that nearer ones leave visible
  double distance;                      ///< l at s = 0
  Point<dim - 1> slope;                 ///< its gradient in s
  double nearness = 0;                  ///< |l| at the centroid
  bool is_twin = false;                 ///< it has the corners of the slave facet

  [[nodiscard]] double distance_at(const Point<dim - 1>& s) const
  {
    return std::abs(distance + slope.dot(s));
  }
};

/// The overlay of one slave facet. Keeps references to what it is made from.
template <int dim>
class SlaveFacet
{
 public:
  /// Throws InputError where the direction does not point out of the facet.
  SlaveFacet(const FacetShape<dim>& slave, const problem::Pairing<dim>& pairing, const Where& where);

  /// Whether a facet in the box may lie opposite a point of this one.
  [[nodiscard]] bool may_see(const mesh::BoundingBox<dim>& box) const;
  /// Adds a master facet if it faces the slave and more than rounding of it lies opposite.
  void add(const FacetShape<dim>& master);
  [[nodiscard]] std::span<const Candidate<dim>> candidates() const { return candidates_; }
  /// Appends the parts, each with its nearest partner. Throws InputError if the nearest is not clear.
  void append_pairs(std::vector<FacetPair<dim>>& pairs);

 private:
  void order_corners(Polygon<dim>& polygon) const;
  void hide();
  void hide(Candidate<dim>& candidate, const Candidate<dim>& before, const Polygon<dim>& cover) const;
  void check_nearer(const Candidate<dim>& near, const Candidate<dim>& far, const Polygon<dim>& common) const;

  const FacetShape<dim>& slave_;
  double reach_;
  const Where& where_;
  Point<dim> e_;
  Tensor<dim> to_frame_;  ///< of x - x_0: s on the plane of the facet, and l
  std::vector<Candidate<dim>> candidates_;
};

/// The facets of a master, found by a tree.
template <int dim>
class MasterFacets
{
 public:
  explicit MasterFacets(std::vector<FacetShape<dim>> facets);
  /// Adds to the slave facet the facets opposite to it.
  void add_to(SlaveFacet<dim>& slave) const;

 private:
  std::vector<FacetShape<dim>> facets_;
  mesh::BoxTree<dim> tree_;
};

/// The shapes of the boundary facets with these numbers.
template <int dim>
[[nodiscard]] std::vector<FacetShape<dim>> facet_shapes(const mesh::Mesh<dim>& mesh,
                                                        std::span<const std::size_t> numbers);

}  // namespace tribound::contact
