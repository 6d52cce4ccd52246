#include "app/command/run_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <utility>

#include "app/console/balance_text.h"
#include "app/console/console.h"
#include "app/shared_file.h"
#include "tribound/algebra/linear_solver.h"
#include "tribound/algebra/petsc.h"
#include "tribound/case/resolve.h"
#include "tribound/doctor/run_warnings.h"
#include "tribound/doctor/solution_facts.h"
#include "tribound/io/fields/contact_line.h"
#include "tribound/io/fields/vtu.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/mesh/gmsh.h"
#include "tribound/mesh/gmsh_text.h"

namespace tribound::app
{

namespace
{

ExitCode exit_code(certify::RunStatus status)
{
  switch (status)
  {
    case certify::RunStatus::certified:
      return ExitCode::success;
    case certify::RunStatus::budget:
      return ExitCode::budget_used_up;
    default:
      return ExitCode::failed;
  }
}

/// Seconds of work that a program which is killed may lose: the first levels take less time than files.
constexpr double most_lost = 1.0;

/// eta_tot and the components cell by cell, for the VTU file.
class CellComponents
{
 public:
  CellComponents(const certify::Estimate& estimate, bool regularised)
  {
    add("eta_tot", estimate, [](const certify::BoundComponents& cell) { return cell.total_sharp(); });
    for (const certify::Component& c : certify::components_of_run(regularised))
      if (c.is_of_cells())
        add(std::string("eta_") + c.name, estimate,
            [&c](const certify::BoundComponents& cell) { return cell.*c.value; });
  }

  [[nodiscard]] std::vector<io::CellField> fields() const
  {
    std::vector<io::CellField> result;
    for (const auto& [name, values] : columns_) result.push_back({name, values});
    return result;
  }

 private:
  template <typename Value>
  void add(std::string name, const certify::Estimate& estimate, const Value& value)
  {
    std::vector<double>& column = columns_.emplace_back(std::move(name), std::vector<double>{}).second;
    column.reserve(estimate.cells.size());
    for (const certify::BoundComponents& cell : estimate.cells) column.push_back(value(cell));
  }

