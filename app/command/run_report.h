#pragma once

/// @file run_report.h
/// The output of a run, level by level or load step by load step.

#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/background.h"
#include "app/command/level_files.h"
#include "app/command/run.h"
#include "app/output_directory.h"
#include "app/page/report_page.h"
#include "tribound/adapt/loop.h"
#include "tribound/adapt/replay.h"
#include "tribound/base/clock.h"
#include "tribound/case/config.h"
#include "tribound/io/record/observations.h"
#include "tribound/io/record/report.h"

namespace tribound::app
{

/// The amount of output on stdout.
enum class Printed
{
  everything,
  levels,   ///< a line per level, when part of a larger run
  verdict,  ///< status and warnings at the end
  nothing
};

/// Keeps the record of a run and writes the files, level by level, in parallel with the computation of the
/// next level where OpenMP offers a second thread. The files do not depend on that. A load step is a level of
/// its pass over the history; the files of a later pass replace those of the previous one once it is
/// complete.
///
/// The directory never contains more than the certificate claims: this exists before the fields of its last
/// level, and files about another level are removed before it changes.
///
/// On several ranks, which call the members together, the first prints and writes, and each writes the fields
/// on its own cells. Contact and the page show the solution as a whole, from cells gathered on the first
/// rank: all cells, or those at the boundary for large meshes.
template <int dim>
class RunReport
{
 public:
  /// Starts on the first mesh; `slides`: doctor::slides_as_a_whole(); the run began at `begin`. Removes the
  /// results of an earlier run from the directory, the certificate first, unless this run continues it.
  /// Throws InputError where nothing can be written.
  RunReport(const case_file::Config& config, const problem::Problem<dim>& problem,
            const adapt::Discretisation<dim>& first, std::vector<bool> slides, Clock::time_point begin,
            Printed printed = Printed::everything, const Restart* restart = nullptr);

  /// From now on add() calls `watcher`, unless it is empty, with every level that has a bound, and with every
  /// load step. What is passed keeps the problem, to which the level refers.
  void watch(std::shared_ptr<const problem::Problem<dim>> problem,
             const std::function<void(const std::shared_ptr<const KeptLevel<dim>>&, const io::LevelRecord&)>&
                 watcher);
  /// To be called after every level, and once more for the last one if Newton's method has converged on it
  /// later; also after every load `step`, of which `view` is then. Writes tables and a certificate that is
  /// valid should the program be killed, at most a second behind; fields where requested for all levels, and
  /// of all load steps. Waits for the files of the previous level. Throws WriteError, after printing the
  /// level, for its own files or, later, for those of the previous level.
  void add(const adapt::LevelView<dim>& view, const adapt::LoadStep<dim>* step = nullptr);
  /// Reports all events along a path, and writes a checkpoint after each step if requested.
  [[nodiscard]] adapt::ReplayObserver<dim> path_observer(const adapt::StepObserver& newton);
  /// Writes the state from which the next level starts; if that fails, first writes the valid results. Throws
  /// WriteError.
  void write_checkpoint(const adapt::Levels<dim>& next);
  /// The mesh of the last valid load step; null where this run has solved none.
  [[nodiscard]] std::shared_ptr<const adapt::Grid<dim>> last_grid() const
  {
    return in_work_.last ? in_work_.last->discrete->grid : nullptr;
  }
  /// Writes everything available, before a further stage such as the check of a history.
  void end(const certify::Verdict& verdict);
  /// Whether there is nothing new, and the path has already been checked.
  [[nodiscard]] bool has_check() const;
  /// Adds the result of the check of the path. Throws WriteError.
  void add_check(io::HistoryCheck check);
  /// Print a new mesh, and a level, where the run prints everything.
  void print_mesh(const std::string& caption, const adapt::Grid<dim>& grid) const;
  void print_level(const io::LevelRecord& level) const;

  /// To be called when the last level is known: writes its fields, the page, and the final output.
  [[nodiscard]] ExitCode close(const certify::Verdict& verdict);
  /// Writes the files of what is complete so far, where the run ends by an exception. Without any level, or
  /// for an incomplete path, writes a certificate of the failure. Throws WriteError.
  void fail(const std::string& reason);

  [[nodiscard]] const io::RunRecord& record() const { return record_; }

