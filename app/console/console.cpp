#include "app/console/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string_view>

#include "app/console/text.h"
#include "app/host.h"

namespace tribound::app
{

using problem::UnitOf;

namespace
{

/// Width of the widest name in a list of regions or boundaries.
template <typename Parts>
std::size_t name_width(const Parts& parts)
{
  std::size_t width = 0;
  for (const auto& part : parts) width = std::max(width, part.name.size());
  return width;
}

/// The units of numbers printed without a unit; empty where the case names none.
std::string units_line(const io::CaseFacts& facts)
{
  if (!facts.units.are_named()) return {};
  return line("units", fmt::format("lengths in {}, stresses in {}, forces in {}, bounds in {}",
                                   facts.label(UnitOf::length), facts.label(UnitOf::stress),
                                   facts.label(UnitOf::force), facts.label(UnitOf::stress_norm)));
}

std::string mesh_line(const io::CaseFacts& facts, const io::MeshFacts& mesh)
{
  return line("mesh",
              fmt::format("{}, {}, h from {:.4g} to {:.4g}{}", count(mesh.vertices, "vertex", "vertices"),
                          count(mesh.cells, "cell", "cells"), mesh.smallest_cell, mesh.largest_cell,
                          facts.behind(UnitOf::length)));
}

std::string method_line(const io::CaseFacts& facts, const io::MeshFacts& mesh)
{
  const std::string model = facts.is_axisymmetric ? "axisymmetric" : fmt::format("{}D", facts.dimension);
  return line("method", fmt::format("{}, degree {}, {} free degrees of freedom, gamma_0 = {:g}", model,
                                    facts.degree, mesh.free_dofs, facts.gamma0));
}

}  // namespace

Host& host()
{
  static Host of_process;
  return of_process;
}

void print(std::string_view text)
{
  if (host().print) return host().print(text);
  (void)std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

void note(std::string_view text)
{
  if (host().note) return host().note(text);
  fmt::print(stderr, "tribound: note: {}\n", text);
}

std::string paragraph(std::string_view caption, std::string_view text)
{
  const std::size_t width = 80 - caption_width;
  std::string lines;
  while (text.size() > width)
  {
    const std::size_t space = text.rfind(' ', width);
    if (space == std::string_view::npos || space == 0) break;
    lines += std::string(text.substr(0, space)) + "\n" + std::string(caption_width, ' ');
    text.remove_prefix(space + 1);
  }
  return line(caption, lines + std::string(text));
}

std::string header_text(const io::CaseFacts& facts, const io::MeshFacts& mesh)
{
  return line("case", facts.title.empty() ? facts.file : facts.title) + units_line(facts) +
         mesh_line(facts, mesh) + method_line(facts, mesh);
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

std::string check_text(const io::CaseFacts& facts, const io::MeshFacts& mesh, const std::string& solver)
{
  const char* size = facts.body_dimension() == 2 ? "area" : "volume";
  std::string text = header_text(facts, mesh);
  text += line_if_any("solver", solver);
  text += "regions\n";
  for (const io::RegionFacts& region : mesh.regions)
    text += fmt::format("  {:<{}}  {}, {} {:.6g}{}: {}\n", region.name, name_width(mesh.regions),
                        count(region.cells, "cell", "cells"), size, region.measure,
                        facts.behind(UnitOf::body), region.material);
  text += "boundaries\n";
  for (const io::BoundaryFacts& boundary : mesh.boundaries)
    text += fmt::format("  {:<{}}  {}, {} {:.6g}{}: {}\n", boundary.name, name_width(mesh.boundaries),
                        count(boundary.facets, "facet", "facets"),
                        facts.body_dimension() == 2 ? "length" : "area", boundary.measure,
                        facts.behind(UnitOf::boundary), boundary.condition);
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

std::string info_text(const io::BuildFacts& build, const std::string& report_page)
{
  const std::string threads =
      build.blas_threads > 0 ? ", " + count(build.blas_threads, "thread", "threads") : std::string{};
  return line("tribound", build.version) + line("compiler", build.compiler) +
         line_if_any("PETSc", build.petsc) + line_if_any("MUMPS", build.mumps) +
         line_if_any("Gmsh", build.gmsh) +
         line_if_any("BLAS", build.blas.empty() ? "" : build.blas + threads) + line_if_any("MPI", build.mpi) +
         line_if_any("Eigen", build.eigen) +
         line_if_any("features", fmt::format("{}", fmt::join(build.features, ", "))) +
         line("report page",
              report_page.empty() ? "none: Tribound was built without Node.js and npm" : report_page);
}

Progress::Progress(bool quiet) : quiet_(quiet), shown_(!quiet && ::isatty(STDERR_FILENO) == 1) {}

void Progress::operator()(const adapt::CertifiedStep& step) const
{
  show(newton_text(step.step, step.relative));
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
