#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "tribound/base/parallel.h"
#include "tribound/certify/bound/algebraic.h"
#include "tribound/mesh/geometry.h"
#include "tribound/problem/weights.h"

namespace tribound::certify
{

namespace
{

/// A simplex that is a union of cells, with what the tree bound needs of it.
template <int dim>
struct TreeNode
{
  mesh::Cell<dim> vertices;
  double volume;
  Point<dim> integral;          ///< of rho
  int height;                   ///< bisections from here to the deepest cell
  std::array<int, 2> children;  ///< -1: a cell of the mesh
};

/// The union of two simplices with a common facet, if it is a simplex again: one shared vertex is exactly the
/// midpoint of the edge between the two others, as bisection puts it.
template <int dim>
std::optional<mesh::Cell<dim>> united(const mesh::Mesh<dim>& mesh, const mesh::Cell<dim>& first,
                                      const mesh::Cell<dim>& second)
{
  const auto is_in = [](const mesh::Cell<dim>& cell, Index v)
  { return std::ranges::find(cell, v) != cell.end(); };
  Index own = -1;
  Index other = -1;
  for (int i = 0; i <= dim; ++i)
  {
    if (!is_in(second, first[i])) own = own < 0 ? first[i] : -2;
    if (!is_in(first, second[i])) other = second[i];
    if (own == -2) return std::nullopt;
  }
  if (own < 0) return std::nullopt;
  const Point<dim> middle = 0.5 * (mesh.vertex(own) + mesh.vertex(other));
  mesh::Cell<dim> whole = first;
  for (Index& v : whole)
    if (mesh.vertex(v) == middle)
    {
      v = other;
      return whole;
    }
  return std::nullopt;
}

/// The own cells with the simplices from which bisection made them; siblings follow each other. Roots are the
/// nodes without a parent.
template <int dim>
struct Forest
{
  std::vector<TreeNode<dim>> nodes;
  std::vector<int> roots;

  Forest(const mesh::Mesh<dim>& mesh, const AffineFields<dim>& rho)
  {
    nodes.reserve(2 * rho.size());
    for (std::size_t c = 0; c < rho.size(); ++c)
    {
      const auto cell = static_cast<Index>(c);
      const double volume = mesh::cell_map(mesh, cell).measure();
      Point<dim> sum = Point<dim>::Zero();
      for (const Point<dim>& value : rho[c]) sum += value;
      nodes.push_back({mesh.cell(cell), volume, volume / (dim + 1) * sum, 0, {-1, -1}});
      roots.push_back(static_cast<int>(nodes.size()) - 1);
      while (roots.size() > 1 && unite_last(mesh))
      {
      }
    }
  }

  bool unite_last(const mesh::Mesh<dim>& mesh)
  {
    const int first = roots[roots.size() - 2];
    const int second = roots.back();
    const auto whole = united<dim>(mesh, nodes[first].vertices, nodes[second].vertices);
    if (!whole) return false;
    nodes.push_back({*whole,
                     nodes[first].volume + nodes[second].volume,
                     nodes[first].integral + nodes[second].integral,
                     1 + std::max(nodes[first].height, nodes[second].height),
                     {first, second}});
    roots.pop_back();
    roots.back() = static_cast<int>(nodes.size()) - 1;
    return true;
  }
};

/// The squares of the sums in algebraic_error(), level by level.
template <int dim>
class TreeSums
{
 public:
  explicit TreeSums(const mesh::Mesh<dim>& mesh, const Forest<dim>& forest) : mesh_(mesh), forest_(forest)
  {
    int height = 0;
    for (const int root : forest.roots) height = std::max(height, forest.nodes[root].height);
    const int n_levels = (height + dim - 1) / dim;
    squares_.resize(static_cast<std::size_t>(mesh.ranks().max(n_levels)), 0.0);
    for (const int root : forest.roots) descend(root, 0);
  }

  [[nodiscard]] std::vector<double>& squares() { return squares_; }

