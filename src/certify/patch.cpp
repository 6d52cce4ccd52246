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
  n_problems_ = data_.on_contact(vertex) ? 2 : 1;
  size_ = 0;
  n_cells_ = 0;
  found_.clear();
  fixed_facets_.clear();
}

template <int dim, int p>
void Patch<dim, p>::add_cell(Index cell, const PreparedCell<dim, p>& prepared,
                             std::span<CellShare<dim, p>, 2> shares)
{
  const Frame<dim>& frame = prepared.frame;
  if (n_cells_ == static_cast<int>(cells_.size()))
    cells_.push_back({0, {}, nullptr, shares, nullptr, {}, {}});
  CellPart& part = cells_[n_cells_++];
  part.vertex = frame.find(vertex_);
  part.prepared = &prepared;
  part.shares = shares;
  const auto& numbers = mesh_.topology().cell_facets[cell];
  for (int f = 0; f <= dim; ++f)
  {
    part.facets[f] = -1;
    if (f == part.vertex) continue;
    const Index facet = numbers[frame.local[f]];
    const auto known = std::ranges::find(found_, facet, &PatchFacet::number);
    part.facets[f] = static_cast<int>(known - found_.begin());
    if (known == found_.end()) found_.push_back({facet, frame.facet_scale(f)});
  }
  size_ = std::max(size_, 1 / frame.grad_norm[part.vertex]);  // the height of the cell above the vertex
}

template <int dim, int p>
void Patch<dim, p>::solve()
{
  order_facets();
  find_rigid_motions();
  const Moments moments = integrate();
  find_divergence_part(moments);
  find_skew_part(moments);
  assemble();
  fix_rigid_motions(static_cast<int>(facets_.size()) - 1);
  if (!matrix_.factor())
    throw SolveError("the patch of vertex " + std::to_string(vertex_) + " has no equilibrated stress");
  for (int problem = 0; problem < n_problems_; ++problem)
  {
    matrix_.solve(std::span(x_[problem]).first(facets_.size()));
    for (int k = 0; k < n_cells_; ++k) recover(cells_[k], problem);
  }
}

/// Renames the facets by the order of elimination.
template <int dim, int p>
void Patch<dim, p>::order_facets()
{
  matrix_.reset(static_cast<int>(found_.size()));
  for (int k = 0; k < n_cells_; ++k)
    for (int f = 0; f <= dim; ++f)
      for (int g = f + 1; g <= dim; ++g)
        if (f != cells_[k].vertex && g != cells_[k].vertex)
          matrix_.connect(cells_[k].facets[f], cells_[k].facets[g]);
  const std::span<const int> rank = matrix_.order();
  for (int k = 0; k < n_cells_; ++k)
    for (int& facet : cells_[k].facets)
      if (facet >= 0) facet = rank[facet];
  facets_.resize(found_.size());
  for (std::size_t i = 0; i < found_.size(); ++i) facets_[rank[i]] = found_[i];
}

template <int dim, int p>
void Patch<dim, p>::find_rigid_motions()
{
  for (const auto& [facet, scale] : facets_)
  {
    if (!data_.is_boundary(facet) || !data_.fixes_any(facet)) continue;
    FixedFacet<dim>& fixed = fixed_facets_.emplace_back();
    for (int v = 0; v < dim; ++v) fixed.vertices[v] = mesh_.vertex(mesh_.topology().facets[facet][v]);
    for (int c = 0; c < dim; ++c) fixed.fixed[c] = data_.fixes(facet, c);
  }
  motions_ = RigidMotions<dim>(mesh_.vertex(vertex_), size_, fixed_facets_);
}

/// Coefficients of motion i in P^p(F)^d.
template <int dim, int p>
auto Patch<dim, p>::moments_on_facet(int place, int motion) const -> FacetVector
{
  const auto& hat = reference<dim, p>().facet_hat_moment;
  FacetVector moments;
  const double scale = std::sqrt(facets_[place].scale);
  for (int v = 0; v < dim; ++v)
  {
    const Point<dim> z =
        scale * motions_(motion, mesh_.vertex(mesh_.topology().facets[facets_[place].number][v]));
    for (int c = 0; c < dim; ++c)
      for (int i = 0; i < S::facet; ++i) moments[c * S::facet + i] += z[c] * hat(i, v);
  }
  return moments;
}

