#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/console/text.h"
#include "app/result/study.h"

namespace tribound::app
{

namespace
{

std::string level_line(const StudyVariant& variant, std::size_t i)
{
  const StudiedLevel& level = variant.levels[i];
  const Rates rates = level_rates(variant, i);
  const auto relative = io::relative_bound(level.record);
  const auto error = level.error ? std::optional(level.error->energy) : std::nullopt;
  return fmt::format(
      "{:>5}  {:>8}  {:>8}  {:>6}  {:>9}  {:>6}  {:>10}  {:>6}  {:>11}  {:>14}  {:>14}\n", level.record.level,
      level.record.cells, level.record.dofs, io::newton_steps(level.record),
      number("{:.4g} %", relative ? std::optional(100 * *relative) : relative), number("{:.2f}", rates.bound),
      number("{:.4e}", error), number("{:.2f}", rates.error), number("{:.3f}", level.effectivity()),
      number("{:.3f}", level.stress_effectivity()), number("{:.3f}", level.energy_effectivity()));
}

std::string variant_table(const StudyVariant& variant)
{
  std::string text = fmt::format("\n{}: {}{}\n", variant.name, certify::to_string(variant.status),
                                 variant.reason.empty() ? "" : ", " + variant.reason);
  text += fmt::format("{:>5}  {:>8}  {:>8}  {:>6}  {:>9}  {:>6}  {:>10}  {:>6}  {:>11}  {:>14}  {:>14}\n",
                      "level", "cells", "dofs", "newton", "bound", "rate", "error", "rate", "effectivity",
                      "bound / stress", "energy bound");
  for (std::size_t i = 0; i < variant.levels.size(); ++i) text += level_line(variant, i);
  return text;
}

std::string newton_table(const Study& study)
{
  std::string text = "\nNewton steps per level\nlevel";
  std::size_t n_levels = 0;
  for (const StudyVariant& variant : study.variants)
  {
    text += fmt::format("  {:>18}", variant.name);
    n_levels = std::max(n_levels, variant.levels.size());
  }
  text += "\n";
  for (std::size_t level = 0; level < n_levels; ++level)
  {
    text += fmt::format("{:>5}", level);
    for (const StudyVariant& variant : study.variants)
      text += level < variant.levels.size()
                  ? fmt::format("  {:>18}", io::newton_steps(variant.levels[level].record))
                  : fmt::format("  {:>18}", "-");
    text += "\n";
  }
  return text + "\n";
}

std::string rates_text(const Study& study)
{
  std::string text;
  for (const StudyVariant& variant : study.variants)
  {
    const Rates rates = fitted_rates(variant);
    text += line(text.empty() ? "rates" : "",
                 fmt::format("{:<18}  energy error {:>6}, bound {:>6}  (powers of the degrees of freedom)",
                             variant.name, number("{:.3f}", rates.error), number("{:.3f}", rates.bound)));
  }
  return text;
}

/// The largest difference of the error with and without the stopping criterion, and where it is.
std::string difference_text(const Study& study, const std::string& name)
{
  const StudyVariant* with = find_variant(study, name);
  const StudyVariant* without = find_variant(study, name + "_converged");
  if (with == nullptr || without == nullptr) return {};
  const auto differences = error_differences(*with, *without);
  const auto size = [](const std::optional<double>& x) { return x ? std::abs(*x) : -1.0; };
  const auto largest = std::ranges::max_element(differences, {}, size);
  if (largest == differences.end() || !*largest) return {};
  return line("criterion", fmt::format("{}: changes the energy error by at most {:.2g} % (level {})", name,
                                       100 * size(*largest), largest - differences.begin()));
}

std::string reference_text(const Study& study)
{
  if (!study.reference) return line("reference", "none: errors are not known");
  const StudyReference& reference = *study.reference;
  std::string text =
      line("reference",
           fmt::format("degree {} on {} cells, {} degrees of freedom; its own bound is {} of ||sigma||",
                       reference.degree, reference.level.cells, reference.level.dofs,
                       number("{:.3g}", io::relative_bound(reference.level))));
  if (!reference.fine_enough)
    text +=
        line("", fmt::format("coarser than asked for ({:.3g}): errors near its bound are not reliable; {}",
                             reference.required, reference.reason));
  return text;
}

/// "<bound> holds on all 7 levels with a known <error>, effectivity 1.1 to 1.4"; empty where none is known.
std::string bounded_text(const Study& study, std::optional<double> (StudiedLevel::*effectivity)() const,
                         const char* bound, const char* error)
{
  std::vector<double> known;
  for (const StudyVariant& variant : study.variants)
    for (const StudiedLevel& level : variant.levels)
      if (const auto e = (level.*effectivity)()) known.push_back(*e);
  if (known.empty()) return {};
  const auto [smallest, largest] = std::ranges::minmax(known);
  return fmt::format("{} holds on all {} levels with a known {}, effectivity {:.3f} to {:.3f}", bound,
                     known.size(), error, smallest, largest);
}

/// The number of levels on which the intervals of the quantities could be compared; empty for none.
std::string intervals_text(const Study& study)
{
  long n = 0;
  for (const StudyVariant& variant : study.variants)
    n += std::ranges::count_if(variant.levels,
                               [](const StudiedLevel& level) { return level.intervals_agree == true; });
  return n == 0
             ? std::string()
             : line("",
                    fmt::format(
                        "the intervals of the quantities meet those of the reference on all {} levels where "
                        "both are known",
                        n));
}

std::string guarantee_text(const Study& study)
{
  std::string problem = violation(study);
  if (!problem.empty()) return line("guarantee", problem);
  const std::string residual = bounded_text(study, &StudiedLevel::effectivity, "the bound", "dual norm");
  const std::string energy =
      bounded_text(study, &StudiedLevel::energy_effectivity, "the energy bound", "error");
  return line("guarantee",
              residual.empty() ? "no dual norm was computed, see study.dual_norm_dofs" : residual) +
         (energy.empty() ? std::string() : line("", energy)) + intervals_text(study);
}

}  // namespace

std::string study_text(const Study& study, const std::string& directory)
{
  std::string text;
  for (const StudyVariant& variant : study.variants) text += variant_table(variant);
  if (study.facts.units.are_named())
    text += "error in " + study.facts.label(problem::UnitOf::energy_norm) + "\n";
  text += newton_table(study) + rates_text(study);
  for (const char* name : {"adaptive", "uniform"}) text += difference_text(study, name);
  text += reference_text(study) + guarantee_text(study);
  if (!study.interruption.empty()) text += line("interrupted", study.interruption);
  return text + line("results", directory);
}

}  // namespace tribound::app
