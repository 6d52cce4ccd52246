#pragma once

/// @file solution_values.h
/// What the readers of solutions share: names, components, missing values.

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tribound/mesh/import/imported_solution.h"

namespace tribound::mesh
{

using StressValues = std::array<double, 6>;

/// NaN in all components if one is no finite number.
[[nodiscard]] Point<3> displacement_of(const std::array<double, 3>& components);
[[nodiscard]] StressValues finite_stress(const StressValues& stress);

extern const Point<3> no_displacement;
extern const StressValues no_stress;

/// A field as a file names it.
struct FieldName
{
  std::string name;
  std::size_t n_components;
  std::vector<std::string> component_names{};  ///< one for each, or none
};

/// The place of the displacement in `fields`: that with the name `wanted`, or if it is empty the first usual
/// one. Throws InputError that says what `fields` has; `kind` is "point arrays" or "views".
[[nodiscard]] std::size_t choose_displacement(std::span<const FieldName> fields, const std::string& wanted,
                                              const Where& where, std::string_view kind);
/// The same for the stress; nothing if none is wanted and none has a usual name.
[[nodiscard]] std::optional<std::size_t> choose_stress(std::span<const FieldName> fields,
                                                       const std::string& wanted, const Where& where,
                                                       std::string_view kind);

/// Displacements of 2 or 3 components each, or of DX, DY, DZ where components of other kinds are between
/// them.
[[nodiscard]] std::vector<Point<3>> displacements_of(std::span<const double> values, const FieldName& field);

/// Sets the stress of `solution` to these values of 3, 4, 6 or 9 components each, in the orders of
/// imported_solution.h. What is not evident goes to its notes.
void set_stress(std::span<const double> values, const FieldName& field, const Where& where,
                ImportedSolution& solution);

/// "tetrahedra of ..." of all blocks: "tetrahedron of 10 nodes, prism of 15 nodes".
[[nodiscard]] std::string element_words(const ImportedMesh& mesh);

// The readers, one for each format.
[[nodiscard]] ImportedSolution read_csv(const std::filesystem::path& file, const SolutionChoice& choice);
[[nodiscard]] ImportedSolution read_frd(const std::filesystem::path& file, const SolutionChoice& choice);
[[nodiscard]] ImportedSolution read_gmsh_solution(const std::filesystem::path& file,
                                                  const SolutionChoice& choice);
[[nodiscard]] ImportedSolution read_med_solution(const std::filesystem::path& file,
                                                 const SolutionChoice& choice);
[[nodiscard]] ImportedSolution read_pvd(const std::filesystem::path& file, const SolutionChoice& choice);
[[nodiscard]] ImportedSolution read_vtk_solution(const std::filesystem::path& file,
                                                 const SolutionChoice& choice);

}  // namespace tribound::mesh
