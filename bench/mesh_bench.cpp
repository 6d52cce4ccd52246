/// Reading, verifying, sorting and bisecting meshes of a million triangles and of half a million tetrahedra;
/// overlays of boundaries.

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmsh.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tribound/contact/pairing/pairing.h"
#include "tribound/mesh/bisect.h"
#include "tribound/mesh/box.h"
#include "tribound/mesh/import/inp.h"
#include "tribound/mesh/import/read.h"
#include "tribound/mesh/import/simplices.h"
#include "tribound/mesh/import/vtk.h"
#include "tribound/mesh/mesh.h"

namespace
{

using namespace tribound;

/// 1 002 528 triangles or 511 104 tetrahedra.
template <int dim>
mesh::BoxMesh large_box()
{
  if constexpr (dim == 2) return {{0, 0}, {2, 1}, {708, 708}, {}};
  return {{0, 0, 0}, {2, 1, 1}, {44, 44, 44}, {}};
}

template <int dim>
void topology(benchmark::State& state)
{
  const mesh::MeshData<dim> data = mesh::box_mesh<dim>(large_box<dim>());
  for (auto _ : state)
    benchmark::DoNotOptimize(mesh::build_topology<dim>(static_cast<Index>(data.vertices.size()), data.cells));
  state.counters["cells"] = static_cast<double>(data.cells.size());
}

/// The constructor of Mesh: verification and topology.
template <int dim>
void verified_mesh(benchmark::State& state)
{
  const mesh::MeshData<dim> data = mesh::box_mesh<dim>(large_box<dim>());
  for (auto _ : state)
  {
    state.PauseTiming();
    mesh::MeshData<dim> copy = data;
    state.ResumeTiming();
    benchmark::DoNotOptimize(mesh::Mesh<dim>(std::move(copy)));
  }
  state.counters["cells"] = static_cast<double>(data.cells.size());
}

/// Three tenths of the cells, marked at random: the worst case for the closure. Arguments: `times`, and
/// whether the mesh comes from bisection (with one cell marked) or its longest edges are determined.
template <int dim>
void bisection(benchmark::State& state)
{
  mesh::Mesh<dim> mesh(mesh::box_mesh<dim>(large_box<dim>()));
  if (state.range(1) != 0) mesh = mesh::bisect<dim>(mesh, std::array<Index, 1>{0}).mesh;
  std::mt19937 random(1);
  std::bernoulli_distribution chosen(0.3);
  std::vector<Index> marked;
  for (Index c = 0; c < mesh.n_cells(); ++c)
    if (chosen(random)) marked.push_back(c);
  Index n_cells = 0;
  for (auto _ : state)
    n_cells = mesh::bisect<dim>(mesh, marked, static_cast<int>(state.range(0))).mesh.n_cells();
  state.counters["cells"] = mesh.n_cells();
  state.counters["bisected"] = n_cells;
}

/// The overlay of two sides of a flat box whose 2 n^2 facets do not match. Argument: n.
void overlay(benchmark::State& state)
{
  const auto n = static_cast<int>(state.range(0));
  mesh::MeshData<3> data = mesh::box_mesh<3>({{0, 0, 0}, {1, 1, 1}, {n, 1, n}, {}});
  for (Point<3>& x : data.vertices)
    if (x[1] > 0)
      for (const int i : {0, 2}) x[i] += 0.4 * x[i] * (1 - x[i]);
  const mesh::Mesh<3> mesh(std::move(data));
  const auto side = [&](const std::string& name) { return mesh::facets_named<3>(mesh, std::span(&name, 1)); };
  const std::vector<std::size_t> bottom = side("bottom");
  const std::vector<std::size_t> top = side("top");
  std::size_t n_segments = 0;
  for (auto _ : state) n_segments = contact::overlay<3>(mesh, bottom, top).size();
  state.counters["segments"] = static_cast<double>(n_segments);
}

/// The large box as Gmsh would save it, with irregular coordinates so that ASCII files have all digits.
std::filesystem::path write_large_file(double version, bool binary)
{
  const mesh::MeshData<2> data = mesh::box_mesh<2>(large_box<2>());
  std::vector<std::size_t> tags;
  std::vector<double> x;
  for (const Point<2>& p : data.vertices)
  {
    tags.push_back(tags.size() + 1);
    x.insert(x.end(), {p[0] / 3 + p[0] * p[0] / 7, p[1] / 3 + p[1] * p[1] / 7, 0.0});
  }
  std::vector<std::size_t> triangles;
  for (const auto& cell : data.cells)
    for (const Index v : cell) triangles.push_back(static_cast<std::size_t>(v) + 1);

  auto file = std::filesystem::temp_directory_path() / "tribound_mesh_bench.msh";
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("Mesh.MshFileVersion", version);
  gmsh::option::setNumber("Mesh.Binary", binary);
  gmsh::model::addDiscreteEntity(2, 1);
  gmsh::model::mesh::addNodes(2, 1, tags, x);
  gmsh::model::mesh::addElementsByType(1, 2, {}, triangles);
  gmsh::write(file.string());
  gmsh::finalize();
  return file;
}

void read_file(benchmark::State& state)
{
  const mesh::MeshFile source{write_large_file(static_cast<double>(state.range(0)) / 10, state.range(1) != 0),
                              {}};
  Index n_cells = 0;
  for (auto _ : state) n_cells = std::get<mesh::Mesh<2>>(mesh::read_mesh(source)).n_cells();
  state.counters["cells"] = n_cells;
  std::filesystem::remove(source.path);
}

/// A cube of n^3 hexahedra as a deck, with regions, a surface and a node set.
std::filesystem::path write_large_deck(int n)
{
  auto file = std::filesystem::temp_directory_path() / "tribound_mesh_bench.inp";
  std::FILE* out = std::fopen(file.c_str(), "w");
  const auto node = [n](int i, int j, int k) { return 1 + i + (n + 1) * (j + (n + 1) * k); };
  std::fputs("*NODE, NSET=Nall\n", out);
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i)
        fmt::print(out, "{}, {:.9e}, {:.9e}, {:.9e}\n", node(i, j, k), i / 3.0, j / 3.0, k / 3.0);
  std::fputs("*ELEMENT, TYPE=C3D8, ELSET=Eall\n", out);
  int element = 0;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
      {
        fmt::print(out, "{}", ++element);
        for (const int z : {k, k + 1})
          fmt::print(out, ", {}, {}, {}, {}", node(i, j, z), node(i + 1, j, z), node(i + 1, j + 1, z),
                     node(i, j + 1, z));
        std::fputs("\n", out);
      }
  fmt::print(out, "*ELSET, ELSET=Ebottom, GENERATE\n1, {}\n*SURFACE, NAME=bottom\nEbottom, S1\n", n * n);
  fmt::print(out, "*NSET, NSET=top, GENERATE\n{}, {}\n", node(0, 0, n), node(n, n, n));
  std::fclose(out);
  return file;
}

