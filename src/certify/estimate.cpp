#include "certify/estimate.h"

#include <cmath>
#include <numbers>

#include "certify/frame.h"
#include "fem/polynomials.h"
#include "fem/quadrature.h"

namespace tribound
{

double BoundComponents::total() const
{
  return std::hypot(osc + str + neu + lin1, cnt + frc + lin2n + lin2t);
}

double BoundComponents::total_sharp() const
{
  return std::hypot(osc + str + neu + lin1, std::hypot(cnt + lin2n, frc + lin2t));
}

namespace
{

/// Orthonormal polynomials of degree p at the points of a rule: [q * n + j].
template <int k>
std::vector<double> tabulate_orthonormal(int degree, std::span<const Point<k>> points)
{
  const int n = polynomial_dimension(k, degree);
  std::vector<double> values(points.size() * n);
  for (std::size_t q = 0; q < points.size(); ++q)
    orthonormal_values<k>(degree, points[q], std::span(values).subspan(q * n, n));
  return values;
}

/// The reference point of the sorted frame that local facet point s of the unsorted cell is.
template <int dim>
Point<dim> in_frame(const Frame<dim>& frame, const Point<dim>& in_cell)
{
  std::array<double, dim + 1> lambda;  // of the cell's own vertices
  lambda[0] = 1 - in_cell.sum();
  for (int i = 0; i < dim; ++i) lambda[i + 1] = in_cell[i];
  Point<dim> sorted;
  for (int i = 0; i < dim; ++i) sorted[i] = lambda[frame.local[i + 1]];
  return sorted;
}

/// A block of stress coefficients at a point of the frame.
template <int dim>
Tensor<dim> stress_at(const Frame<dim>& frame, int degree, std::span<const double> block, const Point<dim>& x)
{
  const int n = polynomial_dimension(dim, degree);
  std::array<double, polynomial_dimension(dim, 4)> values;
  orthonormal_values<dim>(degree, x, std::span(values).first(n));
  Tensor<dim> stress;
  for (int r = 0; r < dim; ++r)
    for (int c = 0; c < dim; ++c)
    {
      double sum = 0;
      for (int j = 0; j < n; ++j) sum += block[(dim * r + c) * n + j] * values[j];
      stress(r, c) = sum / std::sqrt(frame.det);
    }
  return stress;
}

template <int dim>
class Estimator
{
 public:
  Estimator(const NitscheForm<dim>& form, std::span<const double> u, const Stress<dim>& stress)
      : form_(form), mesh_(form.space().mesh()), u_(u), stress_(stress)
  {
    result_.cells.resize(mesh_.n_cells());
  }

  Estimate run()
  {
    volume_terms();
    neumann_terms();
    contact_terms();
    add_up();
    return std::move(result_);
  }

 private:
  void volume_terms();
  [[nodiscard]] double oscillation(Index cell, const Frame<dim>& frame) const;
  void neumann_terms();
  void contact_terms();
  void add_up();

