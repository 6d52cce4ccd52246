#pragma once

/// @file data_terms.h
/// The components of the bound that depend on the data and the mesh alone, method section 5.

#include <vector>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// osc and neu of each own cell; stress units times length^(dim/2).
struct DataTerms
{
  std::vector<double> osc;  ///< (h_T / pi) ||f - Pi^{p-1} f||_T
  std::vector<double> neu;  ///< sum over the Neumann facets of T of C_{T,F} ||g_N - Pi^p_F g_N||_F
  /// ||rho|| over all ranks, rho the cell means of what quadrature may miss of the loads. C_F ||rho|| bounds
  /// its effect.
  double missed = 0;
};

/// Upper bounds if the data are not polynomials: contact/nitsche/discrete_data.h.
template <int dim>
[[nodiscard]] DataTerms data_terms(const contact::NitscheForm<dim>& form);

}  // namespace tribound::certify
