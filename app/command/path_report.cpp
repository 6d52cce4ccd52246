/// @file path_report.cpp
/// Output of a run over load steps in addition to that of a run over levels: passes over the path.

#include <fmt/format.h>

#include <functional>
#include <tuple>
#include <utility>

#include "app/command/run_report.h"
#include "tribound/io/fields/vtu.h"
#include "tribound/io/state/path_checkpoint.h"

namespace tribound::app
{

namespace
{

template <int dim>
adapt::LevelView<dim> view_of(const adapt::LoadStep<dim>& step)
{
  return {step.number, step.at->discrete, step.level, step.verdict, step.seconds, step.discrete()};
}

}  // namespace

template <int dim>
io::LevelRecord RunReport<dim>::record_of(const adapt::LevelView<dim>& view,
                                          const adapt::LoadStep<dim>* step) const
{
  io::LevelRecord record = io::level_record<dim>(view, moment_about_, slides_, record_.facts.units);
  const contact::NitscheForm<dim>& form = view.discrete.form;
  const bool has_stress = record.bound && view.level.stress.degree > 0;
  if (view.level.solved())
    record.probes = io::read_probes<dim>(form, view.level, has_stress, observations_.probes);
  if (has_stress) record.sections = io::read_sections<dim>(form, view.level, observations_.sections);
  if (!step) return record;
  const std::optional<io::LoadStepRecord> before = io::last_load_step(record_);
  record.load_step = io::load_step_record<dim>(*step, before ? &*before : nullptr, config_.history->watch);
  return record;
}

template <int dim>
void RunReport<dim>::begin_pass(int pass, const adapt::Grid<dim>& grid)
{
  rethrow(finish_writing());
  if (!std::exchange(is_resumed_, false) && pass > 0)
  {
    before_.emplace(record_, std::move(in_work_));
    io::drop_steps(record_.earlier);
    is_apart_ = true;
    ranks_.on_first([&] { io::remove_series_directory(fields_directory()); });
  }
  record_.levels.clear();
  in_work_ = Pass(config_.output);
  const bool carries = config_.history->refine == case_file::Refine::transfer;
  print_mesh(fmt::format("{} {}", carries ? "mesh" : "pass", pass), grid);
}

template <int dim>
void RunReport<dim>::write_checkpoint(const adapt::ReplayState<dim>& state)
{
  rethrow(finish_writing());  // the files of the step come first
  const KeptLevel<dim>& last = *in_work_.last;
  const std::filesystem::path& directory = config_.output.directory;
  const bool carries = config_.history->refine == case_file::Refine::transfer;
  const io::LoggedSteps steps{carries ? 0 : state.pass, last.number};
  ranks_.on_first([&]
                  { io::append_step(directory / io::step_log_name, steps, io::last_step_rows(record_)); });
  io::CheckpointFacts facts{.dimension = dim,
                            .degree = config_.method.degree,
                            .case_text = record_.effective.text,
                            .earlier = io::as_earlier(record_, state.pass, state.worst_step),
                            .steps = steps};
  const io::CheckpointFields fields = io::to_checkpoint(state, facts);
  const std::filesystem::path file = directory / io::checkpoint_name;
  io::write_checkpoint<dim>(file, facts, last.discrete->space, fields);
  if (config_.output.checkpoints == case_file::Checkpoints::all)
    ranks_.on_first(
        [&]
        {
          io::copy_checkpoint(
              file, (is_apart_ ? fields_directory() : directory) / io::checkpoint_name_of(last.number));
        });
}

/// The worst step has no record yet if it is solved again on the next mesh.
template <int dim>
void RunReport<dim>::add_mesh(const adapt::PassView<dim>& pass)
{
  const bool is_left = pass.step && (record_.levels.empty() || record_.levels.back().level < pass.worst);
  if (is_left) record_.levels.push_back(record_of(view_of(*pass.step), pass.step));
  io::complete_pass(record_, pass.number, pass.worst);
  if (is_left) record_.levels.pop_back();
}

template <int dim>
void RunReport<dim>::complete(const adapt::PassView<dim>& pass)
{
  rethrow(finish_writing());
  add_mesh(pass);
  hand_over_pass();
  before_.reset();
  record_.status = pass.verdict.status;
  record_.reason = pass.verdict.reason;
  if (has_news()) write_record();
}

template <int dim>
bool RunReport<dim>::give_up()
{
  if (!is_apart_) return false;
  (void)finish_writing();  // errors in files that are removed do not matter
  ranks_.on_first([&] { io::remove_series_directory(fields_directory()); });
  is_apart_ = false;
  if (before_)
    std::tie(record_, in_work_) = *std::exchange(before_, std::nullopt);
  else
    directory_holds_ = true;
  return true;
}

template <int dim>
adapt::ReplayObserver<dim> RunReport<dim>::path_observer(const adapt::StepObserver& newton)
{
  adapt::ReplayObserver<dim> observer{
      .newton = newton,
      .begins = [this](int pass, const adapt::Grid<dim>& grid) { begin_pass(pass, grid); },
      .step = [this](const adapt::LoadStep<dim>& step) { add(view_of(step), &step); },
      .path_end = [this](const adapt::PathEnd& end) { record_.path = end; },
      .complete = [this](const adapt::PassView<dim>& pass) { complete(pass); },
      .given_up = [this] { return give_up(); },
      .finer =
          [this](const adapt::PassView<dim>& left, const adapt::Grid<dim>& grid)
      {
        add_mesh(left);
        print_mesh(fmt::format("mesh {}", left.number + 1), grid);
      }};
  if (config_.output.checkpoints != case_file::Checkpoints::none)
    observer.state = [this](const adapt::ReplayState<dim>& state) { write_checkpoint(state); };
  return observer;
}

template io::LevelRecord RunReport<2>::record_of(const adapt::LevelView<2>&, const adapt::LoadStep<2>*) const;
template io::LevelRecord RunReport<3>::record_of(const adapt::LevelView<3>&, const adapt::LoadStep<3>*) const;
template bool RunReport<2>::give_up();
template bool RunReport<3>::give_up();
template adapt::ReplayObserver<2> RunReport<2>::path_observer(const adapt::StepObserver&);
template adapt::ReplayObserver<3> RunReport<3>::path_observer(const adapt::StepObserver&);

}  // namespace tribound::app
