#include "tribound/certify/energy/contact_resultant.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tribound/certify/energy/obstacle_facets.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

template <int dim>
RigidMotion<dim> rotation(const Point<dim>& point, const Point<dim>& axis)
{
  RigidMotion<dim> motion{.centre = point};
  if constexpr (dim == 2)
    motion.spin << 0, -1, 1, 0;
  else
    motion.spin << 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0;
  return motion;
}

namespace
{

/// The parts of the facets of a resultant, points or edges, where its motion as a weight would jump: of all
/// ranks.
template <int dim>
class Jumps
{
 public:
  Jumps(const contact::NitscheForm<dim>& form, const ContactResultant<dim>& resultant)
  {
    const mesh::Mesh<dim>& mesh = form.space().mesh();
    const std::vector<char> junctions = ObstacleFacets<dim>(form).junctions();
    std::vector<char> jumps(mesh.n_vertices(), 0);
    for (Index v = 0; v < mesh.n_vertices(); ++v) jumps[v] = junctions[dim * v];
    for (const mesh::BoundaryFacet& facet : mesh.boundary())
    {
      const bool is_other = form.problem().contact(facet.tag) != nullptr && !resultant.has(facet);
      for (const Index v : mesh::facet_vertices(mesh.cell(facet.cell), facet.local))
        for (int a = 0; a < dim; ++a)
          if (is_other ||
              (form.problem().boundary(facet.tag).fixes(a) && resultant.motion(mesh.vertex(v))[a] != 0))
            jumps[v] = 1;
    }
    std::vector<Part> here;
    for (std::size_t k = 0; k < form.n_owned_segments(); ++k)
    {
      const mesh::BoundaryFacet& facet = form.segments()[k].slave.facet;
      if (!resultant.has(facet)) continue;
      const auto vertices = mesh::facet_vertices(mesh.cell(facet.cell), facet.local);
      for (const Index v : vertices)
        for (const Index w : vertices)
          if (jumps[v] != 0 && jumps[w] != 0 && v <= w) here.push_back(part(mesh.vertex(v), mesh.vertex(w)));
    }
    parts_ = mesh.ranks().gather(std::span<const Part>(here));
    mesh.ranks().copy_from_first(parts_);
  }

  [[nodiscard]] bool empty() const { return parts_.empty(); }

  [[nodiscard]] double distance(const Point<dim>& x) const
  {
    double nearest = HUGE_VAL;
    for (const Part& part : parts_)
    {
      const Point<dim> first(part.data());
      const Point<dim> edge = Point<dim>(part.data() + dim) - first;
      const double square = edge.squaredNorm();
      const double along = square == 0 ? 0 : std::clamp((x - first).dot(edge) / square, 0.0, 1.0);
      nearest = std::min(nearest, (x - first - along * edge).norm());
    }
    return nearest;
  }

 private:
  using Part = std::array<double, 2 * dim>;  ///< its ends

  [[nodiscard]] static Part part(const Point<dim>& first, const Point<dim>& last)
  {
    Part ends;
    std::ranges::copy(first, ends.begin());
    std::ranges::copy(last, ends.begin() + dim);
    return ends;
  }

  std::vector<Part> parts_;
};

/// The diagonal of the box around the facets of a resultant.
template <int dim>
double diagonal_around(const contact::NitscheForm<dim>& form, const ContactResultant<dim>& resultant)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  std::array<double, 2 * dim> ends;  // the largest -x and x
  ends.fill(-HUGE_VAL);
  for (const contact::ContactSegment<dim>& segment : form.segments())
  {
    const mesh::BoundaryFacet& facet = segment.slave.facet;
    if (!resultant.has(facet)) continue;
    for (const Index v : mesh::facet_vertices(mesh.cell(facet.cell), facet.local))
      for (int a = 0; a < dim; ++a)
      {
        ends[a] = std::max(ends[a], -mesh.vertex(v)[a]);
        ends[dim + a] = std::max(ends[dim + a], mesh.vertex(v)[a]);
      }
  }
  mesh.ranks().max(std::span(ends));
  double square = 0;
  for (int a = 0; a < dim; ++a) square += std::pow(ends[a] + ends[dim + a], 2);
  return std::sqrt(square);
}

