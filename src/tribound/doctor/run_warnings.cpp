#include "tribound/doctor/run_warnings.h"

#include <fmt/format.h>

#include "tribound/doctor/findings.h"

namespace tribound::doctor
{

namespace
{

/// Share of the data in the squares of the components from which refinement goes into the data first.
constexpr double dominant_share = 0.5;
/// A bound below this part of the stress is round-off, whatever its causes.
constexpr double round_off = 1e-9;
/// The next three are between what sound results show and what bad ones do, docs/doctor.md. The first one is
/// ContactOutcome::zigzag.
constexpr double large_zigzag = 0.04;
/// Pressure at kinks of the surface over the mean pressure. 1.27 and 1.5 are Hertz's maxima in 2D and 3D.
constexpr double large_kink_pressure = 2;
/// Penetration over the largest displacement.
constexpr double large_penetration = 0.02;
/// From here on friction can be stronger than the pressure that causes it.
constexpr double large_coefficient = 1;
/// Fewer closed facets do not resolve a contact zone.
constexpr long few_closed_facets = 4;

std::string location(const std::string& boundary, const Place& where)
{
  const std::string name = fmt::format("boundary \"{}\"", boundary);
  return where.empty() ? name : fmt::format("{} at {}", name, describe(where));
}

void add_data(const io::LevelRecord& level, std::vector<io::RunWarning>& warnings)
{
  if (!level.bound || io::relative_bound(level).value_or(0) <= round_off) return;
  const certify::BoundComponents& eta = level.bound->global;
  double squares = 0;
  for (const auto& [name, member] : certify::all_component_names) squares += eta.*member * eta.*member;
  const auto add = [&](const char* code, double component, const char* name, const char* text)
  {
    const double share = component * component / squares;
    if (share > dominant_share)
      warnings.push_back(
          {code,
           fmt::format("{} makes up {:.3g} % of the bound (of the squares): {}", name, 100 * share, text),
           share,
           {}});
  };
  add("body_force_oscillation", eta.osc, "osc",
      "the body force varies faster than the mesh shows; refine where it varies, or raise the degree");
  add("traction_oscillation", eta.neu, "neu",
      "the tractions vary faster than the facets show; put vertices where they jump, or refine there");
}

void add_resolution(const ContactOutcome& outcome, std::vector<io::RunWarning>& warnings)
{
  if (outcome.closed == 0)
    warnings.push_back({"no_contact", "nothing touches there: the boundary might as well be free", 0,
                        location(outcome.boundary, {})});
  else if (outcome.closed_facets < few_closed_facets && outcome.closed_facets < outcome.facets)
    warnings.push_back(
        {"few_contact_facets",
         fmt::format("the contact zone covers {} whole facet{}: too few for its size or its largest "
                     "pressure",
                     outcome.closed_facets, outcome.closed_facets == 1 ? "" : "s"),
         static_cast<double>(outcome.closed_facets), location(outcome.boundary, {})});
}

void add_pressure(const ContactOutcome& outcome, std::vector<io::RunWarning>& warnings)
{
  if (outcome.zigzag > large_zigzag)
    warnings.push_back(
        {"pressure_zigzag",
         fmt::format("the contact pressure goes up and down by {:.2g} % of itself from facet "
                     "to facet: do not read single values; refine there, or take a higher degree",
                     100 * outcome.zigzag),
         outcome.zigzag, location(outcome.boundary, outcome.zigzag_at)});
  if (outcome.kink_pressure <= large_kink_pressure * outcome.mean_pressure()) return;
  const double ratio = outcome.kink_pressure / outcome.mean_pressure();
  warnings.push_back(
      {"pressure_at_kinks",
       fmt::format(
           "the contact pressure reaches {:.3g}, {:.2g} times its mean, where facets meet at an angle "
           "(up to {:.2g} degrees): a peak of the polygon, not of the curve behind it, that grows with "
           "refinement; give the gap of the true shape along the obstacle's normal, such as "
           "\"1-sqrt(1-x^2)\" in the place of \"y\" for an arc on a floor, or take a flat boundary with "
           "the curvature in the gap",
           outcome.kink_pressure, ratio, outcome.kink),
       ratio, location(outcome.boundary, outcome.kink_at)});
}

void add_penetration(const ContactOutcome& outcome, double max_displacement,
                     std::vector<io::RunWarning>& warnings)
{
  if (outcome.penetration <= large_penetration * max_displacement) return;
  const double ratio = outcome.penetration / max_displacement;
  warnings.push_back(
      {"penetration",
       fmt::format("the body penetrates the obstacle by {:.3g}, {:.2g} % of the largest displacement: "
                   "contact is met on average only; refine there, or raise nitsche.gamma0 where "
                   "it was lowered",
                   outcome.penetration, 100 * ratio),
       ratio, location(outcome.boundary, outcome.penetration_at)});
}

void add_friction(const ContactOutcome& outcome, std::vector<io::RunWarning>& warnings)
{
  constexpr double all = 1 - 1e-9;
  if (outcome.coefficient.value_or(0) >= large_coefficient)
    warnings.push_back(
        {"friction_coefficient",
         fmt::format("a friction coefficient of {:g} is large: existence is known for small "
                     "coefficients only, and several solutions are possible for larger ones; compare "
                     "with a smaller one, and with another first mesh",
                     *outcome.coefficient),
         *outcome.coefficient, location(outcome.boundary, {})});
  if (outcome.has_friction && outcome.closed > 0 && outcome.slipping >= all * outcome.closed)
    warnings.push_back(
        {"sliding",
         "all of the contact zone slides: friction is used up, and the model says nothing of what a "
         "larger load would do",
         outcome.slipping / outcome.closed, location(outcome.boundary, {})});
}

}  // namespace

std::vector<io::RunWarning> run_warnings(const io::LevelRecord& level,
                                         std::span<const ContactOutcome> outcomes)
{
  std::vector<io::RunWarning> warnings;
  add_data(level, warnings);
  for (const ContactOutcome& outcome : outcomes)
  {
    add_resolution(outcome, warnings);
    add_pressure(outcome, warnings);
    add_penetration(outcome, level.figures.max_displacement, warnings);
    add_friction(outcome, warnings);
  }
  return warnings;
}

}  // namespace tribound::doctor
