/// Meshes from valid files: every version, regions and boundaries, orientation, unused nodes.

#include <gmsh.h>

#include "tribound/mesh/quadratic_facets.h"
#include "unit/mesh/mesh_testing.h"

namespace tribound
{

namespace
{

using testing_mesh::boundary_measure;
using testing_mesh::Directory;
using testing_mesh::volume;

/// Two regions side by side and four boundary groups, one with two curves; point 9 is unused.
const std::string plane_geo = R"(
Point(1) = {0, 0, 0, 0.4}; Point(2) = {1, 0, 0, 0.4}; Point(3) = {3, 0, 0, 0.4};
Point(4) = {3, 1, 0, 0.4}; Point(5) = {1, 1, 0, 0.4}; Point(6) = {0, 1, 0, 0.4}; Point(9) = {5, 5, 0, 0.4};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1};
Line(7) = {2, 5};
Curve Loop(1) = {1, 7, 5, 6}; Plane Surface(1) = {1};
Curve Loop(2) = {2, 3, 4, -7}; Plane Surface(2) = {2};
Physical Curve("foot") = {1, 2}; Physical Curve("end") = {3}; Physical Curve(17) = {4, 5};
Physical Surface("steel") = {1}; Physical Surface("rubber") = {2};
)";

const std::string solid_geo = R"(
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 2, 1, 1}; Box(2) = {2, 0, 0, 1, 1, 1}; Coherence;
Mesh.MeshSizeMax = 0.5;
Physical Volume("long") = {1}; Physical Volume("short") = {2};
Physical Surface("floor") = Surface In BoundingBox {-0.1, -0.1, -0.1, 3.1, 1.1, 0.1};
)";

/// Meshes a .geo with Gmsh itself and saves the mesh.
mesh::MeshFile saved(const Directory& directory, const std::string& geo, double version, bool binary,
                     bool all = false)
{
  const mesh::MeshFile source = directory.write("source.geo", geo);
  mesh::MeshFile result = source;
  result.path.replace_extension(".msh");
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::open(source.path.string());
  gmsh::model::mesh::generate(gmsh::model::getDimension());
  gmsh::option::setNumber("Mesh.MshFileVersion", version);
  gmsh::option::setNumber("Mesh.Binary", binary);
  gmsh::option::setNumber("Mesh.SaveAll", all);
  gmsh::write(result.path.string());
  gmsh::finalize();
  return result;
}

int position(std::span<const std::string> names, const std::string& name)
{
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

void expect_plane(const mesh::AnyMesh& any)
{
  ASSERT_TRUE(std::holds_alternative<mesh::Mesh<2>>(any));
  const auto& mesh = std::get<mesh::Mesh<2>>(any);
  EXPECT_THAT(mesh.region_names(), testing::UnorderedElementsAre("steel", "rubber"));
  EXPECT_THAT(mesh.boundary_names(), testing::UnorderedElementsAre("foot", "end", "17"));
  EXPECT_NEAR(volume(mesh), 3, 1e-12);
  const auto measure = [&](const std::string& name)
  { return boundary_measure(mesh, position(mesh.boundary_names(), name)); };
  EXPECT_NEAR(measure("foot"), 3, 1e-12);
  EXPECT_NEAR(measure("end"), 1, 1e-12);
  EXPECT_NEAR(measure("17"), 3, 1e-12);
  EXPECT_NEAR(boundary_measure(mesh, -1), 1, 1e-12);
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    const bool is_left = mesh::cell_map(mesh, c)(Point<2>::Constant(1.0 / 3))[0] < 1;
    EXPECT_EQ(mesh.region(c), position(mesh.region_names(), is_left ? "steel" : "rubber"));
  }
}

void expect_solid(const mesh::AnyMesh& any)
{
  ASSERT_TRUE(std::holds_alternative<mesh::Mesh<3>>(any));
  const auto& mesh = std::get<mesh::Mesh<3>>(any);
  EXPECT_THAT(mesh.region_names(), testing::UnorderedElementsAre("long", "short"));
  EXPECT_THAT(mesh.boundary_names(), testing::ElementsAre("floor"));
  EXPECT_NEAR(volume(mesh), 3, 1e-12);
  EXPECT_NEAR(boundary_measure(mesh, 0), 3, 1e-12);
  EXPECT_NEAR(boundary_measure(mesh, -1), 11, 1e-12);
}

/// A version of the format, binary or ASCII.
class GmshFormat : public testing::TestWithParam<std::pair<double, bool>>
{
};

