// Load steps and history-dependent interfaces in the case file: their meaning, and every mistake.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "support/input_error.h"
#include "tribound/case/config.h"
#include "tribound/case/resolve.h"

namespace tribound::history_cases
{
namespace
{

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using Names = std::vector<std::string>;

const std::string head =
    "mesh.file = 'a.msh'\nmaterial = { E = 1, nu = 0.25 }\nboundary.a.traction = [0, '0.1*t']\n";

case_file::Config config_of(const std::string& text)
{
  return case_file::parse_config(head + text, "case.toml");
}

problem::Problem<2> problem_of(const std::string& text)
{
  return case_file::resolve<2>(config_of(text), Names{"steel"}, Names{"a", "b"});
}

/// The law of boundary b from the keys of its interface.
template <class Law>
Law law_of(const std::string& keys)
{
  return std::get<Law>(problem_of("boundary.b.interface = { " + keys + " }\n").boundary(1).contact->law);
}

std::string message(const std::string& text)
{
  return test::message_of([&] { (void)problem_of(text); });
}

std::string message_of_law(const std::string& keys)
{
  return message("boundary.b.interface = { " + keys + " }\n");
}

TEST(History, Steps)
{
  const std::string contact = "boundary.b.contact = {}\n";
  EXPECT_FALSE(config_of(contact).history);
  EXPECT_THAT(config_of(contact + "[history]\nsteps = [0, 40, 2.5]\n").history->program.targets,
              ElementsAre(0, 40, 2.5));
  EXPECT_THAT(
      config_of(contact + "[history]\nsteps = { from = 1, to = -1, count = 5 }\n").history->program.targets,
      ElementsAre(1, 0.5, 0, -0.5, -1));
  EXPECT_THAT(config_of("boundary.b.interface = { law = 'joint' }\n").history->program.targets,
              ElementsAre(1));
}

TEST(History, Control)
{
  const std::string bond =
      "boundary.b.interface = { law = 'joint', tensile_strength = 1, fracture_energy = 1 }\n";
  const auto of = [&](const std::string& keys)
  { return config_of(bond + "[history]\nsteps = [0, 1]\n" + keys).history.value(); };
  EXPECT_EQ(of("").program.following, adapt::Following::load);
  EXPECT_EQ(of("control = 'auto'").program.following, adapt::Following::automatic);
  const case_file::HistoryConfig damage =
      of("control = 'damage'\ndamage_step = 0.5\nstop = { damage = 0.9, t_min = -1, steps = 7 }\n"
         "then = { displacement = 'a.x', step = -0.1, until = -2 }\nwatch = { p = 'a.b.y', m = 'b.cmod', s = "
         "'b.csd' }\nrefine = 'none'");
  EXPECT_EQ(damage.program.following, adapt::Following::damage);
  EXPECT_EQ(damage.program.damage_step, 0.5);
  EXPECT_EQ(damage.program.enough_damage, 0.9);
  EXPECT_EQ(damage.program.t_min, -1);
  EXPECT_EQ(damage.program.max_steps, 7);
  EXPECT_EQ(damage.program.then.value().until, -2);
  EXPECT_EQ(damage.refine, case_file::Refine::none);
  EXPECT_EQ(of("").refine, case_file::Refine::replay);
  EXPECT_EQ(of("refine = 'transfer'").refine, case_file::Refine::transfer);
  EXPECT_FALSE(of("").check);
  EXPECT_TRUE(of("check = true").check);
  ASSERT_EQ(damage.watch.size(), 3U);
  EXPECT_EQ(damage.watch[0].name, "p");
  EXPECT_EQ(damage.watch[0].gauges.at(0).boundary, "a.b");
  EXPECT_EQ(damage.watch[0].gauges[0].component, 1);
  EXPECT_EQ(damage.watch[1].gauges.at(0).jump, adapt::Jump::mouth_opening);
  EXPECT_EQ(damage.watch[2].gauges.at(0).jump, adapt::Jump::mouth_sliding);

  const adapt::DisplacementStage mixed =
      of("control = { displacement = { 'b.opening' = 1, 'a.x' = 0.1 }, step = -1e-3 }").program.displacement;
  EXPECT_EQ(mixed.step, -1e-3);
  EXPECT_EQ(mixed.until, -std::numeric_limits<double>::infinity());
  ASSERT_EQ(mixed.gauges.size(), 2U);
  EXPECT_FALSE(mixed.gauges[0].component);
  EXPECT_EQ(mixed.gauges[0].jump, adapt::Jump::opening);
  EXPECT_EQ(mixed.gauges[1].factor, 0.1);
}

TEST(History, StepsAreSolvedToTheEndUnlessToldOtherwise)
{
  const std::string steps = "boundary.b.contact = {}\n[history]\nsteps = [1]\n";
  EXPECT_EQ(config_of(steps).method.stopping.criterion, adapt::Stopping::last_bounded);
  EXPECT_EQ(config_of(steps + "[newton]\nstopping = 'adaptive'\n").method.stopping.criterion,
            adapt::Stopping::adaptive);
}

TEST(History, BadSteps)
{
  const auto of = [](const std::string& steps)
  { return message("boundary.b.contact = {}\n[history]\n" + steps + "\n"); };
  EXPECT_THAT(of(""), HasSubstr("history.steps: is missing"));
  EXPECT_THAT(of("steps = []"),
              AllOf(HasSubstr("history.steps: is empty"), HasSubstr("such as [0, 0.5, 1]")));
  EXPECT_THAT(of("steps = 3"), HasSubstr("history.steps: must be an array of numbers or a table"));
  EXPECT_THAT(of("steps = ['a']"), HasSubstr("history.steps[0]: must be a number"));
  EXPECT_THAT(of("steps = { from = 0, to = 1, count = 1 }"), HasSubstr("history.steps.count"));
  EXPECT_THAT(of("steps = { from = 0, to = 1 }"), HasSubstr("history.steps.count: is missing"));
  EXPECT_THAT(of("steps = [1]\nrefine = 'again'"), HasSubstr("history.refine: "));
  EXPECT_THAT(of("steps = [1]\n[regularisation]"), HasSubstr("regularisation: stands beside [history]"));
  EXPECT_THAT(message("boundary.b.interface = { law = 'joint' }\n[regularisation]\n"),
              HasSubstr("regularisation: stands beside an interface"));
  EXPECT_THAT(message("[output]\ncheckpoint = 'all'\n"), HasSubstr("output.checkpoint: is \"all\""));
  EXPECT_THAT(of("steps = [1]\n[output]\ncheckpoint = 'some'"),
              HasSubstr("output.checkpoint: must be true, false or \"all\""));
}

TEST(History, LoadsFollowTheLoadFactor)
{
  const problem::Problem<2> problem = problem_of("boundary.b.contact = { gap = '0.1*t*x' }\n");
  EXPECT_TRUE(problem.uses_time());
  EXPECT_EQ(problem.boundary(0).traction[1](Point<2>(1, 0)), 0.1);
  const problem::Problem<2> later = problem.at(3);
  EXPECT_NEAR(later.boundary(0).traction[1](Point<2>(1, 0)), 0.3, 1e-16);
  EXPECT_NEAR((*later.boundary(1).contact->gap)(Point<2>(2, 0)), 0.6, 1e-15);
}

TEST(History, DirectionsFollowTheLoadFactorAndObstaclesDoNot)
{
  const problem::Problem<2> problem = problem_of("boundary.b.contact = { normal = ['t', -1] }\n").at(0.75);
  const Point<2> n = (*problem.boundary(1).contact->normal)(Point<2>(1, 0));
  EXPECT_NEAR(n[0], 0.6, 1e-15);
  EXPECT_NEAR(n[1], -0.8, 1e-15);
  EXPECT_THAT(message("boundary.b.contact = { obstacle = 'ramp' }\n[obstacle.ramp]\ndistance = 'y - t*x'\n"),
              HasSubstr("obstacle.ramp.distance: contains the load factor t"));
}

TEST(Interface, Joint)
{
  const auto joint = law_of<problem::JointLaw>(
      "law = 'joint', tensile_strength = 0.3, fracture_energy = 1e-4, cohesion = 0.7, slip_length = 2e-3, "
      "coefficient = 0.5, threshold = '0.1*x', unloading = 'vertical'");
  EXPECT_EQ(joint.tension.strength, 0.3);
  EXPECT_EQ(joint.tension.fracture_energy, 1e-4);
  EXPECT_EQ(joint.tension.unloading, problem::Unloading::vertical);
  EXPECT_EQ(joint.cohesion, 0.7);
  EXPECT_EQ(joint.slip_length, 2e-3);
  EXPECT_EQ(joint.coefficient, 0.5);
  EXPECT_EQ(joint.threshold(Point<2>(2, 0)), 0.2);
  EXPECT_FALSE(joint.stick);
  EXPECT_TRUE(
      law_of<problem::JointLaw>("law = 'joint', tensile_strength = 1, fracture_energy = 1, stick = true")
          .stick);
  EXPECT_FALSE(law_of<problem::JointLaw>("law = 'joint'").is_bonded());
}

TEST(Interface, MixedAndEndo)
{
  const auto mixed = law_of<problem::MixedLaw>(
      "law = 'mixed', tensile_strength = 3, fracture_energy = 2, shear_ratio = 1.5, coefficient = 0.25");
  EXPECT_EQ(mixed.tension.strength, 3);
  EXPECT_EQ(mixed.shear_ratio, 1.5);
  EXPECT_EQ(mixed.coefficient, 0.25);
  const std::string endo_keys =
      "law = 'endo', normal_stiffness = 5, coefficient = 0.8, b_normal = 0.3, b_tangential = 0.12, d1 = "
      "0.003";
  const auto endo = law_of<problem::EndoLaw>(endo_keys);
  EXPECT_EQ(endo.tangential_stiffness, 5);
  EXPECT_EQ(endo.tangential_hardening, 0.12);
  EXPECT_EQ(endo.energy, 0.003);
  EXPECT_EQ(law_of<problem::EndoLaw>(endo_keys + ", tangential_stiffness = 4").tangential_stiffness, 4);
}

TEST(Interface, OfAPairAndBrokenInPart)
{
  const problem::Problem<2> problem = case_file::resolve<2>(
      case_file::parse_config(
          "mesh.file = 'a.msh'\nmaterial = { E = 1, nu = 0.25 }\n[[contact]]\nslave = "
          "'a'\nmaster = 'b'\ngap = 0.0\ninterface = { law = 'joint', cohesion = 1, broken "
          "= 'x < 2' }\n",
          "case.toml"),
      Names{"steel"}, Names{"a", "b"});
  const problem::Contact& contact = problem.pairs()[0].contact;
  EXPECT_EQ(std::get<problem::JointLaw>(contact.law).cohesion, 1);
  EXPECT_EQ((*contact.broken)(Point<2>(1, 0)), 1);
  EXPECT_EQ((*contact.broken)(Point<2>(3, 0)), 0);
  EXPECT_EQ(contact.gap->constant(), 0);
}

TEST(Interface, Mistakes)
{
  EXPECT_THAT(message_of_law(""), HasSubstr("boundary.b.interface.law: is missing"));
  EXPECT_THAT(message_of_law("law = 'glue'"), HasSubstr(R"(one of "joint", "mixed", "endo")"));
  EXPECT_THAT(message_of_law("law = 'joint', shear_ratio = 2"),
              AllOf(HasSubstr(R"(shear_ratio: does not belong to law = "joint")"),
                    HasSubstr(R"(it goes with law = "mixed")")));
  EXPECT_THAT(message_of_law("law = 'joint', tensile_strength = 1"), HasSubstr("boundary.b.interface.law"));
  EXPECT_THAT(message_of_law("law = 'joint', fracture_energy = 1"),
              HasSubstr("boundary.b.interface.law: a fracture energy needs a tensile strength"));
  EXPECT_THAT(message_of_law("law = 'joint', stick = true"),
              HasSubstr("what sticks until it breaks needs a tensile strength"));
  EXPECT_THAT(
      message_of_law("law = 'joint', tensile_strength = 1, fracture_energy = 1, cohesion = 1, stick = true"),
      HasSubstr("stick excludes a cohesion"));
  EXPECT_THAT(message_of_law("law = 'mixed', tensile_strength = 1, fracture_energy = 1, coefficient = 0.5, "
                             "unloading = 'vertical'"),
              HasSubstr("friction goes with unloading to the origin only"));
  EXPECT_THAT(message_of_law("law = 'joint', slip_length = 1"), HasSubstr("slip_length requires a cohesion"));
  EXPECT_THAT(message_of_law("law = 'mixed', tensile_strength = 1"),
              HasSubstr("boundary.b.interface.fracture_energy: is missing"));
  EXPECT_THAT(message_of_law("law = 'endo', normal_stiffness = 0"), HasSubstr("must be positive"));
  EXPECT_THAT(message_of_law("law = 'joint', friction = 'coulomb'"), HasSubstr("friction: unknown key"));
  EXPECT_THAT(message("boundary.b = { contact = {}, interface = { law = 'joint' } }\n"),
              HasSubstr("interface: stands beside contact"));
  EXPECT_THAT(message("boundary.b = { pressure = 1, interface = { law = 'joint' } }\n"),
              HasSubstr("pressure: stands beside interface on the same boundary"));
  EXPECT_THAT(
      test::message_of(
          []
          {
            (void)case_file::parse_config(
                "mesh.file = 'a.msh'\nmaterial = { E = 1, nu = 0.25 }\n[[contact]]\nslave = 'a'\nmaster = "
                "'b'\nfriction = 'coulomb'\ncoefficient = 0.3\ninterface = { law = 'joint' }\n");
          }),
      HasSubstr("friction: stands beside interface"));
}

}  // namespace
}  // namespace tribound::history_cases
