#include "tribound/certify/energy/balanced_traction.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tribound/base/dense_factors.h"
#include "tribound/base/parallel.h"
#include "tribound/certify/energy/traction_fit.h"

namespace tribound::certify
{

namespace
{

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

/// The conditions on lambda: rest(lambda) = L(z_i) + (t_h(lambda), [z_i])_C = 0.
template <int dim>
class BalanceConditions
{
 public:
  /// t_h(lambda) and its imbalance.
  struct State
  {
    Vector lambda;
    AdmissibleTraction<dim> t_h;
    Vector rest;
    Vector size;  ///< the sum of |force| |z_i| in the rest

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
          for (int i = motions.of_cell(c).begin; i < motions.of_cell(c).end; ++i)
            add_work(i, motions(i, points[node]), Point<dim>(&form.load()[dim * node]), load_);
  }

  [[nodiscard]] State at(Vector lambda) const;
  /// -(J + shift G)^{-1} rest: J the derivative of rest, G = (([z_i], [z_j])_C).
  [[nodiscard]] Vector step(const State& state) const;

 private:
  static constexpr double rounding = 1e-13;

  [[nodiscard]] Eigen::Index n() const { return static_cast<Eigen::Index>(motions_.size()); }
  using Columns = typename TractionFit<dim>::Columns;
  /// [z_i] at the contact points of a segment; r [z_i] on a meridian, so that its product in the plane with a
  /// traction is the work of that.
  struct Jump
  {
    int motion;
    Columns values;
  };
  /// The jumps of the motions of the bodies on its sides; twice if both sides are one body.
  [[nodiscard]] std::vector<Jump> jumps(std::size_t k) const;
  /// t + sum_i lambda_i [z_i] at the contact points.
  [[nodiscard]] std::vector<Point<dim>> shifted(const Vector& lambda) const;
  /// J and G side by side.
  [[nodiscard]] Matrix tangents(const State& state) const;

  /// Adds force . z; from n() on, |force| |z|.
  void add_work(int i, const Point<dim>& z, const Point<dim>& force, Vector& sums) const
  {
    sums[i] += force.dot(z);
    sums[n() + i] += force.norm() * z.norm();
  }

  const contact::NitscheForm<dim>& form_;
  const FreeMotions<dim>& motions_;
  std::span<const Point<dim>> t_;
  TractionFit<dim> fit_;
  Vector load_;  ///< this rank's part of L(z_i), then of size
};

template <int dim>
auto BalanceConditions<dim>::jumps(std::size_t k) const -> std::vector<Jump>
{
  const fem::Quadrature<dim - 1>& rule = form_.facet_rule();
  std::vector<Jump> result;
  const auto add_side = [&](const contact::SegmentSide<dim>& side)
  {
    const auto map = contact::simplex_map(form_.space().mesh(), side);
    const auto [begin, end] = motions_.of_cell(side.facet.cell);
    for (int i = begin; i < end; ++i)
    {
      Columns& values = result.emplace_back(Jump{i, Columns(dim, rule.size())}).values;
      for (int q = 0; q < rule.size(); ++q)
      {
        const Point<dim> x = map(rule.points[q]);
        values.col(q) = side.sign * form_.problem().weight(x) * motions_(i, x);
      }
    }
  };
  form_.segments()[k].for_each_side(add_side);
  return result;
}

template <int dim>
std::vector<Point<dim>> BalanceConditions<dim>::shifted(const Vector& lambda) const
{
  std::vector<Point<dim>> result(t_.begin(), t_.end());
  const auto on_facet = [&](std::size_t k)
  {
    for (const auto& [i, values] : jumps(k))
      for (int q = 0; q < form_.n_segment_points(); ++q)
        result[k * form_.n_segment_points() + q] += lambda[i] * values.col(q);
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
    for (const auto& [i, values] : jumps(k))
      for (int q = 0; q < form_.n_segment_points(); ++q)
        add_work(i, values.col(q),
                 form_.segments()[k].det() * form_.facet_rule().weights[q] *
                     t_h.at_points[k * form_.n_segment_points() + q],
                 sums);
  form_.space().mesh().ranks().sum(std::span(sums.data(), sums.size()));
  return {std::move(lambda), std::move(t_h), sums.head(n()), sums.tail(n())};
}

template <int dim>
Matrix BalanceConditions<dim>::tangents(const State& state) const
{
  const std::vector<Point<dim>> t = shifted(state.lambda);
  struct OfFacet
  {
    std::vector<int> motions;
    Matrix tangent;
    Matrix gram;
  };
  std::vector<OfFacet> of_facets(form_.n_owned_segments());
  const auto on_facet = [&](std::size_t k)
  {
    auto& [motions, tangent, gram] = of_facets[k];
    std::vector<Columns> z;
    for (Jump& jump : jumps(k))
    {
      motions.push_back(jump.motion);
      z.push_back(fit_.turned(k, std::move(jump.values)));
    }
    if (z.empty()) return;
    const double det = form_.segments()[k].det();
    tangent = det * fit_.rates(k, fit_.columns(k, t), z);
    gram = det * fit_.gram(z);
  };
  parallel_for(of_facets.size(), on_facet);
  Matrix sums = Matrix::Zero(n(), 2 * n());
  for (const auto& [motions, tangent, gram] : of_facets)
    for (std::size_t i = 0; i < motions.size(); ++i)
      for (std::size_t j = 0; j < motions.size(); ++j)
      {
        sums(motions[i], motions[j]) += tangent(i, j);
        sums(motions[i], n() + motions[j]) += gram(i, j);
      }
  form_.space().mesh().ranks().sum(std::span(sums.data(), sums.size()));
  return sums;
}

template <int dim>
Vector BalanceConditions<dim>::step(const State& state) const
{
  constexpr double share = 1e-2;  // of the relative rest, in the shift
  const Matrix sums = tangents(state);
  const double shift =
      std::max(1e-14, share * state.rest.template lpNorm<1>() / std::max(state.size.sum(), 1e-300));
  const CholeskyFactors factors(sums.leftCols(n()) + shift * sums.rightCols(n()));
  if (!factors.is_definite()) return Vector::Zero(n());
  return -factors.solve(state.rest);
}

/// Goes along d until the slope rest . d of the convex function has lost half of its size; the slope grows
/// along d. Absent if the function decreases without end.
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
