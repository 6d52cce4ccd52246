#include "certify/checks.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "fem/polynomials.h"
#include "fem/quadrature.h"

namespace tribound
{

double IdentityDefects::largest(int degree) const
{
  const double all = std::max({divergence, jump, neumann, contact});
  return degree == 1 ? all : std::max(all, symmetry);
}

namespace
{

/// sigma_h = sigma_dis + sigma_lin as a function on one cell, in the coordinates of its vertices in ascending
/// order.
template <int dim>
class CellStress
{
 public:
  CellStress(const Mesh<dim>& mesh, const Stress<dim>& stress, Index cell)
      : degree_(stress.degree),
        n_(stress.n),
        coefficients_(stress.dis_in(cell).begin(), stress.dis_in(cell).end())
  {
    const std::span<const double> lin = stress.lin_in(cell);
    for (std::size_t i = 0; i < lin.size(); ++i) coefficients_[i] += lin[i];
    Cell<dim> vertices = mesh.cell(cell);
    std::ranges::sort(vertices);
    origin_ = mesh.vertex(vertices[0]);
    for (int j = 0; j < dim; ++j) jacobian_.col(j) = mesh.vertex(vertices[j + 1]) - origin_;
    det_ = std::abs(jacobian_.determinant());
    inverse_ = jacobian_.inverse();
  }

  [[nodiscard]] double det() const { return det_; }
  [[nodiscard]] Point<dim> physical(const Point<dim>& xhat) const { return origin_ + jacobian_ * xhat; }
  [[nodiscard]] double squared_norm() const
  {
    double sum = 0;
    for (const double c : coefficients_) sum += c * c;
    return sum;
  }

  [[nodiscard]] Tensor<dim> at(const Point<dim>& x) const
  {
    std::vector<double> values(n_);
    orthonormal_values<dim>(degree_, inverse_ * (x - origin_), values);
    Tensor<dim> sigma;
    for (int r = 0; r < dim; ++r)
      for (int c = 0; c < dim; ++c)
      {
        sigma(r, c) = 0;
        for (int j = 0; j < n_; ++j) sigma(r, c) += coefficient(r, c, j) * values[j] / std::sqrt(det_);
      }
    return sigma;
  }

  [[nodiscard]] Point<dim> divergence(const Point<dim>& xhat) const
  {
    std::vector<double> values(n_);
    std::vector<Point<dim>> gradients(n_);
    orthonormal_gradients<dim>(degree_, xhat, values, gradients);
    Point<dim> result = Point<dim>::Zero();
    for (int j = 0; j < n_; ++j)
    {
      const Point<dim> gradient = inverse_.transpose() * gradients[j] / std::sqrt(det_);
      for (int r = 0; r < dim; ++r)
        for (int c = 0; c < dim; ++c) result[r] += coefficient(r, c, j) * gradient[c];
    }
    return result;
  }

  /// ||Pi^{p-1} skew sigma_h||^2: the skew part of the leading coefficients.
  [[nodiscard]] double squared_skew_part() const
  {
    double sum = 0;
    for (int r = 0; r < dim; ++r)
      for (int c = 0; c < dim; ++c)
        for (int j = 0; j < polynomial_dimension(dim, degree_ - 1); ++j)
          sum += std::pow((coefficient(r, c, j) - coefficient(c, r, j)) / 2, 2);
    return sum;
  }

 private:
  [[nodiscard]] double coefficient(int r, int c, int j) const
  {
    return coefficients_[(dim * r + c) * n_ + j];
  }

