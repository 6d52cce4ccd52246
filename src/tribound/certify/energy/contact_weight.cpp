#include "tribound/certify/energy/contact_weight.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "tribound/mesh/geometry.h"
#include "tribound/mesh/quadratic_facets.h"

namespace tribound::certify
{

namespace
{

/// Marks the vertices of the first mesh that any rank names.
void mark_on_all_ranks(const Ranks& ranks, std::span<const Index> named, std::vector<char>& marks)
{
  std::vector<Index> all = ranks.gather(named);
  ranks.copy_from_first(all);
  for (const Index v : all) marks[v] = 1;
}

/// The vertices and edges in the first mesh, on the facets of a resultant, along which its motion would jump.
template <int dim>
class JumpParts
{
 public:
  /// Adds those of a facet of the first mesh.
  void add(const mesh::FirstFacets& first, std::size_t facet, std::span<const char> jumps)
  {
    const auto vertices = first.vertices_of<dim>(facet);
    for (const Index v : vertices)
      for (const Index w : vertices)
        if (jumps[v] != 0 && jumps[w] != 0 && v <= w)
          parts_.push_back({first.point<dim>(v), first.point<dim>(w)});
  }

  [[nodiscard]] bool empty() const { return parts_.empty(); }

  [[nodiscard]] double distance(const Point<dim>& x) const
  {
    double nearest = HUGE_VAL;
    for (const auto& [first, last] : parts_)
    {
      const Point<dim> edge = last - first;
      const double square = edge.squaredNorm();
      const double along = square == 0 ? 0 : std::clamp((x - first).dot(edge) / square, 0.0, 1.0);
      nearest = std::min(nearest, (x - first - along * edge).norm());
    }
    return nearest;
  }

