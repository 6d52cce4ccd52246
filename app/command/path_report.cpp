#include "app/command/path_report.h"

#include <fmt/format.h>

#include <tuple>
#include <utility>

#include "app/console/balance_text.h"
#include "app/console/console.h"
#include "app/program_facts.h"
#include "app/shared_file.h"
#include "tribound/io/fields/vtu.h"
#include "tribound/io/state/path_checkpoint.h"

namespace tribound::app
{

namespace
{

/// Seconds of work that a program which is killed may lose.
constexpr double most_lost = 1.0;

/// Whether a checkpoint is that of a pass after the first that was not complete.
bool is_of_unfinished_pass(const std::filesystem::path& file)
{
  const std::filesystem::path directory = file.parent_path();
  return directory.filename() == unfinished_pass ||
         (file.filename() == io::checkpoint_name && std::filesystem::exists(directory / unfinished_pass));
}

template <int dim>
adapt::LevelView<dim> view_of(const adapt::LoadStep<dim>& step)
{
  return {step.number, step.at->discrete, step.level, step.verdict, step.seconds, step.discrete()};
}

}  // namespace

template <int dim>
PathReport<dim>::PathReport(const case_file::Config& config, const problem::Problem<dim>& problem,
                            const adapt::Grid<dim>& first, std::vector<bool> slides, Clock::time_point begin,
                            Printed printed, const Restart* restart)
    : output_(config.output),
      method_(config.method),
      ranks_(first.mesh.ranks()),
      printed_(ranks_.is_first() ? printed : Printed::nothing),
      page_template_(config.output.report ? find_shared_file("report.html") : std::filesystem::path{}),
      moment_about_(moment_point<dim>(config.output, first.mesh)),
      slides_(std::move(slides)),
      free_sides_(free_sides(config, first.mesh.boundary_names())),
      watch_(config.history->watch),
      carries_(config.history->refine == case_file::Refine::transfer),
      in_work_(0, page_template_)
{
  ranks_.on_first([&] { directory_ = take_directory(config, restart != nullptr); });
  record_ = first_record(config, problem, first.space, fem::dirichlet<dim>(problem, first.space), begin);
  if (restart)
  {
    record_.earlier = restart->facts.earlier;
    is_resumed_ = true;
    is_apart_ = ranks_.on_first([&] { return is_of_unfinished_pass(restart->file); });
  }
  if (printed_ == Printed::everything) print_header(record_.facts, record_.mesh);
}

template <int dim>
std::filesystem::path PathReport<dim>::fields_directory() const
{
  return is_apart_ ? output_.directory / unfinished_pass : output_.directory;
}

template <int dim>
void PathReport<dim>::begin(int pass, const adapt::Grid<dim>& grid)
{
  if (!std::exchange(is_resumed_, false) && pass > 0)
  {
    before_.emplace(record_, std::move(in_work_));
    io::drop_steps(record_.earlier);
    is_apart_ = true;
    ranks_.on_first([&] { io::make_series_directory(fields_directory()); });
  }
  record_.levels.clear();
  in_work_ = Pass(pass, page_template_);
  if (printed_ == Printed::everything)
    print_mesh(fmt::format("{} {}", carries_ ? "mesh" : "pass", pass), grid.mesh.n_global_cells(),
               grid.space.n_global_dofs());
}

template <int dim>
io::LevelRecord PathReport<dim>::record_of(const adapt::LoadStep<dim>& step,
                                           const adapt::LevelView<dim>& view) const
{
  io::LevelRecord record = io::level_record<dim>(view, moment_about_, slides_);
  const std::optional<io::LoadStepRecord> before = io::last_load_step(record_);
  record.load_step = io::load_step_record<dim>(step, before ? &*before : nullptr, watch_);
  return record;
}

template <int dim>
void PathReport<dim>::keep(const adapt::LevelView<dim>& view, double t)
{
  in_work_.shown.reset();
  in_work_.last = std::make_shared<const KeptLevel<dim>>(view, t);
  in_work_.shown = gather(view, in_work_.last, output_, method_);
}

template <int dim>
void PathReport<dim>::add(const adapt::LoadStep<dim>& step)
{
  const Clock::time_point begin = Clock::now();
  const adapt::LevelView<dim> view = view_of(step);
  record_.levels.push_back(record_of(step, view));
  keep(view, step.t);
  update_statements(record_, view, method_.contact_rule);
  certify::add_history(record_.statements,
                       method_.stopping.criterion != adapt::Stopping::tolerance &&
                           method_.stopping.criterion != adapt::Stopping::last_bounded,
                       carries_);
  ranks_.together([&] { update_warnings(record_, view, in_work_.shown.get()); });
  ranks_.together([&] { write_fields(); });
  io::LevelTimes& times = record_.levels.back().times;
  times.stages.output = seconds_since(begin);
  times.level += times.stages.output;
  const double cpu_now = cpu_seconds();
  times.level_cpu = cpu_now - std::exchange(cpu_before_, cpu_now);
  if (printed_ == Printed::everything) print_level(record_.levels.back());
  if (is_apart_ || !ranks_.first_says(seconds_since(written_) > most_lost)) return;
  write_record();
}

template <int dim>
void PathReport<dim>::write_fields()
{
  const KeptLevel<dim>* shown = in_work_.shown.get();
  if (shown != nullptr && fits_page(*shown))
    in_work_.page.add(shown->number, shown->discrete->form, shown->level);
  if (!output_.vtu) return;
  const std::filesystem::path directory = fields_directory();
  const KeptLevel<dim>& last = *in_work_.last;
  write_vtu_files(directory, last, shown);
  if (shown != nullptr) io::write_series(directory, 1, last.number, last.place().stem());
}

template <int dim>
void PathReport<dim>::write_checkpoint(const adapt::ReplayState<dim>& state)
{
  const KeptLevel<dim>& last = *in_work_.last;
  io::CheckpointFacts facts{.dimension = dim,
                            .degree = method_.degree,
                            .case_text = record_.effective.text,
                            .earlier = io::as_earlier(record_, state.pass, state.worst_step)};
  const io::CheckpointFields fields = io::to_checkpoint(state, facts);
  const auto write = [&](const std::filesystem::path& file)
  { io::write_checkpoint<dim>(file, facts, last.discrete->space, fields); };
  write(output_.directory / io::checkpoint_name);
  if (output_.checkpoints == case_file::Checkpoints::all)
    write(fields_directory() / io::checkpoint_name_of(last.number));
}

template <int dim>
void PathReport<dim>::note(const adapt::PathEnd& end)
{
  record_.path = end;
}

/// By its worst step, which has no record yet where it is solved again on the next mesh.
template <int dim>
void PathReport<dim>::add_mesh(const adapt::PassView<dim>& pass)
{
  const bool is_left = pass.step && (record_.levels.empty() || record_.levels.back().level < pass.worst);
  if (is_left) record_.levels.push_back(record_of(*pass.step, view_of(*pass.step)));
  io::complete_pass(record_, pass.number, pass.worst);
  if (is_left) record_.levels.pop_back();
}

template <int dim>
void PathReport<dim>::refine(const adapt::PassView<dim>& left, const adapt::Grid<dim>& finer)
{
  add_mesh(left);
  if (printed_ == Printed::everything)
    print_mesh(fmt::format("mesh {}", left.number + 1), finer.mesh.n_global_cells(),
               finer.space.n_global_dofs());
}

template <int dim>
void PathReport<dim>::complete(const adapt::PassView<dim>& pass)
{
  add_mesh(pass);
  ranks_.on_first(
      [&]
      {
        if (is_apart_) io::move_series(fields_directory(), output_.directory);
      });
  is_apart_ = false;
  before_.reset();
  record_.status = pass.verdict.status;
  record_.reason = pass.verdict.reason;
  write_record();
}

template <int dim>
std::shared_ptr<const adapt::Grid<dim>> PathReport<dim>::last_grid() const
{
  return in_work_.last ? in_work_.last->discrete->grid : nullptr;
}

template <int dim>
void PathReport<dim>::begin_check(const adapt::Grid<dim>& grid)
{
  record_.check.emplace().cells = grid.mesh.n_global_cells();
  if (printed_ == Printed::everything) print_mesh("check", record_.check->cells, grid.space.n_global_dofs());
}

template <int dim>
void PathReport<dim>::add_to_check(const adapt::LoadStep<dim>& step)
{
  std::optional<io::LoadStepRecord>& last = record_.check->last;
  last = io::load_step_record<dim>(step, last ? &*last : nullptr);
  record_.check->steps = step.number;
  io::LevelRecord shown;
  shown.level = step.number;
  shown.newton = step.level.steps;
  shown.times.level = step.seconds;
  shown.load_step = last;
  if (printed_ == Printed::everything) print_level(shown);
}

template <int dim>
void PathReport<dim>::end_check(const adapt::PathEnd& end)
{
  if (!record_.check) record_.check.emplace();
  record_.check->end = end;
}

template <int dim>
bool PathReport<dim>::give_up()
{
  if (!is_apart_) return false;
  ranks_.on_first([&] { io::remove_series_directory(fields_directory()); });
  is_apart_ = false;
  if (before_)
    std::tie(record_, in_work_) = *std::exchange(before_, std::nullopt);
  else
    directory_holds_ = true;
  return true;
}

template <int dim>
void PathReport<dim>::write_record()
{
  if (record_.levels.empty() && !record_.earlier.steps.empty()) return;  // nothing new: what there is holds
  ranks_.on_first([&] { io::write_report(output_.directory, record_); });
  written_ = Clock::now();
}

template <int dim>
void PathReport<dim>::write_what_holds()
{
  give_up();
  if (directory_holds_) return;
  write_record();
  ranks_.together(
      [&]
      {
        if (!in_work_.shown) return;
        const KeptLevel<dim>& shown = *in_work_.shown;
        write_contact_and_mesh(shown, output_, free_sides_);
        if (fits_page(shown)) in_work_.page.add_last(shown.number, shown.discrete->form, shown.level);
        in_work_.page.write(output_.directory, record_);
      });
}

template <int dim>
ExitCode PathReport<dim>::close(const certify::Verdict& verdict)
{
  record_.status = verdict.status;
  record_.reason = verdict.reason;
  write_what_holds();
  print_end(record_, printed_, output_.directory);
  return exit_code(verdict.status);
}

template <int dim>
void PathReport<dim>::fail(const std::string& reason)
{
  if (!record_.earlier.steps.empty() && record_.levels.empty()) return;  // what the run before has left holds
  record_.status = certify::RunStatus::failed;
  record_.reason = reason;
  write_what_holds();
}

template class PathReport<2>;
template class PathReport<3>;

}  // namespace tribound::app
