/// Meshes of VTK in text, as a test can write them: pieces and parts, regions, facets, ghosts, versions, and
/// what is refused. Files that VTK and others write: read_foreign.cpp.

#include "tribound/mesh/import/vtk.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <random>

#include "unit/mesh/imported_testing.h"
#include "unit/mesh/mesh_testing.h"

namespace tribound
{

namespace
{

using testing_mesh::boundary_measure;
using testing_mesh::cell_types;
using testing_mesh::Directory;
using testing_mesh::expect_input_error;
using testing_mesh::ImportedBox;
using testing_mesh::volume;

/// A grid in text; arrays of cells and points as XML.
struct Grid
{
  std::vector<double> points;
  std::vector<std::vector<int>> cells;
  std::vector<int> types;
  std::string cell_data{};
  std::string point_data{};
};

std::string array(const std::string& name, const std::string& numbers, const std::string& type = "Int32")
{
  return fmt::format("<DataArray type=\"{}\" Name=\"{}\" format=\"ascii\">{}</DataArray>\n", type, name,
                     numbers);
}

std::string piece(const Grid& grid)
{
  std::vector<int> nodes;
  std::vector<std::size_t> ends;
  for (const std::vector<int>& cell : grid.cells)
  {
    nodes.insert(nodes.end(), cell.begin(), cell.end());
    ends.push_back(nodes.size());
  }
  return fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", grid.points.size() / 3,
                     grid.cells.size()) +
         fmt::format("<PointData>{}</PointData><CellData>{}</CellData>\n", grid.point_data, grid.cell_data) +
         fmt::format(
             "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">{}"
             "</DataArray></Points>\n<Cells>",
             fmt::join(grid.points, " ")) +
         array("connectivity", fmt::format("{}", fmt::join(nodes, " "))) +
         array("offsets", fmt::format("{}", fmt::join(ends, " "))) +
         array("types", fmt::format("{}", fmt::join(grid.types, " ")), "UInt8") + "</Cells></Piece>\n";
}

std::string vtu(const std::vector<Grid>& grids, const std::string& version = "2.2")
{
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"{}\" "
      "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n",
      version);
  for (const Grid& grid : grids) text += piece(grid);
  return text + "</UnstructuredGrid></VTKFile>\n";
}

/// A square of two triangles, its lower edge and a corner.
Grid square(const std::string& values)
{
  return {{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0},
          {{0, 1, 2}, {0, 2, 3}, {0, 1}, {0}},
          {5, 5, 3, 1},
          values.empty() ? "" : array("material", values)};
}

/// The square shifted, with points of its own.
Grid next_square(const std::string& ids)
{
  return {{1, 0, 0, 2, 0, 0, 2, 1, 0, 1, 1, 0}, {{0, 1, 2, 3}}, {9}, {}, array("GlobalPointIds", ids)};
}

mesh::Mesh<2> plane(const Directory& directory, const std::string& text,
                    std::vector<std::string>* notes = nullptr, const std::string& name = "grid.vtu")
{
  return std::get<mesh::Mesh<2>>(mesh::read_mesh(directory.write(name, text), {}, nullptr, notes));
}

TEST(Vtk, RegionsAndBoundariesAreValuesOfTheArray)
{
  const Directory directory;
  std::vector<std::string> notes;
  const mesh::Mesh<2> mesh = plane(directory, vtu({square("7 -3 4 0")}), &notes);
  EXPECT_THAT(mesh.region_names(), testing::ElementsAre("-3", "7"));
  EXPECT_THAT(mesh.boundary_names(), testing::ElementsAre("4"));
  EXPECT_NEAR(boundary_measure(mesh, 0), 1, 1e-14);
  EXPECT_THAT(notes, testing::ElementsAre(testing::HasSubstr("grid.vtu: 1 vertices are left out")));
}

TEST(Vtk, WithoutAnArrayThereIsOneRegion)
{
  const Directory directory;
  std::vector<std::string> notes;
  const mesh::Mesh<2> mesh = plane(directory, vtu({square("")}), &notes);
  EXPECT_THAT(mesh.region_names(), testing::ElementsAre("domain"));
  EXPECT_THAT(notes, testing::Contains(testing::HasSubstr("1 edges are in no boundary, since no array")));
}

TEST(Vtk, CountsMayHaveBlanks)
{
  const Directory directory;
  std::string text = vtu({square("")});
  text.replace(text.find("NumberOfCells=\"4\""), 17, "NumberOfCells=\" 4\"");
  EXPECT_EQ(plane(directory, text).n_cells(), 2);
}

