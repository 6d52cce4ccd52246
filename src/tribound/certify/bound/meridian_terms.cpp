#include "tribound/certify/bound/meridian_terms.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tribound/certify/bound/constants.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/polynomials.h"
#include "tribound/problem/weights.h"

namespace tribound::certify
{

namespace
{

/// The degree of the squares, as multiples of 1 / r: of r sigma and tau in P^{p+1}, r sigma_0 in P^{p+2}, and
/// of r^2 f_h.
int degree_of_squares(const contact::NitscheForm<2>& form)
{
  const int p = form.space().degree();
  int degree = p + (form.problem().has_initial_stress() ? 2 : 1);
  for (const problem::Region<2>& region : form.problem().regions())
    for (const problem::Field& f : region.body_force)
      if (!f.is_zero()) degree = std::max(degree, 2 + std::min(f.degree(), p + 6));
  return 2 * degree;
}

fem::Tabulation<2> tabulate_stress(int degree, const std::array<int, 3>& local,
                                   std::span<const Point<2>> points)
{
  fem::Tabulation<2> table{static_cast<int>(points.size()), fem::polynomial_dimension(2, degree), {}, {}};
  table.values.resize(points.size() * table.n_nodes);
  table.gradients.resize(table.values.size());
  for (std::size_t q = 0; q < points.size(); ++q)
    fem::orthonormal_gradients<2>(degree, to_sorted_cell<2>(local, points[q]),
                                  std::span(table.values).subspan(q * table.n_nodes, table.n_nodes),
                                  std::span(table.gradients).subspan(q * table.n_nodes, table.n_nodes));
  return table;
}

}  // namespace

std::vector<Point<2>> body_force_at(const contact::NitscheForm<2>& form, Index cell,
                                    std::span<const Point<2>> points)
{
  std::vector<Point<2>> values(points.size(), Point<2>::Zero());
  if (!form.data().has_body_force(cell)) return values;
  const std::vector<Point<2>> coefficients = form.data().body_polynomial(cell);
  std::vector<double> theta(coefficients.size());
  int degree = 0;
  while (fem::polynomial_dimension(2, degree) < static_cast<int>(theta.size())) ++degree;
  for (std::size_t q = 0; q < points.size(); ++q)
  {
    fem::orthonormal_values<2>(degree, points[q], theta);
    for (std::size_t j = 0; j < theta.size(); ++j) values[q] += theta[j] * coefficients[j];
  }
  return values;
}

MeridianTerms::MeridianTerms(const contact::NitscheForm<2>& form)
    : form_(form), rules_(form.space().mesh(), degree_of_squares(form))
{
  for (int i = 0; i < rules_.size(); ++i)
  {
    const std::span<const Point<2>> points = rules_[i].points;
    Table& table = tables_.emplace_back(Table{form.space().basis().tabulate(points), {}});
    std::array<int, 3> local{0, 1, 2};
    do  // permutations in lexicographic order, as permutation_number() counts them
      table.stress.push_back(tabulate_stress(form.space().degree() + 1, local, points));
    while (std::ranges::next_permutation(local).found);
  }
}

auto MeridianTerms::rows_at(const Table& table, const SortedCell<2>& cell, std::span<const double> block,
                            int q) const -> Rows
{
  Rows rows;
  if (block.empty()) return rows;
  const fem::Tabulation<2>& basis = table.stress[permutation_number(cell.local)];
  const auto n = static_cast<std::size_t>(basis.n_nodes);
  const double scale = 1 / std::sqrt(cell.det);
  const Tensor<2> inverse_transpose = cell.inverse.transpose();
  for (std::size_t j = 0; j < n; ++j)
  {
    const double value = scale * basis.values_at(q)[j];
    const Point<2> gradient = scale * (inverse_transpose * basis.gradients_at(q)[j]);
    for (int r = 0; r < 2; ++r)
      for (int c = 0; c < 2; ++c)
      {
        const double x = block[(2 * r + c) * n + j];
        rows.tau(r, c) += x * value;
        rows.divergence[r] += x * gradient[c];
      }
  }
  return rows;
}

/// The first table is that of the cell's own coordinates.
auto MeridianTerms::initial_at(const Table& table, Index cell, int q) const -> InitialStress
{
  const contact::InitialStress<2>& given = form_.data().initial_stress();
  const std::span<const Tensor<2>> plane = given.coefficients(cell);
  const std::span<const double> hoop = given.hoop_coefficients(cell);
  const std::span<const double> theta = table.stress.front().values_at(q);
  InitialStress sum;
  for (std::size_t j = 0; j < plane.size(); ++j)
  {
    sum.plane += theta[j] * plane[j];
    sum.hoop += theta[j] * hoop[j];
  }
  return sum;
}

void MeridianTerms::add(Index cell, std::span<const double> u, const Stress<2>& stress, double rho_z,
                        BoundComponents& eta) const
{
  const fem::LagrangeSpace<2>& space = form_.space();
  const fem::Quadrature<2>& rule = rules_.of_cell(cell);
  const Table& table = tables_[rules_.number(cell)];
  const problem::Material& material = form_.problem().material(space.mesh().region(cell));
  const mesh::CellMap<2> map = mesh::cell_map(space.mesh(), cell);
  const SortedCell<2> sorted = make_sorted_cell(space.mesh(), cell);
  const std::span<const Index> nodes = space.cell_nodes(cell);
  const std::vector<Point<2>> force = body_force_at(form_, cell, rule.points);
  double in_plane = 0;
  double hoop = 0;
  double oscillation = 0;
  for (const auto& [q, x, dx] : fem::cell_points(map, rule))
  {
    const double r = x[0];
    const Tensor<2> gradient =
        fem::gradient_at<2>(nodes, u, table.displacement.gradients_at(q), map.inverse_transpose);
    const double hoop_strain = fem::value_at<2>(nodes, u, table.displacement.values_at(q))[0] / r;
    const Rows dis = rows_at(table, sorted, stress.dis_in(cell), q);
    const double divergence = dis.divergence[1] +
                              rows_at(table, sorted, stress.lin_in(cell), q).divergence[1] +
                              rows_at(table, sorted, stress.reg_in(cell), q).divergence[1];
    const InitialStress initial = initial_at(table, cell, q);
    const Tensor<2> sigma = contact::sigma<2>(material, gradient, hoop_strain) + initial.plane;
    const double sigma_tt = contact::hoop_stress(material, gradient, hoop_strain) + initial.hoop;
    in_plane += dx / r * (dis.tau - r * sigma).squaredNorm();
    hoop += dx * r * std::pow(dis.divergence[0] + r * force[q][0] - sigma_tt, 2);
    oscillation += dx / r * std::pow(r * (force[q][1] - rho_z) + divergence, 2);
  }
  const double most = 1 + rules_.relative_error(cell);
  eta.osc += poincare_constant(mesh::cell_diameter(space.mesh(), cell)) * std::sqrt(most * oscillation);
  eta.str = std::sqrt(most * (in_plane + hoop)) +
            std::sqrt(problem::largest_weight<2>(
                form_.problem(), mesh::points_of(space.mesh().vertices(), space.mesh().cell(cell)))) *
                form_.data().initial_stress().remainder(cell).oscillation;
  eta.lin1 = std::sqrt(square(cell, stress.lin_in(cell)));
  eta.reg1 = std::sqrt(square(cell, stress.reg_in(cell)));
}

double MeridianTerms::square(Index cell, std::span<const double> block) const
{
  if (block.empty()) return 0;
  const mesh::Mesh<2>& mesh = form_.space().mesh();
  const SortedCell<2> sorted = make_sorted_cell(mesh, cell);
  double result = 0;
  for (const auto& [q, x, dx] : fem::cell_points(mesh::cell_map(mesh, cell), rules_.of_cell(cell)))
  {
    const Rows rows = rows_at(tables_[rules_.number(cell)], sorted, block, q);
    result += dx / x[0] * rows.tau.squaredNorm() + dx * x[0] * std::pow(rows.divergence[0], 2);
  }
  return (1 + rules_.relative_error(cell)) * result;
}

}  // namespace tribound::certify
