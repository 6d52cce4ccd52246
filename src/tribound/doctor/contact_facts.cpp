#include "tribound/doctor/contact_facts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace tribound::doctor
{

namespace
{

template <int dim>
double degrees_between(const Point<dim>& a, const Point<dim>& b)
{
  // Twice the angle of half the chord: acos loses half the digits near 0.
  return 2 * std::asin(std::min(1.0, (a - b).norm() / 2)) * 180 / std::numbers::pi;
}

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
    for (const contact::ContactFacet<dim>& facet : form_.contact_facets())
      if (facet.facet.tag == tag_) add_facet(facet);
    add_spread();
    for (const auto& [k, l] : neighbours) add_kink(form_.contact_facets()[k], form_.contact_facets()[l]);
    return facts_;
  }

 private:
  void add_facet(const contact::ContactFacet<dim>& facet)
  {
    ++facts_.facets;
    facts_.measure += facet.geometry.measure;
    mean_ += facet.geometry.measure * facet.geometry.normal;
    const mesh::FacetMap<dim> map =
        mesh::facet_map(form_.space().mesh(), facet.facet.cell, facet.facet.local);
    for (const Point<dim - 1>& s : form_.facet_rule().points) add_gap(*facet.contact, map(s));
  }

  void add_gap(const problem::Contact& contact, const Point<dim>& x)
  {
    const double gap = problem::gap_at<dim>(contact, x);
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
    constexpr double closed_surface = 1e-6;  // all normals together cancel
    if (mean_.norm() <= closed_surface * facts_.measure) return;
    const Point<dim> mean = mean_.normalized();
    facts_.normal = place<dim>(mean);
    for (const contact::ContactFacet<dim>& facet : form_.contact_facets())
      if (facet.facet.tag == tag_)
        facts_.spread = std::max(facts_.spread, degrees_between<dim>(mean, facet.geometry.normal));
  }

  void add_kink(const contact::ContactFacet<dim>& a, const contact::ContactFacet<dim>& b)
  {
    if (a.facet.tag != tag_) return;
    const double angle = kink(a, b);
    if (angle <= facts_.kink) return;
    facts_.kink = angle;
    facts_.kink_at = place<dim>(shared_point(form_.space().mesh(), a.facet, b.facet));
  }

  const contact::NitscheForm<dim>& form_;
  int tag_;
  Point<dim> mean_ = Point<dim>::Zero();
  ContactBoundaryFacts facts_;
};

}  // namespace

template <int dim>
double kink(const contact::ContactFacet<dim>& a, const contact::ContactFacet<dim>& b)
{
  constexpr double corner = 45;
  constexpr double round_off = 0.01;
  const double angle = degrees_between<dim>(a.geometry.normal, b.geometry.normal);
  return angle < corner && angle > round_off ? angle : 0;
}

template <int dim>
std::vector<std::array<int, 2>> contact_neighbours(const contact::NitscheForm<dim>& form)
{
  using Ridge = std::array<Index, dim - 1>;  // what neighbours share
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  std::map<std::pair<int, Ridge>, int> waiting;
  std::vector<std::array<int, 2>> neighbours;
  for (int k = 0; k < static_cast<int>(form.contact_facets().size()); ++k)
  {
    const mesh::BoundaryFacet& facet = form.contact_facets()[k].facet;
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
    if (!boundaries[tag].contact) continue;
    ContactBoundaryFacts facts = Collector<dim>(form, tag).collect(neighbours);
    if (facts.facets > 0) result.push_back(std::move(facts));
  }
  return result;
}

template std::vector<std::array<int, 2>> contact_neighbours(const contact::NitscheForm<2>&);
template std::vector<std::array<int, 2>> contact_neighbours(const contact::NitscheForm<3>&);
template double kink(const contact::ContactFacet<2>&, const contact::ContactFacet<2>&);
template double kink(const contact::ContactFacet<3>&, const contact::ContactFacet<3>&);
template std::vector<ContactBoundaryFacts> contact_boundary_facts(const contact::NitscheForm<2>&);
template std::vector<ContactBoundaryFacts> contact_boundary_facts(const contact::NitscheForm<3>&);

}  // namespace tribound::doctor
