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
#include "tribound/mesh/box.h"
#include "tribound/mesh/cut_open.h"
#include "tribound/mesh/gmsh_library.h"
#include "tribound/mesh/gmsh_load.h"
#include "tribound/mesh/gmsh_session.h"
#include "tribound/mesh/import/inp.h"
#include "tribound/mesh/import/med.h"
#include "tribound/mesh/import/simplices.h"
#include "tribound/mesh/import/vtk.h"
#include "tribound/mesh/mesh_bytes.h"

namespace tribound::mesh
{

namespace
{

/// The first number of a result: the dimension of the mesh that follows, or one of these.
enum Answer : std::size_t
{
  refused = 0,  ///< an InputError follows
  no_memory = 1
};

std::string refusal(const InputError& error)
{
  ByteWriter bytes;
  bytes.put(refused);
  for (const std::string& text : {error.where().file, error.where().key, error.problem(), error.hint()})
    bytes.put(std::string_view(text));
  return bytes.take();
}

/// Runs in the child: the mesh, or why there is none.
std::string load_as_bytes(const std::filesystem::path& file)
{
  ByteWriter bytes;
  try
  {
    const SimplicialMesh mesh = make_simplicial(load_gmsh(file));
    std::visit(
        [&]<int dim>(const MeshData<dim>& data)
        {
          bytes.put(dim);
          bytes.put(mesh.notes);
          put(bytes, data);
        },
        mesh.data);
    return bytes.take();
  }
  catch (const InputError& error)
  {
    return refusal(error);
  }
  catch (const std::bad_alloc&)
  {
    ByteWriter answer;
    answer.put(no_memory);
    return answer.take();
  }
  catch (const std::exception& error)
  {
    return refusal({{.file = file.string()}, fmt::format("Gmsh cannot read the file: {}", error.what())});
  }
  catch (...)  // Gmsh up to 4.8 throws strings, and integers
  {
    return refusal({{.file = file.string()}, "Gmsh cannot read the file: no reason given"});
  }
}

[[noreturn]] void throw_refusal(ByteReader& bytes)
{
  Where where;
  std::string problem;
  std::string hint;
  for (std::string* text : {&where.file, &where.key, &problem, &hint}) bytes.get(*text);
  throw InputError(where, problem, hint);
}

constexpr double share_of_machine = 0.9;

/// Reports that a limit of reading_limits(), such as "0.256 GB", is reached, and what that means.
[[noreturn]] void throw_beyond_limits(const std::filesystem::path& file, const std::string& limit)
{
  std::error_code unknown;
  throw InputError({.file = file.string()},
                   fmt::format("Gmsh needs more than {}, too much for a sound file of {:.3g} MB", limit,
                               1e-6 * static_cast<double>(std::filesystem::file_size(file, unknown))),
                   "the file is damaged: a number of entities, nodes or elements in it is wrong; save the "
                   "mesh again with Gmsh");
}

[[noreturn]] void throw_no_memory(const std::filesystem::path& file)
{
  const double allowed = reading_limits(file).memory;
  if (allowed < share_of_machine * machine_memory())
    throw_beyond_limits(file, fmt::format("{:.3g} GB of memory", 1e-9 * allowed));
  throw InputError(
      {.file = file.string()},
      fmt::format("Gmsh needs more than the {:.3g} GB of this machine for it", 1e-9 * machine_memory()),
      "a coarser mesh; is a mesh size or a number of nodes absurd?");
}

SimplicialMesh mesh_data(const std::filesystem::path& file, std::string_view result)
{
  ByteReader bytes(result);
  std::size_t answer = refused;
  bytes.get(answer);
  if (answer == refused) throw_refusal(bytes);
  if (answer == no_memory) throw_no_memory(file);
  const auto read = [&]<int dim>(MeshData<dim>&& data) -> SimplicialMesh
  {
    std::vector<std::string> notes;
    bytes.get(notes);
    data.source = {.file = file.string()};
    get(bytes, data);
    return {std::move(data), std::move(notes)};
  };
  if (answer == 2) return read(MeshData<2>{});
  return read(MeshData<3>{});
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
      file.extension() == ".geo"
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

SimplicialMesh load(const std::filesystem::path& file, const std::atomic<bool>* stop, double patience)
{
  const ApartOutcome outcome =
      run_apart([&] { return load_as_bytes(file); },
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
      throw_beyond_limits(file, fmt::format("{:.3g} s", reading_limits(file).seconds));
    default:
      return mesh_data(file, outcome.result);
  }
}

AnyMesh verified(std::variant<MeshData<2>, MeshData<3>> any, const FindSeams& find_seams)
{
  return std::visit(
      [&]<int dim>(MeshData<dim>& data) -> AnyMesh
      {
        const Seams seams = find_seams ? find_seams(data.boundary_names) : Seams{};
        cut_open<dim>(data, seams.joints);
        data.interfaces.insert(data.interfaces.end(), seams.interfaces.begin(), seams.interfaces.end());
        return Mesh<dim>(std::move(data));
      },
      any);
}

}  // namespace

namespace
{

/// A file of a format that is not read by Gmsh.
std::optional<ImportedMesh> read_own_format(const std::filesystem::path& file,
                                            std::vector<std::string>& notes)
{
  const std::string suffix = file.extension().string();
  if (suffix == ".inp") return read_inp(file);
  if (suffix == ".med") return read_med(file);
  if (suffix == ".vtu" || suffix == ".pvtu" || suffix == ".vtk") return read_vtk(file, {}, notes);
  return {};
}

}  // namespace

AnyMesh read_gmsh(const MeshFile& source, const FindSeams& find_seams, const std::atomic<bool>* stop,
                  double patience, std::vector<std::string>* notes)
{
  check_mesh_file(source.path, source.where);
  SimplicialMesh mesh = load(source.path, stop, patience);
  if (notes) *notes = std::move(mesh.notes);
  return verified(std::move(mesh.data), find_seams);
}

AnyMesh read_mesh(const MeshSource& source, const FindSeams& find_seams, const std::atomic<bool>* stop,
                  std::vector<std::string>* notes)
{
  if (const auto* file = std::get_if<MeshFile>(&source))
  {
    check_mesh_file(file->path, file->where);
    std::vector<std::string> said;
    std::optional<ImportedMesh> imported = read_own_format(file->path, said);
    if (!imported) return read_gmsh(*file, find_seams, stop, default_patience, notes);
    SimplicialMesh mesh = make_simplicial(std::move(*imported));
    said.insert(said.end(), mesh.notes.begin(), mesh.notes.end());
    if (notes) *notes = std::move(said);
    return verified(std::move(mesh.data), find_seams);
  }
  if (const auto* box = std::get_if<BoxMesh>(&source))
    return box->cells.size() == 3 ? verified(box_mesh<3>(*box), find_seams)
                                  : verified(box_mesh<2>(*box), find_seams);
  const auto& boxes = std::get<Boxes>(source);
  return boxes.front().box.cells.size() == 3 ? verified(box_meshes<3>(boxes), find_seams)
                                             : verified(box_meshes<2>(boxes), find_seams);
}

std::string gmsh_version()
{
  return gmsh::version() + " (API)";
}

}  // namespace tribound::mesh