TEST(Vtk, TheArrayCanBeChosen)
{
  const Directory directory;
  Grid grid = square("1 1 0 0");
  grid.cell_data += array("mine", "2.0 3.0 0 0", "Float32") + array("half", "2.5 3 0 0", "Float64");
  const auto file = directory.write("grid.vtu", vtu({grid})).path;
  std::vector<std::string> notes;
  const mesh::ImportedMesh mesh = mesh::read_vtk(file, "mine", notes);
  ASSERT_EQ(mesh.cell_sets.size(), 2U);
  EXPECT_EQ(mesh.cell_sets[1].name, "3");
  EXPECT_THAT(notes, testing::Contains(
                         testing::HasSubstr("1 edges are in no boundary, since they have 0 in \"mine\"")));
  expect_input_error([&] { (void)mesh::read_vtk(file, "half", notes); },
                     {"array \"half\" has \"2.5\" where an integer is needed"});
  expect_input_error([&] { (void)mesh::read_vtk(file, "none", notes); },
                     {"no cell array \"none\"", "one of \"material\", \"mine\", \"half\""});
}

TEST(Vtk, PiecesShareThePointsWithTheSameGlobalNumbers)
{
  const Directory directory;
  Grid first = next_square("10 11 12 13");
  first.points = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  const std::string shared = vtu({first, next_square("11 21 22 12")});
  EXPECT_EQ(plane(directory, shared).n_vertices(), 6);
  // Numbers of a part of its own are not global.
  std::string original = vtu({first, next_square("10 21 22 12")});
  for (std::size_t at = 0; (at = original.find("GlobalPointIds")) != std::string::npos;)
    original.replace(at, 14, "vtkOriginalPointIds");
  std::vector<std::string> notes;
  EXPECT_EQ(mesh::read_vtk(directory.write("grid.vtu", original).path, {}, notes).nodes.size(), 7U);
  notes.clear();
  Grid second = next_square("");
  second.point_data.clear();
  const auto apart = directory.write("grid.vtu", vtu({first, second})).path;
  EXPECT_EQ(mesh::read_vtk(apart, {}, notes).nodes.size(), 8U);
  EXPECT_THAT(notes, testing::ElementsAre(testing::HasSubstr("4 of 8 points lie where another point")));
  expect_input_error(
      [&] {
        (void)plane(directory, vtu({first, next_square("10 21 22 12")}));
      },
      {"points 0 and 4 have the global number 10, and are not at the same place"});
}

TEST(Vtk, PartsOfAParallelFileAreReadWithoutGhosts)
{
  const Directory directory;
  Grid first = next_square("10 11 12 13");
  first.points = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0};
  first.cells.push_back({1, 4, 5, 2});
  first.types.push_back(9);
  first.point_data = array("GlobalPointIds", "10 11 12 13 21 22");
  first.cell_data = array("vtkGhostType", "0 1", "UInt8");
  (void)directory.write("part0.vtu", vtu({first}));
  (void)directory.write("part1.vtu", vtu({next_square("11 21 22 12")}));
  const std::string parallel =
      "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\"><PUnstructuredGrid GhostLevel=\"1\">"
      "<Piece Source=\"part0.vtu\"/><Piece Source=\"{}.vtu\"/></PUnstructuredGrid></VTKFile>";
  std::vector<std::string> notes;
  const mesh::Mesh<2> mesh =
      plane(directory, fmt::format(fmt::runtime(parallel), "part1"), &notes, "all.pvtu");
  EXPECT_EQ(mesh.n_vertices(), 6);
  EXPECT_NEAR(volume(mesh), 2, 1e-14);
  EXPECT_THAT(notes, testing::ElementsAre(testing::HasSubstr("1 ghost cells are left out")));
  expect_input_error(
      [&] { (void)plane(directory, fmt::format(fmt::runtime(parallel), "part2"), nullptr, "all.pvtu"); },
      {"part2.vtu\" does not exist"});
}