 private:
  /// The simplices of T_{level + 1} inside a simplex of T_level.
  void collect(int node, int bisections, std::vector<int>& parts) const
  {
    const TreeNode<dim>& of = forest_.nodes[node];
    if (bisections == 0 || of.height == 0) return parts.push_back(node);
    for (const int child : of.children) collect(child, bisections - 1, parts);
  }

  void descend(int node, std::size_t level)
  {
    const TreeNode<dim>& of = forest_.nodes[node];
    if (of.height == 0) return;
    std::vector<int> parts;
    parts.reserve(std::size_t{1} << dim);
    collect(node, dim, parts);
    double square = 0;
    for (const int part : parts)
    {
      const TreeNode<dim>& smaller = forest_.nodes[part];
      square += smaller.volume * (smaller.integral / smaller.volume - of.integral / of.volume).squaredNorm();
      descend(part, level + 1);
    }
    const double h = mesh::diameter(mesh::points_of(mesh_.vertices(), of.vertices));
    squares_[level] += std::pow(h / std::numbers::pi, 2) * square;
  }

  const mesh::Mesh<dim>& mesh_;
  const Forest<dim>& forest_;
  std::vector<double> squares_;
};

/// ||rho - mean||_T^2 and ||rho||_T^2.
template <int dim>
std::array<double, 2> squares_on_cell(const std::array<Point<dim>, dim + 1>& rho, double volume)
{
  Point<dim> mean = Point<dim>::Zero();
  for (const Point<dim>& value : rho) mean += value / (dim + 1);
  double deviation = 0;
  for (const Point<dim>& value : rho) deviation += (value - mean).squaredNorm();
  deviation *= volume / ((dim + 1) * (dim + 2));
  return {deviation, deviation + volume * mean.squaredNorm()};
}

}  // namespace

template <int dim>
double field_norm(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                  const AffineFields<dim>& rho)
{
  const auto square = [&](std::size_t c)
  {
    const auto cell = static_cast<Index>(c);
    // rho of an axisymmetric problem is constant on each cell.
    const double weight = mean_weight<dim>(problem, mesh::points_of(mesh.vertices(), mesh.cell(cell)));
    return weight * squares_on_cell<dim>(rho[c], mesh::cell_map(mesh, cell).measure())[1];
  };
  return std::sqrt(mesh.ranks().sum(parallel_sum(rho.size(), 0.0, square)));
}

template <int dim>
double algebraic_error(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                       const AffineFields<dim>& rho, double friedrichs)
{
  const double whole = friedrichs * field_norm<dim>(problem, mesh, rho);
  if (problem.is_axisymmetric()) return whole;
  const Forest<dim> forest(mesh, rho);
  std::vector<double> squares = TreeSums<dim>(mesh, forest).squares();
  double means = 0;
  double remainder = 0;
  for (const int root : forest.roots)
    means += forest.nodes[root].integral.squaredNorm() / forest.nodes[root].volume;
  for (std::size_t c = 0; c < rho.size(); ++c)
  {
    const auto cell = static_cast<Index>(c);
    remainder += std::pow(mesh::cell_diameter(mesh, cell) / std::numbers::pi, 2) *
                 squares_on_cell<dim>(rho[c], mesh::cell_map(mesh, cell).measure())[0];
  }
  squares.push_back(remainder);
  squares.push_back(means);
  mesh.ranks().sum(std::span(squares));
  double tree = friedrichs * std::sqrt(squares.back());
  squares.pop_back();
  for (const double square : squares) tree += std::sqrt(square);
  return std::min(tree, whole);
}

template double field_norm(const problem::Problem<2>&, const mesh::Mesh<2>&, const AffineFields<2>&);
template double field_norm(const problem::Problem<3>&, const mesh::Mesh<3>&, const AffineFields<3>&);
template double algebraic_error(const problem::Problem<2>&, const mesh::Mesh<2>&, const AffineFields<2>&,
                                double);
template double algebraic_error(const problem::Problem<3>&, const mesh::Mesh<3>&, const AffineFields<3>&,
                                double);

}  // namespace tribound::certify
