/// @file rigid_motion_assembly_test.cpp
/// Rigid motions of bodies joined by pairs, and the balance of their loads.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tribound/base/dense_factors.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/contact/support/support.h"
#include "unit/contact/rigid_motion_testing.h"

namespace tribound::test::rigid_motion_assembly_cases
{

namespace
{

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// (0.4, 1.6) x (1, 2) on (0, 2) x (0, 1); in 3D the depth is 1.
template <int dim>
mesh::MeshData<dim> two_blocks()
{
  const auto low = components<dim>(0.4, 1.0, 0.0);
  const auto up = components<dim>(1.6, 2.0, 1.0);
  const auto cells = []
  {
    if constexpr (dim == 2)
      return std::array{2, 1};
    else
      return std::array{1, 1, 1};
  }();
  mesh::MeshData<dim> data = side_by_side(
      block<dim>({3, 1}, {2, 1, 1}), box<dim>(Point<dim>(low.data()), Point<dim>(up.data()), cells), "_up");
  data.interfaces = {{{{{"bottom_up"}, {"top"}}}}};
  return data;
}

/// A third block above the upper one, of the same size.
mesh::MeshData<2> three_blocks()
{
  return side_by_side(two_blocks<2>(), box<2>({0.4, 2.2}, {1.6, 3.2}, {1, 2}), "_top");
}

template <int dim>
std::string verdict(const mesh::MeshData<dim>& mesh, const ProblemData<dim>& data)
{
  const DiscreteProblem<dim> c(mesh, data);
  return verdict<dim>(c, c.form.load());
}

template <int dim>
problem::ContactPair<dim> interface(problem::ContactLaw law)
{
  return pair<dim>("bottom_up", "top", std::move(law));
}

TEST(RigidMotionOfAssemblies, ClosedContactHoldsWithFriction)
{
  const auto on_clamped = [](const problem::ContactLaw& law) {
    return verdict<2>(two_blocks<2>(), {.boundaries = {clamped<2>("bottom")}, .pairs = {interface<2>(law)}});
  };
  EXPECT_THAT(on_clamped(Frictionless()),
              AllOf(HasSubstr("nothing stops the body around (1, 0.5) (region \"box\"), the body around (1, "
                              "1.5) (region \"box_up\") in contact from: translation along x of the body "
                              "around (1, 1.5) (region \"box_up\")\n"),
                    HasSubstr("or give its contact friction")));
  EXPECT_EQ(on_clamped(Coulomb(0)), on_clamped(Frictionless()));
  EXPECT_EQ(on_clamped(Coulomb(0.1)), "held");
  EXPECT_EQ(on_clamped(Tresca(0.1)), "held");
  EXPECT_EQ(on_clamped(Tied()), "held");
}

TEST(RigidMotionOfAssemblies, BodiesThatNothingHoldsMoveTogether)
{
  const auto alone = [](const problem::ContactLaw& law)
  { return verdict<2>(two_blocks<2>(), {.pairs = {interface<2>(law)}}); };
  const std::string together = "from: translation along x; translation along y; rotation about (1, 0.9286)";
  EXPECT_THAT(alone(Tied()), AllOf(HasSubstr(together + "\n"), Not(HasSubstr("friction"))));
  EXPECT_THAT(
      alone(Frictionless()),
      HasSubstr(together + "; translation along x of the body around (1, 1.5) (region \"box_up\")\n"));
}

TEST(RigidMotionOfAssemblies, ABodyInNoPairStandsAlone)
{
  EXPECT_THAT(
      verdict<2>(three_blocks(), {.boundaries = {clamped<2>("bottom")}, .pairs = {interface<2>(Tied())}}),
      HasSubstr("nothing stops the body around (1, 2.7) (region \"box_top\") from: translation"));
}

/// The number of motions that closed and sticking contact leaves free, and the number of zero singular values
/// of the matrix of the first Newton step.
template <int dim>
std::pair<int, int> free_motions(const mesh::MeshData<dim>& mesh, const ProblemData<dim>& data)
{
  const DiscreteProblem<dim> c(mesh, data);
  int motions = 0;
  for (const contact::Assembly<dim>& assembly : contact::find_assemblies<dim>(c.space, c.form.segments()))
    motions += static_cast<int>(
        contact::Support<dim>(c.problem, c.mesh, c.form.segments(), assembly).left_by_contact(true).cols());

  const int n = c.space.n_dofs();
  const std::vector<double> zero(n, 0.0);
  const auto image = [&](const std::vector<double>& w)
  {
    std::vector<double> result(n, 0.0);
    c.form.add_contact_load(c.form.linearised_traction(contact::Linearisation::closed_sticking, zero, w),
                            result);
    const std::vector<double> elastic = contact::apply_stiffness<dim>(c.problem, c.space, w);
    for (int i = 0; i < n; ++i) result[i] = elastic[i] - result[i];
    return result;
  };
  const std::vector<double> at_zero = image(zero);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n);
  for (int j = 0; j < n; ++j)
  {
    if (c.form.constraints().fixed[j]) continue;
    std::vector<double> w = zero;
    w[j] = 1;
    const std::vector<double> column = image(w);
    for (int i = 0; i < n; ++i)
      if (!c.form.constraints().fixed[i]) matrix(i, j) = column[i] - at_zero[i];
  }
  const Eigen::VectorXd values = right_singular(matrix).values;
  return {motions, static_cast<int>((values.array() < 1e-11 * values[0]).count())};
}

/// The kernel of the first matrix is found without knowledge of rigid motions. Frictionless contact does not
/// stick in that matrix.
TEST(RigidMotionOfAssemblies, WhatIsFreeIsTheKernelOfTheFirstMatrix)
{
  const auto agree = [](const auto& mesh, const auto& data, int expected)
  {
    const auto [motions, kernel] = free_motions(mesh, data);
    EXPECT_EQ(motions, expected);
    EXPECT_EQ(kernel, expected);
  };
  using Data = ProblemData<2>;
  const auto top = pair<2>("bottom_top", "top_up", Coulomb(0.1));
  const auto smooth_top = pair<2>("bottom_top", "top_up");
  agree(two_blocks<2>(), Data{.boundaries = {clamped<2>("bottom")}, .pairs = {interface<2>(Frictionless())}},
        1);
  agree(two_blocks<2>(), Data{.boundaries = {clamped<2>("bottom")}, .pairs = {interface<2>(Tied())}}, 0);
  agree(two_blocks<2>(), Data{.pairs = {interface<2>(Coulomb(0.1))}}, 3);
  agree(two_blocks<2>(), Data{.boundaries = {obstacle<2>("bottom")}, .pairs = {interface<2>(Tied())}}, 1);
  agree(two_blocks<2>(), Data{.boundaries = {obstacle<2>("bottom")}, .pairs = {interface<2>(Frictionless())}},
        2);
  agree(three_blocks(), Data{.boundaries = {clamped<2>("bottom")}, .pairs = {interface<2>(Tied()), top}}, 0);
  agree(three_blocks(),
        Data{.boundaries = {clamped<2>("top_top")}, .pairs = {interface<2>(Frictionless()), smooth_top}}, 2);
  agree(three_blocks(),
        Data{.boundaries = {fixed<2>("bottom", free, 0)}, .pairs = {interface<2>(Frictionless()), top}}, 2);
  agree(two_blocks<3>(),
        ProblemData<3>{.boundaries = {clamped<3>("bottom")}, .pairs = {interface<3>(Frictionless())}}, 3);
  agree(two_blocks<3>(),
        ProblemData<3>{.boundaries = {fixed<3>("bottom", free, 0, free)}, .pairs = {interface<3>(Tresca(1))}},
        3);
}

/// A load on the upper block passes through the lower one, which lies on the floor.
TEST(RigidMotionOfAssemblies, ContactPassesPressureOnButNoTension)
{
  const auto loaded_by = [](double x, double y, const problem::ContactLaw& law)
  {
    return verdict<2>(two_blocks<2>(),
                      {.boundaries = {loaded<2>("top_up", x, y), obstacle<2>("bottom", Coulomb(0.5))},
                       .pairs = {interface<2>(law)}});
  };
  EXPECT_EQ(loaded_by(0, -1, Coulomb(0.2)), "held");
  EXPECT_EQ(loaded_by(0.199, -1, Coulomb(0.2)), "held");
  EXPECT_THAT(loaded_by(0.201, -1, Coulomb(0.2)),
              AllOf(HasSubstr("contact cannot hold the body around (1, 0.5)"), HasSubstr("drive it into "),
                    HasSubstr("translation along x of the body around (1, 1.5) (region \"box_up\"); friction "
                              "is too weak")));
  EXPECT_THAT(loaded_by(0, 1, Coulomb(0.2)), HasSubstr("contact only pushes"));
  EXPECT_THAT(loaded_by(0, 1, Tied()), HasSubstr("translation along y; contact only pushes"));
  EXPECT_EQ(loaded_by(0.3, -1, Tied()), "held");
  EXPECT_EQ(loaded_by(0.0999, -1, Tresca(0.1)), "held");
  EXPECT_THAT(loaded_by(0.101, -1, Tresca(0.1)), HasSubstr("the friction threshold takes up only 99 % of"));
}

/// A lateral load at the top tips the whole stack before it tips the upper block.
TEST(RigidMotionOfAssemblies, MomentsActThroughTheWholeStack)
{
  const auto pushed = [](double x, const problem::ContactLaw& law)
  {
    return verdict<2>(two_blocks<2>(),
                      {.boundaries = {loaded<2>("top_up", x, -1), obstacle<2>("bottom", Coulomb(5))},
                       .pairs = {interface<2>(law)}});
  };
  // resultant (x, -1) at (1, 2): about the right end (2, 0) of the floor; about (1.6, 1) from 0.6 on
  EXPECT_EQ(pushed(0.4995, Tied()), "held");
  EXPECT_THAT(pushed(0.5005, Tied()), HasSubstr("drive it into rotation about (2, 0); contact only"));
  EXPECT_EQ(pushed(0.4995, Coulomb(5)), "held");
  EXPECT_THAT(pushed(0.5005, Coulomb(5)), HasSubstr("contact only pushes"));
}

/// A tie across a distance keeps the points opposite each other: bodies turn about centres as far apart.
TEST(RigidMotionOfAssemblies, ATieAcrossADistanceIsNoBond)
{
  const std::string said = verdict<2>(three_blocks(), {.boundaries = {clamped<2>("bottom")},
                                                       .pairs = {pair<2>("bottom_top", "top_up", Tied())}});
  EXPECT_THAT(
      said,
      HasSubstr("rotation about (1, 2.1) of the body around (1, 1.5) (region \"box_up\") with rotation about "
                "(1, 2.3) of the body around (1, 2.7) (region \"box_top\")"));
}

TEST(RigidMotionOfAssemblies, In3D)
{
  const auto pushed = [](double x, const problem::ContactLaw& law)
  {
    return verdict<3>(two_blocks<3>(), {.boundaries = {loaded<3>("top_up", x, -1, 0), clamped<3>("bottom")},
                                        .pairs = {interface<3>(law)}});
  };
  EXPECT_EQ(pushed(0.599, Coulomb(1)), "held");
  EXPECT_THAT(pushed(0.601, Coulomb(1)),
              HasSubstr("drive it into rotation about the axis through (1.6, 1, 0.5) along (0, 0, -1)"));
  EXPECT_THAT(pushed(0.12, Coulomb(0.1)), HasSubstr("friction is too weak"));
  EXPECT_THAT(pushed(0.12, Frictionless()), HasSubstr("nothing stops"));
  EXPECT_EQ(pushed(3, Tied()), "held");
}

}  // namespace

}  // namespace tribound::test::rigid_motion_assembly_cases
