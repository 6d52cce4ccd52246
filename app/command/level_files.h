#pragma once

/// @file level_files.h
/// A level or load step kept beyond its turn in the loop, and its output files.

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tribound/adapt/excerpt.h"
#include "tribound/adapt/loop.h"
#include "tribound/case/config.h"
#include "tribound/io/fields/vtu.h"

namespace tribound::app
{

/// A level that is still needed when the loop continues.
template <int dim>
struct KeptLevel
{
  explicit KeptLevel(const adapt::LevelView<dim>& view, const std::optional<double>& load_factor = {})
      : number(view.number), t(load_factor), discrete(view.owner), level(view.level)
  {
    level.equilibrium.reset();  // factors are large, and no further steps follow
  }
  KeptLevel(int n, const std::optional<double>& load_factor, adapt::Excerpt<dim> excerpt)
      : number(n),
        t(load_factor),
        discrete(std::move(excerpt.discrete)),
        level(std::move(excerpt.level)),
        is_merged(excerpt.is_merged)
  {
  }

  /// What the first rank shows of a level whose owner keeps it as `kept`: that level or, on several ranks,
  /// the gathered cells; null on the other ranks.
  [[nodiscard]] static std::shared_ptr<const KeptLevel> gathered(const adapt::LevelView<dim>& view,
                                                                 std::shared_ptr<const KeptLevel> kept,
                                                                 const case_file::OutputConfig& output,
                                                                 const adapt::Method& method);

  [[nodiscard]] io::SeriesPlace place() const { return {number, t}; }
  /// Whether these are the cells of all ranks.
  [[nodiscard]] bool is_complete() const
  {
    return discrete->mesh.n_cells() == discrete->mesh.n_global_cells();
  }
  /// Whether the page can show it.
  [[nodiscard]] bool fits_page() const { return dim == 3 || is_merged || is_complete(); }

  /// eta_tot, and eta_NAME for the components of the bound, cell by cell.
  [[nodiscard]] std::vector<std::pair<std::string, std::vector<double>>> cell_components() const;
  /// Writes level_NNN.vtu or step_NNN.vtu, or the files of several ranks: the fields of a level with the
  /// bound of every cell, and `further` numbers per cell. Throws WriteError when the file cannot be written.
  void write_fields(const std::filesystem::path& directory,
                    std::span<const io::CellField> further = {}) const;
  /// Writes contact.csv. Throws WriteError.
  void write_contact(const std::filesystem::path& directory) const;
  /// Writes the mesh as adapted.msh if requested; boundaries that the case does not mention have no group
  /// there. All ranks call it together, each with its own level. Throws WriteError.
  void write_mesh(const case_file::Config& config) const;

  int number;
  std::optional<double> t;  ///< of a load step
  std::shared_ptr<const adapt::Discretisation<dim>> discrete;
  adapt::CertifiedLevel<dim> level;
  bool is_merged = false;  ///< whether cells of several ranks were merged to reduce their number
};

}  // namespace tribound::app
