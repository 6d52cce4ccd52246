/// Meshes from decks for Abaqus and CalculiX: types, sets, surfaces, parts, includes, and what is refused.

#include "tribound/mesh/import/inp.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmsh.h>

#include <filesystem>
#include <random>

#include "support/damaged.h"
#include "tribound/mesh/quadratic_facets.h"
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

std::string inp_type(const mesh::ElementType& type)
{
  if (type == mesh::ElementType{mesh::Shape::prism, 18}) return "C3D15V";
  return fmt::format("{}{}", mesh::table_of(type.shape).dim == 2 ? "CPE" : "C3D", type.n_nodes);
}

/// Meshes a geometry and writes the mesh, as Gmsh does.
void write_by_gmsh(const std::filesystem::path& geometry, const std::filesystem::path& to)
{
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::open(geometry.string());
  gmsh::model::mesh::generate(3);
  gmsh::write(to.string());
  gmsh::finalize();
}

/// The cells of a mesh in lines of 8 numbers, nodes and elements numbered with gaps.
std::string nodes_and_elements(const mesh::ImportedMesh& mesh)
{
  std::string text = "*Heading\n anything, *at all\n** made by a test\n*Node, nset=Nall\n";
  for (std::size_t v = 0; v < mesh.nodes.size(); ++v)
    text +=
        fmt::format("{:5}, {}, {}, {}\n", 10 * v + 7, mesh.nodes[v][0], mesh.nodes[v][1], mesh.nodes[v][2]);
  text += fmt::format("*Element, type={}, elset=Eall\n", inp_type(mesh.cells[0].type));
  for (std::size_t e = 0; e < mesh.cells[0].size(); ++e)
  {
    text += fmt::format("{}", 100 + e);
    int n = 1;
    for (const Index node : mesh.cells[0].element(e))
      text += fmt::format(",{} {}", n++ % 8 == 0 ? "\n" : "", 10 * node + 7);
    text += "\n";
  }
  return text;
}

std::string set_lines(std::span<const Index> members, int factor, int offset)
{
  std::string text;
  for (const Index i : members) text += fmt::format("{},\n", factor * i + offset);
  return text;
}

template <class Mesh>
double measure_of(const Mesh& mesh, const std::string& name)
{
  const auto names = mesh.boundary_names();
  return boundary_measure(mesh, static_cast<int>(std::ranges::find(names, name) - names.begin()));
}

class ImportFromInp : public testing::TestWithParam<mesh::ElementType>
{
};

/// Regions by *SOLID SECTION, the bottom by faces of elements, the top by its nodes.
TEST_P(ImportFromInp, OfThisTypeIsRead)
{
  const mesh::ElementType type = GetParam();
  const int dim = mesh::table_of(type.shape).dim;
  std::mt19937 random(13);
  mesh::ImportedMesh box = ImportedBox(type, {3, 2, 2}, random).take();
  std::string text = nodes_and_elements(box);
  for (const mesh::CellSet& set : box.cell_sets)
    text += fmt::format("*ELSET, ELSET={}\n{}", set.name, set_lines(set.cells, 1, 100));
  text += "*SOLID SECTION, MATERIAL=m, ELSET=left\n1.,\n*Solid  Section, elset=RIGHT, material=m\n";
  text += "*NSET, NSET=top\n" + set_lines(box.node_sets[0].nodes, 10, 7) + "*SURFACE, NAME=bottom\n";
  const std::vector<char> all(box.nodes.size(), 1);
  for (const mesh::CellFace& face : mesh::CellFaces(box.cells, all).outer())
  {
    const mesh::FaceNodes facet = mesh::nodes_of(box.cells, face);
    if (std::ranges::all_of(facet.span(), [&](Index v) { return box.nodes[v][dim - 1] == 0; }))
      text += fmt::format("{}, S{}\n", 100 + face.element, face.face + 1);
  }
  text += "*STEP\n*STATIC\n1., 1.\n*BOUNDARY\ntop, 1, 3\n*END STEP\n";
  const Directory directory;
  std::vector<std::string> notes;
  const mesh::AnyMesh any = mesh::read_mesh(directory.write("box.inp", text), {}, nullptr, &notes);
  EXPECT_THAT(notes, testing::ElementsAre(testing::HasSubstr("have all nodes of a body: Nall")));
  std::visit(
      [&]<int d>(const mesh::Mesh<d>& mesh)
      {
        EXPECT_EQ(d, dim);
        EXPECT_NEAR(volume(mesh), d == 2 ? 6 : 12, 1e-12);
        EXPECT_THAT(mesh.region_names(), testing::ElementsAre("left", "right"));
        EXPECT_THAT(mesh.boundary_names(), testing::ElementsAre("bottom", "top"));
        EXPECT_NEAR(measure_of(mesh, "bottom"), d == 2 ? 3 : 6, 1e-12);
        EXPECT_NEAR(measure_of(mesh, "top"), d == 2 ? 3 : 6, 1e-12);
        const mesh::QuadraticFacets& shape = *mesh.labels().quadratic_facets;
        const auto n_tagged =
            std::ranges::count_if(mesh.boundary(), [](const auto& facet) { return facet.tag >= 0; });
        EXPECT_EQ(std::ssize(shape.tags), mesh::has_middles(type) ? n_tagged : 0);
        for (int tag = 0; tag < 2; ++tag) EXPECT_EQ(mesh::sagitta<d>(shape, tag), 0);
      },
      any);
}

