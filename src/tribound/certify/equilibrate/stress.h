#pragma once

/// @file stress.h
/// The equilibrated stress: piecewise polynomials of degree p, coefficients cell by cell.

#include <span>
#include <string_view>
#include <vector>

#include "tribound/base/types.h"

namespace tribound::certify
{

/// The space and the norm in which the stress of a patch is the nearest to its target.
enum class PatchStress
{
  rows,           ///< not symmetric, row by row, L2: enough for the bound of the residual
  afw,            ///< weakly symmetric, L2
  afw_compliance  ///< weakly symmetric, the norm of C^{-1}, C the elasticity tensor of each cell
};

/// The name of the space, as in a case.
[[nodiscard]] constexpr std::string_view to_string(PatchStress patches)
{
  return patches == PatchStress::rows ? "rows" : "afw";
}

/// sigma_h = sigma_dis + sigma_lin (+ sigma_reg, method section 7). On each cell, entry (r, c) has
/// coefficients in the orthonormal basis of P^p(T), phi_j(xhat) / sqrt(det J) with the cell's vertices in
/// ascending order (certify/equilibrate/sorted_cell.h); they are stored entry by entry: coefficient j of
/// entry (r, c) at (dim * r + c) * n + j. Norms are sums of squares, projections truncations.
template <int dim>
struct Stress
{
  int degree = 0;
  int n = 0;                   ///< dim P^p
  PatchStress patches{};       ///< `afw` in both norms of that space
  std::vector<double> dis;     ///< all cells that the rank owns
  std::vector<int> lin_block;  ///< per cell: number of its block in lin and reg, or -1 where both vanish
  std::vector<double> lin;     ///< the cells with a vertex on Gamma_C
  std::vector<double> reg;     ///< the same cells; empty unless T was regularised
  /// What the parts carry up to projection on Gamma_C, at the contact points, and on springs.
  struct Tractions
  {
    std::vector<Point<dim>> dis;        ///< T(u^k)
    std::vector<Point<dim>> lin;        ///< t^k - T_delta(u^k)
    std::vector<Point<dim>> reg;        ///< T_delta(u^k) - T(u^k); empty unless T was regularised
    std::vector<Point<dim>> springs{};  ///< -K (u^k - u_0) at the points of contact::Springs::facets()

    /// Their sum t^k.
    [[nodiscard]] std::vector<Point<dim>> running() const
    {
      std::vector<Point<dim>> t = dis;
      for (std::size_t i = 0; i < t.size(); ++i) t[i] += lin[i];
      for (std::size_t i = 0; i < reg.size(); ++i) t[i] += reg[i];
      return t;
    }
  } tractions;

  /// Weakly.
  [[nodiscard]] bool is_symmetric() const { return degree > 1 && patches != PatchStress::rows; }
  [[nodiscard]] std::size_t block_size() const { return static_cast<std::size_t>(dim) * dim * n; }
  [[nodiscard]] std::span<const double> dis_in(Index cell) const
  {
    return std::span(dis).subspan(cell * block_size(), block_size());
  }
  /// Empty where sigma_lin vanishes.
  [[nodiscard]] std::span<const double> lin_in(Index cell) const { return in_cell(lin, cell); }
  /// Empty where sigma_reg vanishes.
  [[nodiscard]] std::span<const double> reg_in(Index cell) const { return in_cell(reg, cell); }

 private:
  [[nodiscard]] std::span<const double> in_cell(const std::vector<double>& part, Index cell) const
  {
    if (lin_block[cell] < 0 || part.empty()) return {};
    return std::span(part).subspan(lin_block[cell] * block_size(), block_size());
  }
};

}  // namespace tribound::certify
