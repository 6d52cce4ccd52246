#include "tribound/contact/nitsche/rigid_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tribound/base/dense_factors.h"
#include "tribound/mesh/geometry.h"

namespace tribound::contact
{

namespace
{

/// Parts of a motion that are smaller than this, relative to the whole, are round-off.
constexpr double round_off = 1e-6;

/// "(0.5, 0)" with four digits; components that are small compared with `scale` are 0.
template <int dim>
std::string in_words(const Point<dim>& x, double scale)
{
  std::string text = "(";
  for (int i = 0; i < dim; ++i)
    text += fmt::format("{}{:.4g}", i > 0 ? ", " : "", std::abs(x[i]) > round_off * scale ? x[i] : 0.0);
  return text + ")";
}

/// "x" or "-x" for the direction of an axis, otherwise its components.
template <int dim>
std::string direction(const Point<dim>& unit)
{
  for (int i = 0; i < dim; ++i)
    if ((unit.cwiseAbs() - Point<dim>::Unit(i)).norm() <= round_off)
      return std::string(unit[i] < 0 ? "-" : "") + "xyz"[i];
  return in_words<dim>(unit, 1);
}

/// v turned by +90 degrees.
Point<2> turned(const Point<2>& v)
{
  return {-v[1], v[0]};
}

/// Gauss-Jordan elimination of the rows of `a` from row `first` on, with pivots in columns [begin, end); rows
/// without a pivot end up last. Returns the pivot columns, in the order of the rows.
std::vector<Eigen::Index> eliminate(Eigen::MatrixXd& a, Eigen::Index first, Eigen::Index begin,
                                    Eigen::Index end)
{
  std::vector<Eigen::Index> pivots;
  for (Eigen::Index row = first; row < a.rows(); ++row)
  {
    Eigen::Index i = 0;
    Eigen::Index j = 0;
    if (a.block(row, begin, a.rows() - row, end - begin).cwiseAbs().maxCoeff(&i, &j) <= round_off) break;
    a.row(row).swap(a.row(row + i));
    a.row(row) /= a(row, begin + j);
    for (Eigen::Index other = 0; other < a.rows(); ++other)
      if (other != row) a.row(other) -= a(other, begin + j) * a.row(row).eval();
    pivots.push_back(begin + j);
  }
  return pivots;
}

}  // namespace

template <int dim>
auto RigidModes<dim>::at(const Point<dim>& x) const -> ModeMatrix
{
  const Point<dim> arm = (x - centre) / size;
  ModeMatrix m;
  m.template leftCols<dim>().setIdentity();
  if constexpr (dim == 2)
    m.col(2) = turned(arm);
  else
    for (int a = 0; a < 3; ++a) m.col(3 + a) = mesh::cross(Point<3>::Unit(a), arm);
  return m;
}

template <int dim>
std::string RigidModes<dim>::describe(const Coefficients& motion) const
{
  const Point<dim> t = motion.template head<dim>();
  const auto w = motion.template tail<n_modes - dim>();
  if (w.norm() <= round_off * t.norm())
    return fmt::format("translation along {}", direction<dim>(t.normalized()));

  const double scale = std::max(size, centre.norm());
  if constexpr (dim == 2)
    return fmt::format("rotation about {}", in_words<2>(centre + size / w[0] * turned(t), scale));
  else
  {
    const Point<3> foot = centre + size / w.squaredNorm() * mesh::cross(w, t);
    const std::string axis = fmt::format("about the axis through {} along {}", in_words<3>(foot, scale),
                                         in_words<3>(w.normalized(), 1));
    const bool advances = std::abs(t.dot(w)) > round_off * (t.squaredNorm() + w.squaredNorm());
    return (advances ? "screw motion " : "rotation ") + axis;
  }
}

MotionBasis null_space(const Eigen::MatrixXd& gram, double scale)
{
  constexpr double threshold = 1e-14;
  const SymmetricEigen eigen = symmetric_eigen(gram);
  const auto n_null = (eigen.values.array() <= threshold * scale).count();  // eigenvalues ascend
  return eigen.vectors.leftCols(n_null);
}

template <int dim>
std::vector<Eigen::VectorXd> readable_basis(const MotionBasis& motions)
{
  constexpr int n_modes = RigidModes<dim>::n_modes;
  Eigen::MatrixXd rows = motions.transpose();
  std::vector<std::pair<Eigen::Index, Eigen::Index>> order;  // pivot column, row
  const auto eliminate_block = [&](Eigen::Index begin, Eigen::Index end)
  {
    const auto first = static_cast<Eigen::Index>(order.size());
    if (first == rows.rows()) return;
    for (const Eigen::Index pivot : eliminate(rows, first, begin, end))
      order.emplace_back(pivot, static_cast<Eigen::Index>(order.size()));
    const auto done = static_cast<Eigen::Index>(order.size());
    rows.block(done, begin, rows.rows() - done, end - begin).setZero();
  };
  for (Eigen::Index body = rows.cols() - n_modes; body >= 0; body -= n_modes)
  {
    eliminate_block(body + dim, body + n_modes);
    eliminate_block(body, body + dim);
  }
  std::ranges::sort(order);
  std::vector<Eigen::VectorXd> basis;
  basis.reserve(order.size());
  for (const auto& [pivot, row] : order) basis.emplace_back(rows.row(row).transpose());
  return basis;
}

template struct RigidModes<2>;
template struct RigidModes<3>;
template std::vector<Eigen::VectorXd> readable_basis<2>(const MotionBasis&);
template std::vector<Eigen::VectorXd> readable_basis<3>(const MotionBasis&);

}  // namespace tribound::contact
