/// Collections of ParaView: a file for each time. Steps of other formats: solution_programs_test.cpp and
/// solution_med_test.cpp.

#include <fmt/format.h>

#include <random>

#include "support/damaged.h"
#include "unit/mesh/mesh_testing.h"
#include "unit/mesh/solution_files.h"

namespace tribound
{

namespace
{

using mesh::ImportedSolution;
using mesh::read_solution;
using testing_mesh::Directory;
using testing_mesh::expect_input_error;

constexpr const char* series = R"(<?xml version="1.0"?>
<VTKFile type="Collection" version="0.1"><Collection>
<DataSet timestep="0.5" part="0" file="first.vtu"/>
<DataSet timestep=" 1e0 " group="" file="last.vtu"/>
</Collection></VTKFile>
)";

mesh::ImportedMesh write_files(const Directory& directory)
{
  const mesh::ImportedMesh mesh = testing_mesh::box({mesh::Shape::tetrahedron, 10});
  (void)directory.write("first.vtu", testing_mesh::vtu(testing_mesh::box({mesh::Shape::tetrahedron, 4})));
  (void)directory.write("last.vtu", testing_mesh::vtu(mesh));
  return mesh;
}

TEST(SolutionSeries, HasAFileForEachTime)
{
  const Directory directory;
  const mesh::ImportedMesh mesh = write_files(directory);
  const auto file = directory.write("theirs.pvd", series).path;
  const ImportedSolution last = read_solution(file, {});
  testing_mesh::expect_field(last, mesh.nodes.size());
  testing_mesh::expect_steps(last, {{1, 0.5}, {2, 1}});
  EXPECT_TRUE(last.description.ends_with("tetrahedron of 10 nodes, step 2 (t = 1) of theirs.pvd"));
  EXPECT_TRUE(read_solution(file, {.step = 1}).description.find("tetrahedron of 4 nodes, step 1 (t = 0.5)") !=
              std::string::npos);
  testing_mesh::expect_steps(read_solution(directory / "last.vtu", {}), {});
}

TEST(SolutionSeries, FaultsAreNamed)
{
  const Directory directory;
  (void)write_files(directory);
  const auto refuse =
      [&](const std::string& from, const std::string& to, std::initializer_list<std::string> parts, int step)
  {
    std::string text = series;
    text.replace(text.find(from), from.size(), to);
    expect_input_error([&] { return read_solution(directory.write("a.pvd", text).path, {.step = step}); },
                       parts);
  };
  refuse("0.5", "0.5", {"a.pvd: has no step 3", "its steps are 1 to 2"}, 3);
  refuse("0.5", "0.5", {"a.pvd: has no step 0"}, 0);
  refuse("0.5", "1", {"has several files for t = 1", ".pvtu joins parts"}, 1);
  refuse("0.5", "half", {"the timestep \"half\"", "a number"}, 1);
  refuse("0.5", "nan", {"the timestep \"nan\""}, 1);
  refuse("first.vtu", "a.pvd", {"with the file \"a.pvd\"", ".vtu, .pvtu or .vtk"}, 1);
  refuse("first.vtu", "none.vtu", {"none.vtu"}, 1);
  refuse("</Collection>", "", {"is no XML", "cut off"}, 1);
  expect_input_error([&] { return read_solution(directory.write("a.pvd", "<VTKFile/>").path, {}); },
                     {"no <DataSet> in a <Collection>"});
}

TEST(SolutionSeries, DamagedFilesGiveMessages)
{
  const Directory directory;
  (void)write_files(directory);
  std::mt19937 random(5);
  for (int i = 0; i < 300; ++i) try
    {
      const auto file = directory.write("a.pvd", test::damaged(series, random)).path;
      const ImportedSolution solution = read_solution(file, {});
      EXPECT_FALSE(solution.steps.empty());
    }
    catch (const InputError& error)
    {
      EXPECT_NE(error.problem(), "");
      EXPECT_NE(error.where().file, "");
    }
}

}  // namespace

}  // namespace tribound
