#include "tribound/problem/contact_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>

#include "tribound/problem/unilateral.h"

namespace tribound::problem
{

namespace
{

template <FrictionLaw L>
ContactLaw make(std::span<const Field> values)
{
  return L(values);
}

/// The kinds of all laws without bond, which come first.
template <class... L>
constexpr auto kinds_of(const std::variant<L...>* /*type*/)
{
  constexpr std::size_t n = (std::size_t{FrictionLaw<L>} + ...);
  std::array<LawKind, n> kinds;
  std::size_t i = 0;
  const auto add = [&]<class K>()
  {
    if constexpr (FrictionLaw<K>) kinds[i++] = {K::name, K::keys, &make<K>};
  };
  (add.template operator()<L>(), ...);
  return kinds;
}

constexpr auto kinds = kinds_of(static_cast<const ContactLaw*>(nullptr));

template <class L>
constexpr bool has_bond =
    std::derived_from<L, Joint> || std::derived_from<L, Mixed> || std::derived_from<L, Endo>;

/// of(law) for a law with a bond, `without` for the others.
template <class Value, class Of>
Value of_bond(const ContactLaw& law, const Value& without, const Of& of)
{
  return std::visit(
      [&]<Law L>(const L& l) -> Value
      {
        if constexpr (has_bond<L>)
          return of(l);
        else
          return without;
      },
      law);
}

}  // namespace

Coulomb::Coulomb(std::span<const Field> values) : coefficient(values[0].constant()) {}

std::string Frictionless::words(const Units& /*units*/) const
{
  return "no friction";
}

std::string Tresca::words(const Units& units) const
{
  return "Tresca friction, threshold " + problem::words(threshold, units.behind(UnitOf::stress));
}

std::string Slider::words(const Units& /*units*/) const
{
  return "slider: no motion along the normal, none held across it";
}

std::string Tied::words(const Units& /*units*/) const
{
  return "tied";
}

std::string Coulomb::words(const Units& /*units*/) const
{
  return fmt::format("Coulomb friction, coefficient {:.6g}", coefficient);
}

std::string JointLaw::words(const Units& units) const
{
  const std::string stress = units.behind(UnitOf::stress);
  std::string text = "joint";
  if (tension.strength > 0)
    text += fmt::format(", tensile strength {:.6g}{}, fracture energy {:.6g}{}", tension.strength, stress,
                        tension.fracture_energy, units.behind(UnitOf::fracture_energy));
  if (cohesion > 0) text += fmt::format(", cohesion {:.6g}{}", cohesion, stress);
  if (cohesion > 0 && std::isfinite(slip_length))
    text += fmt::format(", lost on a slip of {:.6g}{}", slip_length, units.behind(UnitOf::length));
  if (coefficient > 0) text += fmt::format(", friction coefficient {:.6g}", coefficient);
  if (!threshold.is_zero()) text += ", threshold " + problem::words(threshold, stress);
  return text + (stick ? ", no slip before it breaks" : "");
}

std::string MixedLaw::words(const Units& units) const
{
  return fmt::format(
      "mixed-mode bond, tensile strength {:.6g}{}, fracture energy {:.6g}{}, shear ratio {:.6g}{}",
      tension.strength, units.behind(UnitOf::stress), tension.fracture_energy,
      units.behind(UnitOf::fracture_energy), shear_ratio,
      coefficient > 0 ? fmt::format(", friction coefficient {:.6g}", coefficient) : "");
}

std::string EndoLaw::words(const Units& units) const
{
  const std::string stress = units.behind(UnitOf::stress);
  return fmt::format("elastoplastic joint with damage, tensile strength {:.6g}{}, cohesion {:.6g}{}",
                     tensile_strength(), stress, Endo::cohesion(), stress);
}

namespace
{

/// p_w n.
template <int dim>
Point<dim> water_pressure(const LawPoint<dim>& point)
{
  return point.water * point.normal;
}

/// The response with water, from that of the effective traction.
template <int dim, Law L>
Response<dim> respond_to(const L& law, const LawPoint<dim>& point, const Point<dim>& P, double delta)
{
  const Point<dim> pressure = water_pressure(point);
  const Point<dim> effective = P + pressure;
  Response<dim> response;
  if constexpr (std::same_as<L, Tied>)
    response = {effective, std::numeric_limits<double>::infinity(), ContactStatus::tied};
  else if constexpr (std::same_as<L, Slider>)
    response = {effective.dot(point.normal) * point.normal, 0, ContactStatus::slip};
  else if constexpr (has_bond<L>)
  {
    const InterfaceResponse<dim> of_bond = problem::respond<dim>(law, point, effective);
    response = {of_bond.traction, of_bond.slip_limit, of_bond.status};
  }
  else
    response = respond_unilaterally<dim>(law, point, effective, delta);
  response.traction -= pressure;
  return response;
}

template <int dim>
Tensor<dim> tangent_effectively(const ContactLaw& law, const LawPoint<dim>& point, const Point<dim>& P,
                                double delta)
{
  return std::visit(
      [&]<Law L>(const L& l) -> Tensor<dim>
      {
        if constexpr (std::same_as<L, Tied>)
          return Tensor<dim>::Identity();
        else if constexpr (std::same_as<L, Slider>)
          return point.normal * point.normal.transpose();
        else if constexpr (has_bond<L>)
          return problem::respond<dim>(l, point, P).derivative;
        else
        {
          return unilateral_tangent<dim>(l, point, P, delta);
        }
      },
      law);
}

template <int dim>
InterfaceResponse<dim> advance_effectively(const ContactLaw& law, const LawPoint<dim>& point,
                                           const Point<dim>& P)
{
  return std::visit(
      [&]<Law L>(const L& l) -> InterfaceResponse<dim>
      {
        if constexpr (has_bond<L>)
          return problem::respond<dim>(l, point, P);
        else if constexpr (std::same_as<L, Tied> || std::same_as<L, Slider>)
        {
          constexpr bool is_tied = std::same_as<L, Tied>;
          const Tensor<dim> derivative = tangent_effectively<dim>(law, point, P, 0);
          return {.traction = derivative * P,
                  .derivative = derivative,
                  .state = point.state,
                  .damage_gradient = Point<dim>::Zero(),
                  .slip_limit = is_tied ? std::numeric_limits<double>::infinity() : 0,
                  .status = is_tied ? ContactStatus::tied : ContactStatus::slip};
        }
        else
          return problem::respond<dim>(Joint{.coefficient = l.cone().coefficient}, point, P);
      },
      law);
}

}  // namespace

template <int dim>
Response<dim> respond(const ContactLaw& law, const LawPoint<dim>& point, const Point<dim>& P, double delta)
{
  return std::visit([&]<Law L>(const L& l) { return respond_to<dim>(l, point, P, delta); }, law);
}

template <int dim>
void tractions(const ContactLaw& law, std::span<const LawPoint<dim>> points, std::span<const Point<dim>> P,
               std::span<Point<dim>> T)
{
  std::visit(
      [&]<Law L>(const L& l)
      {
        for (std::size_t q = 0; q < T.size(); ++q) T[q] = respond_to<dim>(l, points[q], P[q], 0).traction;
      },
      law);
}

template <int dim>
Tensor<dim> tangent(const ContactLaw& law, const LawPoint<dim>& point, const Point<dim>& P, double delta)
{
  return tangent_effectively<dim>(law, point, P + water_pressure(point), delta);
}

template <int dim>
InterfaceResponse<dim> advance(const ContactLaw& law, const LawPoint<dim>& point, const Point<dim>& P)
{
  const Point<dim> pressure = water_pressure(point);
  InterfaceResponse<dim> response = advance_effectively<dim>(law, point, P + pressure);
  response.traction -= pressure;
  return response;
}

template <int dim>
InterfaceState<dim> fresh_state(const ContactLaw& law)
{
  return std::visit(
      []<Law L>(const L& l) -> InterfaceState<dim>
      {
        if constexpr (has_bond<L>)
          return {.damage = l.fresh_damage()};
        else
          return {.damage = std::same_as<L, Tied> ? 0.0 : 1.0};
      },
      law);
}

template <int dim>
InterfaceState<dim> admissible(const ContactLaw& law, InterfaceState<dim> state)
{
  state.damage = std::clamp(state.damage, 0.0, 1.0);
  state.slipped = std::max(state.slipped, 0.0);
  const auto* const joint = std::get_if<JointLaw>(&law);
  if (joint && joint->cohesion > 0 && std::isfinite(joint->slip_length) && state.damage < 1)
    state.slipped = std::min(state.slipped, state.damage * joint->slip_length);
  return state;
}

std::string fault(const ContactLaw& law)
{
  return of_bond<std::string>(law, {}, [](const auto& l) { return problem::fault(l); });
}

double softening_slope(const ContactLaw& law)
{
  return of_bond(law, 0.0, [](const auto& l) { return l.softening_slope(); });
}

double tangential_weight(const ContactLaw& law)
{
  return of_bond(law, 1.0, [](const auto& l) { return l.tangential_weight(); });
}

FrictionCone cone(const ContactLaw& law)
{
  return std::visit([](const auto& l) { return l.cone(); }, law);
}

std::string words(const ContactLaw& law, const Units& units)
{
  return std::visit([&](const auto& l) { return l.words(units); }, law);
}

std::string_view name(const ContactLaw& law)
{
  return std::visit([](const auto& l) { return l.name; }, law);
}

bool has_memory(const ContactLaw& law)
{
  return std::holds_alternative<JointLaw>(law) || std::holds_alternative<MixedLaw>(law) ||
         std::holds_alternative<EndoLaw>(law);
}

bool is_minimum(const ContactLaw& law)
{
  return std::visit([](const auto& l) { return l.is_minimum; }, law);
}

std::span<const LawKind> law_kinds()
{
  return kinds;
}

std::span<const LawKind> obstacle_law_kinds()
{
  static_assert(kinds[kinds.size() - 2].name == Slider::name && kinds.back().name == Tied::name);
  return std::span(kinds).first<kinds.size() - 2>();
}

template Response<2> respond(const ContactLaw&, const LawPoint<2>&, const Point<2>&, double);
template Response<3> respond(const ContactLaw&, const LawPoint<3>&, const Point<3>&, double);
template void tractions(const ContactLaw&, std::span<const LawPoint<2>>, std::span<const Point<2>>,
                        std::span<Point<2>>);
template void tractions(const ContactLaw&, std::span<const LawPoint<3>>, std::span<const Point<3>>,
                        std::span<Point<3>>);
template Tensor<2> tangent(const ContactLaw&, const LawPoint<2>&, const Point<2>&, double);
template Tensor<3> tangent(const ContactLaw&, const LawPoint<3>&, const Point<3>&, double);
template InterfaceResponse<2> advance(const ContactLaw&, const LawPoint<2>&, const Point<2>&);
template InterfaceResponse<3> advance(const ContactLaw&, const LawPoint<3>&, const Point<3>&);
template InterfaceState<2> admissible(const ContactLaw&, InterfaceState<2>);
template InterfaceState<3> admissible(const ContactLaw&, InterfaceState<3>);
template InterfaceState<2> fresh_state(const ContactLaw&);
template InterfaceState<3> fresh_state(const ContactLaw&);

}  // namespace tribound::problem
