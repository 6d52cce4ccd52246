#include "tribound/contact/support/cone.h"

#include <algorithm>
#include <cassert>
#include <vector>

#include "tribound/base/dense_factors.h"

namespace tribound::contact
{

namespace
{

/// The columns in use and their coefficients, all positive.
struct ActiveSet
{
  std::vector<Eigen::Index> columns;
  std::vector<double> x;
};

/// Removes the columns whose coefficient is not positive.
void drop_nonpositive(ActiveSet& active)
{
  std::size_t kept = 0;
  for (std::size_t i = 0; i < active.x.size(); ++i)
  {
    if (active.x[i] <= 0) continue;
    active.columns[kept] = active.columns[i];
    active.x[kept++] = active.x[i];
  }
  active.columns.resize(kept);
  active.x.resize(kept);
}

/// Moves x towards the least-squares solution on the active columns, dropping each column whose coefficient
/// reaches 0 on the way, until that solution itself is positive.
void solve_on_active_set(const Eigen::MatrixXd& columns, const Eigen::VectorXd& b, ActiveSet& active)
{
  while (!active.columns.empty())
  {
    const Eigen::MatrixXd selected = columns(Eigen::all, active.columns);
    const Eigen::VectorXd target = PivotedQr(selected).solve(b);
    double alpha = 1;
    for (std::size_t i = 0; i < active.x.size(); ++i)
      if (target[static_cast<Eigen::Index>(i)] <= 0)
        alpha = std::min(alpha, active.x[i] / (active.x[i] - target[static_cast<Eigen::Index>(i)]));
    for (std::size_t i = 0; i < active.x.size(); ++i)
    {
      const double goal = target[static_cast<Eigen::Index>(i)];
      const bool leaves = goal <= 0 && active.x[i] <= alpha * (active.x[i] - goal);
      active.x[i] = leaves ? 0 : active.x[i] + alpha * (goal - active.x[i]);
    }
    drop_nonpositive(active);
    if (alpha == 1) return;
  }
}

}  // namespace

Eigen::VectorXd project_on_polar_cone(const Eigen::MatrixXd& columns, const Eigen::VectorXd& b)
{
  assert(columns.rows() == b.size());
  constexpr int max_exchanges = 300;       // about 10 are usual
  constexpr double inside = 1e-10;         // of |b|
  constexpr double perpendicular = 1e-12;  // of |r| |C_j|
  const Eigen::VectorXd lengths = columns.colwise().norm();
  const double b_norm = b.norm();
  ActiveSet active;
  Eigen::VectorXd r = b;
  for (int i = 0; i < max_exchanges && columns.cols() > 0 && r.norm() > inside * b_norm; ++i)
  {
    Eigen::Index entering = 0;
    const double gain = (columns.transpose() * r - perpendicular * r.norm() * lengths).maxCoeff(&entering);
    if (gain <= 0 || std::ranges::count(active.columns, entering) > 0) break;
    active.columns.push_back(entering);
    active.x.push_back(0);
    solve_on_active_set(columns, b, active);

    Eigen::VectorXd next = b;
    for (std::size_t k = 0; k < active.x.size(); ++k) next -= active.x[k] * columns.col(active.columns[k]);
    if (next.norm() >= r.norm()) break;  // the gain was round-off
    r = next;
  }
  return r;
}

}  // namespace tribound::contact