INSTANTIATE_TEST_SUITE_P(Inp, ImportFromInp, testing::ValuesIn(cell_types),
                         [](const auto& info) {
                           return std::string(mesh::table_of(info.param.shape).name) +
                                  std::to_string(info.param.n_nodes);
                         });

/// Two cubes on top of each other, nodes 1 to 12 in layers, elements 1 and 2.
const std::string two_cubes =
    "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n9,0,0,2\n10,1,0,2\n11,1,"
    "1,2\n"
    "12,0,1,2\n*ELEMENT, TYPE=C3D8R\n1, 1,2,3,4,5,6,7,8\n2, 5,6,7,8,9,10,11,12\n";

mesh::ImportedMesh read(const std::filesystem::path& deck)
{
  std::vector<std::string> notes;
  return mesh::read_inp(deck, false, notes);
}

mesh::Mesh<3> solid(const Directory& directory, const std::string& text,
                    std::vector<std::string>* notes = nullptr)
{
  return std::get<mesh::Mesh<3>>(mesh::read_mesh(directory.write("deck.inp", text), {}, nullptr, notes));
}

TEST(Inp, WithoutSetsEverythingIsOneRegion)
{
  const Directory directory;
  const mesh::Mesh<3> mesh = solid(directory, two_cubes);
  EXPECT_THAT(mesh.region_names(), testing::ElementsAre("domain"));
  EXPECT_NEAR(volume(mesh), 2, 1e-14);
}

TEST(Inp, LineEndsTabsContinuationsAndFortranNumbersAreRead)
{
  const Directory directory;
  const std::string text =
      "*NODE\r\n1,\t0.D0 , +0, 0\r\n 2, 1d+0, 0., 0.\r\n3, 1.0E0 ,1,0\r\n4,0,10.D-1\r\n5,0,0,1,\r\n"
      "\r\n** c\r\n*ELEMENT,\r\nTYPE=C3D5 ,\r\n ELSET = \"my body\"\r\n1, 1,\r\n2,3\r\n4, "
      "5\r\n*ELSET,ELSET=\xc3\xbcnten\r\n1\r\n"
      "*SURFACE, NAME=b, TYPE=ELEMENT\r\n\xc3\xbcnten , s1";
  const mesh::Mesh<3> mesh = solid(directory, text);
  EXPECT_THAT(mesh.region_names(), testing::ElementsAre("my body"));
  EXPECT_NEAR(volume(mesh), 1. / 3, 1e-14);
  EXPECT_NEAR(measure_of(mesh, "b"), 1, 1e-14);
}

