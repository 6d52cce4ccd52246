#include "app/command/judged_step.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/page/judgement_page.h"
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

namespace tribound::app
{

namespace
{

constexpr const char* not_reached = "the run has not come so far";

/// Kinds that follow from the displacement alone.
bool follows_from_displacement(problem::QuantityKind kind)
{
  using K = problem::QuantityKind;
  return kind == K::energy || kind == K::load_work || kind == K::mean_displacement || kind == K::spring_force;
}

template <int dim>
certify::ForeignSolution<dim> read(const JudgeRequest& request, const mesh::ImportedSolution& solution,
                                   const mesh::Mesh<dim>& mesh, bool is_axisymmetric)
{
  return request.interpolate ? certify::interpolated_solution<dim>(solution, mesh, is_axisymmetric)
                             : certify::foreign_solution<dim>(solution, mesh, is_axisymmetric);
}

}  // namespace

template <int dim>
JudgedCase<dim>::JudgedCase(const case_file::Config& config, mesh::Mesh<dim> first)
    : mesh(std::move(first)),
      problem(case_file::resolve(config, mesh)),
      quantities(case_file::resolve_quantities<dim>(config, problem, mesh.boundary_names())),
      facts(case_file::case_facts(config, dim)),
      sharpness(config.judge.sharpness),
      is_path(config.history.has_value())
{
}

template <int dim>
JudgedStep<dim>::JudgedStep(const JudgedCase<dim>& judged_case, const JudgeRequest& request,
                            const io::HashedFile& file, const mesh::ImportedSolution& solution,
                            std::span<const GivenNumber> numbers, std::size_t number,
                            const std::optional<double>& t)
    : case_(judged_case),
      theirs_(read<dim>(request, solution, case_.mesh, case_.problem.is_axisymmetric())),
      space_(case_.mesh, theirs_.degree),
      given_(case_.quantities.size())
{
  JudgementRecord& record = last_.record;
  record.facts = case_.facts;
  record.sharpness = case_.sharpness;
  record.accept = request.accept;
  record.solution = file;
  record.description = solution.description;
  record.read_as = theirs_.read_as;
  record.node_distance = theirs_.node_distance;
  record.curved_distance = theirs_.curved_distance;
  record.their_cells = case_.mesh.n_cells();
  record.t = t;
  record.reason = not_reached;
  for (const GivenNumber& given : numbers)
  {
    const auto quantity = std::ranges::find(case_.quantities, given.name, &problem::Quantity<dim>::name);
    if (quantity == case_.quantities.end())
      throw InputError({.file = "--number " + given.text},
                       fmt::format("the case has no [[quantity]] \"{}\"", given.name),
                       "the name of one of its quantities");
    given_[quantity - case_.quantities.begin()] = given.values[number];
  }
  measure_numbers();
  if (!theirs_.stress.empty()) measure_stress();
  if (!case_.is_path) measure_penetration();  // gaps and slips of a path are not theirs
}

/// Of quantities that follow from the displacement, and those that are given.
template <int dim>
void JudgedStep<dim>::measure_numbers()
{
  JudgementRecord& record = last_.record;
  const problem::Problem<dim> problem = problem_of(record);
  const contact::NitscheForm<dim> form(problem, space_, contact::default_gamma0(theirs_.degree));
  const certify::EnergyBound values =
      certify::no_energy_bound<dim>(form, theirs_.u, case_.quantities, "not yet judged");
  record.numbers.clear();
  for (std::size_t i = 0; i < case_.quantities.size(); ++i)
  {
    JudgedNumber& number = record.numbers.emplace_back();
    number.interval.name = values.quantities[i].name;
    number.interval.reason = "not yet judged";
    number.unit = record.facts.unit_of(number.interval.name);
    number.theirs = given_[i];
    if (!given_[i] && follows_from_displacement(case_.quantities[i].kind))
      number.theirs = values.quantities[i].value;
  }
}

/// The forces of their stress, and where it pulls at a contact.
template <int dim>
void JudgedStep<dim>::measure_stress()
{
  JudgementRecord& record = last_.record;
  const std::vector<Point<dim>> forces =
      certify::boundary_forces<dim>(space_, theirs_.stress, case_.problem.is_axisymmetric());
  for (std::size_t b = 0; b < forces.size(); ++b)
    record.forces.push_back({case_.mesh.boundary_names()[b], {forces[b].begin(), forces[b].end()}});
  const contact::NitscheForm<dim> form(case_.problem, space_, contact::default_gamma0(theirs_.degree));
  std::vector<std::size_t> facets;
  for (const contact::ContactSegment<dim>& segment : form.segments())
    if (const auto cone = problem::cone(segment.contact->law); !cone.is_bilateral && !cone.holds_tension)
      facets.push_back(segment.slave.number);
  if (facets.empty()) return;
  std::ranges::sort(facets);
  record.tension = certify::tension<dim>(space_, theirs_.stress, facets);
}

template <int dim>
void JudgedStep<dim>::measure_penetration()
{
  JudgementRecord& record = last_.record;
  const contact::NitscheForm<dim> form(case_.problem, space_, contact::default_gamma0(theirs_.degree));
  for (std::size_t k = 0; k < form.segments().size(); ++k)
    for (const contact::ContactState<dim>& state : form.contact_states(theirs_.u, k))
    {
      if (record.penetration && -state.gap <= *record.penetration) continue;
      record.penetration = std::max(0.0, -state.gap);
      record.penetrated = case_.problem.boundary(form.segments()[k].slave.facet.tag).name;
    }
}

template <int dim>
void JudgedStep<dim>::judge(const Level& kept, const io::LevelRecord& of_level)
{
  const KeptLevel<dim>& level = *kept;
  JudgementRecord& record = last_.record;
  record.t = level.t;
  if (level.t)
  {
    record.load_step = level.number;
    measure_numbers();  // loads are those of the step
  }
  record.cells = static_cast<long>(level.discrete->mesh.n_global_cells());
  const std::optional<certify::EnergyBound>& energy = level.level.energy;
  if (of_level.balance) record.balance(*of_level.balance);
  record.judgement.reset();
  record.target.clear();
  last_.level.reset();
  record.reason = energy ? energy->reason : "certify.energy is off";
  if (energy) take_intervals(*energy);
  if (!record.reason.empty()) return;
  record.target = io::words_of(energy->target);
  if (level.t) record.target += ", of a load step after the computed slip of those before it";
  // The problem of the level has the initial stress of its load step.
  record.judgement = certify::judge<dim>(level.discrete->form.problem(), space_, theirs_,
                                         level.discrete->space, level.level.u, energy->bound);
  last_.level = kept;
}

template <int dim>
void JudgedStep<dim>::take_intervals(const certify::EnergyBound& energy)
{
  for (JudgedNumber& number : last_.record.numbers)
    if (const certify::QuantityInterval* interval = adapt::find_interval(energy, number.interval.name))
      number.interval = *interval;
}

template <int dim>
void JudgedStep<dim>::accept()
{
  accepted_ = last_;
  last_.level.reset();
  last_.record.judgement.reset();
  last_.record.reason = not_reached;
}

template <int dim>
bool JudgedStep<dim>::is_worse_than(const JudgedStep& other) const
{
  return last_.record.largest_error() > other.last_.record.largest_error();
}

template <int dim>
void JudgedStep<dim>::write_fields(const std::filesystem::path& directory) const
{
  const JudgementRecord& record = this->record();
  const certify::Judgement& judgement = *record.judgement;
  io::write_file(directory / "judged_cells.csv", judged_cells_csv<dim>(case_.mesh, judgement.displacement));
  std::vector<io::CellField> fields = {{"distance", judgement.displacement.cells}};
  if (judgement.stress) fields.push_back({"stress_distance", judgement.stress->cells});
  io::write_level_vtu<dim>({.own = directory / "judged.vtu"}, {}, problem_of(record), space_, theirs_.u,
                           fields);
}

template <int dim>
io::Json JudgedStep<dim>::surfaces() const
{
  const Level& level = found().level;
  if (!level || n_processes() > 1) return nullptr;  // of a mesh that is shared out there is a part
  const problem::Problem<dim> problem = problem_of(record());
  const contact::NitscheForm<dim> form(problem, space_, contact::default_gamma0(theirs_.degree));
  return judged_surfaces<dim>(form, theirs_, *record().judgement, level->discrete->space, level->level.u);
}

template struct JudgedCase<2>;
template struct JudgedCase<3>;
template class JudgedStep<2>;
template class JudgedStep<3>;

}  // namespace tribound::app
