#include "app/command/run_report.h"

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "app/console/console.h"
#include "app/console/text.h"
#include "app/shared_file.h"
#include "tribound/algebra/cholesky.h"
#include "tribound/base/rank_failure.h"
#include "tribound/case/probe_reader.h"
#include "tribound/case/resolve.h"
#include "tribound/doctor/run_warnings.h"
#include "tribound/doctor/solution_facts.h"
#include "tribound/io/fields/vtu.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/record/run_statements.h"
#include "tribound/io/state/checkpoint.h"

namespace tribound::app
{

template <int dim>
RunReport<dim>::Pass::Pass(const case_file::OutputConfig& output)
    : page(output.report ? find_shared_file("report.html") : std::filesystem::path{})
{
}

template <int dim>
RunReport<dim>::RunReport(const case_file::Config& config, const problem::Problem<dim>& problem,
                          const adapt::Discretisation<dim>& first, std::vector<bool> slides,
                          Clock::time_point begin, Printed printed, const Restart* restart)
    : config_(config),
      ranks_(first.mesh.ranks()),
      printed_(ranks_.is_first() ? printed : Printed::nothing),
      moment_about_(case_file::moment_point<dim>(config.output, first.mesh)),
      observations_(case_file::observations<dim>(config, first.mesh)),
      slides_(std::move(slides)),
      in_work_(config.output)
{
  record_.effective = config.effective;
  ranks_.on_first(
      [&]
      {
        directory_ = take_directory(config, restart != nullptr);
        record_.effective.files = io::hashed_files(case_file::files_of(config));
      });
  record_.facts = case_file::case_facts(config, dim);
  record_.mesh = io::mesh_facts<dim>(problem, first.space, first.form.constraints(), config.units);
  record_.build = io::build_facts();
  record_.build.processes = ranks_.size();
  record_.case_file = effective_file_name(config);
  record_.tolerance = config.adapt.tolerance;
  record_.setup = seconds_since(begin);
  record_.statements = io::run_statements(first, record_.facts, config.method);
  if (restart)
  {
    record_.earlier = restart->facts.earlier;
    is_resumed_ = is_path();
    has_old_files_ = true;
    n_earlier_steps_ = restart->facts.steps.last;
    if (is_path()) ranks_.on_first([&] { io::copy_step_log(restart->file, config.output.directory); });
    is_apart_ = is_path() && restart->is_apart;
  }
  if (printed_ == Printed::everything) print(header_text(record_.facts, record_.mesh));
}

template <int dim>
void RunReport<dim>::update_warnings(const adapt::LevelView<dim>& view)
{
  record_.warnings.clear();
  const KeptLevel<dim>* shown = in_work_.shown.get();
  const bool is_shared = view.discrete.mesh.partition() != nullptr;
  if (!view.level.solved() || (is_shared && (!shown || shown->number != view.number))) return;
  const io::LevelRecord& level = record_.levels.back();
  record_.warnings = doctor::run_warnings(
      {level.bound, level.figures.sigma_norm, level.figures.max_displacement, record_.facts.units},
      is_shared ? doctor::contact_outcomes<dim>(shown->discrete->form, shown->level.u)
                : doctor::contact_outcomes<dim>(view.discrete.form, view.level.u));
}

template <int dim>
void RunReport<dim>::rethrow(const std::exception_ptr& failure) const
{
  ranks_.together(
      [&]
      {
        if (failure) std::rethrow_exception(failure);
      });
}

template <int dim>
io::LevelTimes RunReport<dim>::take_back(int number)
{
  if (record_.levels.empty() || record_.levels.back().level != number) return {};
  const io::LevelTimes times = record_.levels.back().times;
  record_.levels.pop_back();
  return times;
}

template <int dim>
void RunReport<dim>::count_time(Clock::time_point& begin)
{
  const double held = seconds_since(std::exchange(begin, Clock::now()));
  const double cpu_now = cpu_seconds();
  io::LevelTimes& times = record_.levels.back().times;
  held_ += held;
  times.level += held;
  times.level_cpu += cpu_now - std::exchange(cpu_before_, cpu_now);
  const int factored_now = algebra::n_factorisations();
  times.factorisations += factored_now - std::exchange(factored_before_, factored_now);
}

template <int dim>
void RunReport<dim>::watch(
    std::shared_ptr<const problem::Problem<dim>> problem,
    const std::function<void(const std::shared_ptr<const KeptLevel<dim>>&, const io::LevelRecord&)>& watcher)
{
  if (!watcher) return;
  watcher_ = [this, problem = std::move(problem), watcher]
  {
    const io::LevelRecord& record = record_.levels.back();
    if (!in_work_.last || in_work_.last->number != record.level) return;
    const auto owner =
        std::make_shared<std::pair<decltype(problem), decltype(in_work_.last)>>(problem, in_work_.last);
    ranks_.together([&] { watcher({owner, in_work_.last.get()}, record); });
  };
}

template <int dim>
void RunReport<dim>::add(const adapt::LevelView<dim>& view, const adapt::LoadStep<dim>* step)
{
  Clock::time_point begin = Clock::now();
  io::LevelRecord level;
  double output = 0;
  double output_cpu = 0;
  {
    const ScopedTimer timer(output, output_cpu, thread_cpu_seconds);
    level = record_of(view, step);
  }
  const std::exception_ptr failure = finish_writing();
  const io::LevelTimes before = take_back(view.number);
  const bool again = before.level > 0;
  if (!again) held_ = 0;
  level.times.stages.output = before.stages.output + output;
  level.times.output_cpu = before.output_cpu + output_cpu;
  level.times.level += held_;
  level.times.level_cpu = before.level_cpu;
  level.times.factorisations = before.factorisations;
  record_.levels.push_back(std::move(level));
  if (step || record_.levels.back().bound)
  {
    in_work_.shown.reset();  // makes room for this level
    in_work_.last.reset();
    in_work_.last =
        std::make_shared<const KeptLevel<dim>>(view, step ? std::optional(step->t) : std::nullopt);
    in_work_.shown = KeptLevel<dim>::gathered(view, in_work_.last, config_.output, config_.method);
  }
  if (!view.level.steps.empty())
    record_.statements =
        io::run_statements(view, record_.levels.back(), record_.facts, config_.method,
                           is_path() && config_.history->refine == case_file::Refine::transfer);
  if (!step)
  {
    record_.status = view.verdict.status;
    record_.reason = view.verdict.reason;
  }
  ranks_.together([&] { update_warnings(view); });
  count_time(begin);
  if (!again) print_level(record_.levels.back());
  rethrow(failure);
  make_room();
  if (is_due()) write_record();  // also moves the directory of the previous fields
  if (is_path()) ranks_.on_first([&] { io::make_series_directory(fields_directory()); });
  ranks_.together([&] { start_writing(); });
  count_time(begin);
  if (watcher_) watcher_();
}

template <int dim>
void RunReport<dim>::print_mesh(const std::string& caption, const adapt::Grid<dim>& grid) const
{
  if (printed_ == Printed::everything)
    print(mesh_text(caption, grid.mesh.n_global_cells(), grid.space.n_global_dofs()));
}

template <int dim>
void RunReport<dim>::print_level(const io::LevelRecord& level) const
{
  if (printed_ == Printed::everything || printed_ == Printed::levels) print(level_text(level));
}

template <int dim>
void RunReport<dim>::write_checkpoint(const adapt::Levels<dim>& next)
{
  const fem::LagrangeSpace<dim>& space = next.discrete().space;
  try
  {
    rethrow(finish_writing());  // the files of the previous level come first
    io::write_checkpoint<dim>(
        config_.output.directory / io::checkpoint_name,
        {dim, space.degree(), next.start(), record_.effective.text, io::as_earlier(record_), {}}, space,
        {.functions = {next.start_displacement()}});
  }
  catch (const io::WriteError& error)
  {
    require_all_failed(ranks_, error.what());
    write_what_holds();
    throw;
  }
}

template <int dim>
void RunReport<dim>::end(const certify::Verdict& verdict)
{
  record_.status = verdict.status;
  record_.reason = verdict.reason;
  write_what_holds();
  is_ended_ = true;
}

template <int dim>
bool RunReport<dim>::has_check() const
{
  return !has_news() && ranks_.on_first([&] { return io::has_history_check(config_.output.directory); });
}

template <int dim>
void RunReport<dim>::add_check(io::HistoryCheck check)
{
  record_.check = std::move(check);
  if (has_news()) return write_page();
  ranks_.on_first([&] { io::add_history_check(config_.output.directory, record_); });
}

template <int dim>
ExitCode RunReport<dim>::close(const certify::Verdict& verdict)
{
  if (!is_ended_) end(verdict);
  const std::string directory = config_.output.directory.string();
  if (printed_ == Printed::everything) print(summary_text(record_, directory));
  if (printed_ == Printed::verdict) print(warnings_text(record_.warnings) + verdict_text(record_, directory));
  return exit_code(verdict.status);
}

template <int dim>
void RunReport<dim>::fail(const std::string& reason)
{
  require_all_failed(ranks_, reason);
  if (is_path() || record_.levels.empty())
  {
    record_.status = certify::RunStatus::failed;
    record_.reason = reason;
  }
  write_what_holds();
}

template class RunReport<2>;
template class RunReport<3>;

}  // namespace tribound::app