TEST(Inp, SetsMayBeGeneratedAndContainSets)
{
  const Directory directory;
  const mesh::Mesh<3> mesh =
      solid(directory,
            two_cubes +
                "*NSET, NSET=low, GENERATE\n1, 3, 2\n*NSET,NSET=bottom\nLOW, 2, 4\n*NSET,NSET=edge\n1,2\n"
                "*NSET,NSET=bottom "
                "too\n1,2,3,4\n*ELSET,ELSET=lower\n1\n*ELSET,ELSET=upper,GENERATE\n2,1000000000000000,1\n"
                "*SURFACE,TYPE=NODE,NAME=top\n9\n10,\n11\n12\n");
  EXPECT_THAT(mesh.region_names(), testing::ElementsAre("lower", "upper"));
  EXPECT_THAT(mesh.boundary_names(), testing::UnorderedElementsAre("bottom", "top"));
  EXPECT_NEAR(measure_of(mesh, "bottom"), 1, 1e-14);
  EXPECT_NEAR(measure_of(mesh, "top"), 1, 1e-14);
}

TEST(Inp, NodeSetsThatAreNoBoundariesAreListed)
{
  const Directory directory;
  std::vector<std::string> notes;
  (void)solid(directory,
              two_cubes +
                  "*NSET,NSET=edge\n1,2\n*NSET,NSET=a\n1,2,3,4\n*NSET,NSET=b\n1,2,3,4\n"
                  "*NODE,NSET=ref\n99,5,5,5\n",
              &notes);
  EXPECT_THAT(notes,
              testing::ElementsAre(
                  testing::HasSubstr("have no outer facet all of whose nodes are in the set: edge, ref"),
                  testing::HasSubstr("have the facets of another boundary: b (as a)"),
                  testing::HasSubstr("1 of 13 nodes belong to no element")));
}

/// The second instance is turned by 90 degrees about the z axis and moved before that.
TEST(Inp, InstancesAreMovedAndTurned)
{
  const Directory directory;
  const std::string part =
      "*PART, NAME=cube\n" + two_cubes +
      "*ELSET,ELSET=all,GENERATE\n1,2\n*SOLID SECTION,ELSET=all\n*NSET,NSET=bottom\n1,2,3,4\n"
      "*ELSET,ELSET=second\n2\n*END PART\n";
  const mesh::Mesh<3> mesh = solid(
      directory, part +
                     "*ASSEMBLY, NAME=a\n*INSTANCE, NAME=one, PART=cube\n*END INSTANCE\n"
                     "*INSTANCE, NAME=two, PART=CUBE\n3,0,0\n0,0,0, 0,0,1, 90\n*END INSTANCE\n"
                     "*NSET,NSET=top,INSTANCE=one\n9,10,11,12\n*NSET,NSET=top,INSTANCE=Two\n9,10,11,12\n"
                     "*SURFACE,NAME=lid\none.second, S4\n*END ASSEMBLY\n");
  EXPECT_THAT(mesh.region_names(), testing::ElementsAre("one.all", "two.all"));
  EXPECT_THAT(mesh.boundary_names(), testing::UnorderedElementsAre("one.bottom", "two.bottom", "lid", "top"));
  EXPECT_NEAR(volume(mesh), 4, 1e-14);
}

TEST(Inp, InstancesAreMovedBeforeTheyAreTurned)
{
  const Directory directory;
  const mesh::ImportedMesh mesh =
      read(directory
               .write("deck.inp", "*PART,NAME=p\n" + two_cubes +
                                      "*END PART\n*INSTANCE,NAME=i,PART=p\n3,0,0\n"
                                      "1,0,0, 1,0,1, 90\n*END INSTANCE\n")
               .path);
  // (1, 0, 0) -> (4, 0, 0) -> about (1, 0): (1, 3, 0)
  EXPECT_LT((mesh.nodes[1] - Point<3>(1, 3, 0)).norm(), 1e-14);
}

TEST(Inp, IncludedFilesAreReadWhereTheyStand)
{
  const Directory directory;
  std::filesystem::create_directory(directory / "sub");
  (void)directory.write("sub/nodes.inp",
                        two_cubes.substr(6, two_cubes.find("*ELEMENT") - 6) + "*INCLUDE, INPUT=more.inp\n");
  (void)directory.write("sub/more.inp", two_cubes.substr(two_cubes.find("*ELEMENT")));
  const mesh::Mesh<3> mesh =
      solid(directory, "*NODE\n*INCLUDE, INPUT=sub/nodes.inp\n*NSET,NSET=bottom\n1,2,3,4\n");
  EXPECT_NEAR(volume(mesh), 2, 1e-14);
  EXPECT_NEAR(measure_of(mesh, "bottom"), 1, 1e-14);
}

