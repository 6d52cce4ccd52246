#include "tribound/certify/energy/linear_intervals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "tribound/certify/energy/traction_fit.h"

namespace tribound::certify
{

template <int dim>
LinearIntervals<dim>::LinearIntervals(const BoundedState<dim>& state, ContactSystems<dim>& systems,
                                      const DualProblem<dim>* unloaded, bool is_held)
    : state_(state),
      systems_(systems),
      unloaded_(unloaded),
      is_held_(is_held),
      slack_(state),
      basis_(state.form.space().degree())
{
  if (!is_held) return;
  double stiffest = 0;
  for (const contact::ContactSegment<dim>& segment : state.form.segments())
    stiffest = std::max(stiffest, segment.gamma);
  constexpr double stiff = 10;  // so that springs hold like conditions, up to a negligible part
  stiffness_ = stiff * state.form.space().mesh().ranks().max(stiffest);
  systems_.set_springs(springs());
}

template <int dim>
Tensor<dim> LinearIntervals<dim>::holding(std::size_t k) const
{
  const Point<dim>& n = state_.form.segments()[k].normal;
  const Tensor<dim> along = n * n.transpose();
  Tensor<dim> result = Tensor<dim>::Zero();
  if (slack_.is_pressed(k)) result += along;
  if (slack_.is_held(k)) result += Tensor<dim>::Identity() - along;
  return stiffness_ * result;
}

namespace
{

/// The contribution of a degree of freedom to [v] on a facet: sign times its basis function, along an axis.
struct JumpTerm
{
  Index dof;
  std::size_t function;  ///< number on the facet
  int axis;
  double sign;  ///< -1 on the master
};

/// The terms of all free degrees of freedom on facet k.
template <int dim>
std::vector<JumpTerm> jump_terms(const BoundedState<dim>& state, std::size_t k)
{
  std::vector<JumpTerm> terms;
  const auto add = [&](std::span<const Index> nodes, double sign)
  {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (int a = 0; a < dim; ++a)
        if (const Index dof = dim * nodes[i] + a; state.form.constraints().fixed[dof] == 0)
          terms.push_back({dof, i, a, sign});
  };
  add(state.facets.nodes(k), 1);
  add(state.facets.master_nodes(k), -1);
  return terms;
}

}  // namespace

/// (S [phi_j], [phi_i])_C, S the stiffness of the springs; with the weight r on a meridian.
template <int dim>
algebra::Triplets LinearIntervals<dim>::springs() const
{
  const contact::NitscheForm<dim>& form = state_.form;
  const fem::Quadrature<dim - 1>& rule = form.facet_rule();
  const fem::Tabulation<dim - 1> table = basis_.tabulate(rule.points);
  const auto n = static_cast<std::size_t>(basis_.n_nodes());
  std::vector<double> products(n * n);  // of the basis on a facet
  const auto set_products = [&](const auto& weight)
  {
    std::ranges::fill(products, 0.0);
    for (int q = 0; q < rule.size(); ++q)
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
          products[i * n + j] += weight(q) * table.values_at(q)[i] * table.values_at(q)[j];
  };
  set_products([&](int q) { return rule.weights[q]; });
  algebra::Triplets entries;
  for (std::size_t k = 0; k < form.segments().size(); ++k)
  {
    const Tensor<dim> stiffness = form.segments()[k].det() * holding(k);
    if (stiffness.isZero()) continue;
    if (form.problem().is_axisymmetric())
      set_products([&](int q) { return rule.weights[q] * form.contact_points(k)[q].x[0]; });
    const std::vector<JumpTerm> terms = jump_terms(state_, k);
    for (const auto& [row, i, a, sign_i] : terms)
      for (const auto& [column, j, b, sign_j] : terms)
        entries.add(row, column, sign_i * sign_j * products[i * n + j] * stiffness(a, b));
  }
  return entries;
}

/// The tractions of the springs on slaves for this displacement of Gamma_C: coefficients in Bernstein's
/// basis.
template <int dim>
std::vector<Point<dim>> LinearIntervals<dim>::exerted(std::span<const double> displacement) const
{
  std::vector<Point<dim>> result;
  for (std::size_t k = 0; k < state_.facets.size(); ++k)
  {
    const Tensor<dim> stiffness = holding(k);
    for (const Point<dim>& c : state_.facets.coefficients(k, displacement))
      result.push_back(-(stiffness * c));
  }
  return result;
}

/// The field at the contact points, from coefficients in Bernstein's basis.
template <int dim>
std::vector<Point<dim>> LinearIntervals<dim>::at_points(std::span<const Point<dim>> coefficients) const
{
  const Eigen::MatrixXd basis = bernstein_at<dim>(basis_.degree(), state_.form.facet_rule().points);
  std::vector<Point<dim>> result;
  result.reserve(state_.facets.size() * basis.rows());
  for (std::size_t k = 0; k < state_.facets.size(); ++k)
    for (Eigen::Index q = 0; q < basis.rows(); ++q)
    {
      Point<dim> sum = Point<dim>::Zero();
      for (Eigen::Index j = 0; j < basis.cols(); ++j) sum += basis(q, j) * coefficients[k * basis.cols() + j];
      result.push_back(sum);
    }
  return result;
}

template <int dim>
auto LinearIntervals<dim>::natural(const LinearNumber<dim>& number) const -> Natural
{
  const fem::LagrangeSpace<dim>& space = state_.form.space();
  const std::vector<double> none(space.n_dofs(), 0.0);
  if (!is_held_)
    return {none, none, std::vector<Point<dim>>(state_.t_h.coefficients.size(), Point<dim>::Zero())};
  const DualProblem<dim>& dual = number.loads ? *number.loads : *unloaded_;
  std::vector<Point<dim>> t(state_.form.n_contact_points(), Point<dim>::Zero());
  if (number.weight) t = at_points(exerted(number.weight->at_nodes));
  constexpr double near = 1e-8;
  const std::vector<double> load = dual.load(t);
  const std::vector<double> z = systems_.solve(OnContact::springs, {&load, 1}, {&none, 1}, near)[0];
  std::vector<double> y = z;
  if (number.weight)
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += number.weight->at_nodes[i];
  Natural result{.y = none, .opposite = none, .r = exerted(y)};
  for (std::size_t k = 0; k < state_.facets.size(); ++k)
  {
    const std::vector<Point<dim>> coefficients = state_.facets.coefficients(k, y);
    for (std::size_t j = 0; j < coefficients.size(); ++j)
      std::ranges::copy(coefficients[j], &result.y[dim * state_.facets.nodes(k)[j]]);
  }
  set_opposite(z, result);
  return result;
}

/// Masters are at rest if the opposite slaves cannot follow: fixed slaves, and slaves that several masters
/// share.
template <int dim>
void LinearIntervals<dim>::set_opposite(std::span<const double> z, Natural& natural) const
{
  const fem::LagrangeSpace<dim>& space = state_.form.space();
  std::vector<char> at_rest = state_.junctions;
  const std::vector<char> between = state_.facets.between_meshes();
  const auto for_each_master = [&](const auto& visit)
  {
    for (std::size_t k = 0; k < state_.facets.size(); ++k)
      for (std::size_t j = 0; j < state_.facets.master_nodes(k).size(); ++j)
        for (int a = 0; a < dim; ++a)
          visit(dim * state_.facets.nodes(k)[j], dim * state_.facets.master_nodes(k)[j] + a);
  };
  for_each_master(
      [&](Index slave, Index master)
      {
        const auto is_set = [](char flag) { return flag != 0; };
        if (state_.junctions[slave] != 0 || between[slave] != 0 ||
            std::ranges::any_of(std::span(&state_.form.constraints().fixed[slave], dim), is_set))
          at_rest[master] = 1;
      });
  space.update(std::span(at_rest));
  for_each_master([&](Index, Index master)
                  { natural.opposite[master] = at_rest[master] != 0 ? 0 : z[master]; });
}

template <int dim>
std::vector<double> LinearIntervals<dim>::trace(const LinearNumber<dim>& number, const Natural& natural) const
{
  const fem::LagrangeSpace<dim>& space = state_.form.space();
  std::vector<double> result = natural.opposite;
  for (std::size_t k = 0; k < state_.facets.size(); ++k)
  {
    const std::span<const Index> masters = state_.facets.master_nodes(k);
    const std::vector<Point<dim>> jumps = state_.facets.values(state_.facets.nodes(k), natural.y);
    for (std::size_t i = 0; i < jumps.size(); ++i)
      for (int a = 0; a < dim; ++a)
      {
        const Index slave = dim * state_.facets.nodes(k)[i] + a;
        const bool has_opposite = !masters.empty() && state_.facets.matches(k);
        result[slave] = jumps[i][a] - (number.weight ? number.weight->at_nodes[slave] : 0) +
                        (has_opposite ? natural.opposite[dim * masters[i] + a] : 0);
      }
  }
  space.update(std::span(result));
  return result;
}

template <int dim>
bool LinearIntervals<dim>::fits(const LinearNumber<dim>& number, const Natural& natural,
                                std::span<const double> z) const
{
  const std::vector<char>& fixed = state_.form.constraints().fixed;
  const std::vector<char> on_parts = state_.form.rigid_parts().marks();
  std::vector<double> y(z.begin(), z.end());
  std::array<double, 2> largest{};  // of what should be 0, and of all
  for (std::size_t i = 0; i < y.size(); ++i)
  {
    if (number.weight) y[i] += number.weight->at_nodes[i];
    if (fixed[i] != 0 && on_parts[i] == 0) largest[0] = std::max(largest[0], std::abs(y[i]));
    largest[1] = std::max({largest[1], std::abs(y[i]), std::abs(z[i])});
  }
  for (std::size_t k = 0; k < state_.facets.size(); ++k)
  {
    const std::vector<Point<dim>> found = state_.facets.coefficients(k, y);
    for (std::size_t j = 0; j < found.size(); ++j)
    {
      const Eigen::Map<const Point<dim>> wanted(&natural.y[dim * state_.facets.nodes(k)[j]]);
      largest[0] = std::max(largest[0], (found[j] - wanted).norm());
    }
  }
  state_.form.space().mesh().ranks().max(std::span(largest));
  constexpr double rounding = 1e-12;
  return largest[0] <= rounding * largest[1];
}

template <int dim>
auto LinearIntervals<dim>::limited(const LinearNumber<dim>& number, const Natural& natural,
                                   std::span<const double> factors) const -> std::vector<Limited>
{
  const fem::LagrangeSpace<dim>& space = state_.form.space();
  const DualProblem<dim>& dual = number.loads ? *number.loads : *unloaded_;
  constexpr double near = 1e-8;  // any z will do
  constexpr double tight = 1e-12;
  const auto n = static_cast<std::size_t>(basis_.n_nodes());
  std::vector<Limited> result;
  std::vector<std::vector<double>> loads;
  std::vector<std::vector<double>> traces;
  for (const double m : factors)
  {
    Limited& one = result.emplace_back(Limited{.m = m, .natural = natural});
    slack_.limit_y(m, one.natural.y);
    for (std::size_t k = 0; k < state_.facets.size(); ++k)
      slack_.limit_r(k, m, std::span(one.natural.r).subspan(k * n, n));
    one.t = at_points(one.natural.r);
    loads.push_back(dual.load(one.t));
    traces.push_back(trace(number, one.natural));
  }
  std::vector<std::vector<double>> z = systems_.solve(OnContact::held, loads, traces, near);
  for (std::size_t k = 0; k < z.size(); ++k) result[k].z = std::move(z[k]);
  if (!std::ranges::any_of(loads, [&](const std::vector<double>& load) { return space.norm(load) > 0; }))
    return result;
  const std::vector<std::vector<double>> none(loads.size(), std::vector<double>(space.n_dofs(), 0.0));
  std::vector<std::vector<double>> targets = systems_.solve(OnContact::free, loads, none, tight);
  for (std::size_t k = 0; k < targets.size(); ++k)
    if (space.norm(loads[k]) > 0) result[k].target = std::move(targets[k]);
  return result;
}

template <int dim>
DualPair<dim> LinearIntervals<dim>::pair(const LinearNumber<dim>& number, Limited limited,
                                         std::string& reason) const
{
  const DualProblem<dim>& dual = number.loads ? *number.loads : *unloaded_;
  DualPair<dim> result{.z = std::move(limited.z), .target = std::move(limited.target)};
  result.form = &dual.form();
  if (!fits(number, limited.natural, result.z))
    reason = "a dual displacement does not fit at the contact boundary";
  if (result.target.empty())
    result.target.assign(result.z.size(), 0.0);
  else
    result.stress = dual.balanced(result.target, limited.t, reason);
  result.oscillation = dual.oscillation(result.target);  // also of loads whose moments vanish
  return result;
}

template <int dim>
LinearBound LinearIntervals<dim>::bound(const LinearNumber<dim>& number, Limited limited, double base,
                                        std::string& reason) const
{
  const double m = limited.m;
  const DualPair<dim> pair = this->pair(number, std::move(limited), reason);
  const DualProducts products = dual_products<dim>(state_, pair);
  if (!(state_.form.space().mesh().ranks().max(products.unbalanced) <= cell_balance_limit))
    reason = "a cell does not balance its dual stress";
  return linear_bound<dim>(state_, base, pair, products, m);
}

template <int dim>
LinearInterval LinearIntervals<dim>::operator()(const LinearNumber<dim>& number, double base) const
{
  const double mid = state_.bound.mid;
  const Natural natural = this->natural(number);
  LinearInterval result;
  const double unmoved = 0;
  const LinearBound first =
      bound(number, std::move(limited(number, natural, {&unmoved, 1})[0]), base, result.reason);
  result.lower = first.centre - first.radius;
  result.upper = first.centre + first.radius;
  result.rounding = first.rounding;
  result.cells = first.cells;
  if (!is_held_ || !result.reason.empty() || !(first.radius > 0 && mid > 0)) return result;
  double smallest = first.radius;
  const double largest = first.radius / (mid * mid);  // with this m the radius cannot be smaller
  const std::array<double, 3> factors = {largest / 4, largest / 16, largest / 64};
  const std::size_t together = systems_.shares_passes() ? factors.size() : 1;
  std::vector<Limited> next;
  for (std::size_t attempt = 0; attempt < factors.size(); ++attempt)
  {
    if (attempt % together == 0)
      next = limited(number, natural, std::span(factors).subspan(attempt, together));
    std::string reason;
    const LinearBound sharper = bound(number, std::move(next[attempt % together]), base, reason);
    if (!reason.empty() || !(sharper.radius < smallest)) break;
    smallest = sharper.radius;
    intersect(result.lower, result.upper, sharper.centre - sharper.radius, sharper.centre + sharper.radius);
    result.rounding = std::max(result.rounding, sharper.rounding);
    result.is_second_order = true;
    result.cells = sharper.cells;
  }
  return result;
}

template class LinearIntervals<2>;
template class LinearIntervals<3>;

}  // namespace tribound::certify