/// Reading a deck of hexahedra and cutting them into tetrahedra, without the verification of the mesh.
void read_deck(benchmark::State& state)
{
  const std::filesystem::path file = write_large_deck(static_cast<int>(state.range(0)));
  std::size_t n_cells = 0;
  for (auto _ : state)
  {
    std::vector<std::string> notes;
    mesh::ImportedMesh mesh = mesh::read_inp(file, false, notes);
    n_cells = std::get<mesh::MeshData<3>>(mesh::make_simplicial(std::move(mesh)).data).cells.size();
  }
  state.counters["cells"] = static_cast<double>(n_cells);
  std::filesystem::remove(file);
}

/// The same cube as VTK's XML, in text or raw bytes behind it.
std::filesystem::path write_large_vtu(int n, bool is_text)
{
  auto file = std::filesystem::temp_directory_path() / "tribound_mesh_bench.vtu";
  const auto node = [n](int i, int j, int k) { return i + (n + 1) * (j + (n + 1) * k); };
  std::vector<double> points;
  std::vector<std::int64_t> connectivity;
  std::vector<std::int64_t> offsets;
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) points.insert(points.end(), {i / 3.0, j / 3.0, k / 3.0});
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
      {
        for (const int z : {k, k + 1})
          connectivity.insert(connectivity.end(),
                              {node(i, j, z), node(i + 1, j, z), node(i + 1, j + 1, z), node(i, j + 1, z)});
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
      }
  const std::vector<std::uint8_t> types(offsets.size(), 12);
  std::string appended = "_";
  std::FILE* out = std::fopen(file.c_str(), "w");
  const auto array = [&](const char* type, const char* name, int n_components, const auto& values)
  {
    fmt::print(out, "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" ", type, name,
               n_components);
    if (is_text)
      fmt::print(out, "format=\"ascii\">{}</DataArray>\n", fmt::join(values, " "));
    else
      fmt::print(out, "format=\"appended\" offset=\"{}\"/>\n", appended.size() - 1);
    const std::uint64_t size = values.size() * sizeof(values[0]);
    appended.append(reinterpret_cast<const char*>(&size), sizeof(size));
    appended.append(reinterpret_cast<const char*>(values.data()), size);
  };
  fmt::print(out,
             "<VTKFile type=\"UnstructuredGrid\" version=\"2.2\" byte_order=\"LittleEndian\" "
             "header_type=\"UInt64\"><UnstructuredGrid><Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">",
             points.size() / 3, offsets.size());
  std::fputs("<Points>", out);
  array("Float64", "Points", 3, points);
  std::fputs("</Points><Cells>", out);
  array("Int64", "connectivity", 1, connectivity);
  array("Int64", "offsets", 1, offsets);
  array("UInt8", "types", 1, types);
  std::fputs("</Cells></Piece></UnstructuredGrid>", out);
  if (!is_text) std::fputs("<AppendedData encoding=\"raw\">", out);
  if (!is_text) std::fwrite(appended.data(), 1, appended.size(), out);
  if (!is_text) std::fputs("</AppendedData>", out);
  std::fputs("</VTKFile>", out);
  std::fclose(out);
  return file;
}

