#pragma once

/// @file load_oscillation.h
/// What loads that are no polynomials add to the energy bound, method section 13.5.

#include <vector>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// |(f - Pi f, w) + (g_N - Pi g_N, w)_N| <= sum_T O_T ||w||_en,T + missed ||w||_en for all w that vanish
/// where Gamma_D fixes them.
struct LoadOscillation
{
  std::vector<double> cells;  ///< O_T of the own cells
  double missed = 0;          ///< what quadrature may miss of the loads, of all ranks; infinite if K is
};

/// `korn` is K of certify/bound/korn.h. All ranks together.
template <int dim>
[[nodiscard]] LoadOscillation load_oscillation(const contact::NitscheForm<dim>& form, double korn);

}  // namespace tribound::certify
