#pragma once

/// @file vtu.h
/// The solution on a mesh as VTU files with true degree-p cells (VTK Lagrange simplices).

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/fem/space.h"
#include "tribound/io/fields/tensor_field.h"
#include "tribound/problem/problem.h"

namespace tribound::io
{

/// One number per cell, such as an error component eta_*.
struct CellField
{
  std::string name;
  std::span<const double> values;
};

/// The position of a file in a series: of levels, or of load steps.
struct SeriesPlace
{
  int number = 0;
  std::optional<double> load_factor{};  ///< t of a load step

  [[nodiscard]] std::string_view stem() const { return load_factor ? "step" : "level"; }
};

/// The files of one level. On several ranks each writes its own cells, and the first also a list of all
/// files.
struct LevelFiles
{
  std::filesystem::path own;
  std::filesystem::path list{};       ///< empty: none
  std::vector<std::string> pieces{};  ///< in the list, relative to it
};

/// level_NNN.vtu or step_NNN.vtu, or level_NNN.pvtu with level_NNN/part_RRRR.vtu on several ranks. Makes the
/// directory. Throws WriteError if this fails.
[[nodiscard]] LevelFiles level_files(const std::filesystem::path& directory, const SeriesPlace& place,
                                     const Ranks& ranks);

/// Writes the own cells of degree p, each with its own points: points and `displacement` (3 components, z = 0
/// in 2D) in double precision, `stress` and the further `tensors` (xx, yy, zz, xy, yz, xz),
/// `principal_stresses` and `von_mises` in single precision; cell data `region` and `cell_fields`. In 2D zz
/// of every tensor follows from out_of_plane_ratio() and out_of_plane_rest(). Needs memory for one cell
/// besides its arguments. Throws WriteError when the file cannot be written.
template <int dim>
void write_level_vtu(const LevelFiles& files, const SeriesPlace& place, const problem::Problem<dim>& problem,
                     const fem::LagrangeSpace<dim>& space, std::span<const double> u,
                     std::span<const CellField> cell_fields = {},
                     std::span<const TensorField<dim>> tensors = {});

/// Writes the segments of Gamma_C as curves or triangles of degree p, in the order of form.segments(): point
/// data `displacement`, `contact_pressure`, `contact_traction`, `contact_status` (0 open, 1 stick, 2 slip, 3
/// tied), `gap`, `slip` at the nodes of each facet, for a load step also `damage` D, `opening` delta^n,
/// `plastic_slip` w; cell data `boundary` (number of the boundary group). Throws WriteError when the file
/// cannot be written.
template <int dim>
void write_contact_vtu(const std::filesystem::path& path, const SeriesPlace& place,
                       const contact::NitscheForm<dim>& form, std::span<const double> u);

/// The name of a numbered file, such as "level_003.vtu".
[[nodiscard]] std::string level_file_name(std::string_view stem, int level);

/// Writes series.pvd, which lists the existing files level_NNN.vtu (or step_NNN.vtu, by the stem), or .pvtu
/// where present, from `first` to `last`, with the number as time. Throws WriteError when the file cannot be
/// written.
void write_series(const std::filesystem::path& directory, int first, int last,
                  std::string_view stem = "level");

/// Removes such a series of an earlier run, from number `first` on: level_NNN.vtu, level_NNN.pvtu,
/// level_NNN/part_N.vtu, the same of steps, contact_NNN.vtu and checkpoint_NNN.h5, where N is a digit and NNN
/// at least three; also series.pvd. Other files stay. Throws InputError when a file cannot be removed.
void remove_series(const std::filesystem::path& directory, int first = 0);

/// Makes a directory for an incomplete series, unless it exists. Throws WriteError if this fails.
void make_series_directory(const std::filesystem::path& directory);
/// Removes it with its series; does nothing where it does not exist.
void remove_series_directory(const std::filesystem::path& directory);
/// Moves all files in `from`, which is removed, to `to`; does nothing where `from` does not exist. Throws
/// WriteError when a file cannot be moved.
void move_series(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace tribound::io
