#include "tribound/certify/equilibrate/reference.h"

#include <Eigen/LU>

#include "tribound/certify/equilibrate/reference.templates.h"

namespace tribound::certify::detail
{

template <int dim>
std::vector<double> nodal_coefficients(const fem::LagrangeBasis<dim>& basis,
                                       const std::array<int, dim + 1>& local)
{
  const int n = basis.n_nodes();
  Eigen::MatrixXd vandermonde(n, n);  // phi_j at node i of the unsorted cell, seen in sorted coordinates
  std::vector<double> values(n);
  for (int i = 0; i < n; ++i)
  {
    Point<dim> x;
    for (int j = 0; j < dim; ++j) x[j] = static_cast<double>(basis.node(i)[local[j + 1]]) / basis.degree();
    fem::orthonormal_values<dim>(basis.degree(), x, values);
    for (int j = 0; j < n; ++j) vandermonde(i, j) = values[j];
  }
  const Eigen::MatrixXd coefficients = vandermonde.inverse();  // of nodal function j in phi: column j
  return {coefficients.data(), coefficients.data() + coefficients.size()};
}

template std::vector<double> nodal_coefficients<2>(const fem::LagrangeBasis<2>&, const std::array<int, 3>&);
template std::vector<double> nodal_coefficients<3>(const fem::LagrangeBasis<3>&, const std::array<int, 4>&);

}  // namespace tribound::certify::detail