 private:
  std::vector<std::array<Point<dim>, 2>> parts_;  ///< their end points
};

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
ContactWeights<dim>::ContactWeights(const contact::NitscheForm<dim>& form, std::span<const char> junctions)
    : first_(form.space().mesh().labels().quadratic_facets->first),
      is_contact_(form.space().mesh().boundary_names().size(), 0),
      junctions_(first_.points.size() / dim, 0)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  for (std::size_t tag = 0; tag < is_contact_.size(); ++tag)
    is_contact_[tag] = form.problem().contact(static_cast<int>(tag)) != nullptr ? 1 : 0;
  const mesh::FirstFacetFinder<dim> find(first_, [this](int tag) { return is_contact_[tag] != 0; });
  std::vector<Index> around;  // a junction, where a linear function vanishes if it does at these vertices
  for (const contact::ContactSegment<dim>& segment : form.segments())
  {
    const mesh::BoundaryFacet& facet = segment.slave.facet;
    const auto vertices = mesh::facet_vertices(mesh.cell(facet.cell), facet.local);
    const auto& place = places_.emplace_back(find(facet.tag, mesh::points_of(mesh.vertices(), vertices)));
    for (int j = 0; j < dim; ++j)
      for (int i = 0; i < dim; ++i)
        if (junctions[dim * vertices[j]] != 0 && place.barycentric[j][i] != 0)
          around.push_back(first_.vertices_of<dim>(place.facet)[i]);
  }
  mark_on_all_ranks(mesh.ranks(), around, junctions_);
}

template <int dim>
std::vector<char> ContactWeights<dim>::jumps(const contact::NitscheForm<dim>& form,
                                             const ContactResultant<dim>& resultant) const
{
  std::vector<char> result(junctions_.size(), 0);
  for (std::size_t f = 0; f < first_.tags.size(); ++f)
  {
    const int tag = first_.tags[f];
    const bool is_other = is_contact_[tag] != 0 && !resultant.has(tag);
    for (const Index v : first_.vertices_of<dim>(f))
      for (int a = 0; a < dim; ++a)
        if (is_other ||
            (form.problem().boundary(tag).fixes(a) && resultant.motion(first_.point<dim>(v))[a] != 0))
          result[v] = 1;
    for (const Index v : first_.vertices_of<dim>(f))  // u_r = 0 on the axis
      if (form.problem().weight(first_.point<dim>(v)) == 0 && resultant.motion(first_.point<dim>(v))[0] != 0)
        result[v] = 1;
  }
  // If slaves are partly without an opposite facet, only these vertices matter.
  std::vector<Index> named;
  for (std::size_t k = 0; k < form.segments().size(); ++k)
    for (int i = 0; i < dim; ++i)
      if (const auto& [facet, barycentric] = places_[k]; is_on(facet, resultant))
        for (const std::array<double, dim>& vertex : barycentric)
          if (vertex[i] != 0 && std::ranges::count(vertex, 0.0) > 0)  // at its ends, or those of its edge
            named.push_back(first_.vertices_of<dim>(facet)[i]);
  std::vector<char> is_reached(result.size(), 0);
  mark_on_all_ranks(form.space().mesh().ranks(), named, is_reached);
  for (std::size_t v = 0; v < result.size(); ++v)
    if (is_reached[v] == 0) result[v] = 0;
  for (std::size_t v = 0; v < result.size(); ++v)
    if (junctions_[v] != 0) result[v] = 1;
  return result;
}

template <int dim>
double ContactWeights<dim>::diagonal_around(const ContactResultant<dim>& resultant) const
{
  mesh::BoundingBox<dim> box;
  for (std::size_t f = 0; f < first_.tags.size(); ++f)
    if (is_on(f, resultant))
      for (const Index v : first_.vertices_of<dim>(f)) box.add(first_.point<dim>(v));
  return box.diagonal();
}

template <int dim>
std::array<Point<dim>, dim> ContactWeights<dim>::at_vertices(std::size_t k,
                                                             std::span<const Point<dim>> at_first) const
{
  const auto& [facet, barycentric] = places_[k];
  const auto vertices = first_.vertices_of<dim>(facet);
  std::array<Point<dim>, dim> values;
  for (int j = 0; j < dim; ++j)
  {
    values[j].setZero();
    for (int i = 0; i < dim; ++i) values[j] += barycentric[j][i] * at_first[vertices[i]];
  }
  return values;
}

template <int dim>
auto ContactWeights<dim>::on_first_mesh(const contact::NitscheForm<dim>& form,
                                        const ContactResultant<dim>& resultant, double ramp) const
    -> FirstValues
{
  const std::vector<char> jumps = this->jumps(form, resultant);
  JumpParts<dim> parts;
  for (std::size_t f = 0; f < first_.tags.size(); ++f)
    if (is_on(f, resultant)) parts.add(first_, f, jumps);
  FirstValues result{std::vector<Point<dim>>(jumps.size(), Point<dim>::Zero()), parts.empty()};
  std::vector<char> is_known(jumps.size(), 0);
  constexpr double rounding = 1e-10;  // of distances
  for (const auto& [facet, barycentric] : places_)
  {
    if (!is_on(facet, resultant)) continue;
    for (const Index v : first_.vertices_of<dim>(facet))
    {
      if (std::exchange(is_known[v], 1) != 0) continue;
      const Point<dim> x = first_.point<dim>(v);
      const double d = parts.distance(x) / ramp;
      result.values[v] = (d <= rounding ? 0 : std::min(1.0, d)) * resultant.motion(x);
    }
  }
  return result;
}

template <int dim>
ContactWeight<dim> ContactWeights<dim>::operator()(const contact::NitscheForm<dim>& form,
                                                   const ContactResultant<dim>& resultant, double ramp) const
{
  assert(form.segments().size() == places_.size());
  const fem::LagrangeSpace<dim>& space = form.space();
  constexpr double share = 0.1;
  const double width = ramp > 0 ? ramp : share * diagonal_around(resultant);
  const FirstValues first = on_first_mesh(form, resultant, width);
  ContactWeight<dim> result{
      .at_nodes = std::vector<double>(space.n_dofs(), 0.0),
      .at_points = std::vector<Point<dim>>(form.n_contact_points(), Point<dim>::Zero())};
  const std::vector<Point<dim>> nodes = space.basis().node_points();
  bool is_zero = true;
  for (std::size_t k = 0; k < form.segments().size(); ++k)
  {
    const contact::SegmentSide<dim>& slave = form.segments()[k].slave;
    if (!resultant.has(slave.facet.tag)) continue;
    const WeightOnFacet<dim> weight{slave.facet, at_vertices(k, first.values)};
    for (const Point<dim>& value : weight.at_vertices) is_zero = is_zero && value.isZero(0);
    for (int q = 0; q < form.n_segment_points(); ++q)
      result.at_points[k * form.n_segment_points() + q] = weight(slave.on_facet(form.facet_rule().points[q]));
    weight.interpolate(form, nodes, result.at_nodes);
  }
  space.update(std::span(result.at_nodes));
  if (!space.mesh().ranks().any(!is_zero))
    result.reason =
        "on the first mesh every facet of the boundary is beside fixed displacements or another contact "
        "boundary: begin with a finer one";
  if (!first.is_motion)
    result.note = fmt::format(
        "weighted: from 0 to 1 within {:.3g} of where displacements are fixed or another contact boundary "
        "begins, linear on the facets of the first mesh",
        width);
  return result;
}

template class ContactWeights<2>;
template class ContactWeights<3>;

}  // namespace tribound::certify
