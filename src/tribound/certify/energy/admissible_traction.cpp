#include "tribound/certify/energy/admissible_traction.h"

#include <algorithm>
#include <cmath>

#include "tribound/base/parallel.h"
#include "tribound/certify/energy/traction_fit.h"
#include "tribound/fem/bernstein.h"
#include "tribound/fem/simplex_parts.h"

namespace tribound::certify
{

template <int dim>
AdmissibleTraction<dim> admissible_traction(const contact::NitscheForm<dim>& form,
                                            std::span<const Point<dim>> t)
{
  const TractionFit<dim> fit(form);
  const Eigen::Index n = fit.at_points().cols();
  const int n_points = form.n_segment_points();
  AdmissibleTraction<dim> result;
  result.thresholds.resize(form.segments().size() * n);
  result.coefficients.resize(form.segments().size() * n);
  result.at_points.resize(t.size());
  std::vector<double> remainders(form.segments().size(), 0.0);
  constexpr double rounding = 1e-14;
  const auto on_facet = [&](std::size_t k)
  {
    const std::vector<TractionCone<dim>> cones = fit.cones(k);
    const auto b = fit.nearest(k, fit.columns(k, t));
    const typename TractionFit<dim>::Columns values = b * fit.at_points().transpose();
    for (int q = 0; q < n_points; ++q)
    {
      result.at_points[k * n_points + q] = fit.frames().at_point(k, q) * values.col(q);
      double s_h = 0;
      for (Eigen::Index j = 0; j < n; ++j) s_h += fit.at_points()(q, j) * cones[j].limit;
      const double strength = form.contact_points(k)[q].strength;
      const double rest = std::abs(strength - s_h);
      if (cones.front().coefficient == 0 && rest > rounding * strength)
        remainders[k] = std::max(remainders[k], rest);
    }
    for (Eigen::Index j = 0; j < n; ++j) result.coefficients[k * n + j] = b.col(j);
    for (Eigen::Index j = 0; j < n; ++j)
      result.thresholds[k * n + j] =
          cones[j].coefficient > 0 ? -cones[j].coefficient * b.col(j).dot(cones[j].normal) : cones[j].limit;
  };
  parallel_for(form.segments().size(), on_facet);
  if (!remainders.empty()) result.threshold_remainder = std::ranges::max(remainders);
  return result;
}

namespace
{

using Matrix = Eigen::MatrixXd;

/// The reference simplex cut at the midpoints of its edges.
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

/// An upper bound of int s |v|, s = sum s_j B_j >= 0, by |v| <= sum |v_j| B_j on a facet halved until it
/// settles.
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

  /// Relative to the measure of the reference facet, like the weights of the rule.
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
  std::vector<Matrix> to_parts_;  ///< maps coefficients on a facet to those on its parts
};

}  // namespace

template <int dim>
struct ContactGap<dim>::Tables
{
  /// For slips and gaps of the degree, and for thresholds, times r on a meridian, of the same degree.
  struct OfSlip
  {
    OfSlip(const contact::NitscheForm<dim>& form, int degree)
        : nodes(fem::LagrangeBasis<dim - 1>(degree).node_points()),
          at_points(bernstein_at<dim>(degree, form.facet_rule().points)),
          at_nodes(bernstein_at<dim>(form.space().degree(), nodes)),
          from_nodes(bernstein_from_nodes(fem::LagrangeBasis<dim - 1>(degree))),
          raise(from_nodes * at_nodes),
          integral(degree)
    {
    }

    std::vector<Point<dim - 1>> nodes;
    Matrix at_points;
    Matrix at_nodes;  ///< from coefficients of the degree of the space
    Matrix from_nodes;
    Matrix raise;  ///< from coefficients of the degree of the space
    SlipIntegral<dim> integral;
  };

  explicit Tables(const contact::NitscheForm<dim>& form)
      : plain(form, form.space().degree() + (form.problem().is_axisymmetric() ? 1 : 0)),
        rich(form, form.space().degree() + 2),
        gap_at_points(bernstein_at<dim>(form.space().degree(), form.facet_rule().points))
  {
  }

  OfSlip plain;
  OfSlip rich;
  Matrix gap_at_points;  ///< coefficients of the degree of the space
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
  const problem::Problem<dim>& problem = form_.problem();
  const Matrix& at_points = tables_->gap_at_points;
  const Eigen::Index n = at_points.cols();
  const Point<dim>& normal = facets_.frames().normal(k);
  const std::vector<Point<dim>> coefficients = facets_.turned(k, facets_.coefficients(k, v));
  Eigen::VectorXd normal_gap(std::ssize(coefficients));
  for (Eigen::Index j = 0; j < normal_gap.size(); ++j)
    normal_gap[j] = coefficients[j].dot(normal) - facets_.gap(k)[j];
  const Matrix& of_gap = facets_.frames().turns(k) ? tables_->rich.at_points : at_points;
  const typename Tables::OfSlip& of_slip = facets_.slip_is_rich(k) ? tables_->rich : tables_->plain;
  const std::vector<Point<dim>> slip = facets_.slip(k, v);
  using Columns = typename SlipIntegral<dim>::Columns;
  Columns slips = Eigen::Map<const Columns>(slip[0].data(), dim, std::ssize(slip));
  if (slips.cols() < of_slip.at_points.cols()) slips = (slips * of_slip.raise.transpose()).eval();
  const Eigen::Map<const Columns> y(t.coefficients[k * n].data(), dim, n);
  const Eigen::Map<const Eigen::VectorXd> thresholds(&t.thresholds[k * n], n);
  const auto map = contact::simplex_map(form_.space().mesh(), form_.segments()[k].slave);
  double sum = 0;
  for (int q = 0; q < rule.size(); ++q)
  {
    const Point<dim> y_there = y * at_points.row(q).transpose();
    const Point<dim> slip_there = slips * of_slip.at_points.row(q).transpose();
    sum += rule.weights[q] * problem.weight(map(rule.points[q])) *
           (y_there.dot(normal) * of_gap.row(q).dot(normal_gap) + y_there.dot(slip_there));
  }
  if (thresholds.maxCoeff() > 0)
  {
    Eigen::VectorXd s = of_slip.at_nodes * thresholds;
    for (Eigen::Index i = 0; i < s.size(); ++i) s[i] *= problem.weight(map(of_slip.nodes[i]));
    sum += of_slip.integral(of_slip.from_nodes * s, slips);
  }
  return std::max(0.0, form_.segments()[k].det() * sum);
}

template AdmissibleTraction<2> admissible_traction(const contact::NitscheForm<2>&, std::span<const Point<2>>);
template AdmissibleTraction<3> admissible_traction(const contact::NitscheForm<3>&, std::span<const Point<3>>);
template class ContactGap<2>;
template class ContactGap<3>;

}  // namespace tribound::certify
