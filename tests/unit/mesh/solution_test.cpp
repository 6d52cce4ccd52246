/// Solutions of other programs: the same field in all formats, choices, what is refused, damaged files.

#include "tribound/mesh/import/imported_solution.h"

#include <cstdlib>
#include <random>

#include "support/damaged.h"
#include "unit/mesh/imported_testing.h"
#include "unit/mesh/mesh_testing.h"
#include "unit/mesh/solution_files.h"

namespace tribound
{

namespace
{

using mesh::ImportedSolution;
using mesh::read_solution;
using mesh::Shape;
using testing_mesh::Directory;
using testing_mesh::displacement_at;
using testing_mesh::expect_input_error;
using testing_mesh::ImportedBox;
using testing_mesh::stress_at;

mesh::ImportedMesh box(const mesh::ElementType& type)
{
  std::mt19937 random(7);
  return ImportedBox(type, {2, 1, 1}, random).take();
}

const std::vector<std::string> solid_columns = {"x",   "y",   "z",   "ux",  "uy",  "uz",
                                                "sxx", "syy", "szz", "sxy", "syz", "sxz"};

double stress_error(const std::array<double, 6>& stress, const Point<3>& x)
{
  double largest = 0;
  for (std::size_t i = 0; i < stress.size(); ++i)
    largest = std::max(largest, std::abs(stress[i] - stress_at(x)[i]));
  return largest;
}

/// Every value belongs to its node; with `digits` as many of them as the file has.
void expect_field(const ImportedSolution& solution, std::size_t n_nodes, double tolerance = 1e-12)
{
  ASSERT_EQ(solution.mesh.nodes.size(), n_nodes);
  ASSERT_EQ(solution.displacement.size(), n_nodes);
  for (std::size_t v = 0; v < n_nodes; ++v)
    EXPECT_LT((solution.displacement[v] - displacement_at(solution.mesh.nodes[v])).norm(), tolerance);
  if (!solution.stress_of_elements)
  {
    ASSERT_EQ(solution.stress.size(), n_nodes);
    for (std::size_t v = 0; v < n_nodes; ++v)
      EXPECT_LT(stress_error(solution.stress[v], solution.mesh.nodes[v]), 1e5 * tolerance);
  }
  EXPECT_EQ(testing_mesh::misplaced_nodes(solution.mesh), "");
}

const std::vector<mesh::ElementType> types_of_vtk = {
    {Shape::triangle, 3},    {Shape::triangle, 6}, {Shape::tetrahedron, 4},  {Shape::tetrahedron, 10},
    {Shape::hexahedron, 27}, {Shape::prism, 18},   {Shape::quadrilateral, 9}};

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

TEST(Solution, ViewsOfGmshAreOfNodesOrOfElements)
{
  const Directory directory;
  for (const mesh::ElementType& type : testing_mesh::cell_types)
  {
    const mesh::ImportedMesh mesh = box(type);
    const bool is_new = type.n_nodes % 2 == 0;
    const std::string text = testing_mesh::msh(mesh, is_new);
    const auto nodal = directory.write("nodes.msh", text + testing_mesh::gmsh_nodal_data(mesh)).path;
    expect_field(read_solution(nodal, {}), mesh.nodes.size());
    const ImportedSolution first = read_solution(nodal, {.step = 0});
    EXPECT_LT((first.displacement[0] - 2 * displacement_at(first.mesh.nodes[0])).norm(), 1e-12);
    EXPECT_TRUE(first.stress.empty());

    const auto of_elements = directory.write("a.msh", text + testing_mesh::gmsh_data_of_elements(mesh)).path;
    const ImportedSolution solution = read_solution(of_elements, {});
    expect_field(solution, mesh.nodes.size());
    ASSERT_TRUE(solution.stress_of_elements);
    const std::vector<Index>& nodes = solution.mesh.cells[0].nodes;
    ASSERT_EQ(solution.stress.size(), nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i)
      EXPECT_LT(stress_error(solution.stress[i], solution.mesh.nodes[nodes[i]]), 1e-12);
  }
}

TEST(Solution, ViewsThatAreRefused)
{
  const Directory directory;
  const mesh::ImportedMesh mesh = box({Shape::quadrilateral, 4});
  const std::string text = testing_mesh::msh(mesh, false);
  const auto refuse = [&](const std::string& data, const mesh::SolutionChoice& choice,
                          std::initializer_list<std::string> parts)
  {
    expect_input_error([&] { return read_solution(directory.write("a.msh", text + data).path, choice); },
                       parts);
  };
  using testing_mesh::gmsh_data;
  refuse("", {}, {"a.msh", "the file has no views"});
  refuse(gmsh_data("ElementData", "u", 0, 3, {"1 1 2 3"}), {}, {"constant in each element"});
  refuse(gmsh_data("NodeData", "u", 0, 3, {"1 1 2 3"}), {.step = 4}, {"no step 4", "its steps are 0 to 0"});
  refuse(gmsh_data("NodeData", "u", 0, 3, {"99 1 2 3"}), {}, {"has node 99, which the mesh does not have"});
  refuse(
      gmsh_data("ElementNodeData", "u", 0, 3, {"1 4 1 1 1 1 1 1 1 1 1 1 1 1", "2 4 2 2 2 2 2 2 2 2 2 2 2 2"}),
      {}, {"has 1 and 2 in elements that share node"});
  const auto constant = directory
                            .write("a.msh", text + gmsh_data("NodeData", "u", 0, 3, {"1 1 2 3"}) +
                                                gmsh_data("ElementData", "s", 0, 9, {"1 1 2 3 2 4 5 3 5 6"}))
                            .path;
  const ImportedSolution solution = read_solution(constant, {});
  EXPECT_THAT(solution.notes, testing::Contains(testing::HasSubstr("\"s\" is constant in each element")));
  EXPECT_EQ(solution.stress.at(3), (std::array<double, 6>{1, 4, 6, 2, 5, 3}));
  EXPECT_TRUE(std::isnan(solution.stress.at(4)[0]));
  EXPECT_TRUE(std::isnan(solution.displacement.at(1)[0]));
}

/// Two bodies, of tetrahedra and of hexahedra.
mesh::ImportedMesh two_bodies()
{
  mesh::ImportedMesh mesh = box({Shape::tetrahedron, 10});
  const mesh::ImportedMesh other = box({Shape::hexahedron, 8});
  mesh.cells.push_back(other.cells[0]);
  for (Index& v : mesh.cells[1].nodes) v += static_cast<Index>(mesh.nodes.size());
  for (const Point<3>& x : other.nodes) mesh.nodes.push_back(x + Point<3>(3, 0, 0));
  return mesh;
}

TEST(Solution, CalculixHasStepsAndBlocks)
{
  const Directory directory;
  const double six_digits = 2e-7;
  const mesh::ImportedMesh mesh = two_bodies();
  const auto file = directory.write("theirs.frd", testing_mesh::frd(mesh)).path;
  const ImportedSolution solution = read_solution(file, {});
  expect_field(solution, mesh.nodes.size(), six_digits);
  EXPECT_EQ(solution.description, "CalculiX results, step 2 (t = 2), C3D10, C3D8");
  const ImportedSolution first = read_solution(file, {.step = 1});
  for (std::size_t v = 0; v < mesh.nodes.size(); ++v)
    EXPECT_LT((first.displacement[v] - 2 * displacement_at(first.mesh.nodes[v])).norm(), six_digits);
  for (const mesh::ElementType& type : testing_mesh::cell_types)
  {
    const bool has_centres = type.n_nodes == 9 || type.n_nodes == 27 || type.n_nodes == 18;
    if (has_centres || type.shape == Shape::pyramid) continue;
    const mesh::ImportedMesh one = box(type);
    expect_field(read_solution(directory.write("one.frd", testing_mesh::frd(one)).path, {}), one.nodes.size(),
                 six_digits);
  }
}

TEST(Solution, ResultsOfCalculixThatAreRefused)
{
  const Directory directory;
  const std::string good = testing_mesh::frd(two_bodies());
  const auto refuse = [&](const std::string& from, const std::string& to, const mesh::SolutionChoice& choice,
                          std::initializer_list<std::string> parts)
  {
    std::string text = good;
    if (!from.empty()) text.replace(text.find(from), from.size(), to);
    expect_input_error([&] { return read_solution(directory.write("a.frd", text).path, choice); }, parts);
  };
  refuse("", "", {.step = 3}, {"a.frd", "no DISP of step 3: the file has DISP (step 1), STRESS (step 1)"});
  refuse("", "", {.field = "STRESS"}, {"STRESS has 6 components, not 3"});
  refuse("", "", {.stress = "MISES"}, {"no MISES in increment 2"});
  refuse("    6    0    1\n", "    9    0    1\n", {}, {"is a shell"});
  refuse("    6    0    1\n", "   11    0    1\n", {}, {"element 1 is a beam"});
  refuse("    6    0    1\n", "   77    0    1\n", {}, {"element 1 is of type 77"});
  refuse(" 9999", "    2C                             1                                     1", {},
         {"the file has a second mesh"});
  const std::size_t end = good.find('\n', good.find("    2C"));
  refuse(good.substr(end - 2, 3), " 2\n", {}, {"a.frd:3", "the file is binary", "*NODE FILE"});
  const std::string cut = good.substr(0, good.size() - 200);
  expect_input_error([&] { return read_solution(directory.write("cut.frd", cut).path, {}); },
                     {"the file ends in the values of STRESS"});
}

TEST(Solution, OtherFilesAreRefused)
{
  const Directory directory;
  expect_input_error([&] { return read_solution(directory / "none.vtu", {}); }, {"the file does not exist"});
  expect_input_error([&] { return read_solution(directory.write("a.odb", "x").path, {}); },
                     {"the format \".odb\" are not read", ".frd"});
  expect_input_error([&] { return read_solution(directory.write("a.med", "x").path, {}); },
                     {"the fields of a .med are not read", ".vtu"});
}

/// The orders of nodes, steps and components by the program itself: every node is displaced linearly.
TEST(Solution, CalculixItself)
{
  if (std::system("command -v ccx > /dev/null") != 0) GTEST_SKIP() << "ccx is not installed (calculix-ccx)";
  const Directory directory;
  for (const auto& [type, name] : {std::pair{mesh::ElementType{Shape::hexahedron, 20}, "C3D20"},
                                   std::pair{mesh::ElementType{Shape::prism, 15}, "C3D15"},
                                   std::pair{mesh::ElementType{Shape::tetrahedron, 10}, "C3D10"}})
  {
    const mesh::ImportedMesh mesh = box(type);
    std::string deck = "*NODE, NSET=N\n";
    std::string displaced;
    const Eigen::Matrix3d gradient{{1e-3, 2e-3, 0}, {0, 3e-3, 0}, {0, -4e-3, 5e-3}};
    for (std::size_t v = 0; v < mesh.nodes.size(); ++v)
    {
      const Point<3> x = mesh.nodes[v];
      const Point<3> u = gradient * x;
      deck += fmt::format("{},{},{},{}\n", v + 1, x[0], x[1], x[2]);
      for (int i = 0; i < 3; ++i) displaced += fmt::format("{},{},{},{:.8f}\n", v + 1, i + 1, i + 1, u[i]);
    }
    deck += fmt::format("*ELEMENT, TYPE={}, ELSET=E", name);
    for (std::size_t e = 0; e < mesh.cells[0].size(); ++e)
    {
      deck += fmt::format("\n{}", e + 1);
      for (int i = 0; i < type.n_nodes; ++i)
        deck += (i == 10 ? ",\n" : ",") + std::to_string(mesh.cells[0].element(e)[i] + 1);
    }
    deck += "\n*MATERIAL, NAME=M\n*ELASTIC\n1000,0\n*SOLID SECTION, ELSET=E, MATERIAL=M\n";
    const std::string output = "*NODE FILE\nU\n*EL FILE\nS\n*END STEP\n";
    deck +=
        "*STEP\n*STATIC\n*BOUNDARY\nN,1,3,0\n" + output + "*STEP\n*STATIC\n*BOUNDARY\n" + displaced + output;
    const auto job = directory.write("job.inp", deck).path.replace_extension();
    ASSERT_EQ(std::system(fmt::format("ccx {} > {}.log 2>&1", job.string(), job.string()).c_str()), 0);
    const ImportedSolution solution = read_solution(job.string() + ".frd", {});
    EXPECT_EQ(solution.description, fmt::format("CalculiX results, step 2 (t = 2), {}", name));
    EXPECT_EQ(testing_mesh::misplaced_nodes(solution.mesh), "");
    ASSERT_EQ(solution.stress.size(), mesh.nodes.size());
    const std::array<double, 6> stress = {1, 3, 5, 1, -2, 0};
    for (std::size_t v = 0; v < mesh.nodes.size(); ++v)
    {
      EXPECT_LT((solution.displacement[v] - gradient * solution.mesh.nodes[v]).norm(), 1e-7);
      for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(solution.stress[v][i], stress[i], 1e-3);  // ccx extrapolates with four digits
    }
    EXPECT_EQ(read_solution(job.string() + ".frd", {.step = 1}).displacement[0], Point<3>::Zero());
  }
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
