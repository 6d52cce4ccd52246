#include "tribound/mesh/geometry.h"

#include <Eigen/LU>
#include <random>

#include "unit/mesh/mesh_testing.h"

namespace tribound
{

namespace
{

/// One positively oriented cell with corners drawn at random.
template <int dim>
mesh::Mesh<dim> random_cell(int seed)
{
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> draw(-1, 1);
  mesh::MeshData<dim> data;
  for (int i = 0; i <= dim; ++i)
  {
    Point<dim>& x = data.vertices.emplace_back();
    for (int a = 0; a < dim; ++a) x[a] = draw(generator);
  }
  mesh::Cell<dim>& cell = data.cells.emplace_back();
  for (int i = 0; i <= dim; ++i) cell[i] = i;
  if (mesh::determinant(mesh::points_of<dim>(data.vertices, cell)) < 0) std::swap(cell[0], cell[1]);
  data.regions = {0};
  data.region_names = {"cell"};
  return mesh::Mesh<dim>(std::move(data));
}

template <int dim>
void check_cell(const mesh::Mesh<dim>& mesh)
{
  const mesh::CellMap<dim> map = mesh::cell_map(mesh, 0);
  EXPECT_NEAR((map.jacobian * map.inverse_transpose.transpose() - Tensor<dim>::Identity()).norm(), 0, 1e-12);
  EXPECT_NEAR(map.det, map.jacobian.determinant(), 1e-14);
  double longest = 0;
  for (int i = 0; i <= dim; ++i)
  {
    Point<dim> xhat = Point<dim>::Zero();
    if (i > 0) xhat[i - 1] = 1;
    EXPECT_NEAR((map(xhat) - mesh.vertex(mesh.cell(0)[i])).norm(), 0, 1e-15);
    for (int j = 0; j < i; ++j) longest = std::max(longest, (mesh.vertex(i) - mesh.vertex(j)).norm());
  }
  EXPECT_DOUBLE_EQ(mesh::cell_diameter(mesh, 0), longest);

  // int_T div w = sum_F |F| w.n for w = e_a and for w = x
  Point<dim> closed = Point<dim>::Zero();
  double flux = 0;
  for (int i = 0; i <= dim; ++i)
  {
    const mesh::FacetGeometry<dim> facet = mesh::facet_geometry(mesh, 0, i);
    const auto vertices = mesh::facet_vertices(mesh.cell(0), i);
    EXPECT_NEAR(facet.normal.norm(), 1, 1e-14);
    EXPECT_LT(facet.normal.dot(mesh.vertex(mesh.cell(0)[i]) - mesh.vertex(vertices[0])), 0);
    closed += facet.measure * facet.normal;
    flux += facet.measure * facet.normal.dot(mesh.vertex(vertices[0]));
    double edge = 0;
    for (const Index a : vertices)
      for (const Index b : vertices) edge = std::max(edge, (mesh.vertex(a) - mesh.vertex(b)).norm());
    EXPECT_DOUBLE_EQ(facet.diameter, edge);
  }
  EXPECT_NEAR(closed.norm(), 0, 1e-14);
  EXPECT_NEAR(flux, dim * map.det / (dim == 2 ? 2 : 6), 1e-14);
}

TEST(Geometry, OfRandomCellsObeysTheDivergenceTheorem)
{
  for (int seed = 0; seed < 20; ++seed)
  {
    check_cell(random_cell<2>(seed));
    check_cell(random_cell<3>(seed));
  }
}

TEST(Geometry, OfTheReferenceTetrahedron)
{
  mesh::MeshData<3> data{
      {.region_names = {"cell"}}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}, {0}};
  const mesh::Mesh<3> mesh(std::move(data));
  EXPECT_DOUBLE_EQ(mesh::cell_map(mesh, 0).det, 1);
  const mesh::FacetGeometry<3> slanted = mesh::facet_geometry(mesh, 0, 0);
  EXPECT_NEAR((slanted.normal - Point<3>::Constant(std::sqrt(1.0 / 3))).norm(), 0, 1e-15);
  EXPECT_NEAR(slanted.measure, std::sqrt(3.0) / 2, 1e-15);
  EXPECT_NEAR(slanted.diameter, std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(mesh::facet_geometry(mesh, 0, 3).measure, 0.5, 1e-15);
}

template <int dim>
void check_facet_points()
{
  const mesh::Mesh<dim> mesh = random_cell<dim>(7);
  const mesh::CellMap<dim> map = mesh::cell_map(mesh, 0);
  for (int i = 0; i <= dim; ++i)
  {
    const auto vertices = mesh::facet_vertices(mesh.cell(0), i);
    for (int k = 0; k < dim; ++k)
    {
      Point<dim - 1> s = Point<dim - 1>::Zero();
      if (k > 0) s[k - 1] = 1;
      EXPECT_NEAR((map(mesh::facet_to_cell<dim>(i, s)) - mesh.vertex(vertices[k])).norm(), 0, 1e-14);
    }
    Point<dim> centre = Point<dim>::Zero();
    for (const Index v : vertices) centre += mesh.vertex(v) / dim;
    EXPECT_NEAR((map(mesh::facet_to_cell<dim>(i, Point<dim - 1>::Constant(1.0 / dim))) - centre).norm(), 0,
                1e-14);
  }
}

TEST(Geometry, FacetPointsGoToTheFacetsVerticesInLocalOrder)
{
  check_facet_points<2>();
  check_facet_points<3>();
}

}  // namespace

}  // namespace tribound
