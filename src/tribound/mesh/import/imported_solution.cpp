#include "tribound/mesh/import/imported_solution.h"

#include <fmt/format.h>

#include <system_error>

#include "tribound/mesh/import/file_text.h"
#include "tribound/mesh/import/solution_values.h"

namespace tribound::mesh
{

ImportedSolution read_solution(const std::filesystem::path& file, const SolutionChoice& choice)
{
  const Where where{.file = file.string()};
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw InputError(where, "the file does not exist", "a file with the displacement of another program");
  const std::string suffix = suffix_of(file);
  if (suffix == ".frd") return read_frd(file, choice);
  if (suffix == ".msh") return read_gmsh_solution(file, choice);
  const bool is_vtk = suffix == ".vtu" || suffix == ".pvtu" || suffix == ".vtk";
  if (choice.step && (is_vtk || suffix == ".csv"))
    throw InputError(where, fmt::format("a {} has no steps to choose from", suffix),
                     "leave the step out, and name the file of the step that is wanted");
  if (is_vtk) return read_vtk_solution(file, choice);
  if (suffix == ".pvd") return read_pvd(file, choice);
  if (suffix == ".csv") return read_csv(file, choice);
  if (suffix == ".med") return read_med_solution(file, choice);
  throw InputError(
      where, fmt::format("solutions of the format \"{}\" are not read", suffix),
      ".csv, .msh, .vtu, .pvtu, .vtk, .pvd, .frd and .med are; ParaView saves what it reads as .vtu");
}

}  // namespace tribound::mesh