/// A field of degree 1 on a boundary facet.
template <int dim>
struct WeightOnFacet
{
  mesh::BoundaryFacet facet;
  std::array<Point<dim>, dim> at_vertices;

  [[nodiscard]] Point<dim> operator()(const Point<dim - 1>& s) const
  {
    Point<dim> sum = (1 - s.sum()) * at_vertices[0];
    for (int j = 1; j < dim; ++j) sum += s[j - 1] * at_vertices[j];
    return sum;
  }

  /// Sets values at the nodes on the facet that are not fixed.
  void interpolate(const contact::NitscheForm<dim>& form, std::span<const Point<dim>> nodes,
                   std::span<double> at_nodes) const
  {
    const fem::LagrangeBasis<dim>& basis = form.space().basis();
    for (int i = 0; i < basis.n_nodes(); ++i)
    {
      if (basis.node(i)[facet.local] != 0) continue;
      const Point<dim> value = (*this)(mesh::cell_to_facet<dim>(facet.local, nodes[i]));
      const Index first = dim * form.space().cell_nodes(facet.cell)[i];
      for (int a = 0; a < dim; ++a)
        if (form.constraints().fixed[first + a] == 0) at_nodes[first + a] = value[a];
    }
  }
};

}  // namespace

template <int dim>
ContactWeight<dim> contact_weight(const contact::NitscheForm<dim>& form,
                                  const ContactResultant<dim>& resultant, double ramp)
{
  const fem::LagrangeSpace<dim>& space = form.space();
  const mesh::Mesh<dim>& mesh = space.mesh();
  const Jumps<dim> jumps(form, resultant);
  constexpr double share = 0.1;
  const double width = ramp > 0 ? ramp : share * diagonal_around(form, resultant);
  constexpr double rounding = 1e-10;  // of distances
  ContactWeight<dim> result{
      .at_nodes = std::vector<double>(space.n_dofs(), 0.0),
      .at_points = std::vector<Point<dim>>(form.n_contact_points(), Point<dim>::Zero())};
  const std::vector<Point<dim>> nodes = space.basis().node_points();
  for (std::size_t k = 0; k < form.segments().size(); ++k)
  {
    const contact::SegmentSide<dim>& slave = form.segments()[k].slave;
    WeightOnFacet<dim> weight{.facet = slave.facet, .at_vertices = {}};
    if (!resultant.has(weight.facet)) continue;
    const auto vertices = mesh::facet_vertices(mesh.cell(weight.facet.cell), weight.facet.local);
    for (int j = 0; j < dim; ++j)
    {
      const Point<dim>& x = mesh.vertex(vertices[j]);
      const double d = jumps.distance(x) / width;
      weight.at_vertices[j] = (d <= rounding ? 0 : std::min(1.0, d)) * resultant.motion(x);
    }
    for (int q = 0; q < form.n_segment_points(); ++q)
      result.at_points[k * form.n_segment_points() + q] = weight(slave.on_facet(form.facet_rule().points[q]));
    weight.interpolate(form, nodes, result.at_nodes);
  }
  space.update(std::span(result.at_nodes));
  if (!jumps.empty())
    result.note = fmt::format(
        "weighted: from 0 to 1 within {:.3g} of where displacements are fixed or another contact boundary "
        "begins, linear on facets",
        width);
  return result;
}

template RigidMotion<2> rotation(const Point<2>&, const Point<2>&);
template RigidMotion<3> rotation(const Point<3>&, const Point<3>&);
template ContactWeight<2> contact_weight(const contact::NitscheForm<2>&, const ContactResultant<2>&, double);
template ContactWeight<3> contact_weight(const contact::NitscheForm<3>&, const ContactResultant<3>&, double);

}  // namespace tribound::certify
