/// @file contact_law_test.cpp
/// Properties of every contact law in both dimensions: the tangent is the derivative of the response,
/// tractions obey the law, and the cone agrees with the limit where contact is closed.

#include "tribound/problem/contact_law.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>
#include <vector>

namespace tribound
{
namespace
{

using problem::ContactLaw;
using problem::ContactStatus;

std::vector<ContactLaw> laws()
{
  std::vector<ContactLaw> all;
  for (const problem::LawKind& kind : problem::obstacle_law_kinds())
  {
    const std::vector<problem::Field> values(kind.keys.size(), problem::Field(0.4));
    all.push_back(kind.make(values));
  }
  return all;
}

template <int dim>
Point<dim> random_vector(std::mt19937& dice)
{
  std::normal_distribution<double> number;
  Point<dim> v;
  for (int a = 0; a < dim; ++a) v[a] = number(dice);
  return v;
}

template <int dim>
void expect_kept(const ContactLaw& law, double delta, std::mt19937& dice)
{
  const problem::FrictionCone cone = problem::cone(law);
  problem::LawPoint<dim> point{random_vector<dim>(dice).normalized()};
  if (cone.strength != nullptr) point.strength = cone.strength->constant();
  const Point<dim> P = random_vector<dim>(dice);
  const problem::Response<dim> response = problem::respond<dim>(law, point, P, delta);
  const Point<dim>& n = point.normal;
  const double p_n = P.dot(n);
  const double t_n = response.traction.dot(n);
  const Point<dim> t_t = response.traction - t_n * n;

  EXPECT_LE(t_n, 1e-15);
  EXPECT_LE(t_t.norm(), response.limit + 1e-15);
  if (delta == 0 && p_n < 0)
  {
    EXPECT_NEAR(response.limit, cone.closed_limit(point.strength, p_n), 1e-15);
  }
  EXPECT_EQ(response.status == ContactStatus::open, p_n > 0);
  if (delta == 0 && response.status == ContactStatus::stick)
  {
    EXPECT_LE((response.traction - P).norm(), 1e-15);
  }

  const double step = 1e-6;
  const Point<dim> direction = random_vector<dim>(dice);
  const auto traction = [&](double along)
  { return problem::respond<dim>(law, point, P + along * direction, delta).traction; };
  const Point<dim> difference = (traction(step) - traction(-step)) / (2 * step);
  const Point<dim> derivative = problem::tangent<dim>(law, point, P, delta) * direction;
  EXPECT_LE((difference - derivative).norm(), 1e-8 * (1 + 1 / std::max(delta, 0.01))) << problem::name(law);
}

TEST(ContactLaw, TangentIsTheDerivativeAndTheTractionObeysTheLaw)
{
  std::mt19937 dice(1);
  for (const ContactLaw& law : laws())
    for (const double delta : {0.0, 0.3})
      for (int trial = 0; trial < 200; ++trial)
      {
        expect_kept<2>(law, delta, dice);
        expect_kept<3>(law, delta, dice);
      }
}

/// Terzaghi: the law holds for T + p_w n. On an open joint without cohesion only water acts, against n.
template <int dim>
void expect_effective(const ContactLaw& law, std::mt19937& dice)
{
  std::uniform_real_distribution<double> between(0, 1);
  problem::LawPoint<dim> dry{.normal = random_vector<dim>(dice).normalized(), .gamma = 10};
  if (problem::cone(law).strength != nullptr) dry.strength = 0.4;
  dry.state = problem::fresh_state<dim>(law);
  problem::LawPoint<dim> wet = dry;
  wet.water = between(dice);
  const Point<dim> pressure = wet.water * wet.normal;
  const Point<dim> P = random_vector<dim>(dice);
  const Point<dim> shifted = P + pressure;
  const auto response = problem::respond<dim>(law, wet, P);
  const auto effective = problem::respond<dim>(law, dry, shifted);
  EXPECT_LE((response.traction + pressure - effective.traction).norm(), 1e-14);
  EXPECT_EQ(response.limit, effective.limit);
  EXPECT_EQ(response.status, effective.status);
  EXPECT_EQ(problem::tangent<dim>(law, wet, P), problem::tangent<dim>(law, dry, shifted));
  const auto committed = problem::advance<dim>(law, wet, P);
  const auto committed_dry = problem::advance<dim>(law, dry, shifted);
  EXPECT_LE((committed.traction + pressure - committed_dry.traction).norm(), 1e-14);
  EXPECT_EQ(committed.state.damage, committed_dry.state.damage);
  EXPECT_EQ(committed.state.slip, committed_dry.state.slip);
  EXPECT_EQ(committed.stored, committed_dry.stored);
  EXPECT_EQ(committed.dissipated, committed_dry.dissipated);
  if (dry.strength == 0 && !problem::has_memory(law) && !problem::cone(law).is_tied &&
      shifted.dot(wet.normal) > 0)
  {
    EXPECT_LE((response.traction + pressure).norm(), 1e-14);
  }
}

TEST(ContactLaw, HoldsOfTheEffectiveTraction)
{
  std::mt19937 dice(3);
  std::vector<ContactLaw> all = laws();
  all.insert(all.end(), {problem::JointLaw({.tension = {0.5, 0.3}, .cohesion = 0.2, .coefficient = 0.5}, 0.4),
                         problem::MixedLaw({.tension = {0.5, 0.3}, .shear_ratio = 0.8, .coefficient = 0.5}),
                         problem::EndoLaw({5, 4, 0.8, 0.3, 0.12, 0.003}), problem::Tied()});
  for (const ContactLaw& law : all)
    for (int trial = 0; trial < 200; ++trial)
    {
      expect_effective<2>(law, dice);
      expect_effective<3>(law, dice);
    }
}

/// A value interpolated between points, or from another mesh, need not be an admissible state.
TEST(ContactLaw, CutsStatesThatNoStepLeaves)
{
  const ContactLaw law = problem::JointLaw({.cohesion = 0.7, .slip_length = 2});
  const auto cut = [](const ContactLaw& of, double damage, double slipped)
  {
    const auto state = problem::admissible<2>(of, {.damage = damage, .slipped = slipped});
    return std::pair(state.damage, state.slipped);
  };
  EXPECT_EQ(cut(law, -0.1, -0.2), std::pair(0.0, 0.0));
  EXPECT_EQ(cut(law, 0.25, 0.4), std::pair(0.25, 0.4));
  EXPECT_EQ(cut(law, 0.25, 0.6), std::pair(0.25, 0.5));  // q <= D slip_c
  EXPECT_EQ(cut(law, 1.1, 3), std::pair(1.0, 3.0));
  EXPECT_EQ(cut(problem::JointLaw({.cohesion = 0.7}), 0.25, 0.6), std::pair(0.25, 0.6));
}

TEST(ContactLaw, KindsAreNamedOnceAndMadeFromTheirKeys)
{
  std::set<std::string_view> names;
  std::set<std::string_view> keys;
  const std::vector<ContactLaw> all = laws();
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    const problem::LawKind& kind = problem::obstacle_law_kinds()[i];
    EXPECT_EQ(problem::name(all[i]), kind.name);
    EXPECT_EQ(all[i].index(), i);
    EXPECT_FALSE(problem::words(all[i]).empty());
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    for (const problem::LawKey& key : kind.keys) EXPECT_TRUE(keys.insert(key.key).second) << key.key;
  }
}

TEST(ContactLaw, WhatIsTiedCarriesAnything)
{
  const ContactLaw tied = problem::Tied();
  std::mt19937 dice(2);
  const Point<3> P = random_vector<3>(dice);
  const problem::LawPoint<3> point{random_vector<3>(dice).normalized()};
  for (const double delta : {0.0, 0.3})
  {
    const problem::Response<3> response = problem::respond<3>(tied, point, P, delta);
    EXPECT_EQ(response.traction, P);
    EXPECT_EQ(response.status, ContactStatus::tied);
    EXPECT_EQ(problem::tangent<3>(tied, point, P, delta), Tensor<3>(Tensor<3>::Identity()));
  }
  EXPECT_TRUE(problem::cone(tied).is_tied);
  for (const ContactLaw& law : laws()) EXPECT_FALSE(problem::cone(law).is_tied);
}

TEST(ContactLaw, OnlyFrictionResistsSliding)
{
  EXPECT_FALSE(cone(problem::Frictionless()).resists_sliding());
  EXPECT_FALSE(cone(problem::Tresca(0.0)).resists_sliding());
  EXPECT_FALSE(cone(problem::Coulomb(0.0)).resists_sliding());
  EXPECT_TRUE(cone(problem::Tresca(problem::Field("x", {}))).resists_sliding());
  EXPECT_TRUE(cone(problem::Coulomb(0.1)).resists_sliding());
  EXPECT_TRUE(cone(problem::Tied()).resists_sliding());
}

}  // namespace
}  // namespace tribound