/// As Gmsh, unical and Salome write surfaces.
TEST(Inp, ShellsOnFacesOfSolidsAreBoundaries)
{
  const Directory directory;
  const std::string shells =
      "*ELEMENT,TYPE=CPS4,ELSET=Surface1\n11, 4,3,2,1\n*ELEMENT,TYPE=S3,ELSET=Surface2\n";
  const mesh::Mesh<3> mesh = solid(directory, two_cubes + "*ELSET,ELSET=body\n1,2\n" + shells);
  EXPECT_THAT(mesh.region_names(), testing::ElementsAre("body"));
  EXPECT_THAT(mesh.boundary_names(), testing::ElementsAre("Surface1"));
  EXPECT_NEAR(measure_of(mesh, "Surface1"), 1, 1e-14);
  const mesh::Mesh<3> named =
      solid(directory, two_cubes + shells + "*ELSET,ELSET=floor\n11\n*ELSET,ELSET=body\n1,2\n");
  EXPECT_THAT(named.boundary_names(), testing::ElementsAre("floor"));
  const std::string both =
      directory
          .write("deck.inp",
                 two_cubes + "*ELEMENT,TYPE=S4,ELSET=skin\n11, 4,3,2,1\n*SHELL SECTION,ELSET=skin\n")
          .path;
  expect_input_error([&] { (void)read(both); }, {"deck.inp:19: element 11 is in a *SHELL SECTION"});
}

/// Springs with a spare comma, a shell beside the solids, a surface on it, a section of a skin.
TEST(Inp, ElementsWithoutCounterpartAreLeftOutIfAsked)
{
  const Directory directory;
  const std::string deck =
      two_cubes +
      "*NODE\n13,3,0,0\n14,4,0,0\n15,4,1,0\n*ELEMENT,TYPE=SPRINGA,ELSET=springs\n21, 9,\n13\n22, 10,13\n"
      "*ELEMENT,TYPE=S3,ELSET=fin\n31, 13,14,15\n*ELEMENT,TYPE=S4,ELSET=skin\n11, 4,3,2,1\n"
      "*SHELL SECTION,ELSET=fin\n*SURFACE,NAME=top\n2, S2\n*SURFACE,NAME=of_fin\nfin, S1\n"
      "*ELSET,ELSET=body\n1,2\n";
  mesh::MeshFile file = directory.write("deck.inp", deck);
  expect_input_error([&] { (void)mesh::read_mesh(file); }, {"deck.inp:", "element 21 is of type SPRINGA",
                                                            "ignore_elements = true leaves them out"});
  file.options.ignore_elements = true;
  std::vector<std::string> notes;
  const auto mesh = std::get<mesh::Mesh<3>>(mesh::read_mesh(file, {}, nullptr, &notes));
  EXPECT_THAT(mesh.boundary_names(), testing::UnorderedElementsAre("skin", "top"));
  EXPECT_NEAR(measure_of(mesh, "skin"), 1, 1e-14);
  EXPECT_NEAR(measure_of(mesh, "top"), 1, 1e-14);
  EXPECT_NEAR(volume(mesh), 2, 1e-14);
  EXPECT_THAT(notes, testing::Contains(testing::HasSubstr(
                         "elements left out: 1 of type S3 (such as 31), 2 of type SPRINGA (such as 21)")));
}

