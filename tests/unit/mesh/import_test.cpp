/// Meshes of all element types, made simplicial: volume, boundary, conformity, names, shapes.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmsh.h>

#include "tribound/mesh/gmsh_elements.h"
#include "tribound/mesh/import/cell_faces.h"
#include "tribound/mesh/import/read.h"
#include "tribound/mesh/import/simplices.h"
#include "tribound/mesh/quadratic_facets.h"
#include "unit/mesh/imported_testing.h"
#include "unit/mesh/mesh_testing.h"

namespace tribound
{

namespace
{

using testing_mesh::all_cell_types;
using testing_mesh::boundary_measure;
using testing_mesh::Directory;
using testing_mesh::expect_input_error;
using testing_mesh::ImportedBox;
using testing_mesh::volume;

constexpr std::array<int, 3> box_size = {3, 2, 2};

int tag_of(std::span<const std::string> names, const std::string& name)
{
  return static_cast<int>(std::ranges::find(names, name) - names.begin());
}

/// That of ImportedBox: Mesh itself has verified that every inner facet has two cells.
template <int dim>
void expect_box(const mesh::Mesh<dim>& mesh, bool is_second_order)
{
  const double volume_of_box = dim == 2 ? 6 : 12;
  const double base = dim == 2 ? 3 : 6;
  EXPECT_NEAR(volume(mesh), volume_of_box, 1e-12);
  const auto measure = [&](const std::string& name)
  { return boundary_measure(mesh, tag_of(mesh.boundary_names(), name)); };
  EXPECT_NEAR(measure("bottom"), base, 1e-12);
  EXPECT_NEAR(measure("top"), base, 1e-12);
  EXPECT_NEAR(boundary_measure(mesh, -1), dim == 2 ? 4 : 20, 1e-12);
  double left = 0;
  for (Index c = 0; c < mesh.n_cells(); ++c)
    if (mesh.region(c) == tag_of(mesh.region_names(), "left")) left += mesh::cell_map(mesh, c).measure();
  EXPECT_NEAR(left, volume_of_box / 3, 1e-12);

  const mesh::QuadraticFacets& shape = *mesh.labels().quadratic_facets;
  const auto n_tagged = static_cast<std::size_t>(std::ranges::count_if(
      mesh.boundary(), [](const mesh::BoundaryFacet& facet) { return facet.tag >= 0; }));
  EXPECT_EQ(shape.tags.size(), is_second_order ? n_tagged : 0);
  for (int tag = 0; tag < 2; ++tag) EXPECT_EQ(mesh::sagitta<dim>(shape, tag), 0);
}

void expect_box(mesh::SimplicialMesh&& made, const mesh::ElementType& type)
{
  std::visit([&]<int dim>(mesh::MeshData<dim>& data)
             { expect_box(mesh::Mesh<dim>(std::move(data)), mesh::has_middles(type)); },
             made.data);
}

TEST(Import, EveryTypeInAnyNumberingFillsTheBox)
{
  std::mt19937 random(7);
  for (const mesh::ElementType& type : all_cell_types)
    for (int k = 0; k < 40; ++k)
    {
      SCOPED_TRACE(fmt::format("{}, numbering {}", mesh::describe(type), k));
      mesh::SimplicialMesh made = mesh::make_simplicial(ImportedBox(type, box_size, random).take());
      EXPECT_EQ(made.notes.size(), mesh::order_of(type) > 2 ? 1U : 0U);
      expect_box(std::move(made), type);
    }
}

/// A hexahedron between two prisms, a pyramid on top of it and tetrahedra around that.
TEST(Import, DifferentTypesFitTogether)
{
  using mesh::Shape;
  const std::vector<Point<3>> nodes = {{0, 0, 0}, {1, 0, 0},  {1, 1, 0}, {0, 1, 0},   {0, 0, 1},
                                       {1, 0, 1}, {1, 1, 1},  {0, 1, 1}, {.5, .5, 2}, {2, 0, 0},
                                       {2, 0, 1}, {-1, 0, 0}, {-1, 0, 1}};
  std::mt19937 random(3);
  for (int k = 0; k < 100; ++k)
  {
    std::vector<Index> to(nodes.size());
    std::iota(to.begin(), to.end(), 0);
    std::ranges::shuffle(to, random);
    mesh::ImportedMesh mesh{.nodes = std::vector<Point<3>>(nodes.size()),
                            .node_numbers = std::vector<std::int64_t>(nodes.size())};
    for (std::size_t v = 0; v < nodes.size(); ++v) mesh.nodes[to[v]] = nodes[v];
    const auto add = [&](mesh::ElementType type, const std::vector<Index>& corners)
    {
      mesh.cells.push_back({type, {}, {1}});
      for (const Index v : corners) mesh.cells.back().nodes.push_back(to[v]);
    };
    add({Shape::hexahedron, 8}, {0, 1, 2, 3, 4, 5, 6, 7});
    add({Shape::pyramid, 5}, {4, 5, 6, 7, 8});
    add({Shape::prism, 6}, {1, 9, 2, 5, 10, 6});
    add({Shape::prism, 6}, {11, 0, 3, 12, 4, 7});
    add({Shape::tetrahedron, 4}, {5, 10, 6, 8});
    add({Shape::tetrahedron, 4}, {12, 4, 7, 8});
    auto made = mesh::make_simplicial(std::move(mesh));
    const mesh::Mesh<3> joined(std::get<mesh::MeshData<3>>(std::move(made.data)));
    EXPECT_NEAR(volume(joined), 1 + 1. / 3 + 1 + 1. / 3, 1e-12);
  }
}

/// A hexahedron with two pairs of equal corners is a prism.
TEST(Import, CornersMayCoincide)
{
  mesh::ImportedMesh mesh{.nodes = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}},
                          .node_numbers = {1, 2, 3, 4, 5, 6},
                          .cells = {{{mesh::Shape::hexahedron, 8}, {0, 1, 2, 2, 3, 4, 5, 5}, {1}}}};
  const mesh::Mesh<3> prism(std::get<mesh::MeshData<3>>(mesh::make_simplicial(mesh).data));
  EXPECT_EQ(prism.n_cells(), 3);
  EXPECT_NEAR(volume(prism), 0.5, 1e-14);
  mesh.cells[0].nodes = {0, 1, 1, 0, 0, 1, 1, 0};
  expect_input_error([&] { (void)mesh::make_simplicial(mesh); },
                     {"element 1 (hexahedron of 8 nodes) has no volume"});
}

