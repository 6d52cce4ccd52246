#include "tribound/doctor/support_facts.h"

#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "tribound/mesh/geometry.h"
#include "tribound/mesh/partition.h"

namespace tribound::doctor
{

namespace
{

/// Motions in the span of `motions` that are orthogonal to `others`, a subspace of it.
contact::MotionBasis complement(const contact::MotionBasis& motions, const contact::MotionBasis& others)
{
  if (motions.cols() == 0) return motions;
  const Eigen::MatrixXd inside = motions.transpose() * others;
  return motions * contact::null_space(inside * inside.transpose(), 1.0);
}

/// For each vertex on boundaries with displacement conditions, the numbers of these boundaries.
using FixedVertices = std::map<Index, std::set<int>>;

template <int dim>
FixedVertices vertices_on_displacement_boundaries(const problem::Problem<dim>& problem,
                                                  const mesh::Mesh<dim>& mesh)
{
  FixedVertices boundaries;
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
    if (problem.boundary(facet.tag).clamps_any())
      for (const Index v : mesh::facet_vertices(mesh.cell(facet.cell), facet.local))
        boundaries[v].insert(facet.tag);
  return boundaries;
}

/// u_D.n at x where the condition prescribes every component in which n is nonzero.
template <int dim>
std::optional<double> fixed_normal_displacement(const problem::BoundaryCondition<dim>& condition,
                                                const Point<dim>& n, const Point<dim>& x)
{
  constexpr double negligible = 1e-6;
  double normal = 0;
  for (int c = 0; c < dim; ++c)
  {
    if (condition.clamps(c))
      normal += n[c] * (*condition.displacement[c])(x);
    else if (std::abs(n[c]) > negligible)
      return std::nullopt;
  }
  return normal;
}

/// A vertex of a contact facet on a displacement boundary.
template <int dim>
struct Meeting
{
  const problem::BoundaryCondition<dim>& contact;
  const problem::BoundaryCondition<dim>& displacement;
  Point<dim> x;
  double normal;  ///< u_D^n
  bool new_vertex;
};

template <int dim>
void add(OverconstrainedCorner& corner, const Meeting<dim>& meeting)
{
  corner.vertices += meeting.new_vertex ? 1 : 0;
  const double gap = (*meeting.contact.contact->gap)(meeting.x);
  if (!corner.where.empty() && meeting.normal - gap <= corner.normal - corner.gap) return;
  corner.contact = meeting.contact.name;
  corner.displacement = meeting.displacement.name;
  corner.where = place<dim>(meeting.x);
  corner.normal = meeting.normal;
  corner.gap = gap;
  corner.sticks = cone(meeting.contact.contact->law).resists_sliding();
  for (int c = 0; c < dim; ++c) corner.sticks = corner.sticks && meeting.displacement.clamps(c);
}

/// Per boundary number, the mean normal of an obstacle or slave whose segments are within 10 degrees of it.
template <int dim>
std::vector<std::optional<Point<dim>>> normals_of_planes(
    std::size_t n_boundaries, const mesh::Mesh<dim>& mesh,
    std::span<const contact::ContactSegment<dim>> segments)
{
  constexpr double cos_limit = 0.985;
  std::vector<Point<dim>> sum(n_boundaries, Point<dim>::Zero());
  for (const contact::ContactSegment<dim>& segment : segments)
    sum[segment.slave.facet.tag] += segment.measure * contact::normal_at_centre(mesh, segment);
  std::vector<std::optional<Point<dim>>> normals(sum.size());
  for (std::size_t tag = 0; tag < sum.size(); ++tag)
    if (sum[tag].norm() > 0) normals[tag] = sum[tag].normalized();
  for (const contact::ContactSegment<dim>& segment : segments)
    if (auto& normal = normals[segment.slave.facet.tag];
        normal && contact::normal_at_centre(mesh, segment).dot(*normal) < cos_limit)
      normal.reset();
  return normals;
}

/// Marks the boundaries along which the bodies of an assembly slide, see slides_as_a_whole().
template <int dim>
void mark_sliding(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                  std::span<const contact::ContactSegment<dim>> segments,
                  std::span<const std::optional<Point<dim>>> plane, const contact::Assembly<dim>& assembly,
                  std::vector<bool>& slides)
{
  constexpr double negligible = 1e-6;  // motions are normalised
  const contact::MotionBasis left = contact::Support<dim>(problem, mesh, segments, assembly).left_by_fixing();
  if (left.cols() == 0) return;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(assembly.n_motions(), assembly.n_motions());
  contact::for_each_corner(mesh, segments, assembly,
                           [&](const contact::AssemblySegment&, const contact::ContactSegment<dim>& segment,
                               const Point<dim>& along, const std::vector<int>& coefficients, const auto& z)
                           {
                             const Point<dim> n = plane[segment.slave.facet.tag].value_or(along);
                             const Eigen::RowVectorXd z_n = n.transpose() * z;
                             gram(coefficients, coefficients) += z_n.transpose() * z_n;
                           });
  const contact::MotionBasis motions =
      left * contact::null_space(left.transpose() * gram * left, gram.trace());
  contact::for_each_corner(mesh, segments, assembly,
                           [&](const contact::AssemblySegment&, const contact::ContactSegment<dim>& segment,
                               const Point<dim>&, const std::vector<int>& coefficients, const auto& z)
                           {
                             const int tag = segment.slave.facet.tag;
                             slides[tag] =
                                 slides[tag] ||
                                 (plane[tag] && (z * motions(coefficients, Eigen::all)).norm() > negligible);
                           });
}

}  // namespace

bool OverconstrainedCorner::contradicts() const
{
  constexpr double round_off = 1e-12;
  return normal - gap > round_off * (std::abs(normal) + gap);
}

template <int dim>
std::vector<bool> slides_as_a_whole(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh)
{
  const fem::LagrangeSpace<dim> space(mesh, 1);
  const std::vector<contact::ContactSegment<dim>> segments = contact::contact_segments(problem, mesh, 1.0);
  std::vector<bool> slides(problem.boundaries().size(), false);
  const std::vector<std::optional<Point<dim>>> plane =
      normals_of_planes<dim>(problem.boundaries().size(), mesh, segments);
  for (const contact::Assembly<dim>& assembly : contact::find_assemblies<dim>(space, segments))
    mark_sliding<dim>(problem, mesh, segments, plane, assembly, slides);
  return slides;
}

template <int dim>
std::vector<ContactHeldMotion> motions_held_by_contact(const contact::NitscheForm<dim>& form)
{
  const std::vector<contact::Assembly<dim>> assemblies =
      contact::find_assemblies<dim>(form.space(), form.segments());
  std::vector<ContactHeldMotion> result;
  for (const contact::Assembly<dim>& assembly : assemblies)
  {
    const contact::Support<dim> support(form.problem(), form.space().mesh(), form.segments(), assembly);
    const contact::MotionBasis left = support.left_by_fixing();
    const contact::MotionBasis sliding = support.left_by_contact(false);
    const auto add = [&](const contact::MotionBasis& motions, bool by_friction)
    {
      for (const Eigen::VectorXd& z : assembly.readable_basis(motions))
        result.push_back({assembly.describe(form.problem(), assemblies.size() > 1),
                          assembly.describe(form.problem(), z), by_friction, support.remedy(z),
                          assembly.bodies.size() > 1});
    };
    add(complement(left, sliding), false);
    add(sliding, true);
  }
  return result;
}

template <int dim>
std::vector<OverconstrainedCorner> overconstrained_corners(const contact::NitscheForm<dim>& form)
{
  const problem::Problem<dim>& problem = form.problem();
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const FixedVertices fixed = vertices_on_displacement_boundaries(problem, mesh);
  std::map<std::pair<int, int>, OverconstrainedCorner> corners;  // by contact and displacement boundary
  std::map<std::pair<int, int>, std::set<Index>> seen;
  for (const contact::ContactSegment<dim>& segment : form.segments())
  {
    if (segment.master) continue;  // the other body yields
    const mesh::BoundaryFacet& facet = segment.slave.facet;
    for (const Index v : mesh::facet_vertices(mesh.cell(facet.cell), facet.local))
    {
      const auto boundaries = fixed.find(v);
      if (boundaries == fixed.end()) continue;
      for (const int tag : boundaries->second)
      {
        const problem::BoundaryCondition<dim>& condition = problem.boundary(tag);
        const auto normal =
            fixed_normal_displacement<dim>(condition, segment.normal_at(mesh.vertex(v)), mesh.vertex(v));
        if (!normal) continue;
        const std::pair key(facet.tag, tag);
        add<dim>(corners[key], {problem.boundary(facet.tag), condition, mesh.vertex(v), *normal,
                                seen[key].insert(v).second});
      }
    }
  }
  std::vector<OverconstrainedCorner> result;
  result.reserve(corners.size());
  for (auto& [key, corner] : corners) result.push_back(std::move(corner));
  return result;
}

template std::vector<bool> slides_as_a_whole(const problem::Problem<2>&, const mesh::Mesh<2>&);
template std::vector<bool> slides_as_a_whole(const problem::Problem<3>&, const mesh::Mesh<3>&);
template std::vector<ContactHeldMotion> motions_held_by_contact(const contact::NitscheForm<2>&);
template std::vector<ContactHeldMotion> motions_held_by_contact(const contact::NitscheForm<3>&);
template std::vector<OverconstrainedCorner> overconstrained_corners(const contact::NitscheForm<2>&);
template std::vector<OverconstrainedCorner> overconstrained_corners(const contact::NitscheForm<3>&);

}  // namespace tribound::doctor
