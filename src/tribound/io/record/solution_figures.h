#pragma once

/// @file solution_figures.h
/// Figures to judge and compare discrete solutions: norms, contact forces, sliding.

#include <optional>
#include <string>
#include <vector>

#include "tribound/adapt/level.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/mesh/bodies.h"

namespace tribound::io
{

/// Further figures of a slave boundary and its masters.
struct PairFigures
{
  std::vector<std::string> master;  ///< names of its boundaries
  std::string law;                  ///< in words
  long segments = 0;
  double covered = 0;  ///< length or area of the slave with a part of the master opposite
  double covered_share = 0;
  double covered_master = 0;  ///< the part of the master opposite these parts
  double smallest_gap = 0;    ///< of g - [u]^n at the quadrature points
  double largest_gap = 0;
  double largest_tension = 0;              ///< largest T^n there; 0 except for ties
  std::vector<double> moment_on_master{};  ///< -integral of Pi(x) x T, about the origin
};

/// One of several bodies: a part of the mesh connected through facets.
struct BodyFigures
{
  std::string name;  ///< body_names()
  long cells = 0;
  double energy = 0;  ///< its part of a(u, u)
  double bound = 0;   ///< its part of the bound: the squares add up
};

/// The name of every body: that of its regions, joined by +, with a number where several have the same. All
/// ranks call it together.
template <int dim>
[[nodiscard]] std::vector<std::string> body_names(const mesh::Mesh<dim>& mesh, const mesh::Bodies& bodies);

/// Resultants of the contact traction; forces (per unit depth in 2D).
struct Resultants
{
  std::string boundary;       ///< name of the boundary group; empty for the whole of Gamma_C
  std::vector<double> force;  ///< integral of T, acts on the body
  double normal = 0.0;        ///< integral of T^n, negative in compression
  double tangential = 0.0;    ///< 2D: integral of T.t with t = n turned by +90 degrees; 3D: |integral of T^t|
  double abs_tangential = 0.0;  ///< integral of |T^t|
  /// mu_F of Coulomb friction where it alone keeps a body from sliding along a nearly plane boundary.
  std::optional<double> coefficient{};
  double resolution = 0.0;            ///< accuracy of the forces: the distance of T(u^k) from t^k
  std::vector<double> moment{};       ///< integral of x x T about the origin, in 2D one number
  std::optional<PairFigures> pair{};  ///< of a slave
};

/// The value rounded to the decimal place of its resolution; 0 where it does not exceed this. Non-finite
/// values are unchanged.
[[nodiscard]] double known_digits(double value, double resolution);

/// Safety of a boundary with Coulomb friction against sliding as a whole, as for dams and walls: N =
/// -(integral of T^n), H = |tangential resultant|.
struct Sliding
{
  double coefficient = 0.0;             ///< mu_F
  double sliding_factor = 0.0;          ///< H / N: the mobilised friction coefficient
  std::optional<double> safety_factor;  ///< mu_F N / H; nothing where no force makes it slide
};

/// Nothing without Resultants::coefficient or without a normal force. A force H below the resolution, or
/// below 1e-10 N, counts as zero; the numbers have the digits that the resolution justifies.
[[nodiscard]] std::optional<Sliding> sliding(const Resultants& resultants);

/// How a rigid part of the boundary moves.
struct RigidFigures
{
  std::string boundary;
  std::vector<double> displacement;  ///< of its point
  std::vector<double> rotation;      ///< small; 2D: one number, positive from x to y
};

/// Figures to compare discrete solutions.
struct SolutionFigures
{
  double energy = 0.0;            ///< a(u, u), not halved
  double sigma_norm = 0.0;        ///< ||sigma(u)||
  double max_displacement = 0.0;  ///< largest |u| at a node
  Resultants contact;
  std::vector<Resultants> boundary_contact;  ///< of every obstacle and slave among the boundary groups
  std::vector<BodyFigures> bodies;           ///< where there are bodies in contact
  double round_off = 0.0;                    ///< a smaller stress is mere rounding
  std::optional<double> spring_energy{};     ///< (K (u - u_0), u - u_0)_S, not halved; with springs
  std::vector<RigidFigures> rigid_parts{};
};

/// The figures of the solution on a level, with the contact traction T(u). Forces have only the known digits
/// of the discrete solution: t^k is in equilibrium with the loads, T(u^k) satisfies the contact laws, and
/// their difference is the remaining error of Newton's method. A stress at rounding level is 0. `slides`: as
/// in doctor::slides_as_a_whole(). `units`: of the laws in words.
template <int dim>
[[nodiscard]] SolutionFigures solution_figures(const contact::NitscheForm<dim>& form,
                                               const adapt::CertifiedLevel<dim>& level,
                                               const std::vector<bool>& slides,
                                               const problem::Units& units = {});

}  // namespace tribound::io
