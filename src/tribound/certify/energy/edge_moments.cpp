#include "tribound/certify/energy/edge_moments.h"

#include <algorithm>
#include <cstddef>

#include "tribound/base/dense_factors.h"
#include "tribound/certify/equilibrate/rigid.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

namespace
{

template <int dim>
using Spin = Eigen::Matrix<double, n_spins<dim>, 1>;
template <int dim>
using SpinGram = Eigen::Matrix<double, n_spins<dim>, n_spins<dim>>;

/// The skew tensor with the given entries above the diagonal.
template <int dim>
Tensor<dim> skew_tensor(const Spin<dim>& entries)
{
  Tensor<dim> w = Tensor<dim>::Zero();
  for (int r = 0, i = 0; r < dim; ++r)
    for (int c = r + 1; c < dim; ++c, ++i)
    {
      w(r, c) = entries[i];
      w(c, r) = -entries[i];
    }
  return w;
}

/// A : W for the unit spins W.
template <int dim>
Spin<dim> tested(const Tensor<dim>& a)
{
  Spin<dim> result;
  for (int r = 0, i = 0; r < dim; ++r)
    for (int c = r + 1; c < dim; ++c, ++i) result[i] = a(r, c) - a(c, r);
  return result;
}

/// w_T as a matrix: w_T(W, W') = W M : W' with M = ((x - x_T)_i, (x - x_T)_j)_T.
template <int dim>
SpinGram<dim> spin_gram(const mesh::Mesh<dim>& mesh, Index cell)
{
  const auto points = mesh::points_of(mesh.vertices(), mesh.cell(cell));
  Point<dim> centre = Point<dim>::Zero();
  for (const Point<dim>& x : points) centre += x / (dim + 1);
  Tensor<dim> second = Tensor<dim>::Zero();
  for (const Point<dim>& x : points) second += (x - centre) * (x - centre).transpose();
  second *= mesh::cell_map(mesh, cell).measure() / ((dim + 1) * (dim + 2));
  SpinGram<dim> gram;
  for (int i = 0; i < n_spins<dim>; ++i)
    gram.col(i) = tested<dim>(skew_tensor<dim>(Spin<dim>::Unit(i)) * second);
  return gram;
}

}  // namespace

template <int dim>
std::vector<Tensor<dim>> edge_moments(const mesh::Mesh<dim>& mesh, std::span<const Point<dim>> forces)
{
  const mesh::Topology<dim>& topology = mesh.topology();
  std::vector<SpinGram<dim>> grams(topology.edges.size(), SpinGram<dim>::Zero());
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    const SpinGram<dim> of_cell = spin_gram(mesh, c);
    for (const Index e : topology.cell_edges[c]) grams[e] += of_cell;
  }
  std::vector<Tensor<dim>> from_first(
      topology.edges.size());  // the share of an edge in K_{T,a}, a its first end
  for (std::size_t e = 0; e < from_first.size(); ++e)
  {
    const auto [a, b] = topology.edges[e];
    const Tensor<dim> moment = forces[e] * (mesh.vertex(b) - mesh.vertex(a)).transpose();
    from_first[e] = skew_tensor<dim>(CholeskyFactors(grams[e]).solve(tested<dim>(moment)));
  }
  std::vector<Tensor<dim>> result(static_cast<std::size_t>(mesh.n_cells()) * (dim + 1), Tensor<dim>::Zero());
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    mesh::Cell<dim> sorted = mesh.cell(c);
    std::ranges::sort(sorted);
    const auto at = [&](Index v) -> Tensor<dim>& {
      return result[static_cast<std::size_t>(c) * (dim + 1) +
                    (std::ranges::find(sorted, v) - sorted.begin())];
    };
    for (const Index e : topology.cell_edges[c])
    {
      at(topology.edges[e][0]) += from_first[e];
      at(topology.edges[e][1]) -= from_first[e];
    }
  }
  return result;
}

template std::vector<Tensor<2>> edge_moments(const mesh::Mesh<2>&, std::span<const Point<2>>);
template std::vector<Tensor<3>> edge_moments(const mesh::Mesh<3>&, std::span<const Point<3>>);

}  // namespace tribound::certify
