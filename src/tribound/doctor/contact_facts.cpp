#include "tribound/doctor/contact_facts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "tribound/mesh/quadratic_facets.h"

namespace tribound::doctor
{

namespace
{

/// The mean of the vertices that two facets share.
template <int dim>
Point<dim> shared_point(const mesh::Mesh<dim>& mesh, const mesh::BoundaryFacet& a,
                        const mesh::BoundaryFacet& b)
{
  const auto of_b = mesh::facet_vertices(mesh.cell(b.cell), b.local);
  Point<dim> sum = Point<dim>::Zero();
  for (const Index v : mesh::facet_vertices(mesh.cell(a.cell), a.local))
    if (std::ranges::find(of_b, v) != of_b.end()) sum += mesh.vertex(v);
  return sum / (dim - 1);
}

/// The facts of one boundary.
template <int dim>
class Collector
{
 public:
  Collector(const contact::NitscheForm<dim>& form, int tag) : form_(form), tag_(tag)
  {
    facts_.name = form.problem().boundary(tag).name;
    facts_.smallest_gap = std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] ContactBoundaryFacts collect(std::span<const std::array<int, 2>> neighbours)
  {
    for (std::size_t k = 0; k < form_.segments().size(); ++k)
      if (form_.segments()[k].slave.facet.tag == tag_) add_segment(k);
    add_spread();
    if (const auto& facets = form_.space().mesh().labels().quadratic_facets; facets && is_without_shape_)
      facts_.straightened = mesh::sagitta<dim>(*facets, tag_);
    for (const auto& [k, l] : neighbours) add_kink(form_.segments()[k], form_.segments()[l]);
    return facts_;
  }

 private:
  void add_segment(std::size_t k)
  {
    const contact::ContactSegment<dim>& segment = form_.segments()[k];
    if (is_first_of_facet(form_, static_cast<int>(k))) ++facts_.facets;
    facts_.measure += segment.measure;
    if (!segment.contact->true_surface) is_without_shape_ = true;
    mean_ += segment.measure * contact::normal_at_centre(form_.space().mesh(), segment);
    const auto points = form_.contact_points(k);
    if (segment.contact->normal) add_direction(segment, points);
    for (std::size_t q = 0; q < points.size(); ++q)
      add_gap(segment.gap(form_.facet_rule().points[q], points[q].x, points[q].normal), points[q].x);
  }

  void add_direction(const contact::ContactSegment<dim>& segment,
                     std::span<const contact::ContactPoint<dim>> points)
  {
    const mesh::BoundaryFacet& facet = segment.slave.facet;
    const Point<dim> normal = mesh::facet_geometry(form_.space().mesh(), facet.cell, facet.local).normal;
    for (const contact::ContactPoint<dim>& point : points)
      if (const double angle = degrees_between<dim>(normal, point.normal); angle > facts_.off_normal)
      {
        facts_.off_normal = angle;
        facts_.off_normal_at = place<dim>(point.x);
      }
  }

  void add_gap(double gap, const Point<dim>& x)
  {
    if (gap < facts_.smallest_gap)
    {
      facts_.smallest_gap = gap;
      facts_.smallest_gap_at = place<dim>(x);
    }
    if (facts_.largest_gap_at.empty() || gap > facts_.largest_gap)
    {
      facts_.largest_gap = gap;
      facts_.largest_gap_at = place<dim>(x);
    }
  }

  void add_spread()
  {
    constexpr double closed_surface = 1e-6;  // the normals cancel
    if (mean_.norm() <= closed_surface * facts_.measure) return;
    const Point<dim> mean = mean_.normalized();
    facts_.normal = place<dim>(mean);
    for (const contact::ContactSegment<dim>& segment : form_.segments())
      if (segment.slave.facet.tag == tag_)
        facts_.spread =
            std::max(facts_.spread,
                     degrees_between<dim>(mean, contact::normal_at_centre(form_.space().mesh(), segment)));
  }

