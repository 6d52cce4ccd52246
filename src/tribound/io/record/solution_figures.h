#pragma once

/// @file solution_figures.h
/// The figures by which a discrete solution is judged and compared: norms, contact forces, sliding.

#include <optional>
#include <string>
#include <vector>

#include "tribound/adapt/level.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::io
{

/// What else there is to know of a slave boundary and what it touches.
struct PairFigures
{
  std::vector<std::string> master;  ///< names of its boundaries
  std::string law;                  ///< in words
  long segments = 0;
  double covered = 0;  ///< length or area of the slave with a part of the master opposite
  double covered_share = 0;
  double covered_master = 0;  ///< what of the master these parts take up
  double smallest_gap = 0;    ///< of g - [u]^n at the quadrature points
  double largest_gap = 0;
  double largest_tension = 0;              ///< largest T^n there; 0 but for ties
  std::vector<double> moment_on_master{};  ///< -integral of Pi(x) x T, about the origin
};

/// A body of several: a part of the mesh that is connected through facets.
struct BodyFigures
{
  std::string name;  ///< of its regions, joined by +, and a number where several have the same
  long cells = 0;
  double energy = 0;  ///< its part of a(u, u)
  double bound = 0;   ///< its part of the bound: the squares add up
};

/// What the contact traction adds up to; forces (per unit depth in 2D).
struct Resultants
{
  std::string boundary;       ///< name of the boundary group; empty for the whole of Gamma_C
  std::vector<double> force;  ///< integral of T, acts on the body
  double normal = 0.0;        ///< integral of T^n, negative in compression
  double tangential = 0.0;    ///< 2D: integral of T.t with t = n turned by +90 degrees; 3D: |integral of T^t|
  double abs_tangential = 0.0;  ///< integral of |T^t|
  /// mu_F of Coulomb's friction where it alone keeps a body from sliding along a boundary that is nearly
  /// plane.
  std::optional<double> coefficient{};
  double resolution = 0.0;            ///< forces are known to this much: the distance of T(u^k) from t^k
  std::vector<double> moment{};       ///< integral of x x T about the origin, in 2D one number
  std::optional<PairFigures> pair{};  ///< of a slave
};

/// The value rounded to the decimal place of its resolution; 0 where it is not larger. Numbers that are not
/// finite stay.
[[nodiscard]] double known_digits(double value, double resolution);

/// How far a boundary with Coulomb friction is from sliding as a whole, as dams and walls are judged:
/// N = -(integral of T^n), H = |tangential resultant|.
struct Sliding
{
  double coefficient = 0.0;             ///< mu_F
  double sliding_factor = 0.0;          ///< H / N: the friction coefficient that is mobilised
  std::optional<double> safety_factor;  ///< mu_F N / H; nothing where no force makes it slide
};

/// Nothing without Resultants::coefficient or without a normal force. A force H below the resolution, or
/// 1e-10 N, counts as none; the numbers have the digits that it leaves them.
[[nodiscard]] std::optional<Sliding> sliding(const Resultants& resultants);

/// The figures by which a discrete solution is compared with others.
struct SolutionFigures
{
  double energy = 0.0;            ///< a(u, u), not halved
  double sigma_norm = 0.0;        ///< ||sigma(u)||
  double max_displacement = 0.0;  ///< largest |u| at a node
  Resultants contact;
  std::vector<Resultants> boundary_contact;  ///< of every obstacle and slave among the boundary groups
  std::vector<BodyFigures> bodies;           ///< where bodies touch each other
  double round_off = 0.0;                    ///< a stress below is nothing but rounding
};

/// The figures of the solution on a level, with the contact traction T(u). Forces have only the digits that
/// are known of the discrete solution: t^k is in equilibrium with the loads, T(u^k) obeys the laws of
/// contact, and what they differ by Newton's method has still to find. A stress that is nothing but rounding
/// is 0. `slides`: as doctor::slides_as_a_whole() has it.
template <int dim>
[[nodiscard]] SolutionFigures solution_figures(const contact::NitscheForm<dim>& form,
                                               const adapt::CertifiedLevel<dim>& level,
                                               const std::vector<bool>& slides);

}  // namespace tribound::io