/// Before 2.1 the last two edges were the other way round.
TEST(Vtk, OldHexahedraOfOrderTwoAreInOrder)
{
  const Directory directory;
  std::mt19937 random(3);
  const mesh::ImportedMesh box = ImportedBox({mesh::Shape::hexahedron, 27}, {1, 1, 1}, random).take();
  // Places of our nodes in VTK's order of today.
  const std::vector<int> order = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13,
                                  14, 15, 16, 17, 18, 19, 25, 23, 22, 24, 20, 21, 26};
  Grid grid{{}, {{}}, {72}};
  for (const Point<3>& x : box.nodes) grid.points.insert(grid.points.end(), x.begin(), x.end());
  for (const int place : order) grid.cells[0].push_back(box.cells[0].element(0)[place]);
  for (const std::string version : {"2.2", "1.0"})
  {
    std::vector<std::string> notes;
    const auto file = directory.write("grid.vtu", vtu({grid}, version)).path;
    EXPECT_EQ(testing_mesh::misplaced_nodes(mesh::read_vtk(file, {}, notes)), "") << version;
    std::swap(grid.cells[0][18], grid.cells[0][19]);
  }
}

const std::string legacy =
    "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0\n1 1 0 "
    "0 1 "
    "0\n"
    "CELLS 2 8\n3 0 1 2\n3 0 2 3\nCELL_TYPES 2\n5\n5\nPOINT_DATA 4\nVECTORS u double\n1 2 3 4 5 6 7 8 9 10 "
    "11 "
    "12\n"
    "SCALARS t float\nLOOKUP_TABLE mine\n1 2 3 4\nLOOKUP_TABLE mine 1\n0 0 0 1\nCELL_DATA 2\nFIELD FieldData "
    "2\n"
    "x%20y 2 2 double\n1 2 3 4\nMaterialID 1 2 int\n3 4\n";

TEST(Vtk, LegacyFilesHaveAllKindsOfArrays)
{
  const Directory directory;
  const mesh::Mesh<2> mesh = plane(directory, legacy, nullptr, "grid.vtk");
  EXPECT_THAT(mesh.region_names(), testing::ElementsAre("3", "4"));
  EXPECT_NEAR(volume(mesh), 1, 1e-14);
}

struct BadGrid
{
  std::string name;
  std::string file;
  std::string text;
  std::vector<std::string> words;
};

void PrintTo(const BadGrid& bad, std::ostream* out)
{
  *out << bad.name;
}

std::string replaced(std::string text, const std::string& what, const std::string& by)
{
  return text.replace(text.find(what), what.size(), by);
}

class BadVtk : public testing::TestWithParam<BadGrid>
{
};

TEST_P(BadVtk, IsRefused)
{
  const Directory directory;
  const mesh::MeshFile file = directory.write(GetParam().file, GetParam().text);
  const std::string message = testing_mesh::message_of([&] { (void)mesh::read_mesh(file); });
  for (const std::string& word : GetParam().words) EXPECT_THAT(message, testing::HasSubstr(word));
}

const std::string sound = vtu({square("1 1 2 0")});

