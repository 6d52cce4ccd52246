#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "app/command/run_report.h"
#include "app/command/study_cases.h"
#include "app/command/with_case.h"
#include "app/console/console.h"
#include "app/console/text.h"
#include "app/output_directory.h"
#include "app/page/report_page.h"
#include "app/result/study.h"
#include "app/shared_file.h"
#include "tribound/adapt/loop.h"
#include "tribound/algebra/petsc.h"
#include "tribound/base/clock.h"
#include "tribound/case/quantity_reader.h"
#include "tribound/case/resolve.h"
#include "tribound/certify/truth/solution_error.h"
#include "tribound/doctor/support_facts.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/record/error_bars.h"
#include "tribound/mesh/bisect.h"

namespace tribound::app
{

namespace
{

/// A completed run.
template <int dim>
struct FinishedRun
{
  certify::Verdict verdict{certify::RunStatus::failed, {}};
  std::vector<io::LevelRecord> records;
  std::vector<KeptLevel<dim>> levels;
};

/// The richest space of at most `max_dofs` in which the dual norm can be computed, if there is one.
template <int dim>
std::optional<certify::RicherSpace> dual_space(const fem::LagrangeSpace<dim>& space, long max_dofs)
{
  for (const int refinements : {2, 1})
    for (const int further : {2, 1})
    {
      const certify::RicherSpace richer = {.refinements = refinements, .degree = space.degree() + further};
      if (certify::count_dofs(space.mesh(), richer) <= static_cast<double>(max_dofs)) return richer;
    }
  return std::nullopt;
}

template <int dim>
class StudyCommand
{
 public:
  StudyCommand(const case_file::Config& config, mesh::Mesh<dim> mesh, const Progress& progress)
      : config_(config),
        mesh_(std::move(mesh)),
        problem_(case_file::resolve(config, mesh_)),
        quantities_(case_file::resolve_quantities<dim>(config, problem_, mesh_.boundary_names())),
        progress_(progress),
        stop_(stop_on_signals())
  {
    study_.facts = case_file::case_facts(config, dim);
    study_.effective = config.effective;
    study_.effective.files = io::hashed_files(case_file::files_of(config));
    study_.case_file = effective_file_name(config);
    study_.build = io::build_facts();
    study_.gamma_lin = config.method.stopping.gamma_lin;
    study_.marking = config.adapt.marking.strategy == adapt::Marking::doerfler ? "doerfler" : "maximum";
    study_.theta = config.adapt.marking.theta;
  }

  ExitCode run()
  {
    const io::OutputDirectory directory(config_.output.directory);
    io::remove_results(config_.output.directory, {"study.json", "study.csv", "report.html", "report.pdf"});
    for (const char* name : variant_names)
      if (!stop_) solve_variant(name);
    if (!stop_) solve_reference();
    measure();
    if (stop_) study_.interruption = "by a signal; what was complete is in the tables";
    study_.times.emplace_back("total", seconds_since(begin_));
    write();
    print(study_text(study_, config_.output.directory.string()));
    if (config_.study.figures && !stop_) draw_figures(config_.output.directory);
    write_page();
    return exit_code();
  }

