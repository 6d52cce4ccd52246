#include "tribound/adapt/gathered_history.h"

#include <algorithm>
#include <utility>

namespace tribound::adapt
{

namespace
{

template <int dim>
using State = typename GatheredHistory<dim>::State;

/// Points of segments closer than this are the same up to rounding, which moves most the corners of segments
/// where edges of both sides are nearly parallel.
constexpr double same_point = 1e-6;  // of the size of the segment

/// The state at x; null where there is none. `states` are sorted by boundary and first coordinate.
template <int dim>
const State<dim>* find_state(std::span<const State<dim>> states, int tag, const Point<dim>& x, double radius)
{
  const auto place = [](const State<dim>& s) { return std::pair(s.tag, s.x[0]); };
  const auto first = std::ranges::lower_bound(states, std::pair(tag, x[0] - radius), {}, place);
  const auto last = std::ranges::upper_bound(states, std::pair(tag, x[0] + radius), {}, place);
  const State<dim>* nearest = nullptr;
  double smallest = radius;
  for (auto it = first; it != last; ++it)
    if (const double distance = (it->x - x).norm(); distance <= smallest)
    {
      smallest = distance;
      nearest = &*it;
    }
  return nearest;
}

}  // namespace

template <int dim>
GatheredHistory<dim> gather_history(const contact::NitscheForm<dim>& form)
{
  const Ranks& ranks = form.space().mesh().ranks();
  if (!ranks.any(form.history() != nullptr)) return {};
  constexpr std::size_t n = 2 * dim + 3;
  std::vector<double> own;
  own.reserve(n * form.n_owned_contact_points());
  for (std::size_t k = 0; k < form.n_owned_segments(); ++k)
    for (const auto& [x, weight, normal, gap, strength, water, state] : form.contact_points(k))
    {
      own.push_back(form.segments()[k].slave.facet.tag);
      own.insert(own.end(), x.begin(), x.end());
      own.insert(own.end(), {state.damage, state.slipped});
      own.insert(own.end(), state.slip.begin(), state.slip.end());
    }
  const std::vector<double> all = ranks.gather<double>(own);
  GatheredHistory<dim> result;
  for (std::size_t i = 0; i < all.size(); i += n)
    result.states.push_back({static_cast<int>(all[i]),
                             Point<dim>(&all[i + 1]),
                             {all[i + dim + 1], all[i + dim + 2], Point<dim>(&all[i + dim + 3])}});
  std::ranges::sort(result.states, {}, [](const State<dim>& s) { return std::pair(s.tag, s.x[0]); });
  return result;
}

template <int dim>
std::shared_ptr<const contact::ContactHistory<dim>> history_on(const contact::NitscheForm<dim>& form,
                                                               const GatheredHistory<dim>& gathered)
{
  if (gathered.states.empty()) return nullptr;
  std::vector<problem::InterfaceState<dim>> states;
  states.reserve(form.n_contact_points());
  for (std::size_t k = 0; k < form.segments().size(); ++k)
    for (const contact::ContactPoint<dim>& point : form.contact_points(k))
    {
      const contact::ContactSegment<dim>& segment = form.segments()[k];
      const State<dim>* found =
          find_state<dim>(gathered.states, segment.slave.facet.tag, point.x, same_point * segment.h);
      if (found == nullptr) return nullptr;
      states.push_back(found->state);
    }
  return std::make_shared<const contact::ContactHistory<dim>>(std::move(states), form.facet_rule(),
                                                              form.space().degree() + 2);
}

template GatheredHistory<2> gather_history(const contact::NitscheForm<2>&);
template GatheredHistory<3> gather_history(const contact::NitscheForm<3>&);
template std::shared_ptr<const contact::ContactHistory<2>> history_on(const contact::NitscheForm<2>&,
                                                                      const GatheredHistory<2>&);
template std::shared_ptr<const contact::ContactHistory<3>> history_on(const contact::NitscheForm<3>&,
                                                                      const GatheredHistory<3>&);

}  // namespace tribound::adapt
