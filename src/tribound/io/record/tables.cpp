#include "tribound/io/record/tables.h"

#include <algorithm>
#include <iterator>

#include "tribound/io/record/error_bars.h"

namespace tribound::io
{

namespace
{

void append(TableRow& row, TableRow columns)
{
  std::ranges::move(columns, std::back_inserter(row));
}

TableRow component_columns(std::span<const certify::Component> components,
                           const std::optional<certify::Bound>& bound)
{
  TableRow row;
  for (const certify::Component& c : components)
    row.push_back({c.name, bound ? std::optional(bound->global.*c.value) : std::nullopt});
  return row;
}

/// The known components of a step.
TableRow component_columns(const adapt::CertifiedStep& record)
{
  TableRow row = component_columns(certify::plain_components, record.bound);
  if (!record.bound && record.linearisation)
    for (std::size_t i = 0; i < row.size(); ++i)
      if (const certify::Component& c = certify::plain_components[i];
          c.cause == certify::BoundCause::linearisation)
        row[i].value = std::optional((*record.linearisation).*c.value);
  return row;
}

TableRow newton_row(const char* level_name, int level, const adapt::CertifiedStep& record,
                    const certify::RunKind& kind)
{
  TableRow row = {{level_name, level},
                  {"step", record.step.step},
                  {"residual", record.step.residual},
                  {"damping", record.step.damping}};
  append(row, component_columns(record));
  append(row, {{"total", bound_value(record.bound, &certify::Bound::total)},
               {"accepted", record.accepted ? 1 : 0}});
  if (kind.regularised)
  {
    append(row, component_columns(certify::regularisation_components, record.bound));
    row.push_back({"delta", record.step.delta});
  }
  if (kind.paired) append(row, component_columns(certify::transfer_components, record.bound));
  return row;
}

TableRow convergence_row(const LevelRecord& level, const certify::RunKind& kind)
{
  TableRow row = level_columns(level);
  append(row, {{"energy", level.figures.energy},
               {"contact_normal", level.figures.contact.normal},
               {"contact_tangential", level.figures.contact.tangential},
               {"t_solve", level.times.stages.solve},
               {"t_certify", level.times.stages.certify},
               {"t_level", level.times.level},
               {"energy_bound", energy_bound(level)},
               {"energy_relative", relative_energy_bound(level)}});
  append(row, further_columns(level, kind));
  return row;
}

bool is_load_step(const LevelRecord& level)
{
  return level.load_step.has_value();
}

const char* name_of_level(std::span<const LevelRecord> levels)
{
  return std::ranges::any_of(levels, is_load_step) ? "load_step" : "level";
}

/// Empty where the step has no hydraulic interface.
TableRow hydraulic_columns(const std::optional<HydraulicFigures>& figures)
{
  const HydraulicFigures& f = figures.value_or(HydraulicFigures());
  const auto known = [&](double value) { return figures ? std::optional(value) : std::nullopt; };
  return {{"effective_normal", known(f.effective_normal)},
          {"uplift", known(f.uplift)},
          {"resultant_x", f.resultant_x},
          {"resultant_x_total", f.resultant_x_total},
          {"in_kernel", f.in_kernel ? std::optional(*f.in_kernel ? 1.0 : 0.0) : std::nullopt},
          {"sliding_safety", f.sliding_safety},
          {"sff_intact", f.sff_intact},
          {"sff_now", f.sff_now},
          {"overturning", f.overturning}};
}

/// Values, and ends where there is an interval.
TableRow quantity_columns(std::span<const certify::QuantityInterval> quantities)
{
  TableRow row;
  for (const certify::QuantityInterval& quantity : quantities)
  {
    const auto known = [&](double end)
    { return quantity.reason.empty() ? std::optional(end) : std::nullopt; };
    append(row, {{"quantity." + quantity.name, quantity.value},
                 {"quantity." + quantity.name + ".lower", known(quantity.lower)},
                 {"quantity." + quantity.name + ".upper", known(quantity.upper)}});
  }
  return row;
}

TableRow history_row(const LevelRecord& level, const certify::RunKind& kind)
{
  const LoadStepRecord& step = level.load_step.value_or(LoadStepRecord());
  TableRow row = {{"step", level.level},
                  {"t", step.t},
                  {"control", step.control},
                  {"cuts", step.cuts},
                  {"passes", step.passes}};
  TableRow of_level = convergence_row(level, kind);
  row.insert(row.end(), std::make_move_iterator(of_level.begin() + 1),
             std::make_move_iterator(of_level.end()));
  append(row, {{"relative_path", bound_along_path(level)}});
  append(row, hydraulic_columns(step.all.hydraulic));
  const HydraulicFigures& hydraulic = step.all.hydraulic.value_or(HydraulicFigures());
  append(row, {{"opened", step.all.opened},
               {"broken", step.all.broken},
               {"process", step.all.process},
               {"slipping", step.all.slipping},
               {"crack_tip", hydraulic.crack_tip},
               {"cmod", hydraulic.cmod},
               {"csd", hydraulic.csd},
               {"damage", step.all.damage},
               {"dissipated", step.dissipated},
               {"dissipated_friction", step.rubbed},
               {"stored", step.all.stored},
               {"work", step.work},
               {"balance", step.balance}});
  for (const auto& [name, value] : step.watched) row.push_back({"watch." + name, std::optional(value)});
  if (level.energy) append(row, quantity_columns(level.energy->quantities));
  return row;
}

}  // namespace

TableRow level_columns(const LevelRecord& level)
{
  TableRow row = {{"level", level.level},
                  {"cells", level.cells},
                  {"dofs", level.dofs},
                  {"newton_steps", newton_steps(level)}};
  append(row, component_columns(certify::plain_components, level.bound));
  append(row, {{"total", bound_value(level.bound, &certify::Bound::total)},
               {"total_sharp", bound_value(level.bound, &certify::Bound::total_sharp)},
               {"relative", relative_bound(level)}});
  return row;
}

TableRow further_columns(const LevelRecord& level, const certify::RunKind& kind)
{
  TableRow row;
  if (kind.regularised)
  {
    append(row, component_columns(certify::regularisation_components, level.bound));
    append(row, {{"delta", last_delta(level)}, {"delta_updates", level.delta_updates.value_or(0)}});
  }
  if (kind.paired) append(row, component_columns(certify::transfer_components, level.bound));
  return row;
}

std::string convergence_csv(std::span<const LevelRecord> levels)
{
  const certify::RunKind kind = run_kind(levels);
  const bool has_steps = std::ranges::any_of(levels, is_load_step);
  const auto row_of = [&](const LevelRecord& level)
  {
    TableRow row = convergence_row(level, kind);
    if (has_steps)
      append(row,
             {{"load_step", level.load_step_number.value_or(0)}, {"relative_path", bound_along_path(level)}});
    return row;
  };
  std::vector<TableRow> rows;
  for (const LevelRecord& level : levels) rows.push_back(row_of(level));
  return csv_text(row_of({}), rows);
}

std::string history_csv(std::span<const LevelRecord> steps)
{
  const certify::RunKind kind = run_kind(steps);
  std::vector<TableRow> rows;
  for (const LevelRecord& step : steps) rows.push_back(history_row(step, kind));
  return csv_text(history_row(steps.empty() ? LevelRecord() : steps.front(), kind), rows);
}

std::vector<TableRow> newton_rows(std::span<const LevelRecord> levels)
{
  const certify::RunKind kind = run_kind(levels);
  std::vector<TableRow> rows;
  for (const LevelRecord& level : levels)
    for (const adapt::CertifiedStep& record : level.newton)
      rows.push_back(newton_row(name_of_level(levels), level.level, record, kind));
  return rows;
}

std::string newton_csv(std::span<const LevelRecord> levels)
{
  return csv_text(newton_row(name_of_level(levels), 0, {}, run_kind(levels)), newton_rows(levels));
}

}  // namespace tribound::io