 private:
  /// Data of the levels, or of the load steps of a pass, in addition to the record.
  struct Pass
  {
    explicit Pass(const case_file::OutputConfig& output);

    ReportPage page;
    std::shared_ptr<const KeptLevel<dim>> last{};   ///< the last one; for levels the last with a bound
    std::shared_ptr<const KeptLevel<dim>> shown{};  ///< what the first rank shows of it
  };

  [[nodiscard]] bool is_path() const { return config_.history.has_value(); }
  /// Whether every level has fields.
  [[nodiscard]] bool writes_all() const
  {
    return is_path() || config_.output.levels == case_file::FieldLevels::all;
  }
  [[nodiscard]] bool is_restarted() const { return record_.earlier.first_cells > 0; }
  /// Where fields are written: those of later passes separately until they are complete.
  [[nodiscard]] std::filesystem::path fields_directory() const;
  [[nodiscard]] io::LevelRecord record_of(const adapt::LevelView<dim>& view,
                                          const adapt::LoadStep<dim>* step) const;
  /// Updates the warnings about the last level.
  void update_warnings(const adapt::LevelView<dim>& view);
  void write_fields(const KeptLevel<dim>& level, const KeptLevel<dim>* shown) const;
  /// Passes the fields of the last level to the background.
  void start_writing();
  /// Waits for them; their time is added to the last level. Returns the exception of writing.
  [[nodiscard]] std::exception_ptr finish_writing();
  /// Rethrows on all ranks, if there is one on any.
  void rethrow(const std::exception_ptr& failure) const;
  /// Writes tables and certificate, then the fields of load steps that have waited for them.
  void write_record();
  /// Whether this run has results that are not in the directory.
  [[nodiscard]] bool has_news() const;
  void write_what_holds();
  void write_page();
  /// Whether tables and certificate must be written before the fields of the last level.
  [[nodiscard]] bool is_due() const;
  /// Called before writing the files of the last level. For the first one after a restart, removes the files
  /// left by a run that continued differently from there.
  void make_room();
  /// Removes the record of the level, if it is the last, and returns its times.
  io::LevelTimes take_back(int number);
  /// Adds to the times of the last level the wall time since `begin`, which is reset, and the CPU time since
  /// the last call.
  void count_time(Clock::time_point& begin);

  void begin_pass(int pass, const adapt::Grid<dim>& grid);
  void write_checkpoint(const adapt::ReplayState<dim>& state);
  /// Notes the pass, or the mesh, by its worst step.
  void add_mesh(const adapt::PassView<dim>& pass);
  void complete(const adapt::PassView<dim>& pass);
  void hand_over_pass();
  /// Abandons the current pass: the previous one is valid, if there is one.
  bool give_up();

  const case_file::Config& config_;
  Ranks ranks_;
  Printed printed_;
  std::unique_ptr<io::OutputDirectory> directory_;
  io::RunRecord record_;  ///< with the levels, or the load steps of the current pass
  Point<dim> moment_about_;
  io::Observations<dim> observations_;
  std::vector<bool> slides_;
  Pass in_work_;
  std::optional<std::pair<io::RunRecord, Pass>> before_;  ///< the last complete one, during another
  bool is_resumed_ = false;                               ///< until the first pass begins
  bool has_old_files_ = false;                            ///< after a restart, until there are new results
  int n_earlier_steps_ = 0;                               ///< load steps before it
  bool is_ended_ = false;                                 ///< whether everything available is written
  bool is_apart_ = false;         ///< whether the current pass is written separately until it is complete
  bool directory_holds_ = false;  ///< results left there by the previous run
  Clock::time_point written_ = Clock::now();  ///< when the record was written; initially the start of the run
  double cost_ = 0;                           ///< time to write it; s
  bool must_write_ = false;                   ///< whether the existing one is no longer valid
  double held_ = 0;                    ///< wall time for which the loop was delayed on the last level; s
  double cpu_before_ = cpu_seconds();  ///< CPU time before the current level
  int factored_before_ = 0;            ///< matrices factored before it
  double writing_ = 0;                 ///< wall time of writing in the background; s
  double writing_cpu_ = 0;
  std::function<void()> watcher_;  ///< of the last level
  Background background_;          ///< the last member, so that it is destroyed before the data of its jobs
};

}  // namespace tribound::app