TEST(Inp, ChosenSetsAreTheBoundaries)
{
  const Directory directory;
  mesh::MeshFile file =
      directory.write("deck.inp", two_cubes +
                                      "*SURFACE,NAME=side\n1, S3\n2, S3\n*SURFACE,NAME=lower\n1, S3\n"
                                      "*NSET,NSET=base\n1,2,3,4\n*NSET,NSET=inner\n5,6,7,8\n");
  expect_input_error([&] { (void)mesh::read_mesh(file); }, {"is also in group"});
  file.options.boundaries = {"lower", "base"};
  const auto mesh = std::get<mesh::Mesh<3>>(mesh::read_mesh(file));
  EXPECT_THAT(mesh.boundary_names(), testing::ElementsAre("lower", "base"));
  file.options.boundaries = {"lower", "bse"};
  expect_input_error([&] { (void)mesh::read_mesh(file); },
                     {"there is no set \"bse\" for a boundary", "the sets are side, lower, base, inner"});
  file.options.boundaries = {"inner"};
  expect_input_error([&] { (void)mesh::read_mesh(file); }, {"\"inner\" has no facet"});
}

/// Two cubes of one region with double nodes between them, not quite in one place.
TEST(Inp, CoincidentNodesOfARegionAreMergedIfAsked)
{
  const Directory directory;
  const std::string cubes =
      "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
      "15,0,0,1.0001\n16,1,0,1\n17,1,1,1\n18,0,1,1\n9,0,0,2\n10,1,0,2\n11,1,1,2\n12,0,1,2\n"
      "*ELEMENT, TYPE=C3D8\n1, 1,2,3,4,5,6,7,8\n2, 15,16,17,18,9,10,11,12\n";
  mesh::MeshFile file = directory.write("deck.inp", cubes + "*NSET,NSET=base\n1,2,3,4\n");
  file.options.merge = 1e-3;
  std::vector<std::string> notes;
  const auto mesh = std::get<mesh::Mesh<3>>(mesh::read_mesh(file, {}, nullptr, &notes));
  EXPECT_EQ(mesh.n_vertices(), 12);
  EXPECT_NEAR(volume(mesh), 2, 1e-3);
  EXPECT_NEAR(measure_of(mesh, "base"), 1, 1e-14);
  EXPECT_THAT(notes, testing::Contains(testing::HasSubstr("4 nodes are merged with others")));
  file.options.merge = 1.1;
  expect_input_error([&] { (void)mesh::read_mesh(file); },
                     {"merge = 1.1 makes one node of two of element 1 (hexahedron of 8 nodes)"});

  mesh::MeshFile two = directory.write("two.inp", cubes + "*ELSET,ELSET=a\n1\n*ELSET,ELSET=b\n2\n");
  two.options.merge = 1e-3;
  EXPECT_EQ(mesh::read_imported(two, nullptr, 1, notes).nodes.size(), 16U) << "regions stay apart";
}

TEST(Inp, PlaneStressAndAxisymmetryAreNoted)
{
  const Directory directory;
  const auto notes_of = [&](const std::string& type)
  {
    std::vector<std::string> notes;
    (void)mesh::read_mesh(
        directory.write("deck.inp", "*NODE\n1,0,0\n2,1,0\n3,0,1\n*ELEMENT,TYPE=" + type + "\n1, 1,2,3\n"), {},
        nullptr, &notes);
    return notes;
  };
  EXPECT_TRUE(notes_of("CPE3").empty());
  EXPECT_THAT(notes_of("CPS3"), testing::ElementsAre(testing::HasSubstr("plane = \"stress\"")));
  EXPECT_THAT(notes_of("CAX3"),
              testing::ElementsAre(testing::HasSubstr(
                  "axisymmetric elements (CAX3), a case says so by model = \"axisymmetric\"")));
}

TEST(Inp, AxisymmetricElementsAreMeridians)
{
  const Directory directory;
  const mesh::MeshFile file = directory.write(
      "deck.inp",
      "*NODE\n1,1,0\n2,3,0\n3,3,1\n4,1,1\n5,2,0\n6,3,.5\n7,2,1\n8,1,.5\n9,4,0\n11,3.5,.5\n12,3.5,0\n"
      "*ELEMENT,TYPE=CAX8R\n1, 1,2,3,4,5,6,7,8\n*ELEMENT,TYPE=CAX6M\n2, 2,9,3,12,11,6\n");
  const mesh::Mesh<2> mesh = std::get<mesh::Mesh<2>>(mesh::read_mesh(file));
  EXPECT_NEAR(volume(mesh), 2.5, 1e-14);
}

