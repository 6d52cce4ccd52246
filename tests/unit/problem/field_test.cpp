#include "tribound/problem/field.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "support/input_error.h"
#include "tribound/problem/formula.h"

namespace tribound
{
namespace
{

using testing::HasSubstr;

const Where in_case_file{"case.toml", "boundary.top.pressure", 12, 11};

double at(const std::string& formula, const Point<3>& x)
{
  return problem::Field(formula, in_case_file)(x);
}

std::string message(const std::string& formula)
{
  return test::message_of([&] { const problem::Field expression(formula, in_case_file); });
}

TEST(Field, EvaluatesFormulas)
{
  const Point<3> x(2, 3, 5);
  EXPECT_DOUBLE_EQ(at("x + 10*y + 100*z", x), 532);
  EXPECT_DOUBLE_EQ(at("9810*max(0, 9-y)", x), 9810 * 6);
  EXPECT_DOUBLE_EQ(at("-x^2", x), -4);
  EXPECT_DOUBLE_EQ(at("x^y^2", x), 512);
  EXPECT_DOUBLE_EQ(at("x < 1 ? 7 : 8", x), 8);
  EXPECT_DOUBLE_EQ(at("x == 2 && y >= 3 && z != 4", x), 1);
  EXPECT_DOUBLE_EQ(at("sin(pi*x/4) + ln(e^y)", x), 4);
  EXPECT_DOUBLE_EQ(at("log(x)", x), std::log(2.0));
  EXPECT_DOUBLE_EQ(at("1.5e-3*x + 2.E+1 + .5", x), 20.503);
  EXPECT_DOUBLE_EQ(at("x\n  + y", x), 5);
}

TEST(Field, IsEvaluatedIn2DWithoutZ)
{
  const problem::Field formula("x - y", in_case_file);
  EXPECT_EQ(formula(Point<2>(1, 2)), -1);
  EXPECT_EQ(formula(Point<3>(1, 2, 3)), -1);
}

TEST(Field, KnowsWhatItDependsOn)
{
  const problem::Field constant("2*pi", in_case_file);
  EXPECT_TRUE(constant.is_constant());
  EXPECT_FALSE(constant.is_zero());
  EXPECT_DOUBLE_EQ(constant(Point<2>(9, 9)), 2 * std::numbers::pi);
  EXPECT_TRUE(problem::Field("1 - 1", in_case_file).is_zero());
  EXPECT_TRUE(problem::Field().is_zero());
  EXPECT_FALSE(problem::Field(3.0).is_zero());
  EXPECT_FALSE(problem::Field("0*x", in_case_file).is_constant());
  EXPECT_TRUE(problem::Field("x + sin(z)", in_case_file).uses_z());
  EXPECT_FALSE(problem::Field("x + y", in_case_file).uses_z());
  EXPECT_FALSE(problem::Field(1.0).uses_z());
  EXPECT_EQ(problem::Field(1.0, in_case_file).where().line, 12);
}

TEST(Field, CopiesAreIndependent)
{
  const Point<2> a(1, 0);
  const Point<2> b(2, 0);
  problem::Field copy;
  {
    const problem::Field original("10*x", in_case_file);
    copy = original;
    EXPECT_EQ(original(a), 10);
    EXPECT_EQ(copy(b), 20);
    EXPECT_EQ(original(a), 10);
  }
  EXPECT_EQ(copy(a), 10);
  const problem::Field moved = std::move(copy);
  EXPECT_EQ(moved(b), 20);
  std::vector<problem::Field> many(3, moved);
  many.resize(100, problem::Field("y", in_case_file));
  EXPECT_EQ(many[2](b), 20);
  EXPECT_EQ(many[99](Point<2>(0, 4)), 4);
}

TEST(Field, FollowsTheLoadFactor)
{
  const problem::Field field("2*t*x + t^2", Where{});
  EXPECT_TRUE(field.uses_time());
  EXPECT_EQ(field(Point<2>(3, 0)), 7);  // t = 1
  const problem::Field later = field.at(0.5);
  EXPECT_EQ(later(Point<2>(3, 0)), 3.25);
  EXPECT_EQ(later.at(-1)(Point<2>(3, 0)), -5);
  EXPECT_EQ(later.degree(), 1);
  const problem::Field folded = problem::Field("t*(4 - t)", Where{}).at(4);
  EXPECT_TRUE(folded.is_zero());
  EXPECT_EQ(folded.at(2).constant(), 4);  // still the formula
  EXPECT_FALSE(problem::Field("2*x", Where{}).uses_time());
  EXPECT_EQ(problem::Field("2*x", Where{}).at(5)(Point<2>(1, 0)), 2);
  EXPECT_THROW((void)problem::Field("1/t", Where{}).at(0), InputError);
}

struct BadFormula
{
  std::string formula;
  std::string problem;
  std::string hint;
};

class BadExpression : public testing::TestWithParam<BadFormula>
{
};

TEST_P(BadExpression, IsRejectedWithThePosition)
{
  const std::string text = message(GetParam().formula);
  EXPECT_THAT(text, HasSubstr("case.toml:12:11: boundary.top.pressure: "));
  EXPECT_THAT(text, HasSubstr(GetParam().problem));
  EXPECT_THAT(text, HasSubstr(GetParam().hint));
}

INSTANTIATE_TEST_SUITE_P(
    Syntax, BadExpression,
    testing::Values(BadFormula{"9810*mxx(0, 9-y)", "unknown name \"mxx\" at character 6",
                               "did you mean \"max\"?"},
                    BadFormula{"1 + X", "unknown name \"X\" at character 5",
                               "allowed are x, y, z, t, pi, e and the functions"},
                    BadFormula{"2*q", "unknown name \"q\" at character 3", "abs, acos"},
                    BadFormula{"_pi", "unknown name \"_pi\" at character 1", "did you mean \"pi\"?"},
                    BadFormula{"1e", "unexpected \"1e\" at character 1", ""},
                    BadFormula{"1+", "something is missing at character 3", ""},
                    BadFormula{"(x", "\")\" is missing at character", ""},
                    BadFormula{"x)", "unexpected \")\" at character 2", ""},
                    BadFormula{"2 x", "unexpected \"x\" at character 3", "operators are"},
                    BadFormula{"x*/y", "unexpected \"/\" at character 3", "operators are"},
                    BadFormula{"x # y", "at character 3", "operators are"},
                    BadFormula{"sin x", "unexpected \"sin\" at character 1", "arguments in parentheses"},
                    BadFormula{"sin(1, x)", "too many arguments of \"sin\"", ""},
                    BadFormula{"atan2(x)", "too few arguments of \"atan2\"", ""},
                    BadFormula{"x ? 1", "\":\" is missing at character 6", ""},
                    BadFormula{"1,5", "\"1,5\" has 2 results", "the decimal sign is a point"},
                    BadFormula{"x, y", "\"x, y\" has 2 results", "the decimal sign is a point"},
                    BadFormula{"x = 3", "an assignment at character 3", "to compare, write =="},
                    BadFormula{"", "is an empty formula", ""}, BadFormula{"   ", "is an empty formula", ""},
                    BadFormula{"1/0", "\"1/0\" is inf", ""},
                    BadFormula{"sqrt(-1)", "\"sqrt(-1)\" is undefined", "defined"}));

TEST(Field, PointsAtTheMistake)
{
  EXPECT_THAT(message("9810*mxx(0, 9-y)"), HasSubstr("\n    9810*mxx(0, 9-y)\n         ^"));
}

TEST(Field, ShowsTheSurroundingsOfAMistakeInALongFormula)
{
  const std::string text = message(std::string(5000, ' ') + "xx" + std::string(4000, ' '));
  EXPECT_THAT(text, HasSubstr("at character 5001 of the formula\n"));
  EXPECT_LT(text.size(), 1000u);
}

TEST(Field, NamesThePointWhereItIsNotFinite)
{
  const problem::Field formula("1/x", in_case_file);
  EXPECT_EQ(formula(Point<2>(0.5, 0)), 2);
  try
  {
    (void)formula(Point<2>(0, 0.25));
    FAIL() << "accepted";
  }
  catch (const InputError& error)
  {
    EXPECT_THAT(error.what(),
                HasSubstr("boundary.top.pressure: the formula \"1/x\" is inf at the point (0, 0.25)"));
  }
  EXPECT_THROW((void)problem::Field("sqrt(z)", in_case_file)(Point<3>(0, 0, -1)), InputError);
}

TEST(Field, ConvertsNumbers)
{
  const problem::Field half = 0.5;
  EXPECT_TRUE(half.is_constant());
  EXPECT_EQ(half.constant(), 0.5);
  EXPECT_TRUE(half.is_enclosed());
}

/// x y, with an enclosure of its values over a box.
problem::FieldFunction product()
{
  problem::FieldFunction function;
  function.values = [](std::span<const double> x, int dim, std::span<double> values)
  {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = x[i * dim] * x[i * dim + 1];
  };
  return function;
}

TEST(Field, TakesFunctionsOfAProgram)
{
  const problem::Field field(product());
  EXPECT_EQ(field(Point<2>(2, 3)), 6);
  EXPECT_EQ(field(Point<3>(2, 3, 7)), 6);
  std::vector<double> values(2);
  field.evaluate(std::vector<double>{1, 2, 3, 4}, 2, values);
  EXPECT_EQ(values, (std::vector<double>{2, 12}));
  EXPECT_FALSE(field.is_constant());
  EXPECT_FALSE(field.is_zero());
  EXPECT_FALSE(field.is_enclosed());
  EXPECT_EQ(field.degree(), problem::FieldFunction::not_polynomial);
  std::vector<problem::Enclosure> unknown(2);
  field.enclose(std::vector<double>{0, 0, 1, 1}, 2, unknown);
  EXPECT_FALSE(unknown[0].bounded());
}

TEST(Field, AFunctionMayKnowItsDegreeAndItsEnclosure)
{
  problem::FieldFunction function = product();
  function.degree = 2;
  function.enclose = [](std::span<const double> vertices, int dim, std::span<problem::Enclosure> c)
  {
    double largest = 0;
    for (std::size_t i = 0; i < vertices.size(); i += dim)
      largest = std::max(largest, std::abs(vertices[i]) + std::abs(vertices[i + 1]));
    c[0] = {-largest * largest, largest * largest};
  };
  const problem::Field field(function);
  EXPECT_EQ(field.degree(), 2);
  EXPECT_TRUE(field.is_enclosed());
  const std::vector<double> x = {1, 2};
  EXPECT_TRUE(field.around(x, 0.1).contains(1.1 * 2.1));
}

TEST(Field, AFunctionThatIsNotFiniteIsAnErrorThatNamesThePoint)
{
  problem::FieldFunction function;
  function.values = [](std::span<const double> x, int /*dim*/, std::span<double> values)
  { values[0] = 1 / x[0]; };
  const problem::Field field(function, {.file = {}, .key = "load"});
  try
  {
    (void)field(Point<2>(0, 0.25));
    FAIL() << "accepted";
  }
  catch (const InputError& error)
  {
    EXPECT_THAT(error.what(), HasSubstr("load: the function is inf at the point (0, 0.25)"));
  }
}

}  // namespace
}  // namespace tribound
