#pragma once

/// @file report.h
/// What a run is reported by. Plain data in, text out; what is not known is absent, never zero.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tribound/adapt/level.h"
#include "tribound/certify/bound/balance.h"
#include "tribound/certify/bound/certificate.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/doctor/findings.h"
#include "tribound/io/record/facts.h"
#include "tribound/solve/newton.h"

namespace tribound::io
{

/// What the contact traction adds up to; forces (per unit depth in 2D).
struct Resultants
{
  std::string boundary;       ///< name of the boundary group; empty for the whole of Gamma_C
  std::vector<double> force;  ///< integral of T, acts on the body
  double normal = 0.0;        ///< integral of T^n, negative in compression
  double tangential = 0.0;    ///< 2D: integral of T.t with t = n turned by +90 degrees; 3D: |integral of T^t|
  double abs_tangential = 0.0;  ///< integral of |T^t|
  /// mu_F of Coulomb's friction where it alone keeps a body from sliding along a boundary that is nearly
  /// plane (slides_as_a_whole).
  std::optional<double> coefficient{};
  double resolution = 0.0;  ///< forces are known to this much: the distance of T(u^k) from t^k
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
  std::vector<Resultants> boundary_contact;  ///< of every boundary group with contact
  double round_off = 0.0;                    ///< a stress below is nothing but rounding
};

/// The figures of the solution on a level, with the contact traction T(u). Forces have only the digits that
/// are known of the discrete solution: t^k is in equilibrium with the loads, T(u^k) obeys the laws of
/// contact, and what they differ by Newton's method has still to find. A stress that is nothing but rounding
/// is 0.
template <int dim>
[[nodiscard]] SolutionFigures solution_figures(const contact::NitscheForm<dim>& form,
                                               const adapt::CertifiedLevel<dim>& level);

/// Seconds on a level, wall time where nothing else is said.
struct LevelTimes
{
  double solve = 0.0;
  std::optional<double> certify;
  double level = 0.0;  ///< everything, output included
  adapt::RefinementSeconds refinement;
  double output = 0.0;
  double solve_cpu = 0.0;  ///< CPU time, all threads
  double certify_cpu = 0.0;
  double level_cpu = 0.0;
};

struct LevelRecord
{
  int level = 0;
  long cells = 0;
  long dofs = 0;  ///< free ones
  std::vector<adapt::CertifiedStep> newton;
  int finishing_steps = 0;           ///< the last of them, with which Newton's method has converged fully
  std::optional<int> delta_updates;  ///< of the regularised variant; absent in the plain method
  SolutionFigures figures;
  std::optional<certify::Bound> bound;
  std::optional<certify::IdentityDefects> identities;
  std::optional<certify::Balance> balance;  ///< where there is a bound
  LevelTimes times;
};

/// Whether it is one of the regularised variant, method section 7.
[[nodiscard]] bool is_regularised(const LevelRecord& level);

/// Newton steps until the stopping criterion held, without those that finish the last level.
[[nodiscard]] int newton_steps(const LevelRecord& level);

/// delta of T_delta in the last Newton step.
[[nodiscard]] std::optional<double> last_delta(const LevelRecord& level);

/// bound / ||sigma(u_h)||, if both are there.
[[nodiscard]] std::optional<double> relative_bound(const LevelRecord& level);

/// Whether the stress is zero as far as rounding lets it be known, and so is the bound.
[[nodiscard]] bool is_round_off(const LevelRecord& level);

struct RunRecord
{
  CaseFacts facts;
  MeshFacts mesh;  ///< the first mesh
  BuildFacts build;
  certify::RunStatus status = certify::RunStatus::uncertified;
  std::string reason;  ///< why the run is not certified, or what failed; empty when certified
  std::vector<LevelRecord> levels;
  double tolerance = 0.0;  ///< of bound / ||sigma(u_h)||
  certify::Statements statements;
  std::vector<doctor::Finding> warnings;              ///< about the last level
  EffectiveCase effective;                            ///< empty where the run is a part of something larger
  std::string case_file = "case.toml";                ///< where it is written in the output directory
  std::vector<std::pair<std::string, double>> times;  ///< s per stage of the whole run
};

/// The certificate, JSON with the fields of docs/output.md; unknown numbers are null.
[[nodiscard]] std::string certificate_json(const RunRecord& run);

/// Writes the effective case, convergence.csv, newton.csv and certificate.json, the last one last. Throws
/// WriteError when a file cannot be written.
void write_report(const std::filesystem::path& directory, const RunRecord& run);

}  // namespace tribound::io