TEST(Inp, IncludedFilesAreKnown)
{
  const Directory directory;
  const mesh::MeshFile file = directory.write("deck.inp", "*INCLUDE, INPUT=a.inp\n*NODE, INPUT=b.inp\n");
  (void)directory.write("a.inp", "*AMPLITUDE, INPUT=nowhere.inp\n");
  (void)directory.write("b.inp", "1, 0, 0, 0\n");
  EXPECT_THAT(mesh::with_included(file.path),
              testing::ElementsAre(file.path, directory / "a.inp", directory / "b.inp"));
  EXPECT_THAT(mesh::with_included(directory / "gone.inp"), testing::ElementsAre(directory / "gone.inp"));
}

/// By Gmsh's own writer, of which only the names of sets and the order of nodes are its own choice.
TEST(Inp, DecksOfGmshHaveItsGroups)
{
  const Directory directory;
  for (const int order : {1, 2})
  {
    const mesh::MeshFile geo = directory.write(
        "part.geo", fmt::format("SetFactory(\"OpenCASCADE\"); Cylinder(1) = {{0, 0, 0, 0, 0, 2, 1}};\n"
                                "Mesh.MeshSizeMax = 0.6; Mesh.ElementOrder = {};\n"
                                "Physical Volume(\"body\") = {{1}}; Physical Surface(\"round\") = {{1}};\n"
                                "Physical Surface(\"lid\") = {{2}};\n",
                                order));
    const auto deck = directory / "part.inp";
    write_by_gmsh(geo.path, deck);
    const auto expected = std::get<mesh::Mesh<3>>(mesh::read_mesh(geo));
    const auto mesh = std::get<mesh::Mesh<3>>(mesh::read_mesh(mesh::MeshFile{deck}));
    EXPECT_EQ(mesh.n_cells(), expected.n_cells());
    EXPECT_NEAR(volume(mesh), volume(expected), 1e-9);
    for (const std::string name : {"round", "lid"})
      EXPECT_NEAR(measure_of(mesh, name), measure_of(expected, name), 1e-9);
    const auto& shape = *mesh.labels().quadratic_facets;
    EXPECT_EQ(shape.tags.size(), expected.labels().quadratic_facets->tags.size());
  }
}

/// The order of the nodes as Gmsh's writer has it, of prisms and hexahedra.
TEST(Inp, MiddlesOfGmshsSolidsAreWhereTheyBelong)
{
  const Directory directory;
  for (const std::string recombine : {"", "Recombine Surface{1};"})
  {
    const mesh::MeshFile geo = directory.write(
        "part.geo",
        "Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 1, 0}; Point(4) = {0, 1, 0};\n"
        "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\n"
        "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1}; Mesh.MeshSizeMax = 0.5; "
        "Mesh.SecondOrderIncomplete = 1;\n" +
            recombine +
            "out[] = Extrude {0, 0, 1} { Surface{1}; Layers{2}; Recombine; };\n"
            "Physical Volume(\"body\") = {1}; Physical Surface(\"base\") = {1}; Mesh.ElementOrder = 2;\n");
    const auto deck = directory / "part.inp";
    write_by_gmsh(geo.path, deck);
    const mesh::ImportedMesh mesh = read(deck);
    EXPECT_EQ(mesh.cells.at(0).type.n_nodes, recombine.empty() ? 15 : 20);
    EXPECT_EQ(testing_mesh::misplaced_nodes(mesh), "");
  }
}

struct BadDeck
{
  std::string name;
  std::string text;
  std::vector<std::string> words;
};

void PrintTo(const BadDeck& bad, std::ostream* out)
{
  *out << bad.name;
}

class BadInp : public testing::TestWithParam<BadDeck>
{
};

TEST_P(BadInp, IsRefused)
{
  const Directory directory;
  const mesh::MeshFile file = directory.write("deck.inp", GetParam().text);
  const std::string message = testing_mesh::message_of([&] { (void)mesh::read_mesh(file); });
  for (const std::string& word : GetParam().words) EXPECT_THAT(message, testing::HasSubstr(word));
}

