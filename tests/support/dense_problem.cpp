#include "support/dense_problem.h"

#include <Eigen/LU>

#include "support/generalized_eigen.h"

namespace tribound::test
{

namespace
{

using Eigen::MatrixXd;
using Eigen::VectorXd;

template <int dim>
std::vector<Motion<dim>> rotations_about(const Point<dim>& a)
{
  std::vector<Motion<dim>> all;
  for (int r = 0; r < dim; ++r)
    for (int c = 0; c < r; ++c)
    {
      Tensor<dim> spin = Tensor<dim>::Zero();
      spin(r, c) = 1;
      spin(c, r) = -1;
      all.push_back({Point<dim>::Zero(), spin, a});
    }
  return all;
}

/// The translations in the components that no facet at the vertex fixes.
template <int dim>
std::vector<Motion<dim>> free_translations(const DenseData<dim>& given, const DensePatch<dim>& patch)
{
  std::vector<Motion<dim>> result;
  for (int c = 0; c < dim; ++c)
    if (std::ranges::none_of(
            patch.facets, [&](int f)
            { return given.facets[f].condition != nullptr && given.facets[f].condition->fixes(c); }))
      result.push_back({Point<dim>::Unit(c), Tensor<dim>::Zero(), given.mesh.vertex(patch.vertex)});
  return result;
}

/// The rotations about the vertex that are admissible or almost so: with fixed components below 0.35 of their
/// values, in the mean square over the vertices of the Dirichlet facets. A basis orthogonal in both. None row
/// by row: no rotation balances there.
template <int dim>
std::vector<Motion<dim>> hardly_stopped(const DenseData<dim>& given, const DensePatch<dim>& patch)
{
  if (given.by_rows) return {};
  const std::vector<Motion<dim>> all = rotations_about<dim>(given.mesh.vertex(patch.vertex));
  const auto n = static_cast<Eigen::Index>(all.size());
  MatrixXd values = MatrixXd::Zero(n, n);
  MatrixXd fixed = MatrixXd::Zero(n, n);
  for (const int f : patch.facets)
  {
    const problem::BoundaryCondition<dim>* condition = given.facets[f].condition;
    bool fixes_any = false;
    for (int c = 0; c < dim && condition; ++c) fixes_any = fixes_any || condition->fixes(c);
    if (!fixes_any) continue;
    for (const Index v : given.facets[f].vertices)
      for (int c = 0; c < dim; ++c)
      {
        VectorXd row(n);
        for (int i = 0; i < n; ++i) row[i] = all[i](given.mesh.vertex(v))[c];
        values += row * row.transpose();
        if (condition->fixes(c)) fixed += row * row.transpose();
      }
  }
  if (values.isZero(0)) return all;
  const SymmetricEigen eigen = generalized_eigen(fixed, values);
  std::vector<Motion<dim>> result;
  for (int k = 0; k < n && eigen.values[k] < 0.35 * 0.35; ++k)
  {
    Motion<dim>& z = result.emplace_back(all[0]);
    z.spin.setZero();
    for (int i = 0; i < n; ++i) z.spin += eigen.vectors(i, k) * all[i].spin;
  }
  return result;
}

/// <R(u^k), psi_a z> = (f, psi_a z) + (g_N, psi_a z)_N - (sigma(u), grad (psi_a z)) + (T(u), psi_a z)_C.
template <int dim>
double residual(const DenseData<dim>& given, const DensePatch<dim>& patch, const Motion<dim>& z)
{
  double sum = 0;
  for (const Index c : patch.cells)
  {
    const DenseCell<dim>& cell = given.cells[c];
    const int i = cell.find(patch.vertex);
    for (std::size_t q = 0; q < cell.x.size(); ++q)
    {
      const double psi = cell.hat(i, cell.x[q]);
      const Point<dim> value = z(cell.x[q]);
      const Tensor<dim> gradient = value * cell.hat_gradient[i].transpose() + psi * z.spin;
      sum += cell.weight[q] * (psi * cell.f[q].dot(value) - cell.sigma[q].cwiseProduct(gradient).sum());
    }
  }
  for (const int f : patch.facets)
  {
    const DenseFacet<dim>& facet = given.facets[f];
    if (!facet.condition) continue;
    const DenseCell<dim>& cell = given.cells[facet.cells[0]];
    for (std::size_t q = 0; q < facet.points.size(); ++q)
    {
      const auto& [x, weight, theta] = facet.points[q];
      sum += weight * cell.hat(cell.find(patch.vertex), x) * facet.traction[q].dot(z(x));
    }
  }
  return sum;
}

/// (t^k - T(u^k), psi_a z)_C.
template <int dim>
double linearisation_work(const DenseData<dim>& given, const DensePatch<dim>& patch, const Motion<dim>& z)
{
  double sum = 0;
  for (const int f : patch.facets)
    for (const DataPoint<dim>& point : given.facets[f].data)
      sum += point.at.weight * patch_traction(given, patch, given.facets[f], point, 1).dot(z(point.at.x));
  return sum;
}

/// y_a, the same for dis and lin, with (y_a, z) = -<R, psi_a z> for the translations and, p > 1,
/// (t^k - T(u^k), psi_a z)_C for the rotations that Gamma_D hardly stops.
template <int dim>
void find_y(const DenseData<dim>& given, DensePatch<dim>& patch)
{
  patch.y.fill({Point<dim>::Zero(), Tensor<dim>::Zero(), given.mesh.vertex(patch.vertex)});
  std::vector<Motion<dim>> z = free_translations(given, patch);
  const std::size_t n_translations = z.size();
  if (given.p > 1)
    for (const Motion<dim>& rotation : hardly_stopped(given, patch)) z.push_back(rotation);
  if (z.empty() || given.mutation == Mutation::no_y) return;
  MatrixXd gram = MatrixXd::Zero(z.size(), z.size());
  VectorXd rhs(z.size());
  for (std::size_t i = 0; i < z.size(); ++i)
  {
    rhs[i] = i < n_translations ? -residual(given, patch, z[i]) : linearisation_work(given, patch, z[i]);
    for (std::size_t j = 0; j < z.size(); ++j)
      for (const Index c : patch.cells)
        for (std::size_t q = 0; q < given.cells[c].x.size(); ++q)
          gram(i, j) += given.cells[c].weight[q] * z[i](given.cells[c].x[q]).dot(z[j](given.cells[c].x[q]));
  }
  const VectorXd y = gram.fullPivLu().solve(rhs);
  for (std::size_t i = 0; i < z.size(); ++i)
    for (Motion<dim>& part : patch.y)
    {
      part.translation += y[i] * z[i].translation;
      part.spin += y[i] * z[i].spin;
    }
}

/// (psi_a sigma(u) n, z) in the fixed components of the Dirichlet facets at the vertex.
template <int dim>
double reaction(const DenseData<dim>& given, const DensePatch<dim>& patch, const Motion<dim>& z)
{
  double sum = 0;
  for (const int f : patch.facets)
  {
    const DenseFacet<dim>& facet = given.facets[f];
    const DenseCell<dim>& cell = given.cells[facet.cells[0]];
    for (int c = 0; c < dim && facet.condition; ++c)
      for (std::size_t q = 0; q < facet.points.size() && facet.condition->fixes(c); ++q)
      {
        const auto& [x, weight, theta] = facet.points[q];
        sum += weight * cell.hat(cell.find(patch.vertex), x) * (cell.sigma[0] * facet.normal)[c] * z(x)[c];
      }
  }
  return sum;
}

/// p = 1: w_a in the span of the gradients of these rotations z, with (w_a, grad z) = (t, z)_{N, C} -
/// (Pi^0 b, z) for lin and (psi_a sigma(u) n, z)_D more for dis.
template <int dim>
void find_w(const DenseData<dim>& given, DensePatch<dim>& patch)
{
  patch.w.fill(Tensor<dim>::Zero());
  const std::vector<Motion<dim>> z = hardly_stopped(given, patch);
  if (given.p > 1 || z.empty()) return;
  double volume = 0;
  for (const Index c : patch.cells)
    for (const double weight : given.cells[c].weight) volume += weight;
  MatrixXd gram(z.size(), z.size());
  MatrixXd rhs = MatrixXd::Zero(z.size(), 2);
  for (std::size_t i = 0; i < z.size(); ++i)
  {
    for (std::size_t j = 0; j < z.size(); ++j) gram(i, j) = volume * z[i].spin.cwiseProduct(z[j].spin).sum();
    rhs(i, 0) = reaction(given, patch, z[i]);
    for (int column = 0; column < 2; ++column)
    {
      for (const Index c : patch.cells)
      {
        Point<dim> total = Point<dim>::Zero();
        Point<dim> moment = Point<dim>::Zero();
        double measure = 0;
        for (std::size_t q = 0; q < given.cells[c].x.size(); ++q)
        {
          total += given.cells[c].weight[q] * patch_b(given, patch, c, static_cast<int>(q), column);
          moment += given.cells[c].weight[q] * z[i](given.cells[c].x[q]);
          measure += given.cells[c].weight[q];
        }
        rhs(i, column) -= total.dot(moment) / measure;
      }
      for (const int f : patch.facets)
        for (const DataPoint<dim>& point : given.facets[f].data)
          rhs(i, column) +=
              point.at.weight *
              patch_traction(given, patch, given.facets[f], point, column).dot(z[i](point.at.x));
    }
  }
  const MatrixXd coefficients = gram.fullPivLu().solve(rhs);
  for (int column = 0; column < 2; ++column)
    for (std::size_t i = 0; i < z.size(); ++i) patch.w[column] += coefficients(i, column) * z[i].spin;
}

}  // namespace

template <int dim>
DensePatch<dim> make_patch(const DenseData<dim>& given, Index vertex)
{
  DensePatch<dim> patch;
  patch.vertex = vertex;
  for (Index c = 0; c < given.mesh.n_cells(); ++c)
    if (given.cells[c].find(vertex) >= 0) patch.cells.push_back(c);
  for (std::size_t f = 0; f < given.facets.size(); ++f)
  {
    const bool touches = std::ranges::any_of(
        given.facets[f].cells, [&](Index c) { return c >= 0 && given.cells[c].find(vertex) >= 0; });
    if (touches)
      (given.facets[f].contains(vertex) ? patch.facets : patch.outer).push_back(static_cast<int>(f));
  }
  find_y(given, patch);
  find_w(given, patch);
  return patch;
}

template <int dim>
Point<dim> patch_b(const DenseData<dim>& given, const DensePatch<dim>& patch, Index c, int q, int column)
{
  const DenseCell<dim>& cell = given.cells[c];
  const int i = cell.find(patch.vertex);
  const Point<dim> y = patch.y[column](cell.x[q]);
  if (column == 1) return given.mutation == Mutation::no_y_in_lin ? Point<dim>::Zero() : y;
  const double sign = given.mutation == Mutation::sign_of_f ? -1 : 1;
  return -sign * cell.hat(i, cell.x[q]) * cell.f[q] + cell.sigma[q] * cell.hat_gradient[i] - y;
}

template <int dim>
Point<dim> patch_traction(const DenseData<dim>& given, const DensePatch<dim>& patch,
                          const DenseFacet<dim>& facet, const DataPoint<dim>& point, int column)
{
  const DenseCell<dim>& cell = given.cells[facet.cells[0]];
  const double sign = column == 0 && given.mutation == Mutation::sign_of_t ? -1 : 1;
  return sign * cell.hat(cell.find(patch.vertex), point.at.x) * point.traction[column];
}

template DensePatch<2> make_patch(const DenseData<2>&, Index);
template Point<2> patch_b(const DenseData<2>&, const DensePatch<2>&, Index, int, int);
template Point<2> patch_traction(const DenseData<2>&, const DensePatch<2>&, const DenseFacet<2>&,
                                 const DataPoint<2>&, int);
template DensePatch<3> make_patch(const DenseData<3>&, Index);
template Point<3> patch_b(const DenseData<3>&, const DensePatch<3>&, Index, int, int);
template Point<3> patch_traction(const DenseData<3>&, const DensePatch<3>&, const DenseFacet<3>&,
                                 const DataPoint<3>&, int);

}  // namespace tribound::test
