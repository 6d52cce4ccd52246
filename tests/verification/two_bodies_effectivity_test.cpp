/// @file two_bodies_effectivity_test.cpp
/// The bound against the dual norm of the residual where bodies touch: random meshes, shapes, materials, laws
/// and gaps, at the first iterates and at the last.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>

#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/certify/truth/true_error.h"

namespace tribound::test
{

namespace
{

/// A pair of random blocks, the upper one on the lower one.
template <int dim>
class RandomPair
{
 public:
  explicit RandomPair(unsigned seed) : random_(seed) {}

  /// What makes the two bodies one system; changes the state of the generator.
  [[nodiscard]] std::pair<mesh::MeshData<dim>, ProblemData<dim>> make()
  {
    const bool is_flat = pick(3) == 0;
    const bool is_turned = !is_flat && pick(2) == 0;
    const double gap = pick(3) == 0 ? within(-0.02, 0.02) : 0;  // of the meshes
    mesh::MeshData<dim> data = side_by_side(upper(gap), lower(), "_below");
    if (!is_flat)
    {
      const double bend = is_turned ? 0 : within(-0.15, 0.15);
      data = mapped<dim>(std::move(data),
                         [&](Point<dim> x) -> Point<dim>
                         {
                           x[1] += bend * std::sin(1.3 * x[0]);
                           return is_turned ? Point<dim>(rotation<dim>() * x) : x;
                         });
    }
    data.interfaces = {{{{{"bottom"}, {"top_below"}}}}};
    if (pick(2) == 0) std::swap(data.interfaces[0].sides[0], data.interfaces[0].sides[1]);
    const auto& [slave, master] = data.interfaces[0].sides;
    ProblemData<dim> problem{
        .boundaries = {clamped<dim>("bottom_below"), loaded<dim>("top", 0.02, -0.1)},
        .material = lame(1, 0.3),
        .regions = {{.name = "box_below", .material = lame(std::pow(10.0, within(-4, 4)), within(0, 0.4))}},
        .pairs = {pair<dim>(slave[0], master[0], law())}};
    problem.boundaries.push_back(pick(3) == 0 && !is_turned ? fixed<dim>("left", 0.0, free)
                                                            : clamped<dim>("left"));
    if (pick(2) == 0) problem.boundaries.push_back(loaded<dim>("right", 0.06, formula("0.05*x")));
    problem::Contact& contact = problem.pairs[0].contact;
    if (cone(contact.law).is_tied)
      contact.gap = problem::Field(0.0);
    else if (const int kind = pick(4); kind == 0)
      contact.gap = problem::Field(within(-0.02, 0.02));
    else if (kind == 1)
      contact.gap = formula("0.03*(x - 0.9)^2 - 0.002");
    else
      contact.gap.reset();
    return {std::move(data), std::move(problem)};
  }

  [[nodiscard]] int pick(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  [[nodiscard]] double within(double from, double to)
  {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }

 private:
  [[nodiscard]] std::array<int, dim> cells()
  {
    if constexpr (dim == 2)
    {
      const int n = std::array{2, 3, 5, 9, 16}[pick(5)];
      return {n, std::max(1, n / 2)};
    }
    else
      return {1 + pick(3), 1, 1 + pick(2)};
  }
  [[nodiscard]] mesh::MeshData<dim> upper(double gap)
  {
    Point<dim> from = Point<dim>::Zero();
    Point<dim> to = Point<dim>::Ones();
    from[1] = gap;
    to[0] = 2;
    return box<dim>(from, to, cells());
  }
  /// Sometimes aside, so that neither side covers the other.
  [[nodiscard]] mesh::MeshData<dim> lower()
  {
    Point<dim> from = Point<dim>::Zero();
    Point<dim> to = Point<dim>::Ones();
    from[1] = -1;
    to[1] = 0;
    to[0] = 2;
    for (const int i : {0, dim - 1})
      if (i != 1 && pick(2) == 0)
      {
        from[i] += within(-0.6, 0.6);
        to[i] += within(-0.3, 0.7);
      }
    return box<dim>(from, to, cells());
  }
  [[nodiscard]] problem::ContactLaw law()
  {
    switch (pick(4))
    {
      case 0:
        return Frictionless();
      case 1:
        return Tresca(within(0.005, 0.05));
      case 2:
        return Coulomb(within(0.1, 0.6));
      default:
        return Tied();
    }
  }

  std::mt19937 random_;
};

/// The quotients of bound and dual norm that were seen.
struct Range
{
  double least = HUGE_VAL;
  double most = 0;
  int count = 0;

