#include <fmt/format.h>

#include <algorithm>

#include "tribound/mesh/import/solution_values.h"
#include "tribound/mesh/import/vtk.h"
#include "tribound/mesh/import/vtk_file.h"

namespace tribound::mesh
{

namespace
{

/// The arrays that all pieces have, with the same number of components.
std::vector<FieldName> fields_of(const VtkFile& file)
{
  std::vector<FieldName> fields;
  for (const VtkArray& array : file.pieces.front().point_data)
  {
    const bool is_everywhere = std::ranges::all_of(
        file.pieces,
        [&](const VtkPiece& piece)
        {
          const VtkArray* same = find(piece.point_data, array.name);
          return same && same->type != VtkType::other && same->n_components == array.n_components;
        });
    if (is_everywhere) fields.push_back({array.name, array.n_components, array.component_names});
  }
  return fields;
}

/// The values of the points of all pieces, of which `nodes` are wanted.
std::vector<double> values_at(const VtkFile& file, const FieldName& field,
                              std::span<const std::int64_t> nodes)
{
  std::vector<double> all;
  for (const VtkPiece& piece : file.pieces)
  {
    const std::vector<double> values = values_of<double>(*find(piece.point_data, field.name),
                                                         piece.n_points * field.n_components, piece.where);
    all.insert(all.end(), values.begin(), values.end());
  }
  std::vector<double> result;
  result.reserve(nodes.size() * field.n_components);
  for (const std::int64_t node : nodes)
  {
    const auto begin = all.begin() + node * static_cast<std::int64_t>(field.n_components);
    result.insert(result.end(), begin, begin + static_cast<std::ptrdiff_t>(field.n_components));
  }
  return result;
}

}  // namespace

/// The numbers of the nodes of read_vtk() are places among the points of all pieces.
ImportedSolution read_vtk_solution(const std::filesystem::path& path, const SolutionChoice& choice)
{
  ImportedSolution solution;
  solution.mesh = read_vtk(path, {}, solution.notes);
  const Where where = solution.mesh.source;
  const VtkFile file = open_vtk(path);
  const std::vector<FieldName> fields = fields_of(file);
  const FieldName& field = fields[choose_displacement(fields, choice.field, where, "point arrays")];
  const std::vector<double> values = values_at(file, field, solution.mesh.node_numbers);
  solution.displacement = displacements_of(values, field);
  solution.description = fmt::format("VTK's point array \"{}\"", field.name);
  if (const auto stress = choose_stress(fields, choice.stress, where, "point arrays"))
  {
    set_stress(values_at(file, fields[*stress], solution.mesh.node_numbers), fields[*stress], where,
               solution);
    solution.description += fmt::format(", stress \"{}\"", fields[*stress].name);
  }
  solution.description += ", " + element_words(solution.mesh);
  return solution;
}

}  // namespace tribound::mesh
