#include "tribound/contact/pairing/slave_facet.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <tuple>
#include <utility>

#include "tribound/mesh/describe.h"

namespace tribound::contact
{

namespace
{

constexpr double facing = 0.1;  ///< least cosine of an angle between e and n_F, e and -n_G, n_F and -n_G
constexpr double smallest_part = 1e-14;  ///< of the slave facet
constexpr double overlapping = 1e-9;     ///< of the slave facet: more than rounding
constexpr double same_corner = 1e-6;     ///< coordinates on the slave facet that differ by less are the same
constexpr double sliver = 6 * same_corner;  ///< at most this part of a slave facet lies beside its twin
constexpr double same_distance = 1e-9;      ///< of the diameter of the slave facet

/// l is affine on the plane of the slave facet: computed from its values at the corners of the master.
template <int dim>
void set_distance(Candidate<dim>& found, const std::array<double, dim>& distances)
{
  Eigen::Matrix<double, dim - 1, dim - 1> edges;
  Point<dim - 1> differences;
  for (int i = 1; i < dim; ++i)
  {
    edges.row(i - 1) = (found.polygon[i].slave - found.polygon[0].slave).transpose();
    differences[i - 1] = distances[i] - distances[0];
  }
  found.slope = edges.inverse() * differences;
  found.distance = distances[0] - found.slope.dot(found.polygon[0].slave);
}

/// Moves the corners of a master facet to those of the slave facet if they are the same but for rounding in
/// mesh files: the pairing then identifies the facets. Returns whether it does.
template <int dim>
bool identify(Polygon<dim>& master)
{
  Polygon<dim> moved = master;
  for (const Point<dim - 1>& corner : fem::reference_simplex<dim - 1>())
  {
    const auto found = std::ranges::find_if(
        master, [&](const auto& x) { return (x.slave - corner).cwiseAbs().maxCoeff() <= same_corner; });
    if (found == master.end()) return false;
    moved[found - master.begin()].slave = corner;
  }
  master = std::move(moved);
  return true;
}

template <int dim>
void clip_to_slave(Polygon<dim>& polygon)
{
  for (int i = 0; i < dim - 1; ++i)
    polygon = clip<dim>(polygon, [i](const CornerPair<dim>& x) { return x.slave[i]; });
  polygon = clip<dim>(polygon, [](const CornerPair<dim>& x) { return 1 - x.slave.sum(); });
}

template <int dim>
std::vector<mesh::BoundingBox<dim>> boxes_of(std::span<const FacetShape<dim>> facets)
{
  std::vector<mesh::BoundingBox<dim>> boxes;
  boxes.reserve(facets.size());
  for (const FacetShape<dim>& facet : facets) boxes.push_back(facet.box);
  return boxes;
}

}  // namespace

template <int dim>
FacetShape<dim>::FacetShape(std::size_t which, const std::array<Point<dim>, dim>& vertices, int local)
    : number(which), map(mesh::facet_map<dim>(vertices)), geometry(mesh::facet_geometry<dim>(vertices, local))
{
  for (const Point<dim>& vertex : vertices) box.add(vertex);
}

template <int dim>
FacetShape<dim>::FacetShape(const mesh::Mesh<dim>& mesh, std::size_t which)
    : FacetShape(which,
                 mesh::points_of(mesh.vertices(), mesh::facet_vertices(mesh.cell(mesh.boundary()[which].cell),
                                                                       mesh.boundary()[which].local)),
                 mesh.boundary()[which].local)
{
}

template <int dim>
SlaveFacet<dim>::SlaveFacet(const FacetShape<dim>& slave, const problem::Pairing<dim>& pairing,
                            const Where& where)
    : slave_(slave), reach_(pairing.reach), where_(where)
{
  e_ = pairing.direction ? pairing.direction->normalized() : slave.geometry.normal;
  if (!(e_.dot(slave.geometry.normal) > facing))
    throw InputError(where_,
                     fmt::format("the direction of a pairing does not point out of the slave at {}",
                                 mesh::describe(slave.centre())),
                     "a direction within 84 degrees of every outward normal of the slave");
  Tensor<dim> frame;
  frame.template leftCols<dim - 1>() = slave.map.jacobian;
  frame.col(dim - 1) = e_;
  to_frame_ = frame.inverse();
}

template <int dim>
bool SlaveFacet<dim>::may_see(const mesh::BoundingBox<dim>& box) const
{
  // Anything opposite a point of the facet is within the diameter of the line through its centre.
  const double radius = slave_.geometry.diameter;
  const double farthest = reach_ + radius / facing;  // the most that l may change on the facet
  const mesh::BoundingBox<dim> wider{box.lower.array() - radius, box.upper.array() + radius};
  const auto [first, last] = mesh::part_in_box<dim>(wider, slave_.centre(), e_, {-farthest, farthest});
  return first <= last;
}

template <int dim>
void SlaveFacet<dim>::add(const FacetShape<dim>& master)
{
  if (master.geometry.normal.dot(slave_.geometry.normal) >= -facing ||
      master.geometry.normal.dot(e_) >= -facing)
    return;
  Candidate<dim> found{.master = master.number, .place = {}, .polygon = {}, .distance = 0, .slope = {}};
  const Point<dim> centre = master.centre();
  std::ranges::copy(centre, found.place.begin());
  std::array<double, dim> distances;
  const auto corners = fem::reference_simplex<dim - 1>();
  for (int i = 0; i < dim; ++i)
  {
    const Point<dim> seen = to_frame_ * (master.map(corners[i]) - slave_.map.origin);
    found.polygon.push_back({seen.template head<dim - 1>(), corners[i]});
    distances[i] = seen[dim - 1];
  }
  found.is_twin = identify<dim>(found.polygon);
  set_distance<dim>(found, distances);
  clip_to_slave<dim>(found.polygon);
  if (fraction<dim>(found.polygon) <= smallest_part) return;
  order_corners(found.polygon);
  found.nearness = found.distance_at(centroid<dim>(found.polygon));
  if (found.nearness <= reach_) candidates_.push_back(std::move(found));
}

template <int dim>
void SlaveFacet<dim>::append_pairs(std::vector<FacetPair<dim>>& pairs)
{
  if (std::ranges::any_of(candidates_, &Candidate<dim>::is_twin))
    std::erase_if(candidates_, [](const Candidate<dim>& c) { return fraction<dim>(c.polygon) <= sliver; });
  const auto nearer = [](const Candidate<dim>& a, const Candidate<dim>& b)
  { return std::tie(a.nearness, a.place) < std::tie(b.nearness, b.place); };
  std::ranges::sort(candidates_, nearer);
  hide();
  std::ranges::sort(candidates_, {}, &Candidate<dim>::place);
  for (Candidate<dim>& candidate : candidates_)
    for (Polygon<dim>& polygon : candidate.visible)
    {
      order_corners(polygon);
      for_each_simplex<dim>(polygon,
                            [&](const auto& on_slave, const auto& on_master)
                            {
                              if (fem::fraction<dim - 1>(on_slave) > smallest_part)
                                pairs.push_back({{slave_.number, on_slave}, {candidate.master, on_master}});
                            });
    }
}

/// In 3D starts from the corner that is first in a direction along which no mesh is aligned, and goes on
/// towards the neighbour that comes next in it. The cuts then depend only on places: not on numbers, which
/// differ between ranks, nor on which of the sides is the slave.
template <int dim>
void SlaveFacet<dim>::order_corners(Polygon<dim>& polygon) const
{
  if (dim == 2 || polygon.empty()) return;
  Point<dim> direction;
  for (int i = 0; i < dim; ++i) direction[i] = std::sin(1 + 1.7 * i);
  const auto along = [&](const CornerPair<dim>& corner) { return direction.dot(slave_.map(corner.slave)); };
  std::rotate(polygon.begin(), std::ranges::min_element(polygon, {}, along), polygon.end());
  if (along(polygon[1]) > along(polygon.back())) std::reverse(polygon.begin() + 1, polygon.end());
}

/// The visible part of each candidate behind those before it: near ones hide what is farther away. Most have
/// only neighbours before them, which a tree finds.
template <int dim>
void SlaveFacet<dim>::hide()
{
  std::vector<mesh::BoundingBox<dim - 1>> boxes(candidates_.size());
  for (std::size_t k = 0; k < boxes.size(); ++k)
    for (const CornerPair<dim>& corner : candidates_[k].polygon) boxes[k].add(corner.slave);
  const mesh::BoxTree<dim - 1> tree(boxes);
  for (std::size_t k = 0; k < boxes.size(); ++k)
  {
    std::vector<std::size_t> before;
    tree.traverse([&](const mesh::BoundingBox<dim - 1>& box) { return mesh::meet(box, boxes[k]); },
                  [&](std::size_t other)
                  {
                    if (other < k && mesh::meet(boxes[other], boxes[k])) before.push_back(other);
                  });
    std::ranges::sort(before);
    candidates_[k].visible = {candidates_[k].polygon};
    for (const std::size_t other : before)
      for (const Polygon<dim>& polygon : candidates_[other].visible)
        hide(candidates_[k], candidates_[other], polygon);
  }
}

/// What a polygon of a nearer candidate leaves visible of a candidate.
template <int dim>
void SlaveFacet<dim>::hide(Candidate<dim>& candidate, const Candidate<dim>& before,
                           const Polygon<dim>& cover) const
{
  std::vector<Polygon<dim>> rest;
  for (const Polygon<dim>& polygon : candidate.visible)
  {
    std::vector<Polygon<dim>> outside;
    Polygon<dim> common = polygon;
    for_each_side<dim>(cover,
                       [&](const auto& side)
                       {
                         const auto opposite = [&](const CornerPair<dim>& x) { return -side(x); };
                         outside.push_back(clip<dim>(common, opposite));
                         common = clip<dim>(common, side);
                       });
    if (fraction<dim>(common) <= overlapping)
    {
      rest.push_back(polygon);
      continue;
    }
    check_nearer(before, candidate, common);
    for (Polygon<dim>& piece : outside)
      if (fraction<dim>(piece) > overlapping) rest.push_back(std::move(piece));
  }
  candidate.visible = std::move(rest);
}

template <int dim>
void SlaveFacet<dim>::check_nearer(const Candidate<dim>& near, const Candidate<dim>& far,
                                   const Polygon<dim>& common) const
{
  const double size = same_distance * slave_.geometry.diameter;
  const Point<dim - 1> centre = centroid<dim>(common);
  const auto lead = [&](const Point<dim - 1>& s) { return far.distance_at(s) - near.distance_at(s); };
  const bool is_nearer = lead(centre) > size && std::ranges::all_of(common, [&](const CornerPair<dim>& corner)
                                                                    { return lead(corner.slave) >= -size; });
  if (!is_nearer)
    throw InputError(
        where_,
        fmt::format("the pairing is ambiguous: opposite {} two facets of the master lie {:.6g} and "
                    "{:.6g} away, and neither is the nearer throughout",
                    mesh::describe(slave_.map(centre)), near.distance_at(centre), far.distance_at(centre)),
        "a reach that leaves out one of them, or a master without one of them");
}

template <int dim>
MasterFacets<dim>::MasterFacets(std::vector<FacetShape<dim>> facets)
    : facets_(std::move(facets)), tree_(boxes_of<dim>(facets_))
{
}

template <int dim>
void MasterFacets<dim>::add_to(SlaveFacet<dim>& slave) const
{
  tree_.traverse([&](const mesh::BoundingBox<dim>& box) { return slave.may_see(box); },
                 [&](std::size_t k) { slave.add(facets_[k]); });
}

template <int dim>
std::vector<FacetShape<dim>> facet_shapes(const mesh::Mesh<dim>& mesh, std::span<const std::size_t> numbers)
{
  std::vector<FacetShape<dim>> facets;
  facets.reserve(numbers.size());
  for (const std::size_t number : numbers) facets.emplace_back(mesh, number);
  return facets;
}

template struct FacetShape<2>;
template class SlaveFacet<2>;
template class MasterFacets<2>;
template std::vector<FacetShape<2>> facet_shapes(const mesh::Mesh<2>&, std::span<const std::size_t>);
template struct FacetShape<3>;
template class SlaveFacet<3>;
template class MasterFacets<3>;
template std::vector<FacetShape<3>> facet_shapes(const mesh::Mesh<3>&, std::span<const std::size_t>);

}  // namespace tribound::contact
