#pragma once

/// @file cell_operator.h
/// The Arnold-Falk-Winther minimisation on one cell with its facet multipliers left over, method section 4.
///
/// On a cell with outward normal traces N, weak divergence B_U and weak skew part B_L, minimising |sigma -
/// G|^2 / 2 under B sigma = beta with multipliers mu for the normal traces gives
///
///     sigma = G - B^T eta - N^T mu,      B B^T eta = r - C mu,      r = B G - beta,  C = B N^T,
///     N sigma = g - S mu,                S = N N^T - C^T (B B^T)^{-1} C,   g = N G - C^T (B B^T)^{-1} r.
///
/// B_L B_L^T = 2 I, so the rotations go first; then B_U B_U^T becomes A = B_U B_U^T - B_U B_L^T B_L B_U^T / 2
/// and C becomes C_U - B_U B_L^T C_L / 2, both of size dim * dim P^{p-1}; N N^T becomes N N^T - C_L^T C_L
/// / 2. All of these are sums of a few reference matrices (certify/equilibrate/reference.h), and for the
/// stress itself the rotations only mean that its truncation to P^{p-1} is symmetric, up to w (p = 1).
///
/// In the norm of C^{-1}, C tau = scale tau + trace tr(tau) I, it is B^T, N^T and B_L^T that C stands before:
/// all products get the factor `scale`, and those of B_U^T and N^T a part more from the traces of these.

#include <array>
#include <span>

#include "tribound/certify/equilibrate/reference.h"
#include "tribound/certify/equilibrate/sorted_cell.h"
#include "tribound/problem/problem.h"

namespace tribound::certify
{

/// The rotation pairs (r, c), r < c, in the order of Lambda.
template <int dim>
inline constexpr auto skew_pairs = []
{
  std::array<std::array<int, 2>, dim*(dim - 1) / 2> pairs{};
  int n = 0;
  for (int r = 0; r < dim; ++r)
    for (int c = r + 1; c < dim; ++c) pairs[n++] = {r, c};
  return pairs;
}();

/// A stress on a cell: coefficient j of entry (r, c) at (dim * r + c) * n + j, n = dim P^p.
template <int dim, int p>
using StressCoefficients = std::array<double, dim * dim * Sizes<dim, p>::stress>;

/// sigma(u) on a cell: the same with n = dim P^{p-1}.
template <int dim, int p>
using DiscreteStress = std::array<double, dim * dim * Sizes<dim, p>::multiplier>;

/// The norm of C^{-1} in which the stress of a cell is the nearest, C tau = scale tau + trace tr(tau) I; by
/// default that of L2.
struct StressMetric
{
  double scale = 1;
  double trace = 0;

  friend bool operator==(const StressMetric&, const StressMetric&) = default;
};

/// What an elimination leaves that does not depend on the data.
template <int dim, int p>
class CellOperator
{
 public:
  using S = Sizes<dim, p>;
  static constexpr int dimension = dim;
  static constexpr int block = S::block;  ///< multipliers of a facet
  using UVector = DenseVector<S::u>;
  using FacetVectors = Dense<dim + 1, S::block>;  ///< row f: facet f
  /// Columns of all facets, those of facet f from f * facet_stride on.
  static constexpr int facet_stride = padded(S::block);
  static constexpr int all_facets = (dim + 1) * facet_stride;

  /// Factors A and forms the couplings C of all facets. Throws SolveError for a cell without volume.
  void build(const SortedCell<dim>& cell, const StressMetric& metric = {});
  /// Forms S; build() has been called.
  void condense(const SortedCell<dim>& cell);

  /// The rows of S that belong to facet f, distance all_facets.
  [[nodiscard]] const double* schur(int f) const { return schur_.row(f * S::block); }

  /// load -= C^T (B B^T)^{-1} r with r = (r_u, -2 w), w the skew tensor of p = 1.
  void subtract_load(FacetVectors& load, const SortedCell<dim>& cell, const UVector& r_u,
                     const Tensor<dim>& w) const;

  /// sigma - G = -C (B^T eta + N^T mu) for the data r = (r_u, -2 w) and the multipliers mu, G being
  /// symmetric.
  [[nodiscard]] StressCoefficients<dim, p> correction(const SortedCell<dim>& cell, const UVector& r_u,
                                                      const Tensor<dim>& w, const FacetVectors& mu) const;

 private:
  void apply_metric(StressCoefficients<dim, p>& stress) const;
  void factor(const SortedCell<dim>& cell);
  void couple(const SortedCell<dim>& cell);
  /// L^{-1} r_u with A = L L^T.
  [[nodiscard]] UVector reduce(const UVector& r_u) const;

  StressMetric metric_;
  Dense<S::u, S::u> factor_;             ///< U with A = U^T U
  std::array<double, S::u> reciprocal_;  ///< of its diagonal
  Dense<S::u, all_facets> coupling_;     ///< U^{-T} C
  Dense<(dim + 1) * S::block, all_facets> schur_;
};

/// The moment of 1 on the cell: its coefficient on the constant of the orthonormal basis.
template <int dim, int p>
[[nodiscard]] double moment_of_one(const SortedCell<dim>& cell)
{
  double sum = 0;
  for (int v = 0; v <= dim; ++v) sum += reference<dim, p>().hat_moment(0, v);
  return std::sqrt(cell.det) * sum;
}

/// The moments of the divergence of a discrete stress on U.
template <int dim, int p>
[[nodiscard]] DenseVector<Sizes<dim, p>::u> discrete_divergence(const SortedCell<dim>& cell,
                                                                const DiscreteStress<dim, p>& sigma);

/// The same of a stress of degree p.
template <int dim, int p>
[[nodiscard]] DenseVector<Sizes<dim, p>::u> divergence_moments(const SortedCell<dim>& cell,
                                                               const StressCoefficients<dim, p>& tau);

/// at(f, r, i) += the coefficient i of row r of the normal trace N tau on facet f.
template <int dim, int p, class At>
void add_normal_traces(const SortedCell<dim>& cell, const StressCoefficients<dim, p>& tau, const At& at);

/// C eps(u) in a cell in the orthonormal basis of P^{p-1}; nodes in the order of the space's basis.
template <int dim, int p>
[[nodiscard]] DiscreteStress<dim, p> discrete_stress(const SortedCell<dim>& cell,
                                                     const problem::Material& material,
                                                     std::span<const Index> nodes, std::span<const double> u);

}  // namespace tribound::certify