/// (-psi_a f + sigma(u^k) grad psi_a, v)_T for v in U.
template <int dim, int p>
auto Patch<dim, p>::raw_load(const CellPart& part) const -> UVector
{
  constexpr int m = S::multiplier;
  const PreparedCell<dim, p>& cell = *part.prepared;
  const Point<dim>& gradient = cell.frame.grad[part.vertex];
  UVector load;
  for (int r = 0; r < dim; ++r)
    for (int j = 0; j < m; ++j)
    {
      load[r * m + j] = -cell.body[part.vertex][r * m + j];
      for (int c = 0; c < dim; ++c) load[r * m + j] += gradient[c] * cell.sigma[(dim * r + c) * m + j];
    }
  return load;
}

template <int dim, int p>
auto Patch<dim, p>::integrate() const -> Moments
{
  constexpr int n = S::affine;
  Moments sum{Point<dim>::Zero(), Tensor<dim>::Zero(), 0, Point<dim>::Zero(), Tensor<dim>::Zero()};
  for (int k = 0; k < n_cells_; ++k)
  {
    const PreparedCell<dim, p>& cell = *cells_[k].prepared;
    const UVector load = raw_load(cells_[k]);
    const Point<dim> edge = edge_to(cell.frame, cells_[k].vertex);
    auto x = cell.coordinates;
    for (int d = 0; d < dim; ++d) x[d][0] -= edge[d] * cell.one;
    sum.volume += cell.one * cell.one;
    for (int c = 0; c < dim; ++c)
    {
      sum.load[c] += cell.one * load[c * S::multiplier];
      sum.position[c] += cell.one * x[c][0];
      for (int d = 0; d < dim; ++d)
        for (int j = 0; j < n; ++j)
        {
          sum.load_position(c, d) += load[c * S::multiplier + j] * x[d][j];
          sum.position_position(c, d) += x[c][j] * x[d][j];
        }
    }
  }
  return sum;
}

template <int dim, int p>
int Patch<dim, p>::local_vertex(Index facet) const
{
  const auto& vertices = mesh_.topology().facets[facet];
  return static_cast<int>(std::ranges::find(vertices, vertex_) - vertices.begin());
}

/// Moments of the traction of the dis (0) or lin (1) problem, or null where there is none.
template <int dim, int p>
auto Patch<dim, p>::traction(Index facet, int problem) const -> const typename FacetData<dim, p>::FacetVector*
{
  if (!data_.is_boundary(facet)) return nullptr;
  const auto* moments = problem == 0 ? data_.discretisation(facet) : data_.linearisation(facet);
  return moments ? &(*moments)[local_vertex(facet)] : nullptr;
}

/// (t, z) over the facets of the patch.
template <int dim, int p>
double Patch<dim, p>::traction_work(int problem, int motion) const
{
  double work = 0;
  for (std::size_t i = 0; i < facets_.size(); ++i)
    if (const auto* t = traction(facets_[i].number, problem))
    {
      const FacetVector z = moments_on_facet(static_cast<int>(i), motion);
      for (int k = 0; k < S::block; ++k) work += (*t)[k] * z[k];
    }
  return work;
}

/// y_a in Z_a (rigid motions; constants for p = 1) with (y_a, z) = -<R(u^k), psi_a z> = (b, z) - (t, z) for
/// the dis problem, and (y_lin, z) = (t^k - T(u^k), psi_a z)_C for the lin problem.
template <int dim, int p>
void Patch<dim, p>::find_divergence_part(const Moments& moments)
{
  y_.fill({Point<dim>::Zero(), Tensor<dim>::Zero()});
  const int n = p == 1 ? motions_.n_translations() : motions_.size();
  if (n == 0) return;
  Dense<S::rigid, S::rigid> gram;
  std::array<RigidVector, 2> y{};
  for (int i = 0; i < S::rigid; ++i) gram(i, i) = 1;  // motions that are not admitted
  for (int i = 0; i < n; ++i)
  {
    const auto& [translation, gradient] = motions_[i];
    for (int j = i; j < n; ++j)
    {
      const auto& [other_translation, other_gradient] = motions_[j];
      gram(i, j) = moments.volume * translation.dot(other_translation) +
                   translation.dot(other_gradient * moments.position) +
                   other_translation.dot(gradient * moments.position) +
                   (gradient * moments.position_position).cwiseProduct(other_gradient).sum();
    }
    y[0][i] = translation.dot(moments.load) + gradient.cwiseProduct(moments.load_position).sum();
    for (int problem = 0; problem < n_problems_; ++problem)
      y[problem][i] += (problem == 0 ? -1 : 1) * traction_work(problem, i);
  }
  RigidVector reciprocal;
  if (!cholesky<S::rigid>(gram.data(), gram.stride, reciprocal.data()))
    throw SolveError("the cells around vertex " + std::to_string(vertex_) + " are too flat");
  for (int problem = 0; problem < n_problems_; ++problem)
  {
    solve_transposed<S::rigid>(gram.data(), gram.stride, reciprocal.data(), y[problem].data());
    solve_upper<S::rigid>(gram.data(), gram.stride, reciprocal.data(), y[problem].data());
    for (int i = 0; i < n; ++i)
    {
      y_[problem].translation += y[problem][i] * motions_[i].translation;
      y_[problem].gradient += y[problem][i] * motions_[i].gradient;
    }
  }
}

