#include "tribound/certify/bound/checks.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tribound/fem/evaluation.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"

namespace tribound::certify
{

double IdentityDefects::largest(int degree) const
{
  double worst = 0;
  for (const double defect : {divergence, jump, neumann, contact, degree == 1 ? 0 : symmetry})
    if (!std::isnan(worst) && !(defect <= worst)) worst = defect;  // nan, too
  return worst;
}

namespace
{

/// Tables on the reference cell whose vertices are in ascending order.
template <int dim>
struct Tables
{
  int n;       ///< dim P^p(T)
  int n_less;  ///< dim P^{p-1}(T)
  fem::Quadrature<dim> data_rule;
  std::array<std::vector<double>, dim> derivative;    ///< (d_k phi_j, chi_i), [i * n + j]
  fem::Quadrature<dim - 1> jump_rule;                 ///< exact to degree 2p
  std::array<std::vector<double>, dim + 1> on_facet;  ///< phi at its points, [q * n + j]

  explicit Tables(int degree)
      : n(fem::polynomial_dimension(dim, degree)),
        n_less(fem::polynomial_dimension(dim, degree - 1)),
        data_rule(fem::quadrature<dim>(fem::data_quadrature_degree(degree))),
        jump_rule(fem::quadrature<dim - 1>(2 * degree))
  {
    std::vector<double> phi(n);
    std::vector<Point<dim>> gradients(n);
    for (auto& matrix : derivative) matrix.assign(static_cast<std::size_t>(n_less) * n, 0.0);
    for (int q = 0; q < data_rule.size(); ++q)
    {
      fem::orthonormal_gradients<dim>(degree, data_rule.points[q], phi, gradients);
      for (int k = 0; k < dim; ++k)
        for (int i = 0; i < n_less; ++i)
          for (int j = 0; j < n; ++j)
            derivative[k][i * n + j] += data_rule.weights[q] * phi[i] * gradients[j][k];
    }
    for (int f = 0; f <= dim; ++f)
      for (const Point<dim - 1>& s : jump_rule.points)
      {
        fem::orthonormal_values<dim>(degree, mesh::facet_to_cell<dim>(f, s), phi);
        on_facet[f].insert(on_facet[f].end(), phi.begin(), phi.end());
      }
  }
};

/// sigma_h = sigma_dis + sigma_lin + sigma_reg on one cell, in the coordinates of its vertices in ascending
/// order.
template <int dim>
class CellStress
{
 public:
  CellStress(const mesh::Mesh<dim>& mesh, const Stress<dim>& stress, Index cell)
      : degree_(stress.degree),
        n_(stress.n),
        coefficients_(stress.dis_in(cell).begin(), stress.dis_in(cell).end()),
        vertices_(mesh.cell(cell))
  {
    for (const std::span<const double> part : {stress.lin_in(cell), stress.reg_in(cell)})
      for (std::size_t i = 0; i < part.size(); ++i) coefficients_[i] += part[i];
    std::ranges::sort(vertices_);
    origin_ = mesh.vertex(vertices_[0]);
    for (int j = 0; j < dim; ++j) jacobian_.col(j) = mesh.vertex(vertices_[j + 1]) - origin_;
    det_ = std::abs(jacobian_.determinant());
    inverse_ = jacobian_.inverse();
  }

  /// The basis of P^{p-1}(T) at a point of space, up to the factor 1/sqrt(det J).
  void truncated_basis_at(const Point<dim>& x, std::span<double> values) const
  {
    fem::orthonormal_values<dim>(degree_ - 1, inverse_ * (x - origin_), values);
  }
  /// Which of the ascending vertices lies opposite to the facet, the cell's vertex `opposite` being that one.
  [[nodiscard]] int facet_opposite(Index opposite) const
  {
    return static_cast<int>(std::ranges::find(vertices_, opposite) - vertices_.begin());
  }
  [[nodiscard]] double squared_norm() const
  {
    double sum = 0;
    for (const double c : coefficients_) sum += c * c;
    return sum;
  }

  /// sigma_h n from the values of the basis at a point.
  [[nodiscard]] Point<dim> normal_trace(const double* basis, const Point<dim>& normal) const
  {
    Point<dim> trace = Point<dim>::Zero();
    for (int r = 0; r < dim; ++r)
      for (int c = 0; c < dim; ++c)
      {
        double entry = 0;
        for (int j = 0; j < n_; ++j) entry += coefficient(r, c, j) * basis[j];
        trace[r] += entry * normal[c] / std::sqrt(det_);
      }
    return trace;
  }
  /// sigma_h n at a point of space.
  [[nodiscard]] Point<dim> normal_trace_at(const Point<dim>& x, const Point<dim>& normal) const
  {
    std::vector<double> values(n_);
    fem::orthonormal_values<dim>(degree_, inverse_ * (x - origin_), values);
    return normal_trace(values.data(), normal);
  }

