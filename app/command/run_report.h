#pragma once

/// @file run_report.h
/// What a run tells and leaves behind, level by level or load step by load step.

#include <exception>
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
#include "tribound/io/record/report.h"

namespace tribound::app
{

/// What a run says on stdout.
enum class Printed
{
  everything,
  levels,   ///< a line per level, as a part of something larger
  verdict,  ///< status and warnings at the end
  nothing
};

/// Keeps the record of a run and writes the files, level by level: beside the computation of the next level
/// where OpenMP offers a second thread. The files do not depend on that. A load step is a level of its pass
/// over the history; the files of passes after the first take the place of those before once they are
/// complete.
///
/// What the directory holds never says more than its certificate: that is there before the fields of its
/// last level, and what described another level is removed before it changes.
///
/// On several ranks, which call the members together, the first prints and writes, and each writes the fields
/// on its own cells. What is shown of the solution as one, contact and the page, comes from cells that are
/// gathered on the first: all, or of large meshes those at the boundary.
template <int dim>
class RunReport
{
 public:
  /// On the first mesh; `slides`: doctor::slides_as_a_whole(); the run began at `begin`. Removes what an
  /// earlier run has left in the directory, the certificate first, unless this one goes on with it. Throws
  /// InputError where nothing can be written.
  RunReport(const case_file::Config& config, const problem::Problem<dim>& problem,
            const adapt::Discretisation<dim>& first, std::vector<bool> slides, Clock::time_point begin,
            Printed printed = Printed::everything, const Restart* restart = nullptr);

  /// After every level, and once more for the last one if Newton's method has converged on it later; after
  /// every load `step`, of which `view` is then: tables and a certificate that holds should the program be
  /// killed, at most a second behind; fields where they are asked for of all levels, and of all load steps.
  /// Waits for the files of the level before. Throws WriteError, the level being printed, for its own files
  /// or later for those of the level before.
  void add(const adapt::LevelView<dim>& view, const adapt::LoadStep<dim>* step = nullptr);
  /// What tells it all that happens along a path, and leaves a checkpoint after each step where there are to
  /// be some.
  [[nodiscard]] adapt::ReplayObserver<dim> path_observer(const adapt::StepObserver& newton);
  /// What the next level starts from; where it cannot be written, what holds is. Throws WriteError.
  void write_checkpoint(const adapt::Levels<dim>& next);
  /// The mesh of the last load step of what holds; null where this run has solved none.
  [[nodiscard]] std::shared_ptr<const adapt::Grid<dim>> last_grid() const
  {
    return in_work_.last ? in_work_.last->discrete->grid : nullptr;
  }
  /// Writes all that there is, before what may follow such as the check of a history.
  void end(const certify::Verdict& verdict);
  /// Whether there is nothing new, and the path was followed once more before.
  [[nodiscard]] bool has_check() const;
  /// What came of the path followed once more. Throws WriteError.
  void add_check(io::HistoryCheck check);
  /// A mesh that is begun on, and a level, where the run tells everything.
  void print_mesh(const std::string& caption, const adapt::Grid<dim>& grid) const;
  void print_level(const io::LevelRecord& level) const;

  /// Which level is the last is known only now: its fields, the page, and the last word.
  [[nodiscard]] ExitCode close(const certify::Verdict& verdict);
  /// The files of what is complete so far, where the run ends by an exception; without any level, or where a
  /// path was not followed to its end, a certificate of the failure. Throws WriteError.
  void fail(const std::string& reason);

  [[nodiscard]] const io::RunRecord& record() const { return record_; }

 private:
  /// What the levels, or the load steps of a pass, leave beside the record.
  struct Pass
  {
    explicit Pass(const case_file::OutputConfig& output);

    ReportPage page;
    std::shared_ptr<const KeptLevel<dim>> last{};   ///< the last one, of levels the last with a bound
    std::shared_ptr<const KeptLevel<dim>> shown{};  ///< what the first rank shows of it
  };

  [[nodiscard]] bool is_path() const { return config_.history.has_value(); }
  /// Whether every level has fields.
  [[nodiscard]] bool writes_all() const
  {
    return is_path() || config_.output.levels == case_file::FieldLevels::all;
  }
  [[nodiscard]] bool is_restarted() const { return record_.earlier.first_cells > 0; }
  /// Where fields are written: those of later passes apart until they are complete.
  [[nodiscard]] std::filesystem::path fields_directory() const;
  [[nodiscard]] io::LevelRecord record_of(const adapt::LevelView<dim>& view,
                                          const adapt::LoadStep<dim>* step) const;
  /// Those about the last level.
  void update_warnings(const adapt::LevelView<dim>& view);
  void write_fields(const KeptLevel<dim>& level, const KeptLevel<dim>* shown) const;
  /// Hands the fields of the last level to the background.
  void start_writing();
  /// Waits for them; their time goes to the last level. What writing has thrown.
  [[nodiscard]] std::exception_ptr finish_writing();
  /// On all ranks, if there is one on any.
  void rethrow(const std::exception_ptr& failure) const;
  /// Tables and certificate, then the fields of load steps that have waited for them.
  void write_record();
  /// Whether this run has something that the directory does not hold.
  [[nodiscard]] bool has_news() const;
  void write_what_holds();
  void write_page();
  /// Whether tables and certificate are to be written before the fields of the last level.
  [[nodiscard]] bool is_due() const;
  /// Before the files of the last level: of the first one after a restart, removes what a run that went
  /// another way from there has left.
  void make_room();
  /// Removes the record of the level, if it is the last, and returns its times.
  io::LevelTimes take_back(int number);
  /// The times of the last level get the wall time since `begin`, which begins anew, and the CPU time since
  /// the last call.
  void count_time(Clock::time_point& begin);

  void begin_pass(int pass, const adapt::Grid<dim>& grid);
  void write_checkpoint(const adapt::ReplayState<dim>& state);
  /// Notes the pass, or the mesh, by its worst step.
  void add_mesh(const adapt::PassView<dim>& pass);
  void complete(const adapt::PassView<dim>& pass);
  void hand_over_pass();
  /// The pass in work leads nowhere: the one before is what holds, where it is there.
  bool give_up();

  const case_file::Config& config_;
  Ranks ranks_;
  Printed printed_;
  std::unique_ptr<io::OutputDirectory> directory_;
  io::RunRecord record_;  ///< with the levels, or the load steps of the pass in work
  Point<dim> moment_about_;
  std::vector<bool> slides_;
  Pass in_work_;
  std::optional<std::pair<io::RunRecord, Pass>> before_;  ///< the last complete one, while another is in work
  bool is_resumed_ = false;                               ///< until the first pass begins
  bool has_old_files_ = false;                            ///< after a restart, until there is something new
  int n_earlier_steps_ = 0;                               ///< load steps before it
  bool is_ended_ = false;                                 ///< whether all that there is is written
  bool is_apart_ = false;         ///< whether the pass in work is written apart until it is complete
  bool directory_holds_ = false;  ///< what the run before this one has left there
  Clock::time_point written_ = Clock::now();  ///< when the record was; at first when the run began
  double cost_ = 0;                           ///< how long that took; s
  bool must_write_ = false;                   ///< whether the one that is there does not hold any more
  double held_ = 0;                    ///< wall time that the loop has been held up on the last level; s
  double cpu_before_ = cpu_seconds();  ///< CPU time up to the level in work
  double writing_ = 0;                 ///< wall time of what the background writes; s
  double writing_cpu_ = 0;
  Background background_;  ///< the last member: it ends before what its jobs use
};

}  // namespace tribound::app
