/// @file repeated_shapes_test.cpp
/// The equilibrated stress when cells and patches share data that depend only on their shape: the identities,
/// and the stress on a mesh whose change is far above rounding but far too small to matter.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/equilibrate/repeated_patches.h"
#include "tribound/certify/equilibrate/repeated_shapes.h"

namespace tribound::test
{

namespace
{

template <int dim>
DiscreteProblem<dim> on_floor(mesh::MeshData<dim> mesh, int degree)
{
  return {std::move(mesh),
          {.boundaries = {clamped<dim>("left"), loaded<dim>("top", 0, formula("-0.1*exp(x)"), 0.01),
                          obstacle<dim>("bottom", Tresca(0.02))}},
          {.degree = degree}};
}

/// Every shape occurs more often than RepeatedShapes requires.
template <int dim>
mesh::MeshData<dim> regular_box()
{
  if constexpr (dim == 2)
    return box<2>({0, 0}, {1.4, 0.7}, {24, 12});
  else
    return box<3>({0, 0, 0}, {1.4, 0.7, 0.7}, {6, 5, 5});
}

/// Moves the interior by `amplitude`.
template <int dim>
mesh::MeshData<dim> distorted_box(double amplitude)
{
  mesh::MeshData<dim> data = regular_box<dim>();
  for (Point<dim>& x : data.vertices)
  {
    double bubble = std::sin(std::numbers::pi * x[0] / 1.4);
    for (int c = 1; c < dim; ++c) bubble *= std::sin(std::numbers::pi * x[c] / 0.7);
    for (int c = 0; c < dim; ++c) x[c] += amplitude * bubble * std::cos(7 * x[0] + 5 * x[1] + c);
  }
  return data;
}

template <int dim, int p>
void expect_same_stress()
{
  const DiscreteProblem<dim> straight = on_floor(regular_box<dim>(), p);
  const DiscreteProblem<dim> distorted = on_floor(distorted_box<dim>(1e-8), p);
  const certify::RepeatedShapes<certify::CellOperator<dim, p>> shared(straight.mesh);
  const certify::RepeatedShapes<certify::CellOperator<dim, p>> own(distorted.mesh);
  int n_shared = 0;
  int n_own = 0;
  for (Index c = 0; c < straight.mesh.n_cells(); ++c)
  {
    n_shared += shared.find(c) != nullptr;
    n_own += own.find(c) == nullptr;
  }
  EXPECT_GT(n_shared, straight.mesh.n_cells() * 9 / 10);
  EXPECT_EQ(n_own, straight.mesh.n_cells());

  const solve::NewtonResult<dim> result = straight.solve();
  for (const certify::PatchStress patches : {certify::PatchStress::rows, certify::PatchStress::afw})
  {
    const auto equilibrated = [&](const DiscreteProblem<dim>& c)
    { return certify::equilibrate<dim>(c.form, result.u, result.traction, 0, 0, patches); };
    const certify::Stress<dim> stress = equilibrated(straight);
    const certify::IdentityDefects defects =
        certify::check_identities<dim>(straight.form, result.traction, stress);
    EXPECT_LE(defects.largest(), p <= 2 ? 1e-11 : 1e-10);
    // Factors of patches that repeat are those of the first ones on the thread.
    for (const int n_threads : {2, 3})
      EXPECT_EQ(
          certify::equilibrate<dim>(straight.form, result.u, result.traction, n_threads, 0, patches).dis,
          certify::equilibrate<dim>(straight.form, result.u, result.traction, 1, 0, patches).dis)
          << certify::to_string(patches);

    const certify::Stress<dim> other = equilibrated(distorted);
    double norm = 0;
    double difference = 0;
    for (std::size_t i = 0; i < stress.dis.size(); ++i)
    {
      norm = std::hypot(norm, stress.dis[i]);
      difference = std::hypot(difference, stress.dis[i] - other.dis[i]);
    }
    EXPECT_LE(difference, 1e-5 * norm) << certify::to_string(patches);
  }
}

/// Stands for factors of which two need more memory than there is.
struct LargeFactors
{
  int number = 0;

  void trim() {}
  [[nodiscard]] std::size_t bytes() const { return std::size_t{40} << 20; }
};

}  // namespace

TEST(RepeatedPatches, KeepsWhatComesTwiceWhileThereIsMemory)
{
  certify::RepeatedPatches<LargeFactors> repeated;
  const certify::PatchKey first{1, 2};
  const certify::PatchKey second{2, 1};
  const auto keep = [&](const certify::PatchKey& key, int number)
  {
    LargeFactors factors{number};
    return repeated.keep(key, factors)->number;
  };
  EXPECT_EQ(keep({}, 7), 7);  // not compared
  EXPECT_EQ(keep({}, 7), 7);
  EXPECT_EQ(repeated.find({}), nullptr);
  EXPECT_EQ(keep(first, 1), 1);
  EXPECT_EQ(repeated.find(first), nullptr);
  EXPECT_EQ(keep(first, 1), 1);
  ASSERT_NE(repeated.find(first), nullptr);
  EXPECT_EQ(repeated.find(first)->number, 1);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(keep(second, 2), 2);
  EXPECT_EQ(repeated.find(second), nullptr);
}

TEST(RepeatedShapes, GiveTheSameStressIn2D)
{
  expect_same_stress<2, 1>();
  expect_same_stress<2, 2>();
  expect_same_stress<2, 3>();
  expect_same_stress<2, 4>();
}

TEST(RepeatedShapes, GiveTheSameStressIn3D)
{
  expect_same_stress<3, 1>();
  expect_same_stress<3, 2>();
}

}  // namespace tribound::test
