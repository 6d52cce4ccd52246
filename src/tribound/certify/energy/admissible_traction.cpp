#include "tribound/certify/energy/admissible_traction.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "tribound/base/parallel.h"
#include "tribound/contact/nitsche/simplex_map.h"
#include "tribound/fem/bernstein.h"
#include "tribound/fem/simplex_parts.h"

namespace tribound::certify
{

namespace
{

using Matrix = Eigen::MatrixXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Bernstein's basis of the facets of the form at points of the reference facet, [point, coefficient].
template <int dim>
Matrix bernstein_at(int degree, std::span<const Point<dim - 1>> points)
{
  const fem::LagrangeBasis<dim - 1> basis(degree);
  const fem::Tabulation<dim - 1> table = basis.tabulate(points);
  const std::vector<double> to_values = fem::values_from_bernstein(basis);
  const int n = basis.n_nodes();
  return Eigen::Map<const RowMajor>(table.values.data(), table.n_points, n) *
         Eigen::Map<const RowMajor>(to_values.data(), n, n);
}

/// Its coefficients from values at the nodes.
template <int k>
Matrix bernstein_from_nodes(const fem::LagrangeBasis<k>& basis)
{
  return Eigen::Map<const RowMajor>(fem::bernstein_from_values(basis).data(), basis.n_nodes(),
                                    basis.n_nodes());
}

/// Where the coefficients of a traction may be: |t^t| <= limit - coefficient t^n, t^n <= 0.
template <int dim>
struct Cone
{
  Point<dim> normal;
  double limit;
  double coefficient;

  [[nodiscard]] bool contains(const Point<dim>& t, double tolerance) const
  {
    const double n = t.dot(normal);
    return n <= tolerance && (t - n * normal).norm() <= limit - coefficient * n + tolerance;
  }

  /// The nearest point; with coefficient > 0 of a cone with its tip at 0.
  [[nodiscard]] Point<dim> nearest(const Point<dim>& t) const
  {
    const double n = t.dot(normal);
    const Point<dim> tangential = t - n * normal;
    const double length = tangential.norm();
    if (coefficient == 0)
      return std::min(n, 0.0) * normal + (length > limit ? limit / length : 1.0) * tangential;
    if (n <= 0 && length <= -coefficient * n) return t;
    const double along = (coefficient * length - n) / (1 + coefficient * coefficient);  // -t^n
    if (along <= 0 || length == 0) return Point<dim>::Zero();
    return -along * normal + coefficient * along / length * tangential;
  }
};

/// Fits coefficients to tractions at the points of the facet rule. On all facets the products of the basis
/// differ by a factor only.
template <int dim>
class Fit
{
 public:
  using Columns = Eigen::Matrix<double, dim, Eigen::Dynamic>;

  explicit Fit(const contact::NitscheForm<dim>& form)
      : rule_(form.facet_rule()),
        basis_(form.space().degree()),
        from_values_(bernstein_from_nodes(basis_)),
        at_points_(bernstein_at<dim>(basis_.degree(), rule_.points))
  {
    const Eigen::Map<const Eigen::VectorXd> weights(rule_.weights.data(), rule_.size());
    weighted_ = at_points_.transpose() * weights.asDiagonal();
    gram_ = weighted_ * at_points_;
    factors_.compute(gram_);
  }

  [[nodiscard]] const Matrix& at_points() const { return at_points_; }

  /// The nearest t_h to t, columns at the points, with its coefficients in the cones: where the projection of
  /// t on polynomials is there, that; else coefficient after coefficient is made the best.
  [[nodiscard]] Columns operator()(const Columns& t, std::span<const Cone<dim>> cones) const
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

  /// Of a threshold, from its values at the nodes of the segment; none is negative.
  [[nodiscard]] Eigen::VectorXd threshold(const contact::NitscheForm<dim>& form, std::size_t k) const
  {
    const contact::ContactSegment<dim>& segment = form.segments()[k];
    const auto map = contact::simplex_map(form.space().mesh(), segment.slave);
    Eigen::VectorXd values(basis_.n_nodes());
    for (int j = 0; j < basis_.n_nodes(); ++j)
      values[j] = problem::strength_at<dim>(segment.contact->law, map(basis_.node_point(j)));
    return (from_values_ * values).cwiseMax(0.0);
  }