 private:
  /// Runs like `tribound run`, from the mesh of the case. `own_limit`: end of the reason for a limit that is
  /// not from the case; `keeps_all`: keeps all levels, else the last.
  FinishedRun<dim> adapt_and_report(const case_file::Config& config, bool keeps_all,
                                    const std::string& own_limit = {})
  {
    FinishedRun<dim> finished;
    // Without marked cells, bisection copies the mesh.
    auto first = std::make_unique<adapt::Discretisation<dim>>(mesh::bisect<dim>(mesh_, {}).mesh, problem_,
                                                              config.method);
    adapt::Levels<dim> levels(problem_, config.method, config.adapt.tolerance, std::move(first), &stop_);
    RunReport<dim> report(config, problem_, levels.discrete(),
                          doctor::slides_as_a_whole<dim>(problem_, levels.discrete().mesh), Clock::now(),
                          Printed::levels);
    levels.ask_for(config.adapt.bars, quantities_);
    adapt::Strategy<dim> strategy = adapt::make_strategy<dim>(config.adapt, &stop_);
    strategy.observer = {progress_, [&](const adapt::LevelView<dim>& view)
                         {
                           report.add(view);
                           if (!keeps_all) finished.levels.clear();
                           finished.levels.emplace_back(view);
                           if (!config.output.vtu) finished.levels.back().level.stress = {};
                         }};
    try
    {
      finished.verdict = adapt::adapt(levels, strategy);
      if (!own_limit.empty() && finished.verdict.reason.ends_with(own_limit))
        finished.verdict.reason = "as large as the last adaptive mesh, there the comparison ends";
      (void)report.close(finished.verdict);
    }
    catch (const SolveError& error)
    {
      report.fail(error.what());
      finished.verdict = {certify::RunStatus::failed, error.what()};
    }
    finished.records = report.record().levels;
    return finished;
  }

  void solve_variant(const std::string& name)
  {
    case_file::Config variant = variant_config(config_, name);
    print(line("variant", name));
    std::string own_limit;
    if (variant.adapt.marking.strategy == adapt::Marking::uniform && !study_.variants[0].levels.empty())
    {
      // The level whose size is nearest to that of the last adaptive one: the next would be 2^dim times
      // larger.
      const double size = std::sqrt(std::exp2(dim)) * study_.variants[0].levels.back().record.dofs;
      if (std::lround(size) < variant.adapt.max_dofs)
        own_limit = fmt::format("adapt.max_dofs = {}", std::lround(size));
      variant.adapt.max_dofs = std::min(variant.adapt.max_dofs, std::lround(size));
    }
    const Clock::time_point begin = Clock::now();
    FinishedRun<dim> finished = adapt_and_report(variant, true, own_limit);
    study_.times.emplace_back(name, seconds_since(begin));
    StudyVariant& result = study_.variants.emplace_back();
    result.name = name;
    result.status = finished.verdict.status;
    result.reason = finished.verdict.reason;
    for (io::LevelRecord& record : finished.records) result.levels.push_back({std::move(record), {}, {}});
    levels_.push_back(std::move(finished.levels));
    write();
  }

  void solve_reference()
  {
    double smallest = std::numeric_limits<double>::infinity();
    for (const StudyVariant& variant : study_.variants)
      for (const StudiedLevel& level : variant.levels)
        smallest = std::min(smallest, io::relative_bound(level.record).value_or(smallest));
    if (!std::isfinite(smallest)) return;
    constexpr double round_off = 1e-10;
    const double required = std::max(config_.study.reference_factor * smallest, round_off);
    const case_file::Config config = reference_config(config_, required);
    print(line("reference",
               fmt::format("degree {}, to a bound of {:.3g} of ||sigma||", config.method.degree, required)));
    const Clock::time_point begin = Clock::now();
    FinishedRun<dim> finished = adapt_and_report(config, false);
    study_.times.emplace_back("reference", seconds_since(begin));
    if (stop_ || !certify::is_bound(finished.verdict.status)) return;
    StudyReference& reference = study_.reference.emplace();
    reference.degree = config.method.degree;
    reference.level = finished.records.back();
    reference.required = required;
    reference.fine_enough = finished.verdict.status == certify::RunStatus::certified;
    reference.reason = finished.verdict.reason;
    reference_ = std::move(finished.levels.back());
  }

  /// Errors and dual norms of all levels of all variants.
  void measure()
  {
    const Clock::time_point begin = Clock::now();
    for (std::size_t variant = 0; variant < levels_.size(); ++variant)
    {
      if (!stop_) progress_.stage(fmt::format("errors of the variant {}", variant_names[variant]));
      for (std::size_t number = 0; number < levels_[variant].size() && !stop_; ++number)
        measure(variant, number);
      show_errors(study_.variants[variant]);
      levels_[variant].clear();
      write();
    }
    study_.times.emplace_back("errors", seconds_since(begin));
  }

