#include "support/dense_patch.h"

#include <vector>

#include "support/dense_problem.h"
#include "tribound/base/dense_factors.h"

namespace tribound::test
{

namespace
{

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Unknowns: all stress coefficients of the patch; columns of the right-hand side: dis, lin.
struct System
{
  MatrixXd rows;
  MatrixXd rhs;
  int n = 0;  ///< rows used

  void close_row() { ++n; }
};

/// (div sigma_a, v)_T = (b, v)_T.
template <int dim>
void add_divergence(const DenseData<dim>& given, const DensePatch<dim>& patch, System& system)
{
  for (std::size_t k = 0; k < patch.cells.size(); ++k)
  {
    const DenseCell<dim>& cell = given.cells[patch.cells[k]];
    for (int r = 0; r < dim; ++r)
      for (int i = 0; i < given.m; ++i, system.close_row())
        for (std::size_t q = 0; q < cell.x.size(); ++q)
        {
          const double v = cell.weight[q] * cell.phi[q][i];
          for (int c = 0; c < dim; ++c)
            for (int j = 0; j < given.n; ++j)
              system.rows(system.n, given.column(k, r, c) + j) += v * cell.dphi[q][j][c];
          for (int part = 0; part < 2; ++part)
            system.rhs(system.n, part) +=
                v * patch_b(given, patch, patch.cells[k], static_cast<int>(q), part)[r];
        }
  }
}

/// (sigma_a, q)_T = (w_a, q)_T for skew q.
template <int dim>
void add_symmetry(const DenseData<dim>& given, const DensePatch<dim>& patch, System& system)
{
  for (std::size_t k = 0; k < patch.cells.size(); ++k)
  {
    const DenseCell<dim>& cell = given.cells[patch.cells[k]];
    for (int r = 0; r < dim; ++r)
      for (int c = 0; c < r; ++c)
        for (int i = 0; i < given.m; ++i, system.close_row())
          for (std::size_t q = 0; q < cell.x.size(); ++q)
          {
            const double v = cell.weight[q] * cell.phi[q][i];
            for (int j = 0; j < given.n; ++j)
            {
              system.rows(system.n, given.column(k, r, c) + j) += v * cell.phi[q][j];
              system.rows(system.n, given.column(k, c, r) + j) -= v * cell.phi[q][j];
            }
            for (int part = 0; part < 2; ++part)
              system.rhs(system.n, part) += v * (patch.w[part](r, c) - patch.w[part](c, r));
          }
  }
}

/// Row (sigma_a n, theta_i e_r)_F, with the jump where the patch has both cells.
template <int dim>
void add_trace(const DenseData<dim>& given, const DensePatch<dim>& patch, const DenseFacet<dim>& facet, int r,
               int i, System& system)
{
  for (std::size_t k = 0; k < patch.cells.size(); ++k)
    for (int side = 0; side < 2; ++side)
    {
      if (facet.cells[side] != patch.cells[k]) continue;
      for (const auto& [x, weight, theta] : facet.points)
      {
        const VectorXd phi = given.cells[patch.cells[k]].basis(given.p, x);
        const double v = (side == 0 ? 1 : -1) * weight * theta[i];
        for (int c = 0; c < dim; ++c)
          system.rows.row(system.n).segment(given.column(k, r, c), given.n) +=
              v * facet.normal[c] * phi.transpose();
      }
    }
}

template <int dim>
void add_facets(const DenseData<dim>& given, const DensePatch<dim>& patch, System& system)
{
  const int n = fem::polynomial_dimension(dim - 1, given.p);
  for (const int f : patch.outer)
    for (int r = 0; r < dim; ++r)
      for (int i = 0; i < n; ++i, system.close_row()) add_trace(given, patch, given.facets[f], r, i, system);
  for (const int f : patch.facets)
  {
    const DenseFacet<dim>& facet = given.facets[f];
    for (int r = 0; r < dim; ++r)
    {
      if (facet.condition && facet.condition->fixes(r)) continue;
      for (int i = 0; i < n; ++i, system.close_row())
      {
        add_trace(given, patch, facet, r, i, system);
        for (const DataPoint<dim>& point : facet.data)
          for (int part = 0; part < 2; ++part)
            system.rhs(system.n, part) +=
                point.at.weight * point.at.theta[i] * patch_traction(given, patch, facet, point, part)[r];
      }
    }
  }
}

/// Coefficients of G: psi_a sigma(u) for dis, 0 for lin.
template <int dim>
MatrixXd target(const DenseData<dim>& given, const DensePatch<dim>& patch)
{
  MatrixXd result = MatrixXd::Zero(given.column(patch.cells.size(), 0, 0), 2);
  for (std::size_t k = 0; k < patch.cells.size(); ++k)
  {
    const DenseCell<dim>& cell = given.cells[patch.cells[k]];
    for (std::size_t q = 0; q < cell.x.size(); ++q)
    {
      const double psi = cell.hat(cell.find(patch.vertex), cell.x[q]);
      for (int r = 0; r < dim; ++r)
        for (int c = 0; c < dim; ++c)
          result.col(0).segment(given.column(k, r, c), given.n) +=
              cell.weight[q] * psi * cell.sigma[q](r, c) * cell.phi[q];
    }
  }
  return result;
}

/// sigma_dis and sigma_lin of a patch: sigma_a = G + the smallest correction that meets all conditions; these
/// depend on each other (compatibility), hence the rank-revealing decomposition.
template <int dim>
MatrixXd solve(const DenseData<dim>& given, const DensePatch<dim>& patch)
{
  const MatrixXd goal = target(given, patch);
  const auto n_rows =
      patch.cells.size() * given.m * (dim + dim * (dim - 1) / 2) +
      (patch.facets.size() + patch.outer.size()) * dim * fem::polynomial_dimension(dim - 1, given.p);
  System system{MatrixXd::Zero(n_rows, goal.rows()), MatrixXd::Zero(n_rows, 2)};
  add_divergence(given, patch, system);
  if (!given.by_rows) add_symmetry(given, patch, system);
  add_facets(given, patch, system);
  MatrixXd rows = system.rows.topRows(system.n);
  MatrixXd rhs = system.rhs.topRows(system.n);
  for (int i = 0; i < system.n; ++i)
  {
    const double norm = rows.row(i).norm();
    rows.row(i) /= norm;
    rhs.row(i) /= norm;
  }
  return goal + least_norm_solution(rows, rhs - rows * goal, 1e-10);
}

}  // namespace

template <int dim>
certify::Stress<dim> dense_equilibrate(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                       std::span<const Point<dim>> t, certify::PatchStress patches,
                                       Mutation mutation)
{
  const DenseData<dim> given(form, u, t, patches, mutation);
  certify::Stress<dim> stress;
  stress.degree = given.p;
  stress.n = given.n;
  stress.patches = patches;
  stress.dis.assign(given.mesh.n_cells() * stress.block_size(), 0.0);
  stress.lin.assign(given.mesh.n_cells() * stress.block_size(), 0.0);
  for (Index c = 0; c < given.mesh.n_cells(); ++c) stress.lin_block.push_back(c);
  stress.tractions.dis = form.traction(u);
  stress.tractions.lin.assign(t.begin(), t.end());
  for (std::size_t i = 0; i < t.size(); ++i) stress.tractions.lin[i] -= stress.tractions.dis[i];
  const mesh::BoundaryFacet& first = form.segments().front().slave.facet;
  const Index left_out = given.mesh.cell(first.cell)[(first.local + 1) % (dim + 1)];
  for (Index a = 0; a < given.mesh.n_vertices(); ++a)
  {
    if (mutation == Mutation::one_patch_left_out && a == left_out) continue;
    const DensePatch<dim> patch = make_patch(given, a);
    const MatrixXd sigma = solve(given, patch);
    for (std::size_t k = 0; k < patch.cells.size(); ++k)
      for (std::size_t i = 0; i < stress.block_size(); ++i)
      {
        const std::size_t place = patch.cells[k] * stress.block_size() + i;
        stress.dis[place] += sigma(k * stress.block_size() + i, 0);
        if (mutation != Mutation::no_lin) stress.lin[place] += sigma(k * stress.block_size() + i, 1);
      }
  }
  return stress;
}

template certify::Stress<2> dense_equilibrate(const contact::NitscheForm<2>&, std::span<const double>,
                                              std::span<const Point<2>>, certify::PatchStress, Mutation);
template certify::Stress<3> dense_equilibrate(const contact::NitscheForm<3>&, std::span<const double>,
                                              std::span<const Point<3>>, certify::PatchStress, Mutation);

}  // namespace tribound::test
