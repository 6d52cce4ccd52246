#pragma once

/// @file data_terms.h
/// The components of the bound for data that are no polynomials, method section 5.

#include <span>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// osc and neu of each own cell; stress units times length^(dim/2).
struct DataTerms
{
  /// (h_T / pi) ||f - Pi^{p-1} f||_T; of an axisymmetric problem that of f - f_h, without the rest of f_h
  std::vector<double> osc;
  /// Sum over the Neumann facets of T of C_{T,F} ||g - Pi^p_F g||_F, g = g_N - K (u - u_0).
  std::vector<double> neu;
  /// ||rho|| over all ranks, with the weight of the problem, rho the cell means of what quadrature may miss
  /// of the loads. C_F ||rho|| bounds its effect.
  double missed = 0;
};

/// Upper bounds if the data are not polynomials: contact/nitsche/discrete_data.h, springs.h.
template <int dim>
[[nodiscard]] DataTerms data_terms(const contact::NitscheForm<dim>& form, std::span<const double> u);

}  // namespace tribound::certify
