#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "tribound/mesh/gmsh.h"
#include "tribound/mesh/gmsh_elements.h"
#include "tribound/mesh/gmsh_library.h"
#include "tribound/mesh/gmsh_load.h"
#include "tribound/mesh/import/imported_bytes.h"
#include "tribound/mesh/import/solution_values.h"

namespace tribound::mesh
{

namespace
{

/// Views of the model that Gmsh has loaded, on the mesh that was read of it.
class GmshSolution
{
 public:
  GmshSolution(const std::filesystem::path& file, const SolutionChoice& choice) : choice_(choice)
  {
    solution_.mesh = load_gmsh(MeshFile{file}, solution_.notes);
    for (std::size_t i = 0; i < solution_.mesh.node_numbers.size(); ++i)
      node_of_tag_[solution_.mesh.node_numbers[i]] = static_cast<Index>(i);
  }

  ImportedSolution read();

 private:
  using Data = gmsh::ModelData;

  [[noreturn]] void fail(const std::string& problem, const std::string& hint = {}) const
  {
    throw InputError(solution_.mesh.source, problem, hint);
  }
  void find_views();
  [[nodiscard]] int step_of(const gmsh::View& view) const;
  [[nodiscard]] static std::vector<SolutionStep> steps_of(const gmsh::View& view);
  void check_length(const std::vector<double>& values, std::size_t wanted, std::size_t tag,
                    const FieldName& field) const;
  [[nodiscard]] std::vector<double> of_nodes(const Data& data, const FieldName& field) const;
  [[nodiscard]] std::vector<double> of_elements(const Data& data, const FieldName& field) const;
  [[nodiscard]] std::vector<double> joined(std::span<const double> values, const FieldName& field) const;
  void read_displacement(const Data& data, const FieldName& field);
  void read_stress(const gmsh::View& view, const FieldName& field, int step);

