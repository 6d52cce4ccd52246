#include "tribound/certify/energy/meridian_oscillation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tribound/base/dense_factors.h"
#include "tribound/base/parallel.h"
#include "tribound/certify/bound/meridian_terms.h"
#include "tribound/certify/bound/poincare_korn.h"
#include "tribound/certify/energy/traction_fit.h"
#include "tribound/certify/equilibrate/meridian_fields.h"
#include "tribound/contact/nitsche/given_data.h"
#include "tribound/contact/nitsche/residual.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/meridian_rules.h"
#include "tribound/fem/polynomials.h"
#include "tribound/problem/weights.h"

namespace tribound::certify
{

double axial_constant(std::array<Point<2>, 3> x)
{
  std::ranges::sort(x, {}, [](const Point<2>& vertex) { return vertex[0]; });
  const double b1 = x[1][0] - x[0][0];
  const double b2 = x[2][0] - x[1][0];
  const auto slope = [&](int i, int j) { return (x[j][1] - x[i][1]) / (x[j][0] - x[i][0]); };
  const double on_long_edge = x[0][1] + slope(0, 2) * b1;
  const double section = std::abs(x[1][1] - on_long_edge);  // at the radius of x[1]
  const double steepest_1 = b1 > 0 ? std::max(std::abs(slope(0, 2)), std::abs(slope(0, 1))) : 0;
  const double steepest_2 = b2 > 0 ? std::max(std::abs(slope(0, 2)), std::abs(slope(1, 2))) : 0;
  const double r1 = x[1][0];
  const double r2 = x[2][0];
  const double far = (1 + r1 / r2) / 4;
  const double i = std::max(b1 * r1, b2 * b2) + far * b2 * b2;
  const double j = std::max(steepest_1 * steepest_1 * b1 * r1, std::pow(steepest_2 * b2, 2)) +
                   far * std::pow(steepest_2 * b2, 2);
  const double hoop = 12 * std::pow(std::max(b1 * r1, b2 * r2) / section, 2);
  return std::sqrt(2.4 * i + std::pow(section / 2 + std::sqrt(1.2 * j), 2) + hoop);
}

namespace
{

/// The degree of rho, of which squares over r are integrated.
int degree_of_rho(const contact::NitscheForm<2>& form)
{
  const int p = form.space().degree();
  int degree = p;
  for (const problem::Region<2>& region : form.problem().regions())
    for (const problem::Field& f : region.body_force)
      if (!f.is_zero()) degree = std::max(degree, 1 + std::min(f.degree(), p + 6));
  return degree;
}

std::array<Point<2>, 3> vertices_of(const contact::NitscheForm<2>& form, Index cell)
{
  const mesh::Mesh<2>& mesh = form.space().mesh();
  return mesh::points_of(mesh.vertices(), mesh.cell(cell));
}

double largest_radius(const contact::NitscheForm<2>& form, Index cell, int local)
{
  const mesh::Mesh<2>& mesh = form.space().mesh();
  return problem::largest_weight<2>(
      form.problem(), mesh::points_of(mesh.vertices(), mesh::facet_vertices(mesh.cell(cell), local)));
}

double smallest_radius(const std::array<Point<2>, 3>& vertices)
{
  return std::min({vertices[0][0], vertices[1][0], vertices[2][0]});
}

/// The oscillation of body forces on cells, without the factor of the stiffness.
class BodyOscillation
{
 public:
  explicit BodyOscillation(const contact::NitscheForm<2>& form)
      : form_(form), fields_(form), rules_(form.space().mesh(), 2 * degree_of_rho(form))
  {
  }

  [[nodiscard]] double operator()(Index cell) const
  {
    const int degree = contact::body_datum(form_.problem(), form_.space().mesh(), cell).degree();
    const int p = form_.space().degree();
    if (degree <= p - 1) return 0;
    const std::array<Point<2>, 3> vertices = vertices_of(form_, cell);
    const double largest = problem::largest_weight<2>(form_.problem(), vertices);
    // Of f - f_h; rules integrate polynomials of degree p + 2 as they are.
    const double rest = degree <= p + 2 ? 0 : form_.data().body_remainder(cell).oscillation;
    const Norms rho = norms(cell);
    const double at_axis = axial_constant(vertices) * (rho.axial + std::sqrt(largest) * rest) + rho.radial +
                           std::pow(largest, 1.5) * rest;
    const double r_t = smallest_radius(vertices);
    if (r_t == 0) return at_axis;
    return std::min(at_axis, poincare_korn<2>(vertices).cell * (rho.plain + largest * rest) / std::sqrt(r_t));
  }

 private:
  struct Norms
  {
    double plain;   ///< ||rho||
    double axial;   ///< ||r^{-1/2} rho_z||
    double radial;  ///< ||r^{1/2} rho_r||
  };

