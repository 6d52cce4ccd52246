#include "tribound/case/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <variant>

namespace tribound
{
namespace
{

using testing::ElementsAre;
using testing::HasSubstr;

constexpr auto complete_case = R"toml(
title = "Block on a rigid floor, Tresca friction"
degree = 2

[mesh]
file = "block.msh"

[material]
E = 1.0
nu = 0.3

[load]
body = [0, "-9.81*2400*1e-6"]

[boundary.left]
displacement = [0, "free"]

[boundary.top]
traction = [0, -0.1]

[boundary.right]
pressure = "9810*max(0, 9-y)"

[boundary.bottom]
contact = { friction = "tresca", threshold = 0.03, gap = 0 }

[nitsche]
gamma0 = 12

[newton]
stopping = "tolerance"
gamma_lin = 0.2

[adapt]
tolerance = 0.02
marking = "maximum"
theta = 0.75
max_levels = 3
max_dofs = 3_000_000
max_cells = 1000
max_time = 60
max_memory = 2.5
separate_contact = true

[certify]
contact_rule = "reference"
stress = "rows"

[solver]
method = "iterative"
package = "umfpack"
tolerance = 1e-8
gamma_alg = 0.02
max_iterations = 7

[study]
reference_degree = 4
reference_factor = 0.125
max_reference_dofs = 1000
dual_norm_dofs = 0
figures = false

[judge]
sharpness = 0.25

[output]
directory = "results"
vtu = false
levels = "all"
report = false
)toml";

const Point<2> somewhere(0.25, 4.0);

TEST(Config, ReadsEveryKey)
{
  const case_file::Config config = case_file::parse_config(complete_case, "cases/block.toml");
  EXPECT_EQ(config.file, "cases/block.toml");
  EXPECT_EQ(config.title, "Block on a rigid floor, Tresca friction");
  EXPECT_EQ(config.method.degree, 2);
  EXPECT_EQ(std::get<mesh::MeshFile>(config.mesh).path, "cases/block.msh");
  EXPECT_THAT(case_file::files_of(config), ElementsAre("cases/block.msh"));
  EXPECT_EQ(config.method.gamma_0(), 12.0);
  EXPECT_EQ(config.method.stopping.criterion, adapt::Stopping::tolerance);
  EXPECT_EQ(config.method.stopping.gamma_lin, 0.2);
  EXPECT_EQ(config.adapt.tolerance, 0.02);
  EXPECT_EQ(config.adapt.marking.strategy, adapt::Marking::maximum);
  EXPECT_EQ(config.adapt.marking.theta, 0.75);
  EXPECT_EQ(config.adapt.max_levels, 3);
  EXPECT_EQ(config.adapt.max_dofs, 3'000'000);
  EXPECT_EQ(config.adapt.max_cells, 1000);
  EXPECT_EQ(config.adapt.max_time, 60.0);
  EXPECT_EQ(config.adapt.max_memory, 2.5);
  EXPECT_TRUE(config.adapt.marking.separate_contact);
  EXPECT_EQ(config.method.contact_rule, certify::ContactRule::reference);
  EXPECT_EQ(config.method.stress, certify::PatchStress::rows);
  EXPECT_EQ(config.method.solver.method, algebra::LinearMethod::iterative);
  EXPECT_EQ(config.method.solver.package, algebra::DirectPackage::umfpack);
  EXPECT_EQ(config.method.solver.tolerance, 1e-8);
  EXPECT_EQ(config.method.solver.gamma_alg, 0.02);
  EXPECT_EQ(config.method.solver.max_iterations, 7);
  EXPECT_EQ(config.study.reference_degree, 4);
  EXPECT_EQ(config.study.reference_factor, 0.125);
  EXPECT_EQ(config.study.max_reference_dofs, 1000);
  EXPECT_EQ(config.study.dual_norm_dofs, 0);
  EXPECT_FALSE(config.study.figures);
  EXPECT_EQ(config.judge.sharpness, 0.25);
  EXPECT_EQ(config.output.directory, "results");
  EXPECT_FALSE(config.output.vtu);
  EXPECT_EQ(config.output.levels, case_file::FieldLevels::all);
  EXPECT_FALSE(config.output.report);
}

TEST(Config, ReadsTheRegularisation)
{
  EXPECT_FALSE(case_file::parse_config(complete_case).method.regularisation) << "the plain method";
  const case_file::Config with_defaults =
      case_file::parse_config(std::string(complete_case) + "[regularisation]\n");
  ASSERT_TRUE(with_defaults.method.regularisation);
  EXPECT_EQ(with_defaults.method.regularisation->delta, 1.0);
  EXPECT_EQ(with_defaults.method.regularisation->factor, 0.25);
  EXPECT_EQ(with_defaults.method.regularisation->gamma_reg, 0.1);
  EXPECT_EQ(with_defaults.method.regularisation->max_updates, 20);
  const case_file::Config config = case_file::parse_config(
      std::string(complete_case) +
      "[regularisation]\ndelta = 0.5\nfactor = 0.1\ngamma_reg = 0.2\nmax_updates = 7\n");
  EXPECT_EQ(config.method.regularisation->delta, 0.5);
  EXPECT_EQ(config.method.regularisation->factor, 0.1);
  EXPECT_EQ(config.method.regularisation->gamma_reg, 0.2);
  EXPECT_EQ(config.method.regularisation->max_updates, 7);
}

TEST(Config, ReadsMaterialAndLoad)
{
  const case_file::Config config = case_file::parse_config(complete_case);
  ASSERT_EQ(config.materials.size(), 1u);
  EXPECT_EQ(config.materials[0].region, "");
  EXPECT_EQ(config.materials[0].E, 1.0);
  EXPECT_EQ(config.materials[0].nu, 0.3);
  EXPECT_EQ(config.materials[0].plane, problem::PlaneModel::strain);
  ASSERT_EQ(config.loads.size(), 1u);
  ASSERT_EQ(config.loads[0].body.size(), 2u);
  EXPECT_DOUBLE_EQ(config.loads[0].body[1](somewhere), -9.81 * 2400 * 1e-6);
}

TEST(Config, ReadsBoundariesInTheOrderOfTheFile)
{
  const case_file::Config config = case_file::parse_config(complete_case);
  ASSERT_EQ(config.boundaries.size(), 4u);
  const case_file::BoundaryConfig& left = config.boundaries[0];
  const case_file::BoundaryConfig& top = config.boundaries[1];
  const case_file::BoundaryConfig& right = config.boundaries[2];
  const case_file::BoundaryConfig& bottom = config.boundaries[3];
  EXPECT_EQ(left.name, "left");
  EXPECT_EQ(left.where.line, 15);
  ASSERT_EQ(left.displacement.size(), 2u);
  EXPECT_TRUE(left.displacement[0] && left.displacement[0]->is_zero());
  EXPECT_FALSE(left.displacement[1]);
  EXPECT_EQ(top.name, "top");
  EXPECT_EQ(top.traction[1](somewhere), -0.1);
  EXPECT_EQ(right.name, "right");
  EXPECT_DOUBLE_EQ((*right.pressure)(somewhere), 9810 * 5.0);
  EXPECT_EQ(bottom.name, "bottom");
  EXPECT_EQ(std::get<problem::Tresca>(bottom.contact->law).threshold(somewhere), 0.03);
  EXPECT_TRUE(bottom.contact->gap->is_zero());
}

constexpr auto small_case = R"toml(
[mesh]
box = { lower = [0, 0, -1], upper = [1, 2, 3.5], cells = [2, 3, 4] }
[material.soft]
E = 1
nu = 0.25
[material]
plane = "stress"
E = 7
nu = 0
[material."hard one"]
E = 2
nu = -0.5
plane = "strain"
[load.soft]
body = [1, 2, "3*x"]
[boundary.bottom]
contact = {}
)toml";

