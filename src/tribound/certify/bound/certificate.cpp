#include "tribound/certify/bound/certificate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tribound/certify/bound/constants.h"
#include "tribound/certify/bound/contact_geometry.h"
#include "tribound/contact/nitsche/elasticity.h"

namespace tribound::certify
{

const char* to_string(RunStatus status)
{
  switch (status)
  {
    case RunStatus::certified:
      return "certified";
    case RunStatus::budget:
      return "budget";
    case RunStatus::not_certified:
      return "not certified";
    case RunStatus::failed:
      return "failed";
    case RunStatus::uncertified:
      break;
  }
  return "uncertified";
}

bool is_bound(RunStatus status)
{
  return status == RunStatus::certified || status == RunStatus::budget;
}

bool is_round_off(const Bound& bound, const contact::StressNorms& norms)
{
  return bound.total_sharp <= norms.round_off && norms.sigma <= norms.round_off;
}

std::string identity_violation(double defect)
{
  if (defect <= identity_limit) return {};
  return fmt::format(
      "an identity of the equilibrated stress is violated: {:.2e} of ||sigma_h||, the limit "
      "is {:g}; what was computed is no bound",
      defect, identity_limit);
}

Verdict judge(const Bound& bound, const IdentityDefects& identities, const contact::StressNorms& norms,
              double tolerance)
{
  if (!std::isfinite(bound.total_sharp) || !std::isfinite(norms.sigma))
    return {RunStatus::not_certified, "the bound is not a finite number"};
  if (is_round_off(bound, norms)) return {RunStatus::certified, {}};
  if (std::string violation = identity_violation(identities.largest()); !violation.empty())
    return {RunStatus::not_certified, std::move(violation)};
  if (bound.total_sharp <= tolerance * norms.sigma) return {RunStatus::certified, {}};
  if (norms.sigma == 0)
    return {RunStatus::budget, "the bound holds, but the stress is zero, so that it is no share of that"};
  return {RunStatus::budget, fmt::format("the bound holds, but it is {:.3g} % of ||sigma(u_h)||, above "
                                         "adapt.tolerance = {:g} %",
                                         100 * bound.total_sharp / norms.sigma, 100 * tolerance)};
}

namespace
{

/// What is known about the continuous problem with the friction laws in use.
template <int dim>
std::string describe_law(const problem::Problem<dim>& problem)
{
  if (!problem.has_contact()) return "linear elasticity: the solution exists and is unique";
  std::vector<problem::ContactLaw> laws;
  for (const auto& boundary : problem.boundaries())
    if (boundary.contact) laws.push_back(boundary.contact->law);
  for (const auto& pair : problem.pairs()) laws.push_back(pair.contact.law);
  if (std::ranges::all_of(laws, [](const auto& law) { return cone(law).is_tied; }))
    return "linear elasticity of bodies tied to each other: the solution exists and is unique";
  if (std::ranges::all_of(laws, [](const auto& law) { return cone(law).is_bilateral; }))
    return "linear elasticity with sliders: the solution exists and is unique, but for motions without "
           "stress";
  if (std::ranges::any_of(laws, [](const auto& law) { return cone(law).is_bonded; }))
    return "cohesive: existence and uniqueness are not known once the interface softens; loading without "
           "softening, with a given friction threshold: unique";
  const bool minimum = std::ranges::all_of(laws, problem::is_minimum);
  if (!minimum)
    return "Coulomb friction: existence is known for small friction coefficients; uniqueness is not known "
           "even then, but for criteria on the solution; the residual is bounded in any case";
  return "unilateral contact without friction or with Tresca friction: the solution exists and is unique, "
         "but for motions without stress of bodies that contact alone holds";
}

/// How data that are not polynomials were treated.
template <int dim>
std::string describe_data(const contact::DataEffort& effort, int degree, const problem::Problem<dim>& problem)
{
  std::string exact = fmt::format(
      "loads, gaps and thresholds that are polynomials of degree {} are integrated exactly", degree);
  if (problem.has_initial_stress())
    exact += fmt::format(", so are temperature and initial stress, in contact of degree {}", degree - 2);
  if (problem.has_springs())
    exact += fmt::format(", forces of springs where k has degree 2 and k u_0 degree {}", degree);
  if (effort.formulas == 0) return exact;
  const std::string cut =
      effort.subdivided == 0 ? std::string()
                             : fmt::format(", {} of them cut into {} parts", effort.subdivided, effort.parts);
  return exact + fmt::format(
                     "; other formulas are enclosed by intervals on {} cells and boundary facets{}, and "
                     "what their integrals may miss is in osc, str, neu, cnt, frc and quad",
                     effort.formulas, cut);
}

/// What the model of contact between bodies leaves out.
template <int dim>
std::vector<std::string> outside_of_pairs(const problem::Problem<dim>& problem)
{
  if (problem.pairs().empty()) return {};
  std::vector<std::string> outside = {
      "pairing and gap are those of the undeformed configuration; sliding must be small against the facets "
      "and the radius of curvature",
      "the facets of both sides are flat; between them the geometric gap is part of the data"};
  if (std::ranges::any_of(problem.pairs(), [](const auto& pair) { return cone(pair.contact.law).is_tied; }))
    outside.emplace_back("tied interfaces are not opened: tension is transmitted");
  if (std::ranges::any_of(problem.pairs(), [](const auto& pair)
                          { return std::holds_alternative<problem::Slider>(pair.contact.law); }))
    outside.emplace_back("sliders are not opened: tension along their normals is transmitted");
  return outside;
}

/// What is known about the polygon that replaces a curve.
std::string describe_geometry(const ContactGeometryFacts& facts)
{
  constexpr double round_off = 0.01;  // of coordinates in a file, in degrees
  std::string text = "facets are straight";
  if (facts.turn > round_off)
    text += fmt::format(
        "; contact facets that meet turn by up to {:.3g} degrees, the directions of contact by {}",
        facts.turn, facts.jump > round_off ? fmt::format("{:.3g}", facts.jump) : "none");
  if (facts.has_direction)
    text += fmt::format(
        "; contact acts along given directions, up to {:.3g} degrees from the normals of the facets",
        facts.off_normal);
  if (facts.has_shape)
    text += fmt::format("; the facets are up to {:.3g} away from the given shapes, whose gaps they have",
                        facts.sagitta);
  if (facts.straightened > 0)
    text +=
        fmt::format("; straight contact facets are up to {:.3g} away from those of second order in the mesh",
                    facts.straightened);
  return text;
}

/// How the integrals in the bound are evaluated.
template <int dim>
std::string describe_quadrature(const contact::NitscheForm<dim>& form, ContactRule rule)
{
  std::string text = describe_data(form.data().effort(), form.space().degree() + 2, form.problem());
  if (!form.problem().has_contact()) return text;
  return text +
         (rule == ContactRule::resolved
              ? "; facets with a kink of the traction, in 3D also those that slip, are subdivided until cnt "
                "and frc settle"
              : "; cnt and frc with the plain rule, which is not rigorous on facets with a kink of the "
                "traction, in 3D also on those that slip (certify.contact_rule = \"reference\")");
}

/// C_F and the proof of it, or what replaces alg.
template <int dim>
void add_friedrichs(const std::optional<FriedrichsConstant>& c, Statements& statements)
{
  if (!c || !std::isfinite(c->value))
  {
    statements.assumptions.emplace_back(
        "linear_systems",
        "no Friedrichs constant could be proved, so that alg is not in the bound: they were solved to "
        "solver.tolerance, and the identities show what is left");
    return;
  }
  statements.constants.emplace_back("friedrichs", c->value);
  statements.constants.emplace_back("friedrichs_theta", c->theta);
  statements.constants.emplace_back("friedrichs_mesh_cells", c->cells);
  if (c->mesh_size > 0)
  {
    statements.constants.emplace_back("friedrichs_mesh_size", c->mesh_size);
    statements.constants.emplace_back("kappa", friedrichs_kappa<dim>());
  }
}

}  // namespace

template <int dim>
Statements statements(const contact::NitscheForm<dim>& form, ContactRule rule,
                      const std::optional<FriedrichsConstant>& friedrichs)
{
  const problem::Problem<dim>& problem = form.problem();
  const auto where = [](bool holds, const char* words) { return std::string(holds ? words : ""); };
  Statements result;
  result.covered = {
      "the dual norm of the residual of the computed displacement: the largest <R(u_h), v> over all v in "
      "H^1, zero where displacements are prescribed" +
          where(problem.has_rigid_parts(), " and a rigid motion on each rigid part") + ", with ||grad v||^2" +
          where(problem.is_axisymmetric(), " + ||v_r / r||^2") +
          " + sum_F ||v||_F^2 / h_F = 1 over contact facets F" +
          where(problem.has_springs(), " and those on springs") +
          where(
              !problem.pairs().empty(),
              ", between bodies with the jump of v over the segments on which a facet of one lies opposite a "
              "facet of the other") +
          where(problem.is_axisymmetric(), ", integrals over the meridian with the weight r") +
          "; no unknown constant",
      "the errors of discretisation, of the data, of the contact and friction conditions, of stopping "
      "Newton's method, and of solving its linear systems"};
  if (!form.problem().pairs().empty())
    result.covered.emplace_back(
        "what contact tractions lose between meshes that do not match (mor); forces on slave and master are "
        "equal and opposite");
  result.law = describe_law(form.problem());
  result.constants = {
      {"poincare", poincare_constant(1)},
      {"trace_squared", form.problem().is_axisymmetric() ? std::pow(meridian_trace_constant(1, 1, 1), 2)
                                                         : trace_constant_squared<dim>()},
      {"identity_limit", identity_limit}};
  add_friedrichs<dim>(friedrichs, result);

  double largest = 0;
  for (const double value : form.constraints().values) largest = std::max(largest, std::abs(value));
  largest = form.space().mesh().ranks().max(largest);
  const double interpolation = dirichlet_interpolation_bound(form);
  const bool exact = interpolation <= 1e-12 * largest;
  const ContactGeometryFacts geometry = contact_geometry(form);
  result.assumptions = {
      {"quadrature", describe_quadrature(form, rule)},
      {"displacement",
       exact ? std::string("the prescribed displacements are in the finite element space")
             : fmt::format(
                   "the prescribed displacements are interpolated at the nodes; they "
                   "differ by {:.3g} where they were compared{}",
                   dirichlet_interpolation_error(form),
                   std::isfinite(interpolation) ? fmt::format(", by {:.3g} at most", interpolation) : "")},
      {"geometry", describe_geometry(geometry)},
      {"rounding", "double precision; rounding errors are not enclosed, the identities show their size"}};

  for (const std::string& outside : outside_of_pairs(form.problem())) result.not_covered.push_back(outside);
  if (std::ranges::any_of(form.problem().contacts(), [](const problem::Contact* contact)
                          { return contact->water && contact->water->follows_crack(); }))
    result.not_covered.emplace_back(
        "which crack the water fills: its tip, found from the computed openings, is part of the data, and "
        "stays "
        "where it was when the crack closes");
  if (rule == ContactRule::reference && form.problem().has_contact())
    result.not_covered.emplace_back(
        "contact and friction conditions on facets where the contact law has a kink: there the plain rule is "
        "no bound (certify.contact_rule = \"reference\")");
  if (!exact)
    result.not_covered.push_back("the interpolation of the prescribed displacements" +
                                 (std::isfinite(interpolation)
                                      ? fmt::format(", which changes them by {:.3g} at most", interpolation)
                                      : std::string(": they are a function without enclosure")));
  if (form.data().effort().unenclosed > 0)
    result.not_covered.emplace_back(
        "what data given by functions without enclosure do between the points at which they were evaluated");
  result.not_covered.emplace_back(geometry.has_shape ? "straight facets in place of a curved boundary, but "
                                                       "for the gaps and directions of contact, which "
                                                       "are those of the given shapes"
                                                     : "straight facets in place of a curved boundary");
  result.not_covered.emplace_back("the model: linear elasticity, small strains, the friction law, the data");
  return result;
}

void add_history(Statements& statements, bool left_early, bool carried)
{
  statements.covered.emplace_back(
      "of every load step the residual of that step: equilibrium, the data at its t, and the interface law "
      "with the history (damage, slip) that the step before has left, at every Newton iterate at that t");
  statements.not_covered.emplace_back(
      std::string("errors that earlier load steps have left in the history") +
      (left_early ? ", that of leaving Newton's method early among them" : ""));
  if (carried)
  {
    statements.assumptions.emplace_back(
        "history",
        "carried to finer meshes along the path, as the polynomials of degree p + 2 on the contact facets: "
        "in "
        "2D the same function, in 3D these in the place of the values at the contact points");
    statements.not_covered.emplace_back(
        "what earlier load steps would have left had they been solved on the later, finer meshes");
  }
  statements.not_covered.emplace_back("the size of the load steps");
  statements.not_covered.emplace_back(
      "the choice of branch: with softening or Coulomb's friction there may be several solutions, and after "
      "a peak the quasi-static path need not be the physical one");
}

template Statements statements(const contact::NitscheForm<2>&, ContactRule,
                               const std::optional<FriedrichsConstant>&);
template Statements statements(const contact::NitscheForm<3>&, ContactRule,
                               const std::optional<FriedrichsConstant>&);

}  // namespace tribound::certify
