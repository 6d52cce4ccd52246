#include "tribound/solve/equilibrium.h"

#include <utility>

#include "tribound/base/error.h"
#include "tribound/base/norm.h"
#include "tribound/contact/nitsche/elasticity.h"

namespace tribound::solve
{

template <int dim>
ExternalForces external_forces(const contact::NitscheForm<dim>& form)
{
  const fem::Constraints& constraints = form.constraints();
  ExternalForces forces{{form.load().begin(), form.load().end()}};
  std::vector<double> lifting = contact::apply_stiffness(form.problem(), form.space(), constraints.values);
  for (std::size_t i = 0; i < lifting.size(); ++i)
    if (constraints.fixed[i]) lifting[i] = forces.load[i] = 0;
  forces.scale = norm(forces.load) + norm(lifting);
  for (std::size_t i = 0; i < lifting.size(); ++i) forces.load[i] -= lifting[i];
  return forces;
}

namespace
{

/// Whether condensing costs less than factorising the tangents.
bool condensation_pays(int dim, const CondensedDofs& dofs, const algebra::SolverOptions& options)
{
  if (dofs.layer.empty()) return false;
  if (options.method == algebra::LinearMethod::condensed) return true;
  return options.method == algebra::LinearMethod::automatic &&
         options.package != algebra::DirectPackage::umfpack && dim == 2;
}

}  // namespace

template <int dim>
std::unique_ptr<Equilibrium<dim>> make_equilibrium(const contact::NitscheForm<dim>& form,
                                                   const algebra::SolverOptions& options)
{
  ExternalForces forces = external_forces(form);
  if (CondensedDofs dofs = condensed_dofs(form); condensation_pays(dim, dofs, options)) try
    {
      return condensed_equilibrium(form, forces, std::move(dofs));
    }
    catch (const SolveError&)  // the tangent may be regular where the stiffness is not
    {
      if (options.method == algebra::LinearMethod::condensed) throw;
    }
  return sparse_equilibrium(form, std::move(forces), options);
}

template ExternalForces external_forces(const contact::NitscheForm<2>&);
template ExternalForces external_forces(const contact::NitscheForm<3>&);
template std::unique_ptr<Equilibrium<2>> make_equilibrium(const contact::NitscheForm<2>&,
                                                          const algebra::SolverOptions&);
template std::unique_ptr<Equilibrium<3>> make_equilibrium(const contact::NitscheForm<3>&,
                                                          const algebra::SolverOptions&);

}  // namespace tribound::solve
