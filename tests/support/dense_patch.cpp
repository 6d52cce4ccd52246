#include "support/dense_patch.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <vector>

#include "support/dense_data.h"

namespace tribound::test
{

namespace
{

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A rigid motion translation + spin (x - a).
template <int dim>
struct Motion
{
  Point<dim> translation;
  Tensor<dim> spin;
  Point<dim> centre;

  [[nodiscard]] Point<dim> operator()(const Point<dim>& x) const { return translation + spin * (x - centre); }
};

template <int dim>
class DenseKernel
{
 public:
  DenseKernel(const NitscheForm<dim>& form, std::span<const double> u, std::span<const Point<dim>> t,
              Mutation mutation)
      : form_(form),
        mesh_(form.space().mesh()),
        mutation_(mutation),
        p_(form.space().degree()),
        n_(polynomial_dimension(dim, p_)),
        m_(polynomial_dimension(dim, p_ - 1)),
        cells_(dense_cells(form, u)),
        facets_(dense_facets(form, u, t, mutation))
  {
  }

  [[nodiscard]] Stress<dim> run() const;

 private:
  struct Patch
  {
    Index vertex;
    std::vector<Index> cells;
    std::vector<int> facets;       ///< those that contain the vertex
    std::vector<int> outer;        ///< the others
    std::array<Motion<dim>, 2> y;  ///< y_a of dis and lin
    std::array<Tensor<dim>, 2> w;  ///< w_a
  };
  /// Unknowns: all stress coefficients of the patch; columns of the right-hand side: dis, lin.
  struct System
  {
    MatrixXd rows;
    MatrixXd rhs;
    int n = 0;  ///< rows used

    void close_row() { ++n; }
  };

  Patch make_patch(Index vertex) const;
  std::vector<Motion<dim>> admissible(const Patch& patch, bool translations, bool rotations) const;
  double residual(const Patch& patch, const Motion<dim>& z) const;
  void find_y(Patch& patch) const;
  void find_w(Patch& patch) const;
  Point<dim> b(const Patch& patch, Index c, int q, int column) const;
  Point<dim> patch_traction(const Patch& patch, const DenseFacet<dim>& facet, const DataPoint<dim>& point,
                            int column) const;
  void add_divergence(const Patch& patch, System& system) const;
  void add_symmetry(const Patch& patch, System& system) const;
  void add_facets(const Patch& patch, System& system) const;
  void add_trace(const Patch& patch, const DenseFacet<dim>& facet, int r, int i, System& system) const;
  MatrixXd target(const Patch& patch) const;
  MatrixXd solve(const Patch& patch) const;
  [[nodiscard]] int column(std::size_t place, int r, int c) const
  {
    return ((static_cast<int>(place) * dim + r) * dim + c) * n_;
  }

