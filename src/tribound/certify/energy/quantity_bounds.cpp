#include "tribound/certify/energy/quantity_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "tribound/certify/energy/energy_interval.h"

namespace tribound::certify
{

using problem::QuantityKind;

/// A quantity and the numbers that it is made of.
template <int dim>
struct QuantityBounds<dim>::Item
{
  QuantityParts<dim> parts;
  std::vector<LinearNumber<dim>> numbers{};
  std::string reason{};  ///< why it has no interval

  [[nodiscard]] QuantityKind kind() const { return parts.quantity.kind; }
  [[nodiscard]] bool is_known() const
  {
    return !numbers.empty() && std::ranges::all_of(numbers, [](const LinearNumber<dim>& number)
                                                   { return number.known.has_value(); });
  }
};

template <int dim>
QuantityBounds<dim>::QuantityBounds(const contact::NitscheForm<dim>& form,
                                    std::span<const problem::Quantity<dim>> quantities)
    : form_(form)
{
  for (const problem::Quantity<dim>& quantity : quantities)
  {
    Item& item = items_.emplace_back();
    item.parts = parts_of(form, quantity);
    item.reason = item.parts.reason;
    if (!item.reason.empty()) continue;
    for (const ContactResultant<dim>& resultant : item.parts.resultants)
    {
      LinearNumber<dim>& number = item.numbers.emplace_back();
      number.known = certify::from_equilibrium(form, resultant);
      for (std::size_t i = 0; i < form.n_contact_points(); ++i)
      {
        const bool counts = resultant.has(form.segments()[i / form.n_segment_points()].slave.facet);
        number.phi.push_back(counts ? resultant.motion(form.contact_points()[i].x) : Point<dim>::Zero());
      }
    }
  }
}

template <int dim>
QuantityBounds<dim>::~QuantityBounds() = default;

namespace
{

template <int dim>
bool slides_freely(const contact::NitscheForm<dim>& form)
{
  return !form.space().mesh().ranks().any(
      std::ranges::any_of(form.segments(), [](const contact::ContactSegment<dim>& segment)
                          { return problem::cone(segment.contact->law).resists_sliding(); }));
}

}  // namespace

template <int dim>
void QuantityBounds<dim>::prepare(const contact::NitscheForm<dim>& bounded,
                                  const algebra::SolverOptions& solver, bool is_held, bool has_pairs)
{
  solver_ = solver;
  is_held_ = is_held;
  systems_ = std::make_unique<DualSystems<dim>>(bounded, solver);
  is_homogeneous_ = is_homogeneous(bounded);
  work_is_energy_ = is_homogeneous_ && slides_freely(bounded);
  for (Item& item : items_)
  {
    if (is_energy(item) || !item.reason.empty()) continue;
    if (has_pairs && !item.is_known())
    {
      item.reason = "there is contact between bodies";  // whose dual problems would be coupled
      continue;
    }
    if (item.parts.resultants.empty() && !is_held)
    {
      item.reason = "contact alone holds a body";  // without it the load of the dual problem moves it
      continue;
    }
    if (item.parts.resultants.empty()) item.numbers.push_back(loaded_number(item.parts, bounded));
    for (std::size_t i = 0; i < item.parts.resultants.size(); ++i)
      if (!item.numbers[i].known)
        set_weight(item.numbers[i], form_, bounded, item.parts.resultants[i], item.parts.quantity.ramp);
    for (LinearNumber<dim>& number : item.numbers)
      if (!number.known && item.reason.empty()) item.reason = number.make_pair(bounded, *systems_);
  }
}

template <int dim>
bool QuantityBounds<dim>::is_energy(const Item& item) const
{
  return item.kind() == QuantityKind::energy || (item.kind() == QuantityKind::load_work && work_is_energy_);
}

template <int dim>
double QuantityBounds<dim>::value(const Item& item, std::span<const double> u,
                                  std::span<const Point<dim>> t) const
{
  const auto of_contact = [&](std::size_t i) { return contact_work<dim>(form_, t, item.numbers[i].phi); };
  switch (item.kind())
  {
    case QuantityKind::energy:
      return contact::stress_norms<dim>(form_.problem(), form_.space(), u).energy;
    case QuantityKind::load_work:
      return form_.space().dot(form_.load(), u);
    case QuantityKind::mean_displacement:
      return mean_displacement<dim>(form_, item.parts, u);
    case QuantityKind::contact_force:
    case QuantityKind::contact_moment:
      return of_contact(0);
    case QuantityKind::safety_factor:
      break;
  }
  double square = 0;
  for (std::size_t i = 1; i < item.numbers.size(); ++i) square += std::pow(of_contact(i), 2);
  return square > 0 ? item.parts.coefficient * of_contact(0) / std::sqrt(square) : 0;
}

namespace
{

QuantityInterval known_interval(const KnownNumber& number)
{
  QuantityInterval result{.exact = true, .basis = "equilibrium"};
  set_ends(result, number.value, number.value, number.uncertainty);
  return result;
}

/// Sets the interval of a quantity, from those of its numbers.
void combine(QuantityInterval& interval, double coefficient, const std::vector<QuantityInterval>& numbers)
{
  if (numbers.size() == 1)
  {
    interval.lower = numbers[0].lower;
    interval.upper = numbers[0].upper;
    interval.reason = numbers[0].reason;
    interval.cells = numbers[0].cells;
  }
  else
    set_safety_factor(interval, coefficient, numbers[0], {numbers.begin() + 1, numbers.end()});
  interval.exact = std::ranges::all_of(numbers, &QuantityInterval::exact);
  for (const QuantityInterval& number : numbers)
    if (!number.exact || interval.exact) interval.basis = number.basis;
}

}  // namespace

template <int dim>
std::vector<QuantityInterval> QuantityBounds<dim>::from_equilibrium(std::span<const double> u,
                                                                    const std::string& reason) const
{
  const std::vector<Point<dim>> t = form_.traction(u);
  std::vector<QuantityInterval> result;
  for (const Item& item : items_)
  {
    QuantityInterval& interval = result.emplace_back();
    interval.name = item.parts.quantity.name;
    if (item.parts.reason.empty()) interval.value = value(item, u, t);
    interval.reason = item.reason.empty() ? reason : item.reason;
    if (!item.is_known()) continue;
    std::vector<QuantityInterval> numbers;
    for (const LinearNumber<dim>& number : item.numbers) numbers.push_back(known_interval(*number.known));
    interval.reason = {};
    combine(interval, item.parts.coefficient, numbers);
  }
  return result;
}

template <int dim>
QuantityInterval QuantityBounds<dim>::bounded(const Item& item, const LinearNumber<dim>& number,
                                              const BoundedState<dim>& state, const DualProducts& products,
                                              const SecondOrder<dim>* second_order) const
{
  if (number.known) return known_interval(*number.known);
  if (!(state.form.space().mesh().ranks().max(products.unbalanced) <= cell_balance_limit))
    return {.reason = "a cell does not balance its dual stress"};
  const bool is_work = item.kind() == QuantityKind::load_work;
  if (is_work && (state.is_projected || state.unresolved > 0))
    return {.reason = "the loads are no polynomials of low degree"};
  const double base = number.base(state, item.parts);
  const LinearBound first = linear_bound<dim>(state, base, number.pair, products);
  const std::optional<LinearBound> second =
      second_order ? (*second_order)(number, base, first) : std::nullopt;
  const LinearBound& better = second ? *second : first;
  double lower = first.centre - first.radius;
  double upper = first.centre + first.radius;
  if (second) intersect(lower, upper, second->centre - second->radius, second->centre + second->radius);
  const double of_loads = is_work ? state.bound.oscillation * state.bound.b_v : 0;
  QuantityInterval result{.basis = second ? "second order" : "energy bound", .cells = better.cells};
  set_ends(result, lower - of_loads, upper + of_loads, std::max(first.rounding, better.rounding));
  return result;
}

template <int dim>
void QuantityBounds<dim>::add_bounded(const BoundedState<dim>& state,
                                      std::vector<QuantityInterval>& intervals) const
{
  const auto is_open = [](const Item& item) { return item.reason.empty() && !item.is_known(); };
  if (std::ranges::none_of(items_, is_open)) return;
  const DualPair<dim> of_energy{.z = {state.v.begin(), state.v.end()}};
  std::vector<const DualPair<dim>*> pairs{&of_energy};
  const auto needs_pair = [](const Item& item, const LinearNumber<dim>& number)
  { return item.reason.empty() && !number.known; };
  for (const Item& item : items_)
    for (const LinearNumber<dim>& number : item.numbers)
      if (needs_pair(item, number)) pairs.push_back(&number.pair);
  const std::vector<DualProducts> products = dual_products<dim>(state, pairs);
  std::optional<SecondOrder<dim>> second_order;
  if (pairs.size() > 1 && is_held_) second_order.emplace(state, *systems_, solver_);
  std::size_t next = 1;
  for (std::size_t i = 0; i < items_.size(); ++i)
  {
    const Item& item = items_[i];
    if (!is_open(item)) continue;
    QuantityInterval& interval = intervals[i];
    interval.reason = {};
    if (is_energy(item))
      set_energy<dim>(state, of_energy, products.front(), is_homogeneous_, interval);
    else
    {
      std::vector<QuantityInterval> numbers;
      for (const LinearNumber<dim>& number : item.numbers)
      {
        numbers.push_back(bounded(item, number, state, products[needs_pair(item, number) ? next++ : 0],
                                  second_order ? &*second_order : nullptr));
        if (!number.weight || number.weight->note.empty()) continue;
        interval.note = number.weight->note;
        interval.is_weighted = true;
      }
      combine(interval, item.parts.coefficient, numbers);
    }
    if (state.bound.target == EnergyTarget::computed_friction)
      interval.note +=
          (interval.note.empty() ? "" : "; ") + std::string("of the computed friction threshold");
  }
}

template class QuantityBounds<2>;
template class QuantityBounds<3>;

}  // namespace tribound::certify
