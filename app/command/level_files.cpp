#include "app/command/level_files.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace tribound::app
{

namespace
{

/// eta_tot and the components cell by cell, for the VTU file.
class CellComponents
{
 public:
  CellComponents(const certify::Estimate& estimate, const certify::RunKind& kind)
  {
    add("eta_tot", estimate, [](const certify::BoundComponents& cell) { return cell.total_sharp(); });
    for (const certify::Component& c : certify::components_of_run(kind))
      if (c.is_of_cells())
        add(std::string("eta_") + c.name, estimate,
            [&c](const certify::BoundComponents& cell) { return cell.*c.value; });
  }

  [[nodiscard]] std::vector<io::CellField> fields() const
  {
    std::vector<io::CellField> result;
    for (const auto& [name, values] : columns_) result.push_back({name, values});
    return result;
  }

 private:
  template <typename Value>
  void add(std::string name, const certify::Estimate& estimate, const Value& value)
  {
    std::vector<double>& column = columns_.emplace_back(std::move(name), std::vector<double>{}).second;
    column.reserve(estimate.cells.size());
    for (const certify::BoundComponents& cell : estimate.cells) column.push_back(value(cell));
  }

  std::vector<std::pair<std::string, std::vector<double>>> columns_;
};

}  // namespace

template <int dim>
void write_level_fields(const std::filesystem::path& directory, const io::SeriesPlace& place,
                        const adapt::Discretisation<dim>& discrete, const adapt::CertifiedLevel<dim>& level,
                        std::span<const io::CellField> further)
{
  const CellComponents components(level.estimate, {.regularised = level.delta_updates.has_value(),
                                                   .paired = !discrete.form.problem().pairs().empty()});
  std::vector<io::CellField> fields = components.fields();
  fields.insert(fields.end(), further.begin(), further.end());
  const std::array tensors = {io::equilibrated_stress_field(discrete.space, level.stress)};
  io::write_level_vtu<dim>(io::level_files(directory, place, discrete.mesh.ranks()), place,
                           discrete.form.problem(), discrete.space, level.u, fields, tensors);
}

template void write_level_fields(const std::filesystem::path&, const io::SeriesPlace&,
                                 const adapt::Discretisation<2>&, const adapt::CertifiedLevel<2>&,
                                 std::span<const io::CellField>);
template void write_level_fields(const std::filesystem::path&, const io::SeriesPlace&,
                                 const adapt::Discretisation<3>&, const adapt::CertifiedLevel<3>&,
                                 std::span<const io::CellField>);

}  // namespace tribound::app