  SolutionChoice choice_;
  ImportedSolution solution_;
  std::unordered_map<std::int64_t, Index> node_of_tag_{};
  std::vector<gmsh::View> views_{};
  std::vector<FieldName> fields_{};
};

/// The last step of a view is never empty.
void GmshSolution::find_views()
{
  for (const gmsh::View& view : gmsh::views())
  {
    if (view.n_steps < 1) continue;
    const Data data = gmsh::model_data(view, view.n_steps - 1);
    fields_.push_back({view.name, static_cast<std::size_t>(std::max(data.n_components, 0))});
    views_.push_back(view);
  }
}

/// That which is chosen, or else the last one.
int GmshSolution::step_of(const gmsh::View& view) const
{
  if (!choice_.step) return view.n_steps - 1;
  if (*choice_.step < 0 || *choice_.step >= view.n_steps)
    fail(fmt::format("view \"{}\" has no step {}", view.name, *choice_.step),
         fmt::format("its steps are 0 to {}", view.n_steps - 1));
  return *choice_.step;
}

/// Those with data.
std::vector<SolutionStep> GmshSolution::steps_of(const gmsh::View& view)
{
  std::vector<SolutionStep> steps;
  for (int i = 0; i < view.n_steps; ++i)
    if (const Data data = gmsh::model_data(view, i); !data.tags.empty()) steps.push_back({i, data.time});
  return steps;
}

void GmshSolution::check_length(const std::vector<double>& values, std::size_t wanted, std::size_t tag,
                                const FieldName& field) const
{
  if (values.size() != wanted)
    fail(fmt::format("view \"{}\" has {} numbers for {}, not {}", field.name, values.size(), tag, wanted),
         "data on all nodes of an element, without an interpolation scheme");
}

/// NaN where a node has none.
std::vector<double> GmshSolution::of_nodes(const Data& data, const FieldName& field) const
{
  std::vector<double> result(solution_.mesh.nodes.size() * field.n_components, std::nan(""));
  for (std::size_t i = 0; i < data.tags.size(); ++i)
  {
    const auto node = node_of_tag_.find(static_cast<std::int64_t>(data.tags[i]));
    if (node == node_of_tag_.end())
      fail(fmt::format("view \"{}\" has node {}, which the mesh does not have", field.name, data.tags[i]),
           "save mesh and views again with Gmsh, nodes numbered without gaps (Mesh.Renumber = 1)");
    check_length(data.values[i], field.n_components, data.tags[i], field);
    std::ranges::copy(data.values[i], result.begin() + node->second * std::ssize(data.values[i]));
  }
  return result;
}

/// For each node of each element; NaN where an element has none.
std::vector<double> GmshSolution::of_elements(const Data& data, const FieldName& field) const
{
  std::unordered_map<std::size_t, const std::vector<double>*> values_of_tag;
  for (std::size_t i = 0; i < data.tags.size(); ++i) values_of_tag[data.tags[i]] = &data.values[i];
  const std::size_t n = field.n_components;
  const bool is_constant = data.kind == "ElementData";
  std::vector<double> result;
  for (const ElementBlock& block : solution_.mesh.cells)
  {
    const std::vector<int> order = to_gmsh(block.type).order;
    for (const std::int64_t number : block.numbers)
    {
      const auto found = values_of_tag.find(static_cast<std::size_t>(number));
      if (found != values_of_tag.end())
        check_length(*found->second, is_constant ? n : n * order.size(), found->first, field);
      for (const int place : order)
        for (std::size_t i = 0; i < n; ++i)
          result.push_back(found == values_of_tag.end()
                               ? std::nan("")
                               : (*found->second)[(is_constant ? 0 : n * place) + i]);
    }
  }
  return result;
}

/// Values of nodes of elements as values of nodes, if they agree.
std::vector<double> GmshSolution::joined(std::span<const double> values, const FieldName& field) const
{
  const std::size_t n = field.n_components;
  double size = 0;
  for (const double value : values)
    if (std::isfinite(value)) size = std::max(size, std::abs(value));
  std::vector<double> result(solution_.mesh.nodes.size() * n, std::nan(""));
  std::size_t entry = 0;
  for (const ElementBlock& block : solution_.mesh.cells)
    for (const Index node : block.nodes)
      for (std::size_t i = 0; i < n; ++i, ++entry)
      {
        double& known = result[static_cast<std::size_t>(node) * n + i];
        if (std::isnan(known)) known = values[entry];
        if (std::abs(values[entry] - known) > 1e-5 * size)
          fail(fmt::format("view \"{}\" has {:g} and {:g} in elements that share node {}", field.name, known,
                           values[entry], solution_.mesh.node_numbers[node]),
               "a displacement that is one in every node: a view of nodes");
      }
  return result;
}

void GmshSolution::read_displacement(const Data& data, const FieldName& field)
{
  if (data.kind == "ElementData")
    fail(fmt::format("view \"{}\" is constant in each element, and cannot be a displacement", field.name),
         "a view of nodes ($NodeData); elements can have stresses");
  const std::vector<double> values =
      data.kind == "NodeData" ? of_nodes(data, field) : joined(of_elements(data, field), field);
  solution_.displacement = displacements_of(values, field);
}

void GmshSolution::read_stress(const gmsh::View& view, const FieldName& field, int step)
{
  const Where& where = solution_.mesh.source;
  const Data data = step < view.n_steps ? gmsh::model_data(view, step) : Data{};
  if (data.tags.empty())
  {
    if (!choice_.stress.empty())
      fail(fmt::format("view \"{}\" has no data in step {}", field.name, step), "another step");
    return;
  }
  solution_.stress_of_elements = data.kind != "NodeData";
  const std::vector<double> values =
      solution_.stress_of_elements ? of_elements(data, field) : of_nodes(data, field);
  set_stress(values, field, where, solution_);
  if (data.kind == "ElementData")
    solution_.notes.push_back(
        fmt::format("{}: the stress \"{}\" is constant in each element", where.file, field.name));
  solution_.description += fmt::format(", stress \"{}\"", field.name);
}

ImportedSolution GmshSolution::read()
{
  find_views();
  const Where& where = solution_.mesh.source;
  const std::size_t u = choose_displacement(fields_, choice_.field, where, "views");
  const int step = step_of(views_[u]);
  const Data data = gmsh::model_data(views_[u], step);
  if (data.tags.empty())
    fail(fmt::format("view \"{}\" has no data in step {}", fields_[u].name, step), "another step");
  solution_.steps = steps_of(views_[u]);
  read_displacement(data, fields_[u]);
  solution_.description =
      fmt::format("Gmsh view \"{}\", step {} (t = {:g})", fields_[u].name, step, data.time);
  if (const auto s = choose_stress(fields_, choice_.stress, where, "views"))
    read_stress(views_[*s], fields_[*s], step);
  solution_.description += ", " + element_words(solution_.mesh);
  return std::move(solution_);
}

}  // namespace

ImportedSolution read_gmsh_solution(const std::filesystem::path& file, const SolutionChoice& choice)
{
  const auto load = [&] { return bytes_of(GmshSolution(file, choice).read()); };
  return solution_from(load_apart(file, load, nullptr, default_patience), {.file = file.string()});
}

}  // namespace tribound::mesh
