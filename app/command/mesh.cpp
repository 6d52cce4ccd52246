#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <system_error>

#include "app/command/commands.h"
#include "app/console/text.h"
#include "tribound/base/error.h"
#include "tribound/io/fields/imported_msh.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/mesh/import/node_sets.h"
#include "tribound/mesh/import/read.h"
#include "tribound/mesh/import/survey.h"

namespace tribound::app
{

namespace
{

/// "1200 tetrahedra of 10 nodes", a line for each type.
std::string element_lines(const mesh::ImportedMesh& mesh)
{
  std::map<std::string, std::size_t> n_of_type;
  for (const mesh::ElementBlock& block : mesh.cells) n_of_type[describe(block.type)] += block.size();
  std::string text;
  for (const auto& [type, n] : n_of_type)
    text += line(text.empty() ? "elements" : "", fmt::format("{} x {}", n, type));
  return text;
}

std::string extent_line(const mesh::ImportedMesh& mesh, int dim)
{
  std::string text;
  for (int k = 0; k < dim; ++k)
  {
    const auto [lower, upper] = std::ranges::minmax(mesh.nodes, {}, [k](const Point<3>& x) { return x[k]; });
    text += fmt::format("{}{} from {:.6g} to {:.6g}", text.empty() ? "" : ", ", "xyz"[k], lower[k], upper[k]);
  }
  return line("extent", text);
}

std::string survey_text(const mesh::ImportedMesh& imported, const mesh::Survey& found)
{
  const bool is_solid = found.dim == 3;
  std::string text = element_lines(imported) + extent_line(imported, found.dim);
  text += line("simplices", fmt::format("{} {} on {} vertices, in {}", found.n_cells,
                                        is_solid ? "tetrahedra" : "triangles", found.n_vertices,
                                        count(static_cast<long>(found.n_bodies), "body", "bodies")));
  for (const mesh::SurveyedGroup& region : found.regions)
    text += line("region", fmt::format("{}: {} cells, {} {:.6g}", region.name, region.n,
                                       is_solid ? "volume" : "area", region.measure));
  for (const mesh::SurveyedGroup& boundary : found.boundaries)
    text += line(boundary.is_inside ? "joint" : "boundary",
                 fmt::format("{}: {} facets, {} {:.6g}", boundary.name, boundary.n,
                             is_solid ? "area" : "length", boundary.measure));
  return text;
}

}  // namespace

void write_mesh(const MeshRequest& request)
{
  if (std::filesystem::path(request.output).extension() != ".msh")
    throw InputError({.file = request.output}, "is not the name of a .msh",
                     "tribound mesh part.step part.msh");
  std::error_code none;
  if (std::filesystem::equivalent(request.input.path, request.output, none))
    throw InputError({.file = request.output}, "is the mesh that is read", "another name");
  std::vector<std::string> notes;
  mesh::ImportedMesh imported =
      mesh::read_imported(request.input, &stop_on_signals(), mesh::default_patience, notes);
  add_node_sets(imported, notes);
  const mesh::SimplicialMesh simplicial = mesh::make_simplicial(imported);
  notes.insert(notes.end(), simplicial.notes.begin(), simplicial.notes.end());
  const mesh::Survey found = mesh::survey(simplicial);
  io::write_msh(request.output, imported);
  if (request.quiet) return;
  for (const std::string& text : notes) note(text);
  print(survey_text(imported, found) + line("written", request.output));
}

}  // namespace tribound::app
