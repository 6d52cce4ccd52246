#include "tribound/mesh/curve.h"

#include <algorithm>
#include <array>

namespace tribound::mesh
{

namespace
{

template <int dim>
constexpr int n_bits = 63 / dim;

template <int dim>
using GridPoint = std::array<std::uint64_t, dim>;

template <int dim>
GridPoint<dim> on_grid(const Cube<dim>& cube, const Point<dim>& x)
{
  constexpr auto n_steps = static_cast<double>((std::uint64_t{1} << n_bits<dim>)-1);
  GridPoint<dim> result;
  for (int i = 0; i < dim; ++i)
    result[i] =
        static_cast<std::uint64_t>(std::clamp((x[i] - cube.lower[i]) / cube.size, 0.0, 1.0) * n_steps);
  return result;
}

/// The bits of all coordinates, the highest first.
template <int dim>
std::uint64_t interleaved(const GridPoint<dim>& x)
{
  std::uint64_t key = 0;
  for (int bit = n_bits<dim> - 1; bit >= 0; --bit)
    for (int i = 0; i < dim; ++i) key = key << 1 | (x[i] >> bit & 1);
  return key;
}

}  // namespace

template <int dim>
Cube<dim> cube_around(std::span<const Point<dim>> points)
{
  if (points.empty()) return {};
  Point<dim> lower = points.front();
  Point<dim> upper = points.front();
  for (const Point<dim>& x : points)
  {
    lower = lower.cwiseMin(x);
    upper = upper.cwiseMax(x);
  }
  const double size = (upper - lower).maxCoeff();
  return {lower, size > 0 ? size : 1};
}

template <int dim>
std::uint64_t hilbert_key(const Cube<dim>& cube, const Point<dim>& point)
{
  GridPoint<dim> x = on_grid(cube, point);
  constexpr std::uint64_t highest = std::uint64_t{1} << (n_bits<dim> - 1);
  for (std::uint64_t bit = highest; bit > 1; bit >>= 1)  // undo the rotations of the subcubes
    for (int i = 0; i < dim; ++i)
    {
      const std::uint64_t lower_bits = bit - 1;
      if ((x[i] & bit) != 0)
        x[0] ^= lower_bits;
      else
      {
        const std::uint64_t different = (x[0] ^ x[i]) & lower_bits;
        x[0] ^= different;
        x[i] ^= different;
      }
    }
  for (int i = 1; i < dim; ++i) x[i] ^= x[i - 1];  // Gray code
  std::uint64_t flips = 0;
  for (std::uint64_t bit = highest; bit > 1; bit >>= 1)
    if ((x[dim - 1] & bit) != 0) flips ^= bit - 1;
  for (std::uint64_t& coordinate : x) coordinate ^= flips;
  return interleaved<dim>(x);
}

template <int dim>
std::uint64_t morton_key(const Cube<dim>& cube, const Point<dim>& x)
{
  return interleaved<dim>(on_grid(cube, x));
}

template Cube<2> cube_around(std::span<const Point<2>>);
template Cube<3> cube_around(std::span<const Point<3>>);
template std::uint64_t hilbert_key(const Cube<2>&, const Point<2>&);
template std::uint64_t hilbert_key(const Cube<3>&, const Point<3>&);
template std::uint64_t morton_key(const Cube<2>&, const Point<2>&);
template std::uint64_t morton_key(const Cube<3>&, const Point<3>&);

}  // namespace tribound::mesh