TEST(Import, ABlockThatIsInvertedAsAWholeIsTurned)
{
  std::mt19937 random(5);
  for (const mesh::ElementType& type : all_cell_types)
  {
    mesh::ImportedMesh mesh = ImportedBox(type, box_size, random).take();
    for (Point<3>& x : mesh.nodes) x[0] = 3 - x[0];
    auto made = mesh::make_simplicial(std::move(mesh));
    std::visit([]<int dim>(mesh::MeshData<dim>& data)
               { EXPECT_NEAR(volume(mesh::Mesh<dim>(std::move(data))), dim == 2 ? 6 : 12, 1e-12); },
               made.data);
  }
}

TEST(Import, AnInvertedElementIsNamed)
{
  std::mt19937 random(9);
  mesh::ImportedMesh mesh = ImportedBox({mesh::Shape::hexahedron, 8}, {2, 1, 1}, random).take();
  mesh.nodes[mesh.cells[0].nodes[9]] = {-3, 0, 0};
  expect_input_error(
      [&] { (void)mesh::make_simplicial(mesh); },
      {"box.inp: element 2 (hexahedron of 8 nodes) of region \"right\", whose tetrahedron with corners",
       "is inverted", "less distorted"});
}

/// Meshes written for Gmsh, which adds middles of its own, and read.
class ImportFromGmsh : public testing::TestWithParam<mesh::ElementType>
{
};

TEST_P(ImportFromGmsh, OfThisTypeIsRead)
{
  const mesh::ElementType type = GetParam();
  const mesh::ShapeTable& table = mesh::table_of(type.shape);
  const std::map<mesh::Shape, int> numbers = {{mesh::Shape::segment, 1},       {mesh::Shape::triangle, 2},
                                              {mesh::Shape::quadrilateral, 3}, {mesh::Shape::tetrahedron, 4},
                                              {mesh::Shape::hexahedron, 5},    {mesh::Shape::prism, 6},
                                              {mesh::Shape::pyramid, 7}};
  std::mt19937 random(11);
  mesh::ImportedMesh linear = ImportedBox({type.shape, table.n_corners}, box_size, random).take();
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n";
  text += fmt::format("{0} 1 \"left\"\n{0} 2 \"right\"\n{1} 3 \"bottom\"\n{1} 4 \"top\"\n", table.dim,
                      table.dim - 1);
  text += fmt::format("$EndPhysicalNames\n$Nodes\n{}\n", linear.nodes.size());
  for (std::size_t v = 0; v < linear.nodes.size(); ++v)
    text += fmt::format("{} {} {} {}\n", v + 1, linear.nodes[v][0], linear.nodes[v][1], linear.nodes[v][2]);
  std::vector<std::string> elements;
  const auto add = [&](mesh::Shape shape, int group, std::span<const Index> corners)
  {
    elements.push_back(fmt::format("{} {} 2 {} {}", elements.size() + 1, numbers.at(shape), group, group));
    for (const Index v : corners) elements.back() += fmt::format(" {}", v + 1);
  };
  for (int region = 0; region < 2; ++region)
    for (const Index cell : linear.cell_sets[region].cells)
      add(type.shape, region + 1, linear.cells[0].element(cell));
  const std::vector<char> all(linear.nodes.size(), 1);
  const int axis = table.dim - 1;
  for (const mesh::CellFace& face : mesh::CellFaces(linear.cells, all).outer())
  {
    const mesh::FaceNodes facet = mesh::nodes_of(linear.cells, face);
    for (const auto& [height, group] : {std::pair{0, 3}, {2, 4}})
      if (std::ranges::all_of(facet.span(), [&](Index v) { return linear.nodes[v][axis] == height; }))
        add(facet.type.shape, group, facet.span());
  }
  text +=
      fmt::format("$EndNodes\n$Elements\n{}\n{}\n$EndElements\n", elements.size(), fmt::join(elements, "\n"));

  const Directory directory;
  const mesh::MeshFile file = directory.write("box.msh", text);
  if (mesh::order_of(type) > 1)
  {
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::open(file.path.string());
    gmsh::option::setNumber("Mesh.SecondOrderIncomplete",
                            !mesh::is_simplex(type.shape) && type.n_nodes == table.n_nodes[1]);
    gmsh::model::mesh::setOrder(mesh::order_of(type));
    gmsh::option::setNumber("Mesh.MshFileVersion", 4.1);
    gmsh::write(file.path.string());
    std::vector<int> types;
    gmsh::model::mesh::getElementTypes(types, table.dim);
    EXPECT_EQ(mesh::gmsh_type(types.at(0)), type);
    gmsh::finalize();
  }
  std::vector<std::string> notes;
  EXPECT_EQ(testing_mesh::misplaced_nodes(mesh::read_imported(file, nullptr, mesh::default_patience, notes)),
            "");
  std::visit([&](const auto& mesh) { expect_box(mesh, mesh::has_middles(type)); }, mesh::read_mesh(file));
}

