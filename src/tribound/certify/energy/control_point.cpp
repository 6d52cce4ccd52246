#include "tribound/certify/energy/control_point.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <vector>

#include "tribound/base/dense_factors.h"

namespace tribound::certify
{

namespace
{

/// a.x = b or a.x <= b.
struct Row
{
  Eigen::VectorXd a;
  double b;
};

/// The free components of a control point.
template <int dim>
class FreeComponents
{
 public:
  FreeComponents(const Point<dim>& c, const std::array<bool, dim>& fixed) : c_(c)
  {
    for (int a = 0; a < dim; ++a)
      if (!fixed[a]) axes_.push_back(a);
  }

  [[nodiscard]] Eigen::Index size() const { return std::ssize(axes_); }
  [[nodiscard]] Eigen::VectorXd values() const { return c_(axes_); }
  /// The comparison of normal.c with b, as a row for the free components.
  [[nodiscard]] Row row(const Point<dim>& normal, double b) const
  {
    Point<dim> still = c_;
    still(axes_).setZero();
    return {normal(axes_), b - normal.dot(still)};
  }
  [[nodiscard]] Point<dim> with(const Eigen::VectorXd& values) const
  {
    Point<dim> result = c_;
    result(axes_) = values;
    return result;
  }

 private:
  Point<dim> c_;
  std::vector<int> axes_;
};

/// An orthonormal basis of the directions orthogonal to a normal.
template <int dim>
std::array<Point<dim>, dim - 1> tangents(const Point<dim>& normal)
{
  const Point<dim> first = normal.unitOrthogonal();
  if constexpr (dim == 2)
    return {first};
  else
    return {first, normal.cross(first)};
}

/// The rounding error of a.x for data of this size.
double rounding(const Eigen::VectorXd& x, double size)
{
  return 4e-15 * std::max(size, x.cwiseAbs().maxCoeff());
}

/// The point of an intersection of hyperplanes nearest to `target` in the norm |L^T x|; absent if they do not
/// meet.
std::optional<Eigen::VectorXd> nearest_on(const std::vector<Row>& planes, const Eigen::MatrixXd& root,
                                          const Eigen::VectorXd& target, double size)
{
  if (planes.empty()) return target;
  Eigen::MatrixXd a(std::ssize(planes), target.size());
  Eigen::VectorXd b(a.rows());
  for (Eigen::Index i = 0; i < a.rows(); ++i)
  {
    a.row(i) = planes[i].a;
    b[i] = planes[i].b;
  }
  const Eigen::MatrixXd scaled = solve_lower(root, a.transpose()).transpose();
  constexpr double threshold = 1e-12;  // for rows that depend on others up to rounding
  Eigen::VectorXd x = target;
  for (int step = 0; step < 2; ++step)  // the second removes the rounding error of the first
    x += solve_lower_transposed(root, least_norm_solution(scaled, b - a * x, threshold));
  if ((a * x - b).cwiseAbs().maxCoeff() > rounding(x, size)) return {};
  return x;
}

/// The same with a.x <= b for all `halves`. At most as many of these as there are components, three or fewer,
/// hold with equality; all choices are tried.
std::optional<Eigen::VectorXd> nearest_in(const std::vector<Row>& planes, const std::vector<Row>& halves,
                                          const Eigen::MatrixXd& root, const Eigen::VectorXd& target,
                                          double size)
{
  std::optional<Eigen::VectorXd> best;
  double least = 0;
  std::vector<Row> chosen = planes;
  const auto search = [&](const auto& self, std::size_t first, Eigen::Index depth) -> void
  {
    const auto x = nearest_on(chosen, root, target, size);
    if (!x) return;  // with more planes they do not meet, either
    const double distance = (root.transpose() * (*x - target)).norm();
    if (best && distance >= least) return;  // with more planes the point is no nearer
    if (std::ranges::all_of(halves,
                            [&](const Row& row) { return row.a.dot(*x) <= row.b + rounding(*x, size); }))
    {
      best = x;
      least = distance;
      return;
    }
    if (depth == target.size()) return;
    for (std::size_t i = first; i < halves.size(); ++i)
    {
      chosen.push_back(halves[i]);
      self(self, i + 1, depth + 1);
      chosen.pop_back();
    }
  };
  search(search, 0, 0);
  return best;
}

/// The conditions of closed and sticking facets as equalities, the others as inequalities.
template <int dim>
std::optional<Point<dim>> as_wanted(const FreeComponents<dim>& components,
                                    std::span<const ControlCondition<dim>> conditions, double size)
{
  std::vector<Row> planes;
  std::vector<Row> halves;
  for (const ControlCondition<dim>& condition : conditions)
  {
    const Row row = components.row(condition.normal, condition.gap);
    (condition.closed ? planes : halves).push_back(row);
    if (condition.sticks)
      for (const Point<dim>& along : tangents<dim>(condition.normal))
        planes.push_back(components.row(along, 0));
  }
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(components.size(), components.size());
  const auto x = nearest_in(planes, halves, identity, components.values(), size);
  if (!x) return {};
  return components.with(*x);
}

/// The compromise: the sum to be minimised is (c - target)^T H (c - target) + constant.
template <int dim>
std::optional<Point<dim>> compromise(const FreeComponents<dim>& components,
                                     std::span<const ControlCondition<dim>> conditions, double size)
{
  const Eigen::Index n = components.size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd vector = Eigen::VectorXd::Zero(n);
  std::vector<Row> halves;
  const auto add = [&](const Row& row, double weight)
  {
    matrix += weight * row.a * row.a.transpose();
    vector += weight * row.b * row.a;
  };
  for (const ControlCondition<dim>& condition : conditions)
  {
    halves.push_back(components.row(condition.normal, condition.gap));
    if (condition.closed) add(halves.back(), condition.pressure);
    if (condition.sticks)
      for (const Point<dim>& along : tangents<dim>(condition.normal))
        add(components.row(along, 0), condition.friction);
  }
  constexpr double small = 1e-6;  // relative to the weights
  const double eps = matrix.trace() > 0 ? small * matrix.trace() : 1;
  matrix.diagonal().array() += eps;
  vector += eps * components.values();
  const CholeskyFactors factors(matrix);
  const auto x = nearest_in({}, halves, factors.lower(), factors.solve(vector), size);
  if (!x) return {};
  return components.with(*x);
}

}  // namespace

template <int dim>
Point<dim> moved(const Point<dim>& c, const std::array<bool, dim>& fixed,
                 std::span<const ControlCondition<dim>> conditions)
{
  const bool is_free = std::ranges::none_of(fixed, [](bool x) { return x; });
  if (is_free && conditions.size() == 1)
  {
    const ControlCondition<dim>& only = conditions[0];
    const double along = only.normal.dot(c);
    const Point<dim> tangential = only.sticks ? Point<dim>::Zero() : Point<dim>(c - along * only.normal);
    if (!only.sticks && !only.closed && along <= only.gap) return c;
    return (only.closed ? only.gap : std::min(along, only.gap)) * only.normal + tangential;
  }
  const FreeComponents<dim> components(c, fixed);
  if (components.size() == 0) return c;
  double size = c.cwiseAbs().maxCoeff();
  for (const ControlCondition<dim>& condition : conditions) size = std::max(size, std::abs(condition.gap));
  if (const auto x = as_wanted<dim>(components, conditions, size)) return *x;
  if (const auto x = compromise<dim>(components, conditions, size)) return *x;
  return c;
}

template Point<2> moved<2>(const Point<2>&, const std::array<bool, 2>&, std::span<const ControlCondition<2>>);
template Point<3> moved<3>(const Point<3>&, const std::array<bool, 3>&, std::span<const ControlCondition<3>>);

}  // namespace tribound::certify
