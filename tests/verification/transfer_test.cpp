/// @file transfer_test.cpp
/// Load paths on meshes that become finer along them; the history of contact is transferred from mesh to
/// mesh.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "support/input_error.h"
#include "tribound/adapt/contact_functions.h"
#include "tribound/adapt/finer.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/contact/nitsche/simplex_map.h"
#include "verification/transfer_paths.h"

namespace tribound::transfers
{
namespace
{

/// Bisects all cells, `times` times in total.
template <int dim>
adapt::Strategy<dim> everywhere(int times)
{
  return adapt::make_strategy<dim>({.marking = {.strategy = adapt::Marking::uniform}, .max_levels = times});
}

/// The segment that x lies in; the last one if there is no other.
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

/// On children, the history of a path is the same function as on their parents.
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

/// The last step of a path that is refined everywhere in its third step, against the path on the fine mesh
/// from the beginning: their relative difference in the norm of the stress, and the larger of their bounds.
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

/// Damage that keeps growing forgets its history.
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

TEST(Transfer, RefinesUntilEveryStepHasTheTolerance)
{
  constexpr double tolerance = 0.03;
  for (const bool pairs : {false, true})
  {
    Peeled<2> run(bonded_laws()[3], pairs, 2, {.tolerance = tolerance});
    const Followed path = followed<2>(run, through({path_of_t.begin(), path_of_t.end()}),
                                      adapt::make_strategy<2>({.tolerance = tolerance}));
    EXPECT_EQ(path.verdict.status, certify::RunStatus::certified) << path.verdict.reason;
    EXPECT_THAT(path.bound, testing::Each(testing::Le(tolerance)));
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
      testing::HasSubstr("not available between bodies in 3D"));
}

/// Work is computed from the forces of two steps; those of the earlier step were transferred.
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
