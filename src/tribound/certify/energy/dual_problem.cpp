#include "tribound/certify/energy/dual_problem.h"

#include <cmath>
#include <utility>

#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/rigid_remainder.h"
#include "tribound/certify/energy/edge_moments.h"
#include "tribound/certify/energy/energy_bound.h"
#include "tribound/certify/energy/load_oscillation.h"
#include "tribound/certify/energy/meridian_edge_forces.h"
#include "tribound/contact/nitsche/contact_moments.h"
#include "tribound/contact/nitsche/given_data.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

template <int dim>
DualProblem<dim>::DualProblem(const contact::NitscheForm<dim>& form, problem::Problem<dim> problem)
    : problem_(std::move(problem)),
      form_(problem_, form.space(), form.gamma0(),
            std::vector(form.segments().begin(), form.segments().end())),
      equilibrator_(std::make_unique<Equilibrator<dim>>(
          form_, problem_.is_axisymmetric() ? PatchStress::afw_compliance : PatchStress::afw))
{
}

template <int dim>
std::vector<double> DualProblem<dim>::load(std::span<const Point<dim>> t) const
{
  std::vector<double> result(form_.load().begin(), form_.load().end());
  form_.add_contact_load(t, result);
  return result;
}

template <int dim>
Stress<dim> DualProblem<dim>::balanced(std::span<const double> z, std::span<const Point<dim>> t,
                                       std::string& reason) const
{
  std::vector<Tensor<dim>> turning;
  if constexpr (dim == 2)
    if (form_.space().degree() == 1)  // of an axisymmetric problem
      turning = edge_moments<2>(form_.space().mesh(), meridian_edge_forces(form_, z, t));
  Stress<dim> stress = equilibrator_->balanced(z, t, turning);
  if (!(check_identities<dim>(form_, t, stress).largest() <= cell_balance_limit) ||
      !(rigid_defect<dim>(form_, stress) <= cell_balance_limit))
    reason = "an identity of the dual stress is violated";
  return stress;
}

template <int dim>
double DualProblem<dim>::oscillation(std::span<const double> z) const
{
  double squares = 0;
  for (const double of_cell : load_oscillation<dim>(form_, z, 0).cells) squares += of_cell * of_cell;
  return std::sqrt(form_.space().mesh().ranks().sum(squares));
}

namespace
{

/// The problem with u_D = 0, without contact and initial stress, with further changes of its boundaries and
/// regions.
template <int dim, class ChangeBoundary, class ChangeRegion>
problem::Problem<dim> changed(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                              const ChangeBoundary& change_boundary, const ChangeRegion& change_region)
{
  const problem::Problem<dim> elastic = problem.without_initial_stress();
  std::vector<problem::Region<dim>> regions(elastic.regions().begin(), elastic.regions().end());
  for (problem::Region<dim>& region : regions) change_region(region);
  std::vector<problem::BoundaryCondition<dim>> boundaries(problem.boundaries().begin(),
                                                          problem.boundaries().end());
  for (std::size_t tag = 0; tag < boundaries.size(); ++tag)
  {
    for (std::optional<problem::Field>& component : boundaries[tag].displacement)
      if (component) component = problem::Field(0.0);
    boundaries[tag].contact.reset();
    if (boundaries[tag].spring) boundaries[tag].spring->rest = {};
    change_boundary(static_cast<int>(tag), boundaries[tag]);
  }
  problem::Problem<dim> result(mesh, regions, boundaries);
  if constexpr (dim == 2)
    if (problem.is_axisymmetric()) return result.axisymmetric();
  return result;
}

/// The problem without loads, but with load(boundary) on one boundary.
template <int dim, class Load>
problem::Problem<dim> unloaded(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh, int tag,
                               const Load& load)
{
  return changed<dim>(
      problem, mesh,
      [&](int number, problem::BoundaryCondition<dim>& boundary)
      {
        boundary.traction = {};
        boundary.pressure.reset();
        if (boundary.rigid) boundary.rigid->force = {};
        if (boundary.rigid) boundary.rigid->moment = {};
        if (number == tag) load(boundary);
      },
      [](problem::Region<dim>& region) { region.body_force = {}; });
}

/// The force and moment of the traction q on a rigid part, of a body of revolution those on the full circle,
/// which along the axis alone are used.
template <int dim>
void set_resultant(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh, int tag,
                   const Point<dim>& q, problem::RigidPart<dim>& part)
{
  Point<dim + 1> sum = Point<dim + 1>::Zero();  // of x; the last entry: the measure
  for (const mesh::BoundaryFacet& facet : mesh.owned_boundary())
  {
    if (facet.tag != tag) continue;
    const double measure = problem.full_circle() * contact::weighted_measure(problem, mesh, facet);
    for (const Index v : mesh::facet_vertices(mesh.cell(facet.cell), facet.local))
      sum.template head<dim>() += measure / dim * mesh.vertex(v);
    sum[dim] += measure;
  }
  mesh.ranks().sum(std::span(sum.data(), sum.size()));
  const Point<dim> arm = sum.template head<dim>() - sum[dim] * part.point;
  const auto moment = contact::moment(arm, q);
  for (int a = 0; a < dim; ++a) part.force[a] = problem::Field(sum[dim] * q[a]);
  for (std::size_t a = 0; a < part.moment.size(); ++a) part.moment[a] = problem::Field(moment[a]);
}

}  // namespace

template <int dim>
problem::Problem<dim> with_loads(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh)
{
  return changed<dim>(
      problem, mesh, [](int, const auto&) {}, [](const auto&) {});
}

template <int dim>
problem::Problem<dim> with_load_on(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh, int tag,
                                   const Point<dim>& q)
{
  return unloaded<dim>(problem, mesh, tag,
                       [&](problem::BoundaryCondition<dim>& boundary)
                       {
                         if (boundary.rigid)
                           set_resultant<dim>(problem, mesh, tag, q, *boundary.rigid);
                         else
                           for (int a = 0; a < dim; ++a) boundary.traction[a] = problem::Field(q[a]);
                       });
}

template <int dim>
problem::Problem<dim> with_spring_moved(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                        int tag, const Point<dim>& e)
{
  return unloaded<dim>(problem, mesh, tag,
                       [&](problem::BoundaryCondition<dim>& boundary)
                       {
                         for (int a = 0; a < dim; ++a) boundary.spring->rest[a] = problem::Field(-e[a]);
                       });
}

template <int dim>
problem::Problem<dim> without_loads(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh)
{
  return with_load_on<dim>(problem, mesh, -1, Point<dim>::Zero());
}

template class DualProblem<2>;
template class DualProblem<3>;
template problem::Problem<2> without_loads(const problem::Problem<2>&, const mesh::Mesh<2>&);
template problem::Problem<3> without_loads(const problem::Problem<3>&, const mesh::Mesh<3>&);
template problem::Problem<2> with_loads(const problem::Problem<2>&, const mesh::Mesh<2>&);
template problem::Problem<3> with_loads(const problem::Problem<3>&, const mesh::Mesh<3>&);
template problem::Problem<2> with_load_on(const problem::Problem<2>&, const mesh::Mesh<2>&, int,
                                          const Point<2>&);
template problem::Problem<3> with_load_on(const problem::Problem<3>&, const mesh::Mesh<3>&, int,
                                          const Point<3>&);
template problem::Problem<2> with_spring_moved(const problem::Problem<2>&, const mesh::Mesh<2>&, int,
                                               const Point<2>&);
template problem::Problem<3> with_spring_moved(const problem::Problem<3>&, const mesh::Mesh<3>&, int,
                                               const Point<3>&);

}  // namespace tribound::certify
