/// CAD, surfaces of triangles and other programs' meshes through Gmsh: names, units, sizes, what is refused.

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <numbers>
#include <regex>

#include "tribound/mesh/import/read.h"
#include "tribound/mesh/import/survey.h"
#include "tribound/mesh/quadratic_facets.h"
#include "unit/mesh/mesh_testing.h"

namespace tribound
{

namespace
{

using testing_mesh::Directory;
using testing_mesh::expect_input_error;
using testing_mesh::volume;

/// Lets Gmsh make a model and write files of it.
void with_gmsh(const std::function<void()>& work)
{
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  work();
  gmsh::finalize();
}

/// A cylinder of radius 1 and height 2, and a cube beside it that touches it from above.
void write_cylinder_and_cube(const std::filesystem::path& file)
{
  with_gmsh(
      [&]
      {
        gmsh::model::occ::addCylinder(0, 0, 0, 0, 0, 2, 1);
        gmsh::model::occ::addBox(-0.5, -0.5, 2, 1, 1, 1);
        gmsh::model::occ::synchronize();
        gmsh::write(file.string());
      });
}

/// Into the present model.
void add_cubes_with_a_common_face()
{
  gmsh::model::occ::addBox(0, 0, 0, 1, 1, 1);
  gmsh::model::occ::addBox(0, 0, 1, 1, 1, 1);
  std::vector<std::pair<int, int>> parts;
  std::vector<std::vector<std::pair<int, int>>> map;
  gmsh::model::occ::fragment({{3, 1}}, {{3, 2}}, parts, map);
  gmsh::model::occ::synchronize();
}

mesh::Survey survey_of(const mesh::MeshFile& file, std::vector<std::string>* notes = nullptr)
{
  std::vector<std::string> said;
  mesh::Survey found =
      survey(mesh::make_simplicial(mesh::read_imported(file, nullptr, mesh::default_patience, said)));
  if (notes) *notes = said;
  return found;
}

std::string text_of(const std::filesystem::path& file)
{
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Cad, SolidsAreRegionsAndFacesBoundaries)
{
  const Directory directory;
  for (const std::string suffix : {".step", ".brep"})
  {
    mesh::MeshFile file{directory / ("part" + suffix), {}};
    write_cylinder_and_cube(file.path);
    file.options.size = 0.4;
    std::vector<std::string> notes;
    const mesh::Survey found = survey_of(file, &notes);
    EXPECT_THAT(notes, testing::IsEmpty());
    EXPECT_EQ(found.n_bodies, 2U) << "solids that touch stay apart";
    ASSERT_EQ(found.regions.size(), 2U);
    EXPECT_EQ(found.boundaries.size(), 9U);
    EXPECT_EQ(std::ranges::count(found.boundaries, true, &mesh::SurveyedGroup::is_inside), 0);
    EXPECT_NEAR(found.regions[0].measure, 2 * std::numbers::pi, 0.15);
    EXPECT_NEAR(found.regions[1].measure, 1, 1e-9);
    if (suffix == ".brep")
    {
      EXPECT_EQ(found.regions[0].name, "solid1");
      EXPECT_EQ(found.boundaries[0].name, "face1");
    }
  }
}

/// The middles of the edges are on the cylinder, to a few percent of the height of the straight facets over
/// it.
TEST(Cad, CurvedFacesAreTheTrueShape)
{
  const Directory directory;
  mesh::MeshFile file{directory / "part.step", {}};
  with_gmsh(
      [&]
      {
        gmsh::model::occ::addCylinder(0, 0, 0, 0, 0, 2, 1);
        gmsh::model::occ::synchronize();
        gmsh::write(file.path.string());
      });
  file.options.size = 0.5;
  std::vector<std::string> notes;
  const mesh::ImportedMesh mesh = mesh::read_imported(file, nullptr, mesh::default_patience, notes);
  double farthest = 0;
  std::size_t n = 0;
  for (const mesh::ElementBlock& block : mesh.facet_sets.at(0).facets)
    for (const Index node : block.nodes)
    {
      farthest = std::max(farthest, std::abs(mesh.nodes[node].head<2>().norm() - 1));
      ++n;
    }
  EXPECT_GT(n, 100U);
  EXPECT_LT(farthest, 1e-6);
  const auto simplicial = std::get<mesh::Mesh<3>>(mesh::read_mesh(file));
  EXPECT_NEAR(mesh::sagitta<3>(*simplicial.labels().quadratic_facets, 0), 1 - std::cos(0.25), 0.015);
}

TEST(Cad, SolidsThatShareAFaceAreOneBody)
{
  const Directory directory;
  mesh::MeshFile file{directory / "part.brep", {}};
  with_gmsh(
      [&]
      {
        add_cubes_with_a_common_face();
        gmsh::write(file.path.string());
      });
  file.options.size = 0.6;
  std::vector<std::string> notes;
  const mesh::Survey found = survey_of(file, &notes);
  EXPECT_EQ(found.n_bodies, 1U);
  EXPECT_EQ(found.regions.size(), 2U);
  EXPECT_EQ(found.boundaries.size(), 10U);
  EXPECT_THAT(notes, testing::ElementsAre(testing::HasSubstr("surfaces between two volumes")));
}

TEST(Cad, LengthsAreThoseOfTheFile)
{
  const Directory directory;
  write_cylinder_and_cube(directory / "part.step");
  const std::string text = text_of(directory / "part.step");
  for (const std::string unit : {"$", ".MILLI.", ".CENTI."})
  {
    mesh::MeshFile file = directory.write(
        "other.step", std::regex_replace(text, std::regex(R"(SI_UNIT\(\.MILLI\.,\.METRE\.\))"),
                                         fmt::format("SI_UNIT({},.METRE.)", unit == "$" ? "$$" : unit)));
    file.options.size = 0.5;
    EXPECT_NEAR(survey_of(file).regions[1].measure, 1, 1e-9) << unit;
  }
}

TEST(Cad, SolidsGoByTheNamesOfTheirParts)
{
  const Directory directory;
  write_cylinder_and_cube(directory / "part.step");
  const std::regex unnamed("Open CASCADE STEP translator [^']*\\.2");
  mesh::MeshFile file =
      directory.write("named.step", std::regex_replace(text_of(directory / "part.step"), unnamed, "cube"));
  file.options.size = 1;
  const mesh::Survey found = survey_of(file);
  EXPECT_EQ(found.regions.at(0).name, "solid1") << "what Open CASCADE calls a part without a name is none";
  EXPECT_EQ(found.regions.at(1).name, "cube");
}

TEST(Cad, WithoutASizeOneIsChosenAndSaid)
{
  const Directory directory;
  mesh::MeshFile file{directory / "part.step", {}};
  write_cylinder_and_cube(file.path);
  std::vector<std::string> notes;
  (void)survey_of(file, &notes);
  EXPECT_THAT(notes, testing::ElementsAre(testing::HasSubstr("part.step: meshed with edges of about 0.2")));
  file.options.size = 1e-3;
  file.where = {.file = "case.toml", .key = "mesh.file", .line = 3};
  expect_input_error([&] { (void)survey_of(file); }, {"case.toml:3: mesh.file: size = 0.001 makes up to",
                                                      "elements of a geometry of 2 x 2 x 3"});
}

TEST(Cad, DamagedFilesAreRefused)
{
  const Directory directory;
  write_cylinder_and_cube(directory / "part.step");
  const std::string text = text_of(directory / "part.step");
  for (const std::size_t share : {3, 5, 8})
  {
    const mesh::MeshFile cut = directory.write("cut.step", text.substr(0, text.size() * share / 10));
    const std::string message = testing_mesh::message_of([&] { (void)mesh::read_mesh(cut); });
    EXPECT_THAT(message, testing::HasSubstr("cut.step")) << share;
  }
  expect_input_error([&] { (void)mesh::read_mesh(directory.write("part.step", "solid part\n")); },
                     {"is not a .step: it does not begin with ISO-10303-21;"});
  expect_input_error([&] { (void)mesh::read_mesh(directory.write("part.jt", "x\n")); },
                     {"part.jt\" is of no format that is read", ".step"});
}

/// A cube with a hole through it, as triangles.
TEST(Cad, SurfacesOfTrianglesAreFilled)
{
  const Directory directory;
  mesh::MeshFile file{directory / "part.stl", {.file = "case.toml", .key = "mesh.file", .line = 3}};
  with_gmsh(
      [&]
      {
        gmsh::model::occ::addBox(0, 0, 0, 2, 2, 2);
        gmsh::model::occ::addBox(0.5, 0.5, -1, 1, 1, 4);
        std::vector<std::pair<int, int>> cut;
        std::vector<std::vector<std::pair<int, int>>> map;
        gmsh::model::occ::cut({{3, 1}}, {{3, 2}}, cut, map);
        gmsh::model::occ::synchronize();
        gmsh::option::setNumber("Mesh.MeshSizeMax", 0.5);
        gmsh::model::mesh::generate(2);
        gmsh::write(file.path.string());
      });
  expect_input_error([&] { (void)mesh::read_mesh(file); },
                     {"case.toml:3", "surface without a volume", "tribound mesh part.stl part.msh --size 2"});
  file.options.size = 0.6;
  const mesh::Survey found = survey_of(file);
  EXPECT_EQ(found.n_bodies, 1U);
  EXPECT_NEAR(found.regions.at(0).measure, 6, 1e-6);
  EXPECT_EQ(found.regions.at(0).name, "solid1");

  std::string text = text_of(file.path);
  text.erase(text.find("facet"), text.find("endfacet") + 9 - text.find("facet"));
  std::ofstream(file.path) << text;
  expect_input_error([&] { (void)survey_of(file); }, {"part.stl: the surface is not closed"});
}

TEST(Cad, SurfacesOfTrianglesAreOfOneBody)
{
  const Directory directory;
  const mesh::MeshFile file{directory / "parts.stl", {}, {.size = 1}};
  const auto write_boxes = [&](bool has_cavity)
  {
    with_gmsh(
        [&]
        {
          gmsh::model::occ::addBox(0, 0, 0, 3, 3, 3);
          gmsh::model::occ::addBox(has_cavity ? 1 : 4, 1, 1, 1, 1, 1);
          std::vector<std::pair<int, int>> cut;
          std::vector<std::vector<std::pair<int, int>>> map;
          if (has_cavity) gmsh::model::occ::cut({{3, 1}}, {{3, 2}}, cut, map);
          gmsh::model::occ::synchronize();
          gmsh::model::mesh::generate(2);
          gmsh::write(file.path.string());
        });
  };
  write_boxes(false);
  expect_input_error([&] { (void)survey_of(file); },
                     {"parts.stl: the surface encloses 2 bodies", "a file for each body"});
  write_boxes(true);
  EXPECT_NEAR(survey_of(file).regions.at(0).measure, 26, 1e-6);
}

/// A box of two layers with groups on top and below.
TEST(Cad, MeshesOfOtherProgramsKeepTheirNumbersOrNames)
{
  const Directory directory;
  for (const std::string suffix : {".unv", ".bdf"})
    for (const int order : {1, 2})
    {
      const mesh::MeshFile file{directory / ("part" + suffix), {}};
      with_gmsh(
          [&]
          {
            add_cubes_with_a_common_face();
            std::vector<std::pair<int, int>> base;
            gmsh::model::getEntitiesInBoundingBox(-1, -1, -0.1, 2, 2, 0.1, base, 2);
            gmsh::model::addPhysicalGroup(3, {1}, 7);
            gmsh::model::addPhysicalGroup(3, {2}, 8);
            gmsh::model::addPhysicalGroup(2, {base.at(0).second}, 9);
            gmsh::model::setPhysicalName(3, 7, "low");
            gmsh::model::setPhysicalName(3, 8, "up");
            gmsh::model::setPhysicalName(2, 9, "base");
            gmsh::option::setNumber("Mesh.MeshSizeMax", 0.6);
            gmsh::option::setNumber("Mesh.SaveElementTagType", 2);  // numbers of groups as properties
            gmsh::option::setNumber("Mesh.SaveGroupsOfElements", 1);
            gmsh::model::mesh::generate(3);
            gmsh::model::mesh::setOrder(order);
            gmsh::write(file.path.string());
          });
      const mesh::Survey found = survey_of(file);
      ASSERT_EQ(found.regions.size(), 2U) << suffix;
      EXPECT_EQ(found.n_bodies, 1U);
      EXPECT_NEAR(found.regions[0].measure, 1, 1e-6);
      EXPECT_EQ(found.regions[0].name, suffix == ".bdf" ? "7" : "low");
      ASSERT_EQ(found.boundaries.size(), 1U);
      EXPECT_NEAR(found.boundaries[0].measure, 1, 1e-6);
      EXPECT_EQ(found.boundaries[0].name, suffix == ".bdf" ? "9" : "base");
    }
}

}  // namespace

}  // namespace tribound