  int degree_;
  int n_;
  std::vector<double> coefficients_;
  Point<dim> origin_;
  Tensor<dim> jacobian_;
  Tensor<dim> inverse_;
  double det_;
};

/// Moments of div sigma_h + f against the orthonormal basis of P^{p-1}(T): their squares add up to the norm
/// of the projection, and div sigma_h is of degree p-1 itself.
template <int dim>
double squared_divergence_defect(const Problem<dim>& problem, int region, int degree,
                                 const CellStress<dim>& sigma)
{
  const Quadrature<dim> rule = quadrature<dim>(data_quadrature_degree(degree));
  const int n = polynomial_dimension(dim, degree - 1);
  std::vector<double> chi(n);
  std::vector<Point<dim>> moments(n, Point<dim>::Zero());
  for (int q = 0; q < rule.size(); ++q)
  {
    orthonormal_values<dim>(degree - 1, rule.points[q], chi);
    const Point<dim> value =
        sigma.divergence(rule.points[q]) + problem.body_force(region, sigma.physical(rule.points[q]));
    for (int i = 0; i < n; ++i) moments[i] += rule.weights[q] * std::sqrt(sigma.det()) * chi[i] * value;
  }
  double sum = 0;
  for (const Point<dim>& moment : moments) sum += moment.squaredNorm();
  return sum;
}

/// A facet with the points of the data rule on it.
template <int dim>
struct FacetPoints
{
  std::vector<Point<dim>> x;
  double scale;  ///< |F| / |reference facet|
};

/// sum over the free components of ||Pi^p_F (sigma_h n - t)||_F^2 with t at the points of the rule.
template <int dim>
double squared_trace_defect(const CellStress<dim>& sigma, int degree, const Quadrature<dim - 1>& rule,
                            const FacetPoints<dim>& points, const Point<dim>& normal,
                            std::span<const Point<dim>> t, const BoundaryCondition<dim>& boundary)
{
  const int n = polynomial_dimension(dim - 1, degree);
  std::vector<double> theta(n);
  std::vector<Point<dim>> moments(n, Point<dim>::Zero());
  for (int q = 0; q < rule.size(); ++q)
  {
    orthonormal_values<dim - 1>(degree, rule.points[q], theta);
    const Point<dim> value = sigma.at(points.x[q]) * normal - t[q];
    for (int i = 0; i < n; ++i) moments[i] += rule.weights[q] * std::sqrt(points.scale) * theta[i] * value;
  }
  double sum = 0;
  for (const Point<dim>& moment : moments)
    for (int c = 0; c < dim; ++c)
      if (!boundary.fixes(c)) sum += moment[c] * moment[c];
  return sum;
}

}  // namespace

template <int dim>
IdentityDefects check_identities(const NitscheForm<dim>& form, std::span<const Point<dim>> t,
                                 const Stress<dim>& stress)
{
  const Mesh<dim>& mesh = form.space().mesh();
  const Topology<dim>& topology = mesh.topology();
  IdentityDefects squares;
  double norm_squared = 0;
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    const CellStress<dim> sigma(mesh, stress, c);
    norm_squared += sigma.squared_norm();
    squares.symmetry += sigma.squared_skew_part();
    squares.divergence += std::pow(cell_diameter(mesh, c), 2) *
                          squared_divergence_defect(form.problem(), mesh.region(c), stress.degree, sigma);
  }

  const Quadrature<dim - 1>& rule = form.facet_rule();
  const auto points_of = [&](Index cell, int local, const FacetGeometry<dim>& geometry)
  {
    FacetPoints<dim> points{{}, geometry.measure * (dim - 1)};
    const CellMap<dim> map = cell_map(mesh, cell);
    for (const Point<dim - 1>& s : rule.points) points.x.push_back(map(facet_to_cell<dim>(local, s)));
    return points;
  };

  for (Index c = 0; c < mesh.n_cells(); ++c)
    for (int local = 0; local <= dim; ++local)
    {
      const auto& [first, second] = topology.facet_cells[topology.cell_facets[c][local]];
      if (first != c || second < 0) continue;
      const FacetGeometry<dim> geometry = facet_geometry(mesh, c, local);
      const FacetPoints<dim> points = points_of(c, local, geometry);
      const CellStress<dim> here(mesh, stress, first);
      const CellStress<dim> there(mesh, stress, second);
      for (int q = 0; q < rule.size(); ++q)
        squares.jump += geometry.diameter * rule.weights[q] * points.scale *
                        ((here.at(points.x[q]) - there.at(points.x[q])) * geometry.normal).squaredNorm();
    }

  std::size_t contact_point = 0;
  for (const BoundaryFacet& facet : mesh.boundary())
  {
    const BoundaryCondition<dim>& boundary = form.problem().boundary(facet.tag);
    const FacetGeometry<dim> geometry = facet_geometry(mesh, facet.cell, facet.local);
    const FacetPoints<dim> points = points_of(facet.cell, facet.local, geometry);
    std::vector<Point<dim>> traction;
    for (const Point<dim>& x : points.x)
      traction.push_back(boundary.contact ? t[contact_point++] : boundary.load(x, geometry.normal));
    const double defect = geometry.diameter *
                          squared_trace_defect<dim>(CellStress<dim>(mesh, stress, facet.cell), stress.degree,
                                                    rule, points, geometry.normal, traction, boundary);
    (boundary.contact ? squares.contact : squares.neumann) += defect;
  }

  const auto relative = [&](double sum) { return norm_squared > 0 ? std::sqrt(sum / norm_squared) : 0; };
  return {relative(squares.divergence), relative(squares.jump), relative(squares.neumann),
          relative(squares.contact), relative(squares.symmetry)};
}

template IdentityDefects check_identities(const NitscheForm<2>&, std::span<const Point<2>>, const Stress<2>&);
template IdentityDefects check_identities(const NitscheForm<3>&, std::span<const Point<3>>, const Stress<3>&);

}  // namespace tribound
