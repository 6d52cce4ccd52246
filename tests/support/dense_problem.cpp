#include "support/dense_problem.h"

#include <Eigen/LU>

namespace tribound::test
{

namespace
{

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A basis of the rigid motions of the wanted kinds whose fixed components vanish on the Dirichlet facets at
/// the vertex: the null space of their values at the vertices of these facets.
template <int dim>
std::vector<Motion<dim>> admissible(const DenseData<dim>& given, const DensePatch<dim>& patch,
                                    bool translations, bool rotations)
{
  const Point<dim>& a = given.mesh.vertex(patch.vertex);
  const double size = mesh::cell_diameter(given.mesh, patch.cells[0]);
  std::vector<Motion<dim>> all;
  for (int i = 0; i < dim && translations; ++i) all.push_back({Point<dim>::Unit(i), Tensor<dim>::Zero(), a});
  for (int r = 0; r < dim && rotations; ++r)
    for (int c = 0; c < r; ++c)
    {
      Tensor<dim> spin = Tensor<dim>::Zero();
      spin(r, c) = 1 / size;
      spin(c, r) = -1 / size;
      all.push_back({Point<dim>::Zero(), spin, a});
    }
  std::vector<VectorXd> conditions;
  for (const int f : patch.facets)
    for (int c = 0; c < dim && given.facets[f].condition; ++c)
      for (const Index v : given.facets[f].vertices)
      {
        if (!given.facets[f].condition->fixes(c)) continue;
        VectorXd& row = conditions.emplace_back(all.size());
        for (std::size_t i = 0; i < all.size(); ++i) row[i] = all[i](given.mesh.vertex(v))[c];
      }
  if (conditions.empty()) return all;
  MatrixXd matrix(conditions.size(), all.size());
  for (std::size_t i = 0; i < conditions.size(); ++i) matrix.row(i) = conditions[i].transpose();
  Eigen::FullPivLU<MatrixXd> lu(matrix);
  lu.setThreshold(1e-9);
  if (lu.dimensionOfKernel() == 0) return {};
  const MatrixXd kernel = lu.kernel();
  std::vector<Motion<dim>> result;
  for (int k = 0; k < kernel.cols(); ++k)
  {
    Motion<dim>& z = result.emplace_back(Motion<dim>{Point<dim>::Zero(), Tensor<dim>::Zero(), a});
    for (std::size_t i = 0; i < all.size(); ++i)
    {
      z.translation += kernel(i, k) * all[i].translation;
      z.spin += kernel(i, k) * all[i].spin;
    }
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

/// y_a in Z_a with (y_a, z) = -<R, psi_a z>, the same for dis and lin.
template <int dim>
void find_y(const DenseData<dim>& given, DensePatch<dim>& patch)
{
  patch.y.fill({Point<dim>::Zero(), Tensor<dim>::Zero(), given.mesh.vertex(patch.vertex)});
  const std::vector<Motion<dim>> z = admissible(given, patch, true, given.p > 1);
  if (z.empty() || given.mutation == Mutation::no_y) return;
  MatrixXd gram = MatrixXd::Zero(z.size(), z.size());
  VectorXd rhs(z.size());
  for (std::size_t i = 0; i < z.size(); ++i)
  {
    rhs[i] = -residual(given, patch, z[i]);
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

/// p = 1: w_a in the span of the gradients of the admissible rotations z about a, with
/// (w_a, grad z) = (t, z)_{N, C} - (Pi^0 b, z), for dis and for lin.
template <int dim>
void find_w(const DenseData<dim>& given, DensePatch<dim>& patch)
{
  patch.w.fill(Tensor<dim>::Zero());
  const std::vector<Motion<dim>> z = admissible(given, patch, false, true);
  if (given.p > 1 || z.empty()) return;
  double volume = 0;
  for (const Index c : patch.cells)
    for (const double weight : given.cells[c].weight) volume += weight;
  MatrixXd gram(z.size(), z.size());
  MatrixXd rhs = MatrixXd::Zero(z.size(), 2);
  for (std::size_t i = 0; i < z.size(); ++i)
  {
    for (std::size_t j = 0; j < z.size(); ++j) gram(i, j) = volume * z[i].spin.cwiseProduct(z[j].spin).sum();
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
