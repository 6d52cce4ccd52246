#include "tribound/certify/truth/true_error.h"

#include <algorithm>
#include <cmath>

#include "tribound/fem/nested.h"
#include "tribound/fem/polynomials.h"

namespace tribound
{

template <int dim>
double count_dofs(const Mesh<dim>& mesh, const RicherSpace& space)
{
  const EntityCounts n = count_after_refinement(mesh, space.refinements);
  const int p = space.degree;
  const double in_facets = dim == 3 ? polynomial_dimension(2, p - 3) * n.facets : 0.0;
  return dim *
         (n.vertices + (p - 1) * n.edges + in_facets + polynomial_dimension(dim, p - dim - 1) * n.cells);
}

std::optional<double> effectivity(double bound, double dual_norm, const StressNorms& norms)
{
  constexpr double resolution = 1e-10;
  if (std::max(bound, dual_norm) <= std::max(resolution * norms.sigma, norms.round_off)) return std::nullopt;
  return bound / dual_norm;
}

namespace
{

/// Newton's method from `start`; a singular matrix is one more reason for having no solution.
template <int dim>
NewtonResult<dim> solve_richer(const NitscheForm<dim>& form, std::span<const double> start,
                               const NewtonConfig& newton, const SolverConfig& solver)
{
  try
  {
    return solve<dim>(form, start, newton, solver);
  }
  catch (const SolveError& error)
  {
    NewtonResult<dim> result;
    result.status = NewtonStatus::diverged;
    result.message = error.what();
    return result;
  }
}

}  // namespace

template <int dim>
RicherSolution compare_with_richer(const NitscheForm<dim>& form, std::span<const double> u,
                                   const RicherSpace& richer, double gamma0, const NewtonConfig& newton,
                                   const SolverConfig& solver)
{
  const Refined<dim> refined = refine_uniformly(form.space().mesh(), richer.refinements);
  const LagrangeSpace<dim> space(refined.mesh, richer.degree);
  const NitscheForm<dim> richer_form(form.problem(), space, gamma0);
  std::vector<double> error = nested_interpolant<dim>(form.space(), u, refined, space);
  const NewtonResult<dim> solution = solve_richer<dim>(richer_form, error, newton, solver);

  RicherSolution result;
  result.cells = refined.mesh.n_cells();
  result.dofs = space.n_dofs() - richer_form.constraints().n_fixed();
  result.newton_steps = static_cast<int>(solution.steps.size());
  result.failure = solution.message;
  if (solution.status != NewtonStatus::converged) return result;
  for (std::size_t i = 0; i < error.size(); ++i) error[i] -= solution.u[i];
  const StressNorms norms = stress_norms<dim>(form.problem(), space, error);
  result.error = SolutionError{std::sqrt(norms.energy), norms.sigma};
  return result;
}

template double count_dofs(const Mesh<2>&, const RicherSpace&);
template double count_dofs(const Mesh<3>&, const RicherSpace&);
template RicherSolution compare_with_richer(const NitscheForm<2>&, std::span<const double>,
                                            const RicherSpace&, double, const NewtonConfig&,
                                            const SolverConfig&);
template RicherSolution compare_with_richer(const NitscheForm<3>&, std::span<const double>,
                                            const RicherSpace&, double, const NewtonConfig&,
                                            const SolverConfig&);

}  // namespace tribound
