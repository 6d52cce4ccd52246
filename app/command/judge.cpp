#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "app/command/judged_step.h"
#include "app/command/run.h"
#include "app/command/step_pairs.h"
#include "app/command/with_case.h"
#include "app/console/text.h"
#include "app/output_directory.h"
#include "app/page/judgement_page.h"
#include "app/page/page_template.h"
#include "app/result/judged_steps.h"
#include "app/result/judgement.h"
#include "app/shared_file.h"
#include "tribound/base/sha256.h"
#include "tribound/io/fields/vtu.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/file/json.h"

namespace tribound::app
{

namespace
{

/// Numbers of theirs that the user gives: NAME=VALUE, or one for each of their steps, NAME=VALUE,VALUE.
GivenNumber parse_number(const std::string& text, std::size_t n_steps)
{
  const std::size_t sign = text.rfind('=');
  GivenNumber number{.text = text, .name = text.substr(0, sign), .values = {}};
  const char* place = sign == std::string::npos ? nullptr : text.data() + sign;
  const char* const end = text.data() + text.size();
  while (place && place != end)
  {
    double value = 0;
    const auto [stop, error] = std::from_chars(place + 1, end, value);
    const bool is_number = error == std::errc{} && (stop == end || *stop == ',') && std::isfinite(value);
    place = is_number ? stop : nullptr;
    number.values.push_back(value);
  }
  if (!place)
    throw InputError({.file = "--number " + text}, "is no number of a quantity",
                     "--number NAME=VALUE with the name of a [[quantity]] of the case");
  if (number.values.size() != n_steps)
    throw InputError(
        {.file = "--number " + text},
        fmt::format("has {} for {}", count(static_cast<long>(number.values.size()), "value", "values"),
                    count(static_cast<long>(n_steps), "step", "steps")),
        "a value for each step that is judged, between commas");
  return number;
}

/// The steps to be judged: those that belong to the load steps of the case, or the one that is chosen.
std::vector<TheirStep> chosen_steps(const JudgeRequest& request, const case_file::Config& config)
{
  if (!request.steps)
  {
    if (request.solutions.size() > 1)
      throw InputError({.file = request.solutions[1]}, "is a second solution",
                       "--steps judges a file for each load step of the case");
    return {{.file = request.solutions.front()}};
  }
  if (!config.history)
    throw InputError({.file = config.file}, "has no load steps", "without --steps its only state is judged");
  if (request.step || request.load_step)
    throw InputError({.file = "--steps"}, "judges all load steps, but one is chosen",
                     "either --steps, or --step and --load-step");
  std::vector<TheirStep> all = all_steps(request);
  std::vector<TheirStep> chosen;
  for (const std::size_t place : pair_steps(config.history->program.targets, all))
    chosen.push_back(std::move(all[place]));
  return chosen;
}

mesh::ImportedSolution solution_of(const JudgeRequest& request, TheirStep& their)
{
  if (their.solution) return *std::exchange(their.solution, std::nullopt);
  const std::optional<int> step = their.step ? their.step->number : request.step;
  return mesh::read_solution(their.file, {request.field, request.stress, step});
}

/// Meshes follow the energy error, and only sharpness and limits end the run.
void prepare_to_judge(case_file::Config& config)
{
  config.output.directory /= "judge";
  config.adapt.bars.levels = adapt::EnergyLevels::every;
  if (config.history) return;  // which refines for all of its steps, to adapt.tolerance
  config.adapt.measure = adapt::ErrorMeasure::energy;
  config.adapt.bars = {.levels = adapt::EnergyLevels::every};  // no goal and no tolerance of the case
  config.adapt.tolerance = 0;
}

/// What the run that judges calls.
template <int dim>
class Judge
{
 public:
  Judge(const JudgeRequest& request, const case_file::Config& config, mesh::Mesh<dim> mesh)
      : request_(request), case_(config, std::move(mesh))
  {
    std::vector<TheirStep> theirs = chosen_steps(request, config);
    if (request.steps) targets_ = config.history->program.targets;
    std::vector<GivenNumber> numbers;
    for (const std::string& text : request.numbers) numbers.push_back(parse_number(text, theirs.size()));
    io::HashedFile file;  // of many steps, if they stand in one
    for (std::size_t i = 0; i < theirs.size(); ++i)
    {
      if (file.name != theirs[i].file) file = {theirs[i].file, sha256(io::read_text(theirs[i].file))};
      const mesh::ImportedSolution solution = solution_of(request, theirs[i]);
      for (const std::string& text : solution.notes)
        if (!request.quiet && is_first_process()) note(text);
      const std::optional<double> t = targets_.empty() ? std::nullopt : std::optional(targets_[i]);
      steps_.push_back(std::make_unique<JudgedStep<dim>>(case_, request, file, solution, numbers, i, t));
    }
  }

