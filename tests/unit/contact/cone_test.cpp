/// @file cone_test.cpp
/// The projection of a vector onto the polar of a cone, by its defining properties.

#include "tribound/contact/support/cone.h"

#include <gtest/gtest.h>

#include <random>

namespace tribound::test
{

namespace
{

Eigen::MatrixXd random_matrix(int rows, int cols, std::mt19937& random)
{
  std::normal_distribution<double> normal;
  Eigen::MatrixXd matrix(rows, cols);
  for (double& x : matrix.reshaped()) x = normal(random);
  return matrix;
}

TEST(Cone, NoColumnsLeaveEverything)
{
  const Eigen::VectorXd b = Eigen::Vector3d(1, 2, 3);
  EXPECT_EQ(contact::project_on_polar_cone(Eigen::MatrixXd(3, 0), b), b);
}

TEST(Cone, Quadrant)
{
  const Eigen::MatrixXd axes = Eigen::MatrixXd::Identity(2, 2);
  EXPECT_LE(contact::project_on_polar_cone(axes, Eigen::Vector2d(3, 4)).norm(), 1e-15);
  EXPECT_LE((contact::project_on_polar_cone(axes, Eigen::Vector2d(3, -4)) - Eigen::Vector2d(0, -4)).norm(),
            1e-15);
  EXPECT_EQ(contact::project_on_polar_cone(axes, Eigen::Vector2d(-3, -4)), Eigen::Vector2d(-3, -4));
}

TEST(Cone, ProjectionIsPolarToTheConeAndPerpendicularToWhatItRemoves)
{
  std::mt19937 random(1);
  for (int rows = 1; rows <= 6; ++rows)
    for (int trial = 0; trial < 50; ++trial)
    {
      Eigen::MatrixXd columns = random_matrix(rows, 3 + trial * 10, random);
      columns.row(0) = columns.row(0).cwiseAbs();  // a pointed cone in a half space
      const Eigen::VectorXd b = random_matrix(rows, 1, random);
      const Eigen::VectorXd r = contact::project_on_polar_cone(columns, b);
      EXPECT_LE((columns.transpose() * r).maxCoeff(), 1e-9 * b.norm());
      EXPECT_NEAR(r.dot(b), r.squaredNorm(), 1e-12 * b.squaredNorm());
    }
}

TEST(Cone, CombinationsAreInside)
{
  std::mt19937 random(2);
  for (int trial = 0; trial < 50; ++trial)
  {
    const Eigen::MatrixXd columns = random_matrix(6, 4 + trial, random);
    const Eigen::VectorXd b = columns * random_matrix(4 + trial, 1, random).cwiseAbs();
    EXPECT_LE(contact::project_on_polar_cone(columns, b).norm(), 1e-9 * b.norm());
  }
}

TEST(Cone, RepeatedColumnsDoNoHarm)
{
  const Eigen::MatrixXd columns = Eigen::Vector2d(1, 1).replicate(1, 1000);
  EXPECT_LE((contact::project_on_polar_cone(columns, Eigen::Vector2d(2, 0)) - Eigen::Vector2d(1, -1)).norm(),
            1e-14);
}

}  // namespace

}  // namespace tribound::test
