/// Solutions of other programs as tables and of VTK: orders, choices, what is refused; damaged files of all
/// formats. Gmsh and CalculiX: solution_programs_test.cpp.

#include "tribound/mesh/import/imported_solution.h"

#include <random>

#include "support/damaged.h"
#include "unit/mesh/mesh_testing.h"
#include "unit/mesh/solution_programs.h"

namespace tribound
{

namespace
{

using mesh::ImportedSolution;
using mesh::read_solution;
using mesh::Shape;
using testing_mesh::box;
using testing_mesh::Directory;
using testing_mesh::expect_field;
using testing_mesh::expect_input_error;

const std::vector<std::string> solid_columns = {"x",   "y",   "z",   "ux",  "uy",  "uz",
                                                "sxx", "syy", "szz", "sxy", "syz", "sxz"};

const std::vector<mesh::ElementType> types_of_vtk = {
    {Shape::triangle, 3},    {Shape::triangle, 6},     {Shape::triangle, 10},    {Shape::triangle, 15},
    {Shape::tetrahedron, 4}, {Shape::tetrahedron, 10}, {Shape::tetrahedron, 20}, {Shape::tetrahedron, 35},
    {Shape::hexahedron, 27}, {Shape::prism, 18},       {Shape::quadrilateral, 9}};

TEST(Solution, TablesHaveAnyOrderOfColumnsAndSeparator)
{
  const Directory directory;
  const mesh::ImportedMesh mesh = box({Shape::tetrahedron, 10});
  std::vector<std::string> columns = solid_columns;
  std::mt19937 random(3);
  for (const std::string separator : {",", ";", "\t", " , ", "  "})
  {
    std::ranges::shuffle(columns, random);
    const auto file = directory.write("theirs.csv", testing_mesh::csv(mesh, columns, separator)).path;
    const ImportedSolution solution = read_solution(file, {});
    expect_field(solution, mesh.nodes.size());
    EXPECT_TRUE(solution.mesh.cells.empty());
    EXPECT_EQ(solution.mesh.node_numbers[0], 3);
    EXPECT_EQ(solution.notes.size(), 0U);
  }
}

TEST(Solution, ATableMayBePlaneAndHaveHoles)
{
  const Directory directory;
  const auto file =
      directory
          .write("theirs.csv",
                 "\xef\xbb\xbf\"X\",Y,vx,vy,p,txx,tyy,txy\r\n0,1,2,3,9,4,5,6 # a\r\n\r\n1,1,,3,9,4,nan,6\r\n")
          .path;
  const ImportedSolution solution = read_solution(file, {.field = "v", .stress = "t"});
  EXPECT_EQ(solution.mesh.nodes[0], Point<3>(0, 1, 0));
  EXPECT_EQ(solution.displacement[0], Point<3>(2, 3, 0));
  EXPECT_EQ(solution.stress[0], (std::array<double, 6>{4, 5, 0, 6, 0, 0}));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(std::isnan(solution.displacement[1][i]));
  for (const double value : solution.stress[1]) EXPECT_TRUE(std::isnan(value));
  EXPECT_THAT(solution.notes,
              testing::ElementsAre(testing::HasSubstr("theirs.csv: left out are the columns \"p\"")));
}

TEST(Solution, AHeaderMayBeAComment)
{
  const Directory directory;
  const auto file =
      directory.write("a.csv", "# by x and y of NumPy\n# x y ux uy\n0e0 1e0 2e0 3e0\n1 1 4 5\n").path;
  EXPECT_EQ(read_solution(file, {}).displacement.at(1), Point<3>(4, 5, 0));
}

TEST(Solution, TablesThatAreRefused)
{
  const Directory directory;
  const auto refuse = [&](const std::string& text, std::initializer_list<std::string> parts)
  { expect_input_error([&] { return read_solution(directory.write("a.csv", text).path, {}); }, parts); };
  refuse("", {"a.csv: has no rows", "x,y,z,ux,uy,uz"});
  refuse("0,1,2,3\n", {"a.csv:1", "there is no header"});
  refuse("x,y,ux\n", {"no column \"uy\"", "the file has x, y, ux", "in 2D x,y,ux,uy"});
  refuse("x,y,ux,uy,uz\n", {"no column \"z\""});
  refuse("x,y,z,ux,uy,uz,sxx\n", {"the stress has no column syy, szz, sxy, syz, sxz", "or none"});
  refuse("x,y,x,ux,uy\n", {"column \"x\" stands there twice"});
  refuse("x,y,ux,uy\n", {"has a header and no rows"});
  refuse("x,y,ux,uy\n0,0,1\n", {"a.csv:2", "3 fields, the header 4"});
  refuse("x;y;ux;uy\n0;0,5;1;1\n", {"a.csv:2", "column \"y\" has \"0,5\"", "decimal point"});
  refuse("x,y,ux,uy\n0,,1,1\n", {"a.csv:2", "no finite coordinates"});
  expect_input_error([&] { return read_solution(directory.write("a.csv", "x").path, {.step = 1}); },
                     {"has no steps to choose from"});
}

TEST(Solution, PointsOfVtkHaveVectorsAndTensors)
{
  const Directory directory;
  for (const mesh::ElementType& type : types_of_vtk)
  {
    const mesh::ImportedMesh mesh = box(type);
    const ImportedSolution solution =
        read_solution(directory.write("theirs.vtu", testing_mesh::vtu(mesh)).path, {});
    if (mesh::table_of(type.shape).dim == 3) expect_field(solution, mesh.nodes.size());
    EXPECT_EQ(solution.description, "VTK's point array \"u\", stress \"sigma\", " + mesh::describe(type));
  }
}

/// Two parts with a cell each, as of a parallel run: the second also has that of the first as a ghost.
TEST(Solution, PointsOfPartsKeepTheirValues)
{
  using testing_mesh::vtk_array;
  const Directory directory;
  const auto part = [&](const std::string& name, const std::string& x, const std::string& ids,
                        const std::string& u, const std::string& nodes, const std::string& ghosts)
  {
    const bool has_two = nodes.size() > 5;
    const std::string text = fmt::format(
                                 "<VTKFile type=\"UnstructuredGrid\" version=\"2.2\"><UnstructuredGrid>"
                                 "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\"><Points>",
                                 has_two ? 4 : 3, has_two ? 2 : 1) +
                             vtk_array("Points", 3, x) + "</Points><Cells>" +
                             vtk_array("connectivity", 1, nodes, "Int64") +
                             vtk_array("offsets", 1, has_two ? "3 6" : "3", "Int64") +
                             vtk_array("types", 1, has_two ? "69 69" : "69", "Int8") + "</Cells><CellData>" +
                             vtk_array("vtkGhostType", 1, ghosts, "UInt8") + "</CellData><PointData>" +
                             vtk_array("vtkOriginalPointIds", 1, ids, "Int64") + vtk_array("u", 3, u) +
                             "</PointData></Piece></UnstructuredGrid></VTKFile>";
    (void)directory.write(name, text);
  };
  part("p0.vtu", "0 0 0 1 0 0 0 1 0", "0 1 2", "0 0 0 1 0 0 2 0 0", "0 1 2", "0");
  part("p1.vtu", "1 1 0 0 1 0 1 0 0 0 0 0", "3 2 1 0", "3 0 0 2 0 0 1 0 0 0 0 0", "0 1 2 3 2 1", "0 1");
  const auto file =
      directory
          .write("u.pvtu",
                 "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid><Piece Source=\"p0.vtu\"/>"
                 "<Piece Source=\"p1.vtu\"/></PUnstructuredGrid></VTKFile>")
          .path;
  const ImportedSolution solution = read_solution(file, {});
  ASSERT_EQ(solution.mesh.nodes.size(), 4U);
  EXPECT_EQ(solution.mesh.cells[0].size(), 2U);
  for (std::size_t v = 0; v < 4; ++v)
  {
    const Point<3>& x = solution.mesh.nodes[v];
    EXPECT_EQ(solution.displacement[v], Point<3>(x[0] + 2 * x[1], 0, 0));
  }
  EXPECT_THAT(solution.notes, testing::Contains(testing::HasSubstr("1 ghost cells are left out")));
}

TEST(Solution, ArraysMayBeAppendedAsBytes)
{
  const Directory directory;
  const mesh::ImportedMesh mesh = box({Shape::tetrahedron, 10});
  std::string text = testing_mesh::vtu(mesh);
  std::string appended = "<AppendedData encoding=\"raw\">_";
  const std::size_t first = appended.size();
  const auto append = [&](const std::string& name, int n, const auto& values_at)
  {
    const std::string head = fmt::format("Name=\"{}\" NumberOfComponents=\"{}\" format=", name, n);
    const std::size_t begin = text.find(head) + head.size();
    const std::size_t end = text.find("</DataArray>", begin);
    text.replace(begin, end - begin, fmt::format("\"appended\" offset=\"{}\">", appended.size() - first));
    std::vector<double> values;
    for (const Point<3>& x : mesh.nodes)
      for (const double value : values_at(x)) values.push_back(value);
    const std::uint64_t n_bytes = values.size() * sizeof(double);
    appended.append(reinterpret_cast<const char*>(&n_bytes), sizeof(n_bytes));
    appended.append(reinterpret_cast<const char*>(values.data()), n_bytes);
  };
  append("u", 3, testing_mesh::displacement_at);
  append("sigma", 9, testing_mesh::tensor_at);
  const std::string version = "version=\"2.2\"";
  text.replace(text.find(version), version.size(),
               version + " byte_order=\"LittleEndian\" header_type=\"UInt64\"");
  text.insert(text.find("</VTKFile>"), appended + "</AppendedData>");
  expect_field(read_solution(directory.write("a.vtu", text).path, {}), mesh.nodes.size());
}

/// One triangle with the arrays.
std::string triangle(const std::string& arrays)
{
  using testing_mesh::vtk_array;
  return "<VTKFile type=\"UnstructuredGrid\" version=\"2.2\"><UnstructuredGrid>"
         "<Piece NumberOfPoints=\"3\" NumberOfCells=\"1\"><Points>" +
         vtk_array("Points", 3, "0 0 0 1 0 0 0 1 0") + "</Points><Cells>" +
         vtk_array("connectivity", 1, "0 1 2", "Int64") + vtk_array("offsets", 1, "3", "Int64") +
         vtk_array("types", 1, "5", "UInt8") + "</Cells><PointData>" + arrays +
         "</PointData></Piece></UnstructuredGrid></VTKFile>";
}

TEST(Solution, StressesHaveSeveralOrders)
{
  const Directory directory;
  const std::string u = testing_mesh::vtk_array("reslin__DEPL", 2, "1 2 3 4 5 6");
  const auto first = [&](int n, const std::string& values, std::size_t n_notes)
  {
    const std::string text = triangle(u + testing_mesh::vtk_array("SIGM_NOEU", n, values));
    const ImportedSolution solution = read_solution(directory.write("a.vtu", text).path, {});
    EXPECT_EQ(solution.displacement[1], Point<3>(3, 4, 0));
    EXPECT_EQ(solution.notes.size(), n_notes);
    return solution.stress.at(0);
  };
  using Stress = std::array<double, 6>;
  EXPECT_EQ(first(3, "1 2 3 0 0 0 0 0 0", 0), (Stress{1, 2, 0, 3, 0, 0}));
  EXPECT_EQ(first(4, "1 2 3 4 0 0 0 0 0 0 0 0", 1), (Stress{1, 2, 3, 4, 0, 0}));
  EXPECT_EQ(first(4, "1 2 2 4 0 0 0 0 0 0 0 0", 1), (Stress{1, 4, 0, 2, 0, 0}));
  EXPECT_EQ(first(6, "1 2 3 4 5 6 0 0 0 0 0 0 0 0 0 0 0 0", 0), (Stress{1, 2, 3, 4, 5, 6}));
  const std::string zeros = " 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0";
  EXPECT_EQ(first(9, "1 2 3 2 4 5 3 5 6" + zeros, 0), (Stress{1, 4, 6, 2, 5, 3}));
  EXPECT_EQ(first(9, "1 2 3 4 4 5 3 5 6" + zeros, 1), (Stress{1, 4, 6, 3, 5, 3}));
}

/// Of code_aster: a force of contact beside the displacement, xz before yz.
TEST(Solution, ComponentsMayHaveNames)
{
  const Directory directory;
  std::string text = triangle(testing_mesh::vtk_array("DEPL", 4, "1 2 9 3 4 5 9 6 7 8 nan 9") +
                              testing_mesh::vtk_array("SIEF_NOEU", 6, "1 2 3 4 5 6 1 2 3 4 5 6 1 2 3 4 5 6"));
  const auto name_components = [&](const std::string& array, const std::vector<std::string>& names)
  {
    const std::size_t place = text.find(fmt::format("Name=\"{}\"", array));
    for (std::size_t i = 0; i < names.size(); ++i)
      text.insert(place, fmt::format("ComponentName{}=\"{}\" ", i, names[i]));
  };
  name_components("DEPL", {"DX", "DY", "LAGS_C", "DZ"});
  name_components("SIEF_NOEU", {"SIXX", "SIYY", "SIZZ", "SIXY", "SIXZ", "SIYZ"});
  const ImportedSolution solution = read_solution(directory.write("a.vtu", text).path, {});
  EXPECT_EQ(solution.displacement.at(2), Point<3>(7, 8, 9));
  EXPECT_EQ(solution.stress.at(2), (std::array<double, 6>{1, 2, 3, 4, 6, 5}));
}

TEST(Solution, ArraysAreNamedWhereNoneIsUsual)
{
  const Directory directory;
  const std::string arrays =
      testing_mesh::vtk_array("v", 3, "1 2 3 4 5 6 7 8 inf") + testing_mesh::vtk_array("T", 1, "1 2 3");
  const auto file = directory.write("a.vtu", triangle(arrays)).path;
  expect_input_error(
      [&] { return read_solution(file, {}); },
      {"a.vtu", "the file has the point arrays \"v\" (3 components), \"T\" (1 components)", "--field"});
  expect_input_error([&] { return read_solution(file, {.field = "T"}); }, {"\"T\" has 1 components"});
  expect_input_error([&] { return read_solution(file, {.field = "w"}); }, {"no displacement \"w\""});
  expect_input_error([&] { return read_solution(file, {.field = "v", .stress = "T"}); },
                     {"\"T\" has 1 components, and cannot be a stress"});
  const ImportedSolution solution = read_solution(file, {.field = "v"});
  EXPECT_TRUE(solution.stress.empty());
  EXPECT_EQ(solution.displacement[1], Point<3>(4, 5, 6));
  EXPECT_TRUE(std::isnan(solution.displacement[2][0]));
}

TEST(Solution, OtherFilesAreRefused)
{
  const Directory directory;
  expect_input_error([&] { return read_solution(directory / "none.vtu", {}); }, {"the file does not exist"});
  expect_input_error([&] { return read_solution(directory.write("a.odb", "x").path, {}); },
                     {"the format \".odb\" are not read", ".frd"});
}

/// A solution or a message, for texts that are damaged at random.
TEST(Solution, DamagedFilesGiveMessages)
{
  const Directory directory;
  const mesh::ImportedMesh mesh = box({Shape::tetrahedron, 10});
  const std::string gmsh = testing_mesh::msh(mesh, true) + testing_mesh::gmsh_nodal_data(mesh);
  std::mt19937 random(11);
  for (const auto& [name, text, n] :
       {std::tuple{"a.csv", testing_mesh::csv(mesh, solid_columns, ","), 700},
        std::tuple{"a.vtu", testing_mesh::vtu(mesh), 600}, std::tuple{"a.frd", testing_mesh::frd(mesh), 600},
        std::tuple{"a.msh", gmsh, 100}})
  {
    int n_read = 0;
    for (int i = 0; i < n; ++i)
    {
      const auto file = directory.write(name, test::damaged(text, random)).path;
      try
      {
        const ImportedSolution solution = read_solution(file, {});
        EXPECT_EQ(solution.displacement.size(), solution.mesh.nodes.size());
        ++n_read;
      }
      catch (const InputError& error)
      {
        EXPECT_NE(error.problem(), "");
        EXPECT_NE(error.where().file, "");
      }
    }
    EXPECT_GT(n_read, n / 20) << name;
    EXPECT_LT(n_read, n - n / 20) << name;
  }
}

}  // namespace

}  // namespace tribound
