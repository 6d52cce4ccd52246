#include "tribound/certify/equilibrate/stress_tabulation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tribound/fem/polynomials.h"

namespace tribound::certify
{

template <int dim>
StressTabulation<dim>::StressTabulation(int degree, std::span<const Point<dim>> points)
    : n_points_(static_cast<int>(points.size())), n_(fem::polynomial_dimension(dim, degree))
{
  std::array<int, dim + 1> local;
  for (int i = 0; i <= dim; ++i) local[i] = i;
  std::vector<double> at_point(n_);
  do  // permutations in lexicographic order, as permutation_number() counts them
  {
    std::vector<double>& values = basis_.emplace_back(static_cast<std::size_t>(n_) * n_points_);
    for (int q = 0; q < n_points_; ++q)
    {
      fem::orthonormal_values<dim>(degree, to_sorted_cell<dim>(local, points[q]), at_point);
      for (int j = 0; j < n_; ++j) values[j * n_points_ + q] = at_point[j];
    }
  } while (std::next_permutation(local.begin(), local.end()));
}

template <int dim>
void StressTabulation<dim>::evaluate(const SortedCell<dim>& cell, std::span<const double> block,
                                     std::span<double> values) const
{
  std::ranges::fill(values, 0);
  if (block.empty()) return;
  const std::vector<double>& basis = basis_[permutation_number(cell.local)];
  const double scale = 1 / std::sqrt(cell.det);
  for (int e = 0; e < dim * dim; ++e)
  {
    double* const entry = &values[e * n_points_];
    for (int j = 0; j < n_; ++j)
    {
      const double c = scale * block[e * n_ + j];
      const double* const row = &basis[j * n_points_];
      for (int q = 0; q < n_points_; ++q) entry[q] += c * row[q];
    }
  }
}

template class StressTabulation<2>;
template class StressTabulation<3>;

}  // namespace tribound::certify
