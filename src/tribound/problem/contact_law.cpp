#include "tribound/problem/contact_law.h"

#include <fmt/format.h>

#include <concepts>
#include <limits>

#include "tribound/problem/projection.h"

namespace tribound::problem
{

namespace
{

/// A friction limit S_h and its derivative by P^n.
struct Limit
{
  double value;
  double by_normal = 0;
};

Limit limit(const Frictionless& /*law*/, double /*strength*/, double /*p_n*/, double /*delta*/)
{
  return {0};
}

Limit limit(const Tresca& /*law*/, double strength, double /*p_n*/, double /*delta*/)
{
  return {strength};
}

/// S_h = -mu_F [P^n]_{-,delta}.
Limit limit(const Coulomb& law, double /*strength*/, double p_n, double delta)
{
  return {-law.coefficient * negative_part(p_n, delta),
          -law.coefficient * negative_part_derivative(p_n, delta)};
}

/// T = [P^n]_- n + [P^t]_S.
template <int dim>
Response<dim> unilateral(const LawPoint<dim>& point, const Point<dim>& P, double S, double delta)
{
  const double p_n = P.dot(point.normal);
  const Point<dim> p_t = P - p_n * point.normal;
  ContactStatus status = p_t.norm() <= S ? ContactStatus::stick : ContactStatus::slip;
  if (p_n > 0) status = ContactStatus::open;
  return {negative_part(p_n, delta) * point.normal + ball_projection<dim>(p_t, S, delta), S, status};
}

/// DT = D[P^n]_- n n^T + D_x[P^t]_S (I - n n^T) + D_a[P^t]_S DS n^T.
template <int dim>
Tensor<dim> unilateral_tangent(const LawPoint<dim>& point, const Point<dim>& P, const Limit& S, double delta)
{
  const Point<dim>& n = point.normal;
  const double p_n = P.dot(n);
  const Point<dim> p_t = P - p_n * n;
  const Tensor<dim> tangential = Tensor<dim>::Identity() - n * n.transpose();
  Tensor<dim> derivative = negative_part_derivative(p_n, delta) * n * n.transpose() +
                           ball_projection_derivative<dim>(p_t, S.value, delta) * tangential;
  if (S.by_normal != 0)
    derivative += S.by_normal * ball_projection_radius_derivative<dim>(p_t, S.value, delta) * n.transpose();
  return derivative;
}

/// A field in words: its value where it is constant.
std::string text(const Field& field)
{
  return field.is_constant() ? fmt::format("{:.6g}", field.constant()) : "varies";
}

template <Law L>
ContactLaw make(std::span<const Field> values)
{
  return L(values);
}

template <Law... L>
constexpr std::array<LawKind, sizeof...(L)> kinds_of(const std::variant<L...>* /*type*/)
{
  return {LawKind{L::name, L::keys, &make<L>}...};
}

constexpr auto kinds = kinds_of(static_cast<const ContactLaw*>(nullptr));

}  // namespace

Coulomb::Coulomb(std::span<const Field> values) : coefficient(values[0].constant()) {}

std::string Frictionless::words() const
{
  return "no friction";
}

std::string Tresca::words() const
{
  return fmt::format("Tresca friction, threshold {}", text(threshold));
}

std::string Tied::words() const
{
  return "tied";
}

std::string Coulomb::words() const
{
  return fmt::format("Coulomb friction, coefficient {:.6g}", coefficient);
}

template <int dim>
Response<dim> respond(const ContactLaw& law, const LawPoint<dim>& point, const Point<dim>& P, double delta)
{
  return std::visit(
      [&]<Law L>(const L& l) -> Response<dim>
      {
        if constexpr (std::same_as<L, Tied>)
          return {P, std::numeric_limits<double>::infinity(), ContactStatus::tied};
        else
          return unilateral<dim>(point, P, limit(l, point.strength, P.dot(point.normal), delta).value, delta);
      },
      law);
}

template <int dim>
Tensor<dim> tangent(const ContactLaw& law, const LawPoint<dim>& point, const Point<dim>& P, double delta)
{
  return std::visit(
      [&]<Law L>(const L& l) -> Tensor<dim>
      {
        if constexpr (std::same_as<L, Tied>)
          return Tensor<dim>::Identity();
        else
          return unilateral_tangent<dim>(point, P, limit(l, point.strength, P.dot(point.normal), delta),
                                         delta);
      },
      law);
}

FrictionCone cone(const ContactLaw& law)
{
  return std::visit([](const auto& l) { return l.cone(); }, law);
}

std::string words(const ContactLaw& law)
{
  return std::visit([](const auto& l) { return l.words(); }, law);
}

std::string_view name(const ContactLaw& law)
{
  return kinds[law.index()].name;
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
  static_assert(kinds.back().name == Tied::name);
  return std::span(kinds).first<kinds.size() - 1>();
}

template Response<2> respond(const ContactLaw&, const LawPoint<2>&, const Point<2>&, double);
template Response<3> respond(const ContactLaw&, const LawPoint<3>&, const Point<3>&, double);
template Tensor<2> tangent(const ContactLaw&, const LawPoint<2>&, const Point<2>&, double);
template Tensor<3> tangent(const ContactLaw&, const LawPoint<3>&, const Point<3>&, double);

}  // namespace tribound::problem
