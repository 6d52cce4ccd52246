#pragma once

/// @file part_motions.h
/// The small system that the motions of rigid parts add to one in which the parts are held.

#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

#include "tribound/contact/nitsche/rigid_parts.h"

namespace tribound::contact
{

/// Functions w_j = chi_j + what follows it with the parts held, and the work of their forces in chi_i.
class PartMotions
{
 public:
  /// w_j, and the work of its forces in every chi_i.
  void add(std::vector<double> motion, std::span<const double> work);
  [[nodiscard]] bool empty() const { return motions_.empty(); }
  /// u += sum_j y_j w_j such that the forces do the `missing` work in every chi_i. Throws SolveError where a
  /// motion meets no resistance.
  void move(std::span<const double> missing, std::span<double> u) const;

 private:
  std::vector<std::vector<double>> motions_;
  Eigen::MatrixXd work_;  ///< by columns
};

/// `forces(w)`: the forces of w at every degree of freedom; `held(f)`: the displacement, 0 on the parts, that
/// the forces f on all else cause.
template <int dim, class Forces, class Held>
[[nodiscard]] PartMotions part_motions(const RigidParts<dim>& parts, const Forces& forces, const Held& held)
{
  PartMotions result;
  for (std::size_t j = 0; j < parts.size(); ++j)
  {
    std::vector<double> motion = parts.motion(j);
    const std::vector<double> others = held(forces(motion));
    for (std::size_t i = 0; i < others.size(); ++i) motion[i] -= others[i];
    const std::vector<double> work = parts.along(forces(motion));
    result.add(std::move(motion), work);
  }
  return result;
}

/// Moves the parts in u so that its forces do the work of b in their motions.
template <int dim, class Forces>
void move_parts(const RigidParts<dim>& parts, const PartMotions& motions, const Forces& forces,
                std::span<const double> b, std::span<double> u)
{
  std::vector<double> missing = forces(u);
  for (std::size_t i = 0; i < missing.size(); ++i) missing[i] = b[i] - missing[i];
  motions.move(parts.along(missing), u);
}

}  // namespace tribound::contact
