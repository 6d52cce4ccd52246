#include "tribound/certify/equilibrate/repeated_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "tribound/mesh/partition.h"

namespace tribound::certify
{

namespace
{

constexpr double exact = 1e-12;
constexpr int table_size = 1 << 12;  // of the hash table: a shape whose entry is taken is given up

/// Equal for most pairs of matrices of a kind that differ by much less than the quantum.
template <int dim>
std::size_t hash(const Tensor<dim>& jacobian, double quantum, int kind)
{
  std::uint64_t key = static_cast<std::uint64_t>(kind) * 0x9e3779b97f4a7c15U;
  for (int r = 0; r < dim; ++r)
    for (int c = 0; c < dim; ++c)
      key = (key ^ static_cast<std::uint64_t>(std::llround(jacobian(r, c) / quantum))) * 0x9e3779b97f4a7c15U;
  return (key >> 40) % table_size;
}

/// Of all ranks, which do not have to talk about it.
template <int dim>
double largest_coordinate(const mesh::Mesh<dim>& mesh)
{
  if (mesh.partition())
  {
    const auto& [lower, size] = mesh.partition()->cube;
    return std::max(lower.cwiseAbs().maxCoeff(), (lower.array() + size).abs().maxCoeff());
  }
  double largest = 0;
  for (const Point<dim>& x : mesh.vertices()) largest = std::max(largest, x.cwiseAbs().maxCoeff());
  return largest;
}

}  // namespace

template <int dim>
ShapeClasses classify_shapes(const mesh::Mesh<dim>& mesh, bool by_region)
{
  ShapeClasses result;
  result.number.assign(mesh.n_cells(), -1);
  const double largest = largest_coordinate(mesh);
  // of differences of coordinates
  const double rounding = 8 * std::numeric_limits<double>::epsilon() * largest;
  std::vector<int> table(table_size, -1);
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    const Tensor<dim> jacobian = jacobian_of(mesh, sorted_vertices<dim>(mesh.cell(c)));
    const int kind = by_region ? mesh.region(c) : 0;
    int& shape = table[hash<dim>(jacobian, 1e3 * rounding, kind)];
    if (shape < 0)
    {
      shape = static_cast<int>(result.first.size());
      result.first.push_back(c);
      result.count.push_back(0);
    }
    if (by_region && mesh.region(result.first[shape]) != kind) continue;
    const Tensor<dim> known = jacobian_of(mesh, sorted_vertices<dim>(mesh.cell(result.first[shape])));
    const double tolerance = std::min(rounding, exact * known.cwiseAbs().maxCoeff());
    if (!((jacobian - known).cwiseAbs().maxCoeff() <= tolerance)) continue;
    result.number[c] = shape;
    ++result.count[shape];
  }
  return result;
}

template ShapeClasses classify_shapes<2>(const mesh::Mesh<2>&, bool);
template ShapeClasses classify_shapes<3>(const mesh::Mesh<3>&, bool);

}  // namespace tribound::certify
