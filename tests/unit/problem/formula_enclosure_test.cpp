#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tribound/problem/field.h"
#include "tribound/problem/formula.h"

namespace tribound::formula_enclosure_cases
{
namespace
{

const Where in_case_file{"case.toml", "load.body", 3, 1};
constexpr double infinity = std::numeric_limits<double>::infinity();

using Vertices = std::vector<double>;

std::vector<problem::Enclosure> enclose(const std::string& text, const Vertices& vertices, int dim, int order)
{
  std::vector<problem::Enclosure> coefficients(order + 1);
  problem::Formula(text, in_case_file).enclose(vertices, dim, coefficients);
  return coefficients;
}

void expect_range(const problem::Enclosure& enclosure, double lower, double upper)
{
  const double tolerance = 1e-13 * (1 + std::abs(lower) + std::abs(upper));
  EXPECT_NEAR(enclosure.lower, lower, tolerance);
  EXPECT_NEAR(enclosure.upper, upper, tolerance);
  EXPECT_LE(enclosure.lower, lower);
  EXPECT_GE(enclosure.upper, upper);
}

const Vertices triangle = {1, 0, 3, 0, 2, 3};  // centre (2, 1)

TEST(Enclosure, OfAnAffineFunctionIsItsRange)
{
  const auto c = enclose("3 - 2*(x - y)/4 + (x + x)/2", triangle, 2, 3);  // 3 + x/2 + y/2
  expect_range(c[0], 3.5, 5.5);
  expect_range(c[1], -1, 1);
  EXPECT_EQ(c[2].magnitude(), 0.0);
  EXPECT_EQ(c[3].magnitude(), 0.0);
}

TEST(Enclosure, OfPowersAndElementaryFunctionsIsThatOfTheirDerivatives)
{
  // x in [1, 3], x - c in [-1, 1]
  const auto cube = enclose("x^3", triangle, 2, 4);
  expect_range(cube[0], 1, 27);
  expect_range(cube[1], -27, 27);
  expect_range(cube[2], 0, 9);
  expect_range(cube[3], -1, 1);
  EXPECT_EQ(cube[4].magnitude(), 0.0);

  const auto exponential = enclose("exp(x)", triangle, 2, 15);
  double factorial = 1.0;
  for (int n = 1; n <= 15; ++n)
  {
    factorial *= n;
    EXPECT_GE(exponential[n].upper, std::exp(3.0) / factorial);
    EXPECT_LE(exponential[n].upper, std::exp(3.0) / factorial * (1 + 1e-12));
  }

  const auto reciprocal = enclose("1/x", triangle, 2, 15);
  for (int n = 0; n <= 15; ++n) EXPECT_NEAR(reciprocal[n].upper, 1.0, 1e-12);

  expect_range(enclose("sin(pi*x)", triangle, 2, 1)[0], -1, 1);
  expect_range(enclose("cos(x)", triangle, 2, 1)[0], std::cos(3.0), std::cos(1.0));
  expect_range(enclose("(x-2)^2", triangle, 2, 1)[0], 0, 1);
  expect_range(enclose("(x-2)^-2", {3, 0, 4, 0, 3, 1}, 2, 1)[0], 0.25, 1);
  expect_range(enclose("(x-2)^5", triangle, 2, 1)[0], -1, 1);
}

TEST(Enclosure, FollowsTheBranchThatIsTaken)
{
  const auto c = enclose("x > 0.5 ? x^2 : 1/(x-2)", triangle, 2, 2);
  expect_range(c[0], 1, 9);
  expect_range(c[2], 0, 1);
  EXPECT_FALSE(enclose("x > 2 ? x^2 : 1/(x-2)", triangle, 2, 2)[0].bounded());
  const auto undecided = enclose("x > 2 ? 7 : y", triangle, 2, 1);
  expect_range(undecided[0], 0, 7);
  EXPECT_FALSE(undecided[1].bounded());
  expect_range(enclose("abs(x-2) + max(x, 2)", triangle, 2, 0)[0], 2, 4);
  EXPECT_FALSE(enclose("abs(x-2)", triangle, 2, 1)[1].bounded());
  expect_range(enclose("abs(-x)", triangle, 2, 1)[1], -1, 1);
  expect_range(enclose("sign(-x) + (x > 0 && y < 5) + (x < 0 || y > 5)", triangle, 2, 1)[0], 0, 0);
  expect_range(enclose("rint(1.9 + x/100)*x", triangle, 2, 1)[1], -2, 2);
  expect_range(enclose("rint(x)", triangle, 2, 1)[0], 1, 3);
}

TEST(Enclosure, OfACellCutAlongASwitchIsSmooth)
{
  const double cut = 0.1 + 0.2;  // not 0.3
  const Vertices right = {cut, 0, 0.35, 0, cut, 0.1};
  const Vertices left = {0.25, 0, cut, 0, cut, 0.1};
  for (const std::string text :
       {"x > 0.3 ? 1 : 0", "x >= 0.3", "0.3 < x", "x > 0.3 && y >= 0", "sign(x-0.3)", "x != 0.3",
        "1 - (x == 0.3)", "max(0, min(1, x-0.3)) > 0", "x - 0.3 ? 1 : 0"})
  {
    const auto c = enclose(text, right, 2, 1);
    expect_range(c[0], 1, 1);
    EXPECT_EQ(c[1].magnitude(), 0.0) << text;
  }
  EXPECT_EQ(enclose("x > 0.3", left, 2, 1)[0].upper, 0.0);
  for (const std::string text : {"abs(x-0.3)", "max(x-0.3, 0)", "0 - min(0, 0.3-x)",
                                 "x > 0.3 ? x - 0.3 : 1/y", "x < 0.3 ? sqrt(0.3-x) : x-0.3"})
  {
    expect_range(enclose(text, right, 2, 1)[0], 0, 0.05);
    EXPECT_TRUE(enclose(text, right, 2, 1)[1].bounded()) << text;
  }
  // A facet on the switch: the comparison decides if its operands are computed without rounding.
  EXPECT_EQ(enclose("y >= 0 ? 2 : 1", {0, 0, 1, 0}, 2, 0)[0].lower, 2.0);
  EXPECT_EQ(enclose("y > 0 ? 2 : 1", {0, 0, 1, 0}, 2, 0)[0].upper, 1.0);
  EXPECT_EQ(enclose("y - 0.1 <= 0", {0, 0.1, 1, 0.1}, 2, 0)[0].lower, 1.0);
  EXPECT_EQ(enclose("-y < -0.1", {0, 0.1, 1, 0.1}, 2, 0)[0].upper, 0.0);
  for (const std::string text : {"3*y > 0.3", "x + y > x + 0.1"})
    expect_range(enclose(text, {0, 0.1, 1, 0.1}, 2, 0)[0], 0, 1);
  expect_range(enclose("y >= 0.1 + 0.5*x", {0, 0.1, 1, 0.6}, 2, 0)[0], 0, 1);
}

TEST(Enclosure, OfWhatIsUndefinedSomewhereIsEverything)
{
  for (const std::string text : {"1/(x-2)", "log(x-2)", "sqrt(x-2)", "asin(x)", "tan(x)", "(x-2)^0.5",
                                 "(x-2)^-1", "acosh(x-1)", "atanh(x-2)", "exp(1e6*x)", "1/0 + x",
                                 "atan(sqrt(x-2))", "exp(sqrt(x-2)) > -1 ? sqrt(x-2) : 0", "(-x)^x"})
  {
    const auto c = enclose(text, triangle, 2, 2);
    for (const problem::Enclosure& coefficient : c)
    {
      EXPECT_EQ(coefficient.lower, -infinity) << text;
      EXPECT_EQ(coefficient.upper, infinity) << text;
    }
  }
  // The outcome of a comparison with something undefined is unknown.
  expect_range(enclose("exp(sqrt(x-2)) > -1 ? 5 : 0", triangle, 2, 0)[0], 0, 5);
}

TEST(Enclosure, OfARootIsBoundedDownToZero)
{
  const auto c = enclose("sqrt(x-1) + (x-1)^1.5", triangle, 2, 1);
  expect_range(c[0], 0, std::sqrt(2.0) + std::pow(2.0, 1.5));
  EXPECT_FALSE(c[1].bounded());
  EXPECT_TRUE(enclose("sqrt(x)", triangle, 2, 15)[15].bounded());
}

/// Composition with the coordinates' own series agrees up to rounding; a quadratic one is as if written out.
TEST(Enclosure, OfACompositionIsThatOfTheFormulaWrittenOut)
{
  const auto composed = [](const std::string& text, const std::vector<std::string>& coordinates)
  {
    std::vector<std::array<problem::Enclosure, 3>> series;
    for (const std::string& coordinate : coordinates)
    {
      const auto c = enclose(coordinate, triangle, 2, 2);
      series.push_back({c[0], c[1], c[2]});
    }
    std::vector<problem::Enclosure> result(5);
    problem::Formula(text, in_case_file).enclose_composed(series, result);
    return result;
  };
  const auto expect_same =
      [](const std::vector<problem::Enclosure>& a, const std::vector<problem::Enclosure>& b)
  {
    for (std::size_t n = 0; n < a.size(); ++n)
    {
      const double tolerance = 1e-13 * (1 + b[n].magnitude());
      EXPECT_NEAR(a[n].lower, b[n].lower, tolerance) << n;
      EXPECT_NEAR(a[n].upper, b[n].upper, tolerance) << n;
    }
  };
  for (const std::string text : {"exp(x/9)*y + 3", "sqrt(x^2+y^2)", "7", "x > 0 ? y/x : 1"})
    expect_same(composed(text, {"x", "y"}), enclose(text, triangle, 2, 4));
  expect_same(composed("exp(x) + z", {"x^2/9", "y"}), enclose("exp(x^2/9)", triangle, 2, 4));
  expect_range(composed("2*x - y", {"x", "y"})[0], -1, 6);  // each coordinate is bounded on its own
  EXPECT_FALSE(composed("abs(x - 2)", {"x", "y"})[1].bounded());
}

TEST(Enclosure, OfABoxHoldsItsBoundary)
{
  const problem::Formula formula("y > 0 ? 1 : 2", in_case_file);
  const auto at = [&](double lower, double upper) {
    return formula.enclose_box(std::array{0.0, lower}, std::array{1.0, upper});
  };
  EXPECT_EQ(at(0, 1).upper, 2.0);
  EXPECT_EQ(at(0.1, 1).upper, 1.0);
  const problem::Formula product("x*y*z", in_case_file);
  expect_range(product.enclose_box(std::array{-1.0, 2.0, 3.0}, std::array{1.0, 4.0, 5.0}), -20, 20);
}

TEST(ExpressionEnclosure, AroundAPointTellsRoundingFromAValue)
{
  const problem::Field gap("y", in_case_file);
  const problem::Enclosure near_zero = gap.around(std::array{0.5, -5.5e-17}, 1e-15);
  EXPECT_TRUE(near_zero.contains(0.0));
  EXPECT_FALSE(gap.around(std::array{0.5, -1e-12}, 1e-15).contains(0.0));
  EXPECT_EQ(problem::Field(3.0).around(std::array{0.5, 0.5}, 1.0).lower, 3.0);
}

TEST(ExpressionEnclosure, ForwardsToTheFormula)
{
  const problem::Field formula("max(x, 0)^2", in_case_file);
  EXPECT_EQ(formula.degree(), problem::Formula::not_polynomial);
  EXPECT_EQ(formula.switches().size(), 1u);
  std::vector<double> values(2);
  formula.evaluate(std::array{2.0, 0.0, -1.0, 5.0}, 2, values);
  EXPECT_EQ(values, (std::vector{4.0, 0.0}));
  std::array<problem::Enclosure, 2> coefficients;
  formula.enclose(triangle, 2, coefficients);
  expect_range(coefficients[0], 1, 9);

  const problem::Field constant(4.0);
  EXPECT_EQ(constant.degree(), 0);
  EXPECT_TRUE(constant.switches().empty());
  constant.evaluate(std::array{2.0, 0.0, -1.0, 5.0}, 2, values);
  EXPECT_EQ(values, (std::vector{4.0, 4.0}));
  constant.enclose(triangle, 2, coefficients);
  EXPECT_EQ(coefficients[0].upper, 4.0);
  EXPECT_EQ(coefficients[1].magnitude(), 0.0);
}

TEST(ExpressionEnclosure, BatchNamesThePointWhereItIsNotFinite)
{
  const problem::Field formula("1/x", in_case_file);
  std::vector<double> values(2);
  try
  {
    formula.evaluate(std::array{1.0, 2.0, 0.0, 0.25}, 2, values);
    FAIL() << "accepted";
  }
  catch (const InputError& error)
  {
    EXPECT_NE(std::string(error.what()).find("the formula \"1/x\" is inf at the point (0, 0.25)"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace tribound::formula_enclosure_cases