/// w_a for p = 1: in the span of grad z of the admissible rotations z, with
/// (w_a, grad z) = (t, z)_{N, C} - (Pi^0 b, z).
template <int dim, int p>
void Patch<dim, p>::find_skew_part(const Moments& moments)
{
  w_.fill(Tensor<dim>::Zero());
  const int n = motions_.n_rotations();
  if (p > 1 || n == 0) return;
  const int first = motions_.n_translations();
  using Gram = Eigen::Matrix<double, S::pairs, S::pairs>;
  Gram gram = Gram::Identity();
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      gram(i, j) =
          moments.volume * motions_[first + i].gradient.cwiseProduct(motions_[first + j].gradient).sum();
  const Gram inverse = gram.inverse();
  for (int problem = 0; problem < n_problems_; ++problem)
  {
    // (Pi^0 b, z), z = grad z x: b is the load of dis without y_a and y_lin,a in lin
    const Tensor<dim> y = y_[problem].translation * moments.position.transpose();
    const Tensor<dim> b = problem == 0 ? Tensor<dim>(moments.load_position - y) : y;
    Eigen::Matrix<double, S::pairs, 1> rhs = Eigen::Matrix<double, S::pairs, 1>::Zero();
    for (int i = 0; i < n; ++i)
      rhs[i] = traction_work(problem, first + i) - b.cwiseProduct(motions_[first + i].gradient).sum();
    for (int i = 0; i < n; ++i) w_[problem] += inverse.row(i).dot(rhs) * motions_[first + i].gradient;
  }
}

template <int dim, int p>
void Patch<dim, p>::assemble()
{
  for (int problem = 0; problem < n_problems_; ++problem) x_[problem].assign(facets_.size(), {});
  for (int k = 0; k < n_cells_; ++k)
  {
    condense(cells_[k]);
    for (int problem = 0; problem < n_problems_; ++problem) assemble_load(cells_[k], problem);
  }
  for (std::size_t i = 0; i < facets_.size(); ++i)
  {
    if (!data_.is_boundary(facets_[i].number)) continue;
    for (int problem = 0; problem < n_problems_; ++problem)
      if (const auto* t = traction(facets_[i].number, problem)) add_multiple(x_[problem][i], -1, *t);
    decouple_fixed_components(static_cast<int>(i));
  }
}

/// Eliminates the multiplier of the outer facet.
template <int dim, int p>
void Patch<dim, p>::condense(CellPart& part)
{
  const PreparedCell<dim, p>& cell = *part.prepared;
  const int o = part.vertex;
  part.outer = cell.shape ? &cell.shape->outer[o] : &part.own_outer;
  if (!cell.shape) part.own_outer.factor(*cell.op, o);
  for (int f = 0; f <= dim; ++f)
    for (int g = 0; g <= dim; ++g)
    {
      if (f == o || g == o || part.facets[f] > part.facets[g]) continue;
      auto& block = matrix_.block(part.facets[f], part.facets[g]);
      if (cell.shape)
        add_multiple(block, 1, cell.shape->reduced[o][f][g]);
      else
        part.own_outer.add_block(*cell.op, f, g, block);
    }
}