  /// The coefficients of div sigma_h in the orthonormal basis of P^{p-1}(T).
  [[nodiscard]] std::vector<Point<dim>> divergence(const Tables<dim>& tables) const
  {
    std::vector<Point<dim>> result(tables.n_less, Point<dim>::Zero());
    for (int k = 0; k < dim; ++k)
      for (int i = 0; i < tables.n_less; ++i)
        for (int r = 0; r < dim; ++r)
          for (int c = 0; c < dim; ++c)
            for (int j = 0; j < n_; ++j)
              result[i][r] += inverse_(k, c) * tables.derivative[k][i * n_ + j] * coefficient(r, c, j);
    return result;
  }

  /// ||Pi^{p-1} skew sigma_h||^2: the skew part of the leading coefficients.
  [[nodiscard]] double squared_skew_part(int n_less) const
  {
    double sum = 0;
    for (int r = 0; r < dim; ++r)
      for (int c = 0; c < dim; ++c)
        for (int j = 0; j < n_less; ++j)
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
  mesh::Cell<dim> vertices_;  ///< ascending
  Point<dim> origin_;
  Tensor<dim> jacobian_;
  Tensor<dim> inverse_;
  double det_;
};

/// ||div sigma_h + Pi^{p-1} f||_T^2: div sigma_h is of degree p-1 itself. The points of the rule come in
/// the numbering of the cell, in which f is given.
template <int dim>
double squared_divergence_defect(const contact::DiscreteData<dim>& data, Index cell,
                                 const Tables<dim>& tables, const CellStress<dim>& sigma,
                                 const mesh::CellMap<dim>& map)
{
  std::vector<Point<dim>> moments = sigma.divergence(tables);
  if (data.has_body_force(cell))
  {
    std::vector<double> chi(tables.n_less);
    std::vector<Point<dim>> f(tables.data_rule.size());
    data.body_force(cell, f);
    for (int q = 0; q < tables.data_rule.size(); ++q)
    {
      sigma.truncated_basis_at(map(tables.data_rule.points[q]), chi);
      for (int i = 0; i < tables.n_less; ++i)
        moments[i] += tables.data_rule.weights[q] * std::sqrt(map.det) * chi[i] * f[q];
    }
  }
  double sum = 0;
  for (const Point<dim>& moment : moments) sum += moment.squaredNorm();
  return sum;
}

/// Sums of squares on the cells, and the square of the norm of sigma_h.
template <int dim>
double check_cells(const contact::NitscheForm<dim>& form, const Stress<dim>& stress,
                   const Tables<dim>& tables, IdentityDefects& squares)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  double norm_squared = 0;
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    const CellStress<dim> sigma(mesh, stress, c);
    norm_squared += sigma.squared_norm();
    squares.symmetry += sigma.squared_skew_part(tables.n_less);
    squares.divergence += std::pow(mesh::cell_diameter(mesh, c), 2) *
                          squared_divergence_defect(form.data(), c, tables, sigma, mesh::cell_map(mesh, c));
  }
  return norm_squared;
}

/// sum h_F ||[sigma_h n]||_F^2 over the facets between two cells. Seen from both, the vertices of the facet
/// come in the same, ascending order.
template <int dim>
double check_jumps(const mesh::Mesh<dim>& mesh, const Stress<dim>& stress, const Tables<dim>& tables)
{
  const mesh::Topology<dim>& topology = mesh.topology();
  const auto opposite = [&](Index cell, Index facet)
  {
    const auto& facets = topology.cell_facets[cell];
    return mesh.cell(cell)[std::ranges::find(facets, facet) - facets.begin()];
  };
  double sum = 0;
  for (Index c = 0; c < mesh.n_cells(); ++c)
    for (int local = 0; local <= dim; ++local)
    {
      const Index facet = topology.cell_facets[c][local];
      const auto& [first, second] = topology.facet_cells[facet];
      if (first != c || second < 0) continue;
      const mesh::FacetGeometry<dim> geometry = mesh::facet_geometry(mesh, c, local);
      const CellStress<dim> here(mesh, stress, first);
      const CellStress<dim> there(mesh, stress, second);
      const double* const phi_here = tables.on_facet[here.facet_opposite(opposite(first, facet))].data();
      const double* const phi_there = tables.on_facet[there.facet_opposite(opposite(second, facet))].data();
      for (int q = 0; q < tables.jump_rule.size(); ++q)
        sum += geometry.diameter * tables.jump_rule.weights[q] * geometry.det() *
               (here.normal_trace(phi_here + q * tables.n, geometry.normal) -
                there.normal_trace(phi_there + q * tables.n, geometry.normal))
                   .squaredNorm();
    }
  return sum;
}

/// Moments (t, theta_i)_F of tractions in the orthonormal basis theta of one boundary facet.
template <int dim>
class FacetMoments
{
 public:
  FacetMoments(const mesh::Mesh<dim>& mesh, const mesh::BoundaryFacet& facet, int degree)
      : degree_(degree),
        scale_(1 / std::sqrt(mesh::facet_geometry(mesh, facet.cell, facet.local).det())),
        theta_(fem::polynomial_dimension(dim - 1, degree))
  {
  }

