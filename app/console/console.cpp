#include "app/console/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "app/console/balance_text.h"
#include "app/console/text.h"
#include "app/result/check_json.h"
#include "tribound/io/record/error_bars.h"

namespace tribound::app
{

namespace
{

std::string count(long n, std::string_view singular, std::string_view plural)
{
  return fmt::format("{} {}", n, n == 1 ? singular : plural);
}

/// line(), or nothing for an empty text.
std::string line_if_any(std::string_view caption, std::string_view text)
{
  return text.empty() ? std::string{} : line(caption, text);
}

/// Width of the widest name in a list of regions or boundaries.
template <typename Parts>
std::size_t name_width(const Parts& parts)
{
  std::size_t width = 0;
  for (const auto& part : parts) width = std::max(width, part.name.size());
  return width;
}

std::string mesh_line(const io::MeshFacts& mesh)
{
  return line("mesh",
              fmt::format("{}, {}, h from {:.4g} to {:.4g}", count(mesh.vertices, "vertex", "vertices"),
                          count(mesh.cells, "cell", "cells"), mesh.smallest_cell, mesh.largest_cell));
}

std::string method_line(const io::CaseFacts& facts, const io::MeshFacts& mesh)
{
  return line("method", fmt::format("{}D, degree {}, {} free degrees of freedom, gamma_0 = {:g}",
                                    facts.dimension, facts.degree, mesh.free_dofs, facts.gamma0));
}

std::string resultants_line(std::string_view caption, std::string_view boundary, const io::Resultants& r)
{
  return line(caption, fmt::format("{}: normal {:.8g}, tangential {:.8g}, force ({:.8g})", boundary, r.normal,
                                   r.tangential, fmt::join(r.force, ", ")));
}

/// For a boundary with Coulomb friction: N and H are the normal and the tangential resultant.
std::string sliding_line(const io::Resultants& r)
{
  const std::optional<io::Sliding> state = io::sliding(r);
  if (!state) return {};
  const std::string safety = state->safety_factor
                                 ? fmt::format("factor of safety mu_F N/H = {:.4g}", *state->safety_factor)
                                 : "no sliding force";
  return line("sliding", fmt::format("{}: sliding factor H/N = {:.4g}, mu_F = {:g}: {}", r.boundary,
                                     state->sliding_factor, state->coefficient, safety));
}

/// A text broken into lines of at most `width` characters, the later ones indented below the first.
std::string wrapped(std::string_view text, std::size_t width)
{
  std::string result;
  while (text.size() > width)
  {
    const std::size_t space = text.rfind(' ', width);
    if (space == std::string_view::npos || space == 0) break;
    result += std::string(text.substr(0, space)) + "\n" + std::string(caption_width, ' ');
    text.remove_prefix(space + 1);
  }
  return result + std::string(text);
}

std::string paragraph(std::string_view caption, std::string_view text)
{
  return line(caption, wrapped(text, 80 - caption_width));
}

/// Component by component with its share of the sum of squares.
std::string component_lines(const certify::BoundComponents& components, const certify::RunKind& kind)
{
  constexpr double round_off = 1e-9;  // as on the page
  std::vector<certify::Component> all = certify::components_of_run(kind);
  std::erase_if(all, [](const certify::Component& c) { return !c.is_summand(); });
  double squares = 0;
  for (const certify::Component& c : all) squares += components.*c.value * components.*c.value;
  std::string text;
  for (const certify::Component& c : all)
  {
    double value = components.*c.value;
    if (value <= round_off * std::sqrt(squares)) value = 0;
    if (value == 0 && !c.is_of_cells()) continue;
    const double share = squares > 0 ? 100 * value * value / squares : 0;
    text += line("", fmt::format("{:<5}  {:<26}  {:>12.5g}  {:>5.1f} %", c.name, c.meaning, value, share));
  }
  return text;
}

}  // namespace

std::string header_text(const io::CaseFacts& facts, const io::MeshFacts& mesh)
{
  return line("case", facts.title.empty() ? facts.file : facts.title) + mesh_line(mesh) +
         method_line(facts, mesh);
}

std::string newton_text(const solve::NewtonStep& step, std::optional<double> relative_bound)
{
  const std::string bound = relative_bound ? fmt::format("bound {:.2e}  ", *relative_bound) : std::string{};
  const std::string damping =
      step.damping < 1 ? fmt::format("damping {:.1g}  ", step.damping) : std::string{};
  const std::string iterations = fmt::format("GMRES {}", step.linear_iterations);
  const std::string direct = step.factorised ? "factorised" : "direct";
  return fmt::format("  step {:>2}  residual {:.1e}  {}{}{}, {:.1f} s\n", step.step, step.residual, bound,
                     damping, step.linear_iterations == 0 ? direct : iterations, step.seconds);
}

std::string level_text(const io::LevelRecord& level)
{
  const std::optional<double> relative =
      level.load_step ? io::bound_along_path(level) : io::relative_bound(level);
  const std::string bound = relative                  ? fmt::format("{:.4g} %", 100 * *relative)
                            : !level.bound            ? std::string("none")
                            : io::is_round_off(level) ? std::string("rounding")
                                                      : fmt::format("{:.4g}", level.bound->total_sharp);
  if (level.load_step)
    return line(fmt::format("step {}", level.level),
                fmt::format("t = {:<12.9g}  newton {:>2}  bound {:<8}  {:.2f} s{}{}", level.load_step->t,
                            io::newton_steps(level), bound, level.times.level,
                            level.load_step->control == "load" ? "" : "  by " + level.load_step->control,
                            level.load_step->cuts > 0 ? fmt::format("  cut {} times", level.load_step->cuts)
                                                      : std::string()));
  return line(fmt::format("level {}", level.level),
              fmt::format("{:>8} cells  {:>8} dofs  newton {:>2}  bound {:<8}  {:.2f} s", level.cells,
                          level.dofs, io::newton_steps(level), bound, level.times.level));
}

std::string mesh_text(std::string_view caption, std::int64_t cells, std::int64_t dofs)
{
  return line(caption, fmt::format("{} cells, {} degrees of freedom", cells, dofs));
}

namespace
{

/// The bound of the error in the energy norm, or why there is none, and the quantities with their intervals.
std::string energy_lines(const io::LevelRecord& level)
{
  if (!level.energy) return {};
  std::string quantities;
  for (const certify::QuantityInterval& quantity : level.energy->quantities)
    quantities +=
        paragraph(quantities.empty() ? "quantities" : "", quantity.name + ": " + io::words_of(quantity));
  if (!level.energy->reason.empty())
    return paragraph("energy error", "no bound: " + level.energy->reason) + quantities;
  const auto relative = io::relative_energy_bound(level);
  return paragraph(
             "energy error",
             fmt::format("at most {:.6g}{}: the distance from {}", level.energy->bound,
                         relative ? fmt::format(", {:.4g} % of ||u_h||_en", 100 * *relative) : std::string(),
                         io::words_of(level.energy->target))) +
         quantities;
}

}  // namespace

std::string certificate_text(const io::RunRecord& run)
{
  if (run.levels.empty() || !run.levels.back().bound) return {};
  const io::LevelRecord& level = run.levels.back();
  const certify::Bound& bound = *level.bound;
  const std::optional<double> relative = io::relative_bound(level);
  std::string text =
      line("bound", fmt::format("{:.6g}, {} (plain sums: {:.6g})", bound.total_sharp,
                                relative ? fmt::format("that is {:.4g} % of ||sigma(u_h)||", 100 * *relative)
                                : io::is_round_off(level) ? std::string("rounding, as the stress is")
                                                          : std::string("of a stress that is zero"),
                                bound.total));
  text += component_lines(bound.global, io::run_kind(level));
  if (level.identities)
    text +=
        line("identities", fmt::format("hold to {:.1e} of ||sigma_h|| (limit {:g})",
                                       level.identities->largest(run.facts.degree), certify::identity_limit));
  text += energy_lines(level);
  for (const std::string& covered : run.statements.covered) text += paragraph("guaranteed", covered);
  text += paragraph("law", run.statements.law);
  for (const std::string& outside : run.statements.not_covered) text += paragraph("outside", outside);
  return text;
}

std::string warnings_text(std::span<const doctor::Finding> warnings)
{
  std::string text;
  for (const doctor::Finding& warning : warnings)
  {
    const std::string where = doctor::location(warning);
    text += paragraph("warning", where.empty() ? warning.text : fmt::format("{}: {}", where, warning.text));
  }
  return text;
}

std::string summary_text(const io::RunRecord& run, const std::string& directory)
{
  std::string text;
  if (!run.levels.empty())
  {
    const io::LevelRecord& last = run.levels.back();
    for (const io::Resultants& part : last.figures.boundary_contact)
      text += resultants_line("contact", part.boundary, part);
    if (last.figures.boundary_contact.size() > 1) text += resultants_line("", "in all", last.figures.contact);
    for (const io::Resultants& part : last.figures.boundary_contact) text += sliding_line(part);
    if (last.balance) text += balance_text(*last.balance);
    text += line("max |u|", fmt::format("{:.8g}", last.figures.max_displacement));
    text += line("energy", fmt::format("a(u, u) = {:.8g}, ||sigma|| = {:.8g}", last.figures.energy,
                                       last.figures.sigma_norm));
    text += certificate_text(run);
    text += warnings_text(run.warnings);
  }
  return text + verdict_text(run, directory);
}

namespace
{

std::string path_text(const adapt::PathEnd& path)
{
  std::string text;
  if (path.peak)
    text += line("peak",
                 fmt::format("t = {:.9g} at load step {}{}", path.peak->t, path.peak->number,
                             path.peak->change
                                 ? fmt::format("; halving its steps changed it by {:.2g}", *path.peak->change)
                                 : std::string(", as its steps have it: halved ones could not be followed")));
  if (!path.dropped.empty())
    text += line("left out",
                 fmt::format("t = {}: from there on damage was given, not t", fmt::join(path.dropped, ", ")));
  for (const std::string& note : path.notes) text += line("path", note);
  return text;
}

/// The path followed once more, where it was.
std::string comparison_text(const io::RunRecord& run)
{
  if (!run.check) return {};
  const io::HistoryCheck& check = *run.check;
  if (!check.end.failure.empty())
    return paragraph("check", "half the steps on a finer mesh: " + check.end.failure);
  std::string text =
      fmt::format("half the steps on {}, not guaranteed:", count(check.cells, "cell", "cells"));
  const io::LoadStepRecord last = io::last_load_step(run).value_or(io::LoadStepRecord());
  for (const io::ComparedFigure& figure : io::compare(run.path, last, check))
    if (const std::optional<double> difference = figure.difference())
    {
      const bool is_rounding = std::abs(*difference) <= 1e-9 * std::abs(*figure.path);
      text += fmt::format(" {} {:.6g} ({:+.2g}),", figure.word, *figure.check, is_rounding ? 0 : *difference);
    }
  text.pop_back();
  return paragraph("check", text);
}

}  // namespace

std::string verdict_text(const io::RunRecord& run, const std::string& directory)
{
  std::string reason = run.reason;
  if (run.status == certify::RunStatus::certified && io::has_history(run))
    reason = fmt::format(
        "the bound of every load step is at most adapt.tolerance = {:g} % of the largest "
        "||sigma(u_h)|| of the path up to it",
        100 * run.tolerance);
  else if (run.status == certify::RunStatus::certified)
    reason = run.levels.empty() || !io::is_round_off(run.levels.back())
                 ? fmt::format("the bound is at most adapt.tolerance = {:g} % of ||sigma(u_h)||",
                               100 * run.tolerance)
                 : std::string("the stress is zero up to rounding, and so is the bound of its error");
  return path_text(run.path) + comparison_text(run) +
         line("status", certify::to_string(run.status) + (reason.empty() ? "" : ": " + reason)) +
         line_if_any("results", directory);
}

std::string check_text(const io::CaseFacts& facts, const io::MeshFacts& mesh, const std::string& solver)
{
  const char* unit = facts.dimension == 2 ? "area" : "volume";
  std::string text = header_text(facts, mesh);
  text += line_if_any("solver", solver);
  text += "regions\n";
  for (const io::RegionFacts& region : mesh.regions)
    text += fmt::format("  {:<{}}  {}, {} {:.6g}: {}\n", region.name, name_width(mesh.regions),
                        count(region.cells, "cell", "cells"), unit, region.measure, region.material);
  text += "boundaries\n";
  for (const io::BoundaryFacts& boundary : mesh.boundaries)
    text += fmt::format("  {:<{}}  {}, {} {:.6g}: {}\n", boundary.name, name_width(mesh.boundaries),
                        count(boundary.facets, "facet", "facets"), facts.dimension == 2 ? "length" : "area",
                        boundary.measure, boundary.condition);
  return text;
}

std::string findings_text(std::span<const doctor::Finding> findings)
{
  std::string text = "findings\n";
  for (const doctor::Finding& finding : findings)
  {
    text += paragraph(fmt::format("  {}", doctor::to_string(finding.severity)), finding.text);
    if (!finding.advice.empty()) text += paragraph("", "-> " + finding.advice);
  }
  const auto how_many = [&](doctor::Severity severity)
  { return std::ranges::count(findings, severity, &doctor::Finding::severity); };
  return text + line("in all",
                     fmt::format("{}, {}", count(how_many(doctor::Severity::warning), "warning", "warnings"),
                                 count(how_many(doctor::Severity::note), "note", "notes")));
}

std::string info_text(const io::BuildFacts& build)
{
  const std::string threads =
      build.blas_threads > 0 ? ", " + count(build.blas_threads, "thread", "threads") : std::string{};
  return line("tribound", build.version) + line("compiler", build.compiler) +
         line_if_any("PETSc", build.petsc) + line_if_any("MUMPS", build.mumps) +
         line_if_any("Gmsh", build.gmsh) +
         line_if_any("BLAS", build.blas.empty() ? "" : build.blas + threads) + line_if_any("MPI", build.mpi) +
         line_if_any("Eigen", build.eigen) +
         line_if_any("features", fmt::format("{}", fmt::join(build.features, ", "))) +
         line("report page", build.report_page.empty() ? "none: Tribound was built without Node.js and npm"
                                                       : build.report_page);
}

void print_header(const io::CaseFacts& facts, const io::MeshFacts& mesh)
{
  print(header_text(facts, mesh));
}

void print_level(const io::LevelRecord& level)
{
  print(level_text(level));
}

void print_mesh(std::string_view caption, std::int64_t cells, std::int64_t dofs)
{
  print(mesh_text(caption, cells, dofs));
}

void print_summary(const io::RunRecord& run, const std::string& directory)
{
  print(summary_text(run, directory));
}

void print_verdict(const io::RunRecord& run, const std::string& directory)
{
  print(warnings_text(run.warnings) + verdict_text(run, directory));
}

void print_check(const io::CaseFacts& facts, const io::MeshFacts& mesh, const std::string& solver,
                 std::span<const doctor::Finding> findings, bool as_json)
{
  print(as_json ? check_json(facts, mesh, solver, findings)
                : check_text(facts, mesh, solver) + findings_text(findings));
}

void print_info(const io::BuildFacts& build)
{
  print(info_text(build));
}

Progress::Progress(bool quiet) : quiet_(quiet), shown_(!quiet && ::isatty(STDERR_FILENO) == 1) {}

void Progress::operator()(const solve::NewtonStep& step, std::optional<double> relative_bound) const
{
  show(newton_text(step, relative_bound));
}

void Progress::stage(const std::string& text) const
{
  show(text + "\n");
}

void Progress::show(const std::string& text) const
{
  if (shown_) (void)std::fputs(text.c_str(), stderr);
}

}  // namespace tribound::app
