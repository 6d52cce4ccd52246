#include "app/result/study.h"

#include <fmt/format.h>

#include <algorithm>

#include "tribound/adapt/rate.h"
#include "tribound/io/file/json.h"
#include "tribound/io/record/error_bars.h"
#include "tribound/io/record/record_json.h"
#include "tribound/io/record/tables.h"

namespace tribound::app
{

namespace
{

constexpr const char* study_schema = "1";

std::optional<double> energy_error(const StudiedLevel& level)
{
  return level.error ? std::optional(level.error->energy) : std::nullopt;
}

std::optional<double> stress_error(const StudiedLevel& level)
{
  return level.error ? std::optional(level.error->stress) : std::nullopt;
}

std::optional<double> bound_of(const StudiedLevel& level)
{
  return level.record.bound ? std::optional(level.record.bound->total_sharp) : std::nullopt;
}

using LevelValue = std::optional<double> (*)(const StudiedLevel&);

/// The quantity at the levels where it is known.
std::vector<adapt::RatePoint> rate_points(std::span<const StudiedLevel> levels, LevelValue value)
{
  std::vector<adapt::RatePoint> points;
  for (const StudiedLevel& level : levels)
    if (const auto known = value(level)) points.push_back({static_cast<double>(level.record.dofs), *known});
  return points;
}

/// The data of a level in study.csv, after `variant`, and in study.json.
io::TableRow columns(const StudyVariant& variant, std::size_t number, const certify::RunKind& kind)
{
  const StudiedLevel& level = variant.levels[number];
  const Rates rates = level_rates(variant, number);
  io::TableRow row = io::level_columns(level.record);
  const auto append = [&row](const io::TableRow& further)
  { row.insert(row.end(), further.begin(), further.end()); };
  append({{"energy_error", energy_error(level)},
          {"stress_error", stress_error(level)},
          {"dual_norm", level.dual_norm},
          {"effectivity", level.effectivity()},
          {"effectivity_stress", level.stress_effectivity()},
          {"energy_bound", io::energy_bound(level.record)},
          {"energy_effectivity", level.energy_effectivity()},
          {"intervals_agree",
           level.intervals_agree ? std::optional(*level.intervals_agree ? 1.0 : 0.0) : std::nullopt},
          {"rate_error", rates.error},
          {"rate_bound", rates.bound},
          {"t_solve", level.record.times.stages.solve},
          {"t_certify", level.record.times.stages.certify},
          {"t_level", level.record.times.level}});
  append(io::further_columns(level.record, kind));
  return row;
}

io::Json json(const std::vector<std::optional<double>>& values)
{
  io::Json array = io::Json::array();
  for (const auto& value : values) array.push_back(io::number_or_null(value));
  return array;
}

io::Json json(const StudyVariant& variant)
{
  io::Json levels = io::Json::array();
  for (std::size_t i = 0; i < variant.levels.size(); ++i)
  {
    levels.push_back(io::row_json(columns(variant, i, io::run_kind(variant.levels[i].record))));
  }
  const Rates rates = fitted_rates(variant);
  return {{"status", certify::to_string(variant.status)},
          {"reason", io::text_or_null(variant.reason)},
          {"rates", {{"error", io::number_or_null(rates.error)}, {"bound", io::number_or_null(rates.bound)}}},
          {"levels", levels}};
}

io::Json json(const std::optional<StudyReference>& reference)
{
  if (!reference) return nullptr;
  const io::LevelRecord& level = reference->level;
  return {{"degree", reference->degree},
          {"cells", level.cells},
          {"dofs", level.dofs},
          {"bound", level.bound ? io::Json(level.bound->total_sharp) : io::Json(nullptr)},
          {"relative", io::number_or_null(io::relative_bound(level))},
          {"required", reference->required},
          {"fine_enough", reference->fine_enough},
          {"reason", io::text_or_null(reference->reason)},
          {"energy", level.figures.energy},
          {"energy_bound", io::number_or_null(io::energy_bound(level))},
          {"contact_normal", level.figures.contact.normal},
          {"contact_tangential", level.figures.contact.tangential},
          {"max_displacement", level.figures.max_displacement}};
}

/// Newton steps per level, a column per variant.
io::Json newton_json(const Study& study)
{
  std::size_t n_levels = 0;
  for (const StudyVariant& variant : study.variants) n_levels = std::max(n_levels, variant.levels.size());
  io::Json table = io::Json::array();
  for (std::size_t level = 0; level < n_levels; ++level)
  {
    io::Json row{{"level", level}};
    for (const char* name : variant_names)
    {
      const StudyVariant* variant = find_variant(study, name);
      row[name] = variant != nullptr && level < variant->levels.size()
                      ? io::Json(io::newton_steps(variant->levels[level].record))
                      : io::Json(nullptr);
    }
    table.push_back(row);
  }
  return table;
}

/// Compares runs with and without the stopping criterion.
io::Json differences(const Study& study)
{
  io::Json object = io::Json::object();
  for (const char* name : {"adaptive", "uniform"})
  {
    const StudyVariant* with = find_variant(study, name);
    const StudyVariant* without = find_variant(study, std::string(name) + "_converged");
    object[name] =
        with != nullptr && without != nullptr ? json(error_differences(*with, *without)) : io::Json(nullptr);
  }
  return object;
}

contact::StressNorms norms_of(const io::LevelRecord& record)
{
  return {.energy = record.figures.energy,
          .sigma = record.figures.sigma_norm,
          .round_off = record.figures.round_off};
}

}  // namespace

std::optional<double> StudiedLevel::effectivity() const
{
  const auto bound = bound_of(*this);
  if (!bound || !dual_norm) return std::nullopt;
  return tribound::certify::effectivity(*bound, *dual_norm, norms_of(record));
}

std::optional<double> StudiedLevel::stress_effectivity() const
{
  const auto bound = bound_of(*this);
  if (!bound || !error) return std::nullopt;
  return tribound::certify::effectivity(*bound, error->stress, norms_of(record));
}

std::optional<double> StudiedLevel::energy_effectivity() const
{
  if (!record.energy || !error) return std::nullopt;
  return certify::energy_effectivity(*record.energy, error->energy, record.figures.energy);
}

const StudyVariant* find_variant(const Study& study, std::string_view name)
{
  const auto found = std::ranges::find(study.variants, name, &StudyVariant::name);
  return found == study.variants.end() ? nullptr : &*found;
}

certify::RunKind run_kind(const Study& study)
{
  certify::RunKind kind;
  for (const StudyVariant& variant : study.variants)
    for (const StudiedLevel& level : variant.levels)
    {
      const certify::RunKind one = io::run_kind(level.record);
      kind = {.regularised = kind.regularised || one.regularised, .paired = kind.paired || one.paired};
    }
  return kind;
}

Rates level_rates(const StudyVariant& variant, std::size_t number)
{
  if (number == 0) return {};
  const std::span<const StudiedLevel> both = std::span(variant.levels).subspan(number - 1, 2);
  const auto rate = [&](LevelValue value) -> std::optional<double>
  {
    const std::vector<adapt::RatePoint> points = rate_points(both, value);
    return points.size() == 2 ? adapt::rate_between(points[0], points[1]) : std::nullopt;
  };
  return {rate(energy_error), rate(bound_of)};
}

Rates fitted_rates(const StudyVariant& variant)
{
  return {adapt::fitted_rate(rate_points(variant.levels, energy_error)),
          adapt::fitted_rate(rate_points(variant.levels, bound_of))};
}

std::vector<std::optional<double>> error_differences(const StudyVariant& with, const StudyVariant& without)
{
  const std::vector<adapt::RatePoint> converged = rate_points(without.levels, energy_error);
  std::vector<std::optional<double>> result(with.levels.size());
  for (std::size_t i = 0; i < result.size(); ++i)
  {
    const auto early = energy_error(with.levels[i]);
    const auto other = adapt::value_at(converged, static_cast<double>(with.levels[i].record.dofs));
    if (early && other && *other > 0) result[i] = (*early - *other) / *other;
  }
  return result;
}

namespace
{

/// What is violated on a level, as the end of a sentence; `of_reference`: the bound of the error of the
/// reference.
std::string violation(const StudiedLevel& level, const std::optional<double>& of_reference)
{
  if (const auto e = level.effectivity(); e && *e < 1)
    return fmt::format(
        "the bound {:.9g} is below the dual norm of the residual, which is at least {:.9g} (effectivity "
        "{:.6f})",
        *bound_of(level), *level.dual_norm, *e);
  const auto bound = io::energy_bound(level.record);
  // The triangle inequality: the reference is not exact either.
  if (of_reference && level.energy_effectivity() && *energy_error(level) > *bound + *of_reference)
    return fmt::format(
        "the bound {:.9g} of the error in the energy norm and that of the reference, {:.3g}, are together "
        "below "
        "the distance {:.9g} between both",
        *bound, *of_reference, *energy_error(level));
  if (level.intervals_agree == false)
    return "the interval of a quantity has no point in common with that of the reference";
  return {};
}

}  // namespace

std::string violation(const Study& study)
{
  const auto of_reference = study.reference ? io::energy_bound(study.reference->level) : std::nullopt;
  for (const StudyVariant& variant : study.variants)
    for (const StudiedLevel& level : variant.levels)
      if (const std::string wrong = violation(level, of_reference); !wrong.empty())
        return fmt::format("the guarantee is violated: in the variant {} on level {} {}", variant.name,
                           level.record.level, wrong);
  return {};
}

std::string study_csv(const Study& study)
{
  const auto row = [kind = run_kind(study)](const StudyVariant& variant, std::size_t number)
  {
    io::TableRow cells = columns(variant, number, kind);
    cells.insert(cells.begin(), {"variant", variant.name});
    return cells;
  };
  std::vector<io::TableRow> rows;
  for (const StudyVariant& variant : study.variants)
    for (std::size_t i = 0; i < variant.levels.size(); ++i) rows.push_back(row(variant, i));
  StudyVariant any;
  any.levels.emplace_back();
  return io::csv_text(row(any, 0), rows);
}

io::Json study_object(const Study& study)
{
  io::Json object{{"schema", study_schema},
                  {"program", io::program_json(study.build)},
                  {"title", study.facts.title},
                  {"purpose", study.facts.purpose},
                  {"file", study.facts.file},
                  {"case", io::effective_case_json(study.effective, study.case_file)},
                  {"d", study.facts.dimension},
                  {"model", io::model_json(study.facts)},
                  {"p", study.facts.degree},
                  {"stress", certify::to_string(study.facts.stress)},
                  {"friction", study.facts.friction},
                  {"units", io::units_json(study.facts)},
                  {"gamma_lin", study.gamma_lin},
                  {"marking", study.marking},
                  {"theta", study.theta},
                  {"guarantee", violation(study).empty() ? "holds" : "violated"},
                  {"interrupted", io::text_or_null(study.interruption)},
                  {"reference", json(study.reference)},
                  {"variants", io::Json::object()}};
  for (const StudyVariant& variant : study.variants) object["variants"][variant.name] = json(variant);
  object["newton_table"] = newton_json(study);
  object["difference"] = differences(study);
  object["times"] = io::Json::object();
  for (const auto& [stage, seconds] : study.times) object["times"][stage] = seconds;
  return object;
}

std::string study_json(const Study& study)
{
  return io::json_text(study_object(study));
}

}  // namespace tribound::app
