#include "tribound/contact/pairing/pairing.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "tribound/base/error.h"
#include "tribound/contact/pairing/polygon.h"
#include "tribound/mesh/box_tree.h"
#include "tribound/mesh/describe.h"
#include "tribound/mesh/geometry.h"

namespace tribound::contact
{

namespace
{

constexpr double facing = 0.1;  ///< least cosine of an angle between e and n_F, e and -n_G, n_F and -n_G
constexpr double negligible = 1e-14;    ///< of the slave facet
constexpr double overlapping = 1e-9;    ///< of the slave facet: more than rounding
constexpr double same_distance = 1e-9;  ///< of the diameter of the slave facet

/// A facet as Pi needs it.
template <int dim>
struct Side
{
  Side(const mesh::Mesh<dim>& mesh, std::size_t which) : number(which)
  {
    const mesh::BoundaryFacet& facet = mesh.boundary()[number];
    map = mesh::facet_map(mesh, facet.cell, facet.local);
    geometry = mesh::facet_geometry(mesh, facet.cell, facet.local);
    for (const Point<dim - 1>& corner : fem::reference_simplex<dim - 1>()) box.add(map(corner));
  }

  [[nodiscard]] Point<dim> centre() const { return map(Point<dim - 1>::Constant(1.0 / dim)); }

  std::size_t number;
  mesh::FacetMap<dim> map;
  mesh::FacetGeometry<dim> geometry;
  mesh::BoundingBox<dim> box;
};

/// What a slave facet has in common with a master facet.
template <int dim>
struct Candidate
{
  std::size_t master;  ///< number of the facet
  Polygon<dim> polygon;
  std::vector<Polygon<dim>> visible{};  ///< what nearer ones leave of it
  double distance;                      ///< l at s = 0
  Point<dim - 1> slope;                 ///< its gradient in s
  double nearness = 0;                  ///< |l| at the centroid

  [[nodiscard]] double distance_at(const Point<dim - 1>& s) const
  {
    return std::abs(distance + slope.dot(s));
  }
};

/// The overlay of one slave facet.
template <int dim>
class SlaveFacet
{
 public:
  SlaveFacet(const Side<dim>& slave, const problem::Pairing<dim>& pairing, const Where& where)
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

  /// e.
  [[nodiscard]] const Point<dim>& direction() const { return e_; }

  /// What lies on the side of the master that faces the slave, and below it.
  void add(const Side<dim>& master)
  {
    if (master.geometry.normal.dot(slave_.geometry.normal) >= -facing ||
        master.geometry.normal.dot(e_) >= -facing)
      return;
    Candidate<dim> found{.master = master.number, .polygon = {}, .distance = 0, .slope = {}};
    std::array<double, dim> distances;
    const auto corners = fem::reference_simplex<dim - 1>();
    for (int i = 0; i < dim; ++i)
    {
      const Point<dim> seen = to_frame_ * (master.map(corners[i]) - slave_.map.origin);
      found.polygon.push_back({seen.template head<dim - 1>(), corners[i]});
      distances[i] = seen[dim - 1];
    }
    set_distance(found, distances);
    clip_to_slave(found.polygon);
    if (fraction<dim>(found.polygon) <= negligible) return;
    found.nearness = found.distance_at(centroid<dim>(found.polygon));
    if (found.nearness <= reach_) candidates_.push_back(std::move(found));
  }

  /// The parts with one partner each, the nearest.
  void append_pairs(std::vector<FacetPair<dim>>& pairs)
  {
    const auto nearer = [](const Candidate<dim>& a, const Candidate<dim>& b)
    { return std::pair(a.nearness, a.master) < std::pair(b.nearness, b.master); };
    std::ranges::sort(candidates_, nearer);
    hide();
    std::ranges::sort(candidates_, {}, &Candidate<dim>::master);
    for (Candidate<dim>& candidate : candidates_)
      for (Polygon<dim>& polygon : candidate.visible)
      {
        turn_to_first_corner(polygon);
        for_each_simplex<dim>(polygon,
                              [&](const auto& on_slave, const auto& on_master)
                              {
                                if (fem::fraction<dim - 1>(on_slave) > negligible)
                                  pairs.push_back({{slave_.number, on_slave}, {candidate.master, on_master}});
                              });
      }
  }

