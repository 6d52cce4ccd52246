#include "tribound/certify/energy/quantity_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "tribound/certify/energy/energy_interval.h"
#include "tribound/contact/nitsche/residual.h"

namespace tribound::certify
{

using problem::QuantityKind;

/// A quantity and the numbers from which it is computed.
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
    if (item.kind() == QuantityKind::spring_force)
      if (const auto known = certify::from_equilibrium<dim>(
              form, {.tag = item.parts.tag, .motion = {.translation = item.parts.direction}}))
        item.numbers.push_back({.known = known});
    for (const ContactResultant<dim>& resultant : item.parts.resultants)
    {
      LinearNumber<dim>& number = item.numbers.emplace_back();
      number.known = certify::from_equilibrium(form, resultant);
      for (std::size_t i = 0; i < form.n_contact_points(); ++i)
      {
        const bool counts = resultant.has(form.segments()[i / form.n_segment_points()].slave.facet.tag);
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
void QuantityBounds<dim>::prepare(const contact::NitscheForm<dim>& bounded, const ObstacleFacets<dim>& facets,
                                  ContactSystems<dim>& systems, bool is_held)
{
  systems_ = &systems;
  is_held_ = is_held;
  is_homogeneous_ = is_homogeneous(bounded, facets);
  work_is_energy_ = is_homogeneous_ && slides_freely(bounded);
  // its motion is then not free where the values of dual displacements are given
  const bool touches = facets.touch(bounded.rigid_parts());
  std::optional<ContactWeights<dim>> weights;
  for (Item& item : items_)
  {
    if (is_energy(item) || !item.reason.empty() || item.is_known()) continue;
    if (touches)
    {
      item.reason = "a rigid part touches a contact boundary";
      continue;
    }
    if (item.parts.resultants.empty() && !is_held)
    {
      item.reason = "contact alone holds a body";  // else the load of the dual problem would move it
      continue;
    }
    if (item.parts.resultants.empty()) item.numbers.push_back(loaded_number(item.parts, bounded));
    for (std::size_t i = 0; i < item.parts.resultants.size(); ++i)
    {
      if (item.numbers[i].known) continue;
      if (!weights) weights.emplace(bounded, facets.junctions());
      const std::string reason = set_weight(item.numbers[i], form_, bounded, *weights,
                                            item.parts.resultants[i], item.parts.quantity.ramp);
      if (!reason.empty()) item.reason = reason;
    }
    if (!unloaded_ && std::ranges::any_of(item.numbers, [](const LinearNumber<dim>& number)
                                          { return !number.known && !number.loads; }))
      unloaded_ = std::make_unique<DualProblem<dim>>(
          bounded, without_loads<dim>(bounded.problem(), bounded.space().mesh()));
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
  const double full_circle = form_.problem().full_circle();
  switch (item.kind())
  {
    case QuantityKind::energy:
      return full_circle * contact::stress_norms<dim>(form_, u).energy;
    case QuantityKind::load_work:
      return full_circle * contact::load_work<dim>(form_, u);
    case QuantityKind::mean_displacement:
      return mean_displacement<dim>(form_, item.parts, u);
    case QuantityKind::spring_force:
      return full_circle * form_.springs().force(item.parts.tag, u).dot(item.parts.direction);
    case QuantityKind::contact_force:
    case QuantityKind::contact_moment:
      return full_circle * of_contact(0);
    case QuantityKind::safety_factor:
      break;
  }
  double square = 0;
  for (std::size_t i = 1; i < item.numbers.size(); ++i) square += std::pow(of_contact(i), 2);
  constexpr double rounding = 1e-10;  // of N, below which no force makes it slide
  const double total = of_contact(0);
  return std::sqrt(square) > rounding * std::abs(total)
             ? item.parts.coefficient * std::max(0.0, total - item.parts.uplift.value) / std::sqrt(square)
             : 0;
}

namespace
{

/// Times a factor, which numbers of the meridian have in those of the full circle.
void scale(QuantityInterval& interval, double factor)
{
  interval.lower *= factor;
  interval.upper *= factor;
  for (double& cell : interval.cells) cell *= factor;
}

/// What the numbers of a quantity on the meridian are multiplied with: quotients stay as they are.
template <int dim>
double factor_of(QuantityKind kind, const problem::Problem<dim>& problem)
{
  const bool is_quotient = kind == QuantityKind::mean_displacement || kind == QuantityKind::safety_factor;
  return is_quotient ? 1 : problem.full_circle();
}

QuantityInterval known_interval(const KnownNumber& number)
{
  QuantityInterval result{.exact = true, .basis = "equilibrium"};
  set_ends(result, number.value, number.value, number.uncertainty);
  return result;
}

/// Unless it is there or empty.
void add_note(QuantityInterval& interval, const std::string& note)
{
  if (note.empty() || interval.note.find(note) != std::string::npos) return;
  interval.note += (interval.note.empty() ? "" : "; ") + note;
}

/// Sets the interval of a quantity from those of its numbers.
template <int dim>
void combine(QuantityInterval& interval, const QuantityParts<dim>& parts,
             std::vector<QuantityInterval> numbers)
{
  if (numbers.size() == 1)
  {
    interval.lower = numbers[0].lower;
    interval.upper = numbers[0].upper;
    interval.reason = numbers[0].reason;
    interval.cells = numbers[0].cells;
  }
  else
  {
    numbers[0].lower -= parts.uplift.value + parts.uplift.uncertainty;
    numbers[0].upper -= parts.uplift.value - parts.uplift.uncertainty;
    set_safety_factor(interval, parts.coefficient, numbers[0], {numbers.begin() + 1, numbers.end()});
  }
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
    interval.note = item.parts.note;
    if (item.parts.reason.empty()) interval.value = value(item, u, t);
    interval.reason = item.reason.empty() ? reason : item.reason;
    if (!item.is_known()) continue;
    std::vector<QuantityInterval> numbers;
    for (const LinearNumber<dim>& number : item.numbers) numbers.push_back(known_interval(*number.known));
    interval.reason = {};
    combine<dim>(interval, item.parts, std::move(numbers));
    scale(interval, factor_of(item.kind(), form_.problem()));
  }
  return result;
}

template <int dim>
QuantityInterval QuantityBounds<dim>::bounded(const Item& item, const LinearNumber<dim>& number,
                                              const BoundedState<dim>& state,
                                              const LinearIntervals<dim>& intervals) const
{
  if (number.known) return known_interval(*number.known);
  const bool is_work = item.kind() == QuantityKind::load_work;
  if (is_work && !state.has_polynomial_loads && state.unresolved > 0)
    return {.reason = "the loads are no polynomials of low degree"};
  if (item.kind() == QuantityKind::spring_force && !state.form.springs().has_polynomial_rest())
    return {.reason = "where the spring rests is no polynomial of low degree"};
  const LinearInterval of_number = intervals(number, number.base(state, item.parts));
  if (!of_number.reason.empty()) return {.reason = of_number.reason};
  QuantityInterval result{.basis = of_number.is_second_order ? "second order" : "energy bound",
                          .cells = of_number.cells};
  set_ends(result, of_number.lower, of_number.upper, of_number.rounding);
  return result;
}

template <int dim>
void QuantityBounds<dim>::add_bounded(const BoundedState<dim>& state,
                                      std::vector<QuantityInterval>& intervals) const
{
  std::optional<LinearIntervals<dim>> of_numbers;
  for (std::size_t i = 0; i < items_.size(); ++i)
  {
    const Item& item = items_[i];
    if (!item.reason.empty() || item.is_known()) continue;
    QuantityInterval& interval = intervals[i];
    interval.reason = {};
    if (is_energy(item))
      set_energy<dim>(state, is_homogeneous_, interval);
    else
    {
      if (!of_numbers) of_numbers.emplace(state, *systems_, unloaded_.get(), is_held_);
      std::vector<QuantityInterval> numbers;
      for (const LinearNumber<dim>& number : item.numbers)
      {
        numbers.push_back(bounded(item, number, state, *of_numbers));
        if (number.weight) add_note(interval, number.weight->note);
      }
      combine<dim>(interval, item.parts, std::move(numbers));
    }
    scale(interval, factor_of(item.kind(), form_.problem()));
    if (state.bound.target == EnergyTarget::computed_friction)
      add_note(interval, "of the computed friction threshold");
  }
}

template class QuantityBounds<2>;
template class QuantityBounds<3>;

}  // namespace tribound::certify
