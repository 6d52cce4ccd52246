#pragma once

/// @file level_record.h
/// The recorded data of a level; what is unknown is absent, never zero.

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "tribound/adapt/loop.h"
#include "tribound/certify/bound/balance.h"
#include "tribound/certify/bound/certificate.h"
#include "tribound/io/record/load_step_record.h"
#include "tribound/io/record/probes.h"
#include "tribound/io/record/sections.h"
#include "tribound/io/record/solution_figures.h"

namespace tribound::io
{

/// Wall time of the stages of a level, or of all levels of a run; s.
struct StageTimes
{
  double solve = 0.0;
  double certify = 0.0;
  double bisect = 0.0;      ///< this and the next two: of making the mesh, 0 for the first
  double discretise = 0.0;  ///< space, load and contact points
  double transfer = 0.0;    ///< transfer of the solution
  double output = 0.0;

  StageTimes& operator+=(const StageTimes& other);
};

/// In the order used in all files.
inline constexpr std::array<std::pair<const char*, double StageTimes::*>, 6> stages = {
    {{"solve", &StageTimes::solve},
     {"certify", &StageTimes::certify},
     {"bisect", &StageTimes::bisect},
     {"discretise", &StageTimes::discretise},
     {"transfer", &StageTimes::transfer},
     {"output", &StageTimes::output}}};

struct LevelTimes
{
  StageTimes stages;
  double level = 0.0;      ///< wall time of work on it; its output may overlap the next level; s
  double solve_cpu = 0.0;  ///< CPU time, all threads; s
  double certify_cpu = 0.0;
  double output_cpu = 0.0;
  double level_cpu = 0.0;
  int factorisations = 0;  ///< of sparse matrices by this process
};

struct LevelRecord
{
  int level = 0;
  long cells = 0;
  long dofs = 0;  ///< free ones
  std::vector<adapt::CertifiedStep> newton;
  int finishing_steps = 0;           ///< those at the end, in which Newton's method converged fully
  std::optional<int> delta_updates;  ///< of the regularised variant; absent in the plain method
  bool paired = false;               ///< whether there are bodies in contact
  SolutionFigures figures;
  std::optional<certify::Bound> bound;
  std::optional<certify::IdentityDefects> identities;
  std::optional<certify::Balance> balance;       ///< where there is a bound
  std::optional<certify::EnergyBound> energy{};  ///< without its cells; absent: not asked for
  LevelTimes times;
  /// Present for a load step, whose number is `level`, or for the worst one of a pass.
  std::optional<LoadStepRecord> load_step;
  std::optional<int> load_step_number;    ///< of the worst step, where `level` is the number of a pass
  std::vector<ProbeRecord> probes{};      ///< where there is a solution
  std::vector<SectionRecord> sections{};  ///< where there is a bound
};

/// The record of a level reported by the loop, with moments about the given point; `slides` and `units`: as
/// solution_figures() has them. Where the verdict says that there is no bound, no step shows one. The times
/// of output, level_cpu and factorisations are not set.
template <int dim>
[[nodiscard]] LevelRecord level_record(const adapt::LevelView<dim>& view, const Point<dim>& moment_about,
                                       const std::vector<bool>& slides, const problem::Units& units = {});

/// bound / largest_sigma for a load step; otherwise nothing, also where there is no stress.
[[nodiscard]] std::optional<double> bound_along_path(const LevelRecord& level);

/// Whether the level is one of the regularised variant, method section 7.
[[nodiscard]] bool is_regularised(const LevelRecord& level);

/// The kind of a run, from one level or from all.
[[nodiscard]] certify::RunKind run_kind(const LevelRecord& level);
[[nodiscard]] certify::RunKind run_kind(std::span<const LevelRecord> levels);

/// Newton steps until the stopping criterion held, without those that finish the last level; all steps for a
/// load step.
[[nodiscard]] int newton_steps(const LevelRecord& level);

/// delta of T_delta in the last Newton step.
[[nodiscard]] std::optional<double> last_delta(const LevelRecord& level);

/// A value of a bound, if there is one.
[[nodiscard]] std::optional<double> bound_value(const std::optional<certify::Bound>& bound,
                                                double certify::Bound::*number);

/// bound / ||sigma(u_h)||, if both exist.
[[nodiscard]] std::optional<double> relative_bound(const LevelRecord& level);

/// Whether the stress is zero up to rounding, and so is the bound.
[[nodiscard]] bool is_round_off(const LevelRecord& level);

}  // namespace tribound::io
