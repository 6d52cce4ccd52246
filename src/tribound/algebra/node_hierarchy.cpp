#include "tribound/algebra/node_hierarchy.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "tribound/mesh/mesh.h"

namespace tribound::algebra
{

namespace
{

/// The basis function of `node`, degree q, at the node x of degree p, both given by their barycentric
/// coordinates times the degree: prod_v binomial(q lambda_v, node_v). Integer arithmetic up to the final
/// quotient keeps zeros exact.
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
  NodeInterpolation result{fine.n_nodes(), coarse.n_nodes(), {}, fine.numbers(), coarse.numbers()};
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

/// Expresses the value of a function at a vertex by those at the vertices of a cell of a coarser mesh.
struct Row
{
  std::array<Index, 4> vertices{};
  std::array<double, 4> weights{};
  int size = 0;

  void add(Index vertex, double weight)
  {
    const auto place = std::find(vertices.begin(), vertices.begin() + size, vertex) - vertices.begin();
    if (place == size) vertices[size++] = vertex;
    weights[place] += weight;
  }
};

/// The inclusion of P^1 on the mesh with the first n_coarse vertices in P^1 on that with the first n_fine. A
/// halved edge lies in one coarse cell, so that v(middle) = (v(a) + v(b)) / 2.
NodeInterpolation inclusion(const mesh::Ancestry& ancestry, Index n_coarse, Index n_fine)
{
  std::vector<Row> rows(n_fine);
  NodeInterpolation result{n_fine, n_coarse, {}, {}, {}};
  for (Index v = 0; v < n_fine; ++v)
  {
    Row& row = rows[v];
    if (v < n_coarse)
      row.add(v, 1);
    else
      for (const Index end : ancestry.halved_edges[v - ancestry.n_vertices.front()])
        for (int k = 0; k < rows[end].size; ++k) row.add(rows[end].vertices[k], 0.5 * rows[end].weights[k]);
    for (int k = 0; k < row.size; ++k) result.weights.add(v, row.vertices[k], row.weights[k]);
  }
  return result;
}

/// Inclusions between P^1 on the mesh and on some of its ancestors. A step over several meshes leaves the
/// scales between them to the smoother of the finest: with refinement towards the corner of a square, as many
/// cells added each time, steps over 1, 2, 3, 4, 5 meshes take 12, 20, 33, 51, 76 iterations.
std::vector<NodeInterpolation> inclusions(const mesh::Ancestry& ancestry, Index n_vertices)
{
  constexpr std::ptrdiff_t most_meshes = 3;
  const auto is_coarser = [&](Index n) { return 1.5 * n <= n_vertices; };
  std::vector<NodeInterpolation> steps;
  auto before = ancestry.n_vertices.rbegin();
  while (true)
  {
    const auto end = before + std::min(ancestry.n_vertices.rend() - before, most_meshes);
    const auto coarse = std::find_if(before, end, is_coarser);
    if (coarse == end) return steps;
    steps.push_back(inclusion(ancestry, *coarse, n_vertices));
    n_vertices = *coarse;
    before = coarse + 1;
  }
}

}  // namespace

template <int dim>
NodeHierarchy node_hierarchy(std::span<const Point<dim>> nodes)
{
  NodeHierarchy result{.dim = dim, .steps = {}, .coarsest_coordinates = {}, .n_coarsest = 0};
  for (const Point<dim>& x : nodes)
    result.coarsest_coordinates.insert(result.coarsest_coordinates.end(), x.data(), x.data() + dim);
  result.n_coarsest = static_cast<std::int64_t>(result.coarsest_coordinates.size());
  return result;
}

template <int dim>
NodeHierarchy node_hierarchy(const fem::LagrangeSpace<dim>& space)
{
  if (space.degree() == 1)
  {
    const std::vector<Point<dim>> points = space.node_points();
    std::vector<Point<dim>> own(space.n_owned_nodes());
    for (Index k = 0; k < space.n_owned_nodes(); ++k) own[k] = points[space.owned_node(k)];
    NodeHierarchy result = node_hierarchy<dim>(own);
    result.steps = inclusions(space.mesh().ancestry(), space.mesh().n_vertices());
    if (!result.steps.empty()) result.coarsest_coordinates.resize(dim * result.steps.back().n_coarse);
    result.n_coarsest = space.numbers() ? space.n_global_dofs()
                                        : static_cast<std::int64_t>(result.coarsest_coordinates.size());
    return result;
  }
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