TEST(Config, HasTheDefaultsOfTheHeader)
{
  const case_file::Config config = case_file::parse_config(small_case);
  EXPECT_EQ(config.title, "");
  EXPECT_EQ(config.method.degree, 2);
  EXPECT_EQ(config.method.gamma_0(), 10.0);
  EXPECT_EQ(config.method.stopping.criterion, adapt::Stopping::adaptive);
  EXPECT_EQ(config.method.newton.tolerance, 1e-10);
  EXPECT_EQ(config.method.newton.max_steps, 50);
  EXPECT_EQ(config.adapt.max_dofs, 2'000'000);
  EXPECT_FALSE(config.adapt.max_cells);
  EXPECT_FALSE(config.adapt.max_time);
  EXPECT_FALSE(config.adapt.max_memory);
  EXPECT_FALSE(config.adapt.marking.separate_contact);
  EXPECT_EQ(config.method.contact_rule, certify::ContactRule::resolved);
  EXPECT_EQ(config.method.solver.method, algebra::LinearMethod::automatic);
  EXPECT_EQ(config.method.solver.package, algebra::DirectPackage::automatic);
  EXPECT_EQ(config.output.directory, "out/case");
  EXPECT_TRUE(config.output.vtu);
  EXPECT_TRUE(config.output.report);
  EXPECT_TRUE(std::holds_alternative<problem::Frictionless>(config.boundaries[0].contact->law));
  EXPECT_TRUE(config.boundaries[0].contact->gap->is_zero());
}

