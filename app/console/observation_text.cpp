/// @file observation_text.cpp
/// The texts about probes and sections.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "app/console/console.h"
#include "app/console/text.h"
#include "tribound/io/fields/tensor_field.h"

namespace tribound::app
{

using problem::UnitOf;

namespace
{

constexpr std::size_t most_rows = 4;  // of a probe; a longer line is summed up

struct ProbeLine
{
  std::string label;
  std::vector<double> numbers;
};

/// u, von Mises' stress of sigma_h, and the difference of both stresses; without a bound that of sigma(u_h).
ProbeLine line_of(const std::string& label, const io::ProbeRow& row)
{
  ProbeLine result{label, row.u};
  result.numbers.push_back(io::von_mises(row.equilibrated.value_or(row.stress)));
  if (row.difference) result.numbers.push_back(*row.difference);
  return result;
}

/// Point by point, or the largest sizes along a line.
std::vector<ProbeLine> lines_of(const io::ProbeRecord& probe)
{
  std::vector<ProbeLine> lines;
  if (probe.rows.size() <= most_rows)
  {
    for (const io::ProbeRow& row : probe.rows)
    {
      std::string label = probe.name;
      if (probe.rows.size() > 1) label += fmt::format(" ({:.4g}), {}", fmt::join(row.x, ", "), row.region);
      lines.push_back(line_of(label, row));
    }
    return lines;
  }
  ProbeLine largest{fmt::format("{}, largest", probe.name), {}};
  for (const io::ProbeRow& row : probe.rows)
  {
    const ProbeLine other = line_of({}, row);
    largest.numbers.resize(other.numbers.size());
    for (std::size_t i = 0; i < other.numbers.size(); ++i)
      if (std::abs(other.numbers[i]) > std::abs(largest.numbers[i])) largest.numbers[i] = other.numbers[i];
  }
  return {largest};
}

/// Rows of numbers below their heads; values at rounding level are shown without digits.
std::string number_table(std::string_view caption, std::span<const std::string> heads,
                         std::span<const ProbeLine> lines)
{
  std::size_t width = 0;
  for (const ProbeLine& row : lines) width = std::max(width, row.label.size());
  std::string text = fmt::format("{:<{}}", "", width);
  for (const std::string& head : heads) text += fmt::format("{:>14}", head);
  text = line(caption, text);
  for (const ProbeLine& row : lines)
  {
    std::string numbers;
    for (const double value : row.numbers) numbers += fmt::format("{:>14.6g}", value == 0 ? 0.0 : value);
    text += line("", fmt::format("{:<{}}{}", row.label, width, numbers));
  }
  return text;
}

std::string probes_text(std::span<const io::ProbeRecord> probes, const io::CaseFacts& facts)
{
  if (probes.empty()) return {};
  std::vector<std::string> heads = {"u_x", "u_y", "u_z"};
  if (facts.is_axisymmetric) heads = {"u_r", "u_z"};
  heads.resize(facts.dimension);
  heads.emplace_back("von Mises");
  std::vector<ProbeLine> lines;
  for (const io::ProbeRecord& probe : probes) std::ranges::move(lines_of(probe), std::back_inserter(lines));
  const bool has_bound = lines[0].numbers.size() > heads.size();
  if (has_bound) heads.emplace_back("difference");
  const std::string units = facts.units.are_named()
                                ? fmt::format("displacements in {}, stresses in {}; ",
                                              facts.label(UnitOf::length), facts.label(UnitOf::stress))
                                : std::string();
  return number_table("probes", heads, lines) +
         paragraph("", units + (has_bound ? "stresses are those of sigma_h, the difference |sigma(u_h) - "
                                            "sigma_h| indicates their error, without guarantee"
                                          : "stresses are those of sigma(u_h)"));
}

double largest_of(std::span<const double> values, double start)
{
  for (const double value : values) start = std::max(start, std::abs(value));
  return start;
}

/// Adds the values, those below 1e-9 of `scale` as 0.
void append_cleared(std::span<const double> values, double scale, std::vector<double>& numbers)
{
  for (const double value : values) numbers.push_back(std::abs(value) > 1e-9 * scale ? value : 0);
}

std::string sections_text(std::span<const io::SectionRecord> sections, const io::CaseFacts& facts)
{
  if (sections.empty()) return {};
  std::vector<std::string> heads = {"N", "V_1", "V_2", "M_n", "M_1", "M_2"};
  if (facts.dimension == 2) heads = {"N", "V", "M"};
  if (facts.is_axisymmetric) heads = {"N", "V"};
  double force = 0;
  double moment = 0;
  for (const io::SectionRecord& section : sections)
  {
    force = largest_of(section.V, std::max(force, std::abs(section.N)));
    moment = largest_of(section.moment, moment);
  }
  std::vector<ProbeLine> lines;
  for (const io::SectionRecord& section : sections)
  {
    std::vector<double>& numbers = lines.emplace_back(ProbeLine{section.name, {}}).numbers;
    append_cleared({&section.N, 1}, force, numbers);
    append_cleared(section.V, force, numbers);
    if (!facts.is_axisymmetric) append_cleared(section.M, moment, numbers);
  }
  std::string units;
  if (facts.units.are_named())
    units = fmt::format("forces in {}{}; ", facts.label(UnitOf::force),
                        facts.is_axisymmetric ? "" : ", moments in " + facts.label(UnitOf::moment));
  if (facts.is_axisymmetric)
    return number_table("sections", heads, lines) +
           paragraph("", units +
                             "of the full circle, on the part behind the section; along the axis in "
                             "equilibrium with the loads, without error bars");
  const std::string& note = sections[0].note;
  return number_table("sections", heads, lines) +
         paragraph("", units + "on the part behind the plane, moments about its point; " +
                           (note.empty() ? "in equilibrium with the loads, without error bars"
                                         : "forces are in equilibrium with the loads; " + note));
}

}  // namespace

std::string observations_text(const io::LevelRecord& level, const io::CaseFacts& facts)
{
  return sections_text(level.sections, facts) + probes_text(level.probes, facts);
}

}  // namespace tribound::app