INSTANTIATE_TEST_SUITE_P(
    Inp, BadInp,
    testing::ValuesIn(std::vector<BadDeck>{
        {"NoMesh", "hello\n", {"deck.inp: the mesh has neither plane elements nor solids"}},
        {"NodeMissing",
         "*NODE\n1,0,0,0\n*ELEMENT,TYPE=C3D4\n5,1,2,3,4\n",
         {"deck.inp:4: node 2 of element 5 is not defined"}},
        {"NodeTwice", two_cubes + "*NODE\n3,1,2,3\n", {"deck.inp:18: node 3 is defined twice"}},
        {"ElementTwice",
         two_cubes + "*ELEMENT,TYPE=C3D4\n2,1,2,3,5\n",
         {"deck.inp:18: element 2 is defined twice"}},
        {"CutOff",
         two_cubes.substr(0, two_cubes.size() - 4),
         {"deck.inp:16: element 2 (C3D8R) has only 7 of its 8 nodes"}},
        {"TooManyNodes",
         two_cubes + "*ELEMENT,TYPE=C3D4\n3,1,2,3,4,5\n",
         {"element 3 (C3D4) has more than 4 nodes"}},
        {"NoNumber", "*NODE\n1,0,x,0\n", {"deck.inp:2: \"x\" is not a number"}},
        {"NoInteger", "*NODE\n1.5,0,0,0\n", {"deck.inp:2: \"1.5\" is not an integer"}},
        {"Infinite", "*NODE\n1,inf,0,0\n", {"deck.inp:2: \"inf\" is not a number"}},
        {"HugeNumber",
         "*NODE\n99999999999999999999,0,0,0\n",
         {"deck.inp:2: \"99999999999999999999\" is not an integer"}},
        {"Beam",
         two_cubes + "*ELEMENT,TYPE=B31\n7,1,2\n",
         {"deck.inp:18: element 7 is of type B31, which is not read", "C3D20"}},
        {"Torsion", "*NODE\n1,0,0\n*ELEMENT,TYPE=CGAX4\n7,1,1,1,1\n", {"element 7 is of type CGAX4"}},
        {"Shell",
         two_cubes + "*ELEMENT,TYPE=S3\n7,1,2,11\n",
         {"deck.inp:18: element 7 (S3) is a shell: it is not a face of a cell"}},
        {"Truss", two_cubes + "*ELEMENT,TYPE=T3D2\n7,1,2\n", {"deck.inp:18: element 7 (T3D2) is a truss"}},
        {"Generators", two_cubes + "*NGEN\n1,5,1\n", {"deck.inp:17: *NGEN is not read"}},
        {"Cylindrical", "*NODE,SYSTEM=C\n1,0,0\n", {"cylindrical", "Cartesian"}},
        {"UnknownSet",
         two_cubes + "*SURFACE,NAME=s\nbody,S1\n",
         {"deck.inp:18: there is no set \"body\" so far"}},
        {"UnknownFace", two_cubes + "*SURFACE,NAME=s\n1,S7\n", {"deck.inp:18: \"S7\" is not a face"}},
        {"NoSuchFace",
         "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n*SURFACE,NAME=s\n1,S5\n",
         {"deck.inp:9: element 1 (C3D4) has no face S5"}},
        {"EmptySurface", two_cubes + "*SURFACE,NAME=s\n", {"deck.inp:17: surface \"s\" is empty"}},
        {"NodesOfNoFacet", two_cubes + "*SURFACE,NAME=s,TYPE=NODE\n1\n2\n", {"\"s\" has no facet"}},
        {"FaceInside", two_cubes + "*SURFACE,NAME=s\n1,S2\n", {"of group \"s\" lies inside the domain"}},
        {"TwoBoundaries",
         two_cubes + "*SURFACE,NAME=s\n1,S1\n*SURFACE,NAME=t\n1,S1\n1,S3\n",
         {"is also in group \"s\""}},
        {"OneNameTwoSets",
         two_cubes + "*SURFACE,NAME=s\n1,S1\n*NSET,NSET=s\n9,10,11,12\n",
         {"two sets of different facets have the name \"s\""}},
        {"RegionsOverlap",
         two_cubes + "*ELSET,ELSET=a\n1,2\n*ELSET,ELSET=b\n2\n*ELSET,ELSET=c\n2\n*ELEMENT,TYPE=C3D5\n3,9,10,"
                     "11,12,1\n",
         {"do not say which region", "element 2 is in \"a\" and in \"b\"", "*SOLID SECTION"}},
        {"MemberMissing", two_cubes + "*ELSET,ELSET=a\n1,2,3\n", {"deck.inp:17: element 3 is not defined"}},
        {"PartWithoutInstance",
         "*PART,NAME=p\n" + two_cubes + "*END PART\n",
         {"deck.inp:1: part \"p\" has no instance"}},
        {"PartWithoutEnd", "*PART,NAME=p\n" + two_cubes, {"deck.inp:1: part \"p\" has no *END PART"}},
        {"InstanceOfNothing",
         "*INSTANCE,NAME=i,PART=p\n",
         {"instance \"i\" of part \"P\", which is not defined here"}},
        {"InstanceWithNodes",
         "*PART,NAME=p\n" + two_cubes + "*END PART\n*INSTANCE,NAME=i,PART=p\n*NODE\n1,0,0,0\n",
         {"*NODE inside an instance"}},
        {"IncludesItself", "*INCLUDE, INPUT=deck.inp\n", {"deck.inp:1: the file", "includes itself"}},
        {"IncludesNothing",
         "*NODE\n*INCLUDE, INPUT=nowhere.inp\n",
         {"deck.inp:2: the file", "nowhere.inp\" does not exist"}},
        {"NotUtf8",
         two_cubes + "*NSET,NSET=\xfcnten\n1\n",
         {"deck.inp:17: a name has bytes that are not UTF-8"}},
        {"Flat",
         "*NODE\n1,0,0,0\n2,1,0,1\n3,0,1,0\n*ELEMENT,TYPE=CPS3\n1,1,2,3\n",
         {"node 2 at (1, 0, 1) is not in the plane z = 0"}},
        {"Inverted",
         "*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n*ELEMENT,TYPE=CPS3\n8,1,2,3\n9,1,4,3\n",
         {"element 9 (triangle of 3 nodes)", "is inverted"}},
    }),
    [](const auto& info) { return info.param.name; });

