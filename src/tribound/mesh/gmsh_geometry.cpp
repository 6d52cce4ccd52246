#include "tribound/mesh/gmsh_geometry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <regex>
#include <string_view>

#include "tribound/base/error.h"
#include "tribound/mesh/gmsh_library.h"
#include "tribound/mesh/gmsh_session.h"
#include "tribound/mesh/triangulated_surface.h"

namespace tribound::mesh
{

namespace
{

constexpr std::array<std::string_view, 5> cad_suffixes = {".step", ".stp", ".iges", ".igs", ".brep"};

bool is_cad(const std::filesystem::path& file)
{
  return std::ranges::count(cad_suffixes, file.extension().string()) > 0;
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

/// The unit of length of a STEP or IGES file by the name that Open CASCADE has for it; empty: not found. Gmsh
/// would convert to millimetres.
std::string length_unit(const std::filesystem::path& file)
{
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  std::smatch match;
  if (file.extension().string().starts_with(".i"))
  {
    // The 15th parameter of the global section: "2HMM", "4HINCH".
    static const std::regex name(R"((?:^|,)\s*\d+H(INCH|IN|MM|FT|MI|M|KM|MIL|UM|CM|UIN)\s*,)");
    const std::string global = text.substr(0, std::min<std::size_t>(text.size(), 4096));
    if (!std::regex_search(global, match, name)) return {};
    return match[1] == "IN" ? "INCH" : match[1].str();
  }
  static const std::regex inch("CONVERSION_BASED_UNIT\\s*\\(\\s*'(INCH|FOOT)'", std::regex::icase);
  static const std::regex metre(R"(SI_UNIT\s*\(\s*(\$|\.\w+\.)\s*,\s*\.METRE\.\s*\))");
  if (std::regex_search(text, match, inch))
    return match.str(1).starts_with("F") || match.str(1).starts_with("f") ? "FT" : "INCH";
  if (!std::regex_search(text, match, metre)) return {};
  const std::string prefix = match[1];
  if (prefix == "$") return "M";
  if (prefix == ".MILLI.") return "MM";
  if (prefix == ".CENTI.") return "CM";
  if (prefix == ".MICRO.") return "UM";
  return prefix == ".KILO." ? "KM" : "";
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
  if (!read_stl(source.path, {.file = source.path.string()}).is_closed())
    throw InputError({.file = source.path.string()},
                     "the surface is not closed: an edge belongs to one triangle only",
                     "close its holes in the program that has made it");
  run_gmsh(source.path, "fill the surface", "do triangles cross? Mend the surface",
           [&] { gmsh::fill_surface(sharp); });
}

}  // namespace

bool has_named_entities(const std::filesystem::path& file)
{
  return is_cad(file) || file.extension() == ".stl";
}

bool is_geometry(const std::filesystem::path& file)
{
  return has_named_entities(file) || file.extension() == ".geo";
}

void mesh_geometry(const MeshFile& source, std::vector<std::string>& notes)
{
  const std::filesystem::path& file = source.path;
  if (is_cad(file))
  {
    if (const std::string unit = length_unit(file); !unit.empty())
      gmsh::set_string("Geometry.OCCTargetUnit", unit);
    gmsh::set_number("Mesh.ElementOrder", 2);
  }
  run_gmsh(file, "read the file", "mend the geometry there; what it merges is looked for beside it",
           [&] { gmsh::open(file.string()); });
  if (file.extension() == ".stl") fill(source);
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
