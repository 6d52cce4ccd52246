/// @file transfer_test.cpp
/// Load paths on meshes that become finer along them, with what contact remembers carried from one to the
/// next.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <memory>
#include <numeric>
#include <vector>

#include "support/bonded_path.h"
#include "support/input_error.h"
#include "tribound/adapt/contact_functions.h"
#include "tribound/adapt/finer.h"
#include "tribound/adapt/transfer.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/contact/nitsche/simplex_map.h"
#include "tribound/io/record/load_step_record.h"
#include "tribound/mesh/bisect.h"

namespace tribound::transfers
{
namespace
{

using test::bonded_laws;
using test::path_of_t;
using test::peeled;
using test::peeled_mesh;
using test::ProblemData;

adapt::Method method_of(int degree)
{
  adapt::Method method{.degree = degree, .newton = {.tolerance = 1e-12}};
  method.stopping.criterion = adapt::Stopping::last_bounded;
  return method;
}

/// Problem and path of bonded_path.h.
template <int dim>
struct Peeled
{
  Peeled(const problem::ContactLaw& law, bool pairs, int degree, const adapt::PathOptions& options = {})
      : mesh(peeled_mesh<dim>(pairs)),
        problem(peeled<dim>(law, pairs).on(mesh)),
        method(method_of(degree)),
        path(problem, method, options, mesh::Mesh<dim>(peeled_mesh<dim>(pairs)))
  {
  }

