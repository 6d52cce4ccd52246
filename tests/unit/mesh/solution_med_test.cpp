/// Fields of .med: names of components, times, profiles, what is refused; damaged files.

#include <fstream>
#include <iterator>
#include <random>

#include "support/damaged.h"
#include "unit/mesh/med_files.h"
#include "unit/mesh/mesh_testing.h"
#include "unit/mesh/solution_files.h"

namespace tribound
{

namespace
{

using mesh::ImportedSolution;
using mesh::read_solution;
using testing_mesh::Directory;
using testing_mesh::displacement_at;
using testing_mesh::expect_input_error;
using testing_mesh::MedFile;
using testing_mesh::stress_at;

/// A field with the components `names`; at(node, component) of the nodes from `first` on, as one profile.
template <class At>
void write_field(const MedFile& file, const std::string& name, const std::vector<std::string>& names,
                 int step, const std::string& profile, std::size_t first, std::size_t end, const At& at)
{
  const std::string field = "/CHA/" + name;
  const std::string time = fmt::format("{}/{:020}{:020}", field, step, 1);
  std::vector<double> values;
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t v = first; v < end; ++v) values.push_back(at(v, i));
  file.array(time + "/NOE/" + profile + "/CO", H5T_NATIVE_DOUBLE, values.size(), values.data());
  if (first == 0)
  {
    file.attribute(time, "NDT", step);
    file.attribute(time, "PDT", 0.25 * step);
  }
  if (step > 1) return;
  std::string padded;
  for (const std::string& component : names) padded += fmt::format("{:16}", component);
  file.attribute(field, "NOM", padded);
  file.attribute(field, "NCO", static_cast<int>(names.size()));
}

/// As code_aster writes it: step 1 twice the displacement, and forces of contact; step 2 on two profiles.
mesh::ImportedMesh write_solution(const std::filesystem::path& path)
{
  const mesh::ImportedMesh mesh = testing_mesh::box({mesh::Shape::tetrahedron, 10});
  testing_mesh::write_med(path, mesh, {});
  const MedFile file(path, H5F_ACC_RDWR);
  const std::size_t n = mesh.nodes.size();
  const std::vector<std::string> names = {"DX", "DY", "DZ", "LAGS_C"};
  const auto u = [&](std::size_t v, std::size_t i) { return i < 3 ? displacement_at(mesh.nodes[v])[i] : 77; };
  write_field(file, "reslin__DEPL", names, 1, "MED_NO_PROFILE_INTERNAL", 0, n,
              [&](std::size_t v, std::size_t i) { return 2 * u(v, i); });
  write_field(file, "reslin__DEPL", names, 2, "first", 0, 10, u);
  write_field(file, "reslin__DEPL", names, 2, "others", 10, n, u);
  std::vector<int> first;
  std::vector<int> others;
  for (std::size_t v = 0; v < n; ++v) (v < 10 ? first : others).push_back(static_cast<int>(v) + 1);
  file.integers("/PROFILS/first/PFL", first);
  file.integers("/PROFILS/others/PFL", others);
  const std::array<std::size_t, 6> places = {0, 1, 2, 3, 5, 4};
  for (const int step : {1, 2})
    write_field(file, "reslin__SIEF_NOEU", {"SIXX", "SIYY", "SIZZ", "SIXY", "SIXZ", "SIYZ"}, step,
                "MED_NO_PROFILE_INTERNAL", 0, n,
                [&](std::size_t v, std::size_t i) { return stress_at(mesh.nodes[v])[places[i]]; });
  return mesh;
}

TEST(SolutionOfMed, FieldsHaveNamesTimesAndProfiles)
{
  const Directory directory;
  const mesh::ImportedMesh mesh = write_solution(directory / "theirs.med");
  const ImportedSolution solution = read_solution(directory / "theirs.med", {});
  testing_mesh::expect_field(solution, mesh.nodes.size());
  EXPECT_EQ(solution.description,
            "MED field \"reslin__DEPL\", step 2, stress \"reslin__SIEF_NOEU\", tetrahedron of 10 nodes");
  testing_mesh::expect_steps(solution, {{1, 0.25}, {2, 0.5}});
  const ImportedSolution first = read_solution(directory / "theirs.med", {.step = 1});
  for (std::size_t v = 0; v < mesh.nodes.size(); ++v)
    EXPECT_LT((first.displacement[v] - 2 * displacement_at(mesh.nodes[v])).norm(), 1e-12);
}

TEST(SolutionOfMed, FieldsThatAreRefused)
{
  const Directory directory;
  (void)write_solution(directory / "a.med");
  const auto refuse = [&](const mesh::SolutionChoice& choice, std::initializer_list<std::string> parts)
  { expect_input_error([&] { return read_solution(directory / "a.med", choice); }, parts); };
  refuse({.step = 3}, {"a.med", "field \"reslin__DEPL\" has no step 3"});
  refuse({.field = "u"}, {"the file has the fields of nodes \"reslin__DEPL\" (4 components)"});
  refuse({.field = "reslin__SIEF_NOEU"}, {"has 6 components, and cannot be a displacement"});
  testing_mesh::write_med(directory / "a.med", testing_mesh::box({mesh::Shape::triangle, 3}), {});
  refuse({}, {"the file has no fields of nodes"});
  {
    const MedFile file(directory / "a.med", H5F_ACC_RDWR);
    write_field(file, "DEPL", {"DX", "DY"}, 1, "MED_NO_PROFILE_INTERNAL", 0, 3,
                [](std::size_t, std::size_t) { return 1; });
  }
  refuse({}, {"field \"DEPL\" has 6 numbers for 2 components of 6 nodes"});
}

TEST(SolutionOfMed, DamagedFilesGiveMessages)
{
  const Directory directory;
  (void)write_solution(directory / "whole.med");
  std::ifstream stream(directory / "whole.med", std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  std::mt19937 random(17);
  for (int i = 0; i < 100; ++i)
  {
    const auto file = directory.write("a.med", test::damaged(text, random)).path;
    try
    {
      const ImportedSolution solution = read_solution(file, {});
      EXPECT_EQ(solution.displacement.size(), solution.mesh.nodes.size());
    }
    catch (const InputError& error)
    {
      EXPECT_NE(error.problem(), "");
      EXPECT_NE(error.where().file, "");
    }
  }
}

}  // namespace

}  // namespace tribound
