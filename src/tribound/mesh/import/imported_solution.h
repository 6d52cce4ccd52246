#pragma once

/// @file imported_solution.h
/// Solutions of other programs, as their files have them.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/mesh/import/imported_mesh.h"

namespace tribound::mesh
{

/// A step of the displacement in a file.
struct SolutionStep
{
  int number = 0;  ///< as SolutionChoice::step has it
  double t = 0;    ///< its time
};

/// A displacement, and perhaps a stress, as a file has it, on the elements that the file has.
struct ImportedSolution
{
  ImportedMesh mesh{};                   ///< no cells: a list of points, numbered by the lines of the file
  std::vector<Point<3>> displacement{};  ///< per node; NaN in all components where the file has none
  std::vector<std::array<double, 6>> stress{};  ///< xx yy zz xy yz xz; NaN in all where there is none
  /// The stress has one entry per entry of the nodes of all blocks of mesh.cells, in order; else per node.
  bool stress_of_elements = false;
  bool stress_has_zz = true;          ///< else it is 0, since the file has none
  std::string description{};          ///< "CalculiX results, step 2 (t = 1), C3D10"
  std::vector<SolutionStep> steps{};  ///< all that the file has, as it has them; none where files have one
  std::vector<std::string> notes{};   ///< what was left out or chosen, "theirs.vtu: ..."
};

/// What to read of a file that has several fields or steps.
struct SolutionChoice
{
  std::string field{};        ///< the displacement; empty: by usual names
  std::string stress{};       ///< empty: by usual names, and a file may have none
  std::optional<int> step{};  ///< by the number that the file has; nothing: the last
};

/// Reads .csv, .msh, .vtu, .pvtu, .vtk, .pvd, .frd and .med, by the suffix.
///
/// CSV: a header with x, y, z, ux, uy, uz, sxx, syy, szz, sxy, syz, sxz in any order, in 2D without those of
/// z; columns between commas, semicolons, tabs or blanks; comments after '#', which the header may be, too.
/// `field` and `stress` replace the letters u and s.
///
/// VTK: arrays of points. The components of the stress are those that their names end with, such as SIXX, if
/// the file names all. Else they are 9 (tensors by rows: the symmetric part is taken), 6 (xx, yy, zz, xy, yz,
/// xz), 4 (xx, yy, zz, xy; or where the two in the middle are equal everywhere, a tensor of 2D by rows) or 3
/// (xx, yy, xy). Where pieces have the same point, it has the values of the first.
///
/// .msh: views by name, of nodes, of nodes of elements, or (only stress) of elements. Displacements have 2 or
/// 3 components, stresses those of VTK. Steps are counted as in the file, from 0.
///
/// .frd of CalculiX, as text: steps are those of the deck; the last increment of a step is read.
///
/// .pvd: the .vtu, .pvtu or .vtk of a time. Steps are counted as in the file, from 1.
///
/// .med of the versions 3 and 4: fields of nodes, which may be on profiles; components and names as of VTK's
/// arrays. Steps are the numbers of the times (NDT).
///
/// Components that a plane file does not have are 0. Throws InputError with the file and the line, node or
/// array.
[[nodiscard]] ImportedSolution read_solution(const std::filesystem::path& file, const SolutionChoice& choice);

}  // namespace tribound::mesh
