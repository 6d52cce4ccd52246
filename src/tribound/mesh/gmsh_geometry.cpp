#include "tribound/mesh/gmsh_geometry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "tribound/base/error.h"
#include "tribound/mesh/gmsh_library.h"
#include "tribound/mesh/gmsh_session.h"
#include "tribound/mesh/import/cad_unit.h"
#include "tribound/mesh/import/file_text.h"
#include "tribound/mesh/triangulated_surface.h"

namespace tribound::mesh
{

namespace
{

constexpr std::array<std::string_view, 5> cad_suffixes = {".step", ".stp", ".iges", ".igs", ".brep"};

bool is_cad(const std::filesystem::path& file)
{
  return std::ranges::count(cad_suffixes, suffix_of(file)) > 0;
}

/// Coordinates beyond this have squares and volumes outside the range of a double.
constexpr double largest_coordinate = 1e60;

/// Gmsh does not terminate if a point of the geometry is not finite, or absurdly far away.
void check_points(const std::filesystem::path& file)
{
  for (const auto& [_, tag] : gmsh::entities(0))
  {
    const std::vector<double> x = gmsh::position(tag);
    if (std::ranges::all_of(x, [](double xi) { return std::abs(xi) <= largest_coordinate; })) continue;
    const bool finite = std::ranges::all_of(x, [](double xi) { return std::isfinite(xi); });
    throw InputError(
        {.file = file.string()},
        fmt::format("point {} of the geometry is at ({}), {}", tag, fmt::join(x, ", "),
                    finite ? fmt::format("beyond {:g}", largest_coordinate) : "which are not finite numbers"),
        "mend its coordinates");
  }
}

/// Sets the size of the elements.
void set_size(const MeshFile& source, int dim, std::vector<std::string>& notes)
{
  constexpr double edges_per_diagonal = 20;
  constexpr double most_cells = 2e8;
  const double given = source.options.size;
  if (given == 0 && !has_named_entities(source.path)) return;
  const auto [lower, upper] = gmsh::bounding_box();
  double squares = 0;
  for (int i = 0; i < 3; ++i) squares += (upper[i] - lower[i]) * (upper[i] - lower[i]);
  const double size = given > 0 ? given : std::sqrt(squares) / edges_per_diagonal;
  double n = dim == 3 ? 8 : 2;
  for (int i = 0; i < 3; ++i) n *= std::max(1.0, (upper[i] - lower[i]) / size);
  if (n > most_cells)
    throw InputError(
        source.where,
        fmt::format("size = {:g} makes up to {:.1g} elements of a geometry of {:.3g} x {:.3g} x {:.3g}", size,
                    n, upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]),
        "the length of an edge, in the unit of the geometry");
  if (given == 0)
    notes.push_back(fmt::format(
        "{}: meshed with edges of about {:.3g}, a {:g}th of its diagonal; size sets another length",
        source.path.string(), size, edges_per_diagonal));
  gmsh::set_number("Mesh.CharacteristicLengthMax", size);
  // Else a tenth of the diagonal at most.
  if (has_named_entities(source.path)) gmsh::set_number("Mesh.CharacteristicLengthMin", size);
}

/// A volume inside a surface of triangles, which must be closed.
void fill(const MeshFile& source)
{
  constexpr double sharp = 40 * std::numbers::pi / 180;
  const Where where{.file = source.path.string()};
  const TriangulatedSurface surface = read_stl(source.path, where);
  if (!surface.is_closed())
    throw InputError(where, "the surface is not closed: an edge belongs to one triangle only",
                     "close its holes in the program that has made it");
  if (const std::size_t n = surface.n_bodies(); n > 1)
    throw InputError(where, fmt::format("the surface encloses {} bodies, one outside of the other", n),
                     "a file for each body; beside the outer surface of a body only its cavities");
  run_gmsh(source.path, "fill the surface", "do triangles cross? Mend the surface",
           [&] { gmsh::fill_surface(sharp); });
}

}  // namespace

bool has_named_entities(const std::filesystem::path& file)
{
  return is_cad(file) || suffix_of(file) == ".stl";
}

bool is_geometry(const std::filesystem::path& file)
{
  return has_named_entities(file) || suffix_of(file) == ".geo";
}

void mesh_geometry(const MeshFile& source, std::vector<std::string>& notes)
{
  const std::filesystem::path& file = source.path;
  if (is_cad(file))
  {
    // Gmsh would convert to millimetres.
    if (const std::string unit = length_unit(file); !unit.empty())
      gmsh::set_string("Geometry.OCCTargetUnit", unit);
    else if (suffix_of(file) != ".brep")  // which names none
      notes.push_back(
          fmt::format("{}: the file names no unit of length, several, or one that is not known here: "
                      "its lengths have become millimetres",
                      file.string()));
    gmsh::set_number("Mesh.ElementOrder", 2);
  }
  run_gmsh(file, "read the file", "mend the geometry there; what it merges is looked for beside it",
           [&] { gmsh::open(file.string()); });
  if (suffix_of(file) == ".stl") fill(source);
  const int dim = gmsh::dimension();
  check_points(file);
  const bool has_mesh = dim >= 2 && !gmsh::element_types(dim).empty();
  if (dim < 2 || has_mesh) return;
  set_size(source, dim, notes);
  // Errors go to the log: nobody would catch exceptions in a team of threads.
  gmsh::set_number("General.AbortOnError", 0);
  run_gmsh(file, "mesh the geometry",
           "do curves or surfaces cross, or is a mesh size absurd? Mend the geometry, or mesh a part of it",
           [&] { gmsh::generate(dim); });
}

}  // namespace tribound::mesh
