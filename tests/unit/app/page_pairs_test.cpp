#include "app/page/page_pairs.h"

#include <gtest/gtest.h>

#include <set>

#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/solve/newton.h"
#include "unit/app/two_blocks.h"

namespace tribound::test
{
namespace
{

struct SolvedBlocks : TwoBlocks<3>
{
  SolvedBlocks(int degree, int n) : TwoBlocks<3>(degree, n)
  {
    const solve::NewtonResult<3> newton =
        solve::solve<3>(form, {}, {}, {.method = algebra::LinearMethod::direct});
    u = newton.u;
    stress = certify::equilibrate<3>(form, newton.u, newton.traction);
  }

  std::vector<double> u;
  certify::Stress<3> stress;
};

Point<3> vertex(const app::Surface& surface, Index face, std::size_t place)
{
  return Point<3>(surface.points.data() +
                  3 * static_cast<std::size_t>(surface.faces[face * surface.n_face_points() + place]));
}

/// Corner c of triangle i, computed from the corners of its face.
Point<3> corner(const app::Surface& surface, const app::FaceParts& parts, std::size_t i, std::size_t c)
{
  const Index face = parts.faces[i];
  const Point<3> origin = vertex(surface, face, 0);
  const std::size_t second = surface.subdivision;
  const std::size_t third = surface.n_face_points() - 1;
  const std::array<double, 6> whole = {0, 0, 1, 0, 0, 1};
  const double* at = parts.corners.empty() ? whole.data() + 2 * c : parts.corners.data() + 6 * i + 2 * c;
  return origin + at[0] * (vertex(surface, face, second) - origin) +
         at[1] * (vertex(surface, face, third) - origin);
}

double area(const app::Surface& surface, const app::FaceParts& parts, std::size_t i)
{
  const Point<3> origin = corner(surface, parts, i, 0);
  return 0.5 *
         mesh::cross(corner(surface, parts, i, 1) - origin, corner(surface, parts, i, 2) - origin).norm();
}

/// Values are linear on each triangle.
double integral(const app::Surface& surface, const app::FaceParts& parts, const std::vector<double>& values)
{
  double sum = 0;
  for (std::size_t i = 0; i < parts.faces.size(); ++i)
    sum += area(surface, parts, i) * (values[3 * i] + values[3 * i + 1] + values[3 * i + 2]) / 3;
  return sum;
}

TEST(PagePairs, SegmentsLieOppositeEachOtherAndCarryTheForce)
{
  const SolvedBlocks blocks(1, 2);
  const app::Surface surface = app::sample_surface<3>(blocks.form, blocks.u, blocks.stress);
  const std::vector<app::PairSurface> pairs = app::sample_pairs(blocks.form, blocks.u, surface);
  ASSERT_EQ(pairs.size(), 1u);
  const app::PairSurface& pair = pairs[0];
  EXPECT_EQ(blocks.mesh.boundary_names()[pair.tag], "bottom");
  EXPECT_EQ(pair.slave.faces.size(), blocks.form.segments().size());
  const std::vector<double> ones(3 * pair.slave.faces.size(), 1.0);
  EXPECT_NEAR(integral(surface, pair.slave, ones), 2, 1e-12);
  EXPECT_NEAR(integral(surface, pair.master, ones), 2, 1e-12);
  for (std::size_t i = 0; i < pair.slave.faces.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_LE((corner(surface, pair.slave, i, c) - corner(surface, pair.master, i, c) -
                 Point<3>(0, TwoBlocks<3>::distance, 0))
                    .norm(),
                1e-12);
  const double force = -contact::contact_resultants<3>(blocks.form, blocks.form.traction(blocks.u)).normal;
  EXPECT_GT(force, 0.01);
  EXPECT_NEAR(integral(surface, pair.slave, pair.values.pressure), force, 1e-12);  // closed, no kinks
  for (const Index status : pair.values.status)
    EXPECT_EQ(status, static_cast<Index>(problem::ContactStatus::slip));
}

TEST(PagePairs, ManySegmentsBecomeMeansOverFacets)
{
  const SolvedBlocks blocks(1, 2);
  const app::Surface surface = app::sample_surface<3>(blocks.form, blocks.u, blocks.stress);
  const std::vector<app::PairSurface> pairs =
      app::sample_pairs(blocks.form, blocks.u, surface, {.segments = 10});
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].slave.faces.size(), 8u);
  EXPECT_TRUE(pairs[0].master.faces.empty());
  const double force = -contact::contact_resultants<3>(blocks.form, blocks.form.traction(blocks.u)).normal;
  EXPECT_NEAR(integral(surface, pairs[0].slave, pairs[0].values.pressure), force, 1e-12);
  EXPECT_TRUE(pairs[1].slave.faces.empty());
  // The slave covers no part of the triangles at two corners of the master.
  EXPECT_EQ(pairs[1].master.faces.size(), 16u);
  EXPECT_EQ(pairs[1].values.status.size(), 16u);
}

TEST(PagePairs, HigherDegreesHaveLattices)
{
  const SolvedBlocks blocks(2, 1);
  const app::Surface surface = app::sample_surface<3>(blocks.form, blocks.u, blocks.stress);
  const app::PairSurface pair = app::sample_pairs(blocks.form, blocks.u, surface)[0];
  EXPECT_EQ(pair.subdivision, 2);
  EXPECT_EQ(pair.values.pressure.size(), 6 * pair.slave.faces.size());
  EXPECT_EQ(pair.values.status.size(), 4 * pair.slave.faces.size());
}

TEST(PagePairs, InterfacesOfBodies)
{
  const TwoBlocks<3> blocks(1, 2);
  const std::vector<app::BodyInterface<3>> interfaces = app::body_interfaces(blocks.form);
  ASSERT_EQ(interfaces.size(), 1u);
  EXPECT_EQ(interfaces[0].bodies, (std::array<Index, 2>{0, 1}));
  EXPECT_NEAR(interfaces[0].measure, 2, 1e-12);
  EXPECT_LE((interfaces[0].normal - Point<3>(0, -1, 0)).norm(), 1e-12);
  EXPECT_NEAR(interfaces[0].axis[1], 0, 1e-12);
}

TEST(PagePairs, MergedDetailsKeepBodiesApart)
{
  const SolvedBlocks blocks(1, 5);
  const app::PageLimits limits{.subdivided = 0, .triangles = 150};
  const app::Surface surface = app::sample_surface<3>(blocks.form, blocks.u, blocks.stress, limits);
  EXPECT_GT(surface.merged_below, TwoBlocks<3>::distance);
  ASSERT_EQ(surface.bodies.size(), surface.n_faces());
  for (std::size_t face = 0; face < surface.n_faces(); ++face)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_EQ(vertex(surface, static_cast<Index>(face), c)[1] < -0.05, surface.bodies[face] == 1);
  std::size_t n = 0;
  for (const app::PairSurface& pair : app::sample_pairs(blocks.form, blocks.u, surface, limits))
    for (const app::FaceParts* side : {&pair.slave, &pair.master})
      for (const Index face : side->faces)
      {
        ++n;
        EXPECT_LT(face, static_cast<Index>(surface.n_faces()));
      }
  EXPECT_GT(n, 0u);
}

}  // namespace
}  // namespace tribound::test
