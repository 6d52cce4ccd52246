#include "tribound/io/record/load_step_record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "tribound/io/record/solution_figures.h"

namespace tribound::io
{

namespace
{

/// The figures that are sums over points.
constexpr std::array sums = {
    &InterfaceFigures::measure,    &InterfaceFigures::opened,  &InterfaceFigures::slipping,
    &InterfaceFigures::broken,     &InterfaceFigures::process, &InterfaceFigures::damage,
    &InterfaceFigures::dissipated, &InterfaceFigures::rubbed,  &InterfaceFigures::stored};

template <int dim>
void add_point(InterfaceFigures& figures, const problem::InterfaceResponse<dim>& response, double weight,
               bool is_bonded)
{
  figures.measure += weight;
  if (response.status == problem::ContactStatus::open) figures.opened += weight;
  if (response.status == problem::ContactStatus::slip) figures.slipping += weight;
  figures.dissipated += weight * response.dissipated;
  figures.rubbed += weight * response.rubbed;
  figures.stored += weight * response.stored;
  if (!is_bonded) return;
  const double damage = response.state.damage;
  figures.damage += weight * damage;
  if (damage >= 1)
    figures.broken += weight;
  else if (damage > 0)
    figures.process += weight;
}

template <int dim>
std::vector<InterfaceFigures> interface_figures(const adapt::LoadStep<dim>& step)
{
  const contact::NitscheForm<dim>& form = step.at->discrete.form;
  const auto boundaries = form.problem().boundaries();
  std::vector<InterfaceFigures> of_boundary(boundaries.size());
  for (std::size_t k = 0; k < form.n_owned_segments(); ++k)
  {
    const contact::ContactSegment<dim>& segment = form.segments()[k];
    const bool is_bonded = problem::cone(segment.contact->law).is_bonded;
    const auto points = form.contact_points(k);
    for (std::size_t q = 0; q < points.size(); ++q)
      add_point(of_boundary[segment.slave.facet.tag], step.responses[k * points.size() + q], points[q].weight,
                is_bonded);
  }
  std::vector<double> values;
  for (const InterfaceFigures& figures : of_boundary)
    for (const auto sum : sums) values.push_back(form.problem().full_circle() * (figures.*sum));
  form.space().mesh().ranks().sum(std::span(values));
  std::vector<InterfaceFigures> result;
  for (std::size_t tag = 0; tag < boundaries.size(); ++tag)
  {
    if (form.problem().contact(static_cast<int>(tag)) == nullptr) continue;
    InterfaceFigures& figures = result.emplace_back();
    figures.boundary = boundaries[tag].name;
    for (std::size_t i = 0; i < sums.size(); ++i) figures.*sums[i] = values[tag * sums.size() + i];
    figures.hydraulic = hydraulic_figures<dim>(step, static_cast<int>(tag));
  }
  const auto has_base = [](const InterfaceFigures& figures) { return figures.hydraulic.has_value(); };
  if (std::ranges::count_if(result, has_base) > 1)  // the loads act on all of them together
    for (InterfaceFigures& figures : result)
      if (figures.hydraulic) figures.hydraulic->overturning.reset();
  return result;
}

void add(std::optional<HydraulicFigures>& all, const std::optional<HydraulicFigures>& part)
{
  if (!part) return;
  all = all ? HydraulicFigures{.effective_normal = all->effective_normal + part->effective_normal,
                               .uplift = all->uplift + part->uplift}
            : *part;
}

}  // namespace

template <int dim>
LoadStepRecord load_step_record(const adapt::LoadStep<dim>& step, const LoadStepRecord* before,
                                std::span<const adapt::Watch> watch)
{
  LoadStepRecord record{.t = step.t,
                        .control = step.control,
                        .cuts = step.cuts,
                        .passes = step.passes,
                        .largest_sigma = step.largest_sigma,
                        .interfaces = interface_figures(step)};
  if (before != nullptr)
  {
    record.dissipated = before->dissipated;
    record.rubbed = before->rubbed;
    record.work = before->work;
  }
  for (const InterfaceFigures& figures : record.interfaces)
  {
    for (const auto sum : sums) record.all.*sum += figures.*sum;
    add(record.all.hydraulic, figures.hydraulic);
  }
  record.dissipated += record.all.dissipated;
  record.rubbed += record.all.rubbed;
  const contact::NitscheForm<dim>& form = step.at->discrete.form;
  const double full_circle = form.problem().full_circle();
  record.work += full_circle * step.work;
  record.balance =
      record.work - full_circle * step.level.norms.energy / 2 - record.all.stored - record.dissipated;
  std::vector<Point<dim>> effective = form.water_pressure();
  for (std::size_t i = 0; i < effective.size(); ++i) effective[i] += step.level.traction[i];
  const contact::ContactResultants<dim> resultants = contact::contact_resultants<dim>(form, effective);
  constexpr double of_sums = 1e-12;  // rounding
  const double resolution = of_sums * (resultants.abs_normal + resultants.abs_tangential);
  record.effective_normal = known_digits(resultants.normal, resolution);
  record.tangential = known_digits(resultants.tangential, resolution);
  for (const adapt::Watch& watched : watch)
    record.watched.emplace_back(watched.name,
                                form.space().dot(adapt::functional<dim>(form, watched.gauges), step.level.u));
  return record;
}

template LoadStepRecord load_step_record(const adapt::LoadStep<2>&, const LoadStepRecord*,
                                         std::span<const adapt::Watch>);
template LoadStepRecord load_step_record(const adapt::LoadStep<3>&, const LoadStepRecord*,
                                         std::span<const adapt::Watch>);

}  // namespace tribound::io
