#include "tribound/certify/equilibrate/too_flat.h"

#include <fmt/format.h>

#include <algorithm>

#include "tribound/mesh/describe.h"

namespace tribound::certify
{

template <int dim>
double slenderness(const SortedCell<dim>& cell)
{
  double longest = 0;
  for (int j = 0; j < dim; ++j)
  {
    longest = std::max(longest, cell.jacobian.col(j).norm());
    for (int i = 0; i < j; ++i)
      longest = std::max(longest, (cell.jacobian.col(j) - cell.jacobian.col(i)).norm());
  }
  return longest * *std::ranges::max_element(cell.grad_norm);  // 1 / |grad lambda_i|: height over facet i
}

template <int dim>
SolveError no_equilibrated_stress(const Point<dim>& place, double slenderness)
{
  constexpr double slender = 1000;  // patches of degree 4 still factor
  const std::string why =
      slenderness > slender
          ? fmt::format("a cell there is {:.2g} times as long as high: mesh again, with rounder cells",
                        slenderness)
          : std::string("numbers there differ by too many powers of ten: check units, sizes and materials");
  return SolveError(fmt::format("there is no equilibrated stress at {}: {}", mesh::describe(place), why));
}

template double slenderness<2>(const SortedCell<2>&);
template double slenderness<3>(const SortedCell<3>&);
template SolveError no_equilibrated_stress<2>(const Point<2>&, double);
template SolveError no_equilibrated_stress<3>(const Point<3>&, double);

}  // namespace tribound::certify
