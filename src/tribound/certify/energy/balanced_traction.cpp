#include "tribound/certify/energy/balanced_traction.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tribound/base/parallel.h"
#include "tribound/certify/energy/traction_fit.h"

namespace tribound::certify
{

namespace
{

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

/// The conditions on lambda: rest(lambda) = L(z_i) + (t_h(lambda), z_i)_C = 0.
template <int dim>
class BalanceConditions
{
 public:
  /// t_h(lambda) and what is left.
  struct State
  {
    Vector lambda;
    AdmissibleTraction<dim> t_h;
    Vector rest;
    Vector size;  ///< the sum of |force| |z_i| in it

    [[nodiscard]] bool is_balanced() const { return (rest.array().abs() <= rounding * size.array()).all(); }
  };

  BalanceConditions(const contact::NitscheForm<dim>& form, const FreeMotions<dim>& motions,
                    std::span<const Point<dim>> t)
      : form_(form), motions_(motions), t_(t), fit_(form), load_(2 * n())
  {
    const fem::LagrangeSpace<dim>& space = form.space();
    const std::vector<Point<dim>> points = space.node_points();
    std::vector<char> is_owned(space.n_nodes(), 0);
    for (Index k = 0; k < space.n_owned_nodes(); ++k) is_owned[space.owned_node(k)] = 1;
    load_.setZero();
    for (Index c = 0; c < space.mesh().n_cells(); ++c)
      for (const Index node : space.cell_nodes(c))
        if (std::exchange(is_owned[node], 0) != 0)
          add_work(motions.of_cell(c), points[node], Point<dim>(&form.load()[dim * node]), load_);
  }

  [[nodiscard]] State at(Vector lambda) const;
  /// -(J + shift G)^{-1} rest body by body: J the derivative of rest, G = ((z_i, z_j)_C).
  [[nodiscard]] Vector step(const State& state) const;

 private:
  static constexpr double rounding = 1e-13;

  [[nodiscard]] Eigen::Index n() const { return static_cast<Eigen::Index>(motions_.size()); }
  [[nodiscard]] auto motions_at(std::size_t k) const
  {
    return motions_.of_cell(form_.segments()[k].slave.facet.cell);
  }
  /// t + sum_i lambda_i z_i at the contact points.
  [[nodiscard]] std::vector<Point<dim>> shifted(const Vector& lambda) const;
  /// J and G of the bodies, one after the other, block after block.
  [[nodiscard]] Vector tangents(const State& state) const;

  /// force . z_i, and from n() on |force| |z_i|.
  void add_work(typename FreeMotions<dim>::Range range, const Point<dim>& x, const Point<dim>& force,
                Vector& sums) const
  {
    for (int i = range.begin; i < range.end; ++i)
    {
      const Point<dim> z = motions_(i, x);
      sums[i] += force.dot(z);
      sums[n() + i] += force.norm() * z.norm();
    }
  }