  const NitscheForm<dim>& form_;
  const Mesh<dim>& mesh_;
  std::span<const double> u_;
  const Stress<dim>& stress_;
  Estimate result_;
};

/// str and lin1: the difference of polynomials of degree p by a rule of degree 2p.
template <int dim>
void Estimator<dim>::volume_terms()
{
  const LagrangeSpace<dim>& space = form_.space();
  const Quadrature<dim> rule = quadrature<dim>(2 * stress_.degree);
  const Tabulation<dim> table = space.basis().tabulate(rule.points);
  for (Index c = 0; c < mesh_.n_cells(); ++c)
  {
    const Frame<dim> frame = make_frame(mesh_, c);
    const CellMap<dim> map = cell_map(mesh_, c);
    const Material& material = form_.problem().material(mesh_.region(c));
    double str = 0;
    for (int q = 0; q < rule.size(); ++q)
    {
      const Tensor<dim> discrete = sigma<dim>(
          material, gradient_at<dim>(space.cell_nodes(c), u_, table.gradients_at(q), map.inverse_transpose));
      const Tensor<dim> equilibrated =
          stress_at<dim>(frame, stress_.degree, stress_.dis_in(c), in_frame<dim>(frame, rule.points[q]));
      str += rule.weights[q] * frame.det * (equilibrated - discrete).squaredNorm();
    }
    double lin = 0;
    for (const double x : stress_.lin_in(c)) lin += x * x;
    BoundComponents& cell = result_.cells[c];
    cell.str = std::sqrt(str);
    cell.lin1 = std::sqrt(lin);
    if (!form_.problem().body_force_is_zero(mesh_.region(c)))
      cell.osc = cell_diameter(mesh_, c) / std::numbers::pi * oscillation(c, frame);
  }
}

/// ||f - Pi^{p-1} f||_T.
template <int dim>
double Estimator<dim>::oscillation(Index cell, const Frame<dim>& frame) const
{
  const Quadrature<dim> rule = quadrature<dim>(data_quadrature_degree(stress_.degree));
  const int n = polynomial_dimension(dim, stress_.degree - 1);
  const std::vector<double> chi = tabulate_orthonormal<dim>(stress_.degree - 1, rule.points);
  std::vector<Point<dim>> f(rule.size());
  std::vector<Point<dim>> projection(n, Point<dim>::Zero());
  for (int q = 0; q < rule.size(); ++q)
  {
    f[q] = form_.problem().body_force(mesh_.region(cell), frame.origin + frame.jacobian * rule.points[q]);
    for (int j = 0; j < n; ++j) projection[j] += rule.weights[q] * chi[q * n + j] * f[q];
  }
  double sum = 0;
  for (int q = 0; q < rule.size(); ++q)
  {
    Point<dim> difference = f[q];
    for (int j = 0; j < n; ++j) difference -= chi[q * n + j] * projection[j];
    sum += rule.weights[q] * frame.det * difference.squaredNorm();
  }
  return std::sqrt(sum);
}

template <int dim>
void Estimator<dim>::neumann_terms()
{
  const Quadrature<dim - 1>& rule = form_.facet_rule();
  const int n = polynomial_dimension(dim - 1, stress_.degree);
  const std::vector<double> theta = tabulate_orthonormal<dim - 1>(stress_.degree, rule.points);
  for (const BoundaryFacet& facet : mesh_.boundary())
  {
    const BoundaryCondition<dim>& boundary = form_.problem().boundary(facet.tag);
    if (!boundary.is_loaded()) continue;
    const CellMap<dim> map = cell_map(mesh_, facet.cell);
    const FacetGeometry<dim> geometry = facet_geometry(mesh_, facet.cell, facet.local);
    std::vector<Point<dim>> g(rule.size());
    std::vector<Point<dim>> projection(n, Point<dim>::Zero());
    for (int q = 0; q < rule.size(); ++q)
    {
      g[q] = boundary.load(map(facet_to_cell<dim>(facet.local, rule.points[q])), geometry.normal);
      for (int j = 0; j < n; ++j) projection[j] += rule.weights[q] * theta[q * n + j] * g[q];
    }
    double sum = 0;
    for (int q = 0; q < rule.size(); ++q)
    {
      Point<dim> difference = g[q];
      for (int j = 0; j < n; ++j) difference -= theta[q * n + j] * projection[j];
      sum += rule.weights[q] * geometry.measure * (dim - 1) * difference.squaredNorm();
    }
    constexpr double pi = std::numbers::pi;
    const double volume = map.det / (dim == 2 ? 2 : 6);
    const double constant = cell_diameter(mesh_, facet.cell) *
                            std::sqrt(geometry.measure / volume * (1 / (pi * pi) + 2 / (dim * pi)));
    result_.cells[facet.cell].neu += constant * std::sqrt(sum);
  }
}

template <int dim>
void Estimator<dim>::contact_terms()
{
  const Quadrature<dim - 1>& rule = form_.facet_rule();
  const std::vector<Point<dim>> traction = form_.traction(u_);
  std::vector<BoundComponents> squares(mesh_.n_cells());
  for (std::size_t k = 0; k < form_.contact_facets().size(); ++k)
  {
    const auto& [facet, geometry, gamma, contact] = form_.contact_facets()[k];
    const Frame<dim> frame = make_frame(mesh_, facet.cell);
    const Point<dim>& n = geometry.normal;
    BoundComponents& sum = squares[facet.cell];
    for (int q = 0; q < rule.size(); ++q)
    {
      const Point<dim> x = in_frame<dim>(frame, facet_to_cell<dim>(facet.local, rule.points[q]));
      const double weight = geometry.diameter * geometry.measure * (dim - 1) * rule.weights[q];
      const Point<dim> difference = traction[k * rule.size() + q] -
                                    stress_at<dim>(frame, stress_.degree, stress_.dis_in(facet.cell), x) * n;
      const Point<dim> lin = stress_at<dim>(frame, stress_.degree, stress_.lin_in(facet.cell), x) * n;
      sum.cnt += weight * std::pow(difference.dot(n), 2);
      sum.frc += weight * (difference - difference.dot(n) * n).squaredNorm();
      sum.lin2n += weight * std::pow(lin.dot(n), 2);
      sum.lin2t += weight * (lin - lin.dot(n) * n).squaredNorm();
    }
  }
  for (Index c = 0; c < mesh_.n_cells(); ++c)
  {
    result_.cells[c].cnt = std::sqrt(squares[c].cnt);
    result_.cells[c].frc = std::sqrt(squares[c].frc);
    result_.cells[c].lin2n = std::sqrt(squares[c].lin2n);
    result_.cells[c].lin2t = std::sqrt(squares[c].lin2t);
  }
}

template <int dim>
void Estimator<dim>::add_up()
{
  constexpr std::array members = {&BoundComponents::osc,   &BoundComponents::str,  &BoundComponents::neu,
                                  &BoundComponents::lin1,  &BoundComponents::cnt,  &BoundComponents::frc,
                                  &BoundComponents::lin2n, &BoundComponents::lin2t};
  for (const BoundComponents& cell : result_.cells)
  {
    for (const auto member : members) result_.global.*member += std::pow(cell.*member, 2);
    result_.total += std::pow(cell.total(), 2);
    result_.total_sharp += std::pow(cell.total_sharp(), 2);
  }
  for (const auto member : members) result_.global.*member = std::sqrt(result_.global.*member);
  result_.total = std::sqrt(result_.total);
  result_.total_sharp = std::sqrt(result_.total_sharp);
}

}  // namespace

template <int dim>
Estimate estimate(const NitscheForm<dim>& form, std::span<const double> u, const Stress<dim>& stress)
{
  return Estimator<dim>(form, u, stress).run();
}

template Estimate estimate(const NitscheForm<2>&, std::span<const double>, const Stress<2>&);
template Estimate estimate(const NitscheForm<3>&, std::span<const double>, const Stress<3>&);

}  // namespace tribound