  /// The level, or the load step, against theirs. Only the level of the worst step is kept.
  void operator()(const std::shared_ptr<const KeptLevel<dim>>& level, const io::LevelRecord& record)
  {
    JudgedStep<dim>* judged = step_of(*level);
    if (!judged) return;
    judged->judge(level, record);
    for (const auto& other : steps_)
      if (other.get() != judged && judged->has_level() && other->has_level())
        (judged->is_worse_than(*other) ? *other : *judged).drop_level();
  }

  /// The load steps so far are those of a whole pass.
  void accept()
  {
    for (const auto& step : steps_) step->accept();
    next_ = 0;
  }

  [[nodiscard]] std::vector<JudgementRecord> records() const
  {
    std::vector<JudgementRecord> records;
    for (const auto& step : steps_) records.push_back(step->record());
    return records;
  }
  [[nodiscard]] bool is_settled() const { return steps_.front()->record().is_settled(); }

  /// judgement.json, judgement.html with the worst step, and the fields of each.
  void write(const case_file::OutputConfig& output) const
  {
    const std::filesystem::path& directory = output.directory;
    const std::vector<JudgementRecord> records = this->records();
    const io::Json judgement =
        request_.steps ? judged_steps_object(records) : judgement_object(records.front());
    io::write_file(directory / "judgement.json", io::json_text(judgement));
    for (std::size_t i = 0; i < steps_.size(); ++i)
    {
      if (!records[i].judgement) continue;
      const std::filesystem::path own = request_.steps ? directory / judged_step_directory(i) : directory;
      io::make_series_directory(own);
      steps_[i]->write_fields(own);
    }
    const PageTemplate page(output.report ? find_shared_file("report.html") : std::filesystem::path{});
    if (!page.empty())
      write_judgement_page(page, directory, records, steps_[worst_step(records)]->surfaces());
  }

  [[nodiscard]] std::string text(const std::string& directory) const
  {
    const std::vector<JudgementRecord> records = this->records();
    return request_.steps ? judged_steps_text(records, directory)
                          : judgement_text(records.front(), directory);
  }

 private:
  /// The step of theirs that a level is compared with; null: none. Between the load steps of the case there
  /// are others where Newton's method has needed them.
  [[nodiscard]] JudgedStep<dim>* step_of(const KeptLevel<dim>& level)
  {
    if (!request_.steps)
      return level.t && request_.load_step && *request_.load_step != level.number ? nullptr
                                                                                  : steps_.front().get();
    if (next_ == targets_.size() || level.t != targets_[next_]) return nullptr;
    return steps_[next_++].get();
  }

  const JudgeRequest& request_;
  JudgedCase<dim> case_;
  std::vector<double> targets_{};                          ///< t of the load steps that are judged
  std::vector<std::unique_ptr<JudgedStep<dim>>> steps_{};  ///< theirs
  std::size_t next_ = 0;                                   ///< of them, in the pass of the run
};

ExitCode exit_code(const std::string& status)
{
  if (status == "judged" || status == "accepted") return ExitCode::success;
  return status == "rejected" ? ExitCode::rejected : ExitCode::budget_used_up;
}

template <int dim>
ExitCode judge(const JudgeRequest& request, const case_file::Config& config, mesh::Mesh<dim> mesh)
{
  Judge<dim> judge(request, config, std::move(mesh));
  RunHooks hooks{.change = prepare_to_judge, .pass = [&] { judge.accept(); }, .is_part = true};
  LoopHooks<dim>& of_dimension = hooks.of<dim>();
  of_dimension.level = [&](const auto& level, const io::LevelRecord& record) { judge(level, record); };
  if (!config.history)
    of_dimension.stop = [&](const auto&) { return judge.is_settled() ? "their solution is judged" : ""; };
  const ExitCode code = run(request, {}, hooks);
  case_file::OutputConfig output = config.output;
  output.directory /= "judge";
  if (is_first_process() && std::filesystem::exists(output.directory))
  {
    judge.write(output);
    print(judge.text(output.directory.string()));
  }
  return code == ExitCode::success || code == ExitCode::budget_used_up
             ? exit_code(common_status(judge.records()))
             : code;
}

}  // namespace

ExitCode judge(const JudgeRequest& request)
{
  return with_case(request, nullptr,
                   [&]<int dim>(const case_file::Config& config, mesh::Mesh<dim> mesh)
                   { return judge<dim>(request, config, std::move(mesh)); });
}

}  // namespace tribound::app
