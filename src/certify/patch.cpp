#include "certify/patch.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"

namespace tribound
{

template <int dim, int p>
void Patch<dim, p>::begin(Index vertex)
{
  vertex_ = vertex;
  size_ = 0;
  cells_.clear();
  facets_.clear();
  facet_scale_.clear();
  fixed_facets_.clear();
}

template <int dim, int p>
void Patch<dim, p>::add_cell(Index cell, const PreparedCell<dim, p>& prepared)
{
  const Frame<dim>& frame = prepared.frame;
  CellPart& part = cells_.emplace_back();
  part.cell = cell;
  part.vertex = frame.find(vertex_);
  part.prepared = &prepared;
  const auto& numbers = mesh_.topology().cell_facets[cell];
  for (int f = 0; f <= dim; ++f)
  {
    part.facets[f] = -1;
    if (f == part.vertex) continue;
    const Index facet = numbers[frame.local[f]];
    const auto known = std::ranges::find(facets_, facet);
    part.facets[f] = static_cast<int>(known - facets_.begin());
    if (known != facets_.end()) continue;
    facets_.push_back(facet);
    facet_scale_.push_back(frame.facet_scale(f));
  }
  size_ = std::max(size_, 1 / frame.grad_norm[part.vertex]);  // the height of the cell above the vertex
}

template <int dim, int p>
void Patch<dim, p>::solve()
{
  find_rigid_motions();
  find_multipliers_of_divergence();
  find_skew_part();
  assemble();
  const int last = matrix_.order();
  fix_rigid_motions(last);
  if (!matrix_.factor())
    throw SolveError("the patch of vertex " + std::to_string(vertex_) + " has no equilibrated stress");
  matrix_.solve(x_);
  for (std::size_t k = 0; k < cells_.size(); ++k)
  {
    FacetColumns& outer = cells_[k].outer;
    outer = condensed_[k].outer_load;
    for (int f = 0; f <= dim; ++f)
      if (f != cells_[k].vertex) outer.noalias() -= condensed_[k].coupling[f] * x_[cells_[k].facets[f]];
    condensed_[k].outer.matrixU().solveInPlace(outer);
  }
}

template <int dim, int p>
void Patch<dim, p>::find_rigid_motions()
{
  for (const Index facet : facets_)
  {
    if (!data_.is_boundary(facet) || !data_.fixes_any(facet)) continue;
    FixedFacet<dim>& fixed = fixed_facets_.emplace_back();
    for (int v = 0; v < dim; ++v) fixed.vertices[v] = mesh_.vertex(mesh_.topology().facets[facet][v]);
    for (int c = 0; c < dim; ++c) fixed.fixed[c] = data_.fixes(facet, c);
  }
  motions_ = RigidMotions<dim>(mesh_.vertex(vertex_), size_, fixed_facets_);
}

/// Coefficients of motion i in U on a cell (for p = 1 of its mean).
template <int dim, int p>
auto Patch<dim, p>::moments_on_cell(const Frame<dim>& frame, int motion) const -> UVector
{
  const auto& hat = reference<dim, p>().hat_moment;
  UVector moments = UVector::Zero();
  const double scale = std::sqrt(frame.det);
  for (int v = 0; v <= dim; ++v)
  {
    const Point<dim> z = scale * motions_(motion, mesh_.vertex(frame.vertices[v]));
    for (int c = 0; c < dim; ++c)
      moments.template segment<S::multiplier>(c * S::multiplier) += z[c] * hat.col(v);
  }
  return moments;
}

/// Coefficients of motion i in P^p(F)^d.
template <int dim, int p>
Eigen::Matrix<double, Sizes<dim, p>::block, 1> Patch<dim, p>::moments_on_facet(Index facet, int motion) const
{
  const auto& hat = reference<dim, p>().facet_hat_moment;
  Eigen::Matrix<double, S::block, 1> moments = Eigen::Matrix<double, S::block, 1>::Zero();
  const auto place = std::ranges::find(facets_, facet) - facets_.begin();
  const double scale = std::sqrt(facet_scale_[place]);
  for (int v = 0; v < dim; ++v)
  {
    const Point<dim> z = scale * motions_(motion, mesh_.vertex(mesh_.topology().facets[facet][v]));
    for (int c = 0; c < dim; ++c) moments.template segment<S::facet>(c * S::facet) += z[c] * hat.col(v);
  }
  return moments;
}

/// (-psi_a f + sigma(u^k) grad psi_a, v)_T for v in U.
template <int dim, int p>
auto Patch<dim, p>::raw_load(const CellPart& part) const -> UVector
{
  const PreparedCell<dim, p>& cell = *part.prepared;
  UVector load = -cell.body[part.vertex];
  const Point<dim>& gradient = cell.frame.grad[part.vertex];
  for (int r = 0; r < dim; ++r)
    for (int c = 0; c < dim; ++c)
      load.template segment<S::multiplier>(r * S::multiplier) += gradient[c] * cell.sigma.col(dim * r + c);
  return load;
}

template <int dim, int p>
int Patch<dim, p>::local_vertex(Index facet) const
{
  const auto& vertices = mesh_.topology().facets[facet];
  return static_cast<int>(std::ranges::find(vertices, vertex_) - vertices.begin());
}

/// (t, z)_F for motion z and the traction of the dis (0) or lin (1) problem.
template <int dim, int p>
double Patch<dim, p>::traction_work(Index facet, int column, int motion) const
{
  if (!data_.is_boundary(facet)) return 0;
  const auto* moments = column == 0 ? data_.discretisation(facet) : data_.linearisation(facet);
  return moments ? (*moments)[local_vertex(facet)].dot(moments_on_facet(facet, motion)) : 0;
}

/// y_a in Z_a (rigid motions; constants for p = 1) with (y_a, z) = -<R(u^k), psi_a z> = (b, z) - (t, z) for
/// the dis problem, and (y_lin, z) = (t^k - T(u^k), psi_a z)_C for the lin problem.
template <int dim, int p>
void Patch<dim, p>::find_multipliers_of_divergence()
{
  y_.setZero();
  const int n = p == 1 ? motions_.n_translations() : motions_.size();
  if (n == 0) return;
  using Gram = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, S::rigid, S::rigid>;
  Gram gram = Gram::Zero(n, n);
  Eigen::Matrix<double, Eigen::Dynamic, 2, 0, S::rigid, 2> rhs(n, 2);
  rhs.setZero();
  std::array<UVector, S::rigid> z;
  for (const CellPart& part : cells_)
  {
    const UVector load = raw_load(part);
    for (int i = 0; i < n; ++i)
    {
      z[i] = moments_on_cell(part.prepared->frame, i);
      rhs(i, 0) += load.dot(z[i]);
      for (int j = 0; j <= i; ++j) gram(i, j) += z[i].dot(z[j]);
    }
  }
  for (const Index facet : facets_)
    for (int i = 0; i < n; ++i)
    {
      rhs(i, 0) -= traction_work(facet, 0, i);
      rhs(i, 1) += traction_work(facet, 1, i);
    }
  y_.topRows(n) = gram.template selfadjointView<Eigen::Lower>().ldlt().solve(rhs);
}

template <int dim, int p>
RigidField<dim> Patch<dim, p>::y(int column) const
{
  RigidField<dim> field{Point<dim>::Zero(), Tensor<dim>::Zero()};
  for (int i = 0; i < motions_.size(); ++i)
  {
    field.translation += y_(i, column) * motions_(i, mesh_.vertex(vertex_));
    field.gradient += y_(i, column) * motions_.gradient(i);
  }
  return field;
}

/// w_a for p = 1: in the span of grad z of the admissible rotations z, with
/// (w_a, grad z) = (t, z)_{N, C} - (Pi^0 b, z).
template <int dim, int p>
void Patch<dim, p>::find_skew_part()
{
  w_.fill(Tensor<dim>::Zero());
  const int n = motions_.n_rotations();
  if (p > 1 || n == 0) return;
  const int first = motions_.n_translations();
  Eigen::Matrix<double, Eigen::Dynamic, 2, 0, 3, 2> rhs(n, 2);
  rhs.setZero();
  double volume = 0;
  for (const CellPart& part : cells_)
  {
    const Frame<dim>& frame = part.prepared->frame;
    double reference_volume = 1;
    for (int k = 2; k <= dim; ++k) reference_volume /= k;
    volume += frame.det * reference_volume;
    UVector y_dis = UVector::Zero();
    UVector y_lin = UVector::Zero();
    for (int i = 0; i < first; ++i)
    {
      const UVector z = moments_on_cell(frame, i);
      y_dis += y_(i, 0) * z;
      y_lin += y_(i, 1) * z;
    }
    const UVector b_dis = raw_load(part) - y_dis;
    for (int i = 0; i < n; ++i)
    {
      const UVector z = moments_on_cell(frame, first + i);
      rhs(i, 0) -= b_dis.dot(z);
      rhs(i, 1) -= y_lin.dot(z);
    }
  }
  for (const Index facet : facets_)
    for (int i = 0; i < n; ++i)
      for (int column = 0; column < 2; ++column) rhs(i, column) += traction_work(facet, column, first + i);

  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> gram(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      gram(i, j) = volume * motions_.gradient(first + i).cwiseProduct(motions_.gradient(first + j)).sum();
  const auto coefficients = gram.ldlt().solve(rhs).eval();
  for (int column = 0; column < 2; ++column)
    for (int i = 0; i < n; ++i) w_[column] += coefficients(i, column) * motions_.gradient(first + i);
}

template <int dim, int p>
void Patch<dim, p>::assemble()
{
  matrix_.reset(static_cast<int>(facets_.size()));
  x_.assign(facets_.size(), FacetColumns::Zero());
  if (condensed_.size() < cells_.size()) condensed_.resize(cells_.size());
  for (std::size_t k = 0; k < cells_.size(); ++k)
  {
    condense(k);
    assemble_loads(k);
  }
  for (std::size_t i = 0; i < facets_.size(); ++i)
  {
    if (!data_.is_boundary(facets_[i])) continue;
    const int v = local_vertex(facets_[i]);
    if (const auto* t = data_.discretisation(facets_[i])) x_[i].col(0) -= (*t)[v];
    if (const auto* t = data_.linearisation(facets_[i])) x_[i].col(1) -= (*t)[v];
    decouple_fixed_components(static_cast<int>(i));
  }
}

/// Eliminates the multiplier of the outer facet o: S(f, g) - S(f, o) S(o, o)^{-1} S(o, g).
template <int dim, int p>
void Patch<dim, p>::condense(std::size_t k)
{
  const CellPart& part = cells_[k];
  const CellOperator<dim, p>& op = part.prepared->op;
  Condensed& condensed = condensed_[k];
  const int o = part.vertex;
  condensed.outer.compute(op.schur(o, o));
  for (int f = 0; f <= dim; ++f)
  {
    if (f == o) continue;
    BlockMatrix& coupling = condensed.coupling[f];
    if (o < f)
      coupling = op.schur(o, f);
    else
      coupling = op.schur(f, o).transpose();
    condensed.outer.matrixL().solveInPlace(coupling);
  }
  for (int f = 0; f <= dim; ++f)
    for (int g = f; g <= dim; ++g)
    {
      if (f == o || g == o) continue;
      BlockMatrix block = op.schur(f, g);
      block.noalias() -= condensed.coupling[f].transpose() * condensed.coupling[g];
      const int i = part.facets[f];
      const int j = part.facets[g];
      if (i <= j)
        matrix_.block(i, j) += block;
      else
        matrix_.block(j, i) += block.transpose();
    }
}

/// g = N G - C^T (B B^T)^{-1} r with the outer facet eliminated. With div G = psi_a div sigma + sigma grad
/// psi_a, r is (psi_a (div sigma + f) + y_a, v) on U and -(w_a, q) on Lambda for dis; (-y_lin, v) and
/// -(w_lin, q) for lin.
template <int dim, int p>
void Patch<dim, p>::assemble_loads(std::size_t k)
{
  constexpr int m = S::multiplier;
  constexpr int n = S::facet;
  const CellPart& part = cells_[k];
  const PreparedCell<dim, p>& cell = *part.prepared;
  const Frame<dim>& frame = cell.frame;
  const Reference<dim, p>& ref = reference<dim, p>();
  const int o = part.vertex;

  std::array<UVector, 2> r_u{cell.body[o], UVector::Zero()};
  for (int r = 0; r < dim; ++r)
    r_u[0].template segment<m>(r * m) += ref.hat[o] * cell.divergence.template segment<m>(r * m);
  for (int i = 0; i < motions_.size(); ++i)
  {
    if (y_.row(i).isZero(0)) continue;
    const UVector z = moments_on_cell(frame, i);
    r_u[0] += y_(i, 0) * z;
    r_u[1] -= y_(i, 1) * z;
  }

  std::array<FacetColumns, dim + 1> load;
  for (int column = 0; column < 2; ++column)
  {
    RotationVector r_rotation = RotationVector::Zero();
    for (int i = 0; i < S::pairs; ++i)
      if (p == 1)
        r_rotation[i] = -2 * w_[column](skew_pairs<dim>[i][0], skew_pairs<dim>[i][1]) * std::sqrt(frame.det) *
                        ref.hat_moment.row(0).sum();
    const UVector reduced = cell.op.reduce(r_u[column], r_rotation);
    for (int f = 0; f <= dim; ++f)
    {
      load[f].col(column) = -cell.op.facet_part(f, reduced);
      if (p == 1) load[f].col(column) -= cell.op.rotation_part(f, r_rotation);
    }
  }
  for (int f = 0; f <= dim; ++f)
  {
    if (f == o) continue;
    for (int r = 0; r < dim; ++r)  // N (psi_a sigma)
    {
      Eigen::Matrix<double, m, 1> normal = Eigen::Matrix<double, m, 1>::Zero();
      for (int c = 0; c < dim; ++c) normal += frame.grad[f][c] * cell.sigma.col(dim * r + c);
      load[f].col(0).template segment<n>(r * n) -=
          ref.hat_trace[f][o] * normal / std::sqrt(frame.grad_norm[f]);
    }
  }
  condensed_[k].outer.matrixL().solveInPlace(load[o]);
  condensed_[k].outer_load = load[o];
  for (int f = 0; f <= dim; ++f)
    if (f != o) x_[part.facets[f]] += load[f] - condensed_[k].coupling[f].transpose() * load[o];
}

/// Where Gamma_D fixes a component the normal trace is free: its multiplier is 0.
template <int dim, int p>
void Patch<dim, p>::decouple_fixed_components(int place)
{
  for (int c = 0; c < dim; ++c)
  {
    if (!data_.fixes(facets_[place], c)) continue;
    matrix_.template decouple<S::facet>(place, c * S::facet);
    x_[place].template middleRows<S::facet>(c * S::facet).setZero();
  }
}

/// Multipliers that are the trace of an admissible rigid motion change nothing: makes the matrix definite by
/// a term on one facet, which the solution, the data being compatible, does not feel.
template <int dim, int p>
void Patch<dim, p>::fix_rigid_motions(int place)
{
  auto& diagonal = matrix_.block(place, place);
  const double scale = diagonal.trace() / S::block;
  for (int i = 0; i < motions_.size(); ++i)
  {
    Eigen::Matrix<double, S::block, 1> trace = moments_on_facet(facets_[place], i);
    if (data_.is_boundary(facets_[place]))
      for (int c = 0; c < dim; ++c)
        if (data_.fixes(facets_[place], c)) trace.template segment<S::facet>(c * S::facet).setZero();
    diagonal += (scale / trace.squaredNorm()) * trace * trace.transpose();
  }
}

template class Patch<2, 1>;
template class Patch<2, 2>;
template class Patch<2, 3>;
template class Patch<2, 4>;
template class Patch<3, 1>;
template class Patch<3, 2>;
template class Patch<3, 3>;
template class Patch<3, 4>;

}  // namespace tribound
