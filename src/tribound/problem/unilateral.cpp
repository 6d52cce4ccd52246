#include "tribound/problem/unilateral.h"

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

/// P with the slip remembered by friction without bond.
template <int dim>
Point<dim> remembered(const LawPoint<dim>& point, const Point<dim>& P)
{
  return P + point.gamma * point.state.slip;
}

}  // namespace

template <int dim, FrictionLaw L>
Response<dim> respond_unilaterally(const L& law, const LawPoint<dim>& point, const Point<dim>& P,
                                   double delta)
{
  const Point<dim> p = remembered(point, P);
  const double p_n = p.dot(point.normal);
  const Point<dim> p_t = p - p_n * point.normal;
  const double S = limit(law, point.strength, p_n, delta).value;
  ContactStatus status = p_t.norm() <= S ? ContactStatus::stick : ContactStatus::slip;
  if (p_n > 0) status = ContactStatus::open;
  return {negative_part(p_n, delta) * point.normal + ball_projection<dim>(p_t, S, delta), S, status};
}

template <int dim, FrictionLaw L>
Tensor<dim> unilateral_tangent(const L& law, const LawPoint<dim>& point, const Point<dim>& P, double delta)
{
  const Point<dim>& n = point.normal;
  const Point<dim> p = remembered(point, P);
  const double p_n = p.dot(n);
  const Point<dim> p_t = p - p_n * n;
  const Limit S = limit(law, point.strength, p_n, delta);
  const Tensor<dim> tangential = Tensor<dim>::Identity() - n * n.transpose();
  Tensor<dim> derivative = negative_part_derivative(p_n, delta) * n * n.transpose() +
                           ball_projection_derivative<dim>(p_t, S.value, delta) * tangential;
  if (S.by_normal != 0)
    derivative += S.by_normal * ball_projection_radius_derivative<dim>(p_t, S.value, delta) * n.transpose();
  return derivative;
}

template Response<2> respond_unilaterally(const Frictionless&, const LawPoint<2>&, const Point<2>&, double);
template Response<3> respond_unilaterally(const Frictionless&, const LawPoint<3>&, const Point<3>&, double);
template Response<2> respond_unilaterally(const Tresca&, const LawPoint<2>&, const Point<2>&, double);
template Response<3> respond_unilaterally(const Tresca&, const LawPoint<3>&, const Point<3>&, double);
template Response<2> respond_unilaterally(const Coulomb&, const LawPoint<2>&, const Point<2>&, double);
template Response<3> respond_unilaterally(const Coulomb&, const LawPoint<3>&, const Point<3>&, double);
template Tensor<2> unilateral_tangent(const Frictionless&, const LawPoint<2>&, const Point<2>&, double);
template Tensor<3> unilateral_tangent(const Frictionless&, const LawPoint<3>&, const Point<3>&, double);
template Tensor<2> unilateral_tangent(const Tresca&, const LawPoint<2>&, const Point<2>&, double);
template Tensor<3> unilateral_tangent(const Tresca&, const LawPoint<3>&, const Point<3>&, double);
template Tensor<2> unilateral_tangent(const Coulomb&, const LawPoint<2>&, const Point<2>&, double);
template Tensor<3> unilateral_tangent(const Coulomb&, const LawPoint<3>&, const Point<3>&, double);

}  // namespace tribound::problem