  mesh::Mesh<dim> mesh;
  problem::Problem<dim> problem;
  adapt::Method method;
  adapt::LoadPath<dim> path;
};

template <int dim>
mesh::Mesh<dim> refined(const mesh::Mesh<dim>& mesh)
{
  std::vector<Index> all(mesh.n_cells());
  std::iota(all.begin(), all.end(), 0);
  return std::move(mesh::bisect<dim>(mesh, all).mesh);
}

/// Bisects all cells, `times` in all.
template <int dim>
adapt::Strategy<dim> everywhere(int times)
{
  return adapt::make_strategy<dim>({.marking = {.strategy = adapt::Marking::uniform}, .max_levels = times});
}

adapt::PathProgram through(std::vector<double> t)
{
  return {.targets = std::move(t)};
}

/// The segment that x lies in; the last has no other.
template <int dim>
std::pair<std::size_t, Point<dim - 1>> place(const contact::NitscheForm<dim>& form, const Point<dim>& x)
{
  for (std::size_t k = 0;; ++k)
  {
    const auto map = contact::simplex_map(form.space().mesh(), form.segments()[k].slave);
    const Point<dim - 1> s =
        (map.jacobian.transpose() * map.jacobian).inverse() * (map.jacobian.transpose() * (x - map.origin));
    const bool is_in = s.minCoeff() > -1e-10 && s.sum() < 1 + 1e-10 && (map(s) - x).norm() < 1e-10;
    if (is_in || k + 1 == form.segments().size()) return {k, s};
  }
}

template <int dim>
double distance(const problem::InterfaceState<dim>& a, const problem::InterfaceState<dim>& b)
{
  return std::max({std::abs(a.damage - b.damage), std::abs(a.slipped - b.slipped), (a.slip - b.slip).norm()});
}

/// The history of a path on some children is the function that it was on their parents.
template <int dim>
void expect_the_same_function(const problem::ContactLaw& law, bool pairs)
{
  SCOPED_TRACE(problem::words(law));
  Peeled<dim> run(law, pairs, 2);
  for (const double t : {0.5, 1.1}) ASSERT_EQ(run.path.advance(t), "");
  const contact::NitscheForm<dim>& from = run.path.last()->at->discrete.form;
  const contact::ContactHistory<dim>& history = *run.path.position().history;

  std::vector<Index> marked;
  for (Index c = 0; c < run.path.grid().mesh.n_cells(); c += 2) marked.push_back(c);
  const adapt::Finer<dim> finer = adapt::finer_mesh<dim>(run.path.grid().space, {}, marked);
  const problem::Problem<dim> problem = run.problem.at(1.1);
  const adapt::Discretisation<dim> discrete(finer.mesh(), problem, run.method);
  ASSERT_GT(discrete.form.segments().size(), from.segments().size());
  const auto carried = adapt::carried_history<dim>(history, from, discrete.form);

  double largest = 0;
  for (std::size_t k = 0; k < discrete.form.segments().size(); ++k)
  {
    const auto map = contact::simplex_map(discrete.mesh, discrete.form.segments()[k].slave);
    for (const double part : {0.03, 0.4, 0.91})
    {
      const Point<dim - 1> s = Point<dim - 1>::Constant(part / (dim - 1));
      const auto [parent, in_parent] = place<dim>(from, map(s));
      EXPECT_LE(distance<dim>(carried->uncut(k, s), history.uncut(parent, in_parent)), 1e-12);
      const problem::InterfaceState<dim> state = history.at(law, parent, in_parent);
      EXPECT_LE(distance<dim>(carried->at(law, k, s), state), 1e-12);
      largest = std::max(largest, distance<dim>(state, problem::fresh_state<dim>(law)));
    }
    for (const contact::ContactPoint<dim>& point : discrete.form.contact_points(k))
    {
      const auto [parent, in_parent] = place<dim>(from, point.x);
      const std::size_t q = &point - discrete.form.contact_points().data();
      EXPECT_LE(distance<dim>(carried->states()[q], history.at(law, parent, in_parent)), 1e-12);
    }
  }
  EXPECT_GT(largest, 1e-3);
}

TEST(Transfer, HistoryOfChildrenIsThatOfTheirParents)
{
  for (const problem::ContactLaw& law : bonded_laws())
    for (const bool pairs : {false, true}) expect_the_same_function<2>(law, pairs);
  for (const std::size_t i : {1, 3}) expect_the_same_function<3>(bonded_laws()[i], false);
}

/// The last step of a path that is refined everywhere in its third step, against the path that has been on
/// that mesh from the beginning, in the norm of the stress, relative; and the larger of their bounds.
struct Compared
{
  double difference;
  double bound;
};

template <int dim>
Compared transferred_and_replayed(const problem::ContactLaw& law, const std::vector<double>& t, bool pairs,
                                  int degree)
{
  const adapt::PathOptions options{.tolerance = 1e-6};
  Peeled<dim> run(law, pairs, degree, options);
  for (const double before : {t[0], t[1]}) EXPECT_EQ(run.path.advance(before), "");
  const certify::Verdict verdict =
      adapt::transfer<dim>(run.path, through({t.begin() + 2, t.end()}), everywhere<dim>(1), {});
  EXPECT_EQ(verdict.status, certify::RunStatus::budget);
  EXPECT_THAT(verdict.reason, testing::HasSubstr("adapt.max_levels = 1"));
  EXPECT_GT(run.path.grid().mesh.n_cells(), run.mesh.n_cells());
  EXPECT_EQ(run.path.last()->number, static_cast<int>(t.size()));

  adapt::LoadPath<dim> again(run.problem, run.method, options, refined<dim>(run.mesh));
  EXPECT_EQ(again.grid().mesh.n_cells(), run.path.grid().mesh.n_cells());
  for (const double to : t) EXPECT_EQ(again.advance(to), "");
  std::vector<double> difference = run.path.last()->level.u;
  for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= again.last()->level.u[i];
  const double sigma = again.last()->level.norms.sigma;
  return {contact::stress_norms(run.problem, run.path.grid().space, difference).sigma / sigma,
          std::max(again.last()->level.estimate.total_sharp, run.path.last()->level.estimate.total_sharp) /
              sigma};
}

/// Where damage grows all the time it forgets what it was.
TEST(Transfer, MonotonePathsAreThoseOfTheFinerMesh)
{
  for (const bool pairs : {false, true})
  {
    const Compared monotone = transferred_and_replayed<2>(
        problem::MixedLaw({.tension = {0.05, 0.003}, .shear_ratio = 0.9}), {0.3, 0.5, 1.1, 1.8}, pairs, 2);
    EXPECT_LE(monotone.difference, 1e-10);
  }
}

TEST(Transfer, OtherPathsDifferByLessThanTheirBounds)
{
  for (const std::size_t i : {1, 3, 5})
  {
    SCOPED_TRACE(problem::words(bonded_laws()[i]));
    const Compared cyclic =
        transferred_and_replayed<2>(bonded_laws()[i], {path_of_t.begin(), path_of_t.end()}, false, 2);
    EXPECT_LE(cyclic.difference, cyclic.bound);
    EXPECT_LE(cyclic.difference, 0.05);
  }
}

struct Followed
{
  certify::Verdict verdict{certify::RunStatus::failed, {}};
  std::vector<double> t;
  std::vector<double> bound;  ///< over the largest stress so far
  std::vector<std::int64_t> cells;
  std::vector<std::int64_t> meshes;  ///< cells of each, after the first
  int left = 0;
  std::optional<io::LoadStepRecord> record;
  adapt::PathEnd end;
};

template <int dim>
Followed followed(Peeled<dim>& run, const adapt::PathProgram& program, const adapt::Strategy<dim>& strategy)
{
  Followed result;
  const adapt::ReplayObserver<dim> observer{
      .begins = [&](int number, const adapt::Grid<dim>&) { EXPECT_EQ(number, 0); },
      .step =
          [&](const adapt::LoadStep<dim>& step)
      {
        result.t.push_back(step.t);
        result.bound.push_back(step.level.estimate.total_sharp / step.largest_sigma);
        result.cells.push_back(step.at->discrete.mesh.n_cells());
        result.record = io::load_step_record<dim>(step, result.record ? &*result.record : nullptr);
        EXPECT_EQ(step.number, static_cast<int>(result.t.size()));
        EXPECT_EQ(step.level.u.size(), run.path.grid().space.n_dofs());
      },
      .path_end = [&](const adapt::PathEnd& end) { result.end = end; },
      .complete = [&](const adapt::PassView<dim>& mesh)
      { EXPECT_EQ(mesh.number, static_cast<int>(result.meshes.size())); },
      .finer =
          [&](const adapt::PassView<dim>& left, const adapt::Grid<dim>& grid)
      {
        EXPECT_EQ(left.number, result.left++);
        result.meshes.push_back(grid.mesh.n_cells());
      }};
  result.verdict = adapt::transfer<dim>(run.path, program, strategy, observer);
  return result;
}

TEST(Transfer, RefinesUntilEveryStepHasTheTolerance)
{
  for (const bool pairs : {false, true})
  {
    Peeled<2> run(bonded_laws()[3], pairs, 2, {.tolerance = 0.04});
    const Followed path = followed<2>(run, through({path_of_t.begin(), path_of_t.end()}),
                                      adapt::make_strategy<2>({.tolerance = 0.04}));
    EXPECT_EQ(path.verdict.status, certify::RunStatus::certified) << path.verdict.reason;
    EXPECT_THAT(path.bound, testing::Each(testing::Le(0.04)));
    EXPECT_THAT(path.t, testing::ElementsAreArray(path_of_t));
    EXPECT_TRUE(std::ranges::is_sorted(path.cells));
    EXPECT_GT(path.cells.back(), path.cells.front());  // some of it along the path
    EXPECT_EQ(path.meshes.back(), path.cells.back());
    EXPECT_TRUE(path.end.notes.empty());
  }
}

/// A limit ends the refinement, not the path.
TEST(Transfer, GoesOnAtALimit)
{
  Peeled<2> run(bonded_laws()[0], false, 2, {.tolerance = 1e-6});
  const Followed path = followed<2>(run, through({path_of_t.begin(), path_of_t.end()}),
                                    adapt::make_strategy<2>({.tolerance = 1e-6, .max_levels = 2}));
  EXPECT_EQ(path.verdict.status, certify::RunStatus::budget);
  EXPECT_THAT(path.verdict.reason, testing::HasSubstr("adapt.max_levels = 2"));
  EXPECT_EQ(path.meshes.size(), 2U);
  EXPECT_THAT(path.cells, testing::Each(path.meshes.back()));
  EXPECT_THAT(path.t, testing::ElementsAreArray(path_of_t));
}

TEST(Transfer, ObstaclesIn3D)
{
  for (const std::size_t i : {1, 3})
  {
    Peeled<3> run(bonded_laws()[i], false, 1, {.tolerance = 1e-6});
    for (const double t : {path_of_t[0], path_of_t[1]}) ASSERT_EQ(run.path.advance(t), "");
    const certify::Verdict verdict = adapt::transfer<3>(
        run.path, through({path_of_t.begin() + 2, path_of_t.end()}), everywhere<3>(1),
        {.step = [](const adapt::LoadStep<3>& step)
         {
           EXPECT_TRUE(certify::is_bound(step.verdict.status)) << step.verdict.reason;
           for (const contact::ContactPoint<3>& point : step.at->discrete.form.contact_points())
           {
             EXPECT_GE(point.state.damage, 0);
             EXPECT_LE(point.state.damage, 1);
             EXPECT_GE(point.state.slipped, 0);
           }
         }});
    EXPECT_EQ(verdict.status, certify::RunStatus::budget);
    EXPECT_GT(run.path.grid().mesh.n_cells(), run.mesh.n_cells());
    EXPECT_EQ(run.path.last()->number, static_cast<int>(path_of_t.size()));
  }
}

TEST(Transfer, PairsIn3DAreRefused)
{
  Peeled<3> run(bonded_laws()[0], true, 1);
  EXPECT_THAT(
      test::message_of([&] { (void)adapt::transfer<3>(run.path, through({1}), everywhere<3>(1), {}); }),
      testing::HasSubstr("which between bodies in 3D cannot be done"));
}

/// Along a path that goes by damage t stays where the step on the coarser mesh has found it, and the next
/// steps and the search for the peak go on from functions of the finer mesh.
TEST(Transfer, PathsUnderControl)
{
  const problem::ContactLaw law = problem::JointLaw({.tension = {0.05, 0.003}, .coefficient = 0.5});
  for (const bool by_displacement : {false, true})
  {
    const double tolerance = by_displacement ? 0.047 : 0.05;
    Peeled<2> run(law, false, 2, {.tolerance = tolerance});
    adapt::PathProgram program{.targets = {0.2, 0.4},
                               .following = adapt::Following::damage,
                               .damage_step = 0.15,
                               .enough_damage = 0.7};
    if (by_displacement)
    {
      program.following = adapt::Following::displacement;
      program.displacement = {.gauges = {{.boundary = "right", .component = 1}}, .step = 0.01, .until = 0.12};
    }
    const Followed path = followed<2>(run, program, adapt::make_strategy<2>({.tolerance = tolerance}));
    EXPECT_EQ(path.end.failure, "");
    EXPECT_THAT(path.end.notes, testing::IsEmpty());
    EXPECT_EQ(path.verdict.status, certify::RunStatus::certified) << path.verdict.reason;
    EXPECT_GT(path.t.size(), 5U);
    EXPECT_GT(path.cells.back(), path.cells.front());
    EXPECT_EQ(run.path.last()->control, by_displacement ? "displacement" : "damage");
  }
}

/// A block on a bond that is broken from x = 1.2 on, lifted at its top by 0.04 t: t has a peak and falls
/// back.
ProblemData<2> torn()
{
  ProblemData<2> data{
      .boundaries = {problem::with_displacement<2>("top", {problem::Field(0.0), test::formula("0.04*t")}),
                     test::obstacle<2>("bottom", problem::JointLaw({.tension = {0.05, 0.0005}}))}};
  data.boundaries.back().contact->broken = test::formula("x > 1.2");
  return data;
}

adapt::PathProgram beyond_the_peak()
{
  return {.targets = {0.2, 0.4},
          .following = adapt::Following::damage,
          .damage_step = 0.1,
          .enough_damage = 0.95};
}

/// Its peak is nearer than a hundredth to that of a mesh that is fine from the beginning.
TEST(Transfer, APeakIsThatOfAFineMesh)
{
  const adapt::PathProgram program = beyond_the_peak();
  const adapt::Method method = method_of(2);
  const mesh::Mesh<2> coarse(peeled_mesh<2>(false));
  const problem::Problem<2> problem = torn().on(coarse);
  adapt::LoadPath<2> on_fine(problem, method, {}, refined<2>(refined<2>(coarse)));
  const adapt::PathEnd fine = adapt::follow<2>(on_fine, program, {}, {});
  ASSERT_TRUE(fine.peak);

  adapt::LoadPath<2> path(problem, method, {.tolerance = 0.06}, mesh::Mesh<2>(peeled_mesh<2>(false)));
  adapt::PathEnd end;
  const certify::Verdict verdict =
      adapt::transfer<2>(path, program, adapt::make_strategy<2>({.tolerance = 0.06, .max_levels = 12}),
                         {.path_end = [&](const adapt::PathEnd& e) { end = e; }});
  EXPECT_EQ(end.failure, "");
  EXPECT_TRUE(certify::is_bound(verdict.status)) << verdict.reason;
  EXPECT_THAT(end.notes, testing::IsEmpty());
  ASSERT_TRUE(end.peak);
  EXPECT_NEAR(end.peak->t, fine.peak->t, 0.01 * fine.peak->t);
}

/// The peak of the finer mesh may be below the t that the coarser one has found, so that there is no solution
/// on it, or one on another branch: the step then stays on the coarser one.
TEST(Transfer, AStepBeyondThePeakOfTheFinerMeshStays)
{
  const adapt::Method method = method_of(1);
  const problem::Problem<2> problem = torn().on(mesh::Mesh<2>(peeled_mesh<2>(false)));
  const auto notes = [&](double tolerance)
  {
    adapt::LoadPath<2> path(problem, method, {.tolerance = tolerance}, mesh::Mesh<2>(peeled_mesh<2>(false)));
    adapt::PathEnd end;
    const certify::Verdict verdict =
        adapt::transfer<2>(path, beyond_the_peak(), adapt::make_strategy<2>({.tolerance = tolerance}),
                           {.path_end = [&](const adapt::PathEnd& e) { end = e; }});
    EXPECT_EQ(end.failure, "");
    EXPECT_EQ(verdict.status, end.notes.empty() ? certify::RunStatus::certified : certify::RunStatus::budget);
    EXPECT_GT(path.last()->number, 10);
    EXPECT_NEAR(end.peak.value_or(adapt::Peak()).t, 0.74, 0.01);
    return end.notes;
  };
  // On which meshes a step is beyond the peak depends on the tolerance.
  std::vector<std::string> all;
  for (const double tolerance : {0.07, 0.1, 0.12, 0.18, 0.25})
    std::ranges::move(notes(tolerance), std::back_inserter(all));
  EXPECT_THAT(all, testing::Each(testing::HasSubstr("stays on the coarser mesh: ")));
  EXPECT_THAT(all, testing::Contains(testing::HasSubstr("the solution is on another branch")));
  EXPECT_THAT(all, testing::Contains(testing::HasSubstr("above newton.tolerance")));
}

/// Work is made from forces of two steps, the earlier of which have been carried.
TEST(Transfer, EnergiesBalance)
{
  for (const std::size_t i : {1, 3})
  {
    Peeled<2> run(bonded_laws()[i], false, 2, {.tolerance = 0.03});
    std::vector<double> t(16);
    for (std::size_t n = 0; n < t.size(); ++n) t[n] = 1.5 * static_cast<double>(n + 1) / 16;
    const Followed path = followed<2>(run, through(t), adapt::make_strategy<2>({.tolerance = 0.03}));
    EXPECT_GT(path.cells.back(), path.cells.front());
    EXPECT_LE(std::abs(path.record->balance), 0.02 * path.record->work);
  }
}

}  // namespace
}  // namespace tribound::transfers
