/// @file nitsche_test.cpp
/// The tangent of the contact form against central differences of its tractions, for every friction law and
/// contact state.

#include "tribound/contact/nitsche/nitsche.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <string>
#include <tuple>
#include <vector>

#include "support/contact_points.h"
#include "support/discrete_problem.h"
#include "support/fields.h"
#include "support/meshes.h"

namespace tribound::test
{

namespace
{

/// A friction law with parameters that make the displacements of `background` stick or slip.
struct Law
{
  std::string name;
  problem::ContactLaw sticking;
  problem::ContactLaw slipping;

  [[nodiscard]] const problem::ContactLaw& making(problem::ContactStatus status) const
  {
    return status == problem::ContactStatus::slip ? slipping : sticking;
  }
};

const Law frictionless{"none", Frictionless(), Frictionless()};
const Law tresca{"tresca", Tresca(formula("100 + x")), Tresca(formula("0.02 + 0.01*x"))};
const Law coulomb{"coulomb", Coulomb(2), Coulomb(0.2)};

void PrintTo(const Law& law, std::ostream* out)
{
  *out << law.name;
}

/// A bent block held from above.
template <int dim>
DiscreteProblem<dim> held_block(int p, const problem::ContactLaw& law, unsigned seed)
{
  mesh::MeshData<dim> data;
  if constexpr (dim == 2)
    data = block<2>({4, 2});
  else
    data = box<3>({0, 0, 0}, {1, 1, 1}, {2, 1, 2});
  return {distorted(std::move(data), seed),
          {.boundaries = {clamped<dim>("top"), fixed<dim>("left", 0, free, free),
                          obstacle<dim>("bottom", law, formula("0.01 + 0.005*x"))}},
          {.degree = p}};
}

/// Displacements with all points safely in `status`: pushed into the obstacle below (or pulled off it) and
/// sideways, in 3D oblique to the axes, with a small random perturbation.
template <int dim>
std::vector<double> displaced(const DiscreteProblem<dim>& c, problem::ContactStatus status, unsigned seed)
{
  const double down = status == problem::ContactStatus::open ? -0.1 : 0.1;
  Point<dim> background = Point<dim>::Zero();
  background[0] = 0.05;
  background[dim - 1] = 0.03;
  background[1] = -down;
  std::vector<double> u = interpolate<dim>(c.space, [&](const Point<dim>&) { return background; });
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-5e-4, 5e-4);
  for (double& value : u) value += uniform(random);
  return u;
}

/// The statuses at the contact points of the form.
template <int dim>
std::vector<problem::ContactStatus> statuses(const contact::NitscheForm<dim>& form, std::span<const double> u)
{
  std::vector<problem::ContactStatus> result;
  for (const contact::ContactState<dim>& state : contact_states(form, u)) result.push_back(state.status);
  return result;
}

/// (T(u), phi_i)_C for free i.
template <int dim>
std::vector<double> contact_forces(const contact::NitscheForm<dim>& form, std::span<const double> u)
{
  std::vector<double> forces(form.space().n_dofs(), 0.0);
  form.add_contact_load(form.traction(u), forces);
  return free_part(form.constraints(), forces);
}

/// a(u, phi_i) - (T(u), phi_i)_C for free i.
template <int dim>
std::vector<double> residual(const DiscreteProblem<dim>& c, std::span<const double> u)
{
  const std::vector<double> ku =
      free_part(c.form.constraints(), contact::apply_stiffness<dim>(c.problem, c.space, u));
  return sum(ku, -1, contact_forces(c.form, u));
}

template <int dim>
void expect_tangent_agrees_with_differences(int p, const Law& law, problem::ContactStatus status)
{
  const DiscreteProblem<dim> c = held_block<dim>(p, law.making(status), p);
  const fem::Constraints& constraints = c.form.constraints();
  const std::vector<double> u = displaced(c, status, 1);
  const problem::ContactStatus expected =
      law.name == "none" && status == problem::ContactStatus::stick ? problem::ContactStatus::slip : status;
  for (const problem::ContactStatus s : statuses(c.form, u)) ASSERT_EQ(s, expected);

  constexpr double h = 1e-6;
  const std::vector<double> w = random_free_vector(constraints, 1.0, 2);
  const std::vector<double> ahead = sum(u, h, w);
  const std::vector<double> behind = sum(u, -h, w);
  const auto difference = [&](const auto& f)
  {
    std::vector<double> d = sum(f(ahead), -1, f(behind));
    for (double& x : d) x /= 2 * h;
    return d;
  };

  const algebra::Triplets tangent = c.form.contact_tangent(contact::Linearisation::newton, u);
  const std::vector<double> contact = multiply(tangent, w);
  const std::vector<double> by_difference =
      difference([&](const std::vector<double>& v) { return contact_forces(c.form, v); });
  EXPECT_LE(norm(sum(contact, 1, by_difference)), 1e-7 * norm(contact));

  const std::vector<double> whole =
      sum(multiply(entries(contact::stiffness(c.problem, c.space, constraints)), w), 1, contact);
  const std::vector<double> whole_by_difference =
      difference([&](const std::vector<double>& v) { return residual(c, v); });
  EXPECT_LE(distance(whole, whole_by_difference), 1e-7 * norm(whole));
  // The threshold does not depend on the pressure: Tresca's tangent is non-zero on open contact, too.
  const bool is_zero = status == problem::ContactStatus::open && law.name != "tresca";
  EXPECT_EQ(norm(contact) == 0, is_zero);
}

class Tangent : public ::testing::TestWithParam<std::tuple<Law, problem::ContactStatus, int>>
{
};

TEST_P(Tangent, AgreesWithDifferencesIn2D)
{
  const auto& [law, status, p] = GetParam();
  expect_tangent_agrees_with_differences<2>(p, law, status);
}

TEST_P(Tangent, AgreesWithDifferencesIn3D)
{
  const auto& [law, status, p] = GetParam();
  expect_tangent_agrees_with_differences<3>(p, law, status);
}

std::string test_name(const ::testing::TestParamInfo<Tangent::ParamType>& info)
{
  const auto& [law, status, p] = info.param;
  const std::array names{"open", "stick", "slip"};
  return law.name + "_" + names[static_cast<int>(status)] + "_P" + std::to_string(p);
}

INSTANTIATE_TEST_SUITE_P(AllLaws, Tangent,
                         ::testing::Combine(::testing::Values(frictionless, tresca, coulomb),
                                            ::testing::Values(problem::ContactStatus::open,
                                                              problem::ContactStatus::stick,
                                                              problem::ContactStatus::slip),
                                            ::testing::Range(1, 5)),
                         test_name);

template <int dim>
void expect_linearised_traction_agrees(const Law& law, problem::ContactStatus status)
{
  const DiscreteProblem<dim> c = held_block<dim>(2, law.making(status), 7);
  const contact::NitscheForm<dim>& form = c.form;
  const std::vector<double> u = displaced(c, status, 1);
  const std::vector<double> step = random_free_vector(form.constraints(), 1.0, 2);
  constexpr double h = 1e-6;

  const std::vector<Point<dim>> at_u = form.traction(u);
  const std::vector<Point<dim>> ahead = form.traction(sum(u, h, step));
  const std::vector<Point<dim>> behind = form.traction(sum(u, -h, step));
  const std::vector<Point<dim>> same = form.linearised_traction(contact::Linearisation::newton, u, u);
  const std::vector<Point<dim>> there =
      form.linearised_traction(contact::Linearisation::newton, u, sum(u, 1, step));
  ASSERT_EQ(at_u.size(), form.n_contact_points());
  for (std::size_t i = 0; i < at_u.size(); ++i)
  {
    EXPECT_LE((same[i] - at_u[i]).norm(), 1e-13 * (1 + at_u[i].norm()));
    const Point<dim> expected = at_u[i] + (ahead[i] - behind[i]) / (2 * h);
    EXPECT_LE((there[i] - expected).norm(), 1e-6 * (1 + expected.norm()));
  }
}

TEST(LinearisedTraction, AgreesWithDifferences)
{
  for (const Law& law : {frictionless, tresca, coulomb})
    for (const problem::ContactStatus status :
         {problem::ContactStatus::open, problem::ContactStatus::stick, problem::ContactStatus::slip})
    {
      SCOPED_TRACE(law.name);
      expect_linearised_traction_agrees<2>(law, status);
      expect_linearised_traction_agrees<3>(law, status);
    }
}

TEST(NitscheForm, WithAnotherGammaIsThatMadeWithIt)
{
  const DiscreteProblem<3> c = held_block<3>(2, tresca.slipping, 7);
  const std::vector<double> u = random_free_vector(c.form.constraints(), 0.02, 3);
  const contact::NitscheForm<3> other = c.form.with_gamma0(0.7);
  const contact::NitscheForm<3> made(c.problem, c.space, 0.7);
  EXPECT_EQ(other.gamma0(), 0.7);
  const std::vector<Point<3>> t = other.traction(u);
  const std::vector<Point<3>> expected = made.traction(u);
  ASSERT_EQ(t.size(), expected.size());
  for (std::size_t i = 0; i < t.size(); ++i)
    EXPECT_LE((t[i] - expected[i]).norm(), 1e-13 * (1 + expected[i].norm()));
  const std::vector<double> tangent = other.contact_tangent(contact::Linearisation::newton, u).values;
  const std::vector<double> expected_tangent = made.contact_tangent(contact::Linearisation::newton, u).values;
  EXPECT_LE(norm(sum(tangent, -1, expected_tangent)), 1e-13 * norm(expected_tangent));
}

/// T_delta has no kinks: its tangent is its derivative for every u, on either side of the kinks and between.
template <int dim>
void expect_regularised_tangent_agrees(const Law& law, double delta)
{
  const DiscreteProblem<dim> c = held_block<dim>(2, law.slipping, 7);
  const contact::NitscheForm<dim>& form = c.form;
  const std::vector<double> u = random_free_vector(form.constraints(), 0.02, 3);
  const std::vector<double> step = random_free_vector(form.constraints(), 1.0, 2);
  const std::vector<problem::ContactStatus> found = statuses(form, u);
  EXPECT_GT(std::ranges::count(found, problem::ContactStatus::open), 0);
  EXPECT_GT(std::ranges::count(found, problem::ContactStatus::slip), 0);
  constexpr double h = 1e-7;

  const std::vector<Point<dim>> at_u = form.traction(u, delta);
  std::vector<Point<dim>> difference = form.traction(sum(u, h, step), delta);
  const std::vector<Point<dim>> behind = form.traction(sum(u, -h, step), delta);
  const std::vector<Point<dim>> there =
      form.linearised_traction(contact::Linearisation::newton, u, sum(u, 1, step), delta);
  for (std::size_t i = 0; i < at_u.size(); ++i)
  {
    difference[i] = (difference[i] - behind[i]) / (2 * h);
    EXPECT_LE((there[i] - at_u[i] - difference[i]).norm(), 2e-5 * (1 + difference[i].norm()));
  }
  std::vector<double> forces(form.space().n_dofs(), 0.0);
  form.add_contact_load(difference, forces);
  const std::vector<double> tangent =
      multiply(form.contact_tangent(contact::Linearisation::newton, u, delta), step);
  EXPECT_LE(norm(sum(tangent, 1, free_part(form.constraints(), forces))), 2e-5 * norm(tangent));
}

TEST(RegularisedTangent, AgreesWithDifferencesEverywhere)
{
  for (const Law& law : {frictionless, tresca, coulomb})
    for (const double delta : {0.05, 1.0})
    {
      SCOPED_TRACE(law.name);
      expect_regularised_tangent_agrees<2>(law, delta);
      expect_regularised_tangent_agrees<3>(law, delta);
    }
}

TEST(ContactTangent, PatternDoesNotDependOnTheState)
{
  const DiscreteProblem<3> c = held_block<3>(2, coulomb.slipping, 4);
  const algebra::Triplets open =
      c.form.contact_tangent(contact::Linearisation::newton, displaced(c, problem::ContactStatus::open, 1));
  const algebra::Triplets slip =
      c.form.contact_tangent(contact::Linearisation::newton, displaced(c, problem::ContactStatus::slip, 1));
  const std::vector<double> zero(c.space.n_dofs(), 0.0);
  const algebra::Triplets first = c.form.contact_tangent(contact::Linearisation::closed_sticking, zero);
  EXPECT_FALSE(open.rows.empty());
  EXPECT_EQ(open.rows, slip.rows);
  EXPECT_EQ(open.cols, slip.cols);
  EXPECT_EQ(first.rows, slip.rows);
  EXPECT_EQ(first.cols, slip.cols);
}

TEST(ContactTangent, FixedDegreesOfFreedomHaveNoEntries)
{
  const DiscreteProblem<2> c = held_block<2>(3, tresca.slipping, 4);
  const algebra::Triplets tangent =
      c.form.contact_tangent(contact::Linearisation::newton, displaced(c, problem::ContactStatus::slip, 1));
  int n_dropped = 0;
  for (std::size_t k = 0; k < tangent.values.size(); ++k)
    for (const int dof : {tangent.rows[k], tangent.cols[k]})
    {
      n_dropped += dof < 0;
      EXPECT_TRUE(dof < 0 || !c.form.constraints().fixed[dof]);
    }
  EXPECT_GT(n_dropped, 0);
}

}  // namespace

}  // namespace tribound::test
