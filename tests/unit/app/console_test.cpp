#include "app/console/console.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tribound
{
namespace
{

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const io::CaseFacts facts{"Block", "case.toml", 2, 2, certify::PatchStress::rows, "tresca", 10.0};
const io::MeshFacts mesh{15,
                         16,
                         80,
                         0.5,
                         0.75,
                         {{"box", 16, 2.0, "E = 1, nu = 0.3, plane strain"}},
                         {{"bottom", 4, 2.0, "contact, Tresca friction, threshold 0.03, gap 0"},
                          {"top", 1, 2.0, "traction-free"}}};

TEST(Console, Header)
{
  EXPECT_EQ(app::header_text(facts, mesh),
            "case          Block\n"
            "mesh          15 vertices, 16 cells, h from 0.5 to 0.75\n"
            "method        2D, degree 2, 80 free degrees of freedom, gamma_0 = 10\n");
}

TEST(Console, CheckNamesRegionsAndBoundaries)
{
  EXPECT_EQ(app::check_text(facts, mesh, "direct (MUMPS)"),
            app::header_text(facts, mesh) +
                "solver        direct (MUMPS)\n"
                "regions\n"
                "  box  16 cells, area 2: E = 1, nu = 0.3, plane strain\n"
                "boundaries\n"
                "  bottom  4 facets, length 2: contact, Tresca friction, threshold 0.03, gap 0\n"
                "  top     1 facet, length 2: traction-free\n");
}

/// The same in mm and N.
io::CaseFacts facts_with_units()
{
  io::CaseFacts named = facts;
  named.units = {"mm", "N"};
  named.quantity_units = {{"thrust", "N/mm"}, {"safety", ""}};
  return named;
}

TEST(Console, HeaderNamesTheUnits)
{
  EXPECT_EQ(app::header_text(facts_with_units(), mesh),
            "case          Block\n"
            "units         lengths in mm, stresses in MPa, forces in N/mm, bounds in MPa mm\n"
            "mesh          15 vertices, 16 cells, h from 0.5 to 0.75 mm\n"
            "method        2D, degree 2, 80 free degrees of freedom, gamma_0 = 10\n");
  io::CaseFacts in_3d = facts_with_units();
  in_3d.dimension = 3;
  EXPECT_THAT(app::header_text(in_3d, mesh),
              HasSubstr("stresses in MPa, forces in N, bounds in MPa mm^(3/2)\n"));
}

TEST(Console, BodiesOfRevolution)
{
  io::CaseFacts revolved = facts_with_units();
  revolved.is_axisymmetric = true;
  EXPECT_THAT(app::header_text(revolved, mesh), AllOf(HasSubstr("forces in N, bounds in MPa mm^(3/2)\n"),
                                                      HasSubstr("method        axisymmetric, degree 2")));
  EXPECT_THAT(app::check_text(revolved, mesh, ""),
              AllOf(HasSubstr("16 cells, volume 2 mm^3: E"), HasSubstr("4 facets, area 2 mm^2: contact")));
  const certify::Balance balance{{1, 0.5},
                                 {{certify::BalanceKind::load, "top", "pressure", {0, -0.5}, {0}},
                                  {certify::BalanceKind::contact, "bottom", "contact", {0, 0.5}, {0}}}};
  EXPECT_EQ(app::balance_text(balance, revolved),
            "balance                                    force z\n"
            "              load      top, pressure         -0.5\n"
            "              contact   bottom                 0.5\n"
            "              forces of the full circle in N on the body\n");
}

TEST(Console, CheckHasSizesWithUnits)
{
  EXPECT_THAT(app::check_text(facts_with_units(), mesh, ""),
              AllOf(HasSubstr("16 cells, area 2 mm^2: E"), HasSubstr("4 facets, length 2 mm: contact")));
}

TEST(Console, SectionsAndProbes)
{
  io::LevelRecord level;
  EXPECT_EQ(app::observations_text(level, facts), "");
  level.sections = {{"base", 2, {1, -0.5}, {3}, {0, 1, -1, 0}, -0.5, {-1}, {3}, ""},
                    {"top", 2, {1e-14, 0.25}, {0}, {0, 1, -1, 0}, 0.25, {-1e-14}, {0}, ""}};
  EXPECT_EQ(app::observations_text(level, facts_with_units()),
            "sections                       N             V             M\n"
            "              base          -0.5            -1             3\n"
            "              top           0.25             0             0\n"
            "              forces in N/mm, moments in N mm/mm; on the part behind the plane,\n"
            "              moments about its point; in equilibrium with the loads, without\n"
            "              error bars\n");
  level.sections[0].note = "moments need degree 2 or more";
  EXPECT_THAT(
      app::observations_text(level, facts),
      HasSubstr("forces are\n              in equilibrium with the loads; moments need degree 2 or more\n"));
  level.sections.clear();
  const std::array<double, 6> stress = {3, 0, 0, 0, 0, 0};
  level.probes = {{"crest", {{0, {1, 2}, "a", "a", {0.5, -0.25}, {}, stress, 0.125}}}, {"line", {}}};
  for (std::size_t k = 0; k < 5; ++k)
    level.probes[1].rows.push_back({k, {1, 2}, "a", "a", {0.5, -0.25 * k}, stress, stress, 0.125});
  EXPECT_THAT(
      app::observations_text(level, facts),
      AllOf(
          HasSubstr("probes                                u_x           u_y     von Mises    difference\n"
                    "              crest                   0.5         -0.25             3         0.125\n"
                    "              line, largest           0.5            -1             3         0.125\n"),
          HasSubstr("without guarantee\n")));
  level.probes = {
      {"joint", {{0, {1, 2}, "a", "a", {0.5, 0}, stress}, {0, {1, 2}, "b", "b", {0.25, 0}, stress}}}};
  EXPECT_THAT(app::observations_text(level, facts),
              AllOf(HasSubstr("joint (1, 2), a           0.5"), HasSubstr("joint (1, 2), b          0.25"),
                    HasSubstr("stresses are those of sigma(u_h)\n")));
}

TEST(Console, NewtonStep)
{
  EXPECT_EQ(app::newton_text({3, 1.3e-5, 1.0, 0, false, 0.125}),
            "  step  3  residual 1.3e-05  direct, 0.1 s\n");
  EXPECT_EQ(app::newton_text({3, 1.3e-5, 1.0, 0, true, 0.125}, 0.025),
            "  step  3  residual 1.3e-05  bound 2.50e-02  factorised, 0.1 s\n");
  EXPECT_THAT(app::newton_text({1, 1.0, 0.5, 7, true, 0.0}), HasSubstr("  damping 0.5  GMRES 7, "));
}

TEST(Console, NewtonStepsFitATerminal)
{
  const solve::NewtonStep longest = {50, 1.25e-5, 1.0 / 1024, 0, true, 999.94};
  EXPECT_LE(app::newton_text(longest, 1.25e-5).size(), 80u + 1);  // with the newline
}

TEST(Console, CertificateGivesEveryComponentAndItsShare)
{
  io::RunRecord run;
  run.facts.degree = 1;
  io::LevelRecord level;
  level.figures.sigma_norm = 2;
  level.bound = certify::Bound{{0, 3, 0, 0, 4, 0, 0, 0}, 0.5, 0.25};
  level.identities = certify::IdentityDefects{1e-13, 0, 0, 0, 1, false};  // no symmetry for p = 1
  run.levels = {level};
  run.statements = {{"the dual norm of the residual"}, "unique", {}, {}, {"the model"}};
  EXPECT_EQ(app::certificate_text(run),
            "bound         0.25, that is 12.5 % of ||sigma(u_h)|| (plain sums: 0.5)\n"
            "              osc    data oscillation                       0    0.0 %\n"
            "              str    stress                                 3   36.0 %\n"
            "              neu    Neumann data                           0    0.0 %\n"
            "              lin1   linearisation, in the body             0    0.0 %\n"
            "              cnt    contact condition                      4   64.0 %\n"
            "              frc    friction                               0    0.0 %\n"
            "              lin2n  linearisation, normal                  0    0.0 %\n"
            "              lin2t  linearisation, tangential              0    0.0 %\n"
            "identities    hold to 1.0e-13 of ||sigma_h|| (limit 1e-08)\n"
            "guaranteed    the dual norm of the residual\n"
            "law           unique\n"
            "outside       the model\n");
}

TEST(Console, NoCertificateWithoutABound)
{
  io::RunRecord run;
  run.levels.resize(1);
  EXPECT_EQ(app::certificate_text(run), "");
}

TEST(Console, Level)
{
  io::LevelRecord level;
  level.level = 3;
  level.cells = 1234;
  level.dofs = 5678;
  level.newton.resize(2);
  level.figures.sigma_norm = 2;
  level.bound = certify::Bound{{}, 0.5, 0.25};
  level.times.level = 1.25;
  EXPECT_EQ(app::level_text(level),
            "level 3           1234 cells      5678 dofs  newton  2  bound 12.5 %    1.25 s\n");
}

TEST(Console, SummaryOfAFailedRun)
{
  io::RunRecord run;
  run.status = certify::RunStatus::failed;
  run.reason = "no convergence in 50 steps";
  EXPECT_EQ(app::summary_text(run, ""), "status        failed: no convergence in 50 steps\n");
}

TEST(Console, SummaryOfACertifiedRunNamesTheTolerance)
{
  io::RunRecord run;
  run.status = certify::RunStatus::certified;
  run.tolerance = 0.03;
  EXPECT_EQ(app::summary_text(run, ""),
            "status        certified: the bound is at most adapt.tolerance = 3 % of ||sigma(u_h)||\n");
}

TEST(Console, Summary)
{
  io::RunRecord run;
  io::LevelRecord level;
  level.newton.resize(5);
  level.figures = {0.0137,
                   0.116,
                   0.084,
                   {"", {-0.04, 0.11}, -0.11, -0.04, 0.05},
                   {{"bottom", {-0.04, 0.11}, -0.11, -0.04, 0.05}}};
  run.levels = {level};
  EXPECT_EQ(app::summary_text(run, "out"),
            "contact       bottom: normal -0.11, tangential -0.04, force (-0.04, 0.11)\n"
            "max |u|       0.084\n"
            "energy        a(u, u) = 0.0137, ||sigma|| = 0.116\n"
            "status        uncertified\n"
            "results       out\n");
}

TEST(Console, ResultsCarryTheirUnits)
{
  io::RunRecord run;
  run.facts = facts_with_units();
  io::LevelRecord level;
  level.figures = {0.0137,
                   2,
                   0.084,
                   {"", {-0.04, 0.11}, -0.11, -0.04, 0.05},
                   {{"bottom", {-0.04, 0.11}, -0.11, -0.04, 0.05}}};
  level.bound = certify::Bound{{}, 0.5, 0.25};
  level.energy.emplace();
  level.energy->bound = 0.125;
  level.energy->quantities = {
      {.name = "thrust", .value = 1.5, .lower = 1, .upper = 2, .basis = "duality gap"},
      {.name = "safety", .value = 3, .lower = 2, .upper = 4, .basis = "duality gap"}};
  level.balance = certify::Balance{{1, 0.5}, {}};
  run.levels = {level};
  EXPECT_THAT(app::summary_text(run, ""),
              AllOf(HasSubstr("bottom: normal -0.11 N/mm, tangential -0.04 N/mm, force (-0.04, 0.11) N/mm\n"),
                    HasSubstr("on the body; forces in N/mm, moments in N mm/mm about (1, 0.5)\n"),
                    HasSubstr("max |u|       0.084 mm\n"),
                    HasSubstr("energy        a(u, u) = 0.0137 N mm/mm, ||sigma|| = 2 MPa mm\n"),
                    HasSubstr("bound         0.25 MPa mm, that is 12.5 % of ||sigma(u_h)||"),
                    HasSubstr("energy error  at most 0.125 (N mm/mm)^(1/2), "),
                    HasSubstr("quantities    thrust: 1.5 N/mm, guaranteed between 1 and 2 (duality gap)\n"),
                    HasSubstr("              safety: 3, guaranteed between 2 and 4 (duality gap)\n")));
}

/// A path and the same path with half the steps, on which everything is a tenth larger.
io::RunRecord checked_run()
{
  const auto step = [](double factor)
  {
    io::LoadStepRecord record;
    record.t = 80;
    record.effective_normal = -37 * factor;
    record.dissipated = 0.5 * factor;
    return record;
  };
  io::RunRecord run;
  run.levels.resize(1);
  run.levels[0].load_step = step(1);
  run.path.peak = adapt::Peak{.t = 100, .number = 1};
  run.check = io::HistoryCheck{
      .cells = 64, .steps = 2, .last = step(1.1), .end = {.peak = adapt::Peak{.t = 110, .number = 2}}};
  return run;
}

TEST(Console, ACheckOfThePathIsALine)
{
  io::RunRecord run = checked_run();
  EXPECT_THAT(app::verdict_text(run, ""),
              HasSubstr("check         half the steps on 64 cells, not guaranteed: t of the peak 110\n"
                        "              (+10), at the end t 80 (+0), N -40.7 (-3.7), V 0 (+0), dissipated\n"
                        "              0.55 (+0.05)\n"
                        "status"));
  run.facts = facts_with_units();
  EXPECT_THAT(app::verdict_text(run, ""),
              AllOf(HasSubstr("N -40.7 N/mm (-3.7)"), HasSubstr("0.55 N mm/mm (+0.05)")));
  run.path.peak.reset();
  EXPECT_THAT(app::verdict_text(run, ""), HasSubstr("not guaranteed: at the end t 80 (+0)"));
  run.check->end.failure = "load step 2 at t = 0.5: no convergence";
  EXPECT_THAT(app::verdict_text(run, ""),
              AllOf(HasSubstr("check         half the steps on a finer mesh: load step 2 at t = 0.5: no\n"
                              "              convergence\n"),
                    Not(HasSubstr("not guaranteed"))));
  run.check.reset();
  EXPECT_THAT(app::verdict_text(run, ""), Not(HasSubstr("check")));
}

TEST(Console, SummaryJudgesSliding)
{
  io::RunRecord run;
  io::LevelRecord level;
  level.figures.boundary_contact = {{"base", {-12.0, 32.0}, -32.0, 12.0, 12.0, 0.75},
                                    {"pad", {0.0, 4.0}, -4.0, 0.0, 0.0, 0.5},
                                    {"rail", {1.0, 4.0}, -4.0, 1.0, 1.0, {}}};
  run.levels = {level};
  EXPECT_THAT(
      app::summary_text(run, ""),
      AllOf(
          HasSubstr(
              "sliding       base: sliding factor H/N = 0.375, mu_F = 0.75: factor of safety mu_F N/H = 2\n"),
          HasSubstr("sliding       pad: sliding factor H/N = 0, mu_F = 0.5: no sliding force\n"),
          Not(HasSubstr("rail: sliding"))));
}

TEST(Console, BalanceShowsRoundingAsZero)
{
  const certify::Balance plane = {
      {1, 0.5},
      {{certify::BalanceKind::load, "box", "body force", {1e-15, -3}, {1.5}},
       {certify::BalanceKind::reaction, "left", "displacement", {1.25, 0}, {-1.5}},
       {certify::BalanceKind::contact, "bottom", "contact", {-1.25, 3}, {0}},
       {certify::BalanceKind::sum, "", "", {0, -4e-16}, {2e-16}}}};
  EXPECT_EQ(app::balance_text(plane, {}),
            "balance                                      force x      force y       moment\n"
            "              load      box, body force            0           -3          1.5\n"
            "              reaction  left                    1.25            0         -1.5\n"
            "              contact   bottom                 -1.25            3            0\n"
            "              sum                                  0            0            0\n"
            "              on the body; moments about (1, 0.5)\n");
}

TEST(Console, BalanceHasThreeMomentsInSpace)
{
  const certify::Balance space = {
      {0, 0, 0},
      {{certify::BalanceKind::reaction, "left", "displacement", {1, 2, 3}, {4, 5, 6}},
       {certify::BalanceKind::sum, "", "", {0, 0, 0}, {0, 0, 0}}}};
  EXPECT_THAT(app::balance_text(space, {}), AllOf(HasSubstr("moment x     moment y     moment z\n"),
                                                  HasSubstr("3            4            5            6\n")));
}

TEST(Console, InfoLeavesOutWhatIsUnknown)
{
  io::BuildFacts build = io::build_facts();
  build.blas = "OpenBLAS 0.3.21";
  build.blas_threads = 1;
  build.petsc.clear();
  EXPECT_THAT(app::info_text(build, ""), AllOf(HasSubstr("tribound      " + build.version), HasSubstr("3.4"),
                                               HasSubstr("OpenBLAS 0.3.21, 1 thread\n"),
                                               HasSubstr("report page   none"), Not(HasSubstr("PETSc"))));
  EXPECT_THAT(app::info_text(build, "/usr/share/tribound/report.html"),
              HasSubstr("report page   /usr/share/tribound/report.html\n"));
}

}  // namespace
}  // namespace tribound
