#pragma once

/// @file cost.h
/// The expected cost of solving on a mesh.

#include <vector>

#include "tribound/algebra/linear_solver.h"
#include "tribound/mesh/mesh.h"

namespace tribound::doctor
{

/// Cost on the first mesh, all Newton steps and the certificate included, on one core.
struct CostEstimate
{
  int degree = 0;
  double dofs = 0;  ///< fixed ones included
  algebra::LinearMethod method = algebra::LinearMethod::direct;
  double bytes = 0;
  double seconds = 0;
};

/// Estimates for the degrees 1 to 4, from a model fitted to measured runs (docs/doctor.md). On other runs of
/// the same sizes, memory was right within a factor of 1.5, mostly within a quarter, and time within a factor
/// of 2. Beyond these sizes both are extrapolated.
template <int dim>
[[nodiscard]] std::vector<CostEstimate> cost_estimates(const mesh::Mesh<dim>& mesh,
                                                       const algebra::SolverOptions& config);

}  // namespace tribound::doctor
