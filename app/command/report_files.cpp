/// @file report_files.cpp
/// The files of a run, written in an order such that they never claim more than the certificate: files about
/// another level are removed, then the certificate is written, then the fields.

#include <algorithm>
#include <exception>
#include <filesystem>
#include <utility>

#include "app/command/run_report.h"
#include "tribound/io/fields/vtu.h"

namespace tribound::app
{

namespace
{

/// Seconds of work that a killed program may lose. The first levels take less time than writing files.
constexpr double most_lost = 1.0;

/// Certificate and tables, whose size grows with the number of load steps, are rewritten only after this many
/// times their writing time, so that they never take more than a small part of a run.
constexpr double least_share = 20;

/// Removes files that show only the last level.
void remove_last_shown(const std::filesystem::path& directory)
{
  io::remove_results(directory, {"contact.csv", "adapted.msh", "report.html", "report.pdf"});
}

/// Returns the exception of writing, to be rethrown on all ranks once the level is printed.
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
std::filesystem::path RunReport<dim>::fields_directory() const
{
  const std::filesystem::path& directory = config_.output.directory;
  return is_path() ? directory / (is_apart_ ? io::unfinished_pass : io::unfinished_steps) : directory;
}

template <int dim>
void RunReport<dim>::write_fields(const KeptLevel<dim>& level, const KeptLevel<dim>* shown) const
{
  if (!config_.output.vtu) return;
  const std::filesystem::path directory = fields_directory();
  level.write_fields(directory);
  if (shown == nullptr) return;
  io::write_contact_vtu<dim>(directory / io::level_file_name("contact", level.number), level.place(),
                             shown->discrete->form, shown->level.u);
  if (!is_path()) io::write_series(directory, writes_all() ? 0 : level.number, level.number);
}

template <int dim>
bool RunReport<dim>::is_due() const
{
  const bool is_late = seconds_since(written_) > std::max(most_lost, least_share * cost_);
  return !is_apart_ && ranks_.first_says(is_late || must_write_ || (writes_all() && !is_path()));
}

template <int dim>
void RunReport<dim>::make_room()
{
  const bool is_first = std::exchange(has_old_files_, false);
  ranks_.on_first(
      [&]
      {
        const std::filesystem::path& directory = config_.output.directory;
        const int first = record_.levels.front().level;
        if (!is_apart_ && (is_path() || record_.levels.back().bound)) remove_last_shown(directory);
        if (is_first && is_path()) io::remove_series(fields_directory(), first);
        if (is_first && !is_apart_)
        {
          io::remove_series(directory, writes_all() ? first : 0);
          io::remove_series_directory(directory / io::unfinished_pass);
        }
      });
  must_write_ = must_write_ || is_first;  // the certificate that is there is of what was removed
}

/// The files of a complete pass replace those of the previous one, after the certificate.
template <int dim>
void RunReport<dim>::hand_over_pass()
{
  if (!std::exchange(is_apart_, false)) return;
  ranks_.on_first(
      [&]
      {
        const std::filesystem::path& directory = config_.output.directory;
        remove_last_shown(directory);
        io::remove_series(directory);
        io::make_series_directory(directory / io::unfinished_steps);
        io::move_series(directory / io::unfinished_pass, directory / io::unfinished_steps);
      });
}

template <int dim>
void RunReport<dim>::start_writing()
{
  const bool is_kept = is_path() || record_.levels.back().bound;
  const bool has_files = is_kept && writes_all() && !is_path();
  if (has_files && ranks_.size() > 1) in_work_.last->write_mesh(config_);  // all together: not in background
  background_.start(
      [this, has_files, level = is_kept ? in_work_.last : nullptr, shown = is_kept ? in_work_.shown : nullptr,
       is_followed = is_path() || record_.status == certify::RunStatus::budget]
      {
        const ScopedTimer timer(writing_, writing_cpu_, thread_cpu_seconds);
        if (level && writes_all()) write_fields(*level, shown.get());
        if (has_files && ranks_.size() == 1) level->write_mesh(config_);
        if (has_files && shown) shown->write_contact(config_.output.directory);
        if (shown && is_followed && shown->fits_page())
          in_work_.page.add(shown->number, shown->discrete->form, shown->level);
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
void RunReport<dim>::write_record()
{
  const std::filesystem::path& directory = config_.output.directory;
  const std::filesystem::path steps = directory / io::unfinished_steps;
  const Clock::time_point begin = Clock::now();
  ranks_.on_first(
      [&]
      {
        io::write_report(directory, record_);
        if (!is_path() || !std::filesystem::exists(steps)) return;
        io::move_series(steps, directory);
        const int last = record_.levels.empty() ? n_earlier_steps_ : record_.levels.back().level;
        if (config_.output.vtu) io::write_series(directory, 1, last, "step");
      });
  written_ = Clock::now();
  cost_ = seconds_since(begin);
  must_write_ = false;
}

template <int dim>
bool RunReport<dim>::has_news() const
{
  if (directory_holds_) return false;
  if (!is_restarted() || !record_.levels.empty()) return true;
  // Left by a run that was killed between its last step and the certificate.
  const std::filesystem::path steps = config_.output.directory / io::unfinished_steps;
  return is_path() && ranks_.on_first([&] { return std::filesystem::exists(steps); });
}

template <int dim>
void RunReport<dim>::write_what_holds()
{
  Clock::time_point begin = Clock::now();
  give_up();
  std::exception_ptr failure = finish_writing();
  if (!has_news()) return rethrow(failure);
  write_record();
  const KeptLevel<dim>* last = in_work_.last.get();
  const KeptLevel<dim>* shown = in_work_.shown.get();
  const auto timed = [&](const auto& work)
  {
    io::LevelTimes& times = record_.levels.back().times;
    const ScopedTimer timer(times.stages.output, times.output_cpu, thread_cpu_seconds);
    if (const std::exception_ptr thrown = failure_of(work)) failure = thrown;
  };
  if (last && !writes_all()) timed([&] { write_fields(*last, shown); });
  if (last && (is_path() || !writes_all())) timed([&] { last->write_mesh(config_); });
  if (shown && (is_path() || !writes_all())) timed([&] { shown->write_contact(config_.output.directory); });
  if (shown && shown->fits_page())
    timed([&] { in_work_.page.add_last(shown->number, shown->discrete->form, shown->level); });
  if (!record_.levels.empty()) count_time(begin);
  write_page();
  rethrow(failure);
}

/// The certificate, now with the times of all files, and the page.
template <int dim>
void RunReport<dim>::write_page()
{
  ranks_.on_first(
      [&]
      {
        io::write_report(config_.output.directory, record_);
        if (!is_restarted() || !record_.levels.empty())
          in_work_.page.write(config_.output.directory, record_);
      });
}

template std::filesystem::path RunReport<2>::fields_directory() const;
template bool RunReport<2>::is_due() const;
template void RunReport<2>::make_room();
template void RunReport<2>::hand_over_pass();
template void RunReport<2>::start_writing();
template std::exception_ptr RunReport<2>::finish_writing();
template void RunReport<2>::write_record();
template bool RunReport<2>::has_news() const;
template void RunReport<2>::write_what_holds();
template void RunReport<2>::write_page();
template std::filesystem::path RunReport<3>::fields_directory() const;
template bool RunReport<3>::is_due() const;
template void RunReport<3>::make_room();
template void RunReport<3>::hand_over_pass();
template void RunReport<3>::start_writing();
template std::exception_ptr RunReport<3>::finish_writing();
template void RunReport<3>::write_record();
template bool RunReport<3>::has_news() const;
template void RunReport<3>::write_what_holds();
template void RunReport<3>::write_page();

}  // namespace tribound::app
