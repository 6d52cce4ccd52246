#include "tribound/certify/energy/second_order.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tribound/certify/energy/traction_fit.h"

namespace tribound::certify
{

template <int dim>
SecondOrder<dim>::SecondOrder(const BoundedState<dim>& state, DualSystems<dim>& systems,
                              const algebra::SolverOptions& solver)
    : state_(state), systems_(systems), slack_(state), basis_(state.form.space().degree())
{
  double stiffest = 0;
  for (const contact::ContactSegment<dim>& segment : state.form.segments())
    stiffest = std::max(stiffest, segment.gamma);
  constexpr double stiff = 10;  // so that springs hold as conditions do, but for a share that does not matter
  stiffness_ = stiff * state.form.space().mesh().ranks().max(stiffest);
  held_ = std::make_unique<ElasticSystem<dim>>(state.form.problem(), state.form.space(),
                                               state.form.constraints().fixed, solver, springs());
}

template <int dim>
Tensor<dim> SecondOrder<dim>::holding(std::size_t k) const
{
  const Point<dim>& n = state_.form.segments()[k].normal;
  const Tensor<dim> along = n * n.transpose();
  Tensor<dim> result = Tensor<dim>::Zero();
  if (slack_.is_pressed(k)) result += along;
  if (slack_.is_held(k)) result += Tensor<dim>::Identity() - along;
  return stiffness_ * result;
}

/// (S phi_j, phi_i)_C, S the stiffness of the springs.
template <int dim>
algebra::Triplets SecondOrder<dim>::springs() const
{
  const contact::NitscheForm<dim>& form = state_.form;
  const fem::Quadrature<dim - 1>& rule = form.facet_rule();
  const fem::Tabulation<dim - 1> table = basis_.tabulate(rule.points);
  const auto n = static_cast<std::size_t>(basis_.n_nodes());
  std::vector<double> products(n * n, 0.0);  // of the basis on the reference facet
  for (int q = 0; q < rule.size(); ++q)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        products[i * n + j] += rule.weights[q] * table.values_at(q)[i] * table.values_at(q)[j];
  const std::vector<char>& fixed = form.constraints().fixed;
  algebra::Triplets entries;
  for (std::size_t k = 0; k < form.segments().size(); ++k)
  {
    const Tensor<dim> stiffness = form.segments()[k].det() * holding(k);
    if (stiffness.isZero()) continue;
    const std::span<const Index> nodes = state_.facets.nodes(k);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        for (int a = 0; a < dim; ++a)
          for (int b = 0; b < dim; ++b)
            if (const Index row = dim * nodes[i] + a, column = dim * nodes[j] + b;
                fixed[row] == 0 && fixed[column] == 0)
              entries.add(row, column, products[i * n + j] * stiffness(a, b));
  }
  return entries;
}

/// What the springs exert where Gamma_C is displaced so: coefficients in Bernstein's basis.
template <int dim>
std::vector<Point<dim>> SecondOrder<dim>::exerted(std::span<const double> displacement) const
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

/// At the contact points, from coefficients in Bernstein's basis.
template <int dim>
std::vector<Point<dim>> SecondOrder<dim>::at_points(std::span<const Point<dim>> coefficients) const
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
auto SecondOrder<dim>::natural(const LinearNumber<dim>& number) const -> Natural
{
  const fem::LagrangeSpace<dim>& space = state_.form.space();
  const DualProblem<dim>& dual = number.loads ? *number.loads : systems_.unloaded();
  std::vector<Point<dim>> t = number.on_contact;
  if (number.weight) t = at_points(exerted(number.weight->at_nodes));
  constexpr double near = 1e-8;
  const std::vector<double> none(space.n_dofs(), 0.0);
  std::vector<double> y = held_->solve(dual.load(t), none, near);
  if (number.weight)
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += number.weight->at_nodes[i];
  Natural result{.y = std::vector<double>(space.n_dofs(), 0.0), .r = exerted(y)};
  for (std::size_t k = 0; k < state_.facets.size(); ++k)
  {
    const std::vector<Point<dim>> coefficients = state_.facets.coefficients(k, y);
    for (std::size_t j = 0; j < coefficients.size(); ++j)
      std::ranges::copy(coefficients[j], &result.y[dim * state_.facets.nodes(k)[j]]);
  }
  return result;
}

template <int dim>
DualPair<dim> SecondOrder<dim>::pair(const LinearNumber<dim>& number, Natural natural, double m,
                                     std::string& reason) const
{
  const fem::LagrangeSpace<dim>& space = state_.form.space();
  const DualProblem<dim>& dual = number.loads ? *number.loads : systems_.unloaded();
  constexpr double near = 1e-8;
  constexpr double tight = 1e-12;
  slack_.limit_y(m, natural.y);
  std::vector<double> trace(space.n_dofs(), 0.0);
  const auto n = static_cast<std::size_t>(basis_.n_nodes());
  for (std::size_t k = 0; k < state_.facets.size(); ++k)
  {
    slack_.limit_r(k, m, std::span(natural.r).subspan(k * n, n));
    const std::vector<Point<dim>> values = state_.facets.values(k, natural.y);
    for (std::size_t i = 0; i < n; ++i) std::ranges::copy(values[i], &trace[dim * state_.facets.nodes(k)[i]]);
  }
  space.update(std::span(trace));
  if (number.weight)
    for (std::size_t i = 0; i < trace.size(); ++i) trace[i] -= number.weight->at_nodes[i];
  std::vector<Point<dim>> t = at_points(natural.r);
  for (std::size_t i = 0; i < number.on_contact.size(); ++i) t[i] += number.on_contact[i];

  const std::vector<double> none(space.n_dofs(), 0.0);
  const std::vector<double> load = dual.load(t);
  DualPair<dim> result{.z = systems_.with_held_contact().solve(load, trace, near)};
  result.target = systems_.with_free_contact().solve(load, none, tight);
  result.stress = dual.balanced(result.target, t, reason);
  return result;
}

template <int dim>
std::optional<LinearBound> SecondOrder<dim>::operator()(const LinearNumber<dim>& number, double base,
                                                        const LinearBound& first) const
{
  const double mid = state_.bound.mid;
  if (!(first.radius > 0 && mid > 0)) return {};
  const Natural natural = this->natural(number);
  std::optional<LinearBound> best;
  double m = first.radius / (mid * mid);  // with this m the radius cannot be smaller
  constexpr int most_attempts = 3;
  for (int attempt = 0; attempt < most_attempts; ++attempt)
  {
    m /= 4;
    std::string reason;
    const DualPair<dim> pair = this->pair(number, natural, m, reason);
    const DualPair<dim>* const only = &pair;
    const DualProducts products = std::move(dual_products<dim>(state_, {&only, 1}).front());
    const double unbalanced = state_.form.space().mesh().ranks().max(products.unbalanced);
    if (!reason.empty() || !(unbalanced <= cell_balance_limit)) break;
    LinearBound bound = linear_bound<dim>(state_, base, pair, products, m);
    if (!(bound.radius < (best ? best->radius : first.radius))) break;
    best = std::move(bound);
  }
  return best;
}

template class SecondOrder<2>;
template class SecondOrder<3>;

}  // namespace tribound::certify
