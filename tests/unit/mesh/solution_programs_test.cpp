/// Solutions of Gmsh and CalculiX: orders of nodes, steps, what is refused; CalculiX itself.

#include <cstdlib>

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
using testing_mesh::displacement_at;
using testing_mesh::expect_field;
using testing_mesh::expect_input_error;
using testing_mesh::stress_error;

TEST(SolutionOfPrograms, ViewsOfGmshAreOfNodesOrOfElements)
{
  const Directory directory;
  for (const mesh::ElementType& type : testing_mesh::all_cell_types)
  {
#ifdef __SANITIZE_ADDRESS__  // Gmsh 4.8 deletes an array of prisms as if it were one object
    if (type.shape == Shape::prism) continue;
#endif
    const mesh::ImportedMesh mesh = box(type);
    const bool is_new = type.n_nodes % 2 == 0;
    const std::string text = testing_mesh::msh(mesh, is_new);
    const auto nodal = directory.write("nodes.msh", text + testing_mesh::gmsh_nodal_data(mesh)).path;
    expect_field(read_solution(nodal, {}), mesh.nodes.size());
    const ImportedSolution first = read_solution(nodal, {.step = 0});
    EXPECT_LT((first.displacement[0] - 2 * displacement_at(first.mesh.nodes[0])).norm(), 1e-12);
    EXPECT_TRUE(first.stress.empty());
    testing_mesh::expect_steps(first, {{0, 0.5}, {1, 1.5}});

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

TEST(SolutionOfPrograms, ViewsThatAreRefused)
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

TEST(SolutionOfPrograms, CalculixHasStepsAndBlocks)
{
  const Directory directory;
  const double six_digits = 2e-7;
  const mesh::ImportedMesh mesh = two_bodies();
  const auto file = directory.write("theirs.frd", testing_mesh::frd(mesh)).path;
  const ImportedSolution solution = read_solution(file, {});
  expect_field(solution, mesh.nodes.size(), six_digits);
  EXPECT_EQ(solution.description, "CalculiX results, step 2 (t = 2), C3D10, C3D8");
  testing_mesh::expect_steps(solution, {{1, 1}, {2, 2}});
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

TEST(SolutionOfPrograms, ResultsOfCalculixThatAreRefused)
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
  refuse("", "", {.step = 3}, {"a.frd", "no DISP of step 3: the file has DISP, STRESS, in steps 1 to 2"});
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

/// The orders of nodes, steps and components by the program itself: every node is displaced linearly.
TEST(SolutionOfPrograms, CalculixItself)
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

}  // namespace

}  // namespace tribound
