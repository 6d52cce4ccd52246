#include "app/command/level_files.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <vector>

#include "app/page/page_surface.h"
#include "tribound/io/fields/contact_line.h"
#include "tribound/io/fields/gmsh_file.h"

namespace tribound::app
{

namespace
{

/// The maximal number of cells of several ranks gathered on one.
constexpr std::int64_t most_in_one = 1'000'000;

/// The boundaries of the mesh that the case does not mention; they are free.
std::vector<std::string> free_sides(const case_file::Config& config,
                                    std::span<const std::string> boundary_names)
{
  std::vector<std::string> sides;
  for (const std::string& name : boundary_names)
    if (std::ranges::count(config.boundaries, name, &case_file::BoundaryConfig::name) == 0)
      sides.push_back(name);
  return sides;
}

}  // namespace

template <int dim>
std::shared_ptr<const KeptLevel<dim>> KeptLevel<dim>::gathered(const adapt::LevelView<dim>& view,
                                                               std::shared_ptr<const KeptLevel> kept,
                                                               const case_file::OutputConfig& output,
                                                               const adapt::Method& method)
{
  if (!view.discrete.mesh.partition()) return kept;
  // In 3D the page shows the surface, and the interior if there are few cells; otherwise only contact.
  const std::int64_t most = dim == 2 ? most_in_one : static_cast<std::int64_t>(PageLimits().volume);
  const bool is_small = view.discrete.mesh.n_global_cells() <= most;
  std::optional<adapt::Excerpt<dim>> excerpt = output.report && (is_small || (dim == 2 && !kept->t))
                                                   ? adapt::excerpt<dim>(view, method, most)
                                                   : adapt::boundary_excerpt<dim>(view, method);
  if (!excerpt) return nullptr;
  return std::make_shared<const KeptLevel>(view.number, kept->t, *std::move(excerpt));
}

template <int dim>
std::vector<std::pair<std::string, std::vector<double>>> KeptLevel<dim>::cell_components() const
{
  std::vector<std::pair<std::string, std::vector<double>>> columns;
  const auto add = [&](std::string name, auto value)
  {
    std::vector<double>& column = columns.emplace_back(std::move(name), std::vector<double>{}).second;
    std::ranges::transform(level.estimate.cells, std::back_inserter(column), value);
  };
  const certify::RunKind kind{.regularised = level.delta_updates.has_value(),
                              .paired = !discrete->form.problem().pairs().empty()};
  add("eta_tot", &certify::BoundComponents::total_sharp);
  for (const certify::Component& c : certify::components_of_run(kind))
    if (c.is_of_cells()) add(std::string("eta_") + c.name, c.value);
  return columns;
}

template <int dim>
void KeptLevel<dim>::write_fields(const std::filesystem::path& directory,
                                  std::span<const io::CellField> further) const
{
  const auto components = cell_components();
  std::vector<io::CellField> fields;
  fields.reserve(components.size() + further.size());
  for (const auto& [name, values] : components) fields.push_back({name, values});
  fields.insert(fields.end(), further.begin(), further.end());
  std::vector<io::TensorField<dim>> tensors;
  if (!discrete->form.problem().is_axisymmetric())  // on a meridian it is r times a stress
    tensors.push_back(io::equilibrated_stress_field(discrete->space, level.stress));
  io::write_level_vtu<dim>(io::level_files(directory, place(), discrete->mesh.ranks()), place(),
                           discrete->form.problem(), discrete->space, level.u, fields, tensors);
}

template <int dim>
void KeptLevel<dim>::write_contact(const std::filesystem::path& directory) const
{
  io::write_contact_csv(directory / "contact.csv", discrete->form, level.u, place());
}

template <int dim>
void KeptLevel<dim>::write_mesh(const case_file::Config& config) const
{
  if (config.output.mesh)
    io::write_gmsh<dim>(config.output.directory / "adapted.msh", discrete->mesh,
                        free_sides(config, discrete->mesh.boundary_names()));
}

template struct KeptLevel<2>;
template struct KeptLevel<3>;

}  // namespace tribound::app
