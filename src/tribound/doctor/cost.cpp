#include "tribound/doctor/cost.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tribound/certify/truth/true_error.h"
#include "tribound/fem/degree.h"

namespace tribound::doctor
{

namespace
{

struct Model
{
  double bytes_per_dof;
  double seconds_per_dof;
};

/// Fitted to measured runs of the block of example 01 and its 3D sibling from scratch, 6 to 23 Newton steps,
/// on one core (docs/doctor.md): 2D to 231k degrees of freedom, 3D to 54k direct and 90k with multigrid. The
/// factors of a 3D matrix grow like n^(4/3), computing them costs n^2 [George73]; everything else is linear.
Model model(int dim, int degree, algebra::LinearMethod method, double n)
{
  if (dim == 2) return {1500.0 + 1000 * degree, 2.2e-5};
  if (method == algebra::LinearMethod::direct)
    return {-400.0 + 2400 * degree + 420 * std::cbrt(n), 3.8e-4 + 7.6e-9 * n};
  return {4500.0 + 1200 * degree, 2e-4};
}

}  // namespace

template <int dim>
std::vector<CostEstimate> cost_estimates(const mesh::Mesh<dim>& mesh, const algebra::SolverOptions& config)
{
  constexpr double program = 50e6;  // bytes of the program and its libraries
  std::vector<CostEstimate> estimates;
  for (int degree = 1; degree <= fem::max_degree; ++degree)
  {
    const double dofs = certify::count_dofs(mesh, {.refinements = 0, .degree = degree});
    const auto n = static_cast<Index>(std::min<double>(dofs, std::numeric_limits<Index>::max()));
    const algebra::LinearMethod method = algebra::choose_method(config, dim, n);
    const Model per_dof = model(dim, degree, method, dofs);
    estimates.push_back(
        {degree, dofs, method, program + per_dof.bytes_per_dof * dofs, per_dof.seconds_per_dof * dofs});
  }
  return estimates;
}

template std::vector<CostEstimate> cost_estimates(const mesh::Mesh<2>&, const algebra::SolverOptions&);
template std::vector<CostEstimate> cost_estimates(const mesh::Mesh<3>&, const algebra::SolverOptions&);

}  // namespace tribound::doctor
