#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tribound/certify/energy/contact_resultant.h"
#include "tribound/fem/evaluation.h"
#include "tribound/mesh/bodies.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

namespace
{

/// Which bodies have contact facets or springs of the resultant, the same on all ranks.
template <int dim>
std::vector<double> moved_bodies(const contact::NitscheForm<dim>& form, const mesh::Bodies& bodies,
                                 const ContactResultant<dim>& resultant)
{
  std::vector<double> moved(bodies.n, 0.0);
  for (const contact::ContactSegment<dim>& segment : form.segments())
    if (resultant.has(segment.slave.facet.tag)) moved[bodies.of_cell[segment.slave.facet.cell]] = 1;
  for (const mesh::BoundaryFacet& facet : form.space().mesh().owned_boundary())
    if (resultant.has_spring(form.problem(), facet.tag)) moved[bodies.of_cell[facet.cell]] = 1;
  form.space().mesh().ranks().max(std::span(moved));
  return moved;
}

/// Whether the traction of an obstacle on segment k is along a constant N, and the motion across it.
template <int dim>
bool slides_along(const contact::NitscheForm<dim>& form, std::size_t k, const RigidMotion<dim>& motion)
{
  const contact::ContactSegment<dim>& segment = form.segments()[k];
  if (segment.master || segment.varying_normal || problem::cone(segment.contact->law).resists_sliding())
    return false;
  return std::ranges::all_of(form.contact_points(k), [&](const contact::ContactPoint<dim>& point)
                             { return motion(point.x).dot(point.normal) == 0; });
}

/// The motion of a rigid part: that of its point, and its rotation.
template <int dim>
Eigen::Matrix<double, dim*(dim + 1) / 2, 1> of_part(const RigidMotion<dim>& motion,
                                                    const problem::RigidPart<dim>& part)
{
  Eigen::Matrix<double, dim*(dim + 1) / 2, 1> result;
  result.template head<dim>() = motion(part.point);
  if constexpr (dim == 2)
    result[2] = motion.spin(1, 0);
  else
    result.template tail<3>() = Point<3>(motion.spin(2, 1), motion.spin(0, 2), motion.spin(1, 0));
  return result;
}

/// Whether the guide of a rigid part acts in the motion.
template <int dim>
bool is_guided(const RigidMotion<dim>& motion, const problem::RigidPart<dim>& part)
{
  const auto moved = of_part(motion, part);
  bool found = false;
  for (std::size_t i = 0; i < part.fixed.size(); ++i)
    found = found || (part.fixed[i] && moved[static_cast<Eigen::Index>(i)] != 0);
  return found;
}

/// Whether anything but the facets of the resultant acts on the bodies in the motion.
template <int dim>
bool is_stopped(const contact::NitscheForm<dim>& form, const mesh::Bodies& bodies,
                std::span<const double> moved, const ContactResultant<dim>& resultant)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const auto moves = [&](const mesh::BoundaryFacet& facet) { return moved[bodies.of_cell[facet.cell]] != 0; };
  bool by_contact = false;
  for (std::size_t k = 0; k < form.segments().size() && !by_contact; ++k)
  {
    const contact::ContactSegment<dim>& segment = form.segments()[k];
    const bool is_other = !resultant.has(segment.slave.facet.tag);
    const bool acts =
        (moves(segment.slave.facet) && is_other) || (segment.master && moves(segment.master->facet));
    by_contact = acts && !(is_other && slides_along(form, k, resultant.motion));
  }
  bool by_conditions = false;
  for (const mesh::BoundaryFacet& facet : mesh.owned_boundary())
  {
    const problem::BoundaryCondition<dim>& condition = form.problem().boundary(facet.tag);
    if (!condition.holds_any() || !moves(facet)) continue;
    if (condition.rigid)
    {
      by_conditions = by_conditions || is_guided(resultant.motion, *condition.rigid);
      continue;
    }
    const Tensor<dim> acting =
        resultant.has_spring(form.problem(), facet.tag)
            ? condition.clamped()
            : condition.acting(mesh::facet_geometry(mesh, facet.cell, facet.local).normal);
    for (const Index v : mesh::facet_vertices(mesh.cell(facet.cell), facet.local))
      by_conditions = by_conditions || !(acting * resultant.motion(mesh.vertex(v))).isZero(0);
  }
  return mesh.ranks().any(by_contact || by_conditions);
}

/// Whether a motion of the meridian is one of the body of revolution.
template <int dim>
bool is_along_axis(const RigidMotion<dim>& motion)
{
  return motion.spin.isZero(0) && motion.translation[0] == 0;
}

