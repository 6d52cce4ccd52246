#include <fmt/format.h>

#include "tribound/doctor/findings.h"

namespace tribound::doctor
{

namespace
{

/// Smaller differences of normals are round-off of the coordinates in a file, degrees.
constexpr double flat = 0.01;
/// Gaps beyond this fraction of the body size are not closed by small displacements.
constexpr double far = 0.05;
/// A gap may increase with the curvature of the obstacle, up to the size of the body.
constexpr double beyond = 1;
/// Fewer facets do not resolve the pressure distribution.
constexpr long few_facets = 4;

Finding corner_finding(const OverconstrainedCorner& corner, const std::string& unit)
{
  Finding finding{.code = "overconstrained_corner", .severity = Severity::note};
  finding.numbers = {{"vertices", static_cast<double>(corner.vertices)},
                     {"normal_displacement", corner.normal},
                     {"gap", corner.gap}};
  finding.where = corner.where;
  const std::string place =
      fmt::format("contact \"{}\" and displacement \"{}\" meet at {} {}", corner.contact, corner.displacement,
                  corner.vertices == 1 ? "the vertex" : fmt::format("{} vertices, such as", corner.vertices),
                  describe(corner.where));
  if (corner.contradicts())
  {
    finding.severity = Severity::warning;
    finding.code = "contradicting_corner";
    finding.text = fmt::format(
        "{}, where the prescribed displacement towards the obstacle, {:.4g}{}, is beyond the gap of {:.4g}{}",
        place, corner.normal, unit, corner.gap, unit);
    finding.advice =
        "the body is pushed into the obstacle there: no displacement satisfies both; reduce the "
        "displacement or enlarge the gap";
    return finding;
  }
  finding.text = fmt::format(
      "{}, where the displacement towards the obstacle is prescribed: {:.4g}{}, with a gap of {:.4g}{}",
      place, corner.normal, unit, corner.gap, unit);
  finding.advice =
      corner.sticks ? "contact and friction have nothing to decide there; expect a stress singularity, and "
                      "do not read pressures from the last facet"
                    : "contact has nothing to decide there; do not read pressures from the last facet";
  return finding;
}

Finding surface_finding(const ContactBoundaryFacts& contact)
{
  Finding finding{.code = "contact_surface"};
  finding.numbers = {
      {"facets", static_cast<double>(contact.facets)}, {"spread", contact.spread}, {"kink", contact.kink}};
  const std::string direction =
      contact.normal.empty() ? "is closed: it faces all directions" : "faces " + describe(contact.normal);
  if (contact.spread <= flat && !contact.normal.empty())
  {
    finding.text = fmt::format("contact \"{}\" {} and is flat", contact.name, direction);
    return finding;
  }
  finding.text = fmt::format("contact \"{}\" {}, with normals up to {:.3g} degrees from that", contact.name,
                             direction, contact.spread);
  if (contact.kink == 0) return finding;
  finding.severity = Severity::note;
  finding.where = contact.kink_at;
  finding.text += fmt::format("; neighbouring facets differ by up to {:.3g} degrees", contact.kink);
  finding.advice =
      "the pressure will peak at such edges, the more the finer the facets on either side, as refinement "
      "keeps the polygon: name the true shape and the obstacle in the contact (shape, obstacle; "
      "case-format.md of the guide), or take a flat boundary with its curvature in the gap";
  return finding;
}

/// Nothing where the mesh has no curved facets, or the contact has a shape.
std::optional<Finding> straightened_finding(const ContactBoundaryFacts& contact, const std::string& unit)
{
  if (contact.straightened == 0) return {};
  Finding finding{.code = "straightened_facets", .severity = Severity::note};
  finding.numbers = {{"sagitta", contact.straightened}};
  finding.text = fmt::format(
      "contact \"{}\" has second-order facets in the mesh, the straight ones in their place are up to "
      "{:.3g}{} "
      "away",
      contact.name, contact.straightened, unit);
  finding.advice =
      "gap and direction of contact can be those of the curved facets: name a shape in the contact, "
      "with mesh = \"order2\" in its table";
  return finding;
}

/// Nothing where the contact direction is nearly normal to the facets.
std::optional<Finding> direction_finding(const ContactBoundaryFacts& contact)
{
  constexpr double oblique = 60;  // degrees
  if (contact.off_normal <= oblique) return {};
  Finding finding{.code = "contact_direction", .severity = Severity::warning, .where = contact.off_normal_at};
  finding.numbers = {{"angle", contact.off_normal}};
  finding.text =
      fmt::format("contact \"{}\" acts along a direction {:.3g} degrees off the facet's normal at {}",
                  contact.name, contact.off_normal, describe(contact.off_normal_at));
  finding.advice =
      contact.off_normal > 90
          ? "it points into the body there: is the obstacle on the other side (inside, the normal of the "
            "plane)? Where the body turns its back to the obstacle, take these facets out of the boundary"
          : "small displacements are a bad model of contact that oblique: take such facets out of the "
            "boundary, or another obstacle for them";
  return finding;
}

Finding gap_finding(const ContactBoundaryFacts& contact, double size, const std::string& unit)
{
  Finding finding{.code = "gap", .where = contact.smallest_gap_at};
  finding.numbers = {{"smallest", contact.smallest_gap}, {"largest", contact.largest_gap}};
  if (contact.largest_gap == 0 && contact.smallest_gap == 0)
    finding.text = fmt::format("contact \"{}\" is closed everywhere at the start", contact.name);
  else if (contact.smallest_gap == contact.largest_gap)
    finding.text = fmt::format("contact \"{}\" starts with the gap {:.4g}{} everywhere", contact.name,
                               contact.smallest_gap, unit);
  else
    finding.text = fmt::format("contact \"{}\" starts with gaps from {:.4g}{} at {} to {:.4g}{} at {}",
                               contact.name, contact.smallest_gap, unit, describe(contact.smallest_gap_at),
                               contact.largest_gap, unit, describe(contact.largest_gap_at));
  if (contact.largest_gap > beyond * size)
  {
    finding.severity = Severity::warning;
    finding.advice =
        fmt::format("up to {:.3g} times the size of the body: look at the gap's formula and unit",
                    contact.largest_gap / size);
  }
  if (contact.smallest_gap <= far * size) return finding;
  finding.severity = Severity::warning;
  finding.advice = fmt::format(
      "that is {:.2g} % of the body, which small displacements do not close: look at "
      "the gap's formula and unit",
      100 * contact.smallest_gap / size);
  return finding;
}

Finding facets_finding(const ContactBoundaryFacts& contact, bool refines)
{
  Finding finding{.code = "contact_facets"};
  finding.numbers = {{"facets", static_cast<double>(contact.facets)}};
  finding.text = fmt::format("contact \"{}\" has {} facet{}", contact.name, contact.facets,
                             contact.facets == 1 ? "" : "s");
  if (contact.facets >= few_facets) return finding;
  finding.severity = refines ? Severity::note : Severity::warning;
  finding.advice = refines
                       ? "adaptation will refine it; a finer first mesh saves levels"
                       : "too few to show how the pressure is distributed: refine, or let adapt.max_levels "
                         "do it";
  return finding;
}

}  // namespace

std::vector<Finding> contact_findings(const Diagnosis& diagnosis)
{
  std::vector<Finding> result;
  const std::string unit = diagnosis.behind(problem::UnitOf::length);
  for (const OverconstrainedCorner& corner : diagnosis.corners)
    result.push_back(corner_finding(corner, unit));
  for (const ContactBoundaryFacts& contact : diagnosis.contacts)
  {
    if (!contact.is_bilateral) result.push_back(facets_finding(contact, diagnosis.refines));
    result.push_back(surface_finding(contact));
    if (auto straightened = straightened_finding(contact, unit)) result.push_back(std::move(*straightened));
    if (auto direction = direction_finding(contact)) result.push_back(std::move(*direction));
    if (!contact.is_bilateral) result.push_back(gap_finding(contact, diagnosis.loads.size, unit));
  }
  return result;
}

}  // namespace tribound::doctor
