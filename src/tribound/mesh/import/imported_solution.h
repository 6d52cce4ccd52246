#pragma once

/// @file imported_solution.h
/// What another program has computed, as a file has it.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tribound/mesh/import/imported_mesh.h"

namespace tribound::mesh
{

/// A displacement, and perhaps a stress, as a file has it, on the elements that the file has.
struct ImportedSolution
{
  ImportedMesh mesh{};  ///< nodes and cells; no cells: a list of points (CSV). No sets needed
  std::vector<Point<3>> displacement{};         ///< per node; NaN where the file has none
  std::vector<std::array<double, 6>> stress{};  ///< xx yy zz xy yz xz per node; empty: none
  bool stress_of_elements = false;   ///< then one entry per entry of the nodes of all blocks of mesh.cells
  std::string description{};         ///< "CalculiX results, step 2 (t = 1), C3D10" for the judgement
  std::vector<std::string> notes{};  ///< what was left out, "theirs.vtu: ..."
};

struct SolutionChoice
{
  std::string field{};
  std::string stress{};
  std::optional<int> step{};
};

[[nodiscard]] ImportedSolution read_solution(const std::filesystem::path& file, const SolutionChoice& choice);

}  // namespace tribound::mesh