/// The boundaries that are rigid parts of these bodies; all on the first rank.
template <int dim>
std::vector<int> moved_parts(const contact::NitscheForm<dim>& form, const mesh::Bodies& bodies,
                             std::span<const double> moved)
{
  std::vector<double> is_moved(form.problem().boundaries().size(), 0.0);
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  for (const mesh::BoundaryFacet& facet : mesh.owned_boundary())
    if (form.problem().boundary(facet.tag).rigid) is_moved[facet.tag] = moved[bodies.of_cell[facet.cell]];
  mesh.ranks().max(std::span(is_moved));
  std::vector<int> result;
  for (std::size_t tag = 0; tag < is_moved.size() && mesh.ranks().rank() == 0; ++tag)
    if (is_moved[tag] != 0) result.push_back(static_cast<int>(tag));
  return result;
}

/// Sums of the work of loads in the motion, of its absolute values and of what quadrature may miss, with the
/// weight of the problem.
template <int dim>
class LoadSums
{
 public:
  LoadSums(const problem::Problem<dim>& problem, const RigidMotion<dim>& motion)
      : problem_(problem), motion_(motion)
  {
  }

  /// Adds a cell or facet with these vertices.
  template <class Points, std::size_t n>
  void add(const Points& points, std::span<const Point<dim>> load, const std::array<Point<dim>, n>& vertices,
           double missed)
  {
    for (const auto& [q, x, dx] : points)
    {
      const Point<dim> m = problem_.weight(x) * motion_(x);
      work_ += dx * load[q].dot(m);
      absolute_ += dx * load[q].cwiseAbs().dot(m.cwiseAbs());
    }
    Point<dim> largest = Point<dim>::Zero();
    for (const Point<dim>& x : vertices)
      largest = largest.cwiseMax((problem_.weight(x) * motion_(x)).cwiseAbs());
    missed_ += missed * largest.sum();
  }

  /// Adds the force and the moment on a rigid part, of axisymmetric problems for one radian.
  void add(const problem::RigidPart<dim>& part)
  {
    const auto moved = of_part(motion_, part);
    auto load = moved;
    load << part.total_force(), part.total_moment();
    load /= problem_.full_circle();
    work_ += load.dot(moved);
    absolute_ += load.cwiseAbs().dot(moved.cwiseAbs());
  }

  [[nodiscard]] KnownNumber total(const Ranks& ranks) const
  {
    std::array<double, 3> sums{static_cast<double>(work_), absolute_, missed_};
    ranks.sum(std::span(sums));
    constexpr double unit_round_offs = 64;  // of values, points and weights
    return {-sums[0], unit_round_offs * std::numeric_limits<double>::epsilon() * sums[1] + sums[2]};
  }

 private:
  const problem::Problem<dim>& problem_;
  const RigidMotion<dim>& motion_;
  long double work_ = 0;
  double absolute_ = 0;
  double missed_ = 0;
};

}  // namespace

template <int dim>
std::optional<KnownNumber> from_equilibrium(const contact::NitscheForm<dim>& form,
                                            const ContactResultant<dim>& resultant)
{
  if (form.problem().is_axisymmetric() && !is_along_axis(resultant.motion)) return {};
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const mesh::Bodies bodies = mesh::number_bodies(mesh);
  const std::vector<double> moved = moved_bodies(form, bodies, resultant);
  if (is_stopped<dim>(form, bodies, moved, resultant)) return {};
  const contact::DiscreteData<dim>& data = form.data();
  LoadSums<dim> sums(form.problem(), resultant.motion);
  std::vector<Point<dim>> load(data.cell_rule().size());
  for (Index c = 0; c < mesh.n_owned_cells(); ++c)
  {
    if (moved[bodies.of_cell[c]] == 0 || !data.has_body_force(c)) continue;
    data.body_force(c, load);
    sums.add(fem::cell_points(mesh::cell_map(mesh, c), data.cell_rule()), load,
             mesh::points_of(mesh.vertices(), mesh.cell(c)), data.body_remainder(c).mean);
  }
  load.resize(data.facet_rule().size());
  for (std::size_t k = 0; k < mesh.n_owned_boundary(); ++k)
  {
    const mesh::BoundaryFacet& facet = mesh.boundary()[k];
    if (moved[bodies.of_cell[facet.cell]] == 0 || !data.has_traction(k)) continue;
    data.traction(k, load);
    sums.add(fem::facet_points(mesh, facet.cell, facet.local, data.facet_rule()), load,
             mesh::points_of(mesh.vertices(), mesh::facet_vertices(mesh.cell(facet.cell), facet.local)),
             data.traction_remainder(k).mean);
  }
  for (const int tag : moved_parts(form, bodies, moved)) sums.add(*form.problem().boundary(tag).rigid);
  return sums.total(mesh.ranks());
}

template std::optional<KnownNumber> from_equilibrium(const contact::NitscheForm<2>&,
                                                     const ContactResultant<2>&);
template std::optional<KnownNumber> from_equilibrium(const contact::NitscheForm<3>&,
                                                     const ContactResultant<3>&);

}  // namespace tribound::certify
