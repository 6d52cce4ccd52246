#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tribound/mesh/import/hdf5_group.h"
#include "tribound/mesh/import/imported_bytes.h"
#include "tribound/mesh/import/med.h"
#include "tribound/mesh/import/read_apart.h"
#include "tribound/mesh/import/solution_values.h"
#include "tribound/mesh/import/text_lines.h"

namespace tribound::mesh
{

namespace
{

/// The fields on the nodes, in the group CHA: each has groups of times, with a group NOE of profiles.
class MedFields
{
 public:
  MedFields(const std::filesystem::path& file, const SolutionChoice& choice, std::size_t n_nodes)
      : where_{.file = file.string()}, file_(file), choice_(choice), n_nodes_(n_nodes)
  {
    if (!file_.has("CHA")) return;
    const Hdf5Group fields = file_.group("CHA");
    for (const std::string& name : fields.names())
      if (is_of_nodes(fields.group(name))) fields_.push_back(field_of(name, fields.group(name)));
  }

  /// All but the mesh.
  ImportedSolution read() const;

 private:
  [[nodiscard]] static bool is_of_nodes(const Hdf5Group& field);
  [[nodiscard]] FieldName field_of(const std::string& name, const Hdf5Group& field) const;
  [[nodiscard]] std::optional<Hdf5Group> time_of(const FieldName& field,
                                                 std::optional<std::int64_t> step) const;
  [[nodiscard]] std::vector<SolutionStep> steps_of(const FieldName& field) const;
  [[nodiscard]] std::vector<double> values_of(const FieldName& field, const Hdf5Group& time) const;
  void add_profile(const Hdf5Group& nodes, const std::string& profile, const FieldName& field,
                   std::vector<double>& values) const;

  Where where_;
  Hdf5Group file_;
  SolutionChoice choice_;
  std::size_t n_nodes_;
  std::vector<FieldName> fields_{};
};

bool MedFields::is_of_nodes(const Hdf5Group& field)
{
  return std::ranges::any_of(field.names(),
                             [&](const std::string& time) { return field.group(time).has("NOE"); });
}

/// The names of the components have 16 characters each.
FieldName MedFields::field_of(const std::string& name, const Hdf5Group& field) const
{
  constexpr std::size_t length = 16;
  const std::int64_t n = field.attribute("NCO").value_or(0);
  if (n < 1 || n > 1000)
    throw InputError(where_, fmt::format("field \"{}\" has {} components", name, n),
                     "the file is damaged: save the field again");
  FieldName result{name, static_cast<std::size_t>(n)};
  std::string names = field.text("NOM").value_or("");
  names.resize(length * result.n_components, ' ');
  for (std::size_t i = 0; i < result.n_components; ++i)
    result.component_names.emplace_back(trimmed(std::string_view(names).substr(length * i, length)));
  return result;
}

/// The last one, or that of the step.
std::optional<Hdf5Group> MedFields::time_of(const FieldName& field, std::optional<std::int64_t> step) const
{
  const Hdf5Group group = file_.group("CHA").group(field.name);
  std::optional<Hdf5Group> found;
  for (const std::string& name : group.names())
    if (Hdf5Group time = group.group(name);
        time.has("NOE") && (!step || time.attribute("NDT").value_or(0) == *step))
      found = std::move(time);
  return found;
}

/// Of times with the same number, the last one, as time_of() has it.
std::vector<SolutionStep> MedFields::steps_of(const FieldName& field) const
{
  std::vector<SolutionStep> steps;
  const Hdf5Group group = file_.group("CHA").group(field.name);
  for (const std::string& name : group.names())
  {
    const Hdf5Group time = group.group(name);
    if (!time.has("NOE")) continue;
    const auto number = static_cast<int>(time.attribute("NDT").value_or(0));
    std::erase_if(steps, [&](const SolutionStep& step) { return step.number == number; });
    steps.push_back({number, time.real("PDT").value_or(0)});
  }
  return steps;
}

/// All values of the first component, all of the second, ...
void MedFields::add_profile(const Hdf5Group& nodes, const std::string& profile, const FieldName& field,
                            std::vector<double>& values) const
{
  const std::vector<double> numbers = nodes.group(profile).numbers("CO");
  const bool is_of_some = profile != "MED_NO_PROFILE_INTERNAL";
  std::vector<std::int64_t> some;
  if (is_of_some) some = file_.group("PROFILS").group(profile).integers("PFL");
  const std::size_t n = is_of_some ? some.size() : n_nodes_;
  if (numbers.size() != n * field.n_components)
    throw InputError(where_,
                     fmt::format("field \"{}\" has {} numbers for {} components of {} nodes", field.name,
                                 numbers.size(), field.n_components, n),
                     "a field of the mesh that the file has");
  for (std::size_t v = 0; v < n; ++v)
  {
    const std::int64_t node = is_of_some ? some[v] - 1 : static_cast<std::int64_t>(v);
    if (node < 0 || node >= static_cast<std::int64_t>(n_nodes_))
      throw InputError(where_, fmt::format("profile \"{}\" has node {} of {}", profile, node + 1, n_nodes_),
                       "the file is damaged: save the field again");
    for (std::size_t i = 0; i < field.n_components; ++i)
      values[static_cast<std::size_t>(node) * field.n_components + i] = numbers[i * n + v];
  }
}

std::vector<double> MedFields::values_of(const FieldName& field, const Hdf5Group& time) const
{
  std::vector<double> values(n_nodes_ * field.n_components, std::nan(""));
  const Hdf5Group nodes = time.group("NOE");
  for (const std::string& profile : nodes.names()) add_profile(nodes, profile, field, values);
  return values;
}

ImportedSolution MedFields::read() const
{
  ImportedSolution solution;
  const FieldName& field = fields_[choose_displacement(fields_, choice_.field, where_, "fields of nodes")];
  const auto time = time_of(field, choice_.step);
  if (!time)
    throw InputError(where_, fmt::format("field \"{}\" has no step {}", field.name, choice_.step.value_or(0)),
                     "the number of a time (NDT) of the field");
  solution.steps = steps_of(field);
  solution.displacement = displacements_of(values_of(field, *time), field);
  const std::int64_t step = time->attribute("NDT").value_or(0);
  solution.description = fmt::format("MED field \"{}\", step {}", field.name, step);
  const auto stress = choose_stress(fields_, choice_.stress, where_, "fields of nodes");
  if (!stress) return solution;
  const FieldName& its = fields_[*stress];
  if (const auto time_of_stress = time_of(its, step))
  {
    set_stress(values_of(its, *time_of_stress), its, where_, solution);
    solution.description += fmt::format(", stress \"{}\"", its.name);
  }
  else if (!choice_.stress.empty())
    throw InputError(where_, fmt::format("field \"{}\" has no step {}", its.name, step), "another step");
  return solution;
}

}  // namespace

ImportedSolution read_med_solution(const std::filesystem::path& file, const SolutionChoice& choice)
{
  ImportedMesh mesh = read_med_without_groups(file);
  const auto read = [&] { return bytes_of(MedFields(file, choice, mesh.nodes.size()).read()); };
  ImportedSolution solution = solution_from(read_apart(file, "HDF5", read), mesh.source);
  solution.mesh = std::move(mesh);
  solution.description += ", " + element_words(solution.mesh);
  return solution;
}

}  // namespace tribound::mesh
