#include <fmt/format.h>

#include "tribound/doctor/findings.h"

namespace tribound::doctor
{

namespace
{

/// Below this, the covered share of a slave is less than intended.
constexpr double nearly_all = 0.99;
/// In facets; larger gaps are not closed by small displacements.
constexpr double far = 10;
/// Between neighbouring facets of a slave, degrees. Beyond this, gaps and overlaps between their normals on
/// the opposite side matter.
constexpr double turning = 15;
constexpr double stretched = 2;
/// Relative to the size of a tie; beyond this, the neglected couple of forces across it matters.
constexpr double across = 1e-3;

Finding warning(const char* code, double number, const Place& where, std::string text, const char* advice)
{
  return {.code = code,
          .severity = Severity::warning,
          .text = std::move(text),
          .numbers = {{"value", number}},
          .where = where,
          .advice = advice};
}

void add_warnings(const PairFacts& pair, const std::string& unit, std::vector<Finding>& result)
{
  if (pair.covered_share < nearly_all && (pair.geometric_gap || pair.is_tied))
    result.push_back(
        warning("pair_coverage", pair.covered_share, {},
                fmt::format("{:.3g} % of the slave of {} has nothing opposite and is free of traction",
                            100 * (1 - pair.covered_share), pair.name),
                pair.is_tied ? "it is not tied there: look at the boundaries, reach and pairing"
                             : "if it is meant to touch there, look at the boundaries, reach and pairing"));
  if (pair.smallest_gap > far && !pair.is_tied)
    result.push_back(warning("pair_gap", pair.smallest_gap, {},
                             fmt::format("the sides of {} are at least {:.3g} facets apart at the start",
                                         pair.name, pair.smallest_gap),
                             "small displacements do not close that: look at the gap, its unit and the "
                             "places of the bodies"));
  if (pair.turn > turning)
    result.push_back(warning(
        "pair_turn", pair.turn, pair.turn_at,
        fmt::format("neighbouring facets of the slave of {} turn by {:.3g} degrees", pair.name, pair.turn),
        "their normals leave out or count twice what lies opposite such an edge: refine "
        "a curved side in the mesh, give a corner two pairs, or pairing a direction"));
  if (pair.stretch > stretched)
    result.push_back(
        warning("pair_stretch", pair.stretch, pair.stretch_at,
                fmt::format("lengths or areas on the sides of {} differ by up to {:.3g} times where they "
                            "lie opposite each other",
                            pair.name, pair.stretch),
                "the sides are far from parallel there: pair along a direction between their normals"));
  if (pair.is_tied && pair.distance > across * pair.size)
    result.push_back(warning(
        "tie_distance", pair.distance, pair.distance_at,
        fmt::format("the sides of {}, which are tied, lie up to {:.3g}{} apart", pair.name, pair.distance,
                    unit),
        "a tie across a distance also stops rotations and carries a couple: let the sides meet in the mesh"));
}

}  // namespace

std::vector<Finding> pair_findings(const Diagnosis& diagnosis)
{
  std::vector<Finding> result;
  for (const PairFacts& pair : diagnosis.pairs)
  {
    Finding finding{.code = "pair"};
    finding.numbers = {{"segments", static_cast<double>(pair.segments)},
                       {"covered_share", pair.covered_share}};
    finding.text = fmt::format("{} has {} segment{} and covers {:.4g} % of the slave", pair.name,
                               pair.segments, pair.segments == 1 ? "" : "s", 100 * pair.covered_share);
    result.push_back(std::move(finding));
    add_warnings(pair, diagnosis.behind(problem::UnitOf::length), result);
  }
  return result;
}

}  // namespace tribound::doctor
