#include "tribound/certify/truth/refined_segments.h"

#include <algorithm>
#include <map>

#include "tribound/contact/pairing/polygon.h"
#include "tribound/fem/nested.h"
#include "tribound/fem/polynomials.h"

namespace tribound::certify
{

namespace
{

using contact::Polygon;
using contact::SegmentSide;
using contact::SimplexMap;

/// The coordinates of a point in the plane of a facet.
template <int dim>
Point<dim - 1> coordinates(const SimplexMap<dim - 1, dim>& map, const Point<dim>& x)
{
  const Eigen::Matrix<double, dim - 1, dim> transpose = map.jacobian.transpose();
  return (transpose * map.jacobian).inverse() * (transpose * (x - map.origin));
}

/// The corners of one simplex in the coordinates of another.
template <int dim>
fem::Part<dim - 1> carried(const fem::Part<dim - 1>& corners, const SimplexMap<dim - 1, dim>& from,
                           const SimplexMap<dim - 1, dim>& to)
{
  fem::Part<dim - 1> result;
  for (int i = 0; i < dim; ++i) result[i] = coordinates<dim>(to, from(corners[i]));
  return result;
}

/// The numbers of the boundary facets of the refined mesh inside those of the original mesh. The parent of a
/// facet is the one that contains its centre.
template <int dim>
class Children
{
 public:
  Children(const mesh::Mesh<dim>& mesh, const mesh::Refined<dim>& refined)
  {
    std::map<std::pair<Index, int>, std::size_t> number;
    for (std::size_t k = 0; k < mesh.boundary().size(); ++k)
      number[{mesh.boundary()[k].cell, mesh.boundary()[k].local}] = k;
    of_facet_.resize(mesh.boundary().size());
    for (std::size_t k = 0; k < refined.mesh.boundary().size(); ++k)
    {
      const mesh::BoundaryFacet& facet = refined.mesh.boundary()[k];
      const Index ancestor = refined.ancestor(facet.cell);
      const Point<dim> centre =
          mesh::facet_map(refined.mesh, facet.cell, facet.local)(Point<dim - 1>::Constant(1.0 / dim));
      const auto lambda = fem::barycentric<dim>(fem::reference_point(mesh::cell_map(mesh, ancestor), centre));
      const auto local = static_cast<int>(std::ranges::min_element(lambda) - lambda.begin());
      of_facet_[number.at({ancestor, local})].push_back(k);
    }
  }

  [[nodiscard]] std::span<const std::size_t> operator[](std::size_t facet) const { return of_facet_[facet]; }

 private:
  std::vector<std::vector<std::size_t>> of_facet_;
};

template <int dim>
class Refinement
{
 public:
  Refinement(const mesh::Mesh<dim>& mesh, const mesh::Refined<dim>& refined)
      : mesh_(mesh), fine_(refined.mesh), children_(mesh, refined)
  {
  }

  /// Adds those of a segment against an obstacle.
  void add_facets(std::size_t k, const contact::ContactSegment<dim>& segment)
  {
    const SimplexMap<dim - 1, dim> map = contact::simplex_map(mesh_, segment.slave);
    for (const std::size_t number : children_[segment.slave.number])
    {
      const SimplexMap<dim - 1, dim> facet = contact::simplex_map(fine_, fine_.boundary()[number]);
      segments_.push_back({k, carried<dim>(fem::reference_simplex<dim - 1>(), facet, map), facet.measure,
                           side(number, segment.slave, std::nullopt)});
    }
  }

  /// Adds those of a segment between bodies.
  void add_pieces(std::size_t k, const contact::ContactSegment<dim>& segment)
  {
    Polygon<dim> whole;
    for (const Point<dim - 1>& s : fem::reference_simplex<dim - 1>()) whole.push_back({s, s});
    for (const std::size_t on_slave : children_[segment.slave.number])
    {
      const Polygon<dim> rest = inside(whole, segment.slave, on_slave);
      if (rest.empty()) continue;
      for (const std::size_t on_master : children_[segment.master->number])
        contact::for_each_simplex<dim>(inside(rest, *segment.master, on_master),
                                       [&](const fem::Part<dim - 1>& part, const auto&)
                                       { add_piece(k, segment, part, on_slave, on_master); });
    }
  }

  [[nodiscard]] std::vector<RefinedSegment<dim>> take() { return std::move(segments_); }

 private:
  static constexpr double negligible = 1e-14;  ///< fraction of a segment

  /// The part of a polygon in a segment that lies in a facet of the refined mesh on this side.
  [[nodiscard]] Polygon<dim> inside(Polygon<dim> polygon, const SegmentSide<dim>& of_segment,
                                    std::size_t number) const
  {
    Polygon<dim> facet;
    for (const Point<dim - 1>& s : carried<dim>(fem::reference_simplex<dim - 1>(),
                                                contact::simplex_map(fine_, fine_.boundary()[number]),
                                                contact::simplex_map(mesh_, of_segment)))
      facet.push_back({s, s});
    contact::for_each_side<dim>(
        facet, [&](const auto& distance) { polygon = contact::clip<dim>(polygon, distance); });
    if (!polygon.empty() && contact::fraction<dim>(polygon) <= negligible) polygon.clear();
    return polygon;
  }

  [[nodiscard]] SegmentSide<dim> side(std::size_t number, const SegmentSide<dim>& of_segment,
                                      std::optional<fem::Part<dim - 1>> part) const
  {
    return {.facet = fine_.boundary()[number],
            .number = number,
            .part = std::move(part),
            .sign = of_segment.sign};
  }

  void add_piece(std::size_t k, const contact::ContactSegment<dim>& segment, const fem::Part<dim - 1>& part,
                 std::size_t on_slave, std::size_t on_master)
  {
    const double share = fem::fraction<dim - 1>(part);
    if (share <= negligible) return;
    const auto on = [&](std::size_t number, const SegmentSide<dim>& of_segment)
    {
      return side(number, of_segment,
                  carried<dim>(part, contact::simplex_map(mesh_, of_segment),
                               contact::simplex_map(fine_, fine_.boundary()[number])));
    };
    segments_.push_back(
        {k, part, share * segment.measure, on(on_slave, segment.slave), on(on_master, *segment.master)});
  }

  const mesh::Mesh<dim>& mesh_;
  const mesh::Mesh<dim>& fine_;
  Children<dim> children_;
  std::vector<RefinedSegment<dim>> segments_;
};

}  // namespace

template <int dim>
std::vector<RefinedSegment<dim>> refined_segments(const mesh::Mesh<dim>& mesh,
                                                  std::span<const contact::ContactSegment<dim>> segments,
                                                  const mesh::Refined<dim>& refined)
{
  Refinement<dim> refinement(mesh, refined);
  for (std::size_t k = 0; k < segments.size(); ++k)
  {
    if (segments[k].master)
      refinement.add_pieces(k, segments[k]);
    else
      refinement.add_facets(k, segments[k]);
  }
  return refinement.take();
}

template std::vector<RefinedSegment<2>> refined_segments(const mesh::Mesh<2>&,
                                                         std::span<const contact::ContactSegment<2>>,
                                                         const mesh::Refined<2>&);
template std::vector<RefinedSegment<3>> refined_segments(const mesh::Mesh<3>&,
                                                         std::span<const contact::ContactSegment<3>>,
                                                         const mesh::Refined<3>&);

}  // namespace tribound::certify
