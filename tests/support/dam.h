#pragma once

/// @file dam.h
/// The gravity dam of the reference data: base 60, height 80, crest 5 (m, MN) on rigid rock, t the level of
/// the reservoir; uplift from the heel at the left to the toe.

#include <cmath>
#include <utility>

#include "support/problem_data.h"
#include "tribound/adapt/load_path.h"

namespace tribound::test
{

inline constexpr double weight_of_water = 9.81e-3;
inline const double tan_30 = 1 / std::sqrt(3.0);

[[nodiscard]] inline problem::Seepage uplift(bool crack = false)
{
  return {.head = formula("t"), .weight = weight_of_water, .line = {{0, 0}, {60, 0}}, .crack = crack};
}

[[nodiscard]] inline problem::ContactLaw dam_joint()
{
  return problem::JointLaw(
      {.tension = {0.3, 1e-4}, .cohesion = 0.7, .slip_length = 2e-3, .coefficient = tan_30});
}

[[nodiscard]] inline ProblemData<2> dam(const problem::Seepage& seepage,
                                        problem::ContactLaw law = dam_joint())
{
  ProblemData<2> data{.boundaries = {pressed<2>("upstream", formula("9.81e-3*max(0, t-y)")),
                                     obstacle<2>("base", std::move(law))},
                      .material = lame(24000, 0.15),
                      .body_force = {problem::Field(0.0), problem::Field(-2400 * 9.81e-6)}};
  data.boundaries.back().contact->water.emplace(seepage);
  data.boundaries.back().contact->base = seepage.line;
  return data;
}

[[nodiscard]] inline adapt::Method dam_method(int degree = 2)
{
  adapt::Method method{.degree = degree, .gamma0 = 10, .newton = {.tolerance = 1e-12}};
  method.stopping.criterion = adapt::Stopping::tolerance;
  return method;
}

}  // namespace tribound::test