TEST(Config, ReadsABox)
{
  const case_file::Config config = case_file::parse_config(small_case);
  const auto& box = std::get<mesh::BoxMesh>(config.mesh);
  EXPECT_THAT(box.lower, ElementsAre(0, 0, -1));
  EXPECT_THAT(box.upper, ElementsAre(1, 2, 3.5));
  EXPECT_THAT(box.cells, ElementsAre(2, 3, 4));
  EXPECT_THAT(case_file::files_of(config), testing::IsEmpty());
}

TEST(Config, ReadsBoxes)
{
  const case_file::Config config = case_file::parse_config(
      "mesh.boxes.low = {lower = [0, 0], upper = [2, 1], cells = [3, 1]}\n"
      "mesh.boxes.\"top one\" = {lower = [0, 1], upper = [1, 2], cells = [1, 2]}\nmaterial = {E = 1, nu = "
      "0}\n");
  const auto& boxes = std::get<mesh::Boxes>(config.mesh);
  ASSERT_EQ(boxes.size(), 2U);
  EXPECT_EQ(boxes[1].name, "top one");
  EXPECT_THAT(boxes[1].box.cells, ElementsAre(1, 2));
}

TEST(Config, ReadsContactsBetweenBodies)
{
  const case_file::Config config = case_file::parse_config(
      "mesh.file = 'a.msh'\nmaterial = {E = 1, nu = 0}\n"
      "[[contact]]\nslave = 'a'\nmaster = ['b', 'c']\nfriction = 'coulomb'\ncoefficient = 0.3\ngap = "
      "'-0.1*x'\n"
      "pairing = [0, -1]\nreach = 0.5\n"
      "[[contact]]\njoint = 'j'\nfriction = 'tied'\n[[contact]]\nslave = 'd'\nmaster = 'e'\n");
  ASSERT_EQ(config.contacts.size(), 3U);
  const case_file::ContactConfig& first = config.contacts[0];
  EXPECT_THAT(first.slave, ElementsAre("a"));
  EXPECT_THAT(first.master, ElementsAre("b", "c"));
  EXPECT_EQ(std::get<problem::Coulomb>(first.contact.law).coefficient, 0.3);
  EXPECT_EQ((*first.contact.gap)(Point<2>(2, 0)), -0.2);
  EXPECT_THAT(first.direction, ElementsAre(0, -1));
  EXPECT_EQ(first.reach, 0.5);
  EXPECT_THAT(config.contacts[1].slave, ElementsAre("j"));
  EXPECT_THAT(config.contacts[1].master, ElementsAre("j.other"));
  EXPECT_TRUE(cone(config.contacts[1].contact.law).is_tied);
  EXPECT_FALSE(config.contacts[2].contact.gap) << "that of the meshes";
  EXPECT_TRUE(config.contacts[2].direction.empty());
  EXPECT_EQ(config.contacts[2].reach, std::numeric_limits<double>::infinity());
  EXPECT_EQ(case_file::friction_name(config), "none+coulomb+tied");

  const mesh::Seams seams =
      case_file::find_seams(config)(std::vector<std::string>{"a", "b", "c", "d", "e", "j"});
  EXPECT_THAT(seams.joints, ElementsAre("j"));
  ASSERT_EQ(seams.interfaces.size(), 2U);
  EXPECT_THAT(seams.interfaces[0].sides[1], ElementsAre("b", "c"));
  const case_file::Config again = case_file::parse_config(config.effective.text, "out/case/case.toml");
  EXPECT_EQ(again.contacts.size(), 3U);
  EXPECT_EQ(again.effective.text, config.effective.text);
}

