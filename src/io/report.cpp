#include "io/report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "io/csv.h"

namespace tribound
{

namespace
{

using Json = nlohmann::ordered_json;

constexpr const char* schema_version = "1";

std::optional<double> member(const std::optional<Bound>& bound, double Bound::*value)
{
  return bound ? std::optional((*bound).*value) : std::nullopt;
}

void add_components(CsvTable& table, const std::optional<Bound>& bound)
{
  for (const auto& [name, value] : component_names)
    table.add(bound ? std::optional(bound->global.*value) : std::nullopt);
}

/// null where there is nothing.
Json json(const std::optional<double>& value)
{
  return value ? Json(*value) : Json(nullptr);
}

Json json(const std::optional<Bound>& bound)
{
  if (!bound) return nullptr;
  Json object;
  for (const auto& [name, value] : component_names) object[name] = bound->global.*value;
  return object;
}

Json json(const std::optional<IdentityDefects>& identities)
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
  return {{"normal", resultants.normal},
          {"tangential", resultants.tangential},
          {"abs_tangential", resultants.abs_tangential},
          {"force", resultants.force}};
}

Json json(const CertifiedStep& record)
{
  return {{"step", record.step.step},
          {"residual", record.step.residual},
          {"damping", record.step.damping},
          {"linear_iterations", record.step.linear_iterations},
          {"factorised", record.step.factorised},
          {"seconds", record.step.seconds},
          {"total", json(member(record.bound, &Bound::total))},
          {"accepted", record.accepted}};
}

/// Bound and figures, which the certificate has of the last level and of each.
void add_results(Json& object, const LevelRecord& level)
{
  object["cells"] = level.cells;
  object["dofs"] = level.dofs;
  object["bound"] = json(member(level.bound, &Bound::total_sharp));
  object["bound_plain"] = json(member(level.bound, &Bound::total));
  object["relative"] = json(relative_bound(level));
  object["components"] = json(level.bound);
  object["identities"] = json(level.identities);
  object["energy"] = level.figures.energy;
  object["sigma_norm"] = level.figures.sigma_norm;
  object["max_displacement"] = level.figures.max_displacement;
  object["contact"] = nullptr;
  if (level.figures.boundary_contact.empty()) return;
  Json contact = json(level.figures.contact);
  for (const Resultants& part : level.figures.boundary_contact)
    contact["boundaries"][part.boundary] = json(part);
  object["contact"] = contact;
}

Json json(const LevelRecord& level)
{
  Json object{{"level", level.level}};
  add_results(object, level);
  object["newton"] = Json::array();
  for (const CertifiedStep& record : level.newton) object["newton"].push_back(json(record));
  object["times"] = {
      {"solve", level.times.solve}, {"certify", json(level.times.certify)}, {"level", level.times.level}};
  return object;
}

Json json(const MeshFacts& mesh)
{
  Json object{
      {"vertices", mesh.vertices},         {"cells", mesh.cells},      {"smallest_cell", mesh.smallest_cell},
      {"largest_cell", mesh.largest_cell}, {"regions", Json::array()}, {"boundaries", Json::array()}};
  for (const RegionFacts& region : mesh.regions)
    object["regions"].push_back({{"name", region.name},
                                 {"cells", region.cells},
                                 {"measure", region.measure},
                                 {"material", region.material}});
  for (const BoundaryFacts& boundary : mesh.boundaries)
    object["boundaries"].push_back({{"name", boundary.name},
                                    {"facets", boundary.facets},
                                    {"measure", boundary.measure},
                                    {"condition", boundary.condition}});
  return object;
}

Json json(const BuildFacts& build)
{
  return {{"name", "tribound"},         {"version", build.version},
          {"compiler", build.compiler}, {"petsc", build.petsc},
          {"mumps", build.mumps},       {"gmsh", build.gmsh},
          {"blas", build.blas},         {"blas_threads", build.blas_threads},
          {"mpi", build.mpi},           {"eigen", build.eigen},
          {"features", build.features}};
}

template <typename Value>
Json json(const std::vector<std::pair<std::string, Value>>& named)
{
  Json object = Json::object();
  for (const auto& [name, value] : named) object[name] = value;
  return object;
}

template <int dim>
Resultants resultants(const std::string& boundary, const ContactResultants<dim>& r)
{
  return {boundary, {r.force.begin(), r.force.end()}, r.normal, r.tangential, r.abs_tangential};
}

}  // namespace