/// As read_deck.
void read_vtu(benchmark::State& state)
{
  const std::filesystem::path file = write_large_vtu(static_cast<int>(state.range(0)), state.range(1) != 0);
  std::size_t n_cells = 0;
  for (auto _ : state)
  {
    std::vector<std::string> notes;
    n_cells =
        std::get<mesh::MeshData<3>>(mesh::make_simplicial(mesh::read_vtk(file, {}, notes)).data).cells.size();
  }
  state.counters["cells"] = static_cast<double>(n_cells);
  std::filesystem::remove(file);
}

}  // namespace

BENCHMARK(topology<2>)->Unit(benchmark::kMillisecond);
BENCHMARK(topology<3>)->Unit(benchmark::kMillisecond);
BENCHMARK(verified_mesh<2>)->Unit(benchmark::kMillisecond);
BENCHMARK(verified_mesh<3>)->Unit(benchmark::kMillisecond);
BENCHMARK(bisection<2>)
    ->ArgNames({"times", "again"})
    ->ArgsProduct({{1, 2}, {0, 1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(bisection<3>)
    ->ArgNames({"times", "again"})
    ->ArgsProduct({{1, 3}, {0, 1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(overlay)->RangeMultiplier(2)->Range(32, 256)->Unit(benchmark::kMillisecond);
BENCHMARK(read_file)
    ->ArgNames({"version", "binary"})
    ->ArgsProduct({{22, 41}, {0, 1}})
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(read_deck)->Arg(100)->Unit(benchmark::kMillisecond);
BENCHMARK(read_vtu)->ArgNames({"n", "text"})->ArgsProduct({{100}, {0, 1}})->Unit(benchmark::kMillisecond);

BENCHMARK_MAIN();