  std::vector<std::pair<std::string, std::vector<double>>> columns_;
};

/// What writing throws, to be thrown again when the level is printed.
template <typename Write>
std::exception_ptr failure_of(const Write& write)
{
  try
  {
    write();
  }
  catch (const io::WriteError&)
  {
    return std::current_exception();
  }
  return nullptr;
}

}  // namespace

io::BuildFacts library_facts()
{
  const algebra::AlgebraVersions algebra = algebra::algebra_versions();
  io::BuildFacts build = io::build_facts();
  build.petsc = algebra.petsc;
  build.mumps = algebra.mumps;
  build.mpi = algebra.mpi;
  build.blas = algebra.blas;
  build.blas_threads = algebra.blas_threads;
  build.gmsh = mesh::gmsh_version();
  build.features = {"2D", "3D", "degrees 1-4", "friction: none, Tresca, Coulomb"};
  build.report_page = find_shared_file("report.html").string();
  return build;
}

std::string describe_solver(algebra::LinearMethod method)
{
  switch (method)
  {
    case algebra::LinearMethod::condensed:
      return "direct, condensed onto the contact boundary";
    case algebra::LinearMethod::iterative:
      return "GMRES with multigrid";
    default:
      return "direct";
  }
}

std::string describe_solver(std::span<const adapt::CertifiedStep> steps)
{
  const bool fell_back = std::ranges::any_of(steps, [](const auto& s) { return s.step.fell_back; });
  return describe_solver(steps.back().step.method) +
         (fell_back ? ", as GMRES with multigrid failed on this mesh" : "");
}

template <int dim>
void write_level_fields(const std::filesystem::path& directory, int number,
                        const adapt::Discretisation<dim>& discrete, const adapt::CertifiedLevel<dim>& level,
                        std::span<const io::CellField> further)
{
  const CellComponents components(level.estimate, level.delta_updates.has_value());
  std::vector<io::CellField> fields = components.fields();
  fields.insert(fields.end(), further.begin(), further.end());
  const std::array tensors = {io::equilibrated_stress_field(discrete.space, level.stress)};
  io::write_level_vtu<dim>(directory / io::level_file_name("level", number), number, discrete.form.problem(),
                           discrete.space, level.u, fields, tensors);
}

template <int dim>
RunReport<dim>::RunReport(const case_file::Config& config, const problem::Problem<dim>& problem,
                          const adapt::Discretisation<dim>& first, Clock::time_point begin, Printed printed)
    : output_(config.output),
      contact_rule_(config.method.contact_rule),
      printed_(printed),
      page_(config.output.report ? find_shared_file("report.html") : std::filesystem::path{}),
      moment_about_(moment_point<dim>(config.output, first.mesh))
{
  const fem::LagrangeSpace<dim>& space = first.space;
  const contact::NitscheForm<dim>& form = first.form;
  require_mesh_elsewhere(config);
  directory_.emplace(output_.directory);
  remove_results(output_.directory, {"certificate.json", "report.html", "convergence.csv", "newton.csv",
                                     "contact.csv", "adapted.msh"});
  io::remove_series(output_.directory);
  record_.facts = case_file::case_facts(config, dim);
  record_.mesh = io::mesh_facts<dim>(problem, space, form.constraints());
  record_.build = library_facts();
  for (const std::string& name : first.mesh.boundary_names())
    if (std::ranges::count(config.boundaries, name, &case_file::BoundaryConfig::name) == 0)
      free_sides_.push_back(name);
  record_.effective = config.effective;
  record_.case_file = effective_file_name(config);
  record_.tolerance = config.adapt.tolerance;
  record_.statements = certify::statements(form, config.method.contact_rule);
  record_.statements.assumptions.emplace_back(
      "linear_solver", describe_solver(algebra::choose_method(config.method.solver, dim, space.n_dofs())));
  record_.setup = seconds_since(begin);
  if (printed_ == Printed::everything) print_header(record_.facts, record_.mesh);
}

template <int dim>
void RunReport<dim>::write_fields(const KeptLevel<dim>& last) const
{
  const contact::NitscheForm<dim>& form = last.discrete->form;
  if (output_.mesh)
    io::write_file(output_.directory / "adapted.msh", mesh::gmsh_text(last.discrete->mesh, free_sides_));
  io::write_contact_csv(output_.directory / "contact.csv", form, last.level.u, last.number);
  if (!output_.vtu) return;
  write_level_fields<dim>(output_.directory, last.number, *last.discrete, last.level);
  io::write_contact_vtu<dim>(output_.directory / io::level_file_name("contact", last.number), last.number,
                             form, last.level.u);
  io::write_series(output_.directory, writes_all_levels() ? 0 : last.number, last.number);
}

template <int dim>
void RunReport<dim>::take(const adapt::LevelView<dim>& view)
{
  if (last_ && last_->number != view.number) page_.add(last_->number, last_->discrete->form, last_->level);
  last_.emplace(view);
  if (writes_all_levels()) write_fields(*last_);
}

template <int dim>
void RunReport<dim>::update_statements(const adapt::LevelView<dim>& view)
{
  if (view.level.steps.empty()) return;
  record_.statements = certify::statements(view.discrete.form, contact_rule_, view.level.friedrichs);
  if (view.level.solved() && is_round_off(view.level.estimate, view.level.norms))
    record_.statements.assumptions.emplace_back(
        "stress",
        fmt::format("zero as far as can be known: here norms of stresses up to {:.3g} are nothing but "
                    "rounding, and so is the bound",
                    view.level.norms.round_off));
  record_.statements.assumptions.emplace_back(
      "linear_solver",
      describe_solver(view.level.steps) +
          (view.level.tightened ? ", beyond solver.tolerance on the last mesh, where it was too loose" : ""));
}

template <int dim>
io::LevelTimes RunReport<dim>::take_back(int number)
{
  if (record_.levels.empty() || record_.levels.back().level != number) return {};
  const io::LevelTimes times = record_.levels.back().times;
  record_.levels.pop_back();
  return times;
}

template <int dim>
void RunReport<dim>::add(const adapt::LevelView<dim>& view)
{
  const contact::NitscheForm<dim>& form = view.discrete.form;
  const io::LevelTimes before = take_back(view.number);
  const bool again = before.level > 0;
  const Clock::time_point before_output = Clock::now();
  io::LevelRecord& level = record_.levels.emplace_back(io::level_record<dim>(view, moment_about_));
  std::exception_ptr failure;
  if (level.bound) failure = failure_of([&] { take(view); });
  const double output = seconds_since(before_output);
  level.times.stages.output = before.stages.output + output;
  level.times.level += level.times.stages.output;
  const double cpu_now = cpu_seconds();
  level.times.level_cpu = before.level_cpu + cpu_now - std::exchange(cpu_before_, cpu_now);
  update_statements(view);
  record_.status = view.verdict.status;
  record_.reason = view.verdict.reason;
  record_.warnings =
      view.level.solved()
          ? doctor::run_warnings({level.bound, level.figures.sigma_norm, level.figures.max_displacement},
                                 doctor::contact_outcomes<dim>(form, view.level.u))
          : std::vector<doctor::Finding>{};
  if (!failure && (writes_all_levels() || seconds_since(written_) > most_lost))
    failure = failure_of([&] { write_record(); });
  if (printed_ != Printed::verdict && !again) print_level(level);
  if (failure) std::rethrow_exception(failure);
}

template <int dim>
void RunReport<dim>::write_record()
{
  io::write_report(output_.directory, record_);
  written_ = Clock::now();
}

template <int dim>
void RunReport<dim>::write_what_holds()
{
  std::exception_ptr failure;
  if (last_)
  {
    const Clock::time_point before_output = Clock::now();
    if (!writes_all_levels()) failure = failure_of([&] { write_fields(*last_); });
    page_.add_last(last_->number, last_->discrete->form, last_->level);
    const double output = seconds_since(before_output);
    io::LevelTimes& times = record_.levels.back().times;
    times.stages.output += output;
    times.level += output;
    const double cpu_now = cpu_seconds();
    times.level_cpu += cpu_now - std::exchange(cpu_before_, cpu_now);
  }
  write_record();
  page_.write(output_.directory, record_);
  if (failure) std::rethrow_exception(failure);
}

template <int dim>
ExitCode RunReport<dim>::close(const certify::Verdict& verdict)
{
  record_.status = verdict.status;
  record_.reason = verdict.reason;
  write_what_holds();
  if (printed_ == Printed::everything) print_summary(record_, output_.directory.string());
  if (printed_ == Printed::verdict) print_verdict(record_, output_.directory.string());
  return exit_code(verdict.status);
}

template <int dim>
void RunReport<dim>::fail(const std::string& reason)
{
  record_.status = certify::RunStatus::failed;
  record_.reason = reason;
  write_what_holds();
}

template void write_level_fields(const std::filesystem::path&, int, const adapt::Discretisation<2>&,
                                 const adapt::CertifiedLevel<2>&, std::span<const io::CellField>);
template void write_level_fields(const std::filesystem::path&, int, const adapt::Discretisation<3>&,
                                 const adapt::CertifiedLevel<3>&, std::span<const io::CellField>);
template class RunReport<2>;
template class RunReport<3>;

}  // namespace tribound::app
