#include "tribound/certify/energy/linear_bound.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tribound/certify/energy/meridian_distances.h"
#include "tribound/fem/degree.h"

namespace tribound::certify
{

template <int dim>
BoundedState<dim>::BoundedState(const contact::NitscheForm<dim>& of, const ObstacleFacets<dim>& on,
                                std::span<const double> displacement, std::span<const double> of_stress,
                                const Stress<dim>& equilibrated, const AdmissibleTraction<dim>& traction,
                                const EnergyBound& energy)
    : form(of),
      facets(on),
      v(displacement),
      balanced(of_stress),
      stress(equilibrated),
      t_h(traction),
      bound(energy),
      forces(of.load().begin(), of.load().end()),
      junctions(on.junctions()),
      has_polynomial_loads(of.problem().load_degree() <= of.space().degree() + 2 &&
                           of.springs().has_polynomial_rest()),
      unresolved(0)
{
  if (!has_polynomial_loads || form.problem().has_initial_stress()) unresolved = bound.oscillation;
  std::vector<double> of_initial(forces.size(), 0.0);
  contact::add_initial_stress<dim>(form.data(), form.space(), of_initial, form.meridian());
  for (std::size_t i = 0; i < forces.size(); ++i) forces[i] -= of_initial[i];
  form.add_contact_load(t_h.at_points, forces);
}

template <int dim>
std::vector<double> BoundedState<dim>::shares(double half_width) const
{
  std::vector<double> result = bound.cells;
  double sum = 0;
  for (const double cell : result) sum += cell;
  sum = form.space().mesh().ranks().sum(sum);
  for (double& cell : result) cell = sum > 0 ? cell * (half_width / sum) : 0;
  return result;
}

template <int dim>
DualProducts products_of_stresses(const BoundedState<dim>& state, const DualPair<dim>& pair)
{
  if constexpr (dim == 2)
    if (state.form.problem().is_axisymmetric())
      return meridian_products(state.form, state.stress, state.v, pair);
  DualProducts result;
  constexpr int lowest = 2;
  fem::with_degree<lowest>(state.form.space().degree(), [&](auto q)
                           { result = dual_products<dim, q>(state.form, state.stress, state.v, pair); });
  return result;
}

template <int dim>
DualProducts dual_products(const BoundedState<dim>& state, const DualPair<dim>& pair)
{
  DualProducts result = products_of_stresses(state, pair);
  if (state.form.springs().facets().empty()) return result;
  const std::size_t n = pair.z.size();
  std::vector<double> mean(n, 0.0);   // of z and the target
  std::vector<double> apart(n, 0.0);  // target less z
  std::vector<double> error(n, 0.0);  // u~ less v
  for (std::size_t i = 0; i < n; ++i)
  {
    const double target = pair.stress ? pair.target[i] : 0;
    mean[i] = (target + pair.z[i]) / 2;
    apart[i] = target - pair.z[i];
    error[i] = state.balanced[i] - state.v[i];
  }
  state.form.springs().add_products(mean, error, result.centre);
  state.form.springs().add_products(apart, apart, result.square);
  state.form.springs().add_products(state.balanced, pair.z, result.work);
  state.form.springs().add_products(pair.z, pair.z, result.energy);
  return result;
}

DualSums::DualSums(const DualProducts& products, const Ranks& ranks)
{
  std::array<double, 6> sums{};
  for (std::size_t k = 0; k < products.centre.size(); ++k)
  {
    sums[0] += products.centre[k];
    sums[1] += products.square[k];
    sums[2] += products.work[k];
    sums[3] += products.energy[k];
    sums[4] += std::abs(products.centre[k]) + std::abs(products.work[k]);
  }
  for (const double x : products.doubt) sums[5] += x;
  ranks.sum(std::span(sums));
  centre = sums[0];
  square = sums[1];
  work = sums[2];
  energy = sums[3];
  absolute = sums[4];
  doubt = sums[5];
}

template <int dim>
LinearBound linear_bound(const BoundedState<dim>& state, double base, const DualPair<dim>& pair,
                         const DualProducts& products, double m)
{
  const DualSums sums(products, state.form.space().mesh().ranks());
  const double mid = state.bound.mid;
  const double eta = std::sqrt(sums.square);
  const bool is_second_order = eta < 2 * m * mid;
  constexpr double unit = 1e-13;
  LinearBound result{.centre = base + sums.centre + state.remainder(pair.z, sums.work),
                     .radius = (is_second_order ? m * mid * mid + sums.square / (4 * m) : eta * mid) +
                               state.unresolved * std::sqrt(sums.energy) +
                               pair.oscillation * state.bound.b_v + sums.doubt,
                     .rounding = unit * (std::abs(base) + sums.absolute)};
  if (!is_second_order)
    result.cells = state.shares(result.radius);
  else
    for (std::size_t k = 0; k < products.square.size(); ++k)
      result.cells.push_back(m * state.bound.cells[k] / 4 + products.square[k] / (4 * m));
  return result;
}

template struct BoundedState<2>;
template struct BoundedState<3>;
template DualProducts products_of_stresses(const BoundedState<2>&, const DualPair<2>&);
template DualProducts products_of_stresses(const BoundedState<3>&, const DualPair<3>&);
template DualProducts dual_products(const BoundedState<2>&, const DualPair<2>&);
template DualProducts dual_products(const BoundedState<3>&, const DualPair<3>&);
template LinearBound linear_bound(const BoundedState<2>&, double, const DualPair<2>&, const DualProducts&,
                                  double);
template LinearBound linear_bound(const BoundedState<3>&, double, const DualPair<3>&, const DualProducts&,
                                  double);

}  // namespace tribound::certify
