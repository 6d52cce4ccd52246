#include "tribound/doctor/findings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tribound::doctor
{

using problem::UnitOf;

namespace
{

/// Above this, strains are no longer small: the quadratic terms neglected by linear elasticity have this
/// relative size.
constexpr double small_strain = 0.05;
/// Below this, loads and E probably have different units: Pa for MPa is a factor of 1e6 off a usual 1e-4.
constexpr double tiny_strain = 1e-9;
/// From this Poisson's ratio on, elements of degree 1 lock.
constexpr double nearly_incompressible = 0.49;
constexpr double large_aspect = 10;    // 1 for the regular simplex
constexpr double large_grading = 1e4;  // largest cell over smallest

/// Angles outside this range are poor, degrees. Mesh generators stay inside by default.
struct GoodAngles
{
  double smallest;
  double largest;
};
constexpr GoodAngles good_2d{15, 150};
constexpr GoodAngles good_3d{8, 165};

using Findings = std::vector<Finding>;

Finding held(const ContactHeldMotion& motion)
{
  Finding finding{.code = motion.by_friction ? "held_by_friction" : "held_by_contact",
                  .severity = Severity::note};
  finding.text =
      motion.by_friction
          ? fmt::format("only friction stops {} from {}", motion.body, motion.motion)
          : fmt::format("only contact stops {} from {}, and contact only pushes", motion.body, motion.motion);
  const char* press = motion.of_several ? "the loads must press the bodies together"
                                        : "the loads must press the body against the obstacle";
  finding.advice = motion.by_friction ? "the loads must press the body on while friction holds it" : press;
  if (motion.remedy)
    finding.advice +=
        fmt::format("; a fixed displacement {} would hold it for certain", contact::describe(*motion.remedy));
  return finding;
}

Finding load_beyond(const LoadBeyondContact& load)
{
  return {.code = "load_beyond_contact",
          .severity = Severity::warning,
          .text = fmt::format("at t = {:g} {}", load.t, load.why),
          .numbers = {{"t", load.t}},
          .advice = "there is no equilibrium there: under given loads the path ends before it"};
}

void add_supports(const Diagnosis& diagnosis, Findings& findings)
{
  if (diagnosis.beyond_contact) findings.push_back(load_beyond(*diagnosis.beyond_contact));
  for (const ContactHeldMotion& motion : diagnosis.held_by_contact) findings.push_back(held(motion));
  if (!diagnosis.held_by_contact.empty()) return;
  const bool has_sliders = std::ranges::any_of(
      diagnosis.contacts, [](const ContactBoundaryFacts& facts) { return facts.is_bilateral; });
  const bool has_springs = diagnosis.loads.has_springs;
  findings.push_back({.code = "held",
                      .text = fmt::format("displacement conditions{}{} stop every rigid motion",
                                          !has_sliders  ? ""
                                          : has_springs ? ", sliders"
                                                        : " and sliders",
                                          has_springs    ? " and springs"
                                          : !has_sliders ? " alone"
                                                         : "")});
}

/// What gives loads.strain(), in words.
std::string cause_of_strain(const LoadFacts& loads, const std::string& stress_unit,
                            const std::string& length_unit)
{
  const double strain = loads.strain();
  const auto of_stress = [&](const char* stresses, double stress)
  {
    return fmt::format("{} near {:.3g}{}, E = {:.4g}{}", stresses, stress, stress_unit, loads.smallest_E,
                       stress_unit);
  };
  if (loads.stress() / loads.smallest_E >= strain) return of_stress("stresses", loads.stress());
  if (loads.initial_stress / loads.smallest_E >= strain)
    return of_stress("initial stresses", loads.initial_stress);
  if (loads.thermal_strain >= strain) return "alpha times the change of the temperature";
  return fmt::format(
      "{} {:.3g}{} over the size {:.4g}{}",
      loads.displacement_strain >= strain ? "prescribed displacements of" : "interferences up to",
      strain * loads.size, length_unit, loads.size, length_unit);
}

Finding strain_finding(const Diagnosis& diagnosis)
{
  const LoadFacts& loads = diagnosis.loads;
  const std::string stress_unit = diagnosis.behind(UnitOf::stress);
  const std::string length_unit = diagnosis.behind(UnitOf::length);
  Finding finding{.code = "strain"};
  finding.numbers = {{"strain", loads.strain()},
                     {"traction_stress", loads.traction_stress},
                     {"support_stress", loads.support_stress},
                     {"body_stress", loads.body_stress},
                     {"displacement_strain", loads.displacement_strain},
                     {"interference_strain", loads.interference_strain},
                     {"thermal_strain", loads.thermal_strain},
                     {"initial_stress", loads.initial_stress},
                     {"E", loads.smallest_E}};
  if (loads.strain() == 0)
  {
    finding.severity = Severity::note;
    finding.code = "no_load";
    finding.text = "there is no load, no interference and no prescribed displacement but 0";
    finding.advice =
        "the solution is 0; unless that is what you want, add a traction, a pressure, a body force or "
        "a displacement";
    return finding;
  }
  finding.text = fmt::format("expect strains of about {:.2g} % ({})", 100 * loads.strain(),
                             cause_of_strain(loads, stress_unit, length_unit));
  if (loads.strain() < tiny_strain)
  {
    finding.severity = Severity::note;
    finding.advice = "so little is unusual: look at the units of loads and E";
  }
  if (loads.strain() <= small_strain) return finding;
  finding.severity = Severity::warning;
  finding.advice =
      "linear elasticity is meant for strains of a few per cent at most: look at the units of loads "
      "and E; in a scaled model only ratios mean something";
  return finding;
}

void add_soft_springs(const Diagnosis& diagnosis, Findings& findings)
{
  const double shift = diagnosis.loads.spring_shift;
  if (shift <= small_strain) return;
  Finding finding{.code = "soft_springs", .severity = Severity::warning};
  finding.text = fmt::format("the loads move the body about {:.3g}{} on its springs, {:.2g} of its size",
                             shift * diagnosis.loads.size, diagnosis.behind(UnitOf::length), shift);
  finding.advice = "displacements are meant to be small: look at the units, stress per length, of spring";
  finding.numbers = {{"spring_shift", shift}};
  findings.push_back(std::move(finding));
}

void add_suction(const Diagnosis& diagnosis, Findings& findings)
{
  for (const Suction& suction : diagnosis.loads.suction)
  {
    Finding finding{.code = "suction", .severity = Severity::warning};
    finding.text = fmt::format(
        "the pressure on boundary \"{}\" is negative, {:.4g}{} at {}: it pulls the body", suction.boundary,
        suction.lowest, diagnosis.behind(UnitOf::stress), describe(suction.where));
    finding.advice =
        "pressure is positive where it pushes; water above its level is cut off: \"9810*max(0, 9-y)\"";
    finding.numbers = {{"pressure", suction.lowest}};
    findings.push_back(std::move(finding));
  }
}

void add_poisson(const Diagnosis& diagnosis, Findings& findings)
{
  for (const RegionMaterial& material : diagnosis.loads.materials)
  {
    if (material.nu <= nearly_incompressible || material.plane_stress) continue;
    Finding finding{.code = "nearly_incompressible",
                    .severity = diagnosis.degree == 1 ? Severity::warning : Severity::note};
    finding.numbers = {{"nu", material.nu}};
    finding.text =
        fmt::format("region \"{}\" is nearly incompressible: nu = {:.6g}", material.region, material.nu);
    finding.advice = diagnosis.degree == 1
                         ? "elements of degree 1 are too stiff for it: take degree 2 or more"
                         : "degree 2 or more copes, but expect larger bounds";
    findings.push_back(finding);
  }
}

void add_mesh(const Diagnosis& diagnosis, Findings& findings)
{
  const MeshQuality& mesh = diagnosis.mesh;
  const GoodAngles good = diagnosis.loads.extent.size() == 2 ? good_2d : good_3d;
  const bool sharp = mesh.smallest_angle < good.smallest;
  const bool blunt = mesh.largest_angle > good.largest;
  const bool poor = sharp || blunt || mesh.largest_aspect > large_aspect;
  Finding shape{.code = "cell_shapes", .severity = poor ? Severity::warning : Severity::ok};
  shape.numbers = {{"smallest_angle", mesh.smallest_angle},
                   {"largest_angle", mesh.largest_angle},
                   {"aspect", mesh.largest_aspect}};
  shape.where = sharp ? mesh.smallest_angle_at : blunt ? mesh.largest_angle_at : mesh.largest_aspect_at;
  shape.text = fmt::format(
      "angles of the cells are between {:.3g} degrees at {} and {:.3g} degrees at {}, the worst "
      "aspect ratio is {:.3g} at {}",
      mesh.smallest_angle, describe(mesh.smallest_angle_at), mesh.largest_angle,
      describe(mesh.largest_angle_at), mesh.largest_aspect, describe(mesh.largest_aspect_at));
  if (poor)
    shape.advice =
        "such cells make the bound pessimistic and the matrices worse: mend the mesh there; bisection "
        "keeps shapes as they are";
  findings.push_back(shape);

  const double ratio = mesh.largest_cell / mesh.smallest_cell;
  Finding sizes{.code = "cell_sizes", .severity = ratio > large_grading ? Severity::warning : Severity::ok};
  sizes.numbers = {{"smallest", mesh.smallest_cell}, {"largest", mesh.largest_cell}, {"ratio", ratio}};
  sizes.text = fmt::format("cells have sizes from {:.4g} to {:.4g}{}, a ratio of {:.3g}", mesh.smallest_cell,
                           mesh.largest_cell, diagnosis.behind(UnitOf::length), ratio);
  if (ratio > large_grading) sizes.advice = "is one of the sizes in the .geo a slip of the pen?";
  findings.push_back(sizes);
}

}  // namespace

const char* to_string(Severity severity)
{
  switch (severity)
  {
    case Severity::warning:
      return "warning";
    case Severity::note:
      return "note";
    default:
      return "ok";
  }
}

std::string location(const Finding& finding)
{
  if (finding.boundary.empty()) return finding.where.empty() ? "" : "at " + describe(finding.where);
  const std::string name = fmt::format("boundary \"{}\"", finding.boundary);
  return finding.where.empty() ? name : fmt::format("{} at {}", name, describe(finding.where));
}

std::string describe(const Place& where)
{
  constexpr double round_off = 1e-12;
  std::vector<double> x = where;
  double largest = 0;
  for (const double component : where) largest = std::max(largest, std::abs(component));
  for (double& component : x)
    if (std::abs(component) <= round_off * largest) component = 0;
  return fmt::format("({:.6g})", fmt::join(x, ", "));
}

std::vector<Finding> findings(const Diagnosis& diagnosis)
{
  Findings result;
  add_supports(diagnosis, result);
  std::ranges::move(contact_findings(diagnosis), std::back_inserter(result));
  std::ranges::move(pair_findings(diagnosis), std::back_inserter(result));
  result.push_back(strain_finding(diagnosis));
  add_soft_springs(diagnosis, result);
  add_suction(diagnosis, result);
  add_poisson(diagnosis, result);
  std::ranges::move(unit_findings(diagnosis), std::back_inserter(result));
  add_mesh(diagnosis, result);
  std::ranges::move(cost_findings(diagnosis), std::back_inserter(result));
  return result;
}

}  // namespace tribound::doctor
