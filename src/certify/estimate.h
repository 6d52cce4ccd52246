#pragma once

/// @file estimate.h
/// The components of the bound, method section 5.

#include <array>
#include <span>
#include <vector>

#include "certify/stress.h"
#include "contact/nitsche.h"

namespace tribound
{

/// Global or cell values of the components; stress units times length^(dim/2).
struct BoundComponents
{
  double osc = 0;    ///< (h_T / pi) ||f - Pi^{p-1} f||
  double str = 0;    ///< ||sigma_dis - sigma(u)||
  double neu = 0;    ///< sum over Neumann facets of C_{T,F} ||g_N - Pi^p_F g_N||
  double lin1 = 0;   ///< ||sigma_lin||
  double cnt = 0;    ///< (sum h_F ||[P^n]_- - sigma_dis^n||_F^2)^{1/2}
  double frc = 0;    ///< (sum h_F ||[P^t]_S - sigma_dis^t||_F^2)^{1/2}
  double lin2n = 0;  ///< (sum h_F ||sigma_lin^n||_F^2)^{1/2}
  double lin2t = 0;  ///< (sum h_F ||sigma_lin^t||_F^2)^{1/2}

  /// (a^2 + b^2)^{1/2} with a = osc + str + neu + lin1 and b = cnt + frc + lin2n + lin2t [FD24].
  [[nodiscard]] double total() const;
  /// The same with b = ((cnt + lin2n)^2 + (frc + lin2t)^2)^{1/2}: normal and tangential part are orthogonal.
  [[nodiscard]] double total_sharp() const;
};

struct Estimate
{
  std::vector<BoundComponents> cells;
  BoundComponents global;  ///< (sum of squares over the cells)^{1/2}, component by component
  double total = 0;        ///< (sum_T total_T^2)^{1/2}
  double total_sharp = 0;  ///< the bound: ||R(u^k)||_* <= total_sharp
};

/// Evaluates every component of the iterate u on every cell.
template <int dim>
[[nodiscard]] Estimate estimate(const NitscheForm<dim>& form, std::span<const double> u,
                                const Stress<dim>& stress);

}  // namespace tribound
