/// @file saved_path.cpp
/// Saving load paths and continuing them.

#include "tribound/adapt/saved_path.h"

#include <utility>

#include "tribound/adapt/gathered_history.h"
#include "tribound/adapt/load_path.h"
#include "tribound/base/error.h"

namespace tribound::adapt
{

namespace
{

constexpr const char* other_contact = "the contact points of the checkpoint are not those of the mesh";
constexpr const char* as_it_was = "go on with pairs, degree and boundaries as they were";

}  // namespace

template <int dim>
SavedPath<dim> LoadPath<dim>::save(std::span<const Position> positions)
{
  SavedPath<dim> saved;
  for (const Position& position : positions)
  {
    const LoadStep<dim>& step = *position.last;
    saved.steps.push_back({.number = step.number,
                           .t = step.t,
                           .control = step.control,
                           .reference_force = position.reference_force,
                           .largest_sigma = position.largest_sigma,
                           .tips = position.tips,
                           .u = step.level.u,
                           .history = gather_history(step.at->discrete.form)});
  }
  saved.before = positions.back().before_last;
  return saved;
}

template <int dim>
auto LoadPath<dim>::recall(const SavedStep<dim>& saved, PathPoint before) const -> Position
{
  auto at = std::make_shared<DiscreteAtTime<dim>>(problem_.with_crack_tips(saved.tips), saved.t, grid_,
                                                  method_, nullptr);
  contact::NitscheForm<dim>& form = at->discrete.form;
  if (!saved.history.states.empty())
  {
    std::shared_ptr<const contact::ContactHistory<dim>> history = history_on(form, saved.history);
    if (grid_->mesh.ranks().any(history == nullptr)) throw InputError({}, other_contact, as_it_was);
    form.set_history(std::move(history));
  }
  auto step = std::make_shared<LoadStep<dim>>();
  step->number = saved.number;
  step->t = saved.t;
  step->control = saved.control;
  step->largest_sigma = saved.largest_sigma;
  step->level.u = saved.u;
  step->level.traction = form.traction(saved.u);
  step->level.friedrichs = friedrichs_;
  step->responses = form.advance(saved.u);
  std::vector<double> contact_load(form.space().n_dofs(), 0.0);
  form.add_contact_load(step->level.traction, contact_load);
  form.add_contact_load(form.water_pressure(), contact_load);
  step->forces = forces_on<dim>(form, saved.u, contact_load);
  step->at = std::move(at);
  std::shared_ptr<const contact::ContactHistory<dim>> after = history_after(*step);
  return {std::move(step),       std::move(before),   std::move(after),
          saved.reference_force, saved.largest_sigma, saved.tips};
}

template <int dim>
auto LoadPath<dim>::recall(const SavedPath<dim>& saved,
                           const std::optional<certify::FriedrichsConstant>& friedrichs)
    -> std::vector<Position>
{
  if (saved.steps.front().tips.size() != position_.tips.size())
    throw InputError({}, other_contact, as_it_was);
  friedrichs_ = friedrichs;
  std::vector<Position> positions;
  for (std::size_t i = 0; i < saved.steps.size(); ++i)
  {
    const bool is_oldest = i + 1 == saved.steps.size();
    positions.push_back(recall(
        saved.steps[i], is_oldest ? saved.before : PathPoint{saved.steps[i + 1].t, saved.steps[i + 1].u}));
  }
  position_ = positions.front();
  prepared_.reset();
  return positions;
}

template SavedPath<2> LoadPath<2>::save(std::span<const Position>);
template SavedPath<3> LoadPath<3>::save(std::span<const Position>);
template std::vector<LoadPath<2>::Position> LoadPath<2>::recall(
    const SavedPath<2>&, const std::optional<certify::FriedrichsConstant>&);
template std::vector<LoadPath<3>::Position> LoadPath<3>::recall(
    const SavedPath<3>&, const std::optional<certify::FriedrichsConstant>&);

}  // namespace tribound::adapt
