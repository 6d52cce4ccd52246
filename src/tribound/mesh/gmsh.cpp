#include "tribound/mesh/gmsh.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "tribound/base/apart.h"
#include "tribound/base/memory.h"
#include "tribound/mesh/gmsh_geometry.h"
#include "tribound/mesh/gmsh_library.h"
#include "tribound/mesh/gmsh_load.h"
#include "tribound/mesh/gmsh_session.h"
#include "tribound/mesh/import/imported_bytes.h"

namespace tribound::mesh
{

namespace
{

constexpr double share_of_machine = 0.9;

/// A limit of reading_limits(), such as "0.256 GB", is reached, and what that means.
InputError beyond_limits(const std::filesystem::path& file, const std::string& limit)
{
  std::error_code unknown;
  return {{.file = file.string()},
          fmt::format("Gmsh needs more than {}, too much for a sound file of {:.3g} MB", limit,
                      1e-6 * static_cast<double>(std::filesystem::file_size(file, unknown))),
          "the file is damaged: a number of entities, nodes or elements in it is wrong; save the mesh again "
          "with Gmsh"};
}

InputError no_memory(const std::filesystem::path& file)
{
  const double allowed = reading_limits(file).memory;
  if (allowed < share_of_machine * machine_memory())
    return beyond_limits(file, fmt::format("{:.3g} GB of memory", 1e-9 * allowed));
  return {{.file = file.string()},
          fmt::format("Gmsh needs more than the {:.3g} GB of this machine for it", 1e-9 * machine_memory()),
          "a coarser mesh; is a mesh size or a number of nodes absurd?"};
}

/// Runs in the child: what `load` returns, or why there is none.
std::string loaded(const std::filesystem::path& file, const std::function<std::string()>& load)
{
  const auto failure = [&](std::string_view what) {
    return bytes_of(InputError({.file = file.string()}, fmt::format("Gmsh cannot read the file: {}", what)));
  };
  try
  {
    return load();
  }
  catch (const InputError& error)
  {
    return bytes_of(error);
  }
  catch (const std::bad_alloc&)
  {
    return bytes_of(no_memory(file));
  }
  catch (const std::exception& error)
  {
    return failure(error.what());
  }
  catch (...)  // Gmsh up to 4.8 throws strings, and integers
  {
    return failure("no reason given");
  }
}

/// The last errors that Gmsh has printed ("Error   : text"), at most three.
std::string printed_errors(std::string_view output)
{
  constexpr std::string_view prefix = "Error   : ";
  std::string text;
  for (int n = 0; n < 3; ++n)
  {
    const std::size_t begin = output.rfind(prefix);
    if (begin == std::string_view::npos) break;
    const std::string_view line = output.substr(begin + prefix.size());
    if (!text.empty()) text.insert(0, "; ");
    text.insert(0, line.substr(0, line.find('\n')));
    output = output.substr(0, begin);
  }
  return text;
}

[[noreturn]] void throw_crashed(const std::filesystem::path& file, const ApartOutcome& outcome)
{
  const std::string errors = printed_errors(outcome.output);
  throw InputError(
      {.file = file.string()},
      fmt::format("Gmsh cannot read the file: it {}{}{}", describe_end(outcome.status),
                  errors.empty() ? "" : ": ", errors),
      is_geometry(file)
          ? "do curves or surfaces cross, or is a mesh size absurd? Leave out parts of the geometry to find "
            "it"
          : "the file is damaged, or has numbers that Gmsh cannot take, such as nodes or elements numbered "
            "below "
            "1 or above 2147483647: save the mesh again with Gmsh (Mesh.Renumber = 1)");
}

[[noreturn]] void throw_silent(const std::filesystem::path& file, double patience)
{
  throw InputError(
      {.file = file.string()}, fmt::format("Gmsh shows no progress for {:g} s and was ended", patience),
      "is a coordinate or a mesh size absurd? A mesh that takes so long can be made once, with the "
      "program gmsh (Debian: apt install gmsh), and the case name the .msh");
}

}  // namespace

std::string load_apart(const std::filesystem::path& file, const std::function<std::string()>& load,
                       const std::atomic<bool>* stop, double patience)
{
  ApartOutcome outcome =
      run_apart([&] { return loaded(file, load); },
                {.silence = patience, .memory = share_of_machine * machine_memory(), .stop = stop});
  switch (outcome.end)
  {
    case ApartEnd::stopped:
      throw SolveError("interrupted while the mesh was read");
    case ApartEnd::silent:
      throw_silent(file, patience);
    case ApartEnd::crashed:
      throw_crashed(file, outcome);
    case ApartEnd::out_of_time:
      throw beyond_limits(file, fmt::format("{:.3g} s", reading_limits(file).seconds));
    default:
      return std::move(outcome.result);
  }
}

ImportedMesh read_gmsh(const MeshFile& source, const std::atomic<bool>* stop, double patience,
                       std::vector<std::string>& notes)
{
  const auto load = [&]
  {
    std::vector<std::string> its_notes;
    const ImportedMesh mesh = load_gmsh(source, its_notes);
    return bytes_of(mesh, its_notes);
  };
  const std::string bytes = load_apart(source.path, load, stop, patience);
  return mesh_from(bytes, {.file = source.path.string()}, notes);
}

std::string gmsh_version()
{
  return gmsh::version() + " (API)";
}

}  // namespace tribound::mesh