std::optional<double> relative_bound(const LevelRecord& level)
{
  if (!level.bound || level.figures.sigma_norm == 0.0) return std::nullopt;
  return level.bound->total_sharp / level.figures.sigma_norm;
}

template <int dim>
SolutionFigures solution_figures(const NitscheForm<dim>& form, std::span<const double> u,
                                 std::span<const Point<dim>> t)
{
  SolutionFigures figures;
  const StressNorms norms = stress_norms(form.problem(), form.space(), u);
  figures.energy = norms.energy;
  figures.sigma_norm = norms.sigma;
  for (std::size_t node = 0; node < u.size(); node += dim)
    figures.max_displacement = std::max(figures.max_displacement, Point<dim>(u.data() + node).norm());
  figures.contact = resultants("", contact_resultants(form, t));
  const auto boundaries = form.problem().boundaries();
  for (int tag = 0; tag < static_cast<int>(boundaries.size()); ++tag)
    if (boundaries[tag].contact)
      figures.boundary_contact.push_back(resultants(boundaries[tag].name, contact_resultants(form, t, tag)));
  return figures;
}

std::string convergence_csv(const RunRecord& run)
{
  CsvTable table(
      "level,cells,dofs,newton_steps,osc,str,neu,lin1,cnt,frc,lin2n,lin2t,total,total_sharp,relative,energy,"
      "contact_normal,contact_tangential,t_solve,t_certify,t_level");
  for (const LevelRecord& level : run.levels)
  {
    table.add(level.level);
    table.add(level.cells);
    table.add(level.dofs);
    table.add(static_cast<long>(level.newton.size()));
    add_components(table, level.bound);
    table.add(member(level.bound, &Bound::total));
    table.add(member(level.bound, &Bound::total_sharp));
    table.add(relative_bound(level));
    table.add(level.figures.energy);
    table.add(level.figures.contact.normal);
    table.add(level.figures.contact.tangential);
    table.add(level.times.solve);
    table.add(level.times.certify);
    table.add(level.times.level);
    table.end_row();
  }
  return table.text();
}

std::string newton_csv(const RunRecord& run)
{
  CsvTable table("level,step,residual,damping,osc,str,neu,lin1,cnt,frc,lin2n,lin2t,total,accepted");
  for (const LevelRecord& level : run.levels)
    for (const CertifiedStep& record : level.newton)
    {
      table.add(level.level);
      table.add(record.step.step);
      table.add(record.step.residual);
      table.add(record.step.damping);
      add_components(table, record.bound);
      table.add(member(record.bound, &Bound::total));
      table.add(record.accepted ? 1 : 0);
      table.end_row();
    }
  return table.text();
}

std::string certificate_json(const RunRecord& run)
{
  Json object{
      {"schema", schema_version},        {"program", json(run.build)},
      {"title", run.facts.title},        {"file", run.facts.file},
      {"status", to_string(run.status)}, {"reason", run.reason.empty() ? Json(nullptr) : Json(run.reason)},
      {"d", run.facts.dimension},        {"p", run.facts.degree},
      {"friction", run.facts.friction},  {"gamma0", run.facts.gamma0}};
  if (!run.levels.empty()) add_results(object, run.levels.back());
  object["tolerance"] = run.tolerance;
  object["covered"] = run.statements.covered;
  object["law"] = run.statements.law;
  object["constants"] = json(run.statements.constants);
  object["assumptions"] = json(run.statements.assumptions);
  object["not_covered"] = run.statements.not_covered;
  object["mesh"] = json(run.mesh);
  object["levels"] = Json::array();
  for (const LevelRecord& level : run.levels) object["levels"].push_back(json(level));
  object["times"] = json(run.times);
  // Names from a file need not be UTF-8.
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_report(const std::filesystem::path& directory, const RunRecord& run)
{
  write_file(directory / "convergence.csv", convergence_csv(run));
  write_file(directory / "newton.csv", newton_csv(run));
  write_file(directory / "certificate.json", certificate_json(run));
}

template SolutionFigures solution_figures(const NitscheForm<2>&, std::span<const double>,
                                          std::span<const Point<2>>);
template SolutionFigures solution_figures(const NitscheForm<3>&, std::span<const double>,
                                          std::span<const Point<3>>);

}  // namespace tribound
