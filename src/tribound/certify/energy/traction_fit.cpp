#include "tribound/certify/energy/traction_fit.h"

#include <algorithm>
#include <cmath>

#include "tribound/contact/nitsche/simplex_map.h"
#include "tribound/fem/bernstein.h"

namespace tribound::certify
{

template <int dim>
bool TractionCone<dim>::contains(const Point<dim>& t, double tolerance) const
{
  const double n = t.dot(normal);
  if (is_tied) return true;
  if (is_bilateral) return (t - n * normal).norm() <= tolerance;
  return n <= tolerance && (t - n * normal).norm() <= limit - coefficient * n + tolerance;
}

template <int dim>
Point<dim> TractionCone<dim>::nearest(const Point<dim>& t) const
{
  if (is_tied) return t;
  const double n = t.dot(normal);
  if (is_bilateral) return n * normal;
  const Point<dim> tangential = t - n * normal;
  const double length = tangential.norm();
  if (coefficient == 0)
    return std::min(n, 0.0) * normal + (length > limit ? limit / length : 1.0) * tangential;
  if (n <= 0 && length <= -coefficient * n) return t;
  const double along = (coefficient * length - n) / (1 + coefficient * coefficient);  // -t^n
  if (along <= 0 || length == 0) return Point<dim>::Zero();
  return -along * normal + coefficient * along / length * tangential;
}

template <int dim>
Tensor<dim> TractionCone<dim>::derivative(const Point<dim>& t) const
{
  if (is_tied) return Tensor<dim>::Identity();
  const double n = t.dot(normal);
  const Point<dim> tangential = t - n * normal;
  const double length = tangential.norm();
  const Tensor<dim> along_normal = normal * normal.transpose();
  if (is_bilateral) return normal * normal.transpose();
  const Tensor<dim> in_plane = Tensor<dim>::Identity() - along_normal;
  const double pushes = n < 0 ? 1 : 0;
  if (coefficient == 0 && length <= limit) return pushes * along_normal + in_plane;
  if (coefficient > 0 && n <= 0 && length <= -coefficient * n) return Tensor<dim>::Identity();
  if (length == 0) return Tensor<dim>::Zero();
  const Point<dim> direction = tangential / length;
  const Tensor<dim> around = in_plane - direction * direction.transpose();
  if (coefficient == 0) return pushes * along_normal + limit / length * around;
  const double along = (coefficient * length - n) / (1 + coefficient * coefficient);
  if (along <= 0) return Tensor<dim>::Zero();
  const Point<dim> edge = (coefficient * direction - normal).normalized();
  return edge * edge.transpose() + coefficient * along / length * around;
}

namespace
{

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace

template <int dim>
Eigen::MatrixXd bernstein_at(int degree, std::span<const Point<dim - 1>> points)
{
  const fem::LagrangeBasis<dim - 1> basis(degree);
  const fem::Tabulation<dim - 1> table = basis.tabulate(points);
  const std::vector<double> to_values = fem::values_from_bernstein(basis);
  const int n = basis.n_nodes();
  return Eigen::Map<const RowMajor>(table.values.data(), table.n_points, n) *
         Eigen::Map<const RowMajor>(to_values.data(), n, n);
}

template <int k>
Eigen::MatrixXd bernstein_from_nodes(const fem::LagrangeBasis<k>& basis)
{
  return Eigen::Map<const RowMajor>(fem::bernstein_from_values(basis).data(), basis.n_nodes(),
                                    basis.n_nodes());
}

template <int dim>
Eigen::MatrixXd bernstein_raised(int lower, int higher)
{
  const fem::LagrangeBasis<dim - 1> basis(higher);
  return bernstein_from_nodes(basis) * bernstein_at<dim>(lower, basis.node_points());
}

template <int dim>
bool is_low(const contact::NitscheForm<dim>& form, const ContactFrames<dim>& frames, std::size_t k)
{
  if (!form.problem().is_axisymmetric() || !frames.turns(k)) return false;
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  bool result = false;
  form.segments()[k].for_each_side(
      [&](const contact::SegmentSide<dim>& side)
      {
        for (const Index v : mesh.cell(side.facet.cell))
          result = result || form.problem().weight(mesh.vertex(v)) == 0;
      });
  return result;
}

template <int dim>
TractionFit<dim>::TractionFit(const contact::NitscheForm<dim>& form, int degree)
    : form_(form),
      frames_(form),
      basis_(degree),
      from_values_(bernstein_from_nodes(basis_)),
      at_points_(bernstein_at<dim>(basis_.degree(), form.facet_rule().points))
{
  const fem::Quadrature<dim - 1>& rule = form.facet_rule();
  const Eigen::Map<const Eigen::VectorXd> weights(rule.weights.data(), rule.size());
  weighted_ = at_points_.transpose() * weights.asDiagonal();
  gram_ = weighted_ * at_points_;
  factors_ = CholeskyFactors(gram_);
  const int lower = degree - ContactFrames<dim>::degree;
  if (degree < form.space().degree() || lower < 0) return;
  for (std::size_t k = 0; k < form.segments().size() && !low_; ++k)
    if (is_low(form, frames_, k)) low_ = std::unique_ptr<const TractionFit>(new TractionFit(form, lower));
}

template <int dim>
std::vector<TractionCone<dim>> TractionFit<dim>::narrowest(std::size_t k, std::size_t n) const
{
  const std::vector<TractionCone<dim>> all = cones(k);
  return std::vector<TractionCone<dim>>(n, *std::ranges::min_element(all, {}, &TractionCone<dim>::limit));
}

template <int dim>
auto TractionFit<dim>::nearest(std::size_t k, const Columns& t) const -> Columns
{
  if (!is_low(form_, frames_, k)) return (*this)(t, cones(k));
  if (!low_) return Columns::Zero(dim, basis_.n_nodes());
  return (*low_)(t, narrowest(k, low_->basis_.n_nodes())) *
         bernstein_raised<dim>(low_->basis_.degree(), basis_.degree()).transpose();
}

template <int dim>
Eigen::MatrixXd TractionFit<dim>::rates(std::size_t k, const Columns& t, std::span<const Columns> z) const
{
  if (!is_low(form_, frames_, k)) return tangent(t, cones(k), z);
  if (!low_) return Eigen::MatrixXd::Zero(std::ssize(z), std::ssize(z));
  return low_->tangent(t, narrowest(k, low_->basis_.n_nodes()), z);
}

template <int dim>
auto TractionFit<dim>::turned(std::size_t k, Columns t) const -> Columns
{
  for (int q = 0; frames_.turns(k) && q < form_.n_segment_points(); ++q)
    t.col(q) = (frames_.at_point(k, q).transpose() * t.col(q)).eval();
  return t;
}

template <int dim>
auto TractionFit<dim>::columns(std::size_t k, std::span<const Point<dim>> t) const -> Columns
{
  const int n_points = form_.n_segment_points();
  return turned(k, Eigen::Map<const Columns>(t[k * n_points].data(), dim, n_points));
}

template <int dim>
std::vector<TractionCone<dim>> TractionFit<dim>::cones(std::size_t k) const
{
  const contact::ContactSegment<dim>& segment = form_.segments()[k];
  const problem::ContactLaw& law = segment.contact->law;
  const auto map = contact::simplex_map(form_.space().mesh(), segment.slave);
  Eigen::VectorXd thresholds(basis_.n_nodes());
  for (int j = 0; j < basis_.n_nodes(); ++j)
    thresholds[j] = problem::strength_at<dim>(law, map(basis_.node_point(j)));
  thresholds = (from_values_ * thresholds).cwiseMax(0.0).eval();
  std::vector<TractionCone<dim>> cones;
  cones.reserve(thresholds.size());
  const problem::FrictionCone cone = problem::cone(law);
  for (const double s : thresholds)
    cones.push_back({frames_.normal(k), s, cone.coefficient, cone.is_tied, cone.is_bilateral});
  return cones;
}

template <int dim>
auto TractionFit<dim>::operator()(const Columns& t, std::span<const TractionCone<dim>> cones) const -> Columns
{
  constexpr int most_sweeps = 400;
  const Columns moments = t * weighted_.transpose();
  Columns b = factors_.solve(moments.transpose()).transpose();
  const double scale = b.cwiseAbs().maxCoeff();
  bool is_pure = true;
  for (Eigen::Index j = 0; j < b.cols(); ++j)
  {
    is_pure = is_pure && cones[j].contains(b.col(j), 1e-12 * scale);
    b.col(j) = cones[j].nearest(b.col(j));
  }
  double change = is_pure ? 0 : scale;
  for (int sweep = 0; sweep < most_sweeps && change > 1e-14 * scale; ++sweep)
  {
    change = 0;
    for (Eigen::Index j = 0; j < b.cols(); ++j)
    {
      const Point<dim> free = b.col(j) + (moments.col(j) - b * gram_.col(j)) / gram_(j, j);
      const Point<dim> better = cones[j].nearest(free);
      change = std::max(change, (better - b.col(j)).cwiseAbs().maxCoeff());
      b.col(j) = better;
    }
  }
  return b;
}

/// The coefficients satisfy b_j = P_j(b_j + (m_j - sum_k b_k G_kj) / G_jj) with the moments m of t. With D_j
/// the derivative of P_j there, (I - D_j) db_j + D_j sum_k db_k G_kj / G_jj = D_j dm_j / G_jj. This is
/// regular, since G is definite and 0 <= D_j <= I.
template <int dim>
Eigen::MatrixXd TractionFit<dim>::tangent(const Columns& t, std::span<const TractionCone<dim>> cones,
                                          std::span<const Columns> z) const
{
  const Columns b = (*this)(t, cones);
  const Columns moments = t * weighted_.transpose();
  const Eigen::Index n = b.cols();
  Eigen::MatrixXd system = Eigen::MatrixXd::Identity(dim * n, dim * n);
  Eigen::MatrixXd rates(dim * n, std::ssize(z));  // of the moments, then of b
  Eigen::MatrixXd tests(dim * n, std::ssize(z));  // moments of z
  for (Eigen::Index i = 0; i < tests.cols(); ++i)
    Eigen::Map<Columns>(tests.col(i).data(), dim, n) = z[i] * weighted_.transpose();
  for (Eigen::Index j = 0; j < n; ++j)
  {
    const Point<dim> free = b.col(j) + (moments.col(j) - b * gram_.col(j)) / gram_(j, j);
    const Tensor<dim> d = cones[j].derivative(free);
    system.template block<dim, dim>(dim * j, dim * j) -= d;
    for (Eigen::Index k = 0; k < n; ++k)
      system.template block<dim, dim>(dim * j, dim * k) += gram_(k, j) / gram_(j, j) * d;
    rates.template middleRows<dim>(dim * j) = d * tests.template middleRows<dim>(dim * j) / gram_(j, j);
  }
  return tests.transpose() * solve_regular(system, rates);
}

template <int dim>
Eigen::MatrixXd TractionFit<dim>::gram(std::span<const Columns> z) const
{
  const auto& weights = form_.facet_rule().weights;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(std::ssize(z), std::ssize(z));
  for (Eigen::Index i = 0; i < result.rows(); ++i)
    for (Eigen::Index j = 0; j < result.cols(); ++j)
      for (int q = 0; q < form_.n_segment_points(); ++q)
        result(i, j) += weights[q] * z[i].col(q).dot(z[j].col(q));
  return result;
}

template bool is_low(const contact::NitscheForm<2>&, const ContactFrames<2>&, std::size_t);
template bool is_low(const contact::NitscheForm<3>&, const ContactFrames<3>&, std::size_t);
template struct TractionCone<2>;
template struct TractionCone<3>;
template Eigen::MatrixXd bernstein_at<2>(int, std::span<const Point<1>>);
template Eigen::MatrixXd bernstein_at<3>(int, std::span<const Point<2>>);
template Eigen::MatrixXd bernstein_from_nodes(const fem::LagrangeBasis<1>&);
template Eigen::MatrixXd bernstein_from_nodes(const fem::LagrangeBasis<2>&);
template Eigen::MatrixXd bernstein_raised<2>(int, int);
template Eigen::MatrixXd bernstein_raised<3>(int, int);
template class TractionFit<2>;
template class TractionFit<3>;

}  // namespace tribound::certify