TEST(Config, ReadsMaterialsOfRegions)
{
  const case_file::Config config = case_file::parse_config(small_case);
  ASSERT_EQ(config.materials.size(), 3u);
  EXPECT_EQ(config.materials[0].region, "");
  EXPECT_EQ(config.materials[0].E, 7.0);
  EXPECT_EQ(config.materials[1].region, "soft");
  EXPECT_EQ(config.materials[1].plane, problem::PlaneModel::stress) << "inherited from [material]";
  EXPECT_EQ(config.materials[2].region, "hard one");
  EXPECT_EQ(config.materials[2].nu, -0.5);
  EXPECT_EQ(config.materials[2].plane, problem::PlaneModel::strain);
  ASSERT_EQ(config.loads.size(), 1u);
  EXPECT_EQ(config.loads[0].region, "soft");
}

TEST(Config, ATableInMaterialIsARegionWhateverItsName)
{
  const case_file::Config config = case_file::parse_config(
      "mesh.file = 'a.msh'\n[material.E]\nE = 2\nnu = 0\n[material.plane]\nE = 3\nnu = 0\n"
      "[load.body]\nbody = [0, 1]\n");
  ASSERT_EQ(config.materials.size(), 2u);
  EXPECT_EQ(config.materials[0].region, "E");
  EXPECT_EQ(config.materials[1].region, "plane");
  ASSERT_EQ(config.loads.size(), 1u);
  EXPECT_EQ(config.loads[0].region, "body");
}

TEST(Config, GammaDefaultGrowsWithTheDegree)
{
  EXPECT_EQ(contact::default_gamma0(1), 10.0);
  EXPECT_EQ(contact::default_gamma0(3), 10.0);
  EXPECT_EQ(contact::default_gamma0(4), 48.0);
}

TEST(Config, NamesTheFrictionLaws)
{
  EXPECT_EQ(case_file::friction_name(case_file::parse_config(complete_case)), "tresca");
  EXPECT_EQ(case_file::friction_name(case_file::parse_config(small_case)), "none");
  EXPECT_EQ(case_file::friction_name(case_file::Config{}), "");
  const std::string two = std::string(small_case) +
                          "[boundary.left.contact]\nfriction = \"coulomb\"\ncoefficient = 0.5\n"
                          "[boundary.right]\ncontact = { friction = \"coulomb\", coefficient = 0 }\n";
  EXPECT_EQ(case_file::friction_name(case_file::parse_config(two)), "none+coulomb");
}

TEST(Config, ReadsAFile)
{
  const auto directory = std::filesystem::path(testing::TempDir()) / "tribound_config_test";
  std::filesystem::create_directories(directory);
  const auto file = directory / "case.toml";
  std::ofstream(file) << complete_case;
  const case_file::Config config = case_file::read_config(file);
  EXPECT_EQ(config.method.degree, 2);
  EXPECT_EQ(std::get<mesh::MeshFile>(config.mesh).path, directory / "block.msh");
  std::filesystem::remove_all(directory);
}

TEST(Config, AFileThatCannotBeReadIsNamed)
{
  try
  {
    (void)case_file::read_config("no/such/case.toml");
    FAIL() << "accepted";
  }
  catch (const InputError& error)
  {
    EXPECT_THAT(error.what(), HasSubstr("no/such/case.toml: cannot be read: No such file or directory"));
  }
  EXPECT_THROW((void)case_file::read_config(testing::TempDir()), InputError);
}

}  // namespace
}  // namespace tribound
