#include "tribound/certify/equilibrate/vertex_partition.h"
#include "tribound/mesh/geometry.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace tribound::certify
{

namespace
{

/// The vertices along a space-filling curve (Morton order): the cells that a part of it needs at a time are
/// few.
template <int dim>
std::vector<Index> by_locality(const mesh::Mesh<dim>& mesh, std::span<const Index> vertices, int n_threads)
{
  const mesh::BoundingBox<dim> box = mesh::bounding_box(mesh.vertices());
  constexpr int bits = 20;
  const double scale = ((std::uint64_t{1} << bits) - 1) / box.longest_edge();
  std::vector<std::pair<std::uint64_t, Index>> keys(vertices.size());
#pragma omp parallel for num_threads(n_threads)
  for (std::size_t i = 0; i < keys.size(); ++i)
  {
    keys[i] = {0, vertices[i]};
    for (int c = 0; c < dim; ++c)
    {
      const auto coordinate =
          static_cast<std::uint64_t>((mesh.vertex(vertices[i])[c] - box.lower[c]) * scale);
      for (int b = 0; b < bits; ++b) keys[i].first |= (coordinate >> b & 1) << (b * dim + c);
    }
  }
  std::ranges::sort(keys);
  std::vector<Index> order(keys.size());
  std::ranges::transform(keys, order.begin(), [](const auto& key) { return key.second; });
  return order;
}

}  // namespace

template <int dim>
VertexPartition partition_vertices(const mesh::Mesh<dim>& mesh, std::span<const Index> vertices, int n)
{
  VertexPartition result;
  result.order = by_locality(mesh, vertices, n);
  result.part.assign(mesh.n_vertices(), -1);
  for (int s = 0; s <= n; ++s) result.begin.push_back(result.order.size() * s / n);
  for (int s = 0; s < n; ++s)
    for (std::size_t i = result.begin[s]; i < result.begin[s + 1]; ++i) result.part[result.order[i]] = s;
  result.shared_index.assign(mesh.n_cells(), -1);
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    int only = -1;
    bool shared = false;
    for (const Index v : mesh.cell(c))
    {
      const int s = result.part[v];
      shared = shared || (s >= 0 && only >= 0 && s != only);
      only = std::max(only, s);
    }
    if (!shared) continue;
    result.shared_index[c] = static_cast<int>(result.shared_cells.size());
    result.shared_cells.push_back(c);
  }
  return result;
}

template VertexPartition partition_vertices(const mesh::Mesh<2>&, std::span<const Index>, int);
template VertexPartition partition_vertices(const mesh::Mesh<3>&, std::span<const Index>, int);

}  // namespace tribound::certify
