#include "tribound/io/record/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tribound/doctor/support_facts.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/record/facts_json.h"
#include "tribound/io/record/tables.h"

namespace tribound::io
{

namespace
{

constexpr const char* certificate_schema = "1";

std::optional<double> member(const std::optional<certify::Bound>& bound, double certify::Bound::*value)
{
  return bound ? std::optional((*bound).*value) : std::nullopt;
}

Json json(const std::optional<certify::Bound>& bound, bool regularised)
{
  if (!bound) return nullptr;
  Json object;
  for (const certify::Component& c : certify::components_of_run(regularised))
    object[c.name] = bound->global.*c.value;
  return object;
}

Json json(const std::optional<certify::IdentityDefects>& identities)
{
  if (!identities) return nullptr;
  return {{"divergence", identities->divergence},
          {"jump", identities->jump},
          {"neumann", identities->neumann},
          {"contact", identities->contact},
          {"symmetry", identities->symmetry}};
}

Json json(const Resultants& resultants)
{
  return {{"resolution", resultants.resolution},
          {"normal", resultants.normal},
          {"tangential", resultants.tangential},
          {"abs_tangential", resultants.abs_tangential},
          {"force", resultants.force}};
}

Json json(const std::optional<Sliding>& sliding)
{
  if (!sliding) return nullptr;
  return {{"coefficient", sliding->coefficient},
          {"sliding_factor", sliding->sliding_factor},
          {"safety_factor", number_or_null(sliding->safety_factor)}};
}

Json json(const adapt::CertifiedStep& record, bool regularised)
{
  Json object{{"step", record.step.step},
              {"residual", record.step.residual},
              {"damping", record.step.damping},
              {"linear_iterations", record.step.linear_iterations},
              {"factorised", record.step.factorised},
              {"seconds", record.step.seconds},
              {"total", number_or_null(member(record.bound, &certify::Bound::total))},
              {"accepted", record.accepted}};
  if (regularised) object["delta"] = record.step.delta;
  return object;
}

/// Bound and figures, which the certificate has of the last level and of each.
void add_results(Json& object, const LevelRecord& level)
{
  object["cells"] = level.cells;
  object["dofs"] = level.dofs;
  object["bound"] = number_or_null(member(level.bound, &certify::Bound::total_sharp));
  object["bound_plain"] = number_or_null(member(level.bound, &certify::Bound::total));
  object["relative"] = number_or_null(relative_bound(level));
  object["components"] = json(level.bound, is_regularised(level));
  if (is_regularised(level))
    object["regularisation"] = {{"delta", number_or_null(last_delta(level))},
                                {"updates", *level.delta_updates}};
  object["identities"] = json(level.identities);
  object["energy"] = level.figures.energy;
  object["sigma_norm"] = level.figures.sigma_norm;
  object["max_displacement"] = level.figures.max_displacement;
  object["contact"] = nullptr;
  if (level.figures.boundary_contact.empty()) return;
  Json contact = json(level.figures.contact);
  for (const Resultants& part : level.figures.boundary_contact)
  {
    contact["boundaries"][part.boundary] = json(part);
    contact["boundaries"][part.boundary]["sliding"] = json(sliding(part));
  }
  object["contact"] = contact;
}

Json json(const LevelRecord& level)
{
  Json object{{"level", level.level}};
  add_results(object, level);
  object["finishing_steps"] = level.finishing_steps;
  object["newton"] = Json::array();
  for (const adapt::CertifiedStep& record : level.newton)
    object["newton"].push_back(json(record, is_regularised(level)));
  object["times"] = {{"solve", level.times.solve},
                     {"certify", number_or_null(level.times.certify)},
                     {"bisect", level.times.refinement.bisect},
                     {"discretise", level.times.refinement.discretise},
                     {"transfer", level.times.refinement.transfer},
                     {"output", level.times.output},
                     {"level", level.times.level},
                     {"solve_cpu", level.times.solve_cpu},
                     {"certify_cpu", level.times.certify_cpu},
                     {"level_cpu", level.times.level_cpu}};
  return object;
}

Json json(const doctor::Finding& warning)
{
  return {{"code", warning.code},
          {"text", warning.text},
          {"value", warning.numbers.empty() ? 0 : warning.numbers.front().second},
          {"where", text_or_null(doctor::location(warning))}};
}

template <typename Value>
Json json(const std::vector<std::pair<std::string, Value>>& named)
{
  Json object = Json::object();
  for (const auto& [name, value] : named) object[name] = value;
  return object;
}

/// The resultants of T(u) and of t^k on the boundary group `tag`, or on all of Gamma_C for tag < 0.
template <int dim>
Resultants resultants(const contact::NitscheForm<dim>& form, std::span<const Point<dim>> of_u,
                      std::span<const Point<dim>> running, int tag = -1)
{
  constexpr double round_off = 1e-12;  // of sums over many points
  const contact::ContactResultants<dim> r = contact::contact_resultants(form, of_u, tag);
  const contact::ContactResultants<dim> in_equilibrium = contact::contact_resultants(form, running, tag);
  Resultants result;
  result.resolution = (r.force - in_equilibrium.force).norm() + std::abs(r.normal - in_equilibrium.normal) +
                      std::abs(r.tangential - in_equilibrium.tangential) +
                      round_off * (std::abs(r.normal) + r.abs_tangential);
  const auto known = [&](double value) { return known_digits(value, result.resolution); };
  for (const double component : r.force) result.force.push_back(known(component));
  result.normal = known(r.normal);
  result.tangential = known(r.tangential);
  result.abs_tangential = known(r.abs_tangential);
  return result;
}

}  // namespace

double known_digits(double value, double resolution)
{
  constexpr int all_digits = 16;
  if (std::abs(value) <= resolution) return 0;
  const double digits = std::floor(std::log10(std::abs(value))) - std::floor(std::log10(resolution));
  if (!(digits < all_digits)) return value;
  return std::stod(fmt::format("{:.{}e}", value, static_cast<int>(digits)));
}

std::optional<Sliding> sliding(const Resultants& resultants)
{
  const double N = -resultants.normal;
  const double H = std::abs(resultants.tangential);
  const double resolution = resultants.resolution;
  if (!resultants.coefficient || N <= resolution) return std::nullopt;
  const double mu_F = *resultants.coefficient;
  const double ratio = H / N;
  constexpr double round_off = 1e-10;
  Sliding result{mu_F, known_digits(ratio, (1 + ratio) * resolution / N), {}};
  if (H > std::max(resolution, round_off * N))
    result.safety_factor = known_digits(mu_F / ratio, mu_F / ratio * (1 + 1 / ratio) * resolution / N);
  return result;
}

int newton_steps(const LevelRecord& level)
{
  return static_cast<int>(level.newton.size()) - level.finishing_steps;
}

bool is_regularised(const LevelRecord& level)
{
  return level.delta_updates.has_value();
}

std::optional<double> last_delta(const LevelRecord& level)
{
  return level.newton.empty() ? std::nullopt : std::optional(level.newton.back().step.delta);
}

std::optional<double> relative_bound(const LevelRecord& level)
{
  if (!level.bound || level.figures.sigma_norm == 0.0) return std::nullopt;
  return level.bound->total_sharp / level.figures.sigma_norm;
}

bool is_round_off(const LevelRecord& level)
{
  const contact::StressNorms norms{.sigma = level.figures.sigma_norm, .round_off = level.figures.round_off};
  return level.bound && certify::is_round_off(*level.bound, norms);
}

template <int dim>
SolutionFigures solution_figures(const contact::NitscheForm<dim>& form,
                                 const adapt::CertifiedLevel<dim>& level)
{
  SolutionFigures figures;
  figures.round_off = level.norms.round_off;
  if (!level.solved() || !is_round_off(level.estimate, level.norms))
  {
    figures.energy = level.norms.energy;
    figures.sigma_norm = level.norms.sigma;
  }
  for (std::size_t node = 0; node < level.u.size(); node += dim)
    figures.max_displacement = std::max(figures.max_displacement, Point<dim>(level.u.data() + node).norm());
  const std::vector<Point<dim>> t = form.traction(level.u);
  figures.contact = resultants<dim>(form, t, level.traction);
  const auto boundaries = form.problem().boundaries();
  const std::vector<bool> slides = doctor::slides_as_a_whole(form);
  for (int tag = 0; tag < static_cast<int>(boundaries.size()); ++tag)
  {
    if (!boundaries[tag].contact) continue;
    Resultants part = resultants<dim>(form, t, level.traction, tag);
    part.boundary = boundaries[tag].name;
    const problem::FrictionCone friction = cone(boundaries[tag].contact->law);
    const bool coefficient_alone = friction.strength == nullptr && friction.coefficient > 0;
    if (coefficient_alone && slides[tag] && adapt::bound_holds(level, form.space().degree()))
      part.coefficient = friction.coefficient;
    figures.boundary_contact.push_back(std::move(part));
  }
  return figures;
}

std::string certificate_json(const RunRecord& run)
{
  Json object{{"schema", certificate_schema},
              {"program", program_json(run.build)},
              {"title", run.facts.title},
              {"file", run.facts.file},
              {"case", effective_case_json(run)},
              {"status", certify::to_string(run.status)},
              {"reason", text_or_null(run.reason)},
              {"d", run.facts.dimension},
              {"p", run.facts.degree},
              {"friction", run.facts.friction},
              {"gamma0", run.facts.gamma0}};
  if (!run.levels.empty()) add_results(object, run.levels.back());
  object["balance"] = nullptr;
  if (!run.levels.empty() && run.levels.back().balance)
    object["balance"] = balance_json(*run.levels.back().balance);
  object["tolerance"] = run.tolerance;
  object["covered"] = run.statements.covered;
  object["law"] = run.statements.law;
  object["constants"] = json(run.statements.constants);
  object["assumptions"] = json(run.statements.assumptions);
  object["not_covered"] = run.statements.not_covered;
  object["warnings"] = Json::array();
  for (const doctor::Finding& warning : run.warnings) object["warnings"].push_back(json(warning));
  object["mesh"] = mesh_json(run.mesh);
  object["levels"] = Json::array();
  for (const LevelRecord& level : run.levels) object["levels"].push_back(json(level));
  object["times"] = json(run.times);
  // Names from a file need not be UTF-8.
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_report(const std::filesystem::path& directory, const RunRecord& run)
{
  if (!run.effective.text.empty()) write_file(directory / run.case_file, run.effective.text);
  write_file(directory / "convergence.csv", convergence_csv(run.levels));
  write_file(directory / "newton.csv", newton_csv(run.levels));
  write_file(directory / "certificate.json", certificate_json(run));
}

template SolutionFigures solution_figures(const contact::NitscheForm<2>&, const adapt::CertifiedLevel<2>&);
template SolutionFigures solution_figures(const contact::NitscheForm<3>&, const adapt::CertifiedLevel<3>&);

}  // namespace tribound::io
