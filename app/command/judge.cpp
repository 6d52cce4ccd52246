#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "app/command/run.h"
#include "app/command/with_case.h"
#include "app/console/console.h"
#include "app/console/text.h"
#include "app/page/judgement_page.h"
#include "app/page/page_template.h"
#include "app/result/judgement.h"
#include "app/shared_file.h"
#include "tribound/adapt/error_bars.h"
#include "tribound/case/quantity_reader.h"
#include "tribound/case/resolve.h"
#include "tribound/certify/energy/energy_bound.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/contact/nitsche/penalty.h"
#include "tribound/io/fields/vtu.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/file/json.h"
#include "tribound/io/record/error_bars.h"
#include "tribound/mesh/import/imported_solution.h"

namespace tribound::app
{

namespace
{

/// A number of theirs that the user gives: NAME=VALUE.
std::pair<std::string, double> parse_number(const std::string& text)
{
  const std::size_t sign = text.rfind('=');
  double value = 0;
  const char* end = text.data() + text.size();
  if (sign != std::string::npos)
    if (const auto [stop, error] = std::from_chars(text.data() + sign + 1, end, value);
        error == std::errc{} && stop == end && std::isfinite(value))
      return {text.substr(0, sign), value};
  throw InputError({.file = "--number " + text}, "is no number of a quantity",
                   "--number NAME=VALUE with the name of a [[quantity]] of the case");
}

/// Kinds that follow from the displacement alone.
bool follows_from_displacement(problem::QuantityKind kind)
{
  using K = problem::QuantityKind;
  return kind == K::energy || kind == K::load_work || kind == K::mean_displacement || kind == K::spring_force;
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
      : request_(request),
        mesh_(std::move(mesh)),
        problem_(case_file::resolve(config, mesh_)),
        quantities_(case_file::resolve_quantities<dim>(config, problem_, mesh_.boundary_names()))
  {
    record_.facts = case_file::case_facts(config, dim);
    record_.sharpness = config.judge.sharpness;
    record_.accept = request.accept;
    read();
    measure(config);
  }

  /// The level, or the load step, against theirs.
  void operator()(const std::shared_ptr<const KeptLevel<dim>>& kept, const io::LevelRecord& record)
  {
    const KeptLevel<dim>& level = *kept;
    if (level.t && request_.load_step && *request_.load_step != level.number) return;
    judged_ = kept;
    if (level.t) record_.load_step = level.number;
    record_.cells = static_cast<long>(level.discrete->mesh.n_global_cells());
    const std::optional<certify::EnergyBound>& energy = level.level.energy;
    if (record.balance) record_.balance(*record.balance);
    record_.judgement.reset();
    record_.reason = energy ? energy->reason : "certify.energy is off";
    if (energy) take_intervals(*energy);
    if (!record_.reason.empty()) return;
    record_.target = io::words_of(energy->target);
    // The problem of the level has the initial stress of its load step.
    record_.judgement = certify::judge<dim>(level.discrete->form.problem(), *space_, theirs_,
                                            level.discrete->space, level.level.u, energy->bound);
  }

  [[nodiscard]] JudgementRecord& record() { return record_; }

  /// judgement.json, judgement.html, judged_cells.csv, and their displacement with the distances as
  /// judged.vtu.
  void write(const case_file::OutputConfig& output) const
  {
    const std::filesystem::path& directory = output.directory;
    io::write_file(directory / "judgement.json", io::json_text(judgement_object(record_)));
    if (record_.judgement) write_fields(directory);
    const PageTemplate page(output.report ? find_shared_file("report.html") : std::filesystem::path{});
    if (!page.empty()) write_judgement_page(page, directory, record_, page_surfaces());
  }

 private:
  void write_fields(const std::filesystem::path& directory) const
  {
    const certify::Judgement& judgement = *record_.judgement;
    io::write_file(directory / "judged_cells.csv", judged_cells_csv<dim>(mesh_, judgement.displacement));
    std::vector<io::CellField> fields = {{"distance", judgement.displacement.cells}};
    if (judgement.stress) fields.push_back({"stress_distance", judgement.stress->cells});
    io::write_level_vtu<dim>({.own = directory / "judged.vtu"}, {}, problem_, *space_, theirs_.u, fields);
  }

  [[nodiscard]] io::Json page_surfaces() const
  {
    if (!record_.judgement || n_processes() > 1)
      return nullptr;  // of a mesh that is shared out there is a part
    return judged_surfaces<dim>(form(), theirs_, *record_.judgement, judged_->discrete->space,
                                judged_->level.u);
  }

  [[nodiscard]] contact::NitscheForm<dim> form() const
  {
    return {problem_, *space_, contact::default_gamma0(theirs_.degree)};
  }

  void read()
  {
    const mesh::ImportedSolution solution =
        mesh::read_solution(request_.solution, {request_.field, request_.stress, request_.step});
    for (const std::string& text : solution.notes)
      if (!request_.quiet && is_first_process()) note(text);
    theirs_ = request_.interpolate ? certify::interpolated_solution<dim>(solution, mesh_)
                                   : certify::foreign_solution<dim>(solution, mesh_);
    space_.emplace(mesh_, theirs_.degree);
    record_.solution = request_.solution;
    record_.description = solution.description;
    record_.read_as = theirs_.read_as;
    record_.node_distance = theirs_.node_distance;
    record_.curved_distance = theirs_.curved_distance;
    record_.their_cells = mesh_.n_cells();
  }

  /// Their numbers, and how far their bodies penetrate.
  void measure(const case_file::Config& config)
  {
    const contact::NitscheForm<dim> form = this->form();
    const certify::EnergyBound values =
        certify::no_energy_bound<dim>(form, theirs_.u, quantities_, "not yet judged");
    for (std::size_t i = 0; i < quantities_.size(); ++i)
    {
      JudgedNumber& number = record_.numbers.emplace_back();
      number.interval.name = values.quantities[i].name;
      number.interval.reason = "not yet judged";
      number.unit = record_.facts.unit_of(number.interval.name);
      if (follows_from_displacement(quantities_[i].kind)) number.theirs = values.quantities[i].value;
    }
    for (const std::string& text : request_.numbers)
    {
      const auto [name, value] = parse_number(text);
      const auto number =
          std::ranges::find(record_.numbers, name, [](const JudgedNumber& n) { return n.interval.name; });
      if (number == record_.numbers.end())
        throw InputError({.file = "--number " + text},
                         fmt::format("the case has no [[quantity]] \"{}\"", name),
                         "the name of one of its quantities");
      number->theirs = value;
    }
    if (!theirs_.stress.empty())
    {
      const std::vector<Point<dim>> forces = certify::boundary_forces<dim>(*space_, theirs_.stress);
      for (std::size_t b = 0; b < forces.size(); ++b)
        record_.forces.push_back({mesh_.boundary_names()[b], {forces[b].begin(), forces[b].end()}});
    }
    measure_tension(form);
    if (config.history) return;  // gaps and slips of a path are not theirs
    for (std::size_t k = 0; k < form.segments().size(); ++k)
      for (const contact::ContactState<dim>& state : form.contact_states(theirs_.u, k))
      {
        if (record_.penetration && -state.gap <= *record_.penetration) continue;
        record_.penetration = std::max(0.0, -state.gap);
        record_.penetrated = problem_.boundary(form.segments()[k].slave.facet.tag).name;
      }
  }

  void measure_tension(const contact::NitscheForm<dim>& form)
  {
    if (theirs_.stress.empty()) return;
    std::vector<std::size_t> facets;
    for (const contact::ContactSegment<dim>& segment : form.segments())
      if (const auto cone = problem::cone(segment.contact->law); !cone.is_bilateral && !cone.holds_tension)
        facets.push_back(segment.slave.number);
    if (facets.empty()) return;
    std::ranges::sort(facets);
    record_.tension = certify::tension<dim>(*space_, theirs_.stress, facets);
  }

  void take_intervals(const certify::EnergyBound& energy)
  {
    for (JudgedNumber& number : record_.numbers)
      if (const certify::QuantityInterval* interval = adapt::find_interval(energy, number.interval.name))
        number.interval = *interval;
  }

  const JudgeRequest& request_;
  mesh::Mesh<dim> mesh_;  ///< the first one, which is theirs
  problem::Problem<dim> problem_;
  std::vector<problem::Quantity<dim>> quantities_;
  certify::ForeignSolution<dim> theirs_{};
  std::optional<fem::LagrangeSpace<dim>> space_{};
  std::shared_ptr<const KeptLevel<dim>> judged_{};  ///< the last level that was judged on
  JudgementRecord record_{};
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
  RunHooks hooks{.change = prepare_to_judge, .is_part = true};
  LoopHooks<dim>& of_dimension = hooks.of<dim>();
  of_dimension.level = [&](const auto& level, const io::LevelRecord& record) { judge(level, record); };
  if (!config.history)
    of_dimension.stop = [&](const auto&)
    { return judge.record().is_settled() ? "their solution is judged" : ""; };
  const ExitCode code = run(request, {}, hooks);
  case_file::OutputConfig output = config.output;
  output.directory /= "judge";
  if (is_first_process() && std::filesystem::exists(output.directory))
  {
    judge.write(output);
    print(judgement_text(judge.record(), output.directory.string()));
  }
  return code == ExitCode::success || code == ExitCode::budget_used_up ? exit_code(judge.record().status())
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
