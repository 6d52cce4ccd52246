#include "app/page/judgement_page.h"

#include <gtest/gtest.h>

#include <vector>

#include "tribound/mesh/bisect.h"
#include "unit/app/packed_array.h"
#include "unit/io/constant_stress.h"

namespace tribound::test
{
namespace
{

using nlohmann::json;

/// Both solutions are the same linear function, ours on a mesh with a part of the cells bisected twice.
template <int dim>
struct SameSolutions
{
  SameSolutions()
  {
    theirs.u = interpolate(box.space, constant_stress_displacement<dim>);
    theirs.degree = box.space.degree();
    u = interpolate(space, constant_stress_displacement<dim>);
    judgement.displacement.cells.assign(box.mesh.n_cells(), 1.0);
    judgement.displacement.cells[3] = 4;
    judgement.displacement.cells[5] = 2;
    judgement.displacement.core.n_cells = 2;
    judgement.displacement.halving = {3};
  }

  json surfaces() const { return app::judged_surfaces<dim>(box.form, theirs, judgement, space, u); }

  const DiscreteProblem<dim> box = constant_stress_problem<dim>(1, 2);
  const mesh::Mesh<dim> fine = mesh::bisect<dim>(mesh::bisect<dim>(box.mesh, {{0, 3}}).mesh, {{1, 4}}).mesh;
  const fem::LagrangeSpace<dim> space{fine, 2};
  certify::ForeignSolution<dim> theirs{};
  std::vector<double> u{};
  certify::Judgement judgement{};
};

/// Numbers, on the page as quantised.
void expect_near(const json& packed, const std::vector<double>& expected, double tolerance)
{
  const std::vector<double> values = unpack(packed);
  ASSERT_EQ(values.size(), expected.size());
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(values[i], expected[i], tolerance) << i;
}

template <int dim>
void expect_the_same(const json& surfaces)
{
  const json& theirs = surfaces["theirs"];
  const json& ours = surfaces["ours"];
  EXPECT_EQ(theirs["faces"], ours["faces"]);
  EXPECT_EQ(theirs["points"], ours["points"]);
  EXPECT_EQ(theirs["subdivision"], 4);
  expect_near(ours["displacement"], unpack(theirs["displacement"]), 1e-5);
  for (std::size_t i = 0; i < theirs["stress"].size(); ++i)
    expect_near(ours["stress"][i], unpack(theirs["stress"][i]), 1e-4);
}

TEST(JudgedSurfaces, OursOnTheirMeshIn2D)
{
  const SameSolutions<2> same;
  const json surfaces = same.surfaces();
  expect_the_same<2>(surfaces);
  EXPECT_NEAR(unpack(surfaces["ours"]["stress"][0])[0], constant_stress<2>()[0], 1e-4);
  EXPECT_EQ(surfaces["contact_faces"], 0);
  EXPECT_FALSE(surfaces.contains("stress_distance"));
}

TEST(JudgedSurfaces, OursOnTheirMeshIn3D)
{
  const json surfaces = SameSolutions<3>().surfaces();
  expect_the_same<3>(surfaces);
  EXPECT_EQ(surfaces["contact_faces"], 8);
}

TEST(JudgedSurfaces, CellsOfTheCoreAndThoseToBeRefined)
{
  const json surfaces = SameSolutions<2>().surfaces();
  std::vector<double> places(8, 0);
  places[3] = 2;
  places[5] = 1;
  expect_near(surfaces["place"], places, 0);
  std::vector<double> distances(8, 1);
  distances[3] = 4;
  distances[5] = 2;
  expect_near(surfaces["distance"], distances, 0.02);
}

TEST(JudgedSurfaces, TheStressThatWasReadIsShown)
{
  SameSolutions<2> same;
  same.theirs.stress.assign(3 * static_cast<std::size_t>(same.box.mesh.n_cells()), Tensor<2>{{1, 3}, {3, 2}});
  same.judgement.stress.emplace().cells.assign(same.box.mesh.n_cells(), 0.5);
  const json surfaces = same.surfaces();
  for (std::size_t i = 0; i < 3; ++i)
    for (const double value : unpack(surfaces["theirs"]["stress"][i]))
      EXPECT_NEAR(value, static_cast<double>(i + 1), 1e-3);
  EXPECT_TRUE(surfaces.contains("stress_distance"));
}

}  // namespace
}  // namespace tribound::test