  [[nodiscard]] std::vector<Point<dim>> none() const { return {theta_.size(), Point<dim>::Zero()}; }
  /// moments += weight theta_i t at the point s of the reference facet.
  void add(const Point<dim - 1>& s, double weight, const Point<dim>& t, std::span<Point<dim>> moments)
  {
    fem::orthonormal_values<dim - 1>(degree_, s, theta_);
    for (std::size_t i = 0; i < moments.size(); ++i) moments[i] += weight * scale_ * theta_[i] * t;
  }

 private:
  int degree_;
  double scale_;  ///< normalises theta on the facet
  std::vector<double> theta_;
};

/// The moments of what acts on each boundary facet: g_N, t^k on slaves, -t^k on masters; empty: nothing.
template <int dim>
std::vector<std::vector<Point<dim>>> prescribed_moments(const contact::NitscheForm<dim>& form,
                                                        std::span<const Point<dim>> t, int degree)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const fem::Quadrature<dim - 1>& rule = form.facet_rule();
  std::vector<std::vector<Point<dim>>> moments(mesh.boundary().size());
  std::vector<Point<dim>> g(rule.size());
  for (std::size_t number = 0; number < mesh.boundary().size(); ++number)
  {
    if (!form.data().has_traction(number)) continue;
    const mesh::BoundaryFacet& facet = mesh.boundary()[number];
    FacetMoments<dim> on_facet(mesh, facet, degree);
    moments[number] = on_facet.none();
    form.data().traction(number, g);
    for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, rule))
      on_facet.add(rule.points[q], dx, g[q], moments[number]);
  }
  for (std::size_t k = 0; k < form.segments().size(); ++k)
    form.segments()[k].for_each_side(
        [&](const contact::SegmentSide<dim>& side)
        {
          FacetMoments<dim> on_facet(mesh, side.facet, degree);
          if (moments[side.number].empty()) moments[side.number] = on_facet.none();
          for (int q = 0; q < rule.size(); ++q)
            on_facet.add(side.on_facet(rule.points[q]), side.sign * form.contact_points(k)[q].weight,
                         t[k * rule.size() + q], moments[side.number]);
        });
  return moments;
}

/// sum h_F ||Pi^p_F (sigma_h n) - prescribed||_F^2 over the free components.
template <int dim>
void check_boundary(const contact::NitscheForm<dim>& form, std::span<const Point<dim>> t,
                    const Stress<dim>& stress, IdentityDefects& squares)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const fem::Quadrature<dim - 1>& rule = form.facet_rule();
  const auto prescribed = prescribed_moments(form, t, stress.degree);
  std::vector<char> in_contact(mesh.boundary().size(), 0);
  for (const contact::ContactSegment<dim>& segment : form.segments())
    segment.for_each_side([&](const contact::SegmentSide<dim>& side) { in_contact[side.number] = 1; });
  for (std::size_t number = 0; number < mesh.boundary().size(); ++number)
  {
    const mesh::BoundaryFacet& facet = mesh.boundary()[number];
    const problem::BoundaryCondition<dim>& boundary = form.problem().boundary(facet.tag);
    const mesh::FacetGeometry<dim> geometry = mesh::facet_geometry(mesh, facet.cell, facet.local);
    const CellStress<dim> sigma(mesh, stress, facet.cell);
    FacetMoments<dim> on_facet(mesh, facet, stress.degree);
    std::vector<Point<dim>> moments = on_facet.none();
    for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, rule))
      on_facet.add(rule.points[q], dx, sigma.normal_trace_at(x, geometry.normal), moments);
    for (std::size_t i = 0; i < prescribed[number].size(); ++i) moments[i] -= prescribed[number][i];
    double& sum = in_contact[number] ? squares.contact : squares.neumann;
    for (const Point<dim>& moment : moments)
      for (int c = 0; c < dim; ++c)
        if (!boundary.fixes(c)) sum += geometry.diameter * moment[c] * moment[c];
  }
}

}  // namespace

template <int dim>
IdentityDefects check_identities(const contact::NitscheForm<dim>& form, std::span<const Point<dim>> t,
                                 const Stress<dim>& stress)
{
  const Tables<dim> tables(stress.degree);
  IdentityDefects squares;
  const double norm_squared = check_cells(form, stress, tables, squares);
  squares.jump = check_jumps(form.space().mesh(), stress, tables);
  check_boundary(form, t, stress, squares);
  const auto relative = [&](double sum) { return sum == 0 ? 0 : std::sqrt(sum / norm_squared); };
  return {relative(squares.divergence), relative(squares.jump), relative(squares.neumann),
          relative(squares.contact), relative(squares.symmetry)};
}

template IdentityDefects check_identities(const contact::NitscheForm<2>&, std::span<const Point<2>>,
                                          const Stress<2>&);
template IdentityDefects check_identities(const contact::NitscheForm<3>&, std::span<const Point<3>>,
                                          const Stress<3>&);

}  // namespace tribound::certify
