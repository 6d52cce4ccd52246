#include "tribound/problem/problem.h"
#include "tribound/case/resolve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "support/input_error.h"

namespace tribound
{
namespace
{

using testing::HasSubstr;
using Names = std::vector<std::string>;

const std::string file_head = "[mesh]\nfile = 'a.msh'\n[material]\nE = 1\nnu = 0.25\n";
const Names regions = {"rubber", "steel"};
const Names sides = {"left", "top", "bottom"};

template <int dim = 2>
problem::Problem<dim> problem(const std::string& text, const Names& region_names = regions,
                              const Names& boundary_names = sides)
{
  return case_file::resolve<dim>(case_file::parse_config(text, "case.toml"), region_names, boundary_names);
}

template <int dim = 2>
std::string message(const std::string& text, const Names& region_names = regions,
                    const Names& boundary_names = sides)
{
  return test::message_of([&] { (void)problem<dim>(text, region_names, boundary_names); });
}

TEST(CaseFacts, AreThoseOfTheCase)
{
  const case_file::Config config = case_file::parse_config(
      file_head + "[boundary.bottom]\ncontact = { friction = 'tresca', threshold = 0.03 }\n", "case.toml",
      std::array<std::string, 2>{"title=Block", "degree=2"});
  const io::CaseFacts facts = case_file::case_facts(config, 2);
  EXPECT_EQ(facts.title, "Block");
  EXPECT_EQ(facts.friction, "tresca");
  EXPECT_EQ(facts.gamma0, 10.0);
}

TEST(CaseFacts, HaveTheUnitOfEveryQuantity)
{
  const std::string quantities =
      "[[quantity]]\nkind = 'energy'\n[[quantity]]\nkind = 'load_work'\n"
      "[[quantity]]\nkind = 'contact_force'\ndirection = [0, 1]\n[[quantity]]\nkind = 'contact_moment'\n"
      "[[quantity]]\nkind = 'safety_factor'\nboundary = 'top'\n"
      "[[quantity]]\nkind = 'mean_displacement'\nboundary = 'top'\n"
      "[[quantity]]\nkind = 'spring_force'\nboundary = 'top'\n";
  const auto units_of = [&](const std::string& units, int dimension)
  {
    std::vector<std::string> labels;
    const case_file::Config config = case_file::parse_config(file_head + units + quantities);
    for (const auto& [name, unit] : case_file::case_facts(config, dimension).quantity_units)
      labels.push_back(name + ": " + unit);
    return labels;
  };
  EXPECT_THAT(
      units_of("[units]\nlength = 'mm'\nforce = 'N'\n", 3),
      testing::ElementsAre("energy: N mm", "load_work: N mm", "contact_force: N", "contact_moment: N mm",
                           "safety_factor top: ", "mean_displacement top: mm", "spring_force top: N"));
  EXPECT_THAT(units_of("[units]\nlength = 'm'\nforce = 'kN'\n", 2),
              testing::ElementsAre(
                  "energy: kN m/m", "load_work: kN m/m", "contact_force: kN/m", "contact_moment: kN m/m",
                  "safety_factor top: ", "mean_displacement top: m", "spring_force top: kN/m"));
  EXPECT_THAT(units_of("", 2), testing::Contains("energy: "));
  const case_file::Config ring = case_file::parse_config(
      "model = 'axisymmetric'\n" + file_head + "[units]\nlength = 'm'\nforce = 'kN'\n" +
      "[[quantity]]\nkind = 'contact_force'\nboundary = 'top'\n");
  EXPECT_EQ(case_file::case_facts(ring, 2).quantity_units.at(0).second, "kN") << "of the full circle";
}

TEST(CaseFacts, UnitsAreLabels)
{
  const auto with = [&](const std::string& units)
  { return case_file::parse_config(units + file_head).materials[0].E; };
  EXPECT_EQ(with("units = { length = 'mm', force = 'kN' }\n"), with(""));
}

TEST(Lame, FollowsTheFormulas)
{
  const auto [lambda, mu, plane, expansion] = problem::lame(2.5, 0.25, problem::PlaneModel::strain);
  EXPECT_DOUBLE_EQ(lambda, 1.0);
  EXPECT_DOUBLE_EQ(mu, 1.0);
  EXPECT_DOUBLE_EQ(problem::lame(3.0, 0.0, problem::PlaneModel::strain).lambda, 0.0);
}

TEST(Lame, PlaneStressGivesYoungsModulusInUniaxialTension)
{
  // sigma_xx = E eps_xx and sigma_yy = 0, that is eps_yy = -nu eps_xx.
  const double E = 2.1;
  const double nu = 0.3;
  const auto [lambda, mu, plane, expansion] = problem::lame(E, nu, problem::PlaneModel::stress);
  EXPECT_NEAR(lambda * (1 - nu) + 2 * mu, E, 1e-14);
  EXPECT_NEAR(lambda * (1 - nu) - 2 * mu * nu, 0.0, 1e-14);
}

/// What stops the expansion in the plane: E alpha / (1 - 2 nu), in plane stress E alpha / (1 - nu).
TEST(ThermalModulus, IsThatOfConstrainedBodies)
{
  problem::Material material = problem::lame(2.1, 0.3, problem::PlaneModel::strain);
  material.expansion = 1e-3;
  EXPECT_NEAR(problem::thermal_modulus(material), 2.1e-3 / 0.4, 1e-16);
  material = problem::lame(2.1, 0.3, problem::PlaneModel::stress);
  material.expansion = 1e-3;
  EXPECT_NEAR(problem::thermal_modulus(material), 2.1e-3 / 0.7, 1e-16);
}

/// Loads of regions, with t: what a case gives is what the problem has.
TEST(InitialStress, OfACase)
{
  const std::string text =
      "mesh.file = 'a.msh'\n[material]\nE = 1\nnu = 0.25\nalpha = 0.1\n"
      "[load.hot]\ntemperature = '20*t + x'\nreference_temperature = 10\ninitial_stress = [1, 'y', 3, 4]\n"
      "[boundary.a]\ndisplacement = [0, 0]\n";
  const problem::Problem<2> p = problem(text, {"hot", "cold"}, {"a"}).at(2);
  Tensor<2> expected;
  const double beta = 0.1 / (1 - 2 * 0.25);
  expected << 1 - beta * 31, 3, 3, 7 - beta * 31;
  EXPECT_TRUE(p.initial_stress(0, {1, 7}).isApprox(expected, 1e-14));
  EXPECT_NEAR(p.initial_stress_zz(0, {1, 7}), 4 - beta * 31, 1e-13);
  EXPECT_TRUE(p.regions()[0].has_initial_stress());
  EXPECT_FALSE(p.regions()[1].has_initial_stress());
  EXPECT_FALSE(p.without_initial_stress().has_initial_stress());
}

constexpr auto complete = R"toml(
[mesh]
file = "a.msh"
[material]
E = 2.5
nu = 0.25
[material.steel]
E = 5
nu = 0.25
[load.rubber]
body = ["x", "2*y"]
[boundary.left]
displacement = ["free", 0.5]
traction = [3, 0]
[boundary.top]
traction = [0, "x"]
pressure = "10*y"
[boundary.bottom]
contact = { friction = "tresca", threshold = "1 - x", gap = "y" }
)toml";

TEST(Problem, ResolvesRegions)
{
  const auto p = problem(complete);
  EXPECT_DOUBLE_EQ(p.material(0).mu, 1.0);
  EXPECT_DOUBLE_EQ(p.material(1).mu, 2.0);
  EXPECT_EQ(p.body_force(0, {3, 4}), Point<2>(3, 8));
  EXPECT_EQ(p.body_force(1, {3, 4}), Point<2>(0, 0));
  EXPECT_FALSE(p.body_force_is_zero(0));
  EXPECT_TRUE(p.body_force_is_zero(1));
  EXPECT_TRUE(p.has_contact());
}

TEST(Problem, ResolvesBoundaries)
{
  const auto p = problem(complete);
  ASSERT_EQ(p.boundaries().size(), 3u);
  const problem::BoundaryCondition<2>& left = p.boundary(0);
  EXPECT_EQ(left.name, "left");
  EXPECT_TRUE(left.fixes_any() && left.fixes(1) && !left.fixes(0));
  EXPECT_TRUE(left.is_loaded());
  EXPECT_EQ(left.load({0, 0}, {-1, 0}), Point<2>(3, 0));
  const problem::BoundaryCondition<2>& top = p.boundary(1);
  EXPECT_FALSE(top.fixes_any());
  EXPECT_EQ(top.load({3, 2}, {0, 1}), Point<2>(0, 3 - 20));
  EXPECT_FALSE(p.boundary(2).is_loaded());
  EXPECT_FALSE(p.boundary(-1).is_loaded() || p.boundary(-1).fixes_any() || p.boundary(-1).contact);
}

TEST(Problem, PressureActsOnFreeComponentsOnly)
{
  const auto p =
      problem(file_head + "[boundary.left]\ndisplacement = [0, 'free']\npressure = 2\n", regions, {"left"});
  const Point<2> n(-0.6, 0.8);
  EXPECT_EQ(p.boundary(0).load({0, 0}, n), Point<2>(0, -1.6));
  EXPECT_TRUE(p.boundary(0).is_loaded());
}

TEST(Problem, ThresholdMustNotBeNegative)
{
  const auto p = problem(complete);
  const problem::Contact& contact = *p.boundary(2).contact;
  EXPECT_EQ((*contact.gap)(Point<2>(0, -0.5)), -0.5);
  EXPECT_EQ(problem::strength_at<2>(contact.law, {0.25, 0}), 0.75);
  EXPECT_THAT(test::message_of(
                  [&] {
                    return problem::strength_at<2>(contact.law, {3, 0});
                  }),
              HasSubstr("boundary.bottom.contact.threshold: is negative, -2, at the point (3, 0)"));
}

TEST(Problem, SidesOfABoxNeedNotBeMentioned)
{
  const std::string box =
      "mesh.box = {lower = [0, 0], upper = [1, 1], cells = [1, 1]}\nmaterial = {E = 1, nu = 0}\n";
  const auto p = problem(box, {"box"}, {"left", "right"});
  EXPECT_FALSE(p.boundary(0).is_loaded() || p.boundary(0).fixes_any() || p.has_contact());
  EXPECT_EQ(p.boundary(1).name, "right");
}

TEST(Problem, WorksIn3D)
{
  const auto p = problem<3>(file_head +
                                "[load]\nbody = [0, 0, 'z']\n[boundary.top]\npressure = 'z'\n"
                                "[boundary.left]\ncontact.gap = 'z'\n",
                            regions, {"top", "left"});
  EXPECT_EQ(p.body_force(0, {1, 2, 3}), Point<3>(0, 0, 3));
  EXPECT_EQ(p.boundary(0).load({0, 0, 2}, {0, 0, 1}), Point<3>(0, 0, -2));
  EXPECT_EQ((*p.boundary(1).contact->gap)(Point<3>(0, 0, 4)), 4);
}

TEST(BadProblem, NamesAreThoseOfTheMesh)
{
  const std::string all = "[boundary.left]\npressure = 1\n[boundary.bottom]\ncontact = {}\n";
  EXPECT_THAT(message(file_head + all + "[boundary.tpo]\npressure = 1\n"),
              HasSubstr("case.toml:10:11: boundary.tpo: the mesh has no boundary \"tpo\"\n"
                        "  hint: did you mean \"top\"? it has \"left\", \"top\", \"bottom\""));
  EXPECT_THAT(message(file_head + "[material.stele]\nE = 1\nnu = 0\n"),
              HasSubstr("material.stele: the mesh has no region \"stele\"\n"
                        "  hint: did you mean \"steel\"? it has \"rubber\", \"steel\""));
  EXPECT_THAT(message(file_head + "[load.concrete]\nbody = [0, 1]\n"),
              HasSubstr("load.concrete: the mesh has no region \"concrete\"\n  hint: it has \"rubber\""));
  EXPECT_THAT(message(file_head + all, regions, {}), HasSubstr("hint: it has none"));
}

TEST(BadProblem, NothingOfTheMeshIsForgotten)
{
  EXPECT_THAT(message("[mesh]\nfile = 'a'\n[material.steel]\nE = 1\nnu = 0\n"),
              HasSubstr("case.toml: material: region \"rubber\" of the mesh has no material\n"
                        "  hint: add [material.rubber] with E and nu"));
  EXPECT_THAT(message(file_head + "[boundary.top]\npressure = 1\n"),
              HasSubstr("case.toml: boundary: the case does not mention boundaries of the mesh: \"left\", "
                        "\"bottom\"\n  hint: if it is traction-free, say so: [boundary.left] with traction"));
  EXPECT_THAT(message(file_head, regions, {"left wall"}),
              HasSubstr("does not mention a boundary of the mesh: \"left wall\"\n"
                        "  hint: if it is traction-free, say so: [boundary.\"left wall\"]"));
}

TEST(BadProblem, VectorsHaveTheDimensionOfTheMesh)
{
  EXPECT_THAT(message<3>(file_head + "[load]\nbody = [0, 1]\n"),
              HasSubstr("load.body: has 2 components, but the mesh is 3D"));
  EXPECT_THAT(message(file_head + "[load.steel]\nbody = [0, 1, 2]\n"),
              HasSubstr("load.steel.body: has 3 components, but the mesh is 2D"));
  EXPECT_THAT(message(file_head + "[boundary.left]\ntraction = [0, 1, 2]\n"),
              HasSubstr("boundary.left.traction: has 3 components, but the mesh is 2D"));
  EXPECT_THAT(message<3>(file_head + "[boundary.left]\ndisplacement = [0, 'free']\n"),
              HasSubstr("boundary.left.displacement: has 2 components, but the mesh is 3D"));
}

TEST(BadProblem, NoZAndNoPlaneModelInTheWrongDimension)
{
  EXPECT_THAT(message(file_head + "[load]\nbody = [0, 'z']\n"),
              HasSubstr("load.body[1]: uses z in a 2D case"));
  EXPECT_THAT(message(file_head + "[boundary.left]\npressure = 'z'\n"), HasSubstr("left.pressure: uses z"));
  EXPECT_THAT(message(file_head + "[boundary.left]\ndisplacement = [0, 'z']\n"), HasSubstr("uses z"));
  EXPECT_THAT(message(file_head + "[boundary.left]\ncontact.gap = 'z'\n"), HasSubstr("contact.gap: uses z"));
  EXPECT_THAT(message(file_head + "[boundary.left]\ncontact = {friction = 'tresca', threshold = 'z'}\n"),
              HasSubstr("contact.threshold: uses z"));
  EXPECT_THAT(message<3>(file_head + "plane = 'stress'\n"),
              HasSubstr("material.plane: plane stress in a 3D case"));
}

}  // namespace
}  // namespace tribound
