#include "tribound/solve/equilibrium.h"

#include <cmath>
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

/// Whether condensing costs less than factorising the tangents. In 2D a factorisation takes about n^{3/2}
/// operations, dense ones the cube of their size. Measured on blocks and strips with p = 1, 2, 4: from
/// scratch, with 11 to 15 steps, condensing takes as long from 13 to 18 n^{1/2} kept unknowns on; on adaptive
/// meshes, with one step or two, it makes no difference at 6 n^{1/2}.
bool condensation_pays(int dim, Index n, const CondensedDofs& dofs, const algebra::SolverOptions& options,
                       bool from_scratch)
{
  const std::size_t kept = dofs.layer.size() + dofs.trace.size();
  if (dofs.layer.empty() || kept >= static_cast<std::size_t>(n)) return false;
  if (options.method == algebra::LinearMethod::condensed) return true;
  return dim == 2 && options.method == algebra::LinearMethod::automatic &&
         options.package != algebra::DirectPackage::umfpack &&
         static_cast<double>(kept) <= (from_scratch ? 12 : 6) * std::sqrt(n);
}

}  // namespace

template <int dim>
algebra::LinearMethod choose_method(const contact::NitscheForm<dim>& form,
                                    const algebra::SolverOptions& options, bool from_scratch)
{
  if (condensation_pays(dim, form.space().n_dofs(), condensed_dofs(form), options, from_scratch))
    return algebra::LinearMethod::condensed;
  return algebra::choose_method(options, dim, form.space().n_dofs());
}

template <int dim>
std::unique_ptr<Equilibrium<dim>> make_equilibrium(const contact::NitscheForm<dim>& form,
                                                   const algebra::SolverOptions& options, bool from_scratch)
{
  ExternalForces forces = external_forces(form);
  if (choose_method(form, options, from_scratch) == algebra::LinearMethod::condensed) try
    {
      return condensed_equilibrium(form, forces, condensed_dofs(form));
    }
    catch (const SolveError&)  // the tangent may be regular where the stiffness is not
    {
      if (options.method == algebra::LinearMethod::condensed) throw;
    }
  return sparse_equilibrium(form, std::move(forces), options);
}

template ExternalForces external_forces(const contact::NitscheForm<2>&);
template ExternalForces external_forces(const contact::NitscheForm<3>&);
template algebra::LinearMethod choose_method(const contact::NitscheForm<2>&, const algebra::SolverOptions&,
                                             bool);
template algebra::LinearMethod choose_method(const contact::NitscheForm<3>&, const algebra::SolverOptions&,
                                             bool);
template std::unique_ptr<Equilibrium<2>> make_equilibrium(const contact::NitscheForm<2>&,
                                                          const algebra::SolverOptions&, bool);
template std::unique_ptr<Equilibrium<3>> make_equilibrium(const contact::NitscheForm<3>&,
                                                          const algebra::SolverOptions&, bool);

}  // namespace tribound::solve
