#include "tribound/problem/formula.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <muParser.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "random_formula.h"

namespace tribound::formula_cases
{
namespace
{

using testing::HasSubstr;

const Where in_case_file{"case.toml", "load.body", 3, 1};

/// The same formula in muParser, which loses digits in some functions and whose optimiser takes 0.3 && 1 for
/// false.
class Reference
{
 public:
  explicit Reference(const std::string& text)
  {
    parser_.ClearConst();
    parser_.EnableOptimizer(false);
    parser_.DefineVar("x", &x_[0]);
    parser_.DefineVar("y", &x_[1]);
    parser_.DefineVar("z", &x_[2]);
    parser_.DefineFun("asinh", [](double a) { return std::asinh(a); });
    parser_.DefineFun("acosh", [](double a) { return std::acosh(a); });
    parser_.DefineFun("atanh", [](double a) { return std::atanh(a); });
    parser_.DefineFun("log2", [](double a) { return std::log2(a); });
    parser_.SetExpr(text);
  }

  double operator()(const std::array<double, 3>& x)
  {
    std::ranges::copy(x, x_);
    return parser_.Eval();
  }

 private:
  double x_[3] = {0, 0, 0};
  mu::Parser parser_;
};

bool agree(double a, double b, double tolerance)
{
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return a == b || std::abs(a - b) <= tolerance;
}

/// The change of the value when x changes by a few units in the last place: no other evaluation can be
/// expected to agree better.
double sensitivity(const problem::Formula& formula, const std::array<double, 3>& x)
{
  const double value = formula(x);
  double change = 0.0;
  for (int k = 0; k < 3; ++k)
    for (const double factor : {1 - 4e-16, 1 + 4e-16, 1 - 2e-15, 1 + 2e-15})
    {
      std::array<double, 3> near = x;
      near[k] *= factor;
      const double difference = std::abs(formula(near) - value);
      change =
          std::isfinite(difference) ? std::max(change, difference) : std::numeric_limits<double>::infinity();
    }
  return change;
}

TEST(Formula, AgreesWithMuParser)
{
  RandomFormulas random(1);
  int n_finite = 0;
  for (int i = 0; i < 20000; ++i)
  {
    const std::string text = random.text(random.tree(1 + i % 5, false), 0.5);
    const problem::Formula formula(text, in_case_file);
    Reference reference(text);
    for (int j = 0; j < 4; ++j)
    {
      const std::array<double, 3> x = {random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
      const double expected = reference(x);
      const double value = formula(x);
      n_finite += std::isfinite(expected) ? 1 : 0;
      if (agree(value, expected, 1e-13 * std::abs(expected))) continue;
      ASSERT_TRUE(agree(value, expected, 1e-13 * std::abs(expected) + 20 * sensitivity(formula, x)))
          << text << " at " << x[0] << " " << x[1] << " " << x[2] << ": " << value << ", muParser "
          << expected;
    }
  }
  EXPECT_GT(n_finite, 40000);
}

TEST(Formula, OfManyPointsIsThatOfEachToTheLastBit)
{
  RandomFormulas random(2);
  for (int i = 0; i < 1000; ++i)
  {
    const problem::Formula formula(random.text(random.tree(4, false)), in_case_file);
    const int dim = 2 + i % 2;
    const int n = i % 100;
    std::vector<double> points(n * dim);
    for (double& coordinate : points) coordinate = random.uniform(-2, 2);
    std::vector<double> values(n);
    formula.evaluate(points, dim, values);
    for (int j = 0; j < n; ++j)
    {
      const double value = formula(std::span(points).subspan(j * dim, dim));
      if (std::isnan(value) && std::isnan(values[j])) continue;  // their signs depend on the instructions
      ASSERT_EQ(std::bit_cast<std::uint64_t>(values[j]), std::bit_cast<std::uint64_t>(value))
          << formula.text();
    }
  }
}

TEST(Formula, IsSharedByThreads)
{
  const problem::Formula formula("sin(x)*exp(-y^2) + (x > 0.3 ? sqrt(x) : max(y, z))^2", in_case_file);
  constexpr int n = 2000;
  const std::array<double, 12> cell = {0.1, 0, 0, 0.9, 0.2, 0, 0.4, 0.8, 0.1, 0.3, 0.3, 0.7};
  const auto work = [&](std::vector<double>& results)
  {
    for (int i = 0; i < n; ++i)
    {
      const double t = i / static_cast<double>(n);
      results.push_back(formula(std::array{t, 1 - t, t * t}));
      std::array<problem::Enclosure, 5> coefficients;
      formula.enclose(cell, 3, coefficients);
      results.push_back(coefficients[0].upper);
    }
  };
  std::vector<double> expected;
  work(expected);
  std::vector<std::vector<double>> results(8);
  std::vector<std::thread> threads;
  for (auto& result : results) threads.emplace_back([&] { work(result); });
  for (std::thread& thread : threads) thread.join();
  for (const auto& result : results) EXPECT_EQ(result, expected);
}

TEST(Formula, TakesAnySequenceOfSigns)
{
  const std::array<double, 3> x = {2, 3, 5};
  for (const auto& [text, expected] : std::vector<std::pair<std::string, double>>{{"--x", 2},
                                                                                  {"- -x", 2},
                                                                                  {"---x", -2},
                                                                                  {"+x", 2},
                                                                                  {"-+x", -2},
                                                                                  {"+-x", -2},
                                                                                  {"2*-x", -4},
                                                                                  {"2*--x", 4},
                                                                                  {"y--x", 5},
                                                                                  {"y---x", 1},
                                                                                  {"-x^2", -4},
                                                                                  {"--x^2", 4},
                                                                                  {"x^--2", 4},
                                                                                  {"x^-x^2", 0.0625},
                                                                                  {"-x*-y", 6},
                                                                                  {"x^-1*y", 1.5},
                                                                                  {"(-x)^3", -8}})
    EXPECT_EQ(problem::Formula(text, in_case_file)(x), expected) << text;
}

TEST(Formula, KnowsItsDegree)
{
  constexpr int no = problem::Formula::not_polynomial;
  for (const auto& [text, degree] : std::vector<std::pair<std::string, int>>{{"3", 0},
                                                                             {"sin(1)*2", 0},
                                                                             {"x", 1},
                                                                             {"-x", 1},
                                                                             {"x/2", 1},
                                                                             {"2/x", no},
                                                                             {"x^2", 2},
                                                                             {"(x+y)^3", 3},
                                                                             {"(x*y*z+1)^4 - x^5", 12},
                                                                             {"x^(1+1)", 2},
                                                                             {"x^0.5", no},
                                                                             {"x^-1", no},
                                                                             {"2^x", no},
                                                                             {"x^y", no},
                                                                             {"sin(x)", no},
                                                                             {"sin(0.1)*x", 1},
                                                                             {"abs(x)", no},
                                                                             {"x > 0", no},
                                                                             {"1 > 0 ? x^2 : sin(x)", 2},
                                                                             {"1 < 0 ? sin(y) : x", 1},
                                                                             {"x > 0 ? 1 : 1", no},
                                                                             {"sum(x, y^2, 3)", 2},
                                                                             {"avg(x, y)", 1},
                                                                             {"max(x^3)", 3},
                                                                             {"max(x, y)", no},
                                                                             {"x^100", 100},
                                                                             {"x^1e9", no},
                                                                             {"(x^1000)^1000", no},
                                                                             {"rint(2.6)*x", 1}})
    EXPECT_EQ(problem::Formula(text, in_case_file).degree(), degree) << text;
}

/// "a0 a1 a2 b; ..." for the switches, each divided by its first non-zero coefficient.
std::string switches(const std::string& text)
{
  std::string result;
  const problem::Formula formula(text, in_case_file);
  for (const auto& [a, b] : formula.switches())
  {
    const double factor = 1.0 / *std::ranges::find_if(a, [](double c) { return c != 0.0; });
    for (const double c : {a[0], a[1], a[2], b})
      result += std::to_string(std::lround(100 * c * factor)) + " ";
    result += ";";
  }
  return result;
}

TEST(Formula, ListsWhereItMayJumpOrKink)
{
  EXPECT_EQ(switches("x > 0.26 && x < 0.32 ? -1 : 0"), "100 0 0 -26 ;100 0 0 -32 ;");
  EXPECT_EQ(switches("max(0, 9-y)"), "0 100 0 -900 ;");
  EXPECT_EQ(switches("abs(2*(x+y)-1) + sign(x) + min(z/3, 1)"), "100 100 0 -50 ;100 0 0 0 ;0 0 100 -300 ;");
  EXPECT_EQ(switches("(2*x > 1) + (0.5 >= x) + (0.5 == x) + abs(3*x - 1.5)"), "100 0 0 -50 ;");
  EXPECT_EQ(switches("max(0, min(x, 1-x))"), "100 0 0 -50 ;100 0 0 0 ;100 0 0 -100 ;");
  EXPECT_EQ(switches("max(x, y, 0)"), "100 -100 0 0 ;100 0 0 0 ;0 100 0 0 ;");
  EXPECT_EQ(switches("x*x > y ? sin(x) : 0"), "");
  EXPECT_EQ(switches("x > x"), "");
}

TEST(Formula, OfAnySizeIsReadOrRefused)
{
  const auto message = [](const std::string& text) -> std::string
  {
    try
    {
      const problem::Formula formula(text, in_case_file);
    }
    catch (const InputError& error)
    {
      return error.what();
    }
    return "accepted";
  };
  const auto repeated = [](const std::string& part, int n)
  {
    std::string text;
    for (int i = 0; i < n; ++i) text += part;
    return text;
  };
  EXPECT_EQ(message(repeated("(", 150) + "x" + repeated(")", 150)), "accepted");
  EXPECT_EQ(message(repeated("x+", 40000) + "x"), "accepted");
  EXPECT_EQ(message(repeated("x>0.1?x:", 150) + "1"), "accepted");
  EXPECT_EQ(message(repeated("max(x>y,abs(z))+", 6000) + "1"), "accepted");
  EXPECT_EQ(message(repeated("max(min(x,1.5*y),abs(z-x))+", 3000) + "1"), "accepted");
  for (const std::string nested : {"(", "-", "x^", "sin(", "1?", "1?2:", "x+(", "1+2*(", "max(1,"})
    for (const int n : {300, 10000})
      EXPECT_THAT(message(repeated(nested, n)), HasSubstr("too deeply nested at character")) << nested;
  EXPECT_THAT(message(repeated("x+", 60000) + "x"), HasSubstr("is a formula of 120001 characters"));
}

TEST(Formula, EvaluatesDeepStacks)
{
  std::string text = "x";
  for (int i = 0; i < 60; ++i) text = "1<2||x&&y<1+1*2^(" + text + ")";
  const problem::Formula formula(text, in_case_file);
  EXPECT_EQ(formula(std::array{0.5, 0.5}), 1.0);
  std::array<problem::Enclosure, 2> coefficients;
  formula.enclose(std::array{0.1, 0.1, 0.2, 0.1, 0.1, 0.2}, 2, coefficients);
  EXPECT_EQ(coefficients[0].lower, 1.0);
}

}  // namespace
}  // namespace tribound::formula_cases
