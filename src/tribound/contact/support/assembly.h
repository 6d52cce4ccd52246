#pragma once

/// @file assembly.h
/// Bodies joined by contact: a motion of one may move the others.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/contact/nitsche/rigid_modes.h"
#include "tribound/contact/nitsche/segment.h"
#include "tribound/contact/support/body.h"
#include "tribound/fem/space.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// A contact segment of an assembly.
struct AssemblySegment
{
  std::size_t number;         ///< number of the segment
  int slave;                  ///< number of its body in the assembly
  std::optional<int> master;  ///< absent: a rigid obstacle
};

/// Bodies that are connected through pairs; a body in no pair is an assembly of its own. Its rigid motions
/// consist of one for each body, z = (z_1 ... z_nb), as vectors of the coefficients of z_1, then z_2, ...
template <int dim>
struct Assembly
{
  RigidModes<dim> modes;  ///< of every body: about the mean of all vertices, scaled by the farthest of them
  std::vector<Body<dim>> bodies;
  std::vector<AssemblySegment> segments;

  [[nodiscard]] int n_motions() const { return RigidModes<dim>::n_modes * static_cast<int>(bodies.size()); }
  /// The numbers of the coefficients of body b.
  [[nodiscard]] static std::vector<int> coefficients(int b);
  /// The coefficients of body b.
  [[nodiscard]] static auto part(const Eigen::VectorXd& motion, int b)
  {
    return motion.segment<RigidModes<dim>::n_modes>(RigidModes<dim>::n_modes * b);
  }

  /// A basis of the same space for users to read: motions of all bodies together, then motions of fewer;
  /// first translations, then rotations, each along the coordinate axes where possible.
  [[nodiscard]] std::vector<Eigen::VectorXd> readable_basis(const MotionBasis& motions) const;

  /// `the body (region "steel")`, `the bodies around (0, 1) (region "dam") and around (0, -1) (region
  /// "rock")`.
  [[nodiscard]] std::string describe(const problem::Problem<dim>& problem, bool several) const;
  /// `translation along x`; if bodies move differently, the motion of each that moves.
  [[nodiscard]] std::string describe(const problem::Problem<dim>& problem,
                                     const Eigen::VectorXd& motion) const;
};

/// [z] of rigid motions on a segment of an assembly.
template <int dim>
class MotionJump
{
 public:
  MotionJump(const mesh::Mesh<dim>& mesh, const Assembly<dim>& assembly, const AssemblySegment& entry,
             const ContactSegment<dim>& segment);

  /// The numbers of the coefficients of the motions of its one or two bodies.
  [[nodiscard]] const std::vector<int>& coefficients() const { return coefficients_; }
  /// M with [z] = M z(coefficients()) at the point with coordinates s on the segment.
  [[nodiscard]] Eigen::Matrix<double, dim, Eigen::Dynamic> operator()(const Point<dim - 1>& s) const;

 private:
  const RigidModes<dim>& modes_;
  SimplexMap<dim - 1, dim> slave_;
  std::optional<SimplexMap<dim - 1, dim>> master_;
  std::vector<int> coefficients_;
};

/// Calls visit(entry, segment, N, coefficients, M) at each corner of each segment of the assembly, with the
/// direction N of contact and [z] = M z(coefficients). The segment numbers of the assembly refer to
/// `segments`.
template <int dim, class Visit>
void for_each_corner(const mesh::Mesh<dim>& mesh, std::span<const ContactSegment<dim>> segments,
                     const Assembly<dim>& assembly, const Visit& visit)
{
  for (const AssemblySegment& entry : assembly.segments)
  {
    const ContactSegment<dim>& segment = segments[entry.number];
    const MotionJump<dim> jump(mesh, assembly, entry, segment);
    const SimplexMap<dim - 1, dim> map = simplex_map(mesh, segment.slave);
    for (const Point<dim - 1>& s : fem::reference_simplex<dim - 1>())
      visit(entry, segment, segment.normal_at(map(s)), jump.coefficients(), jump(s));
  }
}

/// All assemblies, ordered by the first body of each.
template <int dim>
[[nodiscard]] std::vector<Assembly<dim>> find_assemblies(const fem::LagrangeSpace<dim>& space,
                                                         std::span<const ContactSegment<dim>> segments);

}  // namespace tribound::contact