INSTANTIATE_TEST_SUITE_P(Msh, ImportFromGmsh, testing::ValuesIn(all_cell_types),
                         [](const auto& info) {
                           return std::string(mesh::table_of(info.param.shape).name) +
                                  std::to_string(info.param.n_nodes);
                         });

/// The same geometry as tetrahedra of order 1 by Gmsh itself, and as layers of elements of either order.
TEST(Import, LayersOfGmshHaveTheVolumesAndNamesOfItsOwnTetrahedra)
{
  const Directory directory;
  const auto read = [&](const std::string& name, const std::string& options, const std::string& recombine)
  {
    const std::string geo = fmt::format(
        "Mesh.MeshSizeMax = 0.4;\n"
        "Point(1) = {{0, 0, 0}}; Point(2) = {{1, 0, 0}}; Point(3) = {{0, 1, 0}};\n"
        "Line(1) = {{1, 2}}; Circle(2) = {{2, 1, 3}}; Line(3) = {{3, 1}};\n"
        "Transfinite Curve{{1, 2, 3}} = 7; Curve Loop(1) = {{1, 2, 3}}; Plane Surface(1) = {{1}};\n"
        "{} out[] = Extrude {{0, 0, 2}} {{ Surface{{1}}; Layers{{4}}; {} }};\n"
        "Physical Volume(\"body\") = {{out[1]}}; Physical Surface(\"round\") = {{out[3]}};\n"
        "Physical Surface(\"base\") = {{1}}; {}\n",
        recombine.empty() ? "" : recombine, recombine.empty() ? "" : "Recombine;", options);
    return std::get<mesh::Mesh<3>>(mesh::read_mesh(directory.write(name + ".geo", geo)));
  };
  const mesh::Mesh<3> own = read("tetrahedra", "", "");
  const auto measure = [](const mesh::Mesh<3>& mesh, const std::string& name)
  { return boundary_measure(mesh, tag_of(mesh.boundary_names(), name)); };
  for (const std::string recombine : {" ", "Recombine Surface{1};"})
    for (const std::string order : {"1", "2", "2; Mesh.SecondOrderIncomplete = 1"})
    {
      const mesh::Mesh<3> mesh = read("layers", "Mesh.ElementOrder = " + order + ";", recombine);
      EXPECT_NEAR(volume(mesh), volume(own), 1e-12);
      EXPECT_NEAR(measure(mesh, "round"), measure(own, "round"), 1e-12);
      EXPECT_NEAR(measure(mesh, "base"), measure(own, "base"), 1e-12);
      if (order == "1") continue;
      const mesh::QuadraticFacets& shape = *mesh.labels().quadratic_facets;
      const int round = tag_of(mesh.boundary_names(), "round");
      std::size_t n_round = 0;
      for (std::size_t f = 0; f < shape.tags.size(); ++f)
        for (std::size_t a = 0; shape.tags[f] == round && a < 6; ++a)
        {
          const double* x = &shape.points[shape.nodes[f * 6 + a] * 3];
          // Without a node there, the centre of eight nodes is near the cylinder.
          EXPECT_NEAR(std::hypot(x[0], x[1]), 1, order == "2" ? 1e-6 : 1e-3);
          ++n_round;
        }
      EXPECT_EQ(n_round, 6 * std::ranges::count(mesh.boundary(), round, &mesh::BoundaryFacet::tag));
    }
}

}  // namespace

}  // namespace tribound