  const contact::NitscheForm<dim>& form_;
  const FreeMotions<dim>& motions_;
  std::span<const Point<dim>> t_;
  TractionFit<dim> fit_;
  Vector load_;  ///< what this rank has of L(z_i), then of size
};

template <int dim>
std::vector<Point<dim>> BalanceConditions<dim>::shifted(const Vector& lambda) const
{
  std::vector<Point<dim>> result(t_.begin(), t_.end());
  const auto on_facet = [&](std::size_t k)
  {
    const auto [begin, end] = motions_at(k);
    for (int q = 0; q < form_.n_segment_points(); ++q)
      for (int i = begin; i < end; ++i)
        result[k * form_.n_segment_points() + q] += lambda[i] * motions_(i, form_.contact_points(k)[q].x);
  };
  parallel_for(form_.segments().size(), on_facet);
  return result;
}

template <int dim>
auto BalanceConditions<dim>::at(Vector lambda) const -> State
{
  AdmissibleTraction<dim> t_h = admissible_traction<dim>(form_, shifted(lambda));
  Vector sums = load_;
  for (std::size_t k = 0; k < form_.n_owned_segments(); ++k)
    for (int q = 0; q < form_.n_segment_points(); ++q)
    {
      const contact::ContactPoint<dim>& point = form_.contact_points(k)[q];
      add_work(motions_at(k), point.x, point.weight * t_h.at_points[k * form_.n_segment_points() + q], sums);
    }
  form_.space().mesh().ranks().sum(std::span(sums.data(), sums.size()));
  return {std::move(lambda), std::move(t_h), sums.head(n()), sums.tail(n())};
}

template <int dim>
Vector BalanceConditions<dim>::tangents(const State& state) const
{
  constexpr int most = contact::RigidModes<dim>::n_modes;
  const std::vector<Point<dim>> t = shifted(state.lambda);
  std::vector<Matrix> of_facets(form_.n_owned_segments());
  const auto on_facet = [&](std::size_t k)
  {
    const auto [begin, end] = motions_at(k);
    std::vector<typename TractionFit<dim>::Columns> z;
    for (int i = begin; i < end; ++i)
    {
      z.emplace_back(dim, form_.n_segment_points());
      for (int q = 0; q < form_.n_segment_points(); ++q)
        z.back().col(q) = motions_(i, form_.contact_points(k)[q].x);
    }
    if (z.empty()) return;
    const double det = form_.segments()[k].det();
    of_facets[k].resize(end - begin, 2 * (end - begin));
    of_facets[k] << det * fit_.tangent(fit_.columns(k, t), fit_.cones(k), z), det * fit_.gram(z);
  };
  parallel_for(of_facets.size(), on_facet);
  Vector sums = Vector::Zero(static_cast<Eigen::Index>(motions_.n_bodies()) * 2 * most * most);
  for (std::size_t k = 0; k < of_facets.size(); ++k)
  {
    const int body = motions_.body_of(form_.segments()[k].slave.facet.cell);
    Eigen::Map<Matrix>(&sums[body * 2 * most * most], of_facets[k].rows(), of_facets[k].cols()) +=
        of_facets[k];
  }
  form_.space().mesh().ranks().sum(std::span(sums.data(), sums.size()));
  return sums;
}

template <int dim>
Vector BalanceConditions<dim>::step(const State& state) const
{
  constexpr int most = contact::RigidModes<dim>::n_modes;
  constexpr double share = 1e-2;  // of the rest in the shift
  const Vector sums = tangents(state);
  Vector d = Vector::Zero(n());
  for (int body = 0; body < motions_.n_bodies(); ++body)
  {
    const auto range = motions_.of_body(body);
    const int m = range.size();
    const auto rest = state.rest.segment(range.begin, m);
    const double size = state.size.segment(range.begin, m).sum();
    if (m == 0 || size == 0) continue;
    const Eigen::Map<const Matrix> tangent(&sums[body * 2 * most * most], m, m);
    const Eigen::Map<const Matrix> gram(&sums[body * 2 * most * most + m * m], m, m);
    const double shift = std::max(1e-14, share * rest.template lpNorm<1>() / size);
    const Eigen::LLT<Matrix> factors(tangent + shift * gram);
    if (factors.info() == Eigen::Success) d.segment(range.begin, m) = -factors.solve(rest);
  }
  return d;
}

/// Goes along d to where the slope of the convex function, rest . d, which grows, has lost half of its size;
/// absent where it goes on falling.
template <int dim>
auto search(const BalanceConditions<dim>& conditions, const typename BalanceConditions<dim>::State& from,
            const Vector& d) -> std::optional<typename BalanceConditions<dim>::State>
{
  constexpr int most_trials = 40;
  const double slope = from.rest.dot(d);  // negative
  double low = 0;
  double high = HUGE_VAL;
  double alpha = 1;
  for (int trial = 0; trial < most_trials; ++trial)
  {
    auto state = conditions.at(from.lambda + alpha * d);
    const double there = state.rest.dot(d);
    if (std::abs(there) <= std::abs(slope) / 2 || state.is_balanced()) return state;
    (there < 0 ? low : high) = alpha;
    alpha = high == HUGE_VAL ? 2 * alpha : (low + high) / 2;
  }
  if (high == HUGE_VAL) return {};
  return conditions.at(from.lambda + low * d);
}

}  // namespace

template <int dim>
std::optional<AdmissibleTraction<dim>> balanced_traction(const contact::NitscheForm<dim>& form,
                                                         const FreeMotions<dim>& motions,
                                                         std::span<const Point<dim>> t)
{
  if (motions.size() == 0) return admissible_traction<dim>(form, t);
  constexpr int most_steps = 50;
  const BalanceConditions<dim> conditions(form, motions, t);
  std::optional state = conditions.at(Vector::Zero(static_cast<Eigen::Index>(motions.size())));
  for (int k = 0; k < most_steps && state && !state->is_balanced(); ++k)
    state = search(conditions, *state, conditions.step(*state));
  if (!state || !state->is_balanced()) return {};
  return std::move(state->t_h);
}

template std::optional<AdmissibleTraction<2>> balanced_traction(const contact::NitscheForm<2>&,
                                                                const FreeMotions<2>&,
                                                                std::span<const Point<2>>);
template std::optional<AdmissibleTraction<3>> balanced_traction(const contact::NitscheForm<3>&,
                                                                const FreeMotions<3>&,
                                                                std::span<const Point<3>>);

}  // namespace tribound::certify
