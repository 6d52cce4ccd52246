/// Reads the boxes of foreign_meshes.py: volumes, regions, boundary, the places of all nodes; then damaged
/// copies.
///
/// Usage: mesh_read_foreign DIRECTORY

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>

#include "tribound/mesh/geometry.h"
#include "tribound/mesh/import/med.h"
#include "tribound/mesh/import/read.h"
#include "tribound/mesh/import/vtk.h"
#include "tribound/mesh/mesh.h"
#include "unit/mesh/imported_testing.h"

namespace tribound
{

namespace
{

int n_failures = 0;

void expect(bool good, const std::filesystem::path& file, const std::string& what)
{
  if (good) return;
  ++n_failures;
  fmt::print("{}: {}\n", file.filename().string(), what);
}

template <int dim>
void check_mesh(const mesh::Mesh<dim>& mesh, const std::filesystem::path& file)
{
  std::map<std::string, double> measures;
  for (Index c = 0; c < mesh.n_cells(); ++c)
    measures["region " + mesh.region_names()[mesh.region(c)]] +=
        mesh::cell_map(mesh, c).det / (dim == 2 ? 2 : 6);
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
    if (facet.tag >= 0)
      measures["boundary " + mesh.boundary_names()[facet.tag]] +=
          mesh::facet_geometry(mesh, facet.cell, facet.local).measure;
  const double height = dim == 3 ? 2 : 1;
  const std::map<std::string, double> expected = {
      {"region 1", 2 * height}, {"region 2", 4 * height}, {"boundary 5", 3 * height}};
  bool good = measures.size() == expected.size();
  for (const auto& [name, measure] : expected) good = good && std::abs(measures[name] - measure) < 1e-5;
  expect(good, file, fmt::format("{} instead of {}", measures, expected));
}

void check(const std::filesystem::path& file)
{
  const bool is_refused = file.filename().string().starts_with("refused");
  try
  {
    std::visit([&](const auto& mesh) { check_mesh(mesh, file); }, mesh::read_mesh(mesh::MeshFile{file}));
    expect(!is_refused, file, "is read");
    std::vector<std::string> notes;
    const mesh::ImportedMesh imported =
        file.extension() == ".med" ? mesh::read_med(file) : mesh::read_vtk(file, "material", notes);
    expect(testing_mesh::misplaced_nodes(imported).empty(), file, "has a node in a wrong place");
    expect(notes.empty(), file, fmt::format("has the notes {}", notes));
  }
  catch (const InputError& error)
  {
    expect(is_refused, file, error.what());
  }
}

/// Bytes changed, the end cut off: a mesh or a message.
void check_damaged(const std::filesystem::path& file, std::mt19937& random)
{
  const auto below = [&](std::size_t n)
  { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  std::ifstream in(file, std::ios::binary);
  const std::string sound((std::istreambuf_iterator<char>(in)), {});
  const std::filesystem::path damaged = file.parent_path() / ("damaged" + file.extension().string());
  for (int k = 0; k < 4; ++k)
  {
    std::string text = sound;
    for (std::size_t n = 1 + below(3); n > 0; --n)
      text[below(text.size())] = static_cast<char>(below(2) == 0 ? 255 : below(256));
    if (below(4) == 0) text.resize(1 + below(text.size()));
    std::ofstream(damaged, std::ios::binary) << text;
    try
    {
      (void)mesh::read_mesh(mesh::MeshFile{damaged});
    }
    catch (const InputError& error)
    {
      expect(!error.where().file.empty() && !error.problem().empty(), file, "damaged: no message");
    }
  }
  std::filesystem::remove(damaged);
}

}  // namespace

}  // namespace tribound

int main(int, char** arguments)
{
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(arguments[1])) files.push_back(entry.path());
  std::ranges::sort(files);
  std::mt19937 random(1);
  for (const std::filesystem::path& file : files)
  {
    tribound::check(file);
    tribound::check_damaged(file, random);
  }
  fmt::print("{} files, {} failures\n", files.size(), tribound::n_failures);
  return files.size() > 190 && tribound::n_failures == 0 ? 0 : 1;
}
