/// @file summary_text.cpp
/// The texts about a run as a whole.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "app/console/console.h"
#include "app/console/text.h"
#include "tribound/adapt/rate.h"
#include "tribound/io/record/error_bars.h"

namespace tribound::app
{

using problem::UnitOf;

namespace
{

std::string resultants_line(std::string_view caption, std::string_view boundary, const io::Resultants& r,
                            const io::CaseFacts& facts)
{
  const std::string unit = facts.behind(UnitOf::force);
  const std::string force = facts.is_axisymmetric ? fmt::format("axial force {:.8g}", r.force[1])
                                                  : fmt::format("force ({:.8g})", fmt::join(r.force, ", "));
  return line(caption, fmt::format("{}: normal {:.8g}{}, tangential {:.8g}{}, {}{}", boundary, r.normal, unit,
                                   r.tangential, unit, force, unit));
}

/// For a boundary with Coulomb friction: N and H are the normal and the tangential resultant.
std::string sliding_line(const io::Resultants& r)
{
  const std::optional<io::Sliding> state = io::sliding(r);
  if (!state) return {};
  const std::string safety = state->safety_factor
                                 ? fmt::format("factor of safety mu_F N/H = {:.4g}", *state->safety_factor)
                                 : "no sliding force";
  return line("sliding", fmt::format("{}: sliding factor H/N = {:.4g}, mu_F = {:g}: {}", r.boundary,
                                     state->sliding_factor, state->coefficient, safety));
}

/// Each component with its share of the sum of squares.
std::string component_lines(const certify::BoundComponents& components, const certify::RunKind& kind)
{
  constexpr double round_off = 1e-9;  // as on the page
  std::vector<certify::Component> all = certify::components_of_run(kind);
  std::erase_if(all, [](const certify::Component& c) { return !c.is_summand(); });
  double squares = 0;
  for (const certify::Component& c : all) squares += components.*c.value * components.*c.value;
  std::string text;
  for (const certify::Component& c : all)
  {
    double value = components.*c.value;
    if (value <= round_off * std::sqrt(squares)) value = 0;
    if (value == 0 && !c.is_of_cells()) continue;
    const double share = squares > 0 ? 100 * value * value / squares : 0;
    text += line("", fmt::format("{:<5}  {:<26}  {:>12.5g}  {:>5.1f} %", c.name, c.meaning, value, share));
  }
  return text;
}

constexpr std::array axes = {"x", "y", "z"};

double largest_with(std::span<const double> values, double start)
{
  for (const double value : values) start = std::max(start, std::abs(value));
  return start;
}

/// Values at rounding level are shown without digits.
std::string cell(double value, double scale)
{
  return fmt::format("{:>13.6g}", std::abs(value) > 1e-9 * scale ? value : 0.0);
}

std::string label(const certify::BalanceRow& row)
{
  if (row.kind == certify::BalanceKind::load) return row.name + ", " + row.source;
  return row.name;
}

/// What the numbers of the balance are.
std::string balance_note(const certify::Balance& balance, const io::CaseFacts& facts)
{
  const bool has_units = facts.units.are_named();
  if (facts.is_axisymmetric)
    return fmt::format("forces of the full circle{} on the body",
                       has_units ? " in " + facts.label(UnitOf::force) : "");
  return fmt::format("on the body; {}about ({:.6g})",
                     has_units ? fmt::format("forces in {}, moments in {} ", facts.label(UnitOf::force),
                                             facts.label(UnitOf::moment))
                               : "moments ",
                     fmt::join(balance.about, ", "));
}

/// The bound of the error in the energy norm, or why there is none, and the quantities with their intervals.
std::string energy_lines(const io::LevelRecord& level, const io::CaseFacts& facts)
{
  if (!level.energy) return {};
  std::string quantities;
  for (const certify::QuantityInterval& quantity : level.energy->quantities)
    quantities += paragraph(quantities.empty() ? "quantities" : "",
                            quantity.name + ": " + io::words_of(quantity, facts.unit_of(quantity.name)));
  if (!level.energy->reason.empty())
    return paragraph("energy error", "no bound: " + level.energy->reason) + quantities;
  const auto relative = io::relative_energy_bound(level);
  return paragraph(
             "energy error",
             fmt::format("at most {:.6g}{}{}: the distance from {}", level.energy->bound,
                         facts.behind(UnitOf::energy_norm),
                         relative ? fmt::format(", {:.4g} % of ||u_h||_en", 100 * *relative) : std::string(),
                         io::words_of(level.energy->target))) +
         quantities;
}

std::string path_text(const adapt::PathEnd& path)
{
  std::string text;
  if (path.peak)
    text += line("peak",
                 fmt::format("t = {:.9g} at load step {}{}", path.peak->t, path.peak->number,
                             path.peak->change
                                 ? fmt::format("; halving its steps changed it by {:.2g}", *path.peak->change)
                                 : std::string(", as its steps have it: halved ones could not be followed")));
  if (!path.dropped.empty())
    text += line("left out",
                 fmt::format("t = {}: from there on damage was given, not t", fmt::join(path.dropped, ", ")));
  for (const std::string& note : path.notes) text += line("path", note);
  return text;
}

/// The check of the path, if there was one.
std::string comparison_text(const io::RunRecord& run)
{
  if (!run.check) return {};
  const io::HistoryCheck& check = *run.check;
  if (!check.end.failure.empty())
    return paragraph("check", "half the steps on a finer mesh: " + check.end.failure);
  std::string text =
      fmt::format("half the steps on {}, not guaranteed:", count(check.cells, "cell", "cells"));
  const io::LoadStepRecord last = io::last_load_step(run).value_or(io::LoadStepRecord());
  for (const io::ComparedFigure& figure : io::compare(run.path, last, check))
    if (const std::optional<double> difference = figure.difference())
    {
      const bool is_rounding = std::abs(*difference) <= 1e-9 * std::abs(*figure.path);
      text += fmt::format(" {} {:.6g}{} ({:+.2g}),", figure.word, *figure.check,
                          figure.unit ? run.facts.behind(*figure.unit) : "", is_rounding ? 0 : *difference);
    }
  text.pop_back();
  return paragraph("check", text);
}

constexpr std::size_t fewest_levels = 3;
/// For slower rates no forecast is made.
constexpr double slowest_rate = -0.05;

/// Two digits, since it is an estimate.
std::string count_in_words(double n)
{
  if (!(n < 1e9)) return "more than 10^9";
  const bool millions = n >= 995'000;  // which rounds to one
  if (millions) n /= 1e6;
  const double unit = std::pow(10, std::floor(std::log10(n)) - 1);
  return fmt::format("{:g}{}", std::round(n / unit) * unit, millions ? " million" : "");
}

}  // namespace

std::string balance_text(const certify::Balance& balance, const io::CaseFacts& facts)
{
  const std::size_t dim = balance.about.size();
  // Around an axis only the axial forces do not cancel.
  const bool is_whole = !facts.is_axisymmetric;
  const std::size_t n_moments = is_whole ? (dim == 2 ? 1 : dim) : 0;
  const std::size_t first_force = is_whole ? 0 : 1;
  std::size_t width = 0;
  double force = 0;
  double moment = 0;
  for (const certify::BalanceRow& row : balance.rows)
  {
    width = std::max(width, label(row).size());
    force = largest_with(row.force, force);
    moment = largest_with(row.moment, moment);
  }
  std::string head;
  for (std::size_t i = first_force; i < dim; ++i)
    head += fmt::format("{:>13}", fmt::format("force {}", is_whole ? axes[i] : "z"));
  for (std::size_t i = 0; i < n_moments; ++i)
    head += fmt::format("{:>13}", dim == 2 ? "moment" : fmt::format("moment {}", axes[i]));
  std::string text = line("balance", fmt::format("{:<{}}{}", "", width + 10, head));
  for (const certify::BalanceRow& row : balance.rows)
  {
    std::string numbers;
    for (std::size_t i = first_force; i < dim; ++i) numbers += cell(row.force[i], force);
    for (std::size_t i = 0; i < n_moments; ++i) numbers += cell(row.moment[i], moment);
    text += line("", fmt::format("{:<10}{:<{}}{}", certify::to_string(row.kind), label(row), width, numbers));
  }
  return text + line("", balance_note(balance, facts));
}

std::string certificate_text(const io::RunRecord& run)
{
  if (run.levels.empty()) return {};
  const io::LevelRecord& level = run.levels.back();
  if (!level.bound) return energy_lines(level, run.facts);
  const certify::Bound& bound = *level.bound;
  const std::optional<double> relative = io::relative_bound(level);
  std::string text =
      line("bound", fmt::format("{:.6g}{}, {} (plain sums: {:.6g})", bound.total_sharp,
                                run.facts.behind(UnitOf::stress_norm),
                                relative ? fmt::format("that is {:.4g} % of ||sigma(u_h)||", 100 * *relative)
                                : io::is_round_off(level) ? std::string("rounding, as the stress is")
                                                          : std::string("of a stress that is zero"),
                                bound.total));
  text += component_lines(bound.global, io::run_kind(level));
  if (level.identities)
    text += line("identities", fmt::format("hold to {:.1e} of ||sigma_h|| (limit {:g})",
                                           level.identities->largest(), certify::identity_limit));
  text += energy_lines(level, run.facts);
  for (const std::string& covered : run.statements.covered) text += paragraph("guaranteed", covered);
  text += paragraph("law", run.statements.law);
  for (const std::string& outside : run.statements.not_covered) text += paragraph("outside", outside);
  return text;
}

std::string warnings_text(std::span<const doctor::Finding> warnings)
{
  std::string text;
  for (const doctor::Finding& warning : warnings)
  {
    const std::string where = doctor::location(warning);
    text += paragraph("warning", where.empty() ? warning.text : fmt::format("{}: {}", where, warning.text));
  }
  return text;
}

std::string summary_text(const io::RunRecord& run, const std::string& directory)
{
  std::string text;
  if (!run.levels.empty())
  {
    const io::LevelRecord& last = run.levels.back();
    const io::CaseFacts& facts = run.facts;
    for (const io::Resultants& part : last.figures.boundary_contact)
      text += resultants_line("contact", part.boundary, part, facts);
    if (last.figures.boundary_contact.size() > 1)
      text += resultants_line("", "in all", last.figures.contact, facts);
    for (const io::Resultants& part : last.figures.boundary_contact) text += sliding_line(part);
    if (last.balance) text += balance_text(*last.balance, facts);
    text += observations_text(last, facts);
    text +=
        line("max |u|", fmt::format("{:.8g}{}", last.figures.max_displacement, facts.behind(UnitOf::length)));
    text += line("energy", fmt::format("a(u, u) = {:.8g}{}, ||sigma|| = {:.8g}{}", last.figures.energy,
                                       facts.behind(UnitOf::energy), last.figures.sigma_norm,
                                       facts.behind(UnitOf::stress_norm)));
    if (const std::optional<double> stored = last.figures.spring_energy)
      text += line("springs",
                   fmt::format("(K (u - u_0), u - u_0) = {:.8g}{}", *stored, facts.behind(UnitOf::energy)));
    for (const io::RigidFigures& part : last.figures.rigid_parts)
      text += line("rigid", fmt::format("{}: displacement ({:.8g}){}, rotation {:.8g}", part.boundary,
                                        fmt::join(part.displacement, ", "), facts.behind(UnitOf::length),
                                        fmt::join(part.rotation, ", ")));
    text += certificate_text(run);
    text += warnings_text(run.warnings);
  }
  return text + verdict_text(run, directory);
}

std::string verdict_text(const io::RunRecord& run, const std::string& directory)
{
  std::string reason = run.reason;
  if (run.status == certify::RunStatus::certified && io::has_history(run))
    reason = fmt::format(
        "the bound of every load step is at most adapt.tolerance = {:g} % of the largest "
        "||sigma(u_h)|| of the path up to it",
        100 * run.tolerance);
  else if (run.status == certify::RunStatus::certified)
    reason = run.levels.empty() || !io::is_round_off(run.levels.back())
                 ? fmt::format("the bound is at most adapt.tolerance = {:g} % of ||sigma(u_h)||",
                               100 * run.tolerance)
                 : std::string("the stress is zero up to rounding, and so is the bound of its error");
  return path_text(run.path) + comparison_text(run) +
         line("status", certify::to_string(run.status) + (reason.empty() ? "" : ": " + reason)) +
         line_if_any("results", directory);
}

std::string forecast_text(const io::RunRecord& run, long max_dofs)
{
  std::vector<adapt::RatePoint> points;
  for (const io::LevelRecord& level : run.levels)
    if (const auto relative = io::relative_bound(level))
      points.push_back({static_cast<double>(level.dofs), *relative});
  if (points.size() < fewest_levels || points.back().value <= run.tolerance) return {};
  const std::optional<double> rate = adapt::fitted_rate(points);
  if (!rate) return {};
  if (*rate > slowest_rate) return "  the bound hardly decreases";
  const double needed = points.back().dofs * std::pow(run.tolerance / points.back().value, 1 / *rate);
  return fmt::format("  at this rate {:g} % needs {} unknowns{}", 100 * run.tolerance, count_in_words(needed),
                     needed > static_cast<double>(max_dofs) ? ", above adapt.max_dofs" : "");
}

}  // namespace tribound::app
