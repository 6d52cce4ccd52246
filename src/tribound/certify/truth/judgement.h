#pragma once

/// @file judgement.h
/// The guaranteed error of the solution of another program, from its distance to ours and the bound of ours.

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/certify/truth/foreign_solution.h"
#include "tribound/fem/space.h"
#include "tribound/problem/problem.h"

namespace tribound::certify
{

/// lower <= error <= upper; the upper end may be infinite.
struct ErrorInterval
{
  double lower = 0;
  double upper = std::numeric_limits<double>::infinity();
};

/// max(0, d - B) <= ||u - v|| <= d + B for ||u - u_h|| <= B and d = ||v - u_h||, over the whole or any part.
/// d, whose square is exact up to the part `doubt`, is that `distance`.
[[nodiscard]] ErrorInterval error_interval(double distance, double bound, double doubt = 0);
/// The same over ||u||, which lies in ||u_h|| -+ B: [lower / (||u_h|| + B), upper / (||u_h|| - B)].
[[nodiscard]] ErrorInterval relative_interval(const ErrorInterval& error, double norm, double bound,
                                              double doubt = 0);

/// The error on a part of the body.
struct JudgedRegion
{
  std::string name;
  double distance = 0;
  ErrorInterval error{};
};

/// A small part of the body with a large share of the error.
struct ErrorCore
{
  double share = 0;   ///< at least this part of the square of the whole error lies there
  double volume = 0;  ///< its part of the volume
  std::size_t n_cells = 0;
  std::vector<double> centre{};  ///< centroid of d_K^2
};

/// A displacement, or a stress.
struct JudgedField
{
  double distance = 0;                      ///< d
  ErrorInterval error{};                    ///< in the energy norm; of stresses in C^-1
  std::optional<ErrorInterval> relative{};  ///< absent: the size of the exact one is not known
  std::vector<JudgedRegion> regions{};
  std::vector<double> cells{};  ///< d_K of the cells of the mesh that was judged on
  ErrorCore core{};
  std::vector<Index> halving{};  ///< the fewest cells without which at most half of d is left
};

/// The rigid motion nearest to v - u_h at the vertices: rotations about the centroid of the body. Of an
/// axisymmetric body along the axis.
struct RigidDifference
{
  int body = 0;
  std::vector<double> translation{};
  std::vector<double> rotation{};
};

struct Judgement
{
  double bound = 0;        ///< B
  double energy_norm = 0;  ///< ||u_h||
  JudgedField displacement{};
  std::optional<JudgedField> stress{};
  double factor = 0;    ///< a(u_h, v) / a(v, v)
  std::string doubt{};  ///< what the factor says of units or signs; empty: nothing
  std::vector<RigidDifference> rigid{};
};

/// Judges u_h of `space`, whose mesh comes from `mesh` by bisect(), against v on `mesh`. `bound`: of u_h in
/// the energy norm. The statements hold for what u_h's bound holds for. Norms of an axisymmetric problem are
/// those of one radian in `bound`, and of the full circle in the result.
template <int dim>
[[nodiscard]] Judgement judge(const problem::Problem<dim>& problem,
                              const fem::LagrangeSpace<dim>& their_space, const ForeignSolution<dim>& theirs,
                              const fem::LagrangeSpace<dim>& space, std::span<const double> u, double bound);

}  // namespace tribound::certify
