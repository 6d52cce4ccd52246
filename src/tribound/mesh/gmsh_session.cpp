#include "tribound/mesh/gmsh_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "tribound/base/apart.h"
#include "tribound/mesh/gmsh_geometry.h"
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

}  // namespace

void run_gmsh(const std::filesystem::path& file, const std::string& what, const std::string& hint,
              const std::function<void()>& step)
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

ReadingLimits reading_limits(const std::filesystem::path& file)
{
  if (is_geometry(file)) return {HUGE_VAL, HUGE_VAL};
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

void open_in_gmsh(const MeshFile& source, std::vector<std::string>& notes)
{
  const std::filesystem::path& file = source.path;
  if (const std::string problem = gmsh::load(); !problem.empty())
    throw InputError({.file = file.string()}, "Gmsh's library, which reads it, cannot be loaded: " + problem,
                     "install Gmsh " + gmsh::version() +
                         " with its library (Debian: libgmsh); a box (mesh.box) needs none");
  gmsh::initialize();
  gmsh::set_number("General.Terminal", 1);    // signs of progress for the process that waits
  gmsh::set_number("General.NumThreads", 1);  // a copied process has no team of threads
  gmsh::start_logger();
  const ReadingLimits most = reading_limits(file);
  limit_from_here(most.memory, most.seconds);
  if (is_geometry(file))
    mesh_geometry(source, notes);
  else
    run_gmsh(file, "read the file", "is it complete? Save the mesh again with the program that has made it",
             [&] { gmsh::open(file.string()); });
}

}  // namespace tribound::mesh
