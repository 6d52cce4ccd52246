#include "tribound/algebra/node_hierarchy.h"

#include <array>
#include <cstddef>
#include <utility>

namespace tribound::algebra
{

namespace
{

/// The basis function of `node`, degree q, at the node x of degree p, both given by their barycentric
/// coordinates times the degree: prod_v binomial(q lambda_v, node_v). In integers but for the quotient, so
/// that zeros are exact.
template <std::size_t n>
double weight(const std::array<int, n>& node, int q, const std::array<int, n>& x, int p)
{
  int numerator = 1;
  int denominator = 1;
  for (std::size_t v = 0; v < n; ++v)
    for (int k = 0; k < node[v]; ++k)
    {
      numerator *= q * x[v] - k * p;
      denominator *= p * (k + 1);
    }
  return static_cast<double>(numerator) / denominator;
}

template <int dim>
NodeInterpolation inclusion(const fem::LagrangeSpace<dim>& coarse, const fem::LagrangeSpace<dim>& fine)
{
  NodeInterpolation result{fine.n_nodes(), coarse.n_nodes(), {}};
  std::vector<char> done(fine.n_nodes(), 0);  // the cells that share a node agree on its weights
  for (Index c = 0; c < fine.mesh().n_cells(); ++c)
    for (int i = 0; i < fine.basis().n_nodes(); ++i)
    {
      const Index row = fine.cell_nodes(c)[i];
      if (std::exchange(done[row], 1) != 0) continue;
      for (int j = 0; j < coarse.basis().n_nodes(); ++j)
      {
        const double w = weight(coarse.basis().node(j), coarse.degree(), fine.basis().node(i), fine.degree());
        if (w != 0) result.weights.add(row, coarse.cell_nodes(c)[j], w);
      }
    }
  return result;
}

}  // namespace

template <int dim>
NodeHierarchy node_hierarchy(std::span<const Point<dim>> nodes)
{
  NodeHierarchy result{.dim = dim, .steps = {}, .coarsest_coordinates = {}};
  for (const Point<dim>& x : nodes)
    result.coarsest_coordinates.insert(result.coarsest_coordinates.end(), x.data(), x.data() + dim);
  return result;
}

template <int dim>
NodeHierarchy node_hierarchy(const fem::LagrangeSpace<dim>& space)
{
  if (space.degree() == 1) return node_hierarchy<dim>(space.node_points());
  const fem::LagrangeSpace<dim> coarse(space.mesh(), (space.degree() + 1) / 2);
  NodeHierarchy result = node_hierarchy(coarse);
  result.steps.insert(result.steps.begin(), inclusion(coarse, space));
  return result;
}

template NodeHierarchy node_hierarchy(std::span<const Point<2>>);
template NodeHierarchy node_hierarchy(std::span<const Point<3>>);
template NodeHierarchy node_hierarchy(const fem::LagrangeSpace<2>&);
template NodeHierarchy node_hierarchy(const fem::LagrangeSpace<3>&);

}  // namespace tribound::algebra
