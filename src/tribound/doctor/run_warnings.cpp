#include "tribound/doctor/run_warnings.h"

#include <fmt/format.h>

#include "tribound/doctor/findings.h"

namespace tribound::doctor
{

using problem::UnitOf;

namespace
{

/// Share of the data in the sum of squares of the components from which refinement mainly improves the data.
constexpr double dominant_share = 0.5;
/// A bound below this fraction of the stress is round-off, whatever its causes.
constexpr double round_off = 1e-9;
/// The next three lie between the values of good and of bad results, see docs/doctor.md. This one limits
/// ContactOutcome::zigzag.
constexpr double large_zigzag = 0.04;
/// Pressure at kinks of the surface over the mean pressure. 1.27 and 1.5 are Hertz's maxima in 2D and 3D.
constexpr double large_kink_pressure = 2;
/// Penetration over the largest displacement.
constexpr double large_penetration = 0.02;
/// From this coefficient on, friction can exceed the pressure that causes it.
constexpr double large_coefficient = 1;
/// Fewer closed facets do not resolve a contact zone.
constexpr long few_closed_facets = 4;
/// Slope of a law over gamma; at 1 the law has no unique solution, and Newton's method fails earlier.
constexpr double large_softening = 0.5;
/// Rows of facets across a process zone.
constexpr double few_rows = 3;

/// A warning with the value that was compared with a limit.
Finding warning(const char* code, std::string text, double value, const std::string& boundary = {},
                const Place& where = {})
{
  Finding finding{code, Severity::warning, std::move(text), {{"value", value}}, where};
  finding.boundary = boundary;
  return finding;
}

void add_data(const SolvedFigures& solved, std::vector<Finding>& warnings)
{
  if (!solved.bound || !(solved.sigma_norm > 0)) return;
  if (solved.bound->total_sharp <= round_off * solved.sigma_norm) return;
  const certify::BoundComponents& eta = solved.bound->global;
  double squares = 0;
  for (const certify::Component& c : certify::all_components)
    if (c.is_summand()) squares += eta.*c.value * eta.*c.value;
  const auto add = [&](const char* code, double component, const char* name, const char* text)
  {
    const double share = component * component / squares;
    if (share > dominant_share)
      warnings.push_back(warning(
          code,
          fmt::format("{} makes up {:.3g} % of the bound (of the squares): {}", name, 100 * share, text),
          share));
  };
  add("body_force_oscillation", eta.osc, "osc",
      "the body force varies faster than the mesh shows; refine where it varies, or raise the degree");
  add("traction_oscillation", eta.neu, "neu",
      "the tractions vary faster than the facets show; put vertices where they jump, or refine there");
}

void add_resolution(const ContactOutcome& outcome, std::vector<Finding>& warnings)
{
  if (outcome.closed == 0 && outcome.carries) return;  // a bond in tension
  if (outcome.closed == 0)
    warnings.push_back(warning("no_contact", "nothing touches there: the boundary might as well be free", 0,
                               outcome.boundary));
  else if (outcome.closed_facets < few_closed_facets && outcome.closed_facets < outcome.facets)
    warnings.push_back(
        warning("few_contact_facets",
                fmt::format("the contact zone covers {} whole facet{}: too few for its size or its largest "
                            "pressure",
                            outcome.closed_facets, outcome.closed_facets == 1 ? "" : "s"),
                static_cast<double>(outcome.closed_facets), outcome.boundary));
}

void add_pressure(const ContactOutcome& outcome, const problem::Units& units, std::vector<Finding>& warnings)
{
  if (outcome.zigzag > large_zigzag)
    warnings.push_back(
        warning("pressure_zigzag",
                fmt::format("the contact pressure goes up and down by {:.2g} % of itself from facet "
                            "to facet: do not read single values; refine there, or take a higher degree",
                            100 * outcome.zigzag),
                outcome.zigzag, outcome.boundary, outcome.zigzag_at));
  if (outcome.kink_pressure <= large_kink_pressure * outcome.mean_pressure()) return;
  const double ratio = outcome.kink_pressure / outcome.mean_pressure();
  warnings.push_back(warning(
      "pressure_at_kinks",
      fmt::format(
          "the contact pressure reaches {:.3g}{}, {:.2g} times its mean, where facets meet at an angle "
          "(up to {:.2g} degrees): a peak of the polygon, not of the curve behind it, that grows with "
          "refinement; name the true shape and the obstacle, such as contact.shape = \"arc\" and "
          "contact.obstacle = \"floor\" with [shape.arc] circle = {{ centre = [0, 1], radius = 1 }} and "
          "[obstacle.floor] plane = {{ point = [0, 0], normal = [0, 1] }}; or take a flat boundary with the "
          "curvature in the gap",
          outcome.kink_pressure, units.behind(UnitOf::stress), ratio, outcome.kink),
      ratio, outcome.boundary, outcome.kink_at));
}

void add_penetration(const ContactOutcome& outcome, const SolvedFigures& solved,
                     std::vector<Finding>& warnings)
{
  const double max_displacement = solved.max_displacement;
  if (outcome.penetration <= large_penetration * max_displacement) return;
  const double ratio = outcome.penetration / max_displacement;
  warnings.push_back(warning(
      "penetration",
      fmt::format("{} by {:.3g}{}, {:.2g} % of the largest displacement: contact is met on average "
                  "only; refine there, or raise nitsche.gamma0 where it was lowered",
                  outcome.has_master ? "the bodies penetrate each other" : "the body penetrates the obstacle",
                  outcome.penetration, solved.units.behind(UnitOf::length), 100 * ratio),
      ratio, outcome.boundary, outcome.penetration_at));
}

void add_friction(const ContactOutcome& outcome, std::vector<Finding>& warnings)
{
  constexpr double all = 1 - 1e-9;
  if (outcome.coefficient.value_or(0) >= large_coefficient)
    warnings.push_back(
        warning("friction_coefficient",
                fmt::format("a friction coefficient of {:g} is large: existence is known for small "
                            "coefficients only, and several solutions are possible for larger ones; compare "
                            "with a smaller one, and with another first mesh",
                            *outcome.coefficient),
                *outcome.coefficient, outcome.boundary));
  if (outcome.has_friction && outcome.closed > 0 && outcome.slipping >= all * outcome.closed)
    warnings.push_back(
        warning("sliding",
                "all of the contact zone slides: friction is used up, and the model says nothing of what a "
                "larger load would do",
                outcome.slipping / outcome.closed, outcome.boundary));
}

void add_damage(const ContactOutcome& outcome, const problem::Units& units, std::vector<Finding>& warnings)
{
  const Softening& softening = outcome.damage.softening;
  const std::string slope = units.behind(UnitOf::body_force);
  const std::string length = units.behind(UnitOf::length);
  if (softening.ratio() > large_softening)
    warnings.push_back(warning(
        "steep_softening",
        fmt::format(
            "the law softens with the slope {:.4g}{}, and gamma is {:.4g}{} on a facet of size {:.4g}{}: "
            "Newton's method may fail; take facets of less than {:.4g}{} there, or a nitsche.gamma0 of "
            "{:.2g} times as much",
            softening.slope, slope, softening.gamma, slope, softening.h, length,
            large_softening * softening.h / softening.ratio(), length, softening.ratio() / large_softening),
        softening.ratio(), outcome.boundary, softening.where));
  if (outcome.damage.process_zone.value_or(few_rows) < few_rows)
    warnings.push_back(warning(
        "process_zone",
        fmt::format("between what is broken and what is whole lie {:.2g} rows of facets, where the law "
                    "softens: too few for the stresses there and for how far the crack goes; five or "
                    "more resolve them",
                    *outcome.damage.process_zone),
        *outcome.damage.process_zone, outcome.boundary));
  if (outcome.damage.open_cohesion > 0)
    warnings.push_back(warning(
        "open_cohesion",
        fmt::format("an open point keeps its cohesion of {:.4g}{}, since only slip takes it from a joint "
                    "without tensile strength: with tensile_strength and fracture_energy what opens breaks",
                    outcome.damage.open_cohesion, units.behind(UnitOf::stress)),
        outcome.damage.open_cohesion, outcome.boundary));
}

}  // namespace

std::vector<Finding> run_warnings(const SolvedFigures& solved, std::span<const ContactOutcome> outcomes)
{
  std::vector<Finding> warnings;
  add_data(solved, warnings);
  for (const ContactOutcome& outcome : outcomes)
  {
    add_resolution(outcome, warnings);
    add_pressure(outcome, solved.units, warnings);
    add_penetration(outcome, solved, warnings);
    add_friction(outcome, warnings);
    add_damage(outcome, solved.units, warnings);
  }
  return warnings;
}

}  // namespace tribound::doctor