/// g = N G - C^T (B B^T)^{-1} r with the outer facet eliminated. With div G = psi_a div sigma + sigma grad
/// psi_a, r is (psi_a (div sigma + f) + y_a, v) on U and -(w_a, q) on Lambda for dis; (-y_lin, v) and
/// -(w_lin, q) for lin.
template <int dim, int p>
void Patch<dim, p>::assemble_load(CellPart& part, int problem)
{
  constexpr int m = S::multiplier;
  constexpr int n = S::facet;
  const PreparedCell<dim, p>& cell = *part.prepared;
  const Frame<dim>& frame = cell.frame;
  const Reference<dim, p>& ref = reference<dim, p>();
  const int o = part.vertex;
  UVector r_u;
  FacetVectors load;
  if (problem == 0)
  {
    r_u = cell.body[o];
    for (int r = 0; r < dim; ++r)
      for (int i = 0; i < m; ++i)
        for (int j = 0; j < m; ++j) r_u[r * m + i] += ref.hat[o](i, j) * cell.divergence[r * m + j];
    for (int f = 0; f <= dim; ++f)  // N (psi_a sigma)
      for (int r = 0; r < dim && f != o; ++r)
      {
        std::array<double, m> normal{};
        for (int c = 0; c < dim; ++c)
          for (int j = 0; j < m; ++j) normal[j] -= frame.grad[f][c] * cell.sigma[(dim * r + c) * m + j];
        const double scale = 1 / std::sqrt(frame.grad_norm[f]);
        for (int i = 0; i < n; ++i)
          for (int j = 0; j < m; ++j) load(f, r * n + i) += scale * ref.hat_trace[f][o](i, j) * normal[j];
      }
  }
  add_moments(r_u, cell, o, y_[problem], problem == 0 ? 1 : -1);
  cell.op->subtract_load(load, frame, r_u, w_[problem]);

  FacetVector& outer = part.outer_load[problem];
  std::copy_n(load.row(o), FacetVector::stride, outer.data());
  solve_transposed<S::block>(part.outer->rows.data() + o * FacetVector::stride, Operator::all_facets,
                             part.outer->reciprocal.data(), outer.data());
  subtract_transposed_times<S::block, Operator::all_facets>(load.data(), part.outer->rows.data(),
                                                            Operator::all_facets, outer.data());
  for (int f = 0; f <= dim; ++f)
    if (f != o)
      for (int i = 0; i < S::block; ++i) x_[problem][part.facets[f]][i] += load(f, i);
}

/// Where Gamma_D fixes a component the normal trace is free: its multiplier is 0.
template <int dim, int p>
void Patch<dim, p>::decouple_fixed_components(int place)
{
  for (int c = 0; c < dim; ++c)
  {
    if (!data_.fixes(facets_[place].number, c)) continue;
    matrix_.template decouple<S::facet>(place, c * S::facet);
    for (int problem = 0; problem < n_problems_; ++problem)
      std::fill_n(x_[problem][place].data() + c * S::facet, S::facet, 0.0);
  }
}

/// Multipliers that are the trace of an admissible rigid motion change nothing: makes the matrix definite by
/// a term on one facet, which the solution, the data being compatible, does not feel.
template <int dim, int p>
void Patch<dim, p>::fix_rigid_motions(int place)
{
  auto& diagonal = matrix_.block(place, place);
  double scale = 0;
  for (int i = 0; i < S::block; ++i) scale += diagonal(i, i) / S::block;
  for (int motion = 0; motion < motions_.size(); ++motion)
  {
    FacetVector trace = moments_on_facet(place, motion);
    if (data_.is_boundary(facets_[place].number))
      for (int c = 0; c < dim; ++c)
        if (data_.fixes(facets_[place].number, c)) std::fill_n(trace.data() + c * S::facet, S::facet, 0.0);
    double square = 0;
    for (int i = 0; i < S::block; ++i) square += trace[i] * trace[i];
    for (int i = 0; i < S::block; ++i)
      for (int j = 0; j < S::block; ++j) diagonal(i, j) += scale / square * trace[i] * trace[j];
  }
}

/// The multiplier of the outer facet, and all that goes to the cell.
template <int dim, int p>
void Patch<dim, p>::recover(CellPart& part, int problem)
{
  constexpr int stride = Operator::facet_stride;
  constexpr int row = Operator::all_facets;
  CellShare<dim, p>& share = part.shares[problem];
  const int o = part.vertex;
  double* const outer = share.mu.row(o);
  std::copy_n(part.outer_load[problem].data(), stride, outer);
  for (int f = 0; f <= dim; ++f)
  {
    if (f == o) continue;
    const FacetVector& x = x_[problem][part.facets[f]];
    std::copy_n(x.data(), stride, share.mu.row(f));
    subtract_times<S::block, stride>(outer, part.outer->rows.data() + f * stride, row, x.data());
  }
  solve_upper<S::block>(part.outer->rows.data() + o * stride, row, part.outer->reciprocal.data(), outer);
  share.y = y_[problem];
  share.w = w_[problem];
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