  /// Adds the errors to the report page of the variant.
  void show_errors(const StudyVariant& variant) const
  {
    std::vector<TrueErrors> errors;
    for (const StudiedLevel& level : variant.levels)
      errors.push_back({level.record.level, level.error ? std::optional(level.error->stress) : std::nullopt,
                        level.dual_norm});
    add_true_errors(config_.output.directory / variant.name / "report.html", errors);
  }

  void measure(std::size_t variant, std::size_t number)
  {
    const KeptLevel<dim>& kept = levels_[variant][number];
    const adapt::Discretisation<dim>& discrete = *kept.discrete;
    StudiedLevel& result = study_.variants[variant].levels[number];
    if (!result.record.bound) return;
    if (const auto space = dual_space(discrete.space, config_.study.dual_norm_dofs))
      result.dual_norm = certify::DualNorm<dim>(discrete.form, *space)(kept.level.u);
    if (!reference_) return;
    const certify::LocalError error = certify::solution_error<dim>(
        problem_, discrete.space, kept.level.u, reference_->discrete->space, reference_->level.u);
    result.error = error.global;
    result.error->energy *= std::sqrt(problem_.full_circle());
    result.intervals_agree = io::intervals_agree(result.record, study_.reference->level);
    const case_file::Config config = variant_config(config_, study_.variants[variant].name);
    if (config.output.vtu)
      kept.write_fields(config.output.directory,
                        {{{"energy_error", error.energy}, {"stress_error", error.stress}}});
  }

  /// Writes what is complete so far.
  void write() const
  {
    io::write_file(config_.output.directory / study_.case_file, study_.effective.text);
    io::write_file(config_.output.directory / "study.csv", study_csv(study_));
    io::write_file(config_.output.directory / "study.json", study_json(study_));
    write_page();
  }

  void write_page() const
  {
    if (config_.output.report)
      write_study_page(find_shared_file("report.html"), config_.output.directory, study_);
  }

  ExitCode exit_code() const
  {
    const bool failed = !std::ranges::all_of(study_.variants, certify::is_bound, &StudyVariant::status);
    if (failed || !violation(study_).empty()) return ExitCode::failed;
    const bool reached =
        !stop_ && std::ranges::all_of(study_.variants,
                                      [](const StudyVariant& variant) {
                                        return variant.name.starts_with("uniform") ||
                                               variant.status == certify::RunStatus::certified;
                                      });
    return reached ? ExitCode::success : ExitCode::budget_used_up;
  }

  const case_file::Config& config_;
  mesh::Mesh<dim> mesh_;
  problem::Problem<dim> problem_;
  std::vector<problem::Quantity<dim>> quantities_;
  const Progress& progress_;
  const std::atomic<bool>& stop_;
  Clock::time_point begin_ = Clock::now();
  Study study_;
  std::vector<std::vector<KeptLevel<dim>>> levels_;  ///< of each variant
  std::optional<KeptLevel<dim>> reference_;
};

template <int dim>
ExitCode study(const case_file::Config& config, mesh::Mesh<dim> mesh, const Progress& progress)
{
  if (config.adapt.marking.strategy == adapt::Marking::uniform)
    throw InputError({.file = config.file, .key = "adapt.marking"}, "is \"uniform\"",
                     "the study compares an adaptive marking, such as \"doerfler\", with uniform refinement");
  if (config.history)
    throw InputError(
        {.file = config.file, .key = "history"}, "a study is of a single load step",
        "tribound run, which refines the mesh for all steps; tribound verify for their true errors");
  return StudyCommand<dim>(config, std::move(mesh), progress).run();
}

}  // namespace

ExitCode study(const CaseRequest& request)
{
  return with_case(request, &stop_on_signals(),
                   [&]<int dim>(const case_file::Config& config, mesh::Mesh<dim> mesh)
                   {
                     const algebra::Environment environment;
                     return study<dim>(config, std::move(mesh), Progress(request.quiet));
                   });
}

}  // namespace tribound::app
