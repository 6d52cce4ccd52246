#include "tribound/certify/truth/true_error.h"

#include <algorithm>
#include <cmath>

#include "tribound/fem/nested.h"
#include "tribound/fem/polynomials.h"

namespace tribound::certify
{

template <int dim>
double count_dofs(const mesh::Mesh<dim>& mesh, const RicherSpace& space)
{
  const mesh::EntityCounts n = mesh::count_after_refinement(mesh, space.refinements);
  const int p = space.degree;
  const double in_facets = dim == 3 ? fem::polynomial_dimension(2, p - 3) * n.facets : 0.0;
  return dim *
         (n.vertices + (p - 1) * n.edges + in_facets + fem::polynomial_dimension(dim, p - dim - 1) * n.cells);
}

std::optional<double> effectivity(double bound, double dual_norm, const contact::StressNorms& norms)
{
  constexpr double resolution = 1e-10;
  if (std::max(bound, dual_norm) <= std::max(resolution * norms.sigma, norms.round_off)) return std::nullopt;
  return bound / dual_norm;
}

std::optional<double> energy_effectivity(const EnergyBound& bound, double error, double energy)
{
  constexpr double round_off = 1e-10;
  const bool is_known = bound.reason.empty() && bound.target == EnergyTarget::solution;
  if (!is_known || error <= round_off * std::sqrt(energy)) return std::nullopt;
  return bound.bound / error;
}

namespace
{

/// Newton's method from `start`; a singular matrix is one more reason for no solution.
template <int dim>
solve::NewtonResult<dim> solve_richer(const contact::NitscheForm<dim>& form, std::span<const double> start,
                                      const solve::NewtonOptions& newton,
                                      const algebra::SolverOptions& solver)
{
  try
  {
    return solve::solve<dim>(form, start, newton, solver);
  }
  catch (const SolveError& error)
  {
    solve::NewtonResult<dim> result;
    result.status = solve::NewtonStatus::diverged;
    result.message = error.what();
    return result;
  }
}

}  // namespace

template <int dim>
RicherSolution compare_with_richer(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                   const RicherSpace& richer, double gamma0,
                                   const solve::NewtonOptions& newton, const algebra::SolverOptions& solver,
                                   const UseOfRicher<dim>& use)
{
  const mesh::Refined<dim> refined = mesh::refine_uniformly(form.space().mesh(), richer.refinements);
  const fem::LagrangeSpace<dim> space(refined.mesh, richer.degree);
  const contact::NitscheForm<dim> richer_form(form.problem(), space, gamma0);
  std::vector<double> error = fem::nested_interpolant<dim>(form.space(), u, refined, space);
  const solve::NewtonResult<dim> solution = solve_richer<dim>(richer_form, error, newton, solver);

  RicherSolution result;
  result.cells = refined.mesh.n_cells();
  result.dofs = static_cast<long>(fem::n_free_dofs(space, richer_form.constraints()));
  result.newton_steps = static_cast<int>(solution.steps.size());
  result.failure = solution.message;
  if (solution.status != solve::NewtonStatus::converged) return result;
  for (std::size_t i = 0; i < error.size(); ++i) error[i] -= solution.u[i];
  const contact::StressNorms norms =
      contact::stress_norms<dim>(form.problem().without_initial_stress(), space, error);
  result.error = SolutionError{std::sqrt(norms.energy), norms.sigma};
  if (use) use(richer_form, solution.u);
  return result;
}

template double count_dofs(const mesh::Mesh<2>&, const RicherSpace&);
template double count_dofs(const mesh::Mesh<3>&, const RicherSpace&);
template RicherSolution compare_with_richer(const contact::NitscheForm<2>&, std::span<const double>,
                                            const RicherSpace&, double, const solve::NewtonOptions&,
                                            const algebra::SolverOptions&, const UseOfRicher<2>&);
template RicherSolution compare_with_richer(const contact::NitscheForm<3>&, std::span<const double>,
                                            const RicherSpace&, double, const solve::NewtonOptions&,
                                            const algebra::SolverOptions&, const UseOfRicher<3>&);

}  // namespace tribound::certify
