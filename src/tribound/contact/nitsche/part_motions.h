#pragma once

/// @file part_motions.h
/// The small system that the motions of rigid parts add to one in which the parts are held.

#include <Eigen/Core>
#include <span>
#include <vector>

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

}  // namespace tribound::contact
