#pragma once

/// @file initial_moments.h
/// The initial stress in the bases of the patches, method section 16.

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "tribound/certify/equilibrate/prepared_cell.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"

namespace tribound::certify
{

/// Pi^{p-1} sigma_0 and Pi^p (psi_a sigma_0) from the moments of sigma_0 against P^{p+1}.
template <int dim, int p>
class InitialMoments
{
 public:
  using S = Sizes<dim, p>;

  explicit InitialMoments(const contact::NitscheForm<dim>& form) : initial_(form.data().initial_stress())
  {
    if (!form.problem().has_initial_stress()) return;
    std::array<int, dim + 1> local;
    for (int i = 0; i <= dim; ++i) local[i] = i;
    do
    {
      const auto number = static_cast<std::size_t>(permutation_number(local));
      if (number >= tables_.size()) tables_.resize(number + 1);
      tables_[number] = make_table(local);
    } while (std::ranges::next_permutation(local).found);
  }

  /// Adds Pi^{p-1} sigma_0 to the stress of a cell.
  void add(Index cell, const SortedCell<dim>& sorted, DiscreteStress<dim, p>& sigma) const
  {
    const std::span<const Tensor<dim>> given = initial_.coefficients(cell);
    if (given.empty()) return;
    const Table& table = tables_[permutation_number(sorted.local)];
    add_product<S::multiplier>(table.plain, std::sqrt(sorted.det), given, 0, sigma);
  }

  /// A stress of degree p - 1 plus Pi^p sigma_0.
  [[nodiscard]] StressCoefficients<dim, p> total(Index cell, const SortedCell<dim>& sorted,
                                                 const DiscreteStress<dim, p>& elastic) const
  {
    StressCoefficients<dim, p> result{};
    for (int entry = 0; entry < dim * dim; ++entry)
      std::copy_n(&elastic[entry * S::multiplier], S::multiplier, &result[entry * S::stress]);
    if (const std::span<const Tensor<dim>> given = initial_.coefficients(cell); !given.empty())
      add_product<S::stress>(tables_[permutation_number(sorted.local)].plain, std::sqrt(sorted.det), given, 0,
                             result);
    return result;
  }

  /// For each vertex Pi^p (psi_a sigma_0) - psi_a Pi^{p-1} sigma_0; empty where sigma_0 is in P^{p-1}.
  void find_rest(Index cell, const SortedCell<dim>& sorted,
                 std::vector<StressCoefficients<dim, p>>& rest) const
  {
    rest.clear();
    const std::span<const Tensor<dim>> given = initial_.coefficients(cell);
    const std::size_t first = std::min<std::size_t>(S::multiplier, given.size());
    if (std::ranges::all_of(given.subspan(first), [](const Tensor<dim>& c) { return c.isZero(0); })) return;
    const Table& table = tables_[permutation_number(sorted.local)];
    rest.resize(dim + 1, {});
    for (int a = 0; a <= dim; ++a)
      add_product<S::stress>(table.with_hat[a], std::sqrt(sorted.det), given, first, rest[a]);
  }

 private:
  static constexpr int n_theta = fem::polynomial_dimension(dim, p + 1);
  /// [i * n_theta + j]
  using Products = std::vector<double>;

  /// chi is the orthonormal basis in sorted coordinates, theta that in the cell's own.
  struct Table
  {
    Products plain;                          ///< (chi_i, theta_j) on the reference cell
    std::array<Products, dim + 1> with_hat;  ///< (psi_a chi_i, theta_j)
  };

  static Table make_table(const std::array<int, dim + 1>& local)
  {
    const fem::Quadrature<dim> rule = fem::quadrature<dim>(2 * p + 2);
    Table table;
    table.plain.assign(static_cast<std::size_t>(S::stress) * n_theta, 0.0);
    table.with_hat.fill(table.plain);
    std::array<double, S::stress> chi;
    std::array<double, n_theta> theta;
    for (int q = 0; q < rule.size(); ++q)
    {
      const Point<dim> sorted = to_sorted_cell<dim>(local, rule.points[q]);
      fem::orthonormal_values<dim>(p, sorted, chi);
      fem::orthonormal_values<dim>(p + 1, rule.points[q], theta);
      const std::array<double, dim + 1> hat = fem::barycentric<dim>(sorted);
      for (int i = 0; i < S::stress; ++i)
        for (int j = 0; j < n_theta; ++j)
        {
          const double product = rule.weights[q] * chi[i] * theta[j];
          table.plain[i * n_theta + j] += product;
          for (int a = 0; a <= dim; ++a) table.with_hat[a][i * n_theta + j] += hat[a] * product;
        }
    }
    return table;
  }

  /// result_i += scale sum_{j >= first} products_ij given_j for i < n.
  template <int n, std::size_t size>
  static void add_product(const Products& products, double scale, std::span<const Tensor<dim>> given,
                          std::size_t first, std::array<double, size>& result)
  {
    for (int i = 0; i < n; ++i)
      for (std::size_t j = first; j < given.size(); ++j)
        for (int r = 0; r < dim; ++r)
          for (int c = 0; c < dim; ++c)
            result[(dim * r + c) * n + i] += scale * products[i * n_theta + j] * given[j](r, c);
  }

  const contact::InitialStress<dim>& initial_;
  std::vector<Table> tables_;  ///< by permutation_number(); empty without initial stress
};

}  // namespace tribound::certify
