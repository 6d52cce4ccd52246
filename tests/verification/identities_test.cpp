/// @file identities_test.cpp
/// The identities of method section 4 (divergence, normal continuity, tractions, weak symmetry) at the first,
/// second and last Newton iterate: on every kind of mesh, with every pair of conditions on sides that meet.
/// Prints the largest defect of each test.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "support/box_sides.h"
#include "support/discrete_case.h"
#include "support/meshes.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/mesh/bisect.h"

namespace tribound::test
{

namespace
{

constexpr auto tresca = "{ friction = \"tresca\", threshold = \"0.01 + 0.005*sin(x)\" }";
constexpr auto coulomb = "{ friction = \"coulomb\", coefficient = 0.4, gap = \"0.002*(1 + sin(3*x))\" }";

double identity_bound(int p)
{
  return p <= 2 ? 1e-11 : 1e-10;
}

/// Checks iterates 1, 2 and the last; returns the largest defect.
template <int dim>
double expect_identities(DiscreteCase<dim>& c)
{
  double largest = 0;
  const double bound = identity_bound(c.config.method.degree);
  for (const int k : {1, 2, 30})
  {
    c.config.method.newton.max_steps = k;
    const solve::NewtonResult<dim> result = c.solve();
    const certify::Stress<dim> stress = certify::equilibrate<dim>(c.form, result.u, result.traction);
    const certify::IdentityDefects defects = certify::check_identities<dim>(c.form, result.traction, stress);
    EXPECT_LE(defects.divergence, bound) << "iterate " << k;
    EXPECT_LE(defects.jump, bound) << "iterate " << k;
    EXPECT_LE(defects.neumann, bound) << "iterate " << k;
    EXPECT_LE(defects.contact, bound) << "iterate " << k;
    if (c.config.method.degree > 1)
    {
      EXPECT_LE(defects.symmetry, bound) << "iterate " << k;
    }
    largest = std::max(largest, defects.largest(c.config.method.degree));
  }
  return largest;
}

/// Degree, material and a body force of degree 3.
template <int dim>
std::string matter(int p)
{
  return fmt::format(
      "degree = {}\nmaterial = {{ E = 1.0, nu = 0.3 }}\nload.body = [{}]\nnewton.tolerance = 1e-12\n", p,
      dim == 2 ? "\"0.1*x*y\", \"-0.1*(1 + x^2*y)\"" : "\"0.1*x*y\", \"-0.1*(1 + x^2*y)\", \"0.05*z*x\"");
}

template <int dim>
mesh::MeshData<dim> block()
{
  if constexpr (dim == 2)
    return box<2>({0, 0}, {2, 1}, {4, 3});
  else
    return box<3>({0, 0, 0}, {2, 1, 1}, {2, 1, 1});
}

/// A rotation that leaves no side parallel to an axis.
template <int dim>
Tensor<dim> turn()
{
  Tensor<dim> q = Tensor<dim>::Identity();
  q.topLeftCorner(2, 2) << 0.8, -0.6, 0.6, 0.8;
  if constexpr (dim == 3)
  {
    Tensor<dim> about_x = Tensor<dim>::Identity();
    about_x.bottomRightCorner(2, 2) << 0.8, -0.6, 0.6, 0.8;
    q = (about_x * q).eval();
  }
  return q;
}

/// All combinations on the sides of the block turned by `frame`.
template <int dim>
void every_combination(const Tensor<dim>& frame, int p)
{
  double largest = 0;
  const auto choices = covering_sides<dim>(frame);
  for (std::size_t i = 0; i < choices.size(); ++i)
  {
    SCOPED_TRACE(describe<dim>(choices[i]));
    DiscreteCase<dim> c(
        matter<dim>(p) + sides_toml<dim>(choices[i], i % 2 == 0 ? tresca : coulomb),
        mapped<dim>(block<dim>(), [&](const Point<dim>& x) -> Point<dim> { return frame * x; }));
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
  every_combination<2>(turn<2>(), GetParam());
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
  every_combination<3>(turn<3>(), GetParam());
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
void check_case(const std::string& name, DiscreteCase<dim>& c)
{
  SCOPED_TRACE(name);
  const double largest = expect_identities<dim>(c);
  fmt::print("{}, {}D, p = {}, {} cells: largest defect {:.1e}\n", name, dim, c.config.method.degree,
             c.mesh.n_cells(), largest);
}

/// Blocks that contact and friction help to hold, undamped.
std::string held_by_contact(int dimension, int p)
{
  return (dimension == 2 ? matter<2>(p) : matter<3>(p)) + "newton.damping = false\n" +
         (dimension == 2 ? "mesh.box = { lower = [0, 0], upper = [2, 1], cells = [5, 3] }\n"
                         : "mesh.box = { lower = [0, 0, 0], upper = [2, 1, 1], cells = [2, 2, 2] }\n");
}

TEST_P(Identities2D, BlockHeldByContact)
{
  for (const std::string contact : {tresca, coulomb})
    for (const std::string left : {"[0, 0]", "[0, \"free\"]"})
      for (const std::string right : {"boundary.right.traction = [0.02, \"0.01*sin(y)\"]\n",
                                      "boundary.right.displacement = [\"free\", 0]\n", ""})
      {
        DiscreteCase<2> c(held_by_contact(2, GetParam()) + "boundary.bottom.contact = " + contact +
                          "\nboundary.left.displacement = " + left + "\n" + right +
                          "boundary.top.traction = [0, \"-0.1*exp(x)\"]\n");
        check_case("block held by contact", c);
      }
}

TEST_P(Identities3D, BlockHeldByContact)
{
  for (const std::string contact : {tresca, coulomb})
  {
    DiscreteCase<3> c(held_by_contact(3, GetParam()) + "boundary.bottom.contact = " + contact +
                      "\nboundary.left.displacement = [0, \"free\", 0]\n"
                      "boundary.back.displacement = [\"free\", \"free\", 0]\n"
                      "boundary.top.traction = [0, \"-0.1*exp(x)\", 0.01]\n");
    check_case("block held by contact", c);
  }
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

std::string data_file(const std::string& name, int dim)
{
  return fmt::format("mesh.file = \"{}/{}{}.geo\"\n", VERIFICATION_DATA, name, dim);
}

/// The block bisected towards the corner where two contact boundaries meet.
template <int dim>
mesh::Mesh<dim> graded_block()
{
  mesh::Mesh<dim> mesh(distorted<dim>(block<dim>(), 3));
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
  for (const auto* contact : {tresca, coulomb})
  {
    const std::string toml = matter<dim>(p) + sides_toml<dim>(mixed_sides<dim>, contact);
    DiscreteCase<dim> bent(toml, distorted<dim>(block<dim>(), 3));
    check_case("distorted block", bent);
    DiscreteCase<dim> gmsh(data_file("box", dim) + toml);
    check_case("block from Gmsh", gmsh);
    DiscreteCase<dim> graded(toml, graded_block<dim>());
    check_case("bisected block", graded);
  }
}

/// Two materials; the stress is singular at the corner. Contact on the inner wall too, where the re-entrant
/// corner joins it to a traction.
template <int dim>
void l_shape(int p)
{
  const std::string free = dim == 2 ? "[\"free\", 0]" : "[\"free\", 0, \"free\"]";
  std::string toml =
      data_file("lshape", dim) +
      fmt::format(
          "degree = {}\n"
          "material.soft = {{ E = 1.0, nu = 0.3 }}\nmaterial.stiff = {{ E = 20.0, nu = 0.45 }}\n"
          "load.soft.body = [{}]\nnewton.tolerance = 1e-12\n"
          "boundary.bottom.contact = {}\nboundary.wall.contact = {}\n"
          "boundary.top.pressure = \"0.05*exp(x)\"\n",
          p, dim == 2 ? "0, \"-0.02*x*y\"" : "0, \"-0.02*x*y\", 0", tresca, coulomb);
  const std::string traction = dim == 2 ? "[0.01, \"-0.05*cos(x)\"]" : "[0.01, \"-0.05*cos(x)\", 0.01]";
  toml += "boundary.ledge.traction = " + traction + "\nboundary.right.displacement = " + free + "\n";
  toml += dim == 2
              ? "boundary.left.displacement = [0, \"free\"]\n"
              : "boundary.left.displacement = [0, \"free\", \"free\"]\n"
                "boundary.back.displacement = [\"free\", \"free\", 0]\nboundary.front.traction = [0, 0, 0]\n";
  DiscreteCase<dim> c(toml);
  check_case("L-shape of two materials", c);
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

/// Data that no rule integrates exactly: every integral of f must take the same rule (rule 1 of section 4),
/// also where the vertices of a cell do not ascend.
template <int dim>
void no_polynomial(int p)
{
  const std::string body = dim == 2 ? "[\"0.1*sin(5*x)*exp(y)\", \"-0.1*exp(2*x*y)\"]"
                                    : "[\"0.1*sin(5*x)*exp(y)\", \"-0.1*exp(2*x*y)\", \"0.1*cos(3*z)\"]";
  const std::string toml =
      fmt::format(
          "degree = {}\nmaterial = {{ E = 1.0, nu = 0.3 }}\nload.body = {}\nnewton.tolerance = 1e-12\n", p,
          body) +
      sides_toml<dim>(mixed_sides<dim>, tresca);
  DiscreteCase<dim> structured(toml, block<dim>());
  check_case("body force no polynomial, structured", structured);
  DiscreteCase<dim> bent(toml, distorted<dim>(block<dim>(), 3));
  check_case("body force no polynomial, distorted", bent);
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
