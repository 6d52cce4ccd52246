/// Bodies whose boundaries touch at declared interfaces, and meshes cut open along joints.

#include <map>
#include <set>

#include "tribound/mesh/bisect.h"
#include "tribound/mesh/cut_open.h"
#include "tribound/mesh/refine.h"
#include "unit/mesh/mesh_testing.h"

namespace tribound
{

namespace
{

using mesh::Interface;
using mesh::MeshData;
using test::box;
using test::side_by_side;
using testing_mesh::expect_input_error;

template <int dim>
MeshData<dim> cube(double y, int n, double x = 0, double height = 1)
{
  if constexpr (dim == 2)
    return box<2>({x, y}, {x + 1, y + height}, {n, 1});
  else
    return box<3>({x, y, 0}, {x + 1, y + height, 1}, {n, 1, n});
}

/// A box of n facets in each direction on a box of m; vertices between them are doubled.
template <int dim>
MeshData<dim> stack(int n, int m, double x = 0, double overlap = 0)
{
  return side_by_side(cube<dim>(0, m), cube<dim>(1 - overlap, n, x), "_up");
}

const Interface between{{{{"top"}, {"bottom_up"}}}};

template <int dim>
MeshData<dim> with(MeshData<dim> data, const std::vector<Interface>& interfaces)
{
  data.interfaces = interfaces;
  return data;
}

template <int dim>
std::string verdict(const MeshData<dim>& data)
{
  return test::message_of([&] { const mesh::Mesh<dim> mesh(data); });
}

template <int dim>
void boxes_may_touch_where_it_is_declared()
{
  for (const auto& [n, m] : {std::pair(2, 2), {1, 2}, {3, 2}})
    for (const double x : {0.0, 0.25, 1.0})
    {
      EXPECT_THAT(verdict(stack<dim>(n, m, x)), testing::HasSubstr("[[contact]]"));
      EXPECT_EQ(verdict(with(stack<dim>(n, m, x), {between})), "");
      EXPECT_EQ(verdict(with(stack<dim>(n, m, x), {{{{{"bottom_up"}, {"top", "right"}}}}})), "");
      EXPECT_THAT(verdict(with(stack<dim>(n, m, x), {{{{{"left"}, {"bottom_up"}}}}})),
                  testing::HasSubstr("the mesh is not conforming"));
    }
}

TEST(Interfaces, BoxesMayTouchWhereItIsDeclared)
{
  boxes_may_touch_where_it_is_declared<2>();
  boxes_may_touch_where_it_is_declared<3>();
}

template <int dim>
void bodies_may_overlap_where_it_is_declared()
{
  EXPECT_THAT(verdict(stack<dim>(3, 2, 0.2, 0.01)), testing::HasSubstr("the mesh "));
  EXPECT_EQ(verdict(with(stack<dim>(3, 2, 0.2, 0.01), {between})), "");
  const MeshData<dim> three = side_by_side(stack<dim>(3, 2), cube<dim>(0.3, 1, 0.9), "_aside");
  EXPECT_THAT(verdict(with(three, {between})), testing::HasSubstr("the mesh "));
}

TEST(Interfaces, BodiesMayOverlapWhereItIsDeclared)
{
  bodies_may_overlap_where_it_is_declared<2>();
  bodies_may_overlap_where_it_is_declared<3>();
}

/// Both lower boxes are in contact with the upper one, but not with each other.
TEST(Interfaces, EveryOverlapNeedsAPairOfItsOwn)
{
  const MeshData<2> three =
      side_by_side(side_by_side(box<2>({0, 0}, {1, 1}, {2, 1}), box<2>({1, 0}, {2, 1}, {2, 1}), "_right"),
                   box<2>({0, 1}, {2, 2}, {3, 1}), "_up");
  const Interface floor{{{{"top", "top_right"}, {"bottom_up"}}}};
  EXPECT_THAT(verdict(with(three, {floor})), testing::HasSubstr("the mesh is not conforming"));
  EXPECT_EQ(verdict(with(three, {floor, {{{{"right"}, {"left_right"}}}}})), "");
  // The sides that face each other are in pairs, but each with a different side.
  EXPECT_THAT(verdict(with(three, {floor, {{{{"right"}, {"right_right"}}}}, {{{{"left_right"}, {"left"}}}}})),
              testing::HasSubstr("overlap\n"));
}

/// The upper body meets a corner of each of two bodies that share no side.
TEST(Interfaces, ThreeBodiesMayMeetInAPoint)
{
  const MeshData<2> three =
      side_by_side(side_by_side(box<2>({0, 0}, {1, 1}, {2, 1}), box<2>({1, 1}, {2, 2}, {2, 1}), "_above"),
                   box<2>({1, 0}, {2, 1}, {1, 2}), "_right");
  EXPECT_EQ(verdict(with(three, {{{{{"right"}, {"left_right"}}}}, {{{{"bottom_above"}, {"top_right"}}}}})),
            "");
}

template <int dim>
void refined_meshes_keep_their_interfaces()
{
  const mesh::Mesh<dim> first(with(stack<dim>(3, 2, 0.25), {between}));
  const mesh::Mesh<dim> halved = mesh::refine_uniformly(first).mesh;
  EXPECT_EQ(halved.interfaces().size(), 1U);
  EXPECT_EQ(mesh::bisect<dim>(first, std::vector{0, first.n_cells() - 1}, 1).mesh.interfaces().size(), 1U);
}

TEST(Interfaces, RefinedMeshesKeepThem)
{
  refined_meshes_keep_their_interfaces<2>();
  refined_meshes_keep_their_interfaces<3>();
}

/// The facets of the mesh all of whose vertices satisfy inside(x), as a group.
template <int dim, class Inside>
void add_group(MeshData<dim>& data, const std::string& name, const Inside& inside)
{
  data.boundary_names.push_back(name);
  const auto topology = mesh::build_topology<dim>(static_cast<Index>(data.vertices.size()), data.cells);
  for (const auto& facet : topology.facets)
  {
    Point<dim> centre = Point<dim>::Zero();
    for (const Index v : facet) centre += data.vertices[v] / dim;
    if (inside(centre) && std::ranges::all_of(facet, [&](Index v) { return inside(data.vertices[v]); }))
      data.facets.push_back({facet, static_cast<int>(data.boundary_names.size()) - 1});
  }
}

template <int dim>
MeshData<dim> grid_4()
{
  if constexpr (dim == 2)
    return box<2>({0, 0}, {1, 1}, {4, 4});
  else
    return box<3>({0, 0, 0}, {1, 1, 1}, {4, 4, 2});
}

template <int dim>
int group(const mesh::Mesh<dim>& mesh, const std::string& name)
{
  return static_cast<int>(std::ranges::find(mesh.boundary_names(), name) - mesh.boundary_names().begin());
}

/// The mesh without the facets of unnamed joints.
template <int dim>
MeshData<dim> with_joints(const std::vector<std::string>& names)
{
  MeshData<dim> data = grid_4<dim>();
  for (const std::string& name : names)
    add_group(data, name,
              [&](const Point<dim>& x)
              {
                if (name == "through") return x[1] == 0.5;
                if (name == "slit") return x[0] == 0.25 && x[1] >= 0.5;
                if (name == "inner") return x[0] == 0.75 && std::abs(x[1] - 0.5) <= 0.25;
                return x[1] == 0.5 || (x[0] == 0.5 && x[1] >= 0.5);
              });
  data.source = {.file = "joint.msh"};
  return data;
}

template <int dim>
mesh::Mesh<dim> cut(MeshData<dim> data, const std::vector<std::string>& joints)
{
  mesh::cut_open<dim>(data, joints);
  return mesh::Mesh<dim>(std::move(data));
}

/// Cut along joints of the given areas, the grid has `n_bodies` bodies and `n_added` more vertices.
template <int dim>
void expect_cut(const std::map<std::string, double>& joints, int n_bodies, Index n_added)
{
  std::vector<std::string> names;
  for (const auto& [name, area] : joints) names.push_back(name);
  const MeshData<dim> data = with_joints<dim>(names);
  const mesh::Mesh<dim> mesh = cut<dim>(data, names);
  EXPECT_EQ(std::ranges::max(mesh::connected_parts(mesh.topology())) + 1, n_bodies);
  EXPECT_EQ(mesh.n_vertices() - static_cast<Index>(data.vertices.size()), n_added);
  EXPECT_NEAR(testing_mesh::volume(mesh), 1, 1e-13);
  for (const auto& [name, area] : joints)
  {
    std::array<Point<dim>, 2> sum = {Point<dim>::Zero(), Point<dim>::Zero()};
    for (int side = 0; side < 2; ++side)
      for (const std::size_t k :
           mesh::facets_named<dim>(mesh, std::vector{name + (side == 0 ? "" : ".other")}))
      {
        const mesh::BoundaryFacet& facet = mesh.boundary()[k];
        const auto geometry = mesh::facet_geometry(mesh, facet.cell, facet.local);
        sum[side] += geometry.measure * geometry.normal;
      }
    EXPECT_NEAR(sum[0].norm(), area, 1e-13) << name;
    EXPECT_LT((sum[0] + sum[1]).norm(), 1e-13) << name;
  }
}

template <int dim>
void joints_are_cut_open()
{
  const Index deep = dim == 2 ? 1 : 3;  // vertices of the grid in the third direction
  expect_cut<dim>({{"through", 1}}, 2, 5 * deep);
  expect_cut<dim>({{"slit", 0.5}}, 1, 2 * deep);
  expect_cut<dim>({{"inner", 0.5}}, 1, deep);
  expect_cut<dim>({{"through", 1}, {"slit", 0.5}}, 3, 8 * deep);
  expect_cut<dim>({{"through", 1}, {"inner", 0.5}}, 2, 7 * deep);  // four copies where they cross
}

TEST(Joints, AreCutOpen)
{
  joints_are_cut_open<2>();
  joints_are_cut_open<3>();
}

template <int dim>
void bad_joints_are_named()
{
  expect_input_error([] { const mesh::Mesh<dim> mesh(with_joints<dim>({"through"})); },
                     {"joint.msh: ", "lies inside the domain"});
  expect_input_error([] { cut<dim>(with_joints<dim>({}), {"left"}); },
                     {"joint.msh: ", " of joint \"left\" lies on the boundary"});
  expect_input_error([] { cut<dim>(with_joints<dim>({"tee"}), {"tee"}); },
                     {"the two sides of joint \"tee\" cannot be told apart at (0.5, 0.5"});
  expect_input_error(
      [] {
        cut<dim>(with_joints<dim>({"through", "tee"}), {"through", "tee"});
      },
      {" of joint \"tee\" is also in joint \"through\""});
  expect_input_error(
      [] {
        cut<dim>(with_joints<dim>({"through", "tee"}), {"through"});
      },
      {" of joint \"through\" is also in group \"tee\""});
  MeshData<dim> named = with_joints<dim>({"through"});
  named.boundary_names.emplace_back("through.other");
  expect_input_error([&] { cut<dim>(named, {"through"}); }, {"there is a group \"through.other\""});
  MeshData<dim> loose = with_joints<dim>({"through"});
  loose.facets.back().vertices[0] = 0;
  expect_input_error([&] { cut<dim>(loose, {"through"}); }, {" of any cell", "embedded"});
}

TEST(Joints, ThatAreNoneAreNamed)
{
  bad_joints_are_named<2>();
  bad_joints_are_named<3>();
}

}  // namespace

}  // namespace tribound