 private:
  /// Makes the corner the first that is so in a direction which no mesh has: with the sides exchanged the
  /// same simplices come out.
  void turn_to_first_corner(Polygon<dim>& polygon) const
  {
    if (dim == 2 || polygon.empty()) return;
    Point<dim> direction;
    for (int i = 0; i < dim; ++i) direction[i] = std::sin(1 + 1.7 * i);
    const auto along = [&](const CornerPair<dim>& corner) { return direction.dot(slave_.map(corner.slave)); };
    std::rotate(polygon.begin(), std::ranges::min_element(polygon, {}, along), polygon.end());
  }
  /// l is affine on the plane of the slave facet: from its values where the corners of the master lie.
  static void set_distance(Candidate<dim>& found, const std::array<double, dim>& distances)
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

  static void clip_to_slave(Polygon<dim>& polygon)
  {
    for (int i = 0; i < dim - 1; ++i)
      polygon = clip<dim>(polygon, [i](const CornerPair<dim>& x) { return x.slave[i]; });
    polygon = clip<dim>(polygon, [](const CornerPair<dim>& x) { return 1 - x.slave.sum(); });
  }

  /// What is visible of each candidate behind those before it: near ones hide what is farther away. Most have
  /// nothing before them but their neighbours, of which a tree knows.
  void hide()
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

  /// What is left of a candidate behind a polygon of a nearer one.
  void hide(Candidate<dim>& candidate, const Candidate<dim>& before, const Polygon<dim>& cover) const
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

  void check_nearer(const Candidate<dim>& near, const Candidate<dim>& far, const Polygon<dim>& common) const
  {
    const double size = same_distance * slave_.geometry.diameter;
    const Point<dim - 1> centre = centroid<dim>(common);
    const auto lead = [&](const Point<dim - 1>& s) { return far.distance_at(s) - near.distance_at(s); };
    const bool is_nearer =
        lead(centre) > size && std::ranges::all_of(common, [&](const CornerPair<dim>& corner)
                                                   { return lead(corner.slave) >= -size; });
    if (!is_nearer)
      throw InputError(
          where_,
          fmt::format("the pairing is ambiguous: opposite {} two facets of the master lie {:.6g} and "
                      "{:.6g} away, and neither is the nearer throughout",
                      mesh::describe(slave_.map(centre)), near.distance_at(centre), far.distance_at(centre)),
          "a reach that leaves out one of them, or a master without one of them");
  }

  const Side<dim>& slave_;
  double reach_;
  const Where& where_;
  Point<dim> e_;
  Tensor<dim> to_frame_;  ///< of x - x_0: s on the plane of the facet, and l
  std::vector<Candidate<dim>> candidates_;
};

}  // namespace

template <int dim>
std::vector<FacetPair<dim>> overlay(const mesh::Mesh<dim>& mesh, std::span<const std::size_t> slave,
                                    std::span<const std::size_t> master, const problem::Pairing<dim>& pairing,
                                    const Where& where)
{
  std::vector<Side<dim>> masters;
  std::vector<mesh::BoundingBox<dim>> boxes;
  for (const std::size_t number : master) boxes.push_back(masters.emplace_back(mesh, number).box);
  const mesh::BoxTree<dim> tree(boxes);
  std::vector<FacetPair<dim>> pairs;
  for (const std::size_t number : slave)
  {
    const Side<dim> side(mesh, number);
    SlaveFacet<dim> facet(side, pairing, where);
    // Whatever lies opposite a point of the facet is within its diameter of the line through its centre.
    const double radius = side.geometry.diameter;
    const double farthest = pairing.reach + radius / facing;  // by so much l may change on the facet
    const auto accept = [&](const mesh::BoundingBox<dim>& box)
    {
      const mesh::BoundingBox<dim> wider{box.lower.array() - radius, box.upper.array() + radius};
      const auto [first, last] =
          mesh::part_in_box<dim>(wider, side.centre(), facet.direction(), {-farthest, farthest});
      return first <= last;
    };
    tree.traverse(accept, [&](std::size_t k) { facet.add(masters[k]); });
    facet.append_pairs(pairs);
  }
  return pairs;
}

template std::vector<FacetPair<2>> overlay(const mesh::Mesh<2>&, std::span<const std::size_t>,
                                           std::span<const std::size_t>, const problem::Pairing<2>&,
                                           const Where&);
template std::vector<FacetPair<3>> overlay(const mesh::Mesh<3>&, std::span<const std::size_t>,
                                           std::span<const std::size_t>, const problem::Pairing<3>&,
                                           const Where&);

}  // namespace tribound::contact
