#include "tribound/io/record/level_record.h"

#include <algorithm>

#include "tribound/io/record/error_bars.h"

namespace tribound::io
{

StageTimes& StageTimes::operator+=(const StageTimes& other)
{
  for (const auto& [name, seconds] : stages) this->*seconds += other.*seconds;
  return *this;
}

namespace
{

/// Drops the data that only marking needs.
void drop_cells(certify::EnergyBound& bound)
{
  bound.cells.clear();
  for (certify::QuantityInterval& quantity : bound.quantities) quantity.cells.clear();
}

}  // namespace

template <int dim>
LevelRecord level_record(const adapt::LevelView<dim>& view, const Point<dim>& moment_about,
                         const std::vector<bool>& slides, const problem::Units& units)
{
  const contact::NitscheForm<dim>& form = view.discrete.form;
  const adapt::CertifiedLevel<dim>& level = view.level;
  LevelRecord record;
  record.level = view.number;
  record.cells = view.discrete.mesh.n_global_cells();
  record.dofs = fem::n_free_dofs(view.discrete.space, form.constraints());
  record.newton = level.steps;
  record.finishing_steps = level.finishing_steps;
  record.delta_updates = level.delta_updates;
  record.paired = !form.problem().pairs().empty();
  record.figures = solution_figures(form, level, slides, units);
  if (level.solved() && !certify::is_round_off(level.estimate, level.norms))
    record.identities = level.identities;  // meaningless relative to rounding
  if (certify::is_bound(view.verdict.status))
  {
    record.bound = level.estimate.bound();
    record.balance = certify::balance<dim>(form, level.u, level.traction, moment_about);
  }
  else  // a violated identity means no bound, and none is shown
    for (adapt::CertifiedStep& step : record.newton) step.bound = {}, step.linearisation = {};
  record.energy = level.energy;
  if (record.energy)
  {
    drop_cells(*record.energy);
    scale_energies(*record.energy, form.problem().full_circle());
  }
  record.times = {.stages = {.solve = level.solve_seconds,
                             .certify = level.certify_seconds,
                             .bisect = level.refinement.bisect,
                             .discretise = level.refinement.discretise,
                             .transfer = level.refinement.transfer},
                  .level = view.seconds,
                  .solve_cpu = level.solve_cpu,
                  .certify_cpu = level.certify_cpu};
  return record;
}

int newton_steps(const LevelRecord& level)
{
  // A load step is solved to the end, whatever the criterion would have required.
  const int not_asked_for = level.load_step ? 0 : level.finishing_steps;
  return static_cast<int>(level.newton.size()) - not_asked_for;
}

bool is_regularised(const LevelRecord& level)
{
  return level.delta_updates.has_value();
}

certify::RunKind run_kind(const LevelRecord& level)
{
  return {.regularised = is_regularised(level), .paired = level.paired};
}

certify::RunKind run_kind(std::span<const LevelRecord> levels)
{
  return {.regularised = std::ranges::any_of(levels, is_regularised),
          .paired = std::ranges::any_of(levels, &LevelRecord::paired)};
}

std::optional<double> last_delta(const LevelRecord& level)
{
  return level.newton.empty() ? std::nullopt : std::optional(level.newton.back().step.delta);
}

std::optional<double> bound_value(const std::optional<certify::Bound>& bound, double certify::Bound::*number)
{
  return bound ? std::optional((*bound).*number) : std::nullopt;
}

std::optional<double> relative_bound(const LevelRecord& level)
{
  if (!level.bound || level.figures.sigma_norm == 0.0) return std::nullopt;
  return level.bound->total_sharp / level.figures.sigma_norm;
}

std::optional<double> bound_along_path(const LevelRecord& level)
{
  if (!level.bound || !level.load_step || level.load_step->largest_sigma == 0.0) return std::nullopt;
  return level.bound->total_sharp / level.load_step->largest_sigma;
}

bool is_round_off(const LevelRecord& level)
{
  const contact::StressNorms norms{.sigma = level.figures.sigma_norm, .round_off = level.figures.round_off};
  return level.bound && certify::is_round_off(*level.bound, norms);
}

template LevelRecord level_record(const adapt::LevelView<2>&, const Point<2>&, const std::vector<bool>&,
                                  const problem::Units&);
template LevelRecord level_record(const adapt::LevelView<3>&, const Point<3>&, const std::vector<bool>&,
                                  const problem::Units&);

}  // namespace tribound::io
