#pragma once

/// @file level_files.h
/// A level kept beyond its turn in the loop, and its fields as a file.

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "tribound/adapt/excerpt.h"
#include "tribound/adapt/loop.h"
#include "tribound/io/fields/vtu.h"

namespace tribound::app
{

/// A level that is still needed when the loop goes on.
template <int dim>
struct KeptLevel
{
  explicit KeptLevel(const adapt::LevelView<dim>& view, const std::optional<double>& load_factor = {})
      : number(view.number), t(load_factor), discrete(view.owner), level(view.level)
  {
    level.equilibrium.reset();  // factors are large, and no more steps are to come
  }
  KeptLevel(int n, const std::optional<double>& load_factor, adapt::Excerpt<dim> excerpt)
      : number(n),
        t(load_factor),
        discrete(std::move(excerpt.discrete)),
        level(std::move(excerpt.level)),
        is_merged(excerpt.is_merged)
  {
  }

  [[nodiscard]] io::SeriesPlace place() const { return {number, t}; }

  int number;
  std::optional<double> t;  ///< of a load step
  std::shared_ptr<const adapt::Discretisation<dim>> discrete;
  adapt::CertifiedLevel<dim> level;
  bool is_merged = false;  ///< whether cells of several ranks were put together to be few enough
};

/// Writes level_NNN.vtu or step_NNN.vtu, or the files of several ranks: the fields of a level with the bound
/// of every cell, and `further` numbers per cell. Throws WriteError when the file cannot be written.
template <int dim>
void write_level_fields(const std::filesystem::path& directory, const io::SeriesPlace& place,
                        const adapt::Discretisation<dim>& discrete, const adapt::CertifiedLevel<dim>& level,
                        std::span<const io::CellField> further = {});

}  // namespace tribound::app
