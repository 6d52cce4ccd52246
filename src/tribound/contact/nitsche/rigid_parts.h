#pragma once

/// @file rigid_parts.h
/// Parts of the boundary that move as rigid bodies, method section 17.

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/contact/nitsche/rigid_modes.h"
#include "tribound/fem/space.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// A matrix R such that exactly the motions with R z = 0, z the coefficients of the modes, are left to the
/// part.
template <int dim>
[[nodiscard]] Eigen::MatrixXd fixed_motions(const problem::RigidPart<dim>& part,
                                            const RigidModes<dim>& modes);

/// The motion of a part: t + w x (x - point).
template <int dim>
struct PartMotion
{
  int tag;  ///< of the boundary
  Point<dim> translation;
  Eigen::Matrix<double, problem::RigidPart<dim>::n_rotations, 1> rotation;
};

/// The functions chi_i of V_h, i < size(), that are a rigid motion at the nodes of one part S and 0 at all
/// other nodes. V_h consists of them and the functions that vanish on all parts. They are orthonormal in the
/// Euclidean product of degrees of freedom. Vectors have an entry for each degree of freedom. All ranks
/// construct it and call its members together.
template <int dim>
class RigidParts
{
 public:
  /// Throws InputError where a part lies on several bodies, or meets another, or a boundary that clamps a
  /// component which the part can move there.
  RigidParts(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space);

  [[nodiscard]] std::size_t size() const { return n_motions_; }
  [[nodiscard]] bool empty() const { return parts_.empty(); }

  /// chi_i . vector, of all ranks: the work in each motion; of a displacement the r of sum_i r_i chi_i.
  [[nodiscard]] std::vector<double> along(std::span<const double> vector) const;
  /// chi_i.
  [[nodiscard]] std::vector<double> motion(std::size_t i) const;
  /// vector += sum_i r_i chi_i.
  void add(std::span<const double> r, std::span<double> vector) const;
  /// Sets the entries on the parts to sum_i r_i chi_i.
  void set(std::span<const double> r, std::span<double> vector) const;
  /// Adds nodal forces with that work, also along motions that are fixed.
  void add_load(std::span<double> vector) const;
  /// The work of the given forces and moments in chi_i, of axisymmetric problems for one radian.
  [[nodiscard]] std::span<const double> load() const { return load_; }
  /// Per degree of freedom: 1 on the parts.
  [[nodiscard]] std::vector<char> marks() const;
  /// The motion of each part in u.
  [[nodiscard]] std::vector<PartMotion<dim>> motions(const problem::Problem<dim>& problem,
                                                     std::span<const double> u) const;

  /// chi_i(x) on the part it belongs to, i the number within the part.
  struct Part
  {
    int tag;                  ///< of the boundary
    RigidModes<dim> modes;    ///< about the middle of the part
    Eigen::MatrixXd motions;  ///< chi_i by columns: coefficients of the modes
    Eigen::VectorXd forces;   ///< nodal forces of the load, likewise
    std::size_t first = 0;    ///< its motions are number first, ...

    [[nodiscard]] Eigen::Matrix<double, dim, Eigen::Dynamic> at(const Point<dim>& x) const
    {
      return modes.at(x) * motions;
    }
  };
  /// The part that boundary number `tag` is, or null.
  [[nodiscard]] const Part* on(int tag) const;

 private:
  /// A node of a part.
  struct Node
  {
    Index node;
    int part;
    bool is_own;
    Point<dim> x;
  };
  void find_nodes(const problem::Problem<dim>& problem);
  void find_motions(const problem::Problem<dim>& problem);
  void check_bodies(const problem::Problem<dim>& problem) const;
  void check_neighbours(const problem::Problem<dim>& problem) const;
  void find_load(const problem::Problem<dim>& problem, const Eigen::MatrixXd& gram, Part& part);

  const fem::LagrangeSpace<dim>* space_;
  std::vector<Part> parts_;
  std::vector<Node> nodes_;
  std::size_t n_motions_ = 0;
  std::vector<double> load_;
};

}  // namespace tribound::contact