  /// Of rho = r (f_h - f~).
  [[nodiscard]] Norms norms(Index cell) const
  {
    const mesh::Mesh<2>& mesh = form_.space().mesh();
    const SortedCell<2> sorted = make_sorted_cell(mesh, cell);
    const fem::Quadrature<2>& rule = rules_.of_cell(cell);
    const std::vector<Point<2>> f = body_force_at(form_, cell, rule.points);
    const std::array<Eigen::VectorXd, 2> load = fields_.load(cell, sorted);
    std::vector<double> phi(load[0].size());
    double plain = 0;
    double axial = 0;
    double radial = 0;
    for (const auto& [q, x, dx] : fem::cell_points(mesh::cell_map(mesh, cell), rule))
    {
      fem::orthonormal_values<2>(form_.space().degree(), to_sorted_cell<2>(sorted.local, rule.points[q]),
                                 phi);
      Point<2> rho = x[0] * f[q];
      for (int k = 0; k < 2; ++k)
        rho[k] -= Eigen::Map<const Eigen::VectorXd>(phi.data(), std::ssize(phi)).dot(load[k]) /
                  std::sqrt(sorted.det);
      plain += dx * rho.squaredNorm();
      axial += dx / x[0] * rho[1] * rho[1];
      radial += dx * x[0] * rho[0] * rho[0];
    }
    const double most = 1 + rules_.relative_error(cell);
    return {std::sqrt(plain), std::sqrt(most * axial), std::sqrt(radial)};
  }

