#include "tribound/contact/support/rigid_motion.h"

#include <cassert>
#include <vector>

#include "tribound/contact/nitsche/discrete_data.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/contact/support/body.h"
#include "tribound/contact/support/body_check.h"

namespace tribound::contact
{

template <int dim>
void check_rigid_motions(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                         std::span<const ContactSegment<dim>> segments, const DiscreteData<dim>& data,
                         std::span<const double> load)
{
  assert(!space.mesh().partition());
  constexpr double relative_round_off = 1e-11;
  const std::vector<Body<dim>> bodies = find_bodies(space);
  const std::vector<Point<dim>> points = space.node_points();
  for (const Body<dim>& body : bodies)
  {
    const BodyCheck<dim> check(problem, space.mesh(), segments, data, body,
                               describe(body, problem, bodies.size() > 1));
    check.check_held();

    typename BodyCheck<dim>::Coefficients work =
        BodyCheck<dim>::Coefficients::Zero();  // L(z) for each rigid motion z
    double terms = 0;
    for (const Index i : body.nodes)
    {
      const Point<dim> force(load.data() + static_cast<std::size_t>(dim) * i);
      work += body.modes.at(points[i]).transpose() * force;
      terms += force.norm();
    }
    check.check_balanced(work, relative_round_off * terms);
  }
}

template <int dim>
void check_rigid_motions(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh, int degree)
{
  const fem::LagrangeSpace<dim> space(mesh, degree);
  const std::vector<ContactSegment<dim>> segments = contact_segments(problem, mesh, 1.0);
  const DiscreteData<dim> data(problem, mesh, degree, segments);
  check_rigid_motions<dim>(problem, space, segments, data, assemble_load<dim>(data, space));
}

template void check_rigid_motions(const problem::Problem<2>&, const fem::LagrangeSpace<2>&,
                                  std::span<const ContactSegment<2>>, const DiscreteData<2>&,
                                  std::span<const double>);
template void check_rigid_motions(const problem::Problem<3>&, const fem::LagrangeSpace<3>&,
                                  std::span<const ContactSegment<3>>, const DiscreteData<3>&,
                                  std::span<const double>);
template void check_rigid_motions(const problem::Problem<2>&, const mesh::Mesh<2>&, int);
template void check_rigid_motions(const problem::Problem<3>&, const mesh::Mesh<3>&, int);

}  // namespace tribound::contact
