#pragma once

/// @file spring.h
/// Elastic supports and foundations.

#include <array>

#include "tribound/base/types.h"
#include "tribound/problem/field.h"

namespace tribound::problem
{

/// k_n n n^T + k_t (I - n n^T).
template <int dim>
[[nodiscard]] Tensor<dim> spring_matrix(double k_n, double k_t, const Point<dim>& n)
{
  return k_t * Tensor<dim>::Identity() + (k_n - k_t) * n * n.transpose();
}

/// Load steps share one stiffness matrix: throws InputError if the stiffness of a spring names t.
void refuse_time(const Field& stiffness);

/// Up to this degree of K the energy of springs is integrated exactly.
inline constexpr int most_of_stiffness = 2;

/// An elastic support or foundation: sigma n = g_N - K (u - u_0) with K = k_n n n^T + k_t (I - n n^T), n the
/// normal of the facet.
template <int dim>
struct Spring
{
  Field normal;                      ///< k_n >= 0, stress per length
  Field tangential;                  ///< k_t >= 0
  std::array<Field, dim> rest = {};  ///< u_0

  /// K at x. Throws InputError for a negative stiffness, as nonnegative_at() does.
  [[nodiscard]] Tensor<dim> stiffness(const Point<dim>& x, const Point<dim>& n) const;
  /// Of K, at most most_of_stiffness: what more it has is a remainder.
  [[nodiscard]] int stiffness_degree() const;
  /// Whether K has at most this degree, and u_0 that which is left of `degree`.
  [[nodiscard]] bool is_polynomial(int degree) const;
  /// Whether what is no such polynomial is enclosed.
  [[nodiscard]] bool is_enclosed(int degree) const;
};

}  // namespace tribound::problem