  const NitscheForm<dim>& form_;
  const Mesh<dim>& mesh_;
  Mutation mutation_;
  int p_;
  int n_;  ///< dim P^p(T)
  int m_;  ///< dim P^{p-1}(T)
  std::vector<DenseCell<dim>> cells_;
  std::vector<DenseFacet<dim>> facets_;  ///< as numbered by the topology
};

template <int dim>
typename DenseKernel<dim>::Patch DenseKernel<dim>::make_patch(Index vertex) const
{
  Patch patch;
  patch.vertex = vertex;
  for (Index c = 0; c < mesh_.n_cells(); ++c)
    if (cells_[c].find(vertex) >= 0) patch.cells.push_back(c);
  for (std::size_t f = 0; f < facets_.size(); ++f)
  {
    const bool touches =
        std::ranges::any_of(facets_[f].cells, [&](Index c) { return c >= 0 && cells_[c].find(vertex) >= 0; });
    if (touches) (facets_[f].contains(vertex) ? patch.facets : patch.outer).push_back(static_cast<int>(f));
  }
  find_y(patch);
  find_w(patch);
  return patch;
}

/// A basis of the rigid motions of the wanted kinds whose fixed components vanish on the Dirichlet facets at
/// the vertex: the null space of their values at the vertices of these facets.
template <int dim>
std::vector<Motion<dim>> DenseKernel<dim>::admissible(const Patch& patch, bool translations,
                                                      bool rotations) const
{
  const Point<dim>& a = mesh_.vertex(patch.vertex);
  const double size = cell_diameter(mesh_, patch.cells[0]);
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
    for (int c = 0; c < dim && facets_[f].condition; ++c)
      for (const Index v : facets_[f].vertices)
      {
        if (!facets_[f].condition->fixes(c)) continue;
        VectorXd& row = conditions.emplace_back(all.size());
        for (std::size_t i = 0; i < all.size(); ++i) row[i] = all[i](mesh_.vertex(v))[c];
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
double DenseKernel<dim>::residual(const Patch& patch, const Motion<dim>& z) const
{
  double sum = 0;
  for (const Index c : patch.cells)
  {
    const DenseCell<dim>& cell = cells_[c];
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
    const DenseFacet<dim>& facet = facets_[f];
    if (!facet.condition) continue;
    const DenseCell<dim>& cell = cells_[facet.cells[0]];
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
void DenseKernel<dim>::find_y(Patch& patch) const
{
  patch.y.fill({Point<dim>::Zero(), Tensor<dim>::Zero(), mesh_.vertex(patch.vertex)});
  const std::vector<Motion<dim>> z = admissible(patch, true, p_ > 1);
  if (z.empty() || mutation_ == Mutation::no_y) return;
  MatrixXd gram = MatrixXd::Zero(z.size(), z.size());
  VectorXd rhs(z.size());
  for (std::size_t i = 0; i < z.size(); ++i)
  {
    rhs[i] = -residual(patch, z[i]);
    for (std::size_t j = 0; j < z.size(); ++j)
      for (const Index c : patch.cells)
        for (std::size_t q = 0; q < cells_[c].x.size(); ++q)
          gram(i, j) += cells_[c].weight[q] * z[i](cells_[c].x[q]).dot(z[j](cells_[c].x[q]));
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
void DenseKernel<dim>::find_w(Patch& patch) const
{
  patch.w.fill(Tensor<dim>::Zero());
  const std::vector<Motion<dim>> z = admissible(patch, false, true);
  if (p_ > 1 || z.empty()) return;
  double volume = 0;
  for (const Index c : patch.cells)
    for (const double weight : cells_[c].weight) volume += weight;
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
        for (std::size_t q = 0; q < cells_[c].x.size(); ++q)
        {
          total += cells_[c].weight[q] * b(patch, c, static_cast<int>(q), column);
          moment += cells_[c].weight[q] * z[i](cells_[c].x[q]);
          measure += cells_[c].weight[q];
        }
        rhs(i, column) -= total.dot(moment) / measure;
      }
      for (const int f : patch.facets)
        for (const DataPoint<dim>& point : facets_[f].data)
          rhs(i, column) +=
              point.at.weight * patch_traction(patch, facets_[f], point, column).dot(z[i](point.at.x));
    }
  }
  const MatrixXd coefficients = gram.fullPivLu().solve(rhs);
  for (int column = 0; column < 2; ++column)
    for (std::size_t i = 0; i < z.size(); ++i) patch.w[column] += coefficients(i, column) * z[i].spin;
}

/// -psi_a f + sigma(u) grad psi_a - y_a for dis, y_a for lin.
template <int dim>
Point<dim> DenseKernel<dim>::b(const Patch& patch, Index c, int q, int column) const
{
  const DenseCell<dim>& cell = cells_[c];
  const int i = cell.find(patch.vertex);
  const Point<dim> y = patch.y[column](cell.x[q]);
  if (column == 1) return mutation_ == Mutation::no_y_in_lin ? Point<dim>::Zero() : y;
  const double sign = mutation_ == Mutation::sign_of_f ? -1 : 1;
  return -sign * cell.hat(i, cell.x[q]) * cell.f[q] + cell.sigma[q] * cell.hat_gradient[i] - y;
}

/// psi_a g_N or psi_a T(u) for dis, psi_a (t^k - T(u)) for lin.
template <int dim>
Point<dim> DenseKernel<dim>::patch_traction(const Patch& patch, const DenseFacet<dim>& facet,
                                            const DataPoint<dim>& point, int column) const
{
  const DenseCell<dim>& cell = cells_[facet.cells[0]];
  const double sign = column == 0 && mutation_ == Mutation::sign_of_t ? -1 : 1;
  return sign * cell.hat(cell.find(patch.vertex), point.at.x) * point.traction[column];
}

/// (div sigma_a, v)_T = (b, v)_T.
template <int dim>
void DenseKernel<dim>::add_divergence(const Patch& patch, System& system) const
{
  for (std::size_t k = 0; k < patch.cells.size(); ++k)
  {
    const DenseCell<dim>& cell = cells_[patch.cells[k]];
    for (int r = 0; r < dim; ++r)
      for (int i = 0; i < m_; ++i, system.close_row())
        for (std::size_t q = 0; q < cell.x.size(); ++q)
        {
          const double v = cell.weight[q] * cell.phi[q][i];
          for (int c = 0; c < dim; ++c)
            for (int j = 0; j < n_; ++j) system.rows(system.n, column(k, r, c) + j) += v * cell.dphi[q][j][c];
          for (int part = 0; part < 2; ++part)
            system.rhs(system.n, part) += v * b(patch, patch.cells[k], static_cast<int>(q), part)[r];
        }
  }
}

/// (sigma_a, q)_T = (w_a, q)_T for skew q.
template <int dim>
void DenseKernel<dim>::add_symmetry(const Patch& patch, System& system) const
{
  for (std::size_t k = 0; k < patch.cells.size(); ++k)
  {
    const DenseCell<dim>& cell = cells_[patch.cells[k]];
    for (int r = 0; r < dim; ++r)
      for (int c = 0; c < r; ++c)
        for (int i = 0; i < m_; ++i, system.close_row())
          for (std::size_t q = 0; q < cell.x.size(); ++q)
          {
            const double v = cell.weight[q] * cell.phi[q][i];
            for (int j = 0; j < n_; ++j)
            {
              system.rows(system.n, column(k, r, c) + j) += v * cell.phi[q][j];
              system.rows(system.n, column(k, c, r) + j) -= v * cell.phi[q][j];
            }
            for (int part = 0; part < 2; ++part)
              system.rhs(system.n, part) += v * (patch.w[part](r, c) - patch.w[part](c, r));
          }
  }
}

/// Row (sigma_a n, theta_i e_r)_F, with the jump where the patch has both cells.
template <int dim>
void DenseKernel<dim>::add_trace(const Patch& patch, const DenseFacet<dim>& facet, int r, int i,
                                 System& system) const
{
  for (std::size_t k = 0; k < patch.cells.size(); ++k)
    for (int side = 0; side < 2; ++side)
    {
      if (facet.cells[side] != patch.cells[k]) continue;
      for (const auto& [x, weight, theta] : facet.points)
      {
        const VectorXd phi = cells_[patch.cells[k]].basis(p_, x);
        const double v = (side == 0 ? 1 : -1) * weight * theta[i];
        for (int c = 0; c < dim; ++c)
          system.rows.row(system.n).segment(column(k, r, c), n_) += v * facet.normal[c] * phi.transpose();
      }
    }
}

template <int dim>
void DenseKernel<dim>::add_facets(const Patch& patch, System& system) const
{
  const int n = polynomial_dimension(dim - 1, p_);
  for (const int f : patch.outer)
    for (int r = 0; r < dim; ++r)
      for (int i = 0; i < n; ++i, system.close_row()) add_trace(patch, facets_[f], r, i, system);
  for (const int f : patch.facets)
  {
    const DenseFacet<dim>& facet = facets_[f];
    for (int r = 0; r < dim; ++r)
    {
      if (facet.condition && facet.condition->fixes(r)) continue;
      for (int i = 0; i < n; ++i, system.close_row())
      {
        add_trace(patch, facet, r, i, system);
        for (const DataPoint<dim>& point : facet.data)
          for (int part = 0; part < 2; ++part)
            system.rhs(system.n, part) +=
                point.at.weight * point.at.theta[i] * patch_traction(patch, facet, point, part)[r];
      }
    }
  }
}

/// Coefficients of G: psi_a sigma(u) for dis, 0 for lin.
template <int dim>
MatrixXd DenseKernel<dim>::target(const Patch& patch) const
{
  MatrixXd result = MatrixXd::Zero(column(patch.cells.size(), 0, 0), 2);
  for (std::size_t k = 0; k < patch.cells.size(); ++k)
  {
    const DenseCell<dim>& cell = cells_[patch.cells[k]];
    for (std::size_t q = 0; q < cell.x.size(); ++q)
    {
      const double psi = cell.hat(cell.find(patch.vertex), cell.x[q]);
      for (int r = 0; r < dim; ++r)
        for (int c = 0; c < dim; ++c)
          result.col(0).segment(column(k, r, c), n_) +=
              cell.weight[q] * psi * cell.sigma[q](r, c) * cell.phi[q];
    }
  }
  return result;
}

/// sigma_a = G + the smallest correction that meets all conditions; these depend on each other
/// (compatibility), hence the rank-revealing decomposition.
template <int dim>
MatrixXd DenseKernel<dim>::solve(const Patch& patch) const
{
  const MatrixXd goal = target(patch);
  const auto n_rows = patch.cells.size() * m_ * (dim + dim * (dim - 1) / 2) +
                      (patch.facets.size() + patch.outer.size()) * dim * polynomial_dimension(dim - 1, p_);
  System system{MatrixXd::Zero(n_rows, goal.rows()), MatrixXd::Zero(n_rows, 2)};
  add_divergence(patch, system);
  add_symmetry(patch, system);
  add_facets(patch, system);
  MatrixXd rows = system.rows.topRows(system.n);
  MatrixXd rhs = system.rhs.topRows(system.n);
  for (int i = 0; i < system.n; ++i)
  {
    const double norm = rows.row(i).norm();
    rows.row(i) /= norm;
    rhs.row(i) /= norm;
  }
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition;
  decomposition.setThreshold(1e-10);
  decomposition.compute(rows);
  return goal + decomposition.solve(rhs - rows * goal);
}

template <int dim>
Stress<dim> DenseKernel<dim>::run() const
{
  Stress<dim> stress;
  stress.degree = p_;
  stress.n = n_;
  stress.dis.assign(mesh_.n_cells() * stress.block_size(), 0.0);
  stress.lin.assign(mesh_.n_cells() * stress.block_size(), 0.0);
  for (Index c = 0; c < mesh_.n_cells(); ++c) stress.lin_place.push_back(c);
  const BoundaryFacet& first = form_.contact_facets().front().facet;
  const Index left_out = mesh_.cell(first.cell)[(first.local + 1) % (dim + 1)];
  for (Index a = 0; a < mesh_.n_vertices(); ++a)
  {
    if (mutation_ == Mutation::one_patch_left_out && a == left_out) continue;
    const Patch patch = make_patch(a);
    const MatrixXd sigma = solve(patch);
    for (std::size_t k = 0; k < patch.cells.size(); ++k)
      for (std::size_t i = 0; i < stress.block_size(); ++i)
      {
        const std::size_t place = patch.cells[k] * stress.block_size() + i;
        stress.dis[place] += sigma(k * stress.block_size() + i, 0);
        if (mutation_ != Mutation::no_lin) stress.lin[place] += sigma(k * stress.block_size() + i, 1);
      }
  }
  return stress;
}

}  // namespace

template <int dim>
Stress<dim> dense_equilibrate(const NitscheForm<dim>& form, std::span<const double> u,
                              std::span<const Point<dim>> t, Mutation mutation)
{
  return DenseKernel<dim>(form, u, t, mutation).run();
}

template Stress<2> dense_equilibrate(const NitscheForm<2>&, std::span<const double>,
                                     std::span<const Point<2>>, Mutation);
template Stress<3> dense_equilibrate(const NitscheForm<3>&, std::span<const double>,
                                     std::span<const Point<3>>, Mutation);

}  // namespace tribound::test
