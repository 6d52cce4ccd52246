#include "tribound/fem/meridian_rules.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tribound/mesh/geometry.h"

namespace tribound::fem
{

namespace
{

/// Degrees to which 1 / r is approximated.
constexpr std::array extra_degrees = {6, 10, 14, 18, 24, 32, 44, 60};
constexpr double negligible = 1e-13;

/// The first of them that suffices, else the last.
std::size_t level_for(double least, double largest)
{
  std::size_t level = 0;
  while (level + 1 < extra_degrees.size() &&
         inverse_radius_error(least, largest, extra_degrees[level]) > negligible)
    ++level;
  return level;
}

/// Gauss rules in s and t, the barycentric coordinates being 1 - s at the vertex and s (1 - t), s t at the
/// others.
Quadrature<2> collapsed_at(int vertex, int degree, int degree_along)
{
  const Quadrature<1> across = quadrature<1>(degree);
  const Quadrature<1> along = quadrature<1>(degree_along);
  Quadrature<2> rule;
  for (int i = 0; i < across.size(); ++i)
    for (int j = 0; j < along.size(); ++j)
    {
      const double s = across.points[i][0];
      const double t = along.points[j][0];
      std::array<double, 3> lambda{};
      lambda[vertex] = 1 - s;
      lambda[(vertex + 1) % 3] = s * (1 - t);
      lambda[(vertex + 2) % 3] = s * t;
      rule.points.emplace_back(lambda[1], lambda[2]);
      rule.weights.push_back(s * across.weights[i] * along.weights[j]);
    }
  return rule;
}

std::vector<std::array<double, 3>> radii_of_cells(const mesh::Mesh<2>& mesh)
{
  std::vector<std::array<double, 3>> radii(mesh.n_cells());
  for (Index c = 0; c < mesh.n_cells(); ++c)
    for (int i = 0; i < 3; ++i) radii[c][i] = mesh.vertex(mesh.cell(c)[i])[0];
  return radii;
}

}  // namespace

double inverse_radius_error(double least, double largest, int extra)
{
  if (largest <= least) return 0;
  const double half = (largest - least) / 2;
  const double c = (largest + least) / (largest - least);
  const double root = std::sqrt((c - 1) * (c + 1));
  return 2 * largest * std::pow(c + root, -extra) / (half * root * root);
}

MeridianRules::MeridianRules(const mesh::Mesh<2>& mesh, int degree)
    : MeridianRules(radii_of_cells(mesh), degree)
{
}

MeridianRules::MeridianRules(std::span<const std::array<double, 3>> radii, int degree)
    : numbers_(radii.size()), errors_(radii.size(), 0.0)
{
  constexpr std::size_t n_levels = extra_degrees.size();
  std::array<int, 4 * n_levels> known;  // plain rules, then those collapsed at each vertex
  known.fill(-1);
  for (std::size_t c = 0; c < radii.size(); ++c)
  {
    const std::array<double, 3>& r = radii[c];
    const auto n_on_axis = std::ranges::count(r, 0.0);
    const int lowest = static_cast<int>(std::ranges::min_element(r) - r.begin());
    std::size_t level = 0;  // enough where an edge is on the axis: Q / r is a polynomial
    if (n_on_axis < 2)
    {
      double least = r[lowest];
      if (n_on_axis == 1) least = std::min(r[(lowest + 1) % 3], r[(lowest + 2) % 3]);
      level = level_for(least, std::ranges::max(r));
      errors_[c] = inverse_radius_error(least, std::ranges::max(r), extra_degrees[level]);
    }
    int& number = known[(n_on_axis == 1 ? lowest + 1 : 0) * n_levels + level];
    if (number < 0)
    {
      number = size();
      const int exact = degree + extra_degrees[level];
      rules_.push_back(n_on_axis == 1 ? collapsed_at(lowest, degree + 2, exact) : quadrature<2>(exact));
    }
    numbers_[c] = static_cast<std::uint8_t>(number);
  }
}

}  // namespace tribound::fem
