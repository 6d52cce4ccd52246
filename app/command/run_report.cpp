#include "app/command/run_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <utility>

#include "app/console/balance_text.h"
#include "app/console/console.h"
#include "app/program_facts.h"
#include "app/shared_file.h"
#include "tribound/algebra/linear_solver.h"
#include "tribound/io/fields/vtu.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/state/checkpoint.h"

namespace tribound::app
{

namespace
{

/// Seconds of work that a program which is killed may lose: the first levels take less time than files.
constexpr double most_lost = 1.0;

/// What writing throws, to be thrown again when the level is printed, on all ranks.
template <typename Write>
std::exception_ptr failure_of(const Write& write)
{
  try
  {
    write();
  }
  catch (...)
  {
    return std::current_exception();
  }
  return nullptr;
}

}  // namespace

template <int dim>
RunReport<dim>::RunReport(const case_file::Config& config, const problem::Problem<dim>& problem,
                          const adapt::Discretisation<dim>& first, std::vector<bool> slides,
                          Clock::time_point begin, Printed printed, const io::EarlierLevels* earlier)
    : output_(config.output),
      method_(config.method),
      ranks_(first.mesh.ranks()),
      contact_rule_(config.method.contact_rule),
      printed_(printed),
      page_(config.output.report ? find_shared_file("report.html") : std::filesystem::path{}),
      moment_about_(moment_point<dim>(config.output, first.mesh)),
      slides_(std::move(slides)),
      free_sides_(free_sides(config, first.mesh.boundary_names()))
{
  ranks_.on_first([&] { directory_ = take_directory(config, earlier != nullptr); });
  record_ = first_record(config, problem, first.space, first.form.constraints(), begin);
  record_.statements = certify::statements(first.form, contact_rule_);
  record_.statements.assumptions.emplace_back(
      "linear_solver",
      describe_solver(algebra::choose_method(config.method.solver, dim, first.space.n_global_dofs())));
  if (earlier) record_.earlier = *earlier;
  if (!ranks_.is_first()) printed_ = Printed::nothing;
  if (printed_ == Printed::everything) print_header(record_.facts, record_.mesh);
}

template <int dim>
void RunReport<dim>::write_fields(const KeptLevel<dim>& level, const KeptLevel<dim>* shown) const
{
  if (shown) write_contact_and_mesh(*shown, output_, free_sides_);
  if (!output_.vtu) return;
  write_vtu_files(output_.directory, level, shown);
  if (shown) io::write_series(output_.directory, writes_all_levels() ? 0 : level.number, level.number);
}

template <int dim>
void RunReport<dim>::start_writing()
{
  std::optional<io::RunRecord> record;  // a copy, since this one goes on
  if (writes_all_levels() || seconds_since(written_) > most_lost)
  {
    record = record_;
    written_ = Clock::now();
  }
  background_.start(
      [this, record = std::move(record), level = record_.levels.back().bound ? last_ : nullptr,
       shown = record_.levels.back().bound ? shown_ : nullptr,
       is_followed = record_.status == certify::RunStatus::budget]
      {
        const ScopedTimer timer(writing_, writing_cpu_, thread_cpu_seconds);
        if (level && writes_all_levels()) write_fields(*level, shown.get());
        if (record && ranks_.is_first()) io::write_report(output_.directory, *record);
        if (shown && is_followed && fits_page(*shown))
          page_.add(shown->number, shown->discrete->form, shown->level);
      });
}

template <int dim>
std::exception_ptr RunReport<dim>::finish_writing()
{
  std::exception_ptr failure = failure_of([&] { background_.wait(); });
  if (!record_.levels.empty())
  {
    io::LevelTimes& times = record_.levels.back().times;
    times.stages.output += std::exchange(writing_, 0);
    times.output_cpu += std::exchange(writing_cpu_, 0);
  }
  return failure;
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
}

template <int dim>
void RunReport<dim>::add(const adapt::LevelView<dim>& view)
{
  Clock::time_point begin = Clock::now();
  io::LevelRecord level;
  double output = 0;
  double output_cpu = 0;
  {
    const ScopedTimer timer(output, output_cpu, thread_cpu_seconds);
    level = io::level_record<dim>(view, moment_about_, slides_);
  }
  const std::exception_ptr failure = finish_writing();
  const io::LevelTimes before = take_back(view.number);
  const bool again = before.level > 0;
  if (!again) held_ = 0;
  level.times.stages.output = before.stages.output + output;
  level.times.output_cpu = before.output_cpu + output_cpu;
  level.times.level += held_;
  level.times.level_cpu = before.level_cpu;
  record_.levels.push_back(std::move(level));
  if (record_.levels.back().bound)
  {
    shown_.reset();  // makes room for this one
    last_.reset();
    last_ = std::make_shared<const KeptLevel<dim>>(view);
    shown_ = gather(view, last_, output_, method_);
  }
  update_statements(record_, view, contact_rule_);
  record_.status = view.verdict.status;
  record_.reason = view.verdict.reason;
  ranks_.together([&] { update_warnings(record_, view, shown_.get()); });
  count_time(begin);
  if ((printed_ == Printed::everything || printed_ == Printed::levels) && !again)
    print_level(record_.levels.back());
  rethrow(failure);
  ranks_.together([&] { start_writing(); });
  count_time(begin);
}

template <int dim>
void RunReport<dim>::write_what_holds()
{
  Clock::time_point begin = Clock::now();
  std::exception_ptr failure;
  const auto timed = [this](const auto& work)
  {
    io::LevelTimes& times = record_.levels.back().times;
    const ScopedTimer timer(times.stages.output, times.output_cpu, thread_cpu_seconds);
    work();
  };
  // Fields of where the run before has stopped.
  if (last_ && !writes_all_levels() && is_restarted())
    ranks_.on_first([&] { io::remove_series(output_.directory); });
  if (last_ && !writes_all_levels())  // beside the page's data of this level
    timed([&] { failure = failure_of([&] { write_fields(*last_, shown_.get()); }); });
  if (const std::exception_ptr earlier = finish_writing()) failure = earlier;
  const auto add_last = [&] { page_.add_last(shown_->number, shown_->discrete->form, shown_->level); };
  if (shown_ && fits_page(*shown_))
    timed(
        [&]
        {
          if (const std::exception_ptr of_page = failure_of(add_last)) failure = of_page;
        });
  if (!record_.levels.empty()) count_time(begin);
  ranks_.together(
      [&]
      {
        if (ranks_.is_first())
        {
          io::write_report(output_.directory, record_);
          page_.write(output_.directory, record_);
        }
      });
  rethrow(failure);
}

template <int dim>
void RunReport<dim>::write_checkpoint(const adapt::Levels<dim>& next)
{
  rethrow(finish_writing());  // the files of the level before come first
  const fem::LagrangeSpace<dim>& space = next.discrete().space;
  io::write_checkpoint<dim>(
      output_.directory / io::checkpoint_name,
      {dim, space.degree(), next.start(), record_.effective.text, io::as_earlier(record_), {}}, space,
      {.functions = {next.start_displacement()}});
}

template <int dim>
ExitCode RunReport<dim>::close(const certify::Verdict& verdict)
{
  record_.status = verdict.status;
  record_.reason = verdict.reason;
  write_what_holds();
  print_end(record_, printed_, output_.directory);
  return exit_code(verdict.status);
}

template <int dim>
void RunReport<dim>::fail(const std::string& reason)
{
  if (is_restarted() && record_.levels.empty()) return;  // what the run before has left holds
  record_.status = certify::RunStatus::failed;
  record_.reason = reason;
  write_what_holds();
}

template class RunReport<2>;
template class RunReport<3>;

}  // namespace tribound::app
