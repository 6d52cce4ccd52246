/// @file patch_test.cpp
/// Constant-stress patch tests: every degree reproduces an affine displacement on every mesh, in every state
/// of contact.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "support/discrete_case.h"
#include "support/meshes.h"

namespace tribound::test
{

namespace
{

/// u(x) = gradient x + offset on the box (0,2) x (0,1) (x (0,1)), with contact at the bottom.
template <int dim>
struct AffineCase
{
  std::string name;
  Tensor<dim> gradient;
  Point<dim> offset;
  std::string contact;  ///< TOML
  ContactStatus status;
};

const Material material = lame(1.0, 0.3, PlaneModel::strain);

std::string tresca(double s)
{
  return fmt::format("{{ friction = \"tresca\", threshold = {:.17g} }}", s);
}

std::string coulomb(double mu_F)
{
  return fmt::format("{{ friction = \"coulomb\", coefficient = {:.17g} }}", mu_F);
}

/// All states. The displacement is (d (c + k.x + b y), D y) with the tangential direction d, in 3D not along
/// an axis, and a slip c + k.x that varies along the contact but stays positive; shear mu b |d| at the
/// bottom.
template <int dim>
std::vector<AffineCase<dim>> affine_cases()
{
  Point<dim> d = Point<dim>::Unit(0);
  Point<dim> k = 0.1 * Point<dim>::Unit(0);
  if constexpr (dim == 3)
  {
    d = {0.8, 0, -0.6};
    k = {0.1, 0, 0.04};
  }
  const Point<dim> y = Point<dim>::Unit(1);
  const auto field = [&](double slip, double shear, double stretch) -> Tensor<dim>
  { return slip * d * k.transpose() + shear * d * y.transpose() + stretch * y * y.transpose(); };
  const auto pressure = [&](const Tensor<dim>& g) { return -sigma<dim>(material, g)(1, 1); };
  const Tensor<dim> slip = field(1, 0.2, -0.3);
  const Tensor<dim> stick = field(0, 0.2, -0.3);
  const Tensor<dim> smooth = field(1, 0, -0.3);
  const double free_stretch = -material.lambda * d.dot(k) / (material.lambda + 2 * material.mu);
  const Tensor<dim> open = field(1, 0, free_stretch);
  const Point<dim> offset = 0.05 * d;
  const Point<dim> none = Point<dim>::Zero();
  const double shear = 0.2 * material.mu;
  return {
      {"slip, Tresca", slip, offset, tresca(shear), ContactStatus::slip},
      {"slip, Coulomb", slip, offset, coulomb(shear / pressure(slip)), ContactStatus::slip},
      {"stick, Tresca", stick, none, tresca(2 * shear), ContactStatus::stick},
      {"stick, Coulomb", stick, none, coulomb(2 * shear / pressure(stick)), ContactStatus::stick},
      {"frictionless", smooth, offset, "{ friction = \"none\" }", ContactStatus::slip},
      {"open, frictionless", open, offset, "{ friction = \"none\", gap = 1 }", ContactStatus::open},
      {"open, Tresca", open, offset, "{ friction = \"tresca\", threshold = 0, gap = 1 }",
       ContactStatus::open},
      {"open, Coulomb", open, offset, "{ friction = \"coulomb\", coefficient = 0.5, gap = 1 }",
       ContactStatus::open},
  };
}

/// The same physics in a frame turned by `q`.
template <int dim>
AffineCase<dim> turned(AffineCase<dim> c, const Tensor<dim>& q)
{
  c.gradient = (q * c.gradient * q.transpose()).eval();
  c.offset = (q * c.offset).eval();
  return c;
}

/// No side of the turned box is parallel to an axis.
template <int dim>
Tensor<dim> rotation()
{
  Tensor<2> plane;
  plane << 0.8, -0.6, 0.6, 0.8;
  if constexpr (dim == 2) return plane;
  Tensor<dim> about_z = Tensor<dim>::Identity();
  Tensor<dim> about_x = Tensor<dim>::Identity();
  about_z.topLeftCorner(2, 2) = plane;
  about_x.bottomRightCorner(2, 2) = plane;
  return about_x * about_z;
}

/// Displacement on all sides but the bottom and the right one, which carries the exact traction.
template <int dim>
std::string affine_toml(const AffineCase<dim>& c, int p, const Point<dim>& right_normal)
{
  std::string toml = fmt::format(
      "degree = {}\nmaterial = {{ E = 1, nu = 0.3 }}\nnewton.tolerance = 1e-13\nboundary.bottom.contact = "
      "{}\n",
      p, c.contact);
  std::string displacement;
  std::string traction;
  const Point<dim> t = sigma<dim>(material, c.gradient) * right_normal;
  for (int a = 0; a < dim; ++a)
  {
    displacement += fmt::format("\"{:.17g}", c.offset[a]);
    for (int b = 0; b < dim; ++b) displacement += fmt::format(" + {:.17g}*{}", c.gradient(a, b), "xyz"[b]);
    displacement += "\", ";
    traction += fmt::format("{:.17g}, ", t[a]);
  }
  toml += fmt::format("boundary.right.traction = [{}]\n", traction);
  for (const char* side : {"left", "top", "back", "front"})
    if (dim == 3 || (side[0] != 'b' && side[0] != 'f'))
      toml += fmt::format("boundary.{}.displacement = [{}]\n", side, displacement);
  return toml;
}

/// max |u_h - u| / max |u| over the nodes.
template <int dim>
double displacement_error(const DiscreteCase<dim>& d, std::span<const double> u, const AffineCase<dim>& exact)
{
  double error = 0;
  double largest = 0;
  const std::vector<Point<dim>> nodes = d.space.node_points();
  for (Index i = 0; i < d.space.n_nodes(); ++i)
  {
    const Point<dim> value = exact.gradient * nodes[i] + exact.offset;
    const Eigen::Map<const Point<dim>> discrete(u.data() + dim * static_cast<std::size_t>(i));
    error = std::max(error, (discrete - value).norm());
    largest = std::max(largest, value.norm());
  }
  return error / largest;
}

template <int dim>
void expect_exact(const DiscreteCase<dim>& d, const AffineCase<dim>& exact, const Point<dim>& normal)
{
  constexpr double volume = 2;
  constexpr double contact_measure = 2;
  constexpr double tolerance = 1e-11;
  const NewtonResult<dim> newton = d.solve();
  ASSERT_EQ(newton.status, NewtonStatus::converged) << newton.message;
  const double error = displacement_error<dim>(d, newton.u, exact);
  fmt::print("{:<20} {:>5} dofs {:>3} steps   error {:.1e}\n", exact.name, d.space.n_dofs(),
             newton.steps.size(), error);
  EXPECT_LE(error, tolerance);

  const Tensor<dim> stress = sigma<dim>(material, exact.gradient);
  const StressNorms norms = stress_norms<dim>(d.problem, d.space, newton.u);
  const double energy = volume * stress.cwiseProduct(exact.gradient).sum();
  EXPECT_NEAR(norms.energy, energy, tolerance * energy);
  EXPECT_NEAR(norms.sigma, std::sqrt(volume) * stress.norm(), tolerance * stress.norm());

  const ContactResultants<dim> contact = contact_resultants<dim>(d.form, newton.traction);
  const Point<dim> force = contact_measure * stress * normal;
  EXPECT_LE((contact.force - force).norm(), tolerance * stress.norm());
  EXPECT_NEAR(contact.normal, force.dot(normal), tolerance * stress.norm());
  EXPECT_NEAR(contact.abs_tangential, (force - force.dot(normal) * normal).norm(), tolerance * stress.norm());

  const auto table = tabulate_on_facets<dim>(d.space.basis(), d.form.facet_rule().points);
  for (std::size_t k = 0; k < d.form.contact_facets().size(); ++k)
    for (const ContactState<dim>& state : d.form.contact_states(newton.u, static_cast<int>(k), table))
      EXPECT_EQ(state.status, exact.status) << "at " << state.point.transpose();
}

/// Runs `check(case, normal of the right side, normal of the bottom)` for every state.
template <int dim, class Check>
void for_all_states(const Tensor<dim>& frame, const Check& check)
{
  for (const AffineCase<dim>& c : affine_cases<dim>())
  {
    SCOPED_TRACE(c.name);
    check(turned<dim>(c, frame), Point<dim>(frame.col(0)), Point<dim>(-frame.col(1)));
  }
}

template <int dim>
MeshData<dim> structured()
{
  if constexpr (dim == 2)
    return box<2>({0, 0}, {2, 1}, {4, 2});
  else
    return box<3>({0, 0, 0}, {2, 1, 1}, {2, 2, 2});
}

template <int dim>
void structured_patch(int p)
{
  for_all_states<dim>(Tensor<dim>::Identity(),
                      [&](const AffineCase<dim>& c, const Point<dim>& right, const Point<dim>& bottom)
                      {
                        const DiscreteCase<dim> d(affine_toml<dim>(c, p, right), structured<dim>());
                        expect_exact<dim>(d, c, bottom);
                      });
}

/// Vertices and cells in random order, no side along an axis.
template <int dim>
void turned_patch(int p)
{
  const Tensor<dim> frame = rotation<dim>();
  const auto turn = [&](const Point<dim>& x) -> Point<dim> { return frame * x; };
  for_all_states<dim>(frame,
                      [&](const AffineCase<dim>& c, const Point<dim>& right, const Point<dim>& bottom)
                      {
                        MeshData<dim> mesh = renumbered<dim>(mapped<dim>(structured<dim>(), turn), 7);
                        const DiscreteCase<dim> d(affine_toml<dim>(c, p, right), std::move(mesh));
                        expect_exact<dim>(d, c, bottom);
                      });
}

template <int dim>
void unstructured_patch(int p)
{
  const std::string mesh = fmt::format("mesh.file = \"{}/box{}.geo\"\n", VERIFICATION_DATA, dim);
  for_all_states<dim>(Tensor<dim>::Identity(),
                      [&](const AffineCase<dim>& c, const Point<dim>& right, const Point<dim>& bottom)
                      {
                        const DiscreteCase<dim> d(mesh + affine_toml<dim>(c, p, right));
                        expect_exact<dim>(d, c, bottom);
                      });
}

class Patch : public ::testing::TestWithParam<int>
{
};

TEST_P(Patch, Structured2D)
{
  structured_patch<2>(GetParam());
}
TEST_P(Patch, Turned2D)
{
  turned_patch<2>(GetParam());
}
TEST_P(Patch, Unstructured2D)
{
  unstructured_patch<2>(GetParam());
}
TEST_P(Patch, Structured3D)
{
  structured_patch<3>(GetParam());
}
TEST_P(Patch, Turned3D)
{
  turned_patch<3>(GetParam());
}
TEST_P(Patch, Unstructured3D)
{
  unstructured_patch<3>(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Degrees, Patch, ::testing::Values(1, 2, 3, 4));

}  // namespace

}  // namespace tribound::test
