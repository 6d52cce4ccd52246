/// @file findings_test.cpp
/// Which facts deserve a note or a warning, and its words.

#include "tribound/doctor/findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace tribound
{
namespace
{

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A case in which all is well.
doctor::Diagnosis healthy()
{
  doctor::Diagnosis diagnosis;
  diagnosis.degree = 2;
  diagnosis.loads.extent = {2, 1};
  diagnosis.loads.size = 2;
  diagnosis.loads.materials = {{"steel", 2.1e11, 0.3, false}};
  diagnosis.loads.smallest_E = 2.1e11;
  diagnosis.loads.traction_stress = 1e8;
  diagnosis.guesses = {{"m", "N"}};
  diagnosis.mesh = {45, {0, 0}, 90, {1, 1}, 1.4, {1, 0}, 0.1, 0.2};
  diagnosis.contacts = {{.name = "base",
                         .facets = 10,
                         .measure = 2,
                         .normal = {0, -1},
                         .smallest_gap_at = {0, 0},
                         .largest_gap_at = {0, 0}}};
  diagnosis.costs = {{2, 400, algebra::LinearMethod::direct, 1e8, 0.5}};
  diagnosis.multigrid_bytes = 0.9e8;
  diagnosis.memory = {8e9, false};
  return diagnosis;
}

doctor::Finding finding(const doctor::Diagnosis& diagnosis, const std::string& code)
{
  const std::vector<doctor::Finding> all = doctor::findings(diagnosis);
  const auto found = std::ranges::find(all, code, &doctor::Finding::code);
  if (found == all.end()) ADD_FAILURE() << "no finding " << code;
  return found == all.end() ? doctor::Finding{} : *found;
}

TEST(Findings, ALoadBeyondContact)
{
  doctor::Diagnosis diagnosis = healthy();
  diagnosis.beyond_contact = doctor::LoadBeyondContact{1.5, "contact cannot hold the body"};
  EXPECT_EQ(finding(diagnosis, "load_beyond_contact").text, "at t = 1.5 contact cannot hold the body");
  EXPECT_EQ(finding(diagnosis, "load_beyond_contact").severity, doctor::Severity::warning);
}

TEST(Findings, AHealthyCase)
{
  for (const doctor::Finding& f : doctor::findings(healthy()))
    EXPECT_EQ(f.severity, doctor::Severity::ok) << f.text;
  EXPECT_EQ(finding(healthy(), "held").text, "displacement conditions alone stop every rigid motion");
  EXPECT_EQ(finding(healthy(), "gap").text, "contact \"base\" is closed everywhere at the start");
  EXPECT_EQ(finding(healthy(), "units").text,
            "a guess at the units: m, N, Pa (E = 2.1e+11 Pa, a body of 2 m)");
  EXPECT_EQ(finding(healthy(), "cost_degree_2").text,
            "degree 2 on this mesh: 400 degrees of freedom, about 100 MB and under 1 s (this case)");
  EXPECT_EQ(finding(healthy(), "memory").text,
            "this case needs about 100 MB on this mesh, of 8.0 GB (nine tenths of the machine)");
}

TEST(Findings, MotionsThatContactStops)
{
  doctor::Diagnosis diagnosis = healthy();
  diagnosis.held_by_contact = {{"the body", "translation along y", false, contact::Remedy{"top", 1}},
                               {"the body", "translation along x", true, std::nullopt}};
  EXPECT_EQ(finding(diagnosis, "held_by_contact").text,
            "only contact stops the body from translation along y, and contact only pushes");
  EXPECT_THAT(finding(diagnosis, "held_by_contact").advice, HasSubstr("y on boundary \"top\""));
  EXPECT_EQ(finding(diagnosis, "held_by_friction").text,
            "only friction stops the body from translation along x");
  EXPECT_EQ(finding(diagnosis, "held_by_friction").severity, doctor::Severity::note);
}

TEST(Findings, Corners)
{
  doctor::Diagnosis diagnosis = healthy();
  diagnosis.corners = {{"base", "left", 1, {0, 0}, 0, 0, true},
                       {"base", "right", 3, {2, 0}, 0.5, 0.25, false}};
  const doctor::Finding clamped = finding(diagnosis, "overconstrained_corner");
  EXPECT_EQ(clamped.severity, doctor::Severity::note);
  EXPECT_THAT(clamped.text,
              HasSubstr("contact \"base\" and displacement \"left\" meet at the vertex (0, 0)"));
  EXPECT_THAT(clamped.advice, HasSubstr("singularity"));
  const doctor::Finding pushed = finding(diagnosis, "contradicting_corner");
  EXPECT_EQ(pushed.severity, doctor::Severity::warning);
  EXPECT_THAT(pushed.text,
              HasSubstr("3 vertices, such as (2, 0), where the prescribed displacement towards the "
                        "obstacle, 0.5, is beyond the gap of 0.25"));
  EXPECT_THAT(pushed.where, ElementsAre(2, 0));
}

TEST(Findings, GapLargerThanTheBody)
{
  doctor::Diagnosis diagnosis = healthy();
  diagnosis.contacts[0].smallest_gap = 0;
  diagnosis.contacts[0].largest_gap = diagnosis.loads.size;
  EXPECT_EQ(finding(diagnosis, "gap").severity, doctor::Severity::ok);
  diagnosis.contacts[0].largest_gap = 15 * diagnosis.loads.size;
  EXPECT_EQ(finding(diagnosis, "gap").severity, doctor::Severity::warning);
  EXPECT_THAT(finding(diagnosis, "gap").advice, HasSubstr("up to 15 times the size of the body"));
}

TEST(Findings, ContactSurface)
{
  doctor::Diagnosis diagnosis = healthy();
  diagnosis.contacts[0].spread = 12;
  diagnosis.contacts[0].kink = 2;
  diagnosis.contacts[0].kink_at = {0.5, 0};
  diagnosis.contacts[0].smallest_gap = 0.5;
  diagnosis.contacts[0].largest_gap = 0.75;
  diagnosis.contacts[0].facets = 2;
  EXPECT_EQ(finding(diagnosis, "contact_surface").severity, doctor::Severity::note);
  EXPECT_THAT(finding(diagnosis, "contact_surface").text, HasSubstr("differ by up to 2 degrees"));
  EXPECT_EQ(finding(diagnosis, "gap").severity, doctor::Severity::warning);
  EXPECT_THAT(finding(diagnosis, "gap").advice, HasSubstr("25 % of the body"));
  EXPECT_EQ(finding(diagnosis, "contact_facets").severity, doctor::Severity::note);
  diagnosis.refines = false;
  EXPECT_EQ(finding(diagnosis, "contact_facets").severity, doctor::Severity::warning);
}

TEST(Findings, CurvedFacetsMadeStraight)
{
  doctor::Diagnosis diagnosis = healthy();
  EXPECT_EQ(std::ranges::count(doctor::findings(diagnosis), "straightened_facets", &doctor::Finding::code),
            0);
  diagnosis.contacts[0].straightened = 0.01;
  const doctor::Finding straightened = finding(diagnosis, "straightened_facets");
  EXPECT_EQ(straightened.severity, doctor::Severity::note);
  EXPECT_THAT(straightened.text, HasSubstr("up to 0.01 away"));
  EXPECT_THAT(straightened.advice, HasSubstr("mesh = \"order2\""));
}

TEST(Findings, ContactAlongAnObliqueDirection)
{
  doctor::Diagnosis diagnosis = healthy();
  const auto found = [&]
  { return std::ranges::count(doctor::findings(diagnosis), "contact_direction", &doctor::Finding::code); };
  diagnosis.contacts[0].off_normal = 60;
  diagnosis.contacts[0].off_normal_at = {0.25, 0};
  EXPECT_EQ(found(), 0);
  diagnosis.contacts[0].off_normal = 75;
  const doctor::Finding oblique = finding(diagnosis, "contact_direction");
  EXPECT_EQ(oblique.severity, doctor::Severity::warning);
  EXPECT_EQ(oblique.text,
            "contact \"base\" acts along a direction 75 degrees off the facet's normal at (0.25, 0)");
  EXPECT_THAT(oblique.where, ElementsAre(0.25, 0));
  EXPECT_THAT(oblique.advice, HasSubstr("small displacements are a bad model"));
  diagnosis.contacts[0].off_normal = 170;
  EXPECT_THAT(finding(diagnosis, "contact_direction").advice, HasSubstr("it points into the body there"));
}

TEST(Findings, LoadsAgainstStiffness)
{
  doctor::Diagnosis diagnosis = healthy();
  diagnosis.loads.traction_stress = 2.1e10;
  EXPECT_EQ(finding(diagnosis, "strain").severity, doctor::Severity::warning);
  EXPECT_EQ(finding(diagnosis, "strain").text,
            "expect strains of about 10 % (stresses near 2.1e+10, E = 2.1e+11)");
  diagnosis.loads.traction_stress = 100;  // MPa in a case in Pa
  EXPECT_EQ(finding(diagnosis, "strain").severity, doctor::Severity::note);
  EXPECT_THAT(finding(diagnosis, "strain").advice, HasSubstr("units of loads and E"));
  diagnosis.loads.traction_stress = 0;
  EXPECT_EQ(finding(diagnosis, "no_load").severity, doctor::Severity::note);
  diagnosis.loads.interference_strain = 0.002;
  EXPECT_EQ(finding(diagnosis, "strain").text,
            "expect strains of about 0.2 % (interferences up to 0.004 over the size 2)");
  diagnosis.loads.displacement_strain = 0.1;
  EXPECT_THAT(finding(diagnosis, "strain").text,
              HasSubstr("prescribed displacements of 0.2 over the size 2"));
}

TEST(Findings, Sliders)
{
  doctor::Diagnosis diagnosis = healthy();
  diagnosis.contacts[0].is_bilateral = true;
  diagnosis.contacts[0].facets = 1;
  diagnosis.contacts[0].smallest_gap = diagnosis.contacts[0].largest_gap = 5;
  EXPECT_TRUE(std::ranges::none_of(doctor::findings(diagnosis), [](const doctor::Finding& f)
                                   { return f.code == "gap" || f.code == "contact_facets"; }));
  EXPECT_EQ(finding(diagnosis, "held").text, "displacement conditions and sliders stop every rigid motion");
  diagnosis.loads.has_springs = true;
  EXPECT_EQ(finding(diagnosis, "held").text,
            "displacement conditions, sliders and springs stop every rigid motion");
  diagnosis.contacts[0].is_bilateral = false;
  EXPECT_EQ(finding(diagnosis, "held").text, "displacement conditions and springs stop every rigid motion");
}

TEST(Findings, SoftSprings)
{
  doctor::Diagnosis diagnosis = healthy();
  diagnosis.loads.spring_shift = 0.04;
  EXPECT_TRUE(std::ranges::none_of(doctor::findings(diagnosis),
                                   [](const doctor::Finding& f) { return f.code == "soft_springs"; }));
  diagnosis.loads.spring_shift = 0.1;
  EXPECT_EQ(finding(diagnosis, "soft_springs").severity, doctor::Severity::warning);
  EXPECT_EQ(finding(diagnosis, "soft_springs").text,
            "the loads move the body about 0.2 on its springs, 0.1 of its size");
}

TEST(Findings, NearlyIncompressible)
{
  doctor::Diagnosis diagnosis = healthy();
  diagnosis.loads.materials[0].nu = 0.499;
  EXPECT_EQ(finding(diagnosis, "nearly_incompressible").severity, doctor::Severity::note);
  diagnosis.degree = 1;
  EXPECT_EQ(finding(diagnosis, "nearly_incompressible").severity, doctor::Severity::warning);
  diagnosis.loads.materials[0].plane_stress = true;  // free to expand in z: nothing locks
  const std::vector<doctor::Finding> all = doctor::findings(diagnosis);
  EXPECT_EQ(std::ranges::count(all, "nearly_incompressible", &doctor::Finding::code), 0);
}

TEST(Findings, MeshAndUnits)
{
  doctor::Diagnosis diagnosis = healthy();
  diagnosis.mesh.smallest_angle = 10;
  diagnosis.mesh.smallest_angle_at = {0.25, 0.5};
  diagnosis.mesh.smallest_cell = 1e-6;
  diagnosis.guesses.clear();
  EXPECT_EQ(finding(diagnosis, "cell_shapes").severity, doctor::Severity::warning);
  EXPECT_THAT(finding(diagnosis, "cell_shapes").where, ElementsAre(0.25, 0.5));
  EXPECT_EQ(finding(diagnosis, "cell_sizes").severity, doctor::Severity::warning);
  EXPECT_EQ(finding(diagnosis, "units").severity, doctor::Severity::note);
  diagnosis.loads.extent = {2, 1, 1};  // poor shapes of triangles are usual for tetrahedra
  EXPECT_EQ(finding(diagnosis, "cell_shapes").severity, doctor::Severity::ok);
}

/// A case with this E in the first region, in these units.
doctor::Diagnosis named(const problem::Units& units, double E)
{
  doctor::Diagnosis diagnosis = healthy();
  diagnosis.units = units;
  diagnosis.loads.materials[0].E = diagnosis.loads.smallest_E = E;
  return diagnosis;
}

TEST(Findings, WithoutUnitsTheGuessSaysHowToNameThem)
{
  EXPECT_THAT(finding(healthy(), "units").advice, HasSubstr("[units] with length = \"m\" and force = \"N\""));
}

TEST(Findings, StiffnessOfSteelInTheUnitsOfTheCase)
{
  const doctor::Finding steel = finding(named({"mm", "N"}, 210e3), "units");
  EXPECT_EQ(steel.severity, doctor::Severity::ok);
  EXPECT_EQ(steel.text, "E = 210000 MPa of region \"steel\" is that of metals");
  EXPECT_EQ(steel.advice, "");
  for (const auto& [units, E] : {std::pair(problem::Units("m", "N"), 210e9),
                                 {problem::Units("m", "kN"), 210e6},
                                 {problem::Units("mm", "kN"), 210.0},
                                 {problem::Units("in", "lbf"), 30e6},
                                 {problem::Units("in", "kip"), 30e3},
                                 {problem::Units("cm", "kgf"), 2.1e6}})
    EXPECT_THAT(finding(named(units, E), "units").text, HasSubstr("is that of metals")) << E;
}

TEST(Findings, StiffnessOfRubberIsMeantInAnotherUnit)
{
  const doctor::Finding soft = finding(named({"mm", "N"}, 210), "units");
  EXPECT_EQ(soft.severity, doctor::Severity::note);
  EXPECT_EQ(soft.text, "E = 210 MPa of region \"steel\" is that of rubber, soft plastics and soil");
  EXPECT_EQ(soft.advice, "GPa? Then it is E = 210000 in this case, whose stresses are in MPa");
  EXPECT_THAT(finding(named({"in", "lbf"}, 30e3), "units").advice, HasSubstr("ksi? Then it is E = 3e+07"));
}

TEST(Findings, StiffnessOfNoSolid)
{
  const doctor::Finding stiff = finding(named({"mm", "N"}, 210e9), "units");
  EXPECT_EQ(stiff.severity, doctor::Severity::warning);
  EXPECT_EQ(stiff.text,
            "E = 2.1e+11 MPa of region \"steel\" is that of no solid: they have 10 kPa (gels) to 1200 GPa "
            "(diamond)");
  EXPECT_EQ(stiff.advice, "Pa? Then it is E = 210000 in this case, whose stresses are in MPa");
  EXPECT_EQ(finding(named({"m", "N"}, 1e-6), "units").severity, doctor::Severity::warning);
  EXPECT_EQ(finding(named({"m", "N"}, 1e-6), "units").advice,
            "look at E and [units]: one of them is hardly meant so");
}

TEST(Findings, EveryStiffnessIsJudgedOnce)
{
  doctor::Diagnosis diagnosis = named({"m", "MN"}, 25e3);
  diagnosis.loads.materials.push_back({"rock", 15, 0.25, false});
  diagnosis.loads.materials.push_back({"dam", 25e3, 0.2, false});
  const std::vector<doctor::Finding> all = doctor::findings(diagnosis);
  EXPECT_EQ(std::ranges::count(all, "units", &doctor::Finding::code), 2);
}

TEST(Findings, BodyForceThatIsNoWeight)
{
  doctor::Diagnosis diagnosis = named({"mm", "N"}, 210e3);
  diagnosis.loads.largest_body_force = 7850 * 9.81e-9;
  EXPECT_EQ(std::ranges::count(doctor::findings(diagnosis), "body_force", &doctor::Finding::code), 0);
  diagnosis.loads.largest_body_force = 7850 * 9.81;
  const doctor::Finding heavy = finding(diagnosis, "body_force");
  EXPECT_EQ(heavy.severity, doctor::Severity::note);
  EXPECT_EQ(heavy.text, "the largest body force, 7.7e+04 N/mm^3, is 1e+09 times the weight of steel");
  EXPECT_EQ(heavy.advice,
            "if it is a weight, look at its units: steel has 7.7e-05 N/mm^3, water 9.81e-06 N/mm^3");
}

TEST(Findings, NumbersCarryTheirUnits)
{
  doctor::Diagnosis diagnosis = named({"mm", "N"}, 210e3);
  diagnosis.loads.traction_stress = 100;
  diagnosis.loads.suction = {{"top", -3, {1, 1}}};
  diagnosis.contacts[0].smallest_gap = 0.01;
  diagnosis.contacts[0].largest_gap = 0.02;
  diagnosis.contacts[0].straightened = 0.001;
  EXPECT_EQ(finding(diagnosis, "strain").text,
            "expect strains of about 0.048 % (stresses near 100 MPa, E = 2.1e+05 MPa)");
  EXPECT_THAT(finding(diagnosis, "suction").text, HasSubstr("is negative, -3 MPa at (1, 1)"));
  EXPECT_EQ(finding(diagnosis, "gap").text,
            "contact \"base\" starts with gaps from 0.01 mm at (0, 0) to 0.02 mm at (0, 0)");
  EXPECT_THAT(finding(diagnosis, "straightened_facets").text, HasSubstr("up to 0.001 mm away"));
  EXPECT_EQ(finding(diagnosis, "cell_sizes").text, "cells have sizes from 0.1 to 0.2 mm, a ratio of 2");
}

TEST(Findings, Cost)
{
  doctor::Diagnosis diagnosis = healthy();
  diagnosis.costs = {{3, 1234567, algebra::LinearMethod::iterative, 12.34e9, 4321}};
  EXPECT_EQ(finding(diagnosis, "cost_degree_3").text,
            "degree 3 on this mesh: 1234567 degrees of freedom, about 12 GB and 72 min");
}

TEST(Findings, MegabytesThatAreAGigabyte)
{
  doctor::Diagnosis diagnosis = healthy();
  diagnosis.costs = {{2, 1e5, algebra::LinearMethod::direct, 0.9996e9, 50}};
  EXPECT_THAT(finding(diagnosis, "memory").text, HasSubstr("about 1.0 GB"));
}

TEST(Findings, MemoryThatIsNotThere)
{
  doctor::Diagnosis diagnosis = healthy();
  diagnosis.costs = {{1, 1e5, algebra::LinearMethod::direct, 4e9, 50},
                     {2, 1e6, algebra::LinearMethod::direct, 30e9, 500}};
  diagnosis.multigrid_bytes = 7e9;
  const doctor::Finding warning = finding(diagnosis, "memory");
  EXPECT_EQ(warning.severity, doctor::Severity::warning);
  EXPECT_EQ(warning.text,
            "this case needs about 30 GB on this mesh, more than 8.0 GB (nine tenths of the machine)");
  EXPECT_EQ(
      warning.advice,
      "take solver.method = \"iterative\" (about 7.0 GB), or degree 1 (about 4.0 GB), or a coarser first "
      "mesh, which the run refines where it pays");
  diagnosis.memory = {40e9, true};  // within the uncertainty of the estimate
  EXPECT_EQ(finding(diagnosis, "memory").severity, doctor::Severity::note);
  EXPECT_THAT(finding(diagnosis, "memory").text, HasSubstr("of 40 GB (adapt.max_memory)"));
  diagnosis.memory = {100e9, true};
  EXPECT_EQ(finding(diagnosis, "memory").severity, doctor::Severity::ok);
  diagnosis.memory = {};  // not known
  const std::vector<doctor::Finding> all = doctor::findings(diagnosis);
  EXPECT_EQ(std::ranges::count(all, "memory", &doctor::Finding::code), 0);
}

}  // namespace
}  // namespace tribound