/// Bytes changed, lines lost, repeated and exchanged, the end cut off: a mesh or a message.
TEST(Inp, DamagedDecksEndInAMessage)
{
  const Directory directory;
  std::mt19937 random(17);
  const std::string sound =
      "*PART,NAME=p\n" + two_cubes +
      "*NSET,NSET=low,GENERATE\n1,4,1\n*ELSET,ELSET=a\n1\n*ELSET,ELSET=b\n2,\n*SURFACE,NAME=s\na,S1\n*END "
      "PART\n"
      "*INSTANCE,NAME=i,PART=p\n1,2,3\n0,0,0,1,0,0,30\n*END INSTANCE\n*NSET,NSET=t,INSTANCE=i\n9,10,11,12\n"
      "*INCLUDE,INPUT=deck.inp\n*SURFACE,NAME=u\ni.b,S2\n";
  int n_read = 0;
  for (int k = 0; k < 3000; ++k)
  {
    std::string text = sound;
    if (k % 2 == 0) text.erase(text.find("*INCLUDE"), 24);
    const mesh::MeshFile file = directory.write("deck.inp", test::damaged(text, random));
    if (testing_mesh::gives_mesh_or_message(file)) ++n_read;
  }
  EXPECT_GT(n_read, 300);
}

TEST(Inp, ManySetsAndHugeRangesTakeNoTime)
{
  const Directory directory;
  std::string text = two_cubes + "*ELSET,ELSET=all\n1,2\n";
  for (int k = 0; k < 200000; ++k)
    text += fmt::format("*NSET,NSET=n{},GENERATE\n1,2000000000000000,{}\n", k, 1 + k % 7);
  std::vector<std::string> notes;
  const mesh::Mesh<3> mesh = solid(directory, text, &notes);
  EXPECT_NEAR(volume(mesh), 2, 1e-14);
  EXPECT_LT(notes.at(0).size(), 300U);
}

}  // namespace

}  // namespace tribound
