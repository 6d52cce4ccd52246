#include "app/command/report_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/console/console.h"
#include "app/page/page_volume.h"
#include "app/program_facts.h"
#include "tribound/case/resolve.h"
#include "tribound/doctor/run_warnings.h"
#include "tribound/doctor/solution_facts.h"
#include "tribound/io/fields/contact_line.h"
#include "tribound/io/fields/vtu.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/record/error_bars.h"
#include "tribound/io/state/checkpoint.h"
#include "tribound/mesh/gmsh_text.h"

namespace tribound::app
{

namespace
{

/// Cells of several ranks that are gathered on one.
constexpr std::int64_t most_in_one = 1'000'000;

template <int dim>
bool is_complete(const mesh::Mesh<dim>& mesh)
{
  return mesh.n_cells() == mesh.n_global_cells();
}

}  // namespace

std::unique_ptr<OutputDirectory> take_directory(const case_file::Config& config, bool keeps_results)
{
  require_mesh_elsewhere(config);
  const std::filesystem::path& path = config.output.directory;
  auto directory = std::make_unique<OutputDirectory>(path);
  if (keeps_results) return directory;
  remove_results(path, {"certificate.json", "report.html", "convergence.csv", "quantities.csv", "history.csv",
                        "newton.csv", "contact.csv", "adapted.msh", io::checkpoint_name});
  io::remove_series(path);
  return directory;
}

template <int dim>
io::RunRecord first_record(const case_file::Config& config, const problem::Problem<dim>& problem,
                           const fem::LagrangeSpace<dim>& space, const fem::Constraints& constraints,
                           Clock::time_point begin)
{
  io::RunRecord record;
  record.facts = case_file::case_facts(config, dim);
  record.mesh = io::mesh_facts<dim>(problem, space, constraints);
  record.build = library_facts();
  record.build.processes = space.mesh().ranks().size();
  record.effective = config.effective;
  record.case_file = effective_file_name(config);
  record.tolerance = config.adapt.tolerance;
  record.setup = seconds_since(begin);
  return record;
}

std::vector<std::string> free_sides(const case_file::Config& config,
                                    std::span<const std::string> boundary_names)
{
  std::vector<std::string> sides;
  for (const std::string& name : boundary_names)
    if (std::ranges::count(config.boundaries, name, &case_file::BoundaryConfig::name) == 0)
      sides.push_back(name);
  return sides;
}

template <int dim>
bool fits_page(const KeptLevel<dim>& shown)
{
  return dim == 3 || shown.is_merged || is_complete(shown.discrete->mesh);
}

template <int dim>
std::shared_ptr<const KeptLevel<dim>> gather(const adapt::LevelView<dim>& view,
                                             std::shared_ptr<const KeptLevel<dim>> kept,
                                             const case_file::OutputConfig& output,
                                             const adapt::Method& method)
{
  if (!view.discrete.mesh.partition()) return kept;
  // In 3D the page shows the surface, and of few cells the inside.
  const std::int64_t most = dim == 2 || output.mesh ? most_in_one : std::int64_t{max_volume_cells};
  const bool is_small = view.discrete.mesh.n_global_cells() <= most;
  std::optional<adapt::Excerpt<dim>> excerpt = is_small || (dim == 2 && !kept->t)
                                                   ? adapt::excerpt<dim>(view, method, most)
                                                   : adapt::boundary_excerpt<dim>(view, method);
  if (!excerpt) return nullptr;
  return std::make_shared<const KeptLevel<dim>>(view.number, kept ? kept->t : std::nullopt,
                                                *std::move(excerpt));
}

template <int dim>
void write_contact_and_mesh(const KeptLevel<dim>& shown, const case_file::OutputConfig& output,
                            const std::vector<std::string>& free_sides)
{
  if (output.mesh && is_complete(shown.discrete->mesh))
    io::write_file(output.directory / "adapted.msh", mesh::gmsh_text(shown.discrete->mesh, free_sides));
  io::write_contact_csv(output.directory / "contact.csv", shown.discrete->form, shown.level.u, shown.place());
}

template <int dim>
void write_vtu_files(const std::filesystem::path& directory, const KeptLevel<dim>& level,
                     const KeptLevel<dim>* shown)
{
  write_level_fields<dim>(directory, level.place(), *level.discrete, level.level);
  if (shown != nullptr)
    io::write_contact_vtu<dim>(directory / io::level_file_name("contact", level.number), level.place(),
                               shown->discrete->form, shown->level.u);
}

void print_end(const io::RunRecord& record, Printed printed, const std::filesystem::path& directory)
{
  if (printed == Printed::everything) print_summary(record, directory.string());
  if (printed == Printed::verdict) print_verdict(record, directory.string());
}

template <int dim>
void update_statements(io::RunRecord& record, const adapt::LevelView<dim>& view, certify::ContactRule rule)
{
  if (view.level.steps.empty()) return;
  record.statements = certify::statements(view.discrete.form, rule, view.level.friedrichs);
  if (!record.levels.back().load_step && view.discrete.form.problem().uses_time())
    record.statements.assumptions.emplace_back("load_factor", "t = 1 in all formulas, without [history]");
  if (std::string energy = io::words_of_guarantee(record.levels.back()); !energy.empty())
    record.statements.covered.push_back(std::move(energy));
  if (view.level.solved() && is_round_off(view.level.estimate, view.level.norms))
    record.statements.assumptions.emplace_back(
        "stress",
        fmt::format("zero as far as can be known: here norms of stresses up to {:.3g} are nothing but "
                    "rounding, and so is the bound",
                    view.level.norms.round_off));
  record.statements.assumptions.emplace_back(
      "linear_solver",
      describe_solver(view.level.steps) +
          (view.level.tightened ? ", beyond solver.tolerance on the last mesh, where it was too loose" : ""));
}

template <int dim>
void update_warnings(io::RunRecord& record, const adapt::LevelView<dim>& view, const KeptLevel<dim>* shown)
{
  const io::LevelRecord& level = record.levels.back();
  record.warnings.clear();
  const bool is_shared = view.discrete.mesh.partition() != nullptr;
  if (!view.level.solved() || (is_shared && (!shown || shown->number != view.number))) return;
  const std::vector<doctor::ContactOutcome> outcomes =
      is_shared ? doctor::contact_outcomes<dim>(shown->discrete->form, shown->level.u)
                : doctor::contact_outcomes<dim>(view.discrete.form, view.level.u);
  record.warnings =
      doctor::run_warnings({level.bound, level.figures.sigma_norm, level.figures.max_displacement}, outcomes);
}

template io::RunRecord first_record(const case_file::Config&, const problem::Problem<2>&,
                                    const fem::LagrangeSpace<2>&, const fem::Constraints&, Clock::time_point);
template io::RunRecord first_record(const case_file::Config&, const problem::Problem<3>&,
                                    const fem::LagrangeSpace<3>&, const fem::Constraints&, Clock::time_point);
template bool fits_page(const KeptLevel<2>&);
template bool fits_page(const KeptLevel<3>&);
template std::shared_ptr<const KeptLevel<2>> gather(const adapt::LevelView<2>&,
                                                    std::shared_ptr<const KeptLevel<2>>,
                                                    const case_file::OutputConfig&, const adapt::Method&);
template std::shared_ptr<const KeptLevel<3>> gather(const adapt::LevelView<3>&,
                                                    std::shared_ptr<const KeptLevel<3>>,
                                                    const case_file::OutputConfig&, const adapt::Method&);
template void write_contact_and_mesh(const KeptLevel<2>&, const case_file::OutputConfig&,
                                     const std::vector<std::string>&);
template void write_contact_and_mesh(const KeptLevel<3>&, const case_file::OutputConfig&,
                                     const std::vector<std::string>&);
template void write_vtu_files(const std::filesystem::path&, const KeptLevel<2>&, const KeptLevel<2>*);
template void write_vtu_files(const std::filesystem::path&, const KeptLevel<3>&, const KeptLevel<3>*);
template void update_statements(io::RunRecord&, const adapt::LevelView<2>&, certify::ContactRule);
template void update_statements(io::RunRecord&, const adapt::LevelView<3>&, certify::ContactRule);
template void update_warnings(io::RunRecord&, const adapt::LevelView<2>&, const KeptLevel<2>*);
template void update_warnings(io::RunRecord&, const adapt::LevelView<3>&, const KeptLevel<3>*);

}  // namespace tribound::app
