#pragma once

/// @file cell_name.h
/// Names of cells and vertices, the same on every rank and for any number of them.

#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>

#include "tribound/base/types.h"

namespace tribound::mesh
{

/// A well mixed 64-bit number (the last steps of MurmurHash3).
[[nodiscard]] constexpr std::uint64_t mix(std::uint64_t h)
{
  h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdULL;
  h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53ULL;
  return h ^ (h >> 33);
}

/// A cell, given by its ancestor in the first mesh and the path from there. The names of the cells of a mesh
/// ascend in the order in which bisect() numbers them.
struct CellName
{
  /// 42 halvings of h in 3D, 64 in 2D.
  static constexpr int max_depth = 128;

  std::int64_t root = 0;                ///< number in the first mesh
  std::array<std::uint64_t, 2> path{};  ///< the first bisection in the highest bit; 0: the first child
  std::int32_t depth = 0;               ///< bisections

  friend auto operator<=>(const CellName&, const CellName&) = default;

  /// Child 0 or 1 of a cell above max_depth.
  [[nodiscard]] constexpr CellName child(int kept) const
  {
    CellName name = *this;
    name.path[depth / 64] |= static_cast<std::uint64_t>(kept) << (63 - depth % 64);
    ++name.depth;
    return name;
  }
  /// The cell that it is a child of; not for cells of the first mesh.
  [[nodiscard]] constexpr CellName parent() const
  {
    CellName name = *this;
    --name.depth;
    name.path[name.depth / 64] &= ~(std::uint64_t{1} << (63 - name.depth % 64));
    return name;
  }
};

/// A vertex, given by its position, to the bit, and by an origin. The origin distinguishes vertices in one
/// place, as on the two sides of a joint or of a contact, now or after bisection, matching meshes or not.
template <int dim>
struct VertexName
{
  std::array<double, dim> position{};
  std::uint64_t origin = 0;  ///< number in the first mesh, or hash of the vertices between which it is

  friend auto operator<=>(const VertexName&, const VertexName&) = default;

  [[nodiscard]] Point<dim> point() const { return Eigen::Map<const Point<dim>>(position.data()); }
};

/// The name at a point; -0, which has other bits, becomes 0.
template <int dim>
[[nodiscard]] VertexName<dim> vertex_name(const Point<dim>& x, std::uint64_t origin)
{
  VertexName<dim> name{{}, origin};
  for (int i = 0; i < dim; ++i) name.position[i] = x[i] + 0.0;
  return name;
}

template <int dim>
[[nodiscard]] constexpr std::uint64_t hash(const VertexName<dim>& name)
{
  std::uint64_t h = mix(name.origin + 0x9e3779b97f4a7c15ULL);
  for (const double x : name.position) h = mix(h ^ std::bit_cast<std::uint64_t>(x));
  return h;
}

/// The vertex that bisection puts between two, in either order. Equal hashes by chance would only matter
/// among the few vertices in one place.
template <int dim>
[[nodiscard]] VertexName<dim> middle(const VertexName<dim>& a, const VertexName<dim>& b)
{
  return vertex_name<dim>(0.5 * (a.point() + b.point()), mix(hash(a) + hash(b)));
}

/// For unordered containers.
template <int dim>
struct VertexHash
{
  std::size_t operator()(const VertexName<dim>& name) const { return hash(name); }
};

}  // namespace tribound::mesh