 private:
  const fem::Quadrature<dim - 1>& rule_;
  fem::LagrangeBasis<dim - 1> basis_;
  Matrix from_values_;
  Matrix at_points_;
  Matrix weighted_;
  Matrix gram_;
  Eigen::LLT<Matrix> factors_;
};

}  // namespace

template <int dim>
AdmissibleTraction<dim> admissible_traction(const contact::NitscheForm<dim>& form,
                                            std::span<const Point<dim>> t)
{
  const Fit<dim> fit(form);
  const Eigen::Index n = fit.at_points().cols();
  const int n_points = form.n_segment_points();
  AdmissibleTraction<dim> result;
  result.thresholds.resize(form.segments().size() * n);
  result.at_points.resize(t.size());
  std::vector<double> remainders(form.segments().size(), 0.0);
  const auto on_facet = [&](std::size_t k)
  {
    const contact::ContactSegment<dim>& segment = form.segments()[k];
    const double coefficient = problem::cone(segment.contact->law).coefficient;
    const Eigen::VectorXd s = fit.threshold(form, k);
    std::vector<Cone<dim>> cones;
    cones.reserve(n);
    for (Eigen::Index j = 0; j < n; ++j) cones.push_back({segment.normal, s[j], coefficient});
    const Eigen::Map<const typename Fit<dim>::Columns> given(t[k * n_points].data(), dim, n_points);
    const typename Fit<dim>::Columns b = fit(given, cones);
    const typename Fit<dim>::Columns values = b * fit.at_points().transpose();
    for (int q = 0; q < n_points; ++q)
    {
      result.at_points[k * n_points + q] = values.col(q);
      const double s_h = fit.at_points().row(q).dot(s);
      if (coefficient == 0)
        remainders[k] = std::max(remainders[k], std::abs(form.contact_points(k)[q].strength - s_h));
    }
    for (Eigen::Index j = 0; j < n; ++j)
      result.thresholds[k * n + j] = coefficient > 0 ? -coefficient * b.col(j).dot(segment.normal) : s[j];
  };
  parallel_for(form.segments().size(), on_facet);
  if (!remainders.empty()) result.threshold_remainder = std::ranges::max(remainders);
  return result;
}

namespace
{

/// The reference simplex cut at the middles of its edges.
template <int k>
std::vector<fem::Part<k>> equal_parts()
{
  const fem::Part<k> whole = fem::reference_simplex<k>();
  const auto middle = [&](int i, int j) -> Point<k> { return 0.5 * (whole[i] + whole[j]); };
  if constexpr (k == 1)
    return {{whole[0], middle(0, 1)}, {middle(0, 1), whole[1]}};
  else
    return {{whole[0], middle(0, 1), middle(0, 2)},
            {middle(0, 1), whole[1], middle(1, 2)},
            {middle(0, 2), middle(1, 2), whole[2]},
            {middle(1, 2), middle(0, 2), middle(0, 1)}};
}

/// int s |v|, s = sum s_j B_j >= 0, from above by |v| <= sum |v_j| B_j, on a facet halved until it settles.
template <int dim>
class SlipIntegral
{
 public:
  using Columns = Eigen::Matrix<double, dim, Eigen::Dynamic>;

  explicit SlipIntegral(int degree)
      : basis_(degree),
        rule_(fem::quadrature<dim - 1>(2 * degree)),
        at_points_(bernstein_at<dim>(degree, rule_.points)),
        from_values_(bernstein_from_nodes(basis_))
  {
    const std::vector<Point<dim - 1>> nodes = basis_.node_points();
    for (const fem::Part<dim - 1>& part : equal_parts<dim - 1>())
    {
      std::vector<Point<dim - 1>> points;
      points.reserve(nodes.size());
      for (const Point<dim - 1>& x : nodes) points.push_back(fem::point_in<dim - 1>(part, x));
      to_parts_.push_back(from_values_ * bernstein_at<dim>(degree, points));
    }
  }

