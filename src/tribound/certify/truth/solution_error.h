#pragma once

/// @file solution_error.h
/// The distance of a discrete solution from a reference solution, cell by cell; method section 9.

#include <span>
#include <vector>

#include "tribound/certify/truth/true_error.h"
#include "tribound/fem/space.h"
#include "tribound/problem/problem.h"

namespace tribound::certify
{

/// The distance of u from a reference, with the share of every cell of the mesh of u: the squares of the
/// shares add up to the square of the whole.
struct LocalError
{
  SolutionError global;
  std::vector<double> energy;  ///< per cell: (sigma(e), eps(e))_T^{1/2}, e = u - u_ref
  std::vector<double> stress;  ///< per cell: ||sigma(e)||_T
};

/// Integrated exactly over the common refinement of the two meshes, which bisect() makes from one mesh.
/// Either degree may be the higher one. Throws std::invalid_argument for other meshes.
template <int dim>
[[nodiscard]] LocalError solution_error(const problem::Problem<dim>& problem,
                                        const fem::LagrangeSpace<dim>& space, std::span<const double> u,
                                        const fem::LagrangeSpace<dim>& reference_space,
                                        std::span<const double> u_ref);

}  // namespace tribound::certify
