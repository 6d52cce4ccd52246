#include "tribound/solve/equilibrium.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "tribound/base/error.h"
#include "tribound/base/rank_failure.h"
#include "tribound/contact/nitsche/residual.h"

namespace tribound::solve
{

template <int dim>
ExternalForces external_forces(const contact::NitscheForm<dim>& form)
{
  ExternalForces forces{{form.load().begin(), form.load().end()}};
  std::vector<double> lifting = contact::internal_forces<dim>(form, form.constraints().values);
  form.keep_free(forces.load);
  form.keep_free(lifting);
  forces.scale = form.space().norm(forces.load) + form.space().norm(lifting);
  for (std::size_t i = 0; i < lifting.size(); ++i) forces.load[i] -= lifting[i];
  return forces;
}

namespace
{

/// The unknowns that condensation keeps, if it is to be used. It costs less than factorising the tangents if
/// it keeps few: in 2D a sparse factorisation takes about n^{3/2} operations, a dense one the cube of its
/// size. Measured on blocks and strips with p = 1, 2, 4: from scratch, with 11 to 15 steps, condensing breaks
/// even at 13 to 18 n^{1/2} kept unknowns; on adaptive meshes, with one step or two, at 6 n^{1/2}.
template <int dim>
std::optional<CondensedDofs> worth_condensing(const contact::NitscheForm<dim>& form,
                                              const algebra::SolverOptions& options, bool from_scratch)
{
  if (!form.rigid_parts().empty()) return std::nullopt;
  const bool told = options.method == algebra::LinearMethod::condensed;
  const bool may_pay = dim == 2 && options.method == algebra::LinearMethod::automatic &&
                       options.package != algebra::DirectPackage::umfpack;
  if (!told && !may_pay) return std::nullopt;
  CondensedDofs dofs = condensed_dofs(form);
  const auto n = static_cast<double>(form.space().n_global_dofs());
  std::array<std::int64_t, 2> sizes{std::ssize(dofs.layer), std::ssize(dofs.trace)};
  form.space().mesh().ranks().sum(std::span(sizes));
  const auto kept = static_cast<double>(sizes[0] + sizes[1]);
  const bool pays = told || kept <= (from_scratch ? 12 : 6) * std::sqrt(n);
  if (sizes[0] == 0 || kept >= n || !pays) return std::nullopt;
  return dofs;
}

}  // namespace

template <int dim>
algebra::LinearMethod choose_method(const contact::NitscheForm<dim>& form,
                                    const algebra::SolverOptions& options, bool from_scratch)
{
  if (worth_condensing(form, options, from_scratch)) return algebra::LinearMethod::condensed;
  return algebra::choose_method(options, dim, form.space().n_global_dofs());
}

template <int dim>
std::unique_ptr<Equilibrium<dim>> make_equilibrium(const contact::NitscheForm<dim>& form,
                                                   const algebra::SolverOptions& options, bool from_scratch)
{
  if (std::optional<CondensedDofs> dofs = worth_condensing(form, options, from_scratch)) try
    {
      return condensed_equilibrium(form, external_forces(form), *std::move(dofs));
    }
    catch (const SolveError& error)  // the tangent may be regular where the stiffness is not
    {
      require_all_failed(form.space().mesh().ranks(), error.what());
      if (options.method == algebra::LinearMethod::condensed) throw;
    }
  return whole_equilibrium(form, options);
}

std::vector<double> round_off(std::span<const double> diagonal, std::span<const double> u)
{
  std::vector<double> result(u.size());
  for (std::size_t i = 0; i < u.size(); ++i)
    result[i] = 10 * std::numeric_limits<double>::epsilon() * diagonal[i] * u[i];
  return result;
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
