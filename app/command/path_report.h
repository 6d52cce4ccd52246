#pragma once

/// @file path_report.h
/// What a run over load steps tells and leaves behind, step by step and pass by pass.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/command/report_parts.h"
#include "app/command/run.h"
#include "app/page/report_page.h"
#include "tribound/adapt/replay.h"
#include "tribound/io/state/checkpoint.h"

namespace tribound::app
{

/// In the directory of results: the files of a pass in work, after the first.
inline constexpr const char* unfinished_pass = "unfinished_pass";

/// Keeps the record of a run over a history and writes its files: during the first pass step by step, so that
/// what there is holds should the program be killed, later passes in the place of the one before once they
/// are complete. On several ranks, which call the members together, the first prints and writes, and each
/// writes the fields on its own cells.
template <int dim>
class PathReport
{
 public:
  /// `slides`: doctor::slides_as_a_whole(); the run began at `begin`. Removes what an earlier run has left in
  /// the directory, unless this one goes on with it. Throws InputError where nothing can
  /// be written.
  PathReport(const case_file::Config& config, const problem::Problem<dim>& problem,
             const adapt::Grid<dim>& first, std::vector<bool> slides, Clock::time_point begin,
             Printed printed, const Restart* restart = nullptr);

  void begin(int pass, const adapt::Grid<dim>& grid);
  /// Throws WriteError.
  void add(const adapt::LoadStep<dim>& step);
  /// What a run needs to go on from there. Throws WriteError.
  void write_checkpoint(const adapt::ReplayState<dim>& state);
  /// What came of the path of the pass in work.
  void note(const adapt::PathEnd& end);
  void complete(const adapt::PassView<dim>& pass);
  /// The path goes on on a finer mesh; `left`: what was solved on the one before.
  void refine(const adapt::PassView<dim>& left, const adapt::Grid<dim>& finer);
  /// The pass in work leads nowhere: the one before is what holds, where it is there.
  bool give_up();
  /// The mesh of the last step of what holds; null where this run has solved none.
  [[nodiscard]] std::shared_ptr<const adapt::Grid<dim>> last_grid() const;
  /// The path followed once more (adapt::follow_finely): its mesh, each of its steps, what came of it.
  void begin_check(const adapt::Grid<dim>& grid);
  void add_to_check(const adapt::LoadStep<dim>& step);
  void end_check(const adapt::PathEnd& end);
  /// The last word. Throws WriteError.
  [[nodiscard]] ExitCode close(const certify::Verdict& verdict);
  /// The files of the steps so far, where the run ends by an exception.
  void fail(const std::string& reason);

 private:
  /// What the steps of a pass leave beside the record.
  struct Pass
  {
    Pass(int n, const std::filesystem::path& page_template) : number(n), page(page_template) {}

    int number;
    ReportPage page;
    std::shared_ptr<const KeptLevel<dim>> last{};   ///< the last step
    std::shared_ptr<const KeptLevel<dim>> shown{};  ///< what the first rank shows of it
  };

  /// Where fields are written: those of later passes apart until they are complete.
  [[nodiscard]] std::filesystem::path fields_directory() const;
  [[nodiscard]] io::LevelRecord record_of(const adapt::LoadStep<dim>& step,
                                          const adapt::LevelView<dim>& view) const;
  void add_mesh(const adapt::PassView<dim>& pass);
  void keep(const adapt::LevelView<dim>& view, double t);
  void write_fields();
  void write_record();
  void write_what_holds();

  const case_file::OutputConfig& output_;
  const adapt::Method& method_;
  Ranks ranks_;
  Printed printed_;
  std::filesystem::path page_template_;
  std::unique_ptr<OutputDirectory> directory_;
  io::RunRecord record_;  ///< with the steps of the pass in work
  Point<dim> moment_about_;
  std::vector<bool> slides_;
  std::vector<std::string> free_sides_;
  const std::vector<adapt::Watch>& watch_;
  bool carries_;  ///< whether the history goes from mesh to mesh
  Pass in_work_;
  std::optional<std::pair<io::RunRecord, Pass>> before_;  ///< the last complete one, while another is in work
  bool is_resumed_ = false;                               ///< until the first pass begins
  bool is_apart_ = false;         ///< whether the pass in work is written apart until it is complete
  bool directory_holds_ = false;  ///< what the run before this one has left there
  Clock::time_point written_ = Clock::now();
  double cpu_before_ = cpu_seconds();
};

}  // namespace tribound::app