TEST_P(GmshFormat, IsRead)
{
  const auto [version, binary] = GetParam();
  const Directory directory;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  if (version > 1)  // version 1 has no names
  {
    expect_plane(mesh::read_mesh(saved(directory, plane_geo, version, binary)));
    expect_solid(mesh::read_mesh(saved(directory, solid_geo, version, binary)));
    expect_plane(mesh::read_mesh(saved(directory, plane_geo + "Mesh.ElementOrder = 2;\n", version, binary)));
    expect_solid(mesh::read_mesh(saved(directory, solid_geo + "Mesh.ElementOrder = 2;\n", version, binary)));
  }
  else
  {
    const auto mesh = std::get<mesh::Mesh<2>>(mesh::read_mesh(saved(directory, plane_geo, version, binary)));
    EXPECT_NEAR(volume(mesh), 3, 1e-12);
    EXPECT_EQ(mesh.region_names().size(), 2U);
    EXPECT_THAT(mesh.boundary_names(), testing::Contains("17"));
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

INSTANTIATE_TEST_SUITE_P(Gmsh, GmshFormat,
                         testing::Values(std::pair{1.0, false}, std::pair{2.2, false}, std::pair{2.2, true},
                                         std::pair{4.0, false}, std::pair{4.1, false}, std::pair{4.1, true}),
                         [](const auto& info)
                         {
                           return "Version" + std::to_string(static_cast<int>(10 * info.param.first)) +
                                  (info.param.second ? "Binary" : "Ascii");
                         });

TEST(Gmsh, GeometriesAreMeshed)
{
  const Directory directory;
  expect_plane(mesh::read_mesh(directory.write("plane.geo", plane_geo)));
  expect_solid(mesh::read_mesh(directory.write("solid.geo", solid_geo)));
}

/// The number of second-order facets in a group; each of their nodes passes `check`.
template <int dim, class Check>
std::size_t check_nodes(const mesh::Mesh<dim>& mesh, int tag, const Check& check)
{
  const mesh::QuadraticFacets& facets = *mesh.labels().quadratic_facets;
  constexpr std::size_t n = mesh::n_facet_nodes<dim>;
  for (std::size_t f = 0; f < facets.tags.size(); ++f)
    for (std::size_t a = 0; facets.tags[f] == tag && a < n; ++a)
      check(Point<dim>(&facets.points[facets.nodes[f * n + a] * dim]));
  return std::ranges::count(facets.tags, tag);
}

template <int dim>
std::size_t n_facets(const mesh::Mesh<dim>& mesh, int tag)
{
  return std::ranges::count(mesh.boundary(), tag, &mesh::BoundaryFacet::tag);
}

/// Cells get straight sides; facets of groups keep their nodes, on the circle and on the ball.
TEST(Gmsh, OfOrderTwoTheNodesOfBoundariesAreKept)
{
  const Directory directory;
  const std::string disc =
      "SetFactory(\"OpenCASCADE\"); Disk(1) = {0, 0, 0, 1}; Mesh.MeshSizeMax = 0.4;\n"
      "Physical Surface(\"disc\") = {1}; Physical Curve(\"rim\") = {1};\n";
  const std::string ball =
      "SetFactory(\"OpenCASCADE\"); Sphere(1) = {0, 0, 0, 1}; Mesh.MeshSizeMax = 0.6;\n"
      "Physical Volume(\"ball\") = {1}; Physical Surface(\"skin\") = {1};\n";
  const auto is_on_unit_ball = [](const auto& x) { EXPECT_NEAR(x.norm(), 1, 1e-6); };
  const std::string second = "Mesh.ElementOrder = 2;\n";
  for (const mesh::MeshFile& file :
       {saved(directory, disc + second, 2.2, false), directory.write("disc.geo", disc + second)})
  {
    const auto mesh = std::get<mesh::Mesh<2>>(mesh::read_mesh(file));
    const auto straight = std::get<mesh::Mesh<2>>(mesh::read_mesh(directory.write("disc1.geo", disc)));
    EXPECT_TRUE(straight.labels().quadratic_facets->tags.empty());
    EXPECT_NEAR(volume(mesh), volume(straight), 1e-12);
    EXPECT_EQ(mesh.n_cells(), straight.n_cells());
    EXPECT_EQ(check_nodes(mesh, 0, is_on_unit_ball), n_facets(mesh, 0));
    EXPECT_GT(n_facets(mesh, 0), 10U);
  }
  const auto mesh = std::get<mesh::Mesh<3>>(mesh::read_mesh(directory.write("ball.geo", ball + second)));
  EXPECT_EQ(check_nodes(mesh, 0, is_on_unit_ball), n_facets(mesh, 0));
  EXPECT_GT(n_facets(mesh, 0), 40U);
  EXPECT_NEAR(mesh::sagitta<3>(*mesh.labels().quadratic_facets, 0), 0.05, 0.05);
}

TEST(Gmsh, AGeometryThatMeshesItselfIsNotMeshedAgain)
{
  const Directory directory;
  expect_plane(mesh::read_mesh(directory.write("plane.geo", plane_geo + "Mesh 2;\n")));
}

TEST(Gmsh, SurfacesOrientedDownAreTurned)
{
  const Directory directory;
  std::string geo = plane_geo;
  geo.replace(geo.find("{1, 7, 5, 6}"), 12, "{-6, -5, -7, -1}");
  const auto file = saved(directory, geo, 4.1, false);
  expect_plane(mesh::read_mesh(file));
}

TEST(Gmsh, WithoutPhysicalGroupsEverythingIsOneRegion)
{
  const Directory directory;
  const std::string geo = plane_geo.substr(0, plane_geo.find("Physical"));
  for (const mesh::MeshFile& file : {saved(directory, geo, 4.1, false), directory.write("bare.geo", geo)})
  {
    const auto mesh = std::get<mesh::Mesh<2>>(mesh::read_mesh(file));
    EXPECT_THAT(mesh.region_names(), testing::ElementsAre("domain"));
    EXPECT_THAT(mesh.boundary_names(), testing::IsEmpty());
    EXPECT_NEAR(volume(mesh), 3, 1e-12);
  }
}

TEST(Gmsh, PointsOfTheGeometryThatNoCellUsesAreDropped)
{
  const Directory directory;
  expect_plane(mesh::read_mesh(saved(directory, plane_geo, 4.1, false, true)));
}

TEST(Gmsh, NodesThatNoCellUsesAreDroppedAndCounted)
{
  const Directory directory;
  const mesh::MeshFile file = directory.write(
      "block.msh",
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 1 0\n1 0 0 0 1 1 0 0 0\n$EndEntities\n"
      "$Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n7 8 0\n$EndNodes\n"
      "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n");
  std::vector<std::string> notes;
  const auto mesh = std::get<mesh::Mesh<2>>(mesh::read_mesh(file, {}, nullptr, &notes));
  EXPECT_EQ(mesh.n_vertices(), 3);
  EXPECT_THAT(
      notes,
      testing::ElementsAre(testing::HasSubstr(
          "block.msh: 1 of 4 nodes belong to no element and are left out, such as node 4 at (7, 8, 0)")));
}

TEST(Gmsh, SparseNodeTagsAreFine)
{
  const Directory directory;
  const auto mesh = std::get<mesh::Mesh<2>>(
      mesh::read_mesh(directory.write("sparse.msh",
                                      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n"
                                      "7 0 0 0\n900000 1 0 0\n80000000 0 1 0\n$EndNodes\n"
                                      "$Elements\n1\n1 2 2 1 1 7 900000 80000000\n"
                                      "$EndElements\n")));
  EXPECT_EQ(mesh.n_vertices(), 3);
  EXPECT_NEAR(volume(mesh), 0.5, 1e-15);
  EXPECT_THAT(mesh.region_names(), testing::ElementsAre("1"));
}

TEST(Gmsh, ReadingTwiceGivesTheSame)
{
  const Directory directory;
  const mesh::MeshFile file = saved(directory, solid_geo, 4.1, true);
  const auto first = std::get<mesh::Mesh<3>>(mesh::read_mesh(file));
  const auto second = std::get<mesh::Mesh<3>>(mesh::read_mesh(file));
  EXPECT_TRUE(std::ranges::equal(first.cells(), second.cells()));
  EXPECT_TRUE(std::ranges::equal(first.vertices(), second.vertices()));
}

/// The meshing process is a copy without the threads of this process. A model that the program itself has
/// loaded into Gmsh stays.
TEST(Gmsh, ReadsBesideThreadsAndAnotherModel)
{
  const Directory directory;
  const mesh::MeshFile source = directory.write("plane.geo", plane_geo);
  int n_threads = 0;
#pragma omp parallel num_threads(3) reduction(+ : n_threads)
  n_threads += 1;
  EXPECT_GE(n_threads, 1);
  gmsh::initialize(0, nullptr, false);
  gmsh::model::add("mine");
  const auto mesh = std::get<mesh::Mesh<2>>(mesh::read_mesh(source));
  EXPECT_NEAR(volume(mesh), 3.0, 1e-14);
  std::string name;
  gmsh::model::getCurrent(name);
  EXPECT_EQ(name, "mine");
  gmsh::finalize();
}

}  // namespace

}  // namespace tribound