  /// Relative to the measure of the reference facet as the weights of the rule are.
  [[nodiscard]] double operator()(const Eigen::VectorXd& s, const Columns& v, int depth = 0) const
  {
    constexpr int deepest = dim == 2 ? 12 : 5;
    constexpr double close = 1e-3;
    const Eigen::VectorXd above = v.colwise().norm().transpose();
    double upper = 0;
    double value = 0;
    for (int q = 0; q < rule_.size(); ++q)
    {
      const double weight = rule_.weights[q] * at_points_.row(q).dot(s);
      upper += weight * at_points_.row(q).dot(above);
      value += weight * (v * at_points_.row(q).transpose()).norm();
    }
    if (depth == deepest || upper - value <= close * upper) return upper;
    double sum = 0;
    for (const Matrix& to_part : to_parts_)
      sum += (*this)(to_part * s, v * to_part.transpose(), depth + 1) / static_cast<double>(to_parts_.size());
    return std::min(upper, sum);
  }

 private:
  fem::LagrangeBasis<dim - 1> basis_;
  fem::Quadrature<dim - 1> rule_;
  Matrix at_points_;
  Matrix from_values_;
  std::vector<Matrix> to_parts_;  ///< coefficients on the parts of a facet from those on it
};

}  // namespace

template <int dim>
struct ContactGap<dim>::Tables
{
  explicit Tables(const contact::NitscheForm<dim>& form)
      : at_points(bernstein_at<dim>(form.space().degree(), form.facet_rule().points)),
        slip(form.space().degree())
  {
  }

  Matrix at_points;
  SlipIntegral<dim> slip;
};

template <int dim>
ContactGap<dim>::ContactGap(const contact::NitscheForm<dim>& form, const ObstacleFacets<dim>& facets)
    : form_(form), facets_(facets), tables_(std::make_unique<Tables>(form))
{
}

template <int dim>
ContactGap<dim>::~ContactGap() = default;

template <int dim>
double ContactGap<dim>::operator()(std::size_t k, const AdmissibleTraction<dim>& t,
                                   std::span<const double> v) const
{
  const fem::Quadrature<dim - 1>& rule = form_.facet_rule();
  const Matrix& at_points = tables_->at_points;
  const Eigen::Index n = at_points.cols();
  const Point<dim>& normal = form_.segments()[k].normal;
  const std::vector<Point<dim>> coefficients = facets_.coefficients(k, v);
  Eigen::VectorXd normal_gap(n);
  Eigen::VectorXd thresholds(n);
  typename SlipIntegral<dim>::Columns tangential(dim, n);
  for (Eigen::Index j = 0; j < n; ++j)
  {
    const double v_n = coefficients[j].dot(normal);
    normal_gap[j] = v_n - facets_.gap(k)[j];
    tangential.col(j) = coefficients[j] - v_n * normal;
    thresholds[j] = t.thresholds[k * n + j];
  }
  double sum = 0;
  for (int q = 0; q < rule.size(); ++q)
  {
    const Point<dim>& t_h = t.at_points[k * rule.size() + q];
    const Point<dim> v_t = tangential * at_points.row(q).transpose();
    sum += rule.weights[q] * (t_h.dot(normal) * at_points.row(q).dot(normal_gap) + t_h.dot(v_t));
  }
  if (thresholds.maxCoeff() > 0) sum += tables_->slip(thresholds, tangential);
  return std::max(0.0, form_.segments()[k].det() * sum);
}

template AdmissibleTraction<2> admissible_traction(const contact::NitscheForm<2>&, std::span<const Point<2>>);
template AdmissibleTraction<3> admissible_traction(const contact::NitscheForm<3>&, std::span<const Point<3>>);
template class ContactGap<2>;
template class ContactGap<3>;

}  // namespace tribound::certify
