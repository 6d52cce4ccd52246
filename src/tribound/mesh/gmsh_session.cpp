#include "tribound/mesh/gmsh_session.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "tribound/base/apart.h"
#include "tribound/mesh/gmsh_library.h"

namespace tribound::mesh
{

namespace
{

/// The errors that Gmsh has logged, the first few of them.
std::string logged_errors()
{
  constexpr int most = 5;
  constexpr std::string_view prefix = "Error: ";
  std::string text;
  int n = 0;
  for (const std::string& line : gmsh::log())
    if (line.starts_with(prefix) && ++n <= most)
      text += (text.empty() ? "" : "; ") + line.substr(prefix.size());
  return n > most ? fmt::format("{}; and {} more", text, n - most) : text;
}

/// Runs one step of Gmsh, which reports failure by an exception, by a message, or by both.
template <class Step>
void attempt(const std::filesystem::path& file, const std::string& what, const std::string& hint,
             const Step& step)
{
  bool failed = false;
  try
  {
    step();
  }
  catch (const std::bad_alloc&)
  {
    throw;
  }
  catch (...)  // a std::string up to Gmsh 4.8, a std::runtime_error later; the log holds the text in any case
  {
    failed = true;
  }
  const std::string errors = logged_errors();
  if (failed || !errors.empty())
    throw InputError({.file = file.string()},
                     fmt::format("Gmsh cannot {}: {}", what, errors.empty() ? "no reason given" : errors),
                     hint);
}

/// The log outlives finalize() unless it is stopped.
void stop_gmsh()
{
  gmsh::stop_logger();
  gmsh::finalize();
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

constexpr std::string_view to_save_again = "is it complete? Save the mesh again with Gmsh";
constexpr std::string_view to_mend_geometry =
    "mend the geometry there; what it merges is looked for beside it";

}  // namespace

ReadingLimits reading_limits(const std::filesystem::path& file)
{
  if (file.extension() == ".geo") return {HUGE_VAL, HUGE_VAL};
  // Measured for 10^6 triangles and tetrahedra in formats 2.2 and 4.1, ASCII and binary: 4 to 9 bytes of
  // address space and 10 to 60 ns for each byte of the file; 15 bytes where nodes are numbered with gaps.
  constexpr double bytes_per_byte = 64;
  constexpr double bytes_of_any = 256e6;
  constexpr double seconds_per_byte = 2e-6;
  constexpr double seconds_of_any = 10;
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(file, unknown);
  if (unknown) return {HUGE_VAL, HUGE_VAL};
  const auto n = static_cast<double>(size);
  return {bytes_of_any + bytes_per_byte * n, seconds_of_any + seconds_per_byte * n};
}

GmshSession::GmshSession(const std::filesystem::path& file)
{
  if (const std::string problem = gmsh::load(); !problem.empty())
    throw InputError({.file = file.string()}, "Gmsh's library, which reads it, cannot be loaded: " + problem,
                     "install Gmsh " + gmsh::version() +
                         " with its library (Debian: libgmsh); a box (mesh.box) needs none");
  gmsh::initialize();
  try
  {
    gmsh::set_number("General.Terminal", 1);    // signs of progress for the process that waits
    gmsh::set_number("General.NumThreads", 1);  // a copied process has no team of threads
    gmsh::start_logger();
    const bool is_geometry = file.extension() == ".geo";
    const ReadingLimits most = reading_limits(file);
    limit_from_here(most.memory, most.seconds);
    attempt(file, "read the file", std::string(is_geometry ? to_mend_geometry : to_save_again),
            [&] { gmsh::open(file.string()); });
    if (!is_geometry) return;
    const int dim = gmsh::dimension();
    check_points(file);
    if (dim >= 2 && gmsh::element_types(dim).empty())
    {
      // Errors go to the log: nobody would catch exceptions in a team of threads.
      gmsh::set_number("General.AbortOnError", 0);
      attempt(
          file, "mesh the geometry",
          "do curves or surfaces cross, or is a mesh size absurd? Mend the geometry, or mesh a part of it",
          [&] { gmsh::generate(dim); });
    }
  }
  catch (...)
  {
    stop_gmsh();
    throw;
  }
}

GmshSession::~GmshSession()
{
  gmsh::finalize();
}

void check_mesh_file(const std::filesystem::path& file, const Where& where)
{
  const auto fail = [&](const std::string& problem, const std::string& hint)
  { throw InputError(where, fmt::format("mesh file \"{}\" {}", file.string(), problem), hint); };

  std::error_code error;
  if (!std::filesystem::exists(file, error)) fail("does not exist", "the path is relative to the case file");
  const std::string suffix = file.extension().string();
  constexpr std::array<std::string_view, 7> suffixes = {".msh",  ".geo", ".inp", ".vtu",
                                                        ".pvtu", ".vtk", ".med"};
  if (std::ranges::count(suffixes, suffix) == 0)
    fail(fmt::format("is none of {}", fmt::join(suffixes, ", ")),
         "a .geo of one line reads other formats: Merge \"part.unv\"; keeps the groups, .bdf and .mesh "
         "lose their names, .step and .iges are geometries to be meshed");
  if (std::filesystem::is_directory(file, error)) fail("is a directory", "name the mesh file in it");
  if (std::filesystem::is_empty(file, error)) fail("is empty", "save the mesh again");
  std::ifstream stream(file, std::ios::binary);
  const int first = stream.get();
  stream.seekg(-1, std::ios::end);
  const int last = stream.get();
  if (!std::filesystem::is_regular_file(file, error) || !stream)
    fail("cannot be read", "check its permissions");
  if (suffix == ".msh" && first != '$')
    fail("is not a Gmsh mesh: it does not begin with a $ section such as $MeshFormat",
         "save the mesh again with Gmsh");
  if (suffix == ".geo" && last != '\n')  // Gmsh ignores the statement at the very end, without a word
    fail("does not end with a newline, and Gmsh would ignore its last statement", "add a newline at the end");
}

}  // namespace tribound::mesh
