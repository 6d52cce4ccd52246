#include "tribound/fem/lagrange.h"

#include <algorithm>

#include "tribound/base/dense_factors.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/polynomials.h"

namespace tribound::fem
{

namespace
{

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// All barycentric multi-indices of sum p: vertices first, then inside edges, faces, the cell.
template <int k>
std::vector<std::array<int, k + 1>> lattice(int p)
{
  std::vector<std::array<int, k + 1>> nodes;
  std::array<int, k + 1> node{};
  const auto fill = [&](const auto& self, int i, int rest) -> void
  {
    if (i == k)
    {
      node[k] = rest;
      nodes.push_back(node);
      return;
    }
    for (node[i] = rest; node[i] >= 0; --node[i]) self(self, i + 1, rest - node[i]);
    node[i] = 0;
  };
  fill(fill, 0, p);
  std::ranges::stable_sort(nodes, {}, [](const auto& n) { return k + 1 - std::ranges::count(n, 0); });
  return nodes;
}

}  // namespace

template <int k>
LagrangeBasis<k>::LagrangeBasis(int degree) : degree_(degree), nodes_(lattice<k>(degree))
{
  const int n = n_nodes();
  Matrix vandermonde(n, n);  // value of orthonormal polynomial j at node i
  for (int i = 0; i < n; ++i)
    orthonormal_values<k>(degree, node_point(i), std::span(vandermonde.row(i).data(), n));
  const Matrix coefficients = inverse_of(vandermonde).transpose();
  coefficients_.assign(coefficients.data(), coefficients.data() + coefficients.size());
}

template <int k>
Point<k> LagrangeBasis<k>::node_point(int i) const
{
  Point<k> point;
  for (int j = 0; j < k; ++j) point[j] = static_cast<double>(nodes_[i][j + 1]) / degree_;
  return point;
}

template <int k>
std::vector<Point<k>> LagrangeBasis<k>::node_points() const
{
  std::vector<Point<k>> points;
  points.reserve(nodes_.size());
  for (int i = 0; i < n_nodes(); ++i) points.push_back(node_point(i));
  return points;
}

template <int k>
Tabulation<k> LagrangeBasis<k>::tabulate(std::span<const Point<k>> points) const
{
  const int n = n_nodes();
  Tabulation<k> table;
  table.n_points = static_cast<int>(points.size());
  table.n_nodes = n;
  table.values.assign(points.size() * n, 0.0);
  table.gradients.assign(points.size() * n, Point<k>::Zero());

  std::vector<double> values(n);
  std::vector<Point<k>> gradients(n);
  for (std::size_t q = 0; q < points.size(); ++q)
  {
    orthonormal_gradients<k>(degree_, points[q], values, gradients);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
      {
        table.values[q * n + i] += coefficients_[i * n + j] * values[j];
        table.gradients[q * n + i] += coefficients_[i * n + j] * gradients[j];
      }
  }
  return table;
}

template <int dim>
FacetTabulation<dim> tabulate_on_facets(const LagrangeBasis<dim>& basis,
                                        std::span<const Point<dim - 1>> points)
{
  FacetTabulation<dim> table;
  table.points.assign(points.begin(), points.end());
  for (int facet = 0; facet <= dim; ++facet)
    table.on_facet[facet] = basis.tabulate(points_on_facet<dim>(facet, points));
  return table;
}

template <int dim>
std::vector<Tensor<dim>> gradient_products(const LagrangeBasis<dim>& basis)
{
  const Quadrature<dim> rule = quadrature<dim>(2 * basis.degree() - 2);
  const Tabulation<dim> table = basis.tabulate(rule.points);
  const int n = basis.n_nodes();
  std::vector<Tensor<dim>> products(static_cast<std::size_t>(n) * n, Tensor<dim>::Zero());
  for (int q = 0; q < rule.size(); ++q)
  {
    const auto gradients = table.gradients_at(q);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        products[i * n + j] += rule.weights[q] * gradients[i] * gradients[j].transpose();
  }
  return products;
}

template std::vector<Tensor<2>> gradient_products(const LagrangeBasis<2>&);
template std::vector<Tensor<3>> gradient_products(const LagrangeBasis<3>&);
template class LagrangeBasis<1>;
template class LagrangeBasis<2>;
template class LagrangeBasis<3>;
template FacetTabulation<2> tabulate_on_facets(const LagrangeBasis<2>&, std::span<const Point<1>>);
template FacetTabulation<3> tabulate_on_facets(const LagrangeBasis<3>&, std::span<const Point<2>>);

}  // namespace tribound::fem
