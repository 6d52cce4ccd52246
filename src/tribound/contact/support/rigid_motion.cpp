#include "tribound/contact/support/rigid_motion.h"

#include <cassert>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/contact/support/assembly.h"
#include "tribound/contact/support/assembly_check.h"
#include "tribound/fem/space.h"

namespace tribound::contact
{

template <int dim>
void check_rigid_motions(const NitscheForm<dim>& form, std::span<const double> load)
{
  const fem::LagrangeSpace<dim>& space = form.space();
  assert(!space.mesh().partition());
  // What contact holds is the effective traction: water acts like a load.
  std::vector<double> pushed(load.begin(), load.end());
  std::vector<Point<dim>> water = form.water_pressure();
  for (Point<dim>& t : water) t = -t;
  form.add_contact_load(water, pushed);
  constexpr double relative_round_off = 1e-11;
  const std::vector<Assembly<dim>> assemblies = find_assemblies<dim>(space, form.segments());
  const std::vector<Point<dim>> points = space.node_points();
  for (const Assembly<dim>& assembly : assemblies)
  {
    const AssemblyCheck<dim> check(form, assembly, assembly.describe(form.problem(), assemblies.size() > 1));
    check.check_held();

    Eigen::VectorXd work = Eigen::VectorXd::Zero(assembly.n_motions());  // L(z) for each rigid motion z
    double terms = 0;
    for (int b = 0; b < static_cast<int>(assembly.bodies.size()); ++b)
      for (const Index i : assembly.bodies[b].nodes)
      {
        const Point<dim> force(pushed.data() + static_cast<std::size_t>(dim) * i);
        work(assembly.coefficients(b)) += assembly.modes.at(points[i]).transpose() * force;
        terms += force.norm();
      }
    check.check_balanced(work, relative_round_off * terms);
  }
}

template <int dim>
std::string why_not_held(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space)
{
  try
  {
    check_rigid_motions(NitscheForm<dim>(problem, space, 1.0));
  }
  catch (const InputError& error)
  {
    return error.problem();
  }
  return {};
}

template <int dim>
void check_rigid_motions(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh, int degree)
{
  const fem::LagrangeSpace<dim> space(mesh, degree);
  check_rigid_motions(NitscheForm<dim>(problem, space, 1.0));
}

template void check_rigid_motions(const NitscheForm<2>&, std::span<const double>);
template void check_rigid_motions(const NitscheForm<3>&, std::span<const double>);
template std::string why_not_held(const problem::Problem<2>&, const fem::LagrangeSpace<2>&);
template std::string why_not_held(const problem::Problem<3>&, const fem::LagrangeSpace<3>&);
template void check_rigid_motions(const problem::Problem<2>&, const mesh::Mesh<2>&, int);
template void check_rigid_motions(const problem::Problem<3>&, const mesh::Mesh<3>&, int);

}  // namespace tribound::contact
