#pragma once

/// @file manufactured.h
/// Smooth exact solutions, given as formulas, and the error against them. Integration shares only the
/// quadrature rules with the library's own norms.

#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/fem/evaluation.h"

namespace tribound::test
{

/// A solution on the box (0, upper) with contact at the bottom y = 0 and prescribed displacement elsewhere.
template <int dim>
struct Manufactured
{
  std::string name;
  problem::Material material;
  std::array<double, dim> upper;
  std::array<std::string, dim> u;
  std::array<std::string, dim * dim> gradient;  ///< row by row
  std::array<std::string, dim> body;            ///< f = -div sigma(u)
  problem::ContactLaw law;
};

/// u and grad u as functions.
template <int dim>
class ExactField
{
 public:
  explicit ExactField(const Manufactured<dim>& solution) : ExactField(solution.u, solution.gradient) {}
  /// The gradient row by row.
  ExactField(std::span<const std::string> u, std::span<const std::string> gradient)
  {
    for (const std::string& text : u) u_.push_back(formula(text));
    for (const std::string& text : gradient) gradient_.push_back(formula(text));
  }

  [[nodiscard]] Point<dim> value(const Point<dim>& x) const
  {
    Point<dim> result;
    for (int a = 0; a < dim; ++a) result[a] = u_[a](x);
    return result;
  }

  [[nodiscard]] Tensor<dim> gradient(const Point<dim>& x) const
  {
    Tensor<dim> result;
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b) result(a, b) = gradient_[a * dim + b](x);
    return result;
  }

 private:
  std::vector<problem::Field> u_;
  std::vector<problem::Field> gradient_;
};

/// The problem with degree p on a uniform mesh with n cells along y.
template <int dim>
DiscreteProblem<dim> manufactured_problem(const Manufactured<dim>& solution, int p, int n)
{
  Point<dim> upper;
  std::array<int, dim> cells;
  ProblemData<dim> data{.boundaries = {obstacle<dim>("bottom", solution.law)}, .material = solution.material};
  std::array<std::optional<problem::Field>, dim> u;
  for (int a = 0; a < dim; ++a)
  {
    upper[a] = solution.upper[a];
    cells[a] = static_cast<int>(std::lround(n * solution.upper[a] / solution.upper[1]));
    data.body_force[a] = formula(solution.body[a]);
    u[a] = formula(solution.u[a]);
  }
  for (const std::string side : side_names<dim>)
    if (side != "bottom") data.boundaries.push_back(problem::with_displacement<dim>(side, u));
  return {box<dim>(Point<dim>::Zero(), upper, cells), data, {.degree = p, .newton = {.tolerance = 1e-11}}};
}

/// ||u - u_h||_en = (sigma(e), eps(e))^(1/2), and the same norm of u.
struct EnergyError
{
  double error;
  double exact;
};

/// With one exact solution for each region.
template <int dim>
EnergyError energy_error(const DiscreteProblem<dim>& c, std::span<const double> u,
                         std::span<const ExactField<dim>> exact)
{
  const fem::Quadrature<dim> rule = fem::quadrature<dim>(2 * c.space.degree() + 6);
  const fem::Tabulation<dim> table = c.space.basis().tabulate(rule.points);
  EnergyError sum{0, 0};
  for (Index cell = 0; cell < c.mesh.n_cells(); ++cell)
  {
    const mesh::CellMap<dim> map = mesh::cell_map(c.mesh, cell);
    const int region = c.mesh.region(cell);
    const auto density = [&](const Tensor<dim>& g)
    { return contact::sigma<dim>(c.problem.material(region), g).cwiseProduct(g).sum(); };
    for (int q = 0; q < rule.size(); ++q)
    {
      const Tensor<dim> discrete =
          fem::gradient_at<dim>(c.space.cell_nodes(cell), u, table.gradients_at(q), map.inverse_transpose);
      const Tensor<dim> g = exact[region].gradient(map(rule.points[q]));
      sum.error += rule.weights[q] * map.det * density(g - discrete);
      sum.exact += rule.weights[q] * map.det * density(g);
    }
  }
  return {std::sqrt(sum.error), std::sqrt(sum.exact)};
}

}  // namespace tribound::test