INSTANTIATE_TEST_SUITE_P(
    Vtk, BadVtk,
    testing::ValuesIn(std::vector<BadGrid>{
        {"NoXml", "a.vtu", "hello", {"a.vtu", "is no XML"}},
        {"CutOff", "a.vtu", sound.substr(0, 400), {"a.vtu:", "is no XML", "cut off"}},
        {"PolyData",
         "a.vtu",
         "<VTKFile type=\"PolyData\"></VTKFile>",
         {"is of the type PolyData, not an unstructured grid"}},
        {"Lz4",
         "a.vtu",
         replaced(sound, "version=\"2.2\"", "version=\"2.2\" compressor=\"vtkLZ4DataCompressor\""),
         {"is compressed by vtkLZ4DataCompressor", "zlib"}},
        {"Empty", "a.vtu", vtu({}), {"the grid has no cells"}},
        {"Polyhedron",
         "a.vtu",
         replaced(sound, ">5 5 3 1<", ">5 42 3 1<"),
         {"cell 1 is of type 42 (polyhedron) with 3 points, which is not read"}},
        {"HighOrder",
         "a.vtu",
         vtu({{{0, 0, 0}, {std::vector<int>(21, 0)}, {69}}}),
         {"cell 0 is of type 69 (Lagrange triangle) with 21 points",
          "triangles and tetrahedra of order 1 to 4"}},
        {"HighOrderOfQuadrilaterals",
         "a.vtu",
         vtu({{{0, 0, 0}, {std::vector<int>(16, 0)}, {70}}}),
         {"cell 0 is of type 70 (Lagrange quadrilateral) with 16 points", "of order 1 or 2"}},
        {"OnlyLines",
         "a.vtu",
         vtu({{{0, 0, 0, 1, 0, 0}, {{0, 1}}, {3}}}),
         {"neither plane elements nor solids"}},
        {"NoSuchPoint",
         "a.vtu",
         replaced(sound, ">0 1 2 0 2 3", ">0 1 2 0 2 4"),
         {"node 4 of cell 1 does not exist: there are 4 points"}},
        {"PointMissing",
         "a.vtu",
         replaced(sound, "0 1 0</DataArray>", "0 1</DataArray>"),
         {"array \"Points\" has 11 of its 12 numbers"}},
        {"PointTooMuch",
         "a.vtu",
         replaced(sound, "0 1 0</DataArray>", "0 1 0 7</DataArray>"),
         {"array \"Points\" has more than 12 numbers"}},
        {"NoNumber",
         "a.vtu",
         replaced(sound, "0 1 0</DataArray>", "0 x 0</DataArray>"),
         {"array \"Points\" has \"x\" where a number is needed"}},
        {"Huge",
         "a.vtu",
         replaced(sound, "NumberOfCells=\"4\"", "NumberOfCells=\"99999999999999\""),
         {"NumberOfCells of a <Piece> is \"99999999999999\""}},
        {"OffsetsBack",
         "a.vtu",
         replaced(sound, ">3 6 8 9<", ">6 3 8 9<"),
         {"the nodes of cell 1 end before they begin"}},
        {"EdgeInside",
         "a.vtu",
         replaced(sound, "0 1 2 0 2 3 0 1", "0 1 2 0 2 3 1 3"),
         {"cell 2 (segment of 2 nodes) is not an edge of a cell"}},
        {"Flat",
         "a.vtu",
         replaced(sound, "1 1 0 0 1 0", "1 1 1 0 1 0"),
         {"node 2 at (1, 1, 1) is not in the plane z = 0"}},
        {"Folded",
         "a.vtu",
         replaced(sound, "0 1 2 0 2 3", "0 1 2 0 3 2"),
         {"element 1 (triangle of 3 nodes)", "is inverted"}},
        {"NoLegacy", "a.vtk", "hello\n", {"does not begin with \"# vtk DataFile Version\" 2.0 to 5.1"}},
        {"Structured",
         "a.vtk",
         replaced(legacy, "UNSTRUCTURED_GRID", "STRUCTURED_POINTS"),
         {"has the dataset \"STRUCTURED_POINTS\", not UNSTRUCTURED_GRID"}},
        {"LegacyCutOff",
         "a.vtk",
         legacy.substr(0, legacy.find("3 0 2 3") + 3),
         {"array \"CELLS\" ends too early"}},
        {"LegacyArray",
         "a.vtk",
         replaced(legacy, "int\n3 4", "blob\n3 4"),
         {"is of type \"blob\", which is not read"}},
        {"LegacyWord", "a.vtk", legacy + "HELLO 3\n", {"has \"hello\" where a keyword"}},
        {"LegacyCounts",
         "a.vtk",
         replaced(legacy, "CELL_TYPES 2", "CELL_TYPES 3"),
         {"has 3 CELL_TYPES for 2 CELLS"}},
        {"LegacyNodes",
         "a.vtk",
         replaced(legacy, "\n3 0 2 3", "\n4 0 2 3"),
         {"the nodes of cell 1 are missing"}},
    }),
    [](const auto& info) { return info.param.name; });

TEST(Vtk, DamagedTextsEndInAMessage)
{
  const Directory directory;
  std::mt19937 random(17);
  const auto below = [&](std::size_t n)
  { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  int n_read = 0;
  for (int k = 0; k < 2000; ++k)
  {
    std::string text = k % 2 == 0 ? legacy : sound;
    for (std::size_t n = 1 + below(3); n > 0; --n)
    {
      const std::size_t at = below(text.size());
      const std::array<std::string, 3> others = {text.substr(below(text.size()), below(40)),
                                                 std::to_string(random()),
                                                 std::string(1, static_cast<char>(below(256)))};
      text.replace(at, below(4), others[below(3)]);
      if (below(20) == 0) text.resize(at + 1);
    }
    if (testing_mesh::gives_mesh_or_message(directory.write(k % 2 == 0 ? "grid.vtk" : "grid.vtu", text)))
      ++n_read;
  }
  EXPECT_GT(n_read, 50);
}

}  // namespace

}  // namespace tribound