  const contact::NitscheForm<2>& form_;
  MeridianFields fields_;
  fem::MeridianRules rules_;
};

/// The directions in which a spring acts on a facet, one independently of the other.
std::vector<Point<2>> spring_directions(const problem::BoundaryCondition<2>& boundary, const Point<2>& normal)
{
  for (int a = 0; a < 2; ++a)
    if (boundary.fixes(a)) return {Point<2>::Unit(1 - a)};
  std::vector<Point<2>> directions;
  if (!boundary.spring->normal.is_zero()) directions.push_back(normal);
  if (!boundary.spring->tangential.is_zero()) directions.emplace_back(-normal[1], normal[0]);
  return directions;
}

/// <= e . K e on the facet, K of degree 2: the least coefficient in Bernstein's basis.
double least_along(const contact::SpringFacet<2>& spring, const fem::Quadrature<1>& rule, const Point<2>& e)
{
  const Eigen::MatrixXd basis = bernstein_at<2>(problem::most_of_stiffness, rule.points);
  Eigen::VectorXd values(rule.size());
  for (int q = 0; q < rule.size(); ++q) values[q] = e.dot(spring.stiffness.values[q] * e);
  const Eigen::VectorXd coefficients =
      CholeskyFactors(basis.transpose() * basis).solve(basis.transpose() * values);
  constexpr double rounding = 1e-12;  // of the largest
  return coefficients.minCoeff() - rounding * coefficients.maxCoeff();
}

/// An upper bound of (r (T - Pi_F^r T), w)_F / (r K w, w)_F^{1/2}, T = -K (u - u_0) with polynomials K and
/// u_0 that rules integrate; infinite where K may vanish. Any projection onto P^p is farther from T than
/// Pi_F^r.
double spring_loss(const contact::NitscheForm<2>& form, const contact::SpringFacet<2>& spring,
                   std::span<const double> u)
{
  const mesh::Mesh<2>& mesh = form.space().mesh();
  const fem::Quadrature<1>& rule = form.facet_rule();
  Eigen::MatrixXd theta(form.space().degree() + 1, rule.size());
  Eigen::Matrix2Xd rest(2, rule.size());
  for (int q = 0; q < rule.size(); ++q)
  {
    fem::orthonormal_values<1>(form.space().degree(), rule.points[q],
                               std::span(theta.col(q).data(), theta.rows()));
    rest.col(q) = form.springs().traction(spring, u, q);
  }
  const Eigen::Map<const Eigen::VectorXd> weights(rule.weights.data(), rule.size());
  rest -= (rest * weights.asDiagonal() * theta.transpose()).eval() * theta;
  const Eigen::Map<const Eigen::VectorXd> with_r(spring.weights.data(), rule.size());
  double squares = 0;
  for (const Point<2>& e : spring_directions(form.problem().boundary(mesh.boundary()[spring.number].tag),
                                             mesh::facet_geometry(mesh, spring.cell, spring.local).normal))
    if (const double square = (e.transpose() * rest).cwiseAbs2().dot(with_r); square > 0)
    {
      const double least = least_along(spring, rule, e);
      squares += least > 0 ? square / least : std::numeric_limits<double>::infinity();
    }
  return std::sqrt(squares);
}

/// ||r^{1/2} (sigma_0 - Pi^p sigma_0)||: the functions of degree p + 1 among its moments and what these leave
/// out.
double initial_oscillation(const contact::NitscheForm<2>& form, Index cell)
{
  const contact::InitialStress<2>& initial = form.data().initial_stress();
  const std::span<const Tensor<2>> plane = initial.coefficients(cell);
  const std::span<const double> hoop = initial.hoop_coefficients(cell);
  double square = 0;
  for (auto j = static_cast<std::size_t>(fem::polynomial_dimension(2, form.space().degree()));
       j < plane.size(); ++j)
    square += plane[j].squaredNorm() + hoop[j] * hoop[j];
  const double norm = std::sqrt(square * mesh::cell_map(form.space().mesh(), cell).det);
  return std::sqrt(problem::largest_weight<2>(form.problem(), vertices_of(form, cell))) *
         initial.remainder(cell).added_to(norm);
}

/// Adds those of tractions, and what quadrature may miss of them.
void add_tractions(const contact::NitscheForm<2>& form, std::span<const double> u, std::span<double> missed,
                   LoadOscillation& result)
{
  const mesh::Mesh<2>& mesh = form.space().mesh();
  const int p = form.space().degree();
  bool is_unknown = false;
  bool is_soft = false;
  for (std::size_t k = 0; k < mesh.n_owned_boundary(); ++k)
  {
    const mesh::BoundaryFacet& facet = mesh.boundary()[k];
    const contact::SpringFacet<2>* const spring = form.springs().on(k);
    const bool is_polynomial = contact::traction_datum(form.problem(), mesh, facet).degree() <= p;
    if (is_polynomial && (spring == nullptr || spring->is_resolved)) continue;
    const double largest = largest_radius(form, facet.cell, facet.local);
    if (largest == 0) continue;  // on the axis
    const std::array<Point<2>, 3> vertices = vertices_of(form, facet.cell);
    if (smallest_radius(vertices) == 0)
    {
      is_unknown = is_unknown || !is_polynomial || !spring->rest.is_polynomial;
      if (is_unknown) continue;
      const double loss = spring_loss(form, *spring, u);
      is_soft = is_soft || std::isinf(loss);
      result.cells[facet.cell] += std::sqrt(least_stiffness(form, facet.cell)) * loss;
      continue;
    }
    const auto [oscillation, mean] = contact::traction_remainder(form, k, u);
    const double measure = mesh::facet_geometry(mesh, facet.cell, facet.local).measure;
    const PoincareKorn<2> constants = poincare_korn<2>(vertices);
    result.cells[facet.cell] += largest / std::sqrt(smallest_radius(vertices)) *
                                (constants.facets[facet.local] * oscillation +
                                 constants.traces[facet.local] * 2 * mean / std::sqrt(measure));
    missed[facet.cell] += 2 * largest * mean;
  }
  if (mesh.ranks().any(is_soft))
    result.reason = "a spring whose stiffness varies on a cell that touches the axis may be 0 there";
  if (mesh.ranks().any(is_unknown))
    result.reason = fmt::format("tractions on cells that touch the axis are no polynomials of degree {}", p);
}

}  // namespace

/// What quadrature misses has the weight r times an affine one, as in the plane, and K of the plane is one
/// with the weight r up to the root of the smallest r.
LoadOscillation meridian_load_oscillation(const contact::NitscheForm<2>& form, std::span<const double> u,
                                          double korn)
{
  const mesh::Mesh<2>& mesh = form.space().mesh();
  const Index n_cells = mesh.n_owned_cells();
  LoadOscillation result{.cells = std::vector<double>(n_cells, 0.0)};
  std::vector<double> missed(n_cells, 0.0);
  const BodyOscillation of_body(form);
  parallel_for(result.cells.size(),
               [&](std::size_t c) {
                 result.cells[c] =
                     of_body(static_cast<Index>(c)) + initial_oscillation(form, static_cast<Index>(c));
               });
  for (Index c = 0; c < n_cells; ++c)
    missed[c] =
        problem::largest_weight<2>(form.problem(), vertices_of(form, c)) * form.data().body_remainder(c).mean;
  add_tractions(form, u, missed, result);
  double squares = 0;
  double least = std::numeric_limits<double>::infinity();    // of the stiffness
  double nearest = std::numeric_limits<double>::infinity();  // radius
  for (Index c = 0; c < n_cells; ++c)
  {
    const double stiffness = least_stiffness(form, c);
    least = std::min(least, stiffness);
    nearest = std::min(nearest, smallest_radius(vertices_of(form, c)));
    result.cells[c] /= std::sqrt(stiffness);
    squares += missed[c] * missed[c] / mesh::cell_map(mesh, c).measure();
  }
  squares = mesh.ranks().sum(squares);
  least = -mesh.ranks().max(-least);
  nearest = -mesh.ranks().max(-nearest);
  if (squares == 0) return result;
  result.missed = nearest > 0 ? 3 * korn * std::sqrt(squares / (least * nearest))
                              : std::numeric_limits<double>::infinity();
  if (result.reason.empty() && !std::isfinite(result.missed))
    result.reason = nearest > 0
                        ? "quadrature may miss a part of the loads, and displacements do not hold the "
                          "meridian in its plane"
                        : "quadrature may miss a part of the loads, and the bodies touch the axis";
  return result;
}

double meridian_traction_constant(const contact::NitscheForm<2>& form, Index cell, int local)
{
  const std::array<Point<2>, 3> vertices = vertices_of(form, cell);
  return largest_radius(form, cell, local) / std::sqrt(smallest_radius(vertices)) *
         poincare_korn<2>(vertices).facets[local];
}

}  // namespace tribound::certify
