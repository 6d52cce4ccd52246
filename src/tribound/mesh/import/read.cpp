#include "tribound/mesh/import/read.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "tribound/mesh/axis.h"
#include "tribound/mesh/box.h"
#include "tribound/mesh/cut_open.h"
#include "tribound/mesh/import/bdf_check.h"
#include "tribound/mesh/import/choices.h"
#include "tribound/mesh/import/file_text.h"
#include "tribound/mesh/import/inp.h"
#include "tribound/mesh/import/med.h"
#include "tribound/mesh/import/vtk.h"

namespace tribound::mesh
{

namespace
{

/// A format by the suffix of its files.
struct Format
{
  std::string_view suffix;
  bool is_geometry = false;        ///< is meshed, with options.size
  bool has_ignorable = false;      ///< knows options.ignore_elements
  bool has_arrays = false;         ///< knows options.region_array
  std::string_view begins{};       ///< every file; empty: with anything
  std::string_view begins_with{};  ///< the same in words
};

constexpr std::array formats = {
    Format{.suffix = ".msh", .begins = "$", .begins_with = "a $ section such as $MeshFormat"},
    Format{.suffix = ".geo", .is_geometry = true},
    Format{.suffix = ".unv"},
    Format{.suffix = ".bdf", .has_ignorable = true},
    Format{.suffix = ".nas", .has_ignorable = true},
    Format{.suffix = ".step", .is_geometry = true, .begins = "ISO-10303-21", .begins_with = "ISO-10303-21;"},
    Format{.suffix = ".stp", .is_geometry = true, .begins = "ISO-10303-21", .begins_with = "ISO-10303-21;"},
    Format{.suffix = ".brep", .is_geometry = true},
    Format{.suffix = ".iges", .is_geometry = true},
    Format{.suffix = ".igs", .is_geometry = true},
    Format{.suffix = ".stl", .is_geometry = true},
    Format{.suffix = ".inp", .has_ignorable = true},
    Format{.suffix = ".vtu", .has_arrays = true},
    Format{.suffix = ".pvtu", .has_arrays = true},
    Format{.suffix = ".vtk", .has_arrays = true},
    Format{.suffix = ".med"}};

/// Throws at source.where unless the file can be read and is, by its suffix and its first characters, of a
/// format, which is returned.
const Format& check_file(const MeshFile& source)
{
  const std::filesystem::path& file = source.path;
  const auto fail = [&](const std::string& problem, const std::string& hint)
  { throw InputError(source.where, fmt::format("mesh file \"{}\" {}", file.string(), problem), hint); };

  std::error_code error;
  if (!std::filesystem::exists(file, error))
    fail("does not exist", source.where.file.empty() ? "" : "the path is relative to the case file");
  const auto format = std::ranges::find(formats, suffix_of(file), &Format::suffix);
  if (format == formats.end())
  {
    std::vector<std::string_view> suffixes;
    suffixes.reserve(formats.size());
    for (const Format& known : formats) suffixes.push_back(known.suffix);
    fail("is of no format that is read", fmt::format("{}", fmt::join(suffixes, ", ")));
  }
  if (std::filesystem::is_directory(file, error)) fail("is a directory", "name the mesh file in it");
  if (std::filesystem::is_empty(file, error)) fail("is empty", "save the mesh again");
  std::ifstream stream(file, std::ios::binary);
  std::string first(std::max<std::size_t>(format->begins.size(), 1), ' ');
  stream.read(first.data(), static_cast<std::streamsize>(first.size()));
  if (!std::filesystem::is_regular_file(file, error) || stream.gcount() == 0)
    fail("cannot be read", "check its permissions");
  if (!first.starts_with(format->begins))
    fail(fmt::format("is not a {}: it does not begin with {}", format->suffix, format->begins_with),
         "save it again with the program that has made it");
  stream.clear();
  stream.seekg(-1, std::ios::end);
  if (format->suffix == ".geo" && stream.get() != '\n')  // Gmsh ignores the statement at the very end
    fail("does not end with a newline, and Gmsh would ignore its last statement", "add a newline at the end");
  return *format;
}

/// An option that would change nothing is a mistake.
void check_options(const MeshFile& source, const Format& format)
{
  const auto fail = [&](std::string_view option, std::string_view purpose)
  {
    throw InputError(source.where, fmt::format("{} is of no use for a {}", option, format.suffix),
                     std::string(purpose));
  };
  const ImportOptions& options = source.options;
  if (options.size > 0 && !format.is_geometry)
    fail("size", "it is for geometries; a mesh has the size it was made with");
  if (options.ignore_elements && !format.has_ignorable) fail("ignore_elements", "it is for decks");
  if (!options.region_array.empty() && !format.has_arrays)
    fail("region_array", "it is for formats with arrays of cells");
}

AnyMesh verified(std::variant<MeshData<2>, MeshData<3>> any, const FindSeams& find_seams,
                 std::span<const FormulaGroup> groups)
{
  return std::visit(
      [&]<int dim>(MeshData<dim>& data) -> AnyMesh
      {
        add_groups<dim>(data, groups);
        const Seams seams = find_seams ? find_seams(data.boundary_names) : Seams{};
        if (seams.has_axis) meet_axis(data);
        cut_open<dim>(data, seams.joints);
        data.interfaces.insert(data.interfaces.end(), seams.interfaces.begin(), seams.interfaces.end());
        return Mesh<dim>(std::move(data));
      },
      any);
}

AnyMesh read_file(const MeshFile& file, const FindSeams& find_seams, const std::atomic<bool>* stop,
                  std::vector<std::string>* notes, std::span<const FormulaGroup> groups)
{
  if (suffix_of(file.path) == ".stl")
    throw InputError(
        file.where, fmt::format("mesh file \"{}\" is a surface without a volume", file.path.string()),
        fmt::format("fill it once: tribound mesh {} {} --size 2", file.path.filename().string(),
                    std::filesystem::path(file.path).replace_extension(".msh").filename().string()));
  std::vector<std::string> said;
  SimplicialMesh mesh = make_simplicial(read_imported(file, stop, default_patience, said), !groups.empty());
  said.insert(said.end(), mesh.notes.begin(), mesh.notes.end());
  if (notes) *notes = std::move(said);
  return verified(std::move(mesh.data), find_seams, groups);
}

}  // namespace

ImportedMesh read_imported(const MeshFile& source, const std::atomic<bool>* stop, double patience,
                           std::vector<std::string>& notes)
{
  const Format& format = check_file(source);
  check_options(source, format);
  if (format.suffix == ".bdf" || format.suffix == ".nas")
    check_bdf(source.path, source.options.ignore_elements, notes);
  const ImportOptions& options = source.options;
  ImportedMesh mesh = format.suffix == ".inp"   ? read_inp(source.path, options.ignore_elements, notes)
                      : format.suffix == ".med" ? read_med(source.path)
                      : format.has_arrays       ? read_vtk(source.path, options.region_array, notes)
                                                : read_gmsh(source, stop, patience, notes);
  if (options.merge > 0) merge_nodes(mesh, options.merge, notes);
  if (!options.boundaries.empty()) choose_boundaries(mesh, options.boundaries);
  return mesh;
}

AnyMesh read_mesh(const MeshSource& source, const FindSeams& find_seams, const std::atomic<bool>* stop,
                  std::vector<std::string>* notes, std::span<const FormulaGroup> groups)
{
  if (const auto* file = std::get_if<MeshFile>(&source))
    return read_file(*file, find_seams, stop, notes, groups);
  const auto finish = [&](auto data) { return verified(std::move(data), find_seams, groups); };
  if (const auto* box = std::get_if<BoxMesh>(&source))
    return box->cells.size() == 3 ? finish(box_mesh<3>(*box)) : finish(box_mesh<2>(*box));
  const auto& boxes = std::get<Boxes>(source);
  return boxes.front().box.cells.size() == 3 ? finish(box_meshes<3>(boxes)) : finish(box_meshes<2>(boxes));
}

std::vector<std::filesystem::path> with_included(const std::filesystem::path& file)
{
  std::error_code error;
  return suffix_of(file) == ".inp" && std::filesystem::is_regular_file(file, error) ? files_of_inp(file)
                                                                                    : std::vector{file};
}

}  // namespace tribound::mesh
