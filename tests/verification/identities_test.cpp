/// @file identities_test.cpp
/// The identities of method section 4 (divergence, normal continuity, tractions, weak symmetry) at the first,
/// second and last Newton iterates: on every kind of mesh, with every pair of conditions on adjacent sides.
/// Prints the largest defect of each test.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <span>
#include <string>

#include "support/box_sides.h"
#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/mesh/bisect.h"
#include "verification/data_mesh.h"

namespace tribound::test
{

namespace
{

const problem::Contact tresca(Tresca(formula("0.01 + 0.005*sin(x)")));
const problem::Contact coulomb(Coulomb(0.4), formula("0.002*(1 + sin(3*x))"));

double identity_bound(int p)
{
  return p <= 2 ? 1e-11 : 1e-10;
}

/// Checks iterates 1, 2 and the last with patches of both kinds; returns the largest defect.
template <int dim>
double expect_identities(DiscreteProblem<dim>& c)
{
  double largest = 0;
  const double bound = identity_bound(c.method.degree);
  for (const int k : {1, 2, 30})
  {
    c.method.newton.max_steps = k;
    const solve::NewtonResult<dim> result = c.solve();
    for (const certify::PatchStress kind : {certify::PatchStress::rows, certify::PatchStress::afw})
    {
      SCOPED_TRACE(fmt::format("iterate {}, {}", k, kind == certify::PatchStress::rows ? "rows" : "AFW"));
      const certify::Stress<dim> stress =
          certify::equilibrate<dim>(c.form, result.u, result.traction, 0, 0, kind);
      const certify::IdentityDefects defects =
          certify::check_identities<dim>(c.form, result.traction, stress);
      EXPECT_LE(defects.divergence, bound);
      EXPECT_LE(defects.jump, bound);
      EXPECT_LE(defects.neumann, bound);
      EXPECT_LE(defects.contact, bound);
      const bool is_symmetric = kind == certify::PatchStress::afw && c.method.degree > 1;
      if (is_symmetric)
      {
        EXPECT_LE(defects.symmetry, bound);
      }
      largest = std::max(largest, defects.largest());
    }
  }
  return largest;
}

template <int dim>
using Conditions = std::vector<problem::BoundaryCondition<dim>>;

/// Adds a body force of degree 3.
template <int dim>
ProblemData<dim> heavy(const Conditions<dim>& boundaries)
{
  return {
      .boundaries = boundaries,
      .body_force = components<dim>(formula("0.1*x*y"), formula("-0.1*(1 + x^2*y)"), formula("0.05*z*x"))};
}

adapt::Method method(int p)
{
  return {.degree = p, .newton = {.tolerance = 1e-12}};
}

template <int dim>
mesh::MeshData<dim> some_block()
{
  return block<dim>({4, 3}, {2, 1, 1});
}

/// All combinations on the sides of the block rotated by `frame`.
template <int dim>
void every_combination(const Tensor<dim>& frame, int p)
{
  double largest = 0;
  const auto choices = covering_sides<dim>(frame);
  for (std::size_t i = 0; i < choices.size(); ++i)
  {
    SCOPED_TRACE(describe<dim>(choices[i]));
    DiscreteProblem<dim> c(
        mapped<dim>(some_block<dim>(), [&](const Point<dim>& x) -> Point<dim> { return frame * x; }),
        heavy<dim>(side_conditions<dim>(choices[i], i % 2 == 0 ? tresca : coulomb)), method(p));
    largest = std::max(largest, expect_identities<dim>(c));
  }
  fmt::print("{}D, p = {}: {} choices of sides, largest defect {:.1e}\n", dim, p, choices.size(), largest);
}

class Identities2D : public ::testing::TestWithParam<int>
{
};

TEST_P(Identities2D, EveryCombinationOfNeighbouringSides)
{
  every_combination<2>(Tensor<2>::Identity(), GetParam());
}

TEST_P(Identities2D, EveryCombinationOnInclinedSides)
{
  every_combination<2>(rotation<2>(), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Degrees, Identities2D, ::testing::Range(1, 5));

class Identities3D : public ::testing::TestWithParam<int>
{
};

TEST_P(Identities3D, EveryCombinationOfNeighbouringSides)
{
  every_combination<3>(Tensor<3>::Identity(), GetParam());
}

TEST_P(Identities3D, EveryCombinationOnInclinedSides)
{
  every_combination<3>(rotation<3>(), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Degrees, Identities3D, ::testing::Range(1, 4));

TEST(CoveringSides, ContainEveryCombination)
{
  std::set<Meeting> in_plane;
  for (const Sides<2>& sides : covering_sides<2>())
    for (const Meeting& meeting : meetings(sides)) in_plane.insert(meeting);
  EXPECT_EQ(in_plane.size(), 2 * 5 * 5);  // kinds of corners, conditions on either side
  std::set<Meeting> in_space;
  for (const Sides<3>& sides : covering_sides<3>())
    for (const Meeting& meeting : meetings(sides)) in_space.insert(meeting);
  EXPECT_EQ(in_space.size(), 3 * 6 * 6);
}

/// Checks one case and prints.
template <int dim>
void check_case(const std::string& name, DiscreteProblem<dim> c)
{
  SCOPED_TRACE(name);
  const double largest = expect_identities<dim>(c);
  fmt::print("{}, {}D, p = {}, {} cells: largest defect {:.1e}\n", name, dim, c.method.degree,
             c.mesh.n_cells(), largest);
}

/// Blocks partly held by contact and friction, undamped.
template <int dim>
void held_by_contact(const Conditions<dim>& boundaries, int p)
{
  check_case<dim>("block held by contact", {block<dim>({5, 3}, {2, 2, 2}),
                                            heavy<dim>(boundaries),
                                            {.degree = p, .newton = {.tolerance = 1e-12, .damping = false}}});
}

TEST_P(Identities2D, BlockHeldByContact)
{
  for (const problem::Contact& contact : {tresca, coulomb})
    for (const auto& left : {clamped<2>("left"), fixed<2>("left", 0, free)})
      for (const auto& right : {loaded<2>("right", 0.02, formula("0.01*sin(y)")), fixed<2>("right", free, 0),
                                loaded<2>("right", 0, 0)})
        held_by_contact<2>(
            {obstacle<2>("bottom", contact), left, right, loaded<2>("top", 0, formula("-0.1*exp(x)"))},
            GetParam());
}

TEST_P(Identities3D, BlockHeldByContact)
{
  for (const problem::Contact& contact : {tresca, coulomb})
    held_by_contact<3>({obstacle<3>("bottom", contact), fixed<3>("left", 0, free),
                        fixed<3>("back", free, free), loaded<3>("top", 0, formula("-0.1*exp(x)"), 0.01)},
                       GetParam());
}

/// The condition of each side of the block on unstructured meshes: contact below and on the right.
template <int dim>
constexpr Sides<dim> mixed_sides = []
{
  Sides<dim> sides{Side::roller_x, Side::contact, Side::contact, Side::neumann};
  if constexpr (dim == 3)
    sides = {Side::roller_x, Side::contact, Side::contact, Side::neumann, Side::roller_z, Side::dirichlet};
  return sides;
}();

/// The block bisected towards the corner where two contact boundaries meet.
template <int dim>
mesh::Mesh<dim> graded_block()
{
  mesh::Mesh<dim> mesh(distorted<dim>(some_block<dim>(), 3));
  for (int level = 0; level < (dim == 2 ? 6 : 3); ++level)
  {
    const auto vertices = mesh.vertices();
    const auto corner =
        std::ranges::max_element(vertices, {}, [](const Point<dim>& x) { return x[0] - x[1]; });
    const auto& topology = mesh.topology();
    const auto* first = &topology.vertex_cells_begin[corner - vertices.begin()];
    mesh = mesh::bisect<dim>(mesh, std::span(topology.vertex_cells).subspan(first[0], first[1] - first[0]), 1)
               .mesh;
  }
  return mesh;
}

template <int dim>
void unstructured_meshes(int p)
{
  for (const problem::Contact& contact : {tresca, coulomb})
  {
    const ProblemData<dim> data = heavy<dim>(side_conditions<dim>(mixed_sides<dim>, contact));
    check_case<dim>("distorted block", {distorted<dim>(some_block<dim>(), 3), data, method(p)});
    check_case<dim>("block from Gmsh", {data_mesh<dim>("box"), data, method(p)});
    check_case<dim>("bisected block", {graded_block<dim>(), data, method(p)});
  }
}

/// Two materials; the stress is singular at the corner. Contact also acts on the inner wall, which meets a
/// traction boundary at the re-entrant corner.
template <int dim>
void l_shape(int p)
{
  ProblemData<dim> data{
      .boundaries = {obstacle<dim>("bottom", tresca), obstacle<dim>("wall", coulomb),
                     pressed<dim>("top", formula("0.05*exp(x)")),
                     loaded<dim>("ledge", 0.01, formula("-0.05*cos(x)"), 0.01),
                     fixed<dim>("right", free, 0, free), fixed<dim>("left", 0, free, free)},
      .regions = {{.name = "soft",
                   .material = lame(1, 0.3),
                   .body_force = components<dim, problem::Field>(0, formula("-0.02*x*y"), 0)},
                  {.name = "stiff", .material = lame(20, 0.45)}}};
  if (dim == 3) data.boundaries.push_back(fixed<dim>("back", free, free, 0));
  check_case<dim>("L-shape of two materials", {data_mesh<dim>("lshape"), data, method(p)});
}

TEST_P(Identities2D, UnstructuredMeshes)
{
  unstructured_meshes<2>(GetParam());
}
TEST_P(Identities2D, LShapeOfTwoMaterials)
{
  l_shape<2>(GetParam());
}
TEST_P(Identities3D, UnstructuredMeshes)
{
  unstructured_meshes<3>(GetParam());
}
TEST_P(Identities3D, LShapeOfTwoMaterials)
{
  l_shape<3>(GetParam());
}

/// Data that no rule integrates exactly: every integral of f must use the same rule (rule 1 of section 4),
/// even if the vertices of a cell are not in ascending order.
template <int dim>
void no_polynomial(int p)
{
  const ProblemData<dim> data{
      .boundaries = side_conditions<dim>(mixed_sides<dim>, tresca),
      .body_force = components<dim>(formula("0.1*sin(5*x)*exp(y)"), formula("-0.1*exp(2*x*y)"),
                                    formula("0.1*cos(3*z)"))};
  check_case<dim>("body force no polynomial, structured", {some_block<dim>(), data, method(p)});
  check_case<dim>("body force no polynomial, distorted",
                  {distorted<dim>(some_block<dim>(), 3), data, method(p)});
}

TEST_P(Identities2D, BodyForceThatIsNoPolynomial)
{
  no_polynomial<2>(GetParam());
}
TEST_P(Identities3D, BodyForceThatIsNoPolynomial)
{
  no_polynomial<3>(GetParam());
}

}  // namespace

}  // namespace tribound::test
