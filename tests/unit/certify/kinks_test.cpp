/// @file kinks_test.cpp
/// What is said of kinks of the contact traction against the traction on a lattice.

#include "tribound/certify/bound/kinks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace tribound::test
{

namespace
{

/// A random polynomial of degree 3 on the reference facet, small beside its value at 0 or not.
template <int k>
class Cubic
{
 public:
  Cubic(std::mt19937& dice, double mean) : mean_(mean)
  {
    std::uniform_real_distribution<double> number(-1, 1);
    for (auto& row : a_)
      for (double& a : row) a = number(dice);
  }
  double operator()(const Point<k>& s) const
  {
    double sum = mean_;
    for (int i = 0; i < k; ++i) sum += s[i] * (a_[i][0] + s[k - 1 - i] * (a_[i][1] + s[i] * a_[i][2]));
    return sum;
  }

 private:
  double mean_;
  std::array<std::array<double, 3>, k> a_;
};

template <int dim>
void expect_sound(const problem::ContactLaw& law, std::mt19937& dice)
{
  constexpr int k = dim - 1;
  std::uniform_real_distribution<double> number(-1.5, 1.5);
  std::vector<Cubic<k>> p;
  for (int a = 0; a < dim; ++a) p.emplace_back(dice, number(dice));
  const Cubic<k> threshold(dice, 4);
  const Point<dim> normal = Point<dim>::Unit(dim - 1);
  const auto at = [&](const Point<k>& s)
  {
    Point<dim> value;
    for (int a = 0; a < dim; ++a) value[a] = p[a](s);
    return value;
  };
  const auto excess = [&](const Point<k>& s)
  {
    const Point<dim> value = at(s);
    return value.template head<k>().norm() - problem::respond<dim>(law, {normal, threshold(s)}, value).limit;
  };

  const fem::Quadrature<k> rule = fem::quadrature<k>(6);
  std::vector<Point<dim>> values;
  std::vector<double> thresholds;
  for (const Point<k>& s : rule.points)
  {
    values.push_back(at(s));
    thresholds.push_back(std::holds_alternative<problem::Tresca>(law) ? threshold(s) : 0);
  }
  const certify::Kinks kinks = certify::KinkFinder<dim>(rule, 3)(law, std::span(&normal, 1), values,
                                                                 thresholds, certify::Bond::none, 1e-14);

  constexpr int m = 60;
  std::array<bool, 2> pressed{};
  std::array<bool, 2> slides{};
  double lowest = values[0][dim - 1];
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= (k == 1 ? 0 : m - i); ++j)
    {
      Point<k> s = Point<k>::Constant(static_cast<double>(j) / m);
      s[0] = static_cast<double>(i) / m;
      const double p_n = at(s)[dim - 1];
      lowest = std::min(lowest, p_n);
      pressed[p_n < 0] = true;
      if (p_n < 0 || std::holds_alternative<problem::Tresca>(law)) slides[excess(s) > 0] = true;
    }
  EXPECT_LE(kinks.lowest, lowest + 1e-12);
  const bool rubs = !std::holds_alternative<problem::Frictionless>(law);
  const bool kinked = (pressed[0] && pressed[1]) || (rubs && slides[0] && slides[1]);
  EXPECT_TRUE(kinks.possible || !kinked);
  const bool seen = std::ranges::any_of(values, [](const Point<dim>& v) { return v[dim - 1] < 0; });
  if (lowest < 0 && !seen)
  {
    EXPECT_GE(kinks.hidden, lowest * lowest * (1 - 1e-8));
  }
}

TEST(Kinks, NoneIsMissed)
{
  std::mt19937 dice(3);
  const problem::Coulomb coulomb(0.6);
  for (int trial = 0; trial < 400; ++trial)
    for (const problem::ContactLaw& law :
         {problem::ContactLaw(problem::Frictionless{}), problem::ContactLaw(problem::Tresca(1.0)),
          problem::ContactLaw(coulomb)})
    {
      expect_sound<2>(law, dice);
      expect_sound<3>(law, dice);
    }
}

TEST(Kinks, RoundingIsNone)
{
  const fem::Quadrature<1> rule = fem::quadrature<1>(6);
  std::vector<Point<2>> p;
  for (int q = 0; q < rule.size(); ++q) p.emplace_back(0, q % 2 == 0 ? 1e-15 : -1e-15);
  const std::vector<double> none(p.size(), 0.0);
  const certify::KinkFinder<2> kinks(rule, 3);
  const std::array<Point<2>, 1> up{Point<2>::UnitY()};
  EXPECT_FALSE(kinks(problem::Frictionless{}, up, p, none, certify::Bond::none, 1e-13).possible);
  EXPECT_TRUE(kinks(problem::Frictionless{}, up, p, none, certify::Bond::none, 0).possible);
}

/// Sharp: no kink is suspected where the traction keeps well away from one.
TEST(Kinks, NoneIsSuspectedFarAway)
{
  const fem::Quadrature<2> rule = fem::quadrature<2>(6);
  std::vector<Point<3>> p;
  for (const Point<2>& s : rule.points)
    p.emplace_back(0.1 + 0.05 * s[0], 0.05 * s[1], -1 - 0.4 * s[0] * s[1]);
  const std::vector<double> none(p.size(), 0.0);
  problem::Coulomb coulomb(0.3);
  const certify::KinkFinder<3> kinks(rule, 3);
  const std::array<Point<3>, 1> up{Point<3>::UnitZ()};
  EXPECT_FALSE(kinks(coulomb, up, p, none, certify::Bond::none, 0).possible);
  coulomb.coefficient = 0.05;
  EXPECT_FALSE(kinks(coulomb, up, p, none, certify::Bond::none, 0).possible);
  coulomb.coefficient = 0.12;
  EXPECT_TRUE(kinks(coulomb, up, p, none, certify::Bond::none, 0).possible);
}

}  // namespace

}  // namespace tribound::test
