#include "tribound/contact/nitsche/part_motions.h"

#include <utility>

#include "tribound/base/dense_factors.h"
#include "tribound/base/error.h"

namespace tribound::contact
{

void PartMotions::add(std::vector<double> motion, std::span<const double> work)
{
  motions_.push_back(std::move(motion));
  const auto n = static_cast<Eigen::Index>(work.size());
  work_.conservativeResize(n, static_cast<Eigen::Index>(motions_.size()));
  work_.rightCols<1>() = Eigen::Map<const Eigen::VectorXd>(work.data(), n);
}

void PartMotions::move(std::span<const double> missing, std::span<double> u) const
{
  constexpr double rounding = 1e-13;
  const Eigen::VectorXd resistance = right_singular(work_).values;
  if (!(resistance.minCoeff() > rounding * resistance.maxCoeff()))
    throw SolveError("the matrix is singular: nothing stops a motion of a rigid part");
  const Eigen::VectorXd y =
      solve_regular(work_, Eigen::Map<const Eigen::VectorXd>(missing.data(), work_.rows()));
  for (std::size_t j = 0; j < motions_.size(); ++j)
    for (std::size_t i = 0; i < u.size(); ++i) u[i] += y[static_cast<Eigen::Index>(j)] * motions_[j][i];
}

}  // namespace tribound::contact