  void add(double quotient)
  {
    least = std::min(least, quotient);
    most = std::max(most, quotient);
    ++count;
  }
};

struct Seen
{
  Range converged;
  Range others;
};

/// At a random iterate of the first three, and at the last.
template <int dim>
void expect_above_dual_norm(unsigned seed, int degree, Seen& seen)
{
  RandomPair<dim> random(seed);
  auto [data, problem] = random.make();
  adapt::Method method{.degree = degree};
  method.gamma0 = contact::default_gamma0(degree) * std::pow(10.0, random.within(0, 1));
  method.newton.damping = true;
  method.newton.max_steps = 40;
  const DiscreteProblem<dim> c(std::move(data), problem, method);
  certify::DualNorm<dim> dual_norm(c.form, {.refinements = dim == 2 ? 2 : 1, .degree = degree + 2});
  const int early = 1 + random.pick(3);
  const certify::Estimator<dim> estimator(c.form, certify::ContactRule::resolved);
  const auto check = [&](const solve::NewtonIterate<dim>& iterate) -> solve::NewtonAdvice
  {
    if (!iterate.converged && iterate.step.step != early) return false;
    const certify::Stress<dim> stress = certify::equilibrate<dim>(c.form, iterate.u(), iterate.traction);
    EXPECT_LE(certify::check_identities<dim>(c.form, iterate.traction, stress).largest(degree), 1e-9) << seed;
    const double eta = estimator(iterate.u(), stress).total_sharp;
    const double below = dual_norm(iterate.u());
    EXPECT_GE(eta, below) << seed << ", step " << iterate.step.step;
    (iterate.converged ? seen.converged : seen.others).add(eta / below);
    return false;
  };
  (void)c.solve(0, check);
}

void report(int dim, int degree, const Seen& seen)
{
  fmt::print("{}D, p = {}: {} converged {:.3f} to {:.3f}, {} others {:.3f} to {:.3f}\n", dim, degree,
             seen.converged.count, seen.converged.least, seen.converged.most, seen.others.count,
             seen.others.least, seen.others.most);
}

class RandomPairs2D : public ::testing::TestWithParam<int>
{
};

TEST_P(RandomPairs2D, TheBoundIsAboveTheDualNorm)
{
  const int degree = GetParam();
  const int n_cases = degree == 1 ? 70 : degree == 2 ? 70 : degree == 3 ? 30 : 10;
  Seen seen;
  for (int i = 0; i < n_cases; ++i)
    expect_above_dual_norm<2>(static_cast<unsigned>(1000 * degree + i), degree, seen);
  report(2, degree, seen);
  EXPECT_GE(seen.converged.count, n_cases * 9 / 10);
  EXPECT_LE(seen.converged.most, 2);  // it was 1.11 to 1.97, three of 180 above 1.8
}

INSTANTIATE_TEST_SUITE_P(Degrees, RandomPairs2D, ::testing::Range(1, 5));

/// On meshes of one or two cells in height, which say little of the stress.
TEST(RandomPairs3D, TheBoundIsAboveTheDualNorm)
{
  for (const auto& [degree, n_cases] : {std::pair(1, 34), {2, 6}})
  {
    Seen seen;
    for (int i = 0; i < n_cases; ++i)
      expect_above_dual_norm<3>(static_cast<unsigned>(500 * degree + i), degree, seen);
    report(3, degree, seen);
    EXPECT_GE(seen.converged.count, n_cases * 9 / 10);
    EXPECT_LE(seen.converged.most, 5);  // it was 1.19 to 4.68
  }
}

}  // namespace

}  // namespace tribound::test
