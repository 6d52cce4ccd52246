#include "app/page/page_surface.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tribound/io/fields/vtu.h"
#include "unit/io/constant_stress.h"

namespace tribound::test
{
namespace
{

/// The three coordinates of vertex v.
Point<3> position(const app::Surface& surface, int dim, Index v)
{
  Point<3> x = Point<3>::Zero();
  for (int i = 0; i < dim; ++i) x[i] = surface.points[dim * v + i];
  return x;
}

/// Area times normal of triangle a, b, c of a face: half the cross product.
Point<3> area_vector(const app::Surface& surface, int dim, std::size_t face, int a, int b, int c)
{
  const Index* v = surface.faces.data() + face * surface.n_face_points();
  const Point<3> x = position(surface, dim, v[a]);
  return 0.5 * mesh::cross(position(surface, dim, v[b]) - x, position(surface, dim, v[c]) - x);
}

/// Area times normal of the whole face, from its corners.
Point<3> area_vector(const app::Surface& surface, int dim, std::size_t face)
{
  return area_vector(surface, dim, face, 0, surface.subdivision,
                     static_cast<int>(surface.n_face_points()) - 1);
}

template <int dim>
void expect_exact_values(const app::Surface& surface)
{
  const auto [xx, yy, zz] = constant_stress<dim>();
  const std::array<double, 6> sigma = {xx, yy, zz, 0, 0, 0};
  ASSERT_EQ(surface.stress.size(), dim == 2 ? 3u : 6u);
  for (std::size_t i = 0; i < surface.stress.size(); ++i)
    for (const double value : surface.stress[i])
      EXPECT_NEAR(value, sigma[app::stress_entries<dim>[i]], 1e-10);
  for (std::size_t v = 0; v < surface.points.size() / dim; ++v)
  {
    const Point<dim> u = constant_stress_displacement<dim>(Point<dim>(surface.points.data() + dim * v));
    for (int i = 0; i < dim; ++i) EXPECT_NEAR(surface.displacement[dim * v + i], u[i], 1e-14);
  }
}

TEST(PageSurface, CellsIn2D)
{
  for (const int degree : {1, 2, 3})
  {
    const DiscreteProblem<2> box = constant_stress_problem<2>(degree, 3);
    const adapt::CertifiedLevel<2> level = constant_stress_level(box);
    const app::Surface surface = app::sample_surface<2>(box.form, level.u, level.stress);
    EXPECT_EQ(surface.subdivision, degree);
    EXPECT_EQ(surface.n_faces(), 18u);
    EXPECT_EQ(surface.points.size() / 2, (3u * degree + 1) * (3 * degree + 1));
    EXPECT_EQ(surface.stress[0].size(), 18 * surface.n_face_points());
    double area = 0;
    for (std::size_t face = 0; face < surface.n_faces(); ++face)
    {
      const Point<3> vector = area_vector(surface, 2, face);
      EXPECT_GT(vector[2], 0.0);
      area += vector[2];
    }
    EXPECT_NEAR(area, 2.0, 1e-14);
    expect_exact_values<2>(surface);
  }
}

TEST(PageSurface, BoundaryFacetsIn3DLookOutwards)
{
  for (const int degree : {1, 2})
  {
    const DiscreteProblem<3> box = constant_stress_problem<3>(degree, 2);
    const adapt::CertifiedLevel<3> level = constant_stress_level(box);
    const app::Surface surface = app::sample_surface<3>(box.form, level.u, level.stress);
    EXPECT_EQ(surface.n_faces(), 48u);
    double area = 0;
    for (std::size_t face = 0; face < surface.n_faces(); ++face)
    {
      const Point<3> vector = area_vector(surface, 3, face);
      const Point<3> outwards =
          position(surface, 3, surface.faces[face * surface.n_face_points()]) - Point<3>(1.0, 0.5, 0.5);
      EXPECT_GT(vector.dot(outwards), 0.0);
      area += vector.norm();
    }
    EXPECT_NEAR(area, 10.0, 1e-13);
    expect_exact_values<3>(surface);
  }
}

TEST(PageSurface, ContactFacesComeFirst)
{
  const DiscreteProblem<3> box = constant_stress_problem<3>(2, 2);
  const adapt::CertifiedLevel<3> level = constant_stress_level(box);
  const app::Surface surface = app::sample_surface<3>(box.form, level.u, level.stress);
  const app::SurfaceContact& contact = surface.contact;
  const std::size_t n_points = 8 * surface.n_face_points();
  ASSERT_EQ(contact.pressure.size(), n_points);
  ASSERT_EQ(contact.status.size(), 8u * 4);
  for (std::size_t i = 0; i < n_points; ++i)
  {
    EXPECT_NEAR(contact.pressure[i], -constant_stress<3>()[2], 1e-12);
    EXPECT_NEAR(contact.friction[i], 0.0, 1e-12);
    EXPECT_EQ(contact.limit[i], 0.0);
    EXPECT_NEAR(contact.gap[i], 0.0, 1e-14);
    const Point<3> x = position(surface, 3, surface.faces[i]);
    EXPECT_NEAR(x[2], 0.0, 1e-14);
    EXPECT_NEAR(contact.slip[i], 0.1 * std::hypot(x[0], x[1]), 1e-14);
  }
  for (const Index status : contact.status)
    EXPECT_EQ(status, static_cast<Index>(problem::ContactStatus::slip));
}

TEST(PageSurface, LargeMeshesAreNotSubdivided)
{
  const DiscreteProblem<2> box = constant_stress_problem<2>(3, 3);
  const adapt::CertifiedLevel<2> level = constant_stress_level(box);
  EXPECT_EQ(app::sample_surface<2>(box.form, level.u, level.stress, {.subdivided = 18 * 4}).subdivision, 2);
  EXPECT_EQ(app::sample_surface<2>(box.form, level.u, level.stress, {.subdivided = 18 * 4 - 1}).subdivision,
            1);
}

TEST(PageSurface, LargeMeshesHaveOneStressPerFace)
{
  const DiscreteProblem<2> box = constant_stress_problem<2>(1, 40);
  const adapt::CertifiedLevel<2> level = constant_stress_level(box);
  for (const std::size_t limit : {100'000u, 1000u})
  {
    const app::Surface surface = app::sample_surface<2>(
        box.form, level.u, level.stress, {.subdivided = 0, .triangles = limit, .stresses = 3000});
    EXPECT_EQ(surface.stress[0].size(), surface.n_faces());
    expect_exact_values<2>(surface);
  }
}

TEST(PageSurface, DetailsOfVeryLargeMeshesAreMerged)
{
  const DiscreteProblem<2> box = constant_stress_problem<2>(1, 40);
  const adapt::CertifiedLevel<2> level = constant_stress_level(box);
  const std::size_t limit = 1000;
  const app::Surface surface =
      app::sample_surface<2>(box.form, level.u, level.stress, {.subdivided = 0, .triangles = limit});
  EXPECT_LE(surface.n_triangles(), limit);
  EXPECT_GT(surface.n_triangles(), limit / 4);
  EXPECT_GT(surface.merged_below, 0.01);
  EXPECT_LT(surface.merged_below, 0.2);
  EXPECT_EQ(surface.faces.size(), 3 * surface.n_faces());
  EXPECT_EQ(surface.stress[0].size(), 3 * surface.n_faces());
  for (const Index v : surface.faces) EXPECT_LT(v, static_cast<Index>(surface.points.size() / 2));
  expect_exact_values<2>(surface);
  double area = 0;
  for (std::size_t face = 0; face < surface.n_faces(); ++face) area += area_vector(surface, 2, face)[2];
  EXPECT_NEAR(area, 2.0, 0.3);
}

TEST(PageSurface, MergingIn3DKeepsContactBesideItsFaces)
{
  const DiscreteProblem<3> box = constant_stress_problem<3>(1, 6);
  const adapt::CertifiedLevel<3> level = constant_stress_level(box);
  const app::Surface surface =
      app::sample_surface<3>(box.form, level.u, level.stress, {.subdivided = 0, .triangles = 200});
  const std::size_t n_contact = surface.contact.status.size();
  EXPECT_LE(surface.n_triangles(), 200u);
  EXPECT_GT(n_contact, 0u);
  EXPECT_EQ(surface.contact.gap.size(), 3 * n_contact);
  EXPECT_EQ(surface.contact.point_status.size(), 3 * n_contact);
  for (std::size_t i = 0; i < 3 * n_contact; ++i)
    EXPECT_LT(position(surface, 3, surface.faces[i])[2], surface.merged_below);
}

}  // namespace
}  // namespace tribound::test
