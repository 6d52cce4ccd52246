#pragma once

/// @file run_report.h
/// What a run tells and leaves behind, level by level.

#include <exception>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/background.h"
#include "app/command/report_parts.h"
#include "app/command/run.h"
#include "app/page/report_page.h"
#include "tribound/adapt/loop.h"
#include "tribound/base/clock.h"
#include "tribound/case/config.h"
#include "tribound/io/record/facts.h"
#include "tribound/io/record/report.h"

namespace tribound::app
{

/// Keeps the record of a run and writes the files, level by level: beside the computation of the next level
/// where OpenMP offers a second thread. The files do not depend on that.
///
/// On several ranks, which call the members together, the first prints and writes, and each writes the fields
/// on its own cells. What is shown of the solution as one, contact and the page, comes from cells that are
/// gathered on the first: all, or of large meshes those at the boundary.
template <int dim>
class RunReport
{
 public:
  /// On the first mesh; `slides`: doctor::slides_as_a_whole(); the run began at `begin`. Removes what an
  /// earlier run has left in the directory, the certificate first, unless this one goes on with it: then
  /// `earlier` has its levels. Throws InputError where nothing can be written.
  RunReport(const case_file::Config& config, const problem::Problem<dim>& problem,
            const adapt::Discretisation<dim>& first, std::vector<bool> slides, Clock::time_point begin,
            Printed printed = Printed::everything, const io::EarlierLevels* earlier = nullptr);

  /// After every level, and once more for the last one if Newton's method has converged on it later: tables
  /// and a certificate that holds should the program be killed, at most a second behind; fields where they
  /// are asked for of all levels. Waits for the files of the level before. Throws WriteError, the level being
  /// printed, for its own files or later for those of the level before.
  void add(const adapt::LevelView<dim>& view);
  /// What the next level starts from. Throws WriteError.
  void write_checkpoint(const adapt::Levels<dim>& next);
  /// Which level is the last is known only now: its fields, the page, and the last word.
  [[nodiscard]] ExitCode close(const certify::Verdict& verdict);
  /// The files of the levels so far, where the run ends by an exception. Throws WriteError.
  void write_what_holds();
  /// The same where there is no level at all: leaves a certificate of the failure behind.
  void fail(const std::string& reason);

  [[nodiscard]] const io::RunRecord& record() const { return record_; }

 private:
  [[nodiscard]] bool writes_all_levels() const { return output_.levels == case_file::FieldLevels::all; }
  [[nodiscard]] bool is_restarted() const { return record_.earlier.first_cells > 0; }
  void write_fields(const KeptLevel<dim>& level, const KeptLevel<dim>* shown) const;
  /// Hands the files of the last level that are due to the background.
  void start_writing();
  /// Waits for them; their time goes to the last level. What writing has thrown.
  [[nodiscard]] std::exception_ptr finish_writing();
  /// On all ranks, if there is one on any.
  void rethrow(const std::exception_ptr& failure) const;
  /// Removes the record of the level, if it is the last, and returns its times.
  io::LevelTimes take_back(int number);
  /// The times of the last level get the wall time since `begin`, which begins anew, and the CPU time since
  /// the last call.
  void count_time(Clock::time_point& begin);

  const case_file::OutputConfig& output_;
  const adapt::Method& method_;
  Ranks ranks_;
  certify::ContactRule contact_rule_;
  Printed printed_;
  std::unique_ptr<OutputDirectory> directory_;
  io::RunRecord record_;
  ReportPage page_;
  std::shared_ptr<const KeptLevel<dim>> last_;   ///< the last level that has a bound
  std::shared_ptr<const KeptLevel<dim>> shown_;  ///< what the first rank shows of it
  Point<dim> moment_about_;
  std::vector<bool> slides_;
  std::vector<std::string> free_sides_;       ///< boundaries that the case does not mention
  Clock::time_point written_ = Clock::now();  ///< when the record was; at first when the run began
  double held_ = 0;                    ///< wall time that the loop has been held up on the last level; s
  double cpu_before_ = cpu_seconds();  ///< CPU time up to the level in work
  double writing_ = 0;                 ///< wall time of what the background writes; s
  double writing_cpu_ = 0;
  Background background_;  ///< the last member: it ends before what its jobs use
};

}  // namespace tribound::app
