#include "tribound/certify/energy/contact_slack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace tribound::certify
{

namespace
{

/// c with its normal and tangential parts cut to these lengths.
template <int dim>
Point<dim> limited(const Point<dim>& c, const Point<dim>& n, double normal, double tangential)
{
  const double along = c.dot(n);
  const Point<dim> across = c - along * n;
  const double length = across.norm();
  return std::clamp(along, -normal, normal) * n + (length > tangential ? tangential / length : 1.0) * across;
}

/// What `slack` allows for the factor m.
double times(double m, double slack)
{
  return std::isinf(slack) ? slack : m * slack;
}

}  // namespace

template <int dim>
ContactSlack<dim>::ContactSlack(const BoundedState<dim>& state)
    : state_(state),
      n_(state.facets.size() > 0 ? state.facets.nodes(0).size() : 0),
      slack_(state.facets.size() * n_),
      is_pressed_(state.facets.size(), 0),
      is_held_(state.facets.size(), 0)
{
  std::array<double, 2> largest{};  // |v|, |t_h|
  for (const double component : state.v) largest[0] = std::max(largest[0], std::abs(component));
  for (const Point<dim>& t : state.t_h.coefficients) largest[1] = std::max(largest[1], t.norm());
  state.form.space().mesh().ranks().max(std::span(largest));
  constexpr double rounding = 1e-13;
  length_ = rounding * largest[0];
  stress_ = rounding * largest[1];
  for (std::size_t k = 0; k < state.facets.size(); ++k)
  {
    if (!state.facets.matches(k)) continue;
    if (problem::cone(state.form.segments()[k].contact->law).is_tied)
    {
      set_tied(k);
      continue;
    }
    if (problem::cone(state.form.segments()[k].contact->law).is_bilateral)
    {
      set_slider(k);
      continue;
    }
    set_normal(k);
    set_tangential(k);
  }
}

template <int dim>
void ContactSlack<dim>::set_tied(std::size_t k)
{
  is_pressed_[k] = is_held_[k] = 1;
  std::fill_n(slack_.begin() + k * n_, n_, Slack{.normal_r = HUGE_VAL, .tangential_r = HUGE_VAL});
}

template <int dim>
void ContactSlack<dim>::set_slider(std::size_t k)
{
  is_pressed_[k] = 1;
  std::fill_n(slack_.begin() + k * n_, n_, Slack{.tangential_y = HUGE_VAL, .normal_r = HUGE_VAL});
}

template <int dim>
void ContactSlack<dim>::set_normal(std::size_t k)
{
  const Point<dim>& normal = state_.form.segments()[k].normal;
  const std::vector<Point<dim>> v = state_.facets.coefficients(k, state_.v);
  bool is_closed = true;
  bool is_open = true;
  for (std::size_t j = 0; j < n_; ++j)
  {
    is_closed = is_closed && std::abs(v[j].dot(normal) - state_.facets.gap(k)[j]) <= length_;
    is_open = is_open && std::abs(state_.t_h.coefficients[k * n_ + j].dot(normal)) <= stress_;
  }
  is_pressed_[k] = is_closed && !is_open ? 1 : 0;
  for (std::size_t j = 0; j < n_; ++j)
  {
    Slack& slack = slack_[k * n_ + j];
    if (is_pressed(k)) slack.normal_r = std::max(0.0, -state_.t_h.coefficients[k * n_ + j].dot(normal));
    if (is_open) slack.normal_y = std::max(0.0, state_.facets.gap(k)[j] - v[j].dot(normal));
  }
}

template <int dim>
void ContactSlack<dim>::set_tangential(std::size_t k)
{
  const Point<dim>& normal = state_.form.segments()[k].normal;
  const std::vector<Point<dim>> slip = state_.facets.slip(k, state_.v);
  const std::span<const double> s = std::span(state_.t_h.thresholds).subspan(k * n_, n_);
  const auto friction = [&](std::size_t j) -> Point<dim>
  {
    const Point<dim>& t = state_.t_h.coefficients[k * n_ + j];
    return t - t.dot(normal) * normal;
  };
  bool is_smooth = true;
  bool sticks = true;
  bool slips = dim == 2;
  double least_slip = HUGE_VAL;
  for (const Point<dim>& c : slip)
  {
    sticks = sticks && c.norm() <= length_;
    slips = slips && c.dot(slip[0]) > 0 && c.norm() > length_;
    least_slip = std::min(least_slip, c.norm());
  }
  for (std::size_t j = 0; j < n_; ++j)
  {
    is_smooth = is_smooth && s[j] <= stress_;
    slips = slips && (friction(j) + s[j] * slip[0].normalized()).norm() <= stress_;
  }
  is_held_[k] = sticks && !is_smooth ? 1 : 0;
  for (std::size_t j = 0; j < n_; ++j)
  {
    Slack& slack = slack_[k * n_ + j];
    if (is_smooth)
      slack.tangential_y = HUGE_VAL;
    else if (sticks)
      slack.tangential_r = std::max(0.0, s[j] - friction(j).norm());
    else if (slips)  // the slip after an earlier one is in another basis
      slack.tangential_y = state_.facets.has_slipped(k) ? least_slip : slip[j].norm();
  }
}

template <int dim>
void ContactSlack<dim>::limit_r(std::size_t k, double m, std::span<Point<dim>> r) const
{
  const Point<dim>& normal = state_.form.segments()[k].normal;
  for (std::size_t j = 0; j < n_; ++j)
    r[j] = limited<dim>(r[j], normal, times(m, at(k, j).normal_r), times(m, at(k, j).tangential_r));
}

template <int dim>
void ContactSlack<dim>::limit_y(double m, std::span<double> y) const
{
  struct Condition
  {
    Point<dim> normal;
    double along;
    double across;
  };
  constexpr double same = 1e-12;
  std::map<Index, Condition> conditions;  // by node
  for (std::size_t k = 0; k < state_.facets.size(); ++k)
    for (std::size_t j = 0; j < n_; ++j)
    {
      const Point<dim>& normal = state_.form.segments()[k].normal;
      const Slack& slack = at(k, j);
      Condition& all =
          conditions.try_emplace(state_.facets.nodes(k)[j], Condition{normal, HUGE_VAL, HUGE_VAL})
              .first->second;
      all.along = std::min(all.along, slack.normal_y);
      all.across = std::min(all.across, slack.tangential_y);
      if ((all.normal - normal).norm() > same) all.along = all.across = 0;
    }
  for (const auto& [node, condition] : conditions)
  {
    bool is_fixed = state_.junctions[dim * node] != 0;
    for (int a = 0; a < dim; ++a) is_fixed = is_fixed || state_.form.constraints().fixed[dim * node + a] != 0;
    Point<dim> c(&y[dim * node]);
    c = is_fixed ? Point<dim>::Zero()
                 : limited<dim>(c, condition.normal, times(m, condition.along), times(m, condition.across));
    std::ranges::copy(c, &y[dim * node]);
  }
  state_.form.space().update(y);
}

template class ContactSlack<2>;
template class ContactSlack<3>;

}  // namespace tribound::certify
