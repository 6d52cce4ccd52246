/// @file mutations_test.cpp
/// The equilibrated stress against a dense kernel, written independently from method section 4. The kernel is
/// then run with one mistake at a time; the identities or the reference components of T2D must notice each.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/dense_patch.h"
#include "support/discrete_problem.h"
#include "support/meshes.h"
#include "support/t2d.h"
#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/estimate.h"
#include "tribound/certify/equilibrate/equilibrate.h"

namespace tribound::test
{

namespace
{

/// The block with no side along an axis, with cells of all shapes, numbered at random. (For facets almost
/// along a fixed component see almost_along_test.cpp.)
template <int dim>
mesh::MeshData<dim> skewed(mesh::MeshData<dim> data)
{
  const auto map = [](const Point<dim>& x) -> Point<dim>
  {
    Point<dim> y = x;
    for (int a = 0; a < dim; ++a) y[a] += (a == 0 ? 0.4 : -0.3) * x[(a + 1) % dim] + 0.03 * x[a] * x[a];
    return y;
  };
  return renumbered(mapped(std::move(data), map), 5);
}

/// T2D with a body force, a roller on the left and a tangential one on the right; in 3D also rollers behind.
template <int dim>
ProblemData<dim> rolling_block(const problem::Contact& contact)
{
  ProblemData<dim> data{
      .boundaries = {fixed<dim>("left", 0, free, free),
                     loaded<dim>(fixed<dim>("right", free, 0, free), 0.04, 0, 0.01),
                     loaded<dim>("top", 0.01, formula("-0.1*exp(x)"), 0.02),
                     obstacle<dim>("bottom", contact)},
      .body_force = components<dim>(formula("0.1*x*y"), formula("-0.1*(1 + x^2)"), formula("0.05*x*z"))};
  if (dim == 3) data.boundaries.push_back(fixed<dim>("back", free, free, 0));
  return data;
}

const problem::Contact tresca(Tresca(0.03));
const problem::Contact coulomb(Coulomb(0.4), formula("0.01*x"));

template <int dim>
mesh::MeshData<dim> some_block()
{
  return block<dim>({4, 2}, {2, 1, 1});
}

template <int dim>
solve::NewtonResult<dim> iterate(DiscreteProblem<dim>& c, int k)
{
  c.method.newton.max_steps = k;
  return c.solve();
}

/// sigma_lin of a cell, zeros where it is not stored.
template <int dim>
std::vector<double> lin_of(const certify::Stress<dim>& stress, Index cell)
{
  std::vector<double> result(stress.block_size(), 0.0);
  std::ranges::copy(stress.lin_in(cell), result.begin());
  return result;
}

/// The larger of ||a - b|| / ||sigma_dis|| for dis and lin.
template <int dim>
double difference(const certify::Stress<dim>& a, const certify::Stress<dim>& b)
{
  double dis = 0;
  double lin = 0;
  double norm = 0;
  for (std::size_t i = 0; i < a.dis.size(); ++i)
  {
    dis += std::pow(a.dis[i] - b.dis[i], 2);
    norm += a.dis[i] * a.dis[i];
  }
  for (std::size_t c = 0; c < a.lin_block.size(); ++c)
  {
    const std::vector<double> x = lin_of(a, static_cast<Index>(c));
    const std::vector<double> y = lin_of(b, static_cast<Index>(c));
    for (std::size_t i = 0; i < x.size(); ++i) lin += std::pow(x[i] - y[i], 2);
  }
  return std::sqrt(std::max(dis, lin) / norm);
}

template <int dim>
void expect_agreement(const std::string& name, const problem::Contact& contact, int p,
                      mesh::MeshData<dim> mesh)
{
  SCOPED_TRACE(name);
  DiscreteProblem<dim> c(std::move(mesh), rolling_block<dim>(contact), t2d_method(p));
  for (const int k : {1, 2, 30})
  {
    const solve::NewtonResult<dim> result = iterate(c, k);
    for (const certify::PatchStress patches : {certify::PatchStress::rows, certify::PatchStress::afw})
    {
      const double d = difference(certify::equilibrate<dim>(c.form, result.u, result.traction, 0, 0, patches),
                                  dense_equilibrate<dim>(c.form, result.u, result.traction, patches));
      fmt::print("{}, {}D, p = {}, iterate {}, {}: difference {:.1e}\n", name, dim, p, k,
                 certify::to_string(patches), d);
      EXPECT_LE(d, 1e-10) << "iterate " << k << ", " << certify::to_string(patches);
    }
  }
}

template <int dim>
void expect_agreement(int p)
{
  expect_agreement<dim>("Tresca", tresca, p, some_block<dim>());
  expect_agreement<dim>("Coulomb, skewed", coulomb, p, skewed<dim>(some_block<dim>()));
}

class DenseKernel : public ::testing::TestWithParam<int>
{
};

TEST_P(DenseKernel, AgreesIn2D)
{
  expect_agreement<2>(GetParam());
}

TEST(DenseKernel3D, Agrees)
{
  expect_agreement<3>(1);
  expect_agreement<3>(2);
}

INSTANTIATE_TEST_SUITE_P(Degrees, DenseKernel, ::testing::Range(1, 4));

/// The largest difference of a component from the reference program, relative to eta_tot, at iterate k of
/// T2D on the 4 x 2 mesh. The stress comes from the dense kernel.
double distance_from_reference(int p, int k, Mutation mutation)
{
  double largest = 0;
  for (const nlohmann::json& expected : t2d_reference())
  {
    if (expected["p"] != p || expected["nx"] != 4) continue;
    DiscreteProblem<2> c = t2d(p, expected["nx"], expected["ny"]);
    const solve::NewtonResult<2> result = iterate(c, k);
    const certify::Estimate eta = certify::estimate<2>(
        c.form, result.u,
        dense_equilibrate<2>(c.form, result.u, result.traction, certify::PatchStress::afw, mutation),
        certify::ContactRule::reference);
    const nlohmann::json& e = expected[fmt::format("iterate{}_est", k)];
    const double total = e["eta_tot"];
    const auto compare = [&](double value, const char* name)
    { largest = std::max(largest, std::abs(value - e[name].get<double>()) / total); };
    compare(eta.global.str, "eta_str");
    compare(eta.global.lin1, "eta_lin1");
    compare(eta.global.cnt, "eta_cnt");
    compare(eta.global.frc, "eta_frc");
    compare(eta.global.lin2n, "eta_lin2n");
    compare(eta.global.lin2t, "eta_lin2t");
    compare(eta.total, "eta_tot");
    return largest;
  }
  ADD_FAILURE() << "no reference for p = " << p;
  return largest;
}

/// The dense kernel itself is right: it gives the numbers of the reference program.
TEST(DenseKernelT2D, HasTheComponentsOfTheReference)
{
  for (const int p : {1, 2})
    for (const int k : {1, 2}) EXPECT_LE(distance_from_reference(p, k, Mutation::none), 1e-9);
}

/// A mistake and what must notice it: an identity (null: none does), the reference components of T2D.
struct Mistake
{
  Mutation mutation;
  const char* name;
  double certify::IdentityDefects::*identity;
  bool components;
};

// y_a enters dis and lin with opposite signs. Dropped from both, it cancels in sigma_h, so the identities
// hold and so does the bound. The parts are then wrong, and the components show it. T2D has no body force.
constexpr std::array mistakes{
    Mistake{Mutation::sign_of_f, "sign of f", &certify::IdentityDefects::divergence, false},
    Mistake{Mutation::sign_of_t, "sign of t", &certify::IdentityDefects::neumann, true},
    Mistake{Mutation::no_y, "no y_a", nullptr, true},
    Mistake{Mutation::no_y_in_lin, "no y_a in lin", &certify::IdentityDefects::divergence, true},
    Mistake{Mutation::coarse_rule_for_t, "coarse rule for t", &certify::IdentityDefects::contact, true},
    Mistake{Mutation::one_patch_left_out, "one patch left out", &certify::IdentityDefects::divergence, true},
    Mistake{Mutation::t_replaced_by_T, "T for t^k", &certify::IdentityDefects::contact, true},
    Mistake{Mutation::no_lin, "no sigma_lin", &certify::IdentityDefects::contact, true},
};

std::string summary(const certify::IdentityDefects& d)
{
  return fmt::format("divergence {:.1e}  jump {:.1e}  neumann {:.1e}  contact {:.1e}  symmetry {:.1e}",
                     d.divergence, d.jump, d.neumann, d.contact, d.symmetry);
}

class Mutations : public ::testing::TestWithParam<int>
{
};

template <int dim>
void expect_noticed(int p, certify::PatchStress patches)
{
  DiscreteProblem<dim> c(some_block<dim>(), rolling_block<dim>(tresca), t2d_method(p));
  const solve::NewtonResult<dim> result = iterate(c, 2);
  ASSERT_NE(result.status, solve::NewtonStatus::converged) << "sigma_lin would vanish";
  const auto defects = [&](Mutation mutation)
  {
    return certify::check_identities<dim>(
        c.form, result.traction,
        dense_equilibrate<dim>(c.form, result.u, result.traction, patches, mutation));
  };
  const certify::IdentityDefects right = defects(Mutation::none);
  fmt::print("{}D, p = {}, {}\n{:<20} {}\n", dim, p, certify::to_string(patches), "none", summary(right));
  EXPECT_LE(right.largest(), 1e-11);
  for (const auto& [mutation, name, identity, components] : mistakes)
  {
    const certify::IdentityDefects wrong = defects(mutation);
    fmt::print("{:<20} {}\n", name, summary(wrong));
    if (identity)
    {
      EXPECT_GT(wrong.*identity, 1e-8) << name;
    }
    else
    {
      EXPECT_TRUE(components) << name;
      EXPECT_LE(wrong.largest(), 1e-11) << name;
    }
  }
}

TEST_P(Mutations, AreNoticedIn2D)
{
  expect_noticed<2>(GetParam(), certify::PatchStress::rows);
  expect_noticed<2>(GetParam(), certify::PatchStress::afw);
}

TEST(Mutations3D, AreNoticed)
{
  expect_noticed<3>(1, certify::PatchStress::rows);
  expect_noticed<3>(1, certify::PatchStress::afw);
}

TEST(MutationsT2D, ChangeTheComponents)
{
  for (const int p : {1, 2})
    for (const auto& [mutation, name, identity, components] : mistakes)
    {
      const double distance = distance_from_reference(p, 2, mutation);
      fmt::print("T2D, p = {}, {:<20} components off by {:.1e}\n", p, name, distance);
      if (components)
      {
        EXPECT_GT(distance, 1e-5) << name;
      }
    }
}

INSTANTIATE_TEST_SUITE_P(Degrees, Mutations, ::testing::Range(1, 4));

}  // namespace

}  // namespace tribound::test
