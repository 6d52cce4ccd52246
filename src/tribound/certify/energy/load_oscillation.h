#pragma once

/// @file load_oscillation.h
/// What loads that are no polynomials add to the energy bound, method section 13.5.

#include <vector>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::certify
{

/// O_T of the own cells, (C_V ||f - Pi f||_T + sum_F C_F ||g_N - Pi g_N||_F) / min(2 mu, 2 mu + d
/// lambda)^{1/2}:
/// |(f - Pi f, w)_T + sum_F (g_N - Pi g_N, w)_F| <= O_T ||w||_en,T for all w, but for what quadrature misses
/// of the loads.
template <int dim>
[[nodiscard]] std::vector<double> load_oscillation(const contact::NitscheForm<dim>& form);

}  // namespace tribound::certify
