#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "tribound/mesh/import/frd_mesh.h"
#include "tribound/mesh/import/frd_records.h"
#include "tribound/mesh/import/solution_values.h"

namespace tribound::mesh
{

namespace
{

/// Values of nodes, where they stand in the file.
struct FrdField
{
  std::string name{};
  int state = 0;  ///< the fields of one increment have the same
  int step = 0;
  double time = 0;
  std::size_t n_components = 0;
  std::size_t width = 0;  ///< of the numbers of nodes
  TextLines::Place place{};
};

class FrdReader
{
 public:
  FrdReader(const std::filesystem::path& file, const SolutionChoice& choice)
      : choice_(choice), records_(file), mesh_(records_)
  {
  }

  ImportedSolution read();

 private:
  void read_field_header();
  [[nodiscard]] const FrdField* last(const std::string& name, std::optional<int> step) const;
  [[nodiscard]] std::vector<SolutionStep> steps(const std::string& name) const;
  [[nodiscard]] std::string all_fields() const;
  template <std::size_t n, class Put>
  void read_values(const FrdField& field, const Put& put);
  void read_displacement(const FrdField& displacement);
  void read_stress(int state);

  SolutionChoice choice_;
  FrdRecords records_;
  FrdMesh mesh_;
  int step_ = 0;  ///< of the last 1PSTEP
  std::vector<FrdField> fields_{};
  ImportedSolution solution_{};
};

/// 100C: what follows, "-4" and a "-5" for each component. The values are only passed over.
void FrdReader::read_field_header()
{
  FrdField found{.step = step_, .time = records_.number(12, "the time of a field")};
  found.state = static_cast<int>(records_.integer(58, 5, "the number of an increment"));
  if (found.step == 0) found.step = found.state;
  found.width = records_.width_of_numbers();
  records_.next_in("fields");
  if (records_.key() != "-4") records_.fail("a field begins with -4");
  found.name = records_.field(5, 8);
  const bool is_of_nodes = records_.field(18, 5) == "1";
  for (records_.next_in("fields"); records_.key() == "-5"; records_.next_in("fields"))
    found.n_components += records_.field(33, 5) == "1" ? 0 : 1;  // 1: is computed from the others
  found.place = records_.before();
  while (records_.key() != "-3") records_.next_in(fmt::format("values of {}", found.name));
  if (is_of_nodes) fields_.push_back(std::move(found));
}

/// The last one of the step, or of all.
const FrdField* FrdReader::last(const std::string& name, std::optional<int> step) const
{
  const FrdField* found = nullptr;
  for (const FrdField& field : fields_)
    if (field.name == name && (!step || field.step == *step)) found = &field;
  return found;
}

/// Each with the time of its last increment.
std::vector<SolutionStep> FrdReader::steps(const std::string& name) const
{
  std::vector<SolutionStep> result;
  for (const FrdField& field : fields_)
    if (&field == last(name, field.step)) result.push_back({field.step, field.time});
  return result;
}

std::string FrdReader::all_fields() const
{
  if (fields_.empty()) return "the file has no fields of nodes";
  std::vector<std::string> names;
  for (const FrdField& field : fields_)
    if (std::ranges::find(names, field.name) == names.end()) names.push_back(field.name);
  const auto [first, last] = std::ranges::minmax(fields_, {}, &FrdField::step);
  return fmt::format("the file has {}, in steps {} to {}", fmt::join(names, ", "), first.step, last.step);
}

/// Calls put(place of the node, values) for each node that has some.
template <std::size_t n, class Put>
void FrdReader::read_values(const FrdField& field, const Put& put)
{
  if (field.n_components != n)
    throw InputError(records_.where(),
                     fmt::format("{} has {} components, not {}", field.name, field.n_components, n),
                     "a displacement has 3 (DISP), a stress 6 (STRESS)");
  records_.go_to(field.place);
  std::vector<char> is_there(mesh_.mesh().nodes.size(), 0);
  for (records_.next_in("values"); records_.key() != "-3"; records_.next_in("values"))
  {
    if (records_.key() != "-1") records_.fail("the values of a node begin with -1");
    const std::int64_t label = records_.integer(FrdRecords::n_key, field.width, "the number of a node");
    const Index place = mesh_.node(label, field.name);
    if (std::exchange(is_there[place], 1) != 0)
      records_.fail(fmt::format("node {} is there twice in {}", label, field.name));
    std::array<double, n> values{};
    for (std::size_t i = 0; i < n; ++i)
      values[i] = records_.number(FrdRecords::n_key + field.width + 12 * i, "a value");
    put(place, values);
  }
}

void FrdReader::read_displacement(const FrdField& displacement)
{
  solution_.displacement.assign(mesh_.mesh().nodes.size(), no_displacement);
  read_values<3>(displacement, [&](Index node, const std::array<double, 3>& values)
                 { solution_.displacement[node] = displacement_of(values); });
}

/// That of the same increment.
void FrdReader::read_stress(int state)
{
  const std::string name = choice_.stress.empty() ? "STRESS" : choice_.stress;
  const auto found = std::ranges::find_if(
      fields_, [&](const FrdField& field) { return field.name == name && field.state == state; });
  if (found == fields_.end())
  {
    if (choice_.stress.empty()) return;
    throw InputError(records_.where(),
                     fmt::format("there is no {} in increment {}: {}", name, state, all_fields()),
                     "*EL FILE with S writes STRESS");
  }
  solution_.stress.assign(mesh_.mesh().nodes.size(), no_stress);
  read_values<6>(*found, [&](Index node, const StressValues& values)
                 { solution_.stress[node] = finite_stress(values); });
}

ImportedSolution FrdReader::read()
{
  while (records_.next())
  {
    const std::string_view key = records_.field(0, 6);
    if (key == "2C") mesh_.read_nodes();
    if (key == "3C") mesh_.read_elements();
    if (key == "1PSTEP") step_ = static_cast<int>(records_.integer(48, 12, "the number of a step"));
    if (key == "100C") read_field_header();
  }
  mesh_.check();
  const std::string name = choice_.field.empty() ? "DISP" : choice_.field;
  const FrdField* displacement = last(name, choice_.step);
  if (!displacement)
    throw InputError(records_.where(),
                     fmt::format("there is no {}{}: {}", name,
                                 choice_.step ? fmt::format(" of step {}", *choice_.step) : "", all_fields()),
                     "*NODE FILE with U writes DISP");
  solution_.steps = steps(name);
  read_displacement(*displacement);
  read_stress(displacement->state);
  std::vector<std::string> types;
  for (const ElementBlock& block : mesh_.mesh().cells)
    types.push_back(table_of(block.type.shape).dim == 3 ? fmt::format("C3D{}", block.type.n_nodes)
                                                        : describe(block.type));
  solution_.description = fmt::format("CalculiX results, step {} (t = {:g}), {}", displacement->step,
                                      displacement->time, fmt::join(types, ", "));
  solution_.mesh = mesh_.mesh();
  return std::move(solution_);
}

}  // namespace

ImportedSolution read_frd(const std::filesystem::path& file, const SolutionChoice& choice)
{
  return FrdReader(file, choice).read();
}

}  // namespace tribound::mesh