  void add_kink(const contact::ContactSegment<dim>& a, const contact::ContactSegment<dim>& b)
  {
    if (a.slave.facet.tag != tag_) return;
    const double angle = kink(form_.space().mesh(), a, b);
    if (angle <= facts_.kink) return;
    facts_.kink = angle;
    facts_.kink_at = place<dim>(shared_point(form_.space().mesh(), a.slave.facet, b.slave.facet));
  }

  const contact::NitscheForm<dim>& form_;
  int tag_;
  bool is_without_shape_ = false;
  Point<dim> mean_ = Point<dim>::Zero();
  ContactBoundaryFacts facts_;
};

}  // namespace

template <int dim>
double degrees_between(const Point<dim>& a, const Point<dim>& b)
{
  // Twice the angle of half the chord, since acos loses half the digits near 0.
  return 2 * std::asin(std::min(1.0, (a - b).norm() / 2)) * 180 / std::numbers::pi;
}

template <int dim>
double kink(const mesh::Mesh<dim>& mesh, const contact::ContactSegment<dim>& a,
            const contact::ContactSegment<dim>& b)
{
  constexpr double corner = 45;
  constexpr double round_off = 0.01;
  const Point<dim> x = shared_point(mesh, a.slave.facet, b.slave.facet);
  const double angle = degrees_between<dim>(a.normal_at(x), b.normal_at(x));
  return angle < corner && angle > round_off ? angle : 0;
}

template <int dim>
std::vector<std::array<int, 2>> contact_neighbours(const contact::NitscheForm<dim>& form)
{
  using Ridge = std::array<Index, dim - 1>;  // what neighbours share
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  std::map<std::pair<int, Ridge>, int> waiting;
  std::vector<std::array<int, 2>> neighbours;
  for (int k = 0; k < static_cast<int>(form.segments().size()); ++k)
  {
    if (!is_first_of_facet(form, k)) continue;
    const mesh::BoundaryFacet& facet = form.segments()[k].slave.facet;
    const auto vertices = mesh::facet_vertices(mesh.cell(facet.cell), facet.local);
    for (int left_out = 0; left_out < dim; ++left_out)
    {
      Ridge ridge = mesh::facet_vertices(vertices, left_out);
      std::ranges::sort(ridge);
      const auto [other, is_new] = waiting.try_emplace({facet.tag, ridge}, k);
      if (!is_new) neighbours.push_back({other->second, k});
    }
  }
  return neighbours;
}

template <int dim>
std::vector<ContactBoundaryFacts> contact_boundary_facts(const contact::NitscheForm<dim>& form)
{
  const std::vector<std::array<int, 2>> neighbours = contact_neighbours(form);
  std::vector<ContactBoundaryFacts> result;
  const auto boundaries = form.problem().boundaries();
  for (int tag = 0; tag < static_cast<int>(boundaries.size()); ++tag)
  {
    if (form.problem().contact(tag) == nullptr) continue;
    ContactBoundaryFacts facts = Collector<dim>(form, tag).collect(neighbours);
    facts.is_bilateral = cone(form.problem().contact(tag)->law).is_bilateral;
    if (facts.facets > 0) result.push_back(std::move(facts));
  }
  return result;
}

template double degrees_between(const Point<2>&, const Point<2>&);
template double degrees_between(const Point<3>&, const Point<3>&);
template std::vector<std::array<int, 2>> contact_neighbours(const contact::NitscheForm<2>&);
template std::vector<std::array<int, 2>> contact_neighbours(const contact::NitscheForm<3>&);
template double kink(const mesh::Mesh<2>&, const contact::ContactSegment<2>&,
                     const contact::ContactSegment<2>&);
template double kink(const mesh::Mesh<3>&, const contact::ContactSegment<3>&,
                     const contact::ContactSegment<3>&);
template std::vector<ContactBoundaryFacts> contact_boundary_facts(const contact::NitscheForm<2>&);
template std::vector<ContactBoundaryFacts> contact_boundary_facts(const contact::NitscheForm<3>&);

}  // namespace tribound::doctor
