/// Every flaw that the verification of a mesh must find, and what it must not take for a flaw.

#include <functional>
#include <limits>

#include "tribound/mesh/box.h"
#include "unit/mesh/mesh_testing.h"

namespace tribound
{

namespace
{

/// A valid mesh, a change that spoils it, and required parts of the message.
template <int dim>
struct Flaw
{
  std::string name;
  std::function<void(mesh::MeshData<dim>&)> spoil;
  std::vector<std::string> words;
};

template <int dim>
void PrintTo(const Flaw<dim>& flaw, std::ostream* out)
{
  *out << flaw.name;
}

template <int dim>
void expect_found(const Flaw<dim>& flaw)
{
  const std::vector<double> upper(dim, 2.0);
  mesh::MeshData<dim> data =
      mesh::box_mesh<dim>({std::vector<double>(dim, 0.0), upper, std::vector<int>(dim, 2), {}});
  data.source = {.file = "block.msh"};
  flaw.spoil(data);
  const std::string message = testing_mesh::message_of([&] { const mesh::Mesh<dim> mesh(std::move(data)); });
  EXPECT_THAT(message, testing::StartsWith("block.msh: "));
  for (const std::string& word : flaw.words) EXPECT_THAT(message, testing::HasSubstr(word));
}

/// Adds the vertices and one cell of region 0.
template <int dim>
void add_cell(mesh::MeshData<dim>& data, const std::vector<Point<dim>>& vertices, const mesh::Cell<dim>& cell)
{
  data.vertices.insert(data.vertices.end(), vertices.begin(), vertices.end());
  data.cells.push_back(cell);
  data.regions.push_back(0);
}

using Plane = mesh::MeshData<2>;
using Solid = mesh::MeshData<3>;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class PlaneFlaw : public testing::TestWithParam<Flaw<2>>
{
};

TEST_P(PlaneFlaw, IsFound)
{
  expect_found(GetParam());
}

// The square (0,2)^2 with the vertices 0 1 2 / 3 4 5 / 6 7 8.
INSTANTIATE_TEST_SUITE_P(
    Verify, PlaneFlaw,
    testing::ValuesIn(std::vector<Flaw<2>>{
        {"BodyAcross",
         [](Plane& m) {
           add_cell<2>(m, {{-1, 0.7}, {3, 0.7}, {3, 0.8}}, {9, 10, 11});
         },
         {"the mesh overlaps itself: edge ", "of its boundary cross at (", "bodies must not intersect"}},
        {"BodyInside",
         [](Plane& m) {
           add_cell<2>(m, {{0.2, 0.3}, {0.3, 0.3}, {0.2, 0.4}}, {9, 10, 11});
         },
         {"the mesh overlaps itself: edge ", "(0.3, 0.3)", "lies inside other cells"}},
        {"BodyAroundAll",
         [](Plane& m) {
           add_cell<2>(m, {{-9, -8}, {9, -8}, {0, 9}}, {9, 10, 11});
         },
         {"the mesh overlaps itself: edge ", "lies inside other cells"}},
        {"FarTooSmall",
         [](Plane& m)
         {
           for (Point<2>& x : m.vertices) x *= 1e-100;
         },
         {"triangle 0", "has the diameter 1.41e-100, whose powers are not in the range of numbers"}},
        {"NoCells", [](Plane& m) { m.cells.clear(), m.regions.clear(); }, {"has no cells"}},
        {"NotFinite", [](Plane& m) { m.vertices[4][1] = nan; }, {"vertex 4", "(1, nan)", "not finite"}},
        {"VertexOutOfRange",
         [](Plane& m) { m.cells[3][1] = 9; },
         {"cell 3", "vertex number 9", "9 vertices"}},
        {"NegativeVertex", [](Plane& m) { m.cells[3][1] = -1; }, {"cell 3", "vertex number -1"}},
        {"RegionOutOfRange", [](Plane& m) { m.regions[2] = 1; }, {"cell 2", "region number 1", "1 regions"}},
        {"RegionsMissing", [](Plane& m) { m.regions.pop_back(); }, {"7 region numbers for 8 cells"}},
        {"BisectionTypesMissing",
         [](Plane& m) { m.bisection_types.assign(7, 0); },
         {"7 bisection types for 8 cells"}},
        {"BisectionTypeOutOfRange",
         [](Plane& m) { m.bisection_types = {0, 0, 0, 0, 0, 1, 0, 0}; },
         {"cell 5", "bisection type 1", "1 types"}},
        {"AncestryTooShort",
         [](Plane& m) {
           m.ancestry = {{4, 6}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
         },
         {"ancestry", "does not fit"}},
        {"AncestryOfYoungerVertices",
         [](Plane& m) {
           m.ancestry = {{7}, {{0, 1}, {2, 8}}};
         },
         {"ancestry", "does not fit"}},
        {"TagOutOfRange", [](Plane& m) { m.facets[0].tag = 4; }, {"boundary group number 4"}},
        {"FacetVertexOutOfRange",
         [](Plane& m) { m.facets[0].vertices[0] = 12; },
         {"vertex number 12", "9 vertices"}},
        {"Inverted",
         [](Plane& m) { std::swap(m.cells[0][1], m.cells[0][2]); },
         {"triangle 0 of region \"box\"", "(0, 0), (1, 1), (1, 0)", "inverted", "counterclockwise"}},
        {"Flat",
         [](Plane& m) {
           m.vertices[4] = {2, 1e-14};
         },
         {"triangle 0", "degenerate", "area is"}},
        {"RepeatedVertex",
         [](Plane& m) {
           m.cells[5] = {4, 5, 5};
         },
         {"triangle 5", "degenerate"}},
        {"Duplicate",
         [](Plane& m) {
           add_cell<2>(m, {}, {4, 0, 1});
         },
         {"triangle 8", "is the same as number 0", "(1, 1), (0, 0), (1, 0)"}},
        {"DuplicateOfALoneCell",
         [](Plane& m) {
           add_cell<2>(m, {{5, 0}, {6, 0}, {5, 1}}, {9, 10, 11}), add_cell<2>(m, {}, {10, 11, 9});
         },
         {"triangle 9", "is the same as number 8"}},
        {"CrowdedEdge",
         [](Plane& m) {
           add_cell<2>(m, {{3, 0}}, {0, 9, 4});
         },
         {"edge (0, 0), (1, 1)", "more than two cells: numbers 0, 1 and 8"}},
        {"Folded",
         [](Plane& m) {
           add_cell<2>(m, {{0.5, 1.5}}, {0, 1, 9});
         },
         {"triangle 0", "triangle 8", "overlap", "same side", "edge (0, 0), (1, 0)"}},
        {"HangingVertex",
         [](Plane& m) {
           add_cell<2>(m, {{2, 0.5}, {3, 0.5}}, {9, 10, 5});
         },
         {"not conforming", "vertex 9 at (2, 0.5)", "lies on the edge (2, 0), (2, 1)", "Coherence"}},
        {"HangingVertexOfALargeNeighbour",
         [](Plane& m) {
           add_cell<2>(m, {{2e6, 0}}, {2, 9, 8});
         },
         {"not conforming", "vertex 5 at (2, 1)", "lies on the edge (2, 0), (2, 2)"}},
        {"Unmerged",
         [](Plane& m) {
           add_cell<2>(m, {{2, 0}, {3, 0}, {2, 1}}, {9, 10, 11});
         },
         {"vertices 2 and 9 are both at (2, 0)", "Coherence"}},
        {"TouchingInAPoint",
         [](Plane& m) {
           add_cell<2>(m, {{3, 2}, {3, 3}}, {8, 9, 10});
         },
         {"3 cells around vertex 8 at (2, 2)", "not connected through edges"}},
        {"UnusedVertex",
         [](Plane& m) {
           m.vertices.push_back({7, 8});
         },
         {"vertex 9 at (7, 8)", "no cell"}},
        {"TagOfNoEdge",
         [](Plane& m) {
           m.facets.push_back({{0, 8}, 1});
         },
         {"edge (0, 0), (2, 2) of group \"right\"", "is not an edge of any cell"}},
        {"TagInside",
         [](Plane& m) {
           m.facets.push_back({{4, 0}, 3});
         },
         {"edge (1, 1), (0, 0) of group \"top\"", "inside the domain"}},
        {"TwoGroups",
         [](Plane& m) {
           m.facets.push_back({{1, 0}, 3});
         },
         {"edge (1, 0), (0, 0)", "\"top\"", "\"bottom\""}},
    }),
    [](const auto& info) { return info.param.name; });

class SolidFlaw : public testing::TestWithParam<Flaw<3>>
{
};

TEST_P(SolidFlaw, IsFound)
{
  expect_found(GetParam());
}

// The cube (0,2)^3; vertex (x, y, z) has number (3z + y) 3 + x.
INSTANTIATE_TEST_SUITE_P(
    Verify, SolidFlaw,
    testing::ValuesIn(std::vector<Flaw<3>>{
        {"Inverted",
         [](Solid& m) { std::swap(m.cells[7][0], m.cells[7][1]); },
         {"tetrahedron 7 of region \"box\"", "inverted", "left-handed"}},
        {"Flat",
         [](Solid& m) {
           m.cells[2] = {0, 1, 3, 4};
         },
         {"tetrahedron 2", "degenerate", "volume is 0"}},
        {"Duplicate",
         [](Solid& m) { add_cell<3>(m, {}, m.cells[9]); },
         {"tetrahedron 48", "same as number 9"}},
        {"Folded",
         [](Solid& m) {
           add_cell<3>(m, {{0.5, 0.5, 1}}, {0, 1, 4, 27});
         },
         {"overlap", "face (0, 0, 0), (1, 0, 0), (1, 1, 0)"}},
        {"BodyAcross",  // no vertex in another cell
         [](Solid& m) {
           add_cell<3>(m, {{-1, 0.7, 0.6}, {3, 0.7, 0.6}, {3, 0.8, 0.6}, {3, 0.7, 0.7}}, {27, 28, 29, 30});
         },
         {"the mesh overlaps itself: face ", "of its boundary cross at (2, 0.", "bodies must not intersect"}},
        {"BodyInside",
         [](Solid& m) {
           add_cell<3>(m, {{0.2, 0.3, 0.4}, {0.3, 0.3, 0.4}, {0.2, 0.4, 0.4}, {0.2, 0.3, 0.5}},
                       {27, 28, 29, 30});
         },
         {"the mesh overlaps itself: face ", "(0.3, 0.3, 0.4)", "lies inside other cells"}},
        {"HangingVertexOnAFace",
         [](Solid& m) {
           add_cell<3>(m, {{2.0, 0.5, 0.25}, {3, 0, 0}, {3, 1, 0}, {3, 0, 1}}, {27, 28, 29, 30});
         },
         {"vertex 27 at (2, 0.5, 0.25)", "lies on the face"}},
        {"HangingVertexOnAnEdge",
         [](Solid& m) {
           add_cell<3>(m, {{2, 0, 0.5}, {3, 0, 0}, {3, 1, 0}, {3, 0, 1}}, {27, 28, 29, 30});
         },
         {"vertex 27 at (2, 0, 0.5)", "lies on the face"}},
        {"OtherDiagonal",
         [](Solid& m)
         {
           add_cell<3>(m, {{4, 1, 1}}, {2, 5, 11, 27});
           add_cell<3>(m, {}, {5, 14, 11, 27});
         },
         {"not conforming", "(2, 0, 0)", "overlap", "same triangles"}},
        {"Unmerged",
         [](Solid& m) {
           add_cell<3>(m, {{2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {3, 0, 1}}, {27, 28, 29, 30});
         },
         {"vertices 2 and 27 are both at (2, 0, 0)"}},
        {"TouchingInAPoint",
         [](Solid& m) {
           add_cell<3>(m, {{3, 2, 2}, {2, 3, 2}, {2, 2, 3}}, {26, 27, 28, 29});
         },
         {"around vertex 26 at (2, 2, 2)", "not connected through faces"}},
        {"TouchingInAnEdge",
         [](Solid& m) {
           add_cell<3>(m, {{3, 2.2, 1.5}, {3, 3, 1}}, {17, 27, 28, 26});
         },
         {"around vertex 17 at (2, 2, 1)", "not connected through faces"}},
        {"UnusedVertex",
         [](Solid& m) {
           m.vertices.push_back({7, 8, 9});
         },
         {"vertex 27 at (7, 8, 9)"}},
        {"TagInside",
         [](Solid& m) {
           m.facets.push_back({{0, 13, 1}, 3});
         },
         {"face (0, 0, 0), (1, 1, 1), (1, 0, 0) of group \"top\"", "inside the domain"}},
        {"TwoGroups",
         [](Solid& m) {
           m.facets.push_back({{4, 0, 1}, 5});
         },
         {"face (1, 1, 0), (0, 0, 0), (1, 0, 0)", "\"front\"", "\"back\""}},
    }),
    [](const auto& info) { return info.param.name; });

TEST(Verify, AcceptsThinAndGradedMeshes)
{
  EXPECT_NO_THROW(mesh::Mesh<2>(mesh::box_mesh<2>({{0, 0}, {1, 1e-7}, {4, 3}, {}})));
  EXPECT_NO_THROW(mesh::Mesh<3>(mesh::box_mesh<3>({{1e3, 1e3, 1e3}, {1001, 1001, 1000.001}, {4, 4, 4}, {}})));
  mesh::MeshData<2> graded = mesh::box_mesh<2>({{0, 0}, {1, 1}, {16, 16}, {}});
  for (auto& x : graded.vertices) x = x.array().pow(6);
  EXPECT_NO_THROW(mesh::Mesh<2>(std::move(graded)));
}

TEST(Verify, AcceptsTwoBodiesSideBySideWithANarrowGap)
{
  mesh::MeshData<2> data = mesh::box_mesh<2>({{0, 0}, {1, 1}, {3, 3}, {}});
  const mesh::MeshData<2> other = mesh::box_mesh<2>({{1 + 1e-6, 0}, {2, 1}, {2, 5}, {}});
  const auto shift = static_cast<Index>(data.vertices.size());
  data.vertices.insert(data.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& cell : other.cells)
    data.cells.push_back({cell[0] + shift, cell[1] + shift, cell[2] + shift});
  data.regions.resize(data.cells.size(), 0);
  EXPECT_NO_THROW(mesh::Mesh<2>(std::move(data)));
}

TEST(Verify, AcceptsAFacetListedTwiceInOneGroup)
{
  mesh::MeshData<2> data = mesh::box_mesh<2>({{0, 0}, {1, 1}, {3, 3}, {}});
  data.facets.push_back(data.facets.front());
  EXPECT_EQ(mesh::Mesh<2>(std::move(data)).boundary().size(), 12U);
}

TEST(Verify, KeepsTheTagsOfTheBoundaryAndMarksTheRest)
{
  mesh::MeshData<2> data = mesh::box_mesh<2>({{0, 0}, {1, 1}, {2, 2}, {}});
  std::erase_if(data.facets, [](const auto& facet) { return facet.tag == 1; });
  const mesh::Mesh<2> mesh(std::move(data));
  ASSERT_EQ(mesh.boundary().size(), 8U);
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    const Point<2> normal = mesh::facet_geometry(mesh, facet.cell, facet.local).normal;
    EXPECT_EQ(facet.tag, normal[0] > 0.5 ? -1 : normal[0] < -0.5 ? 0 : normal[1] < 0 ? 2 : 3);
  }
}

}  // namespace

}  // namespace tribound
