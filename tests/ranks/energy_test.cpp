/// @file energy_test.cpp
/// Admissible displacements and the energy bound of a body on obstacles: all ranks together against the
/// whole mesh.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "support/meshes.h"
#include "support/problem_data.h"
#include "support/two_blocks.h"
#include "tribound/adapt/error_bars.h"
#include "tribound/adapt/finer.h"
#include "tribound/adapt/finer_contact.h"
#include "tribound/certify/bound/korn.h"
#include "tribound/certify/energy/admissible_displacement.h"
#include "tribound/certify/energy/energy_bound.h"
#include "tribound/certify/energy/obstacle_facets.h"
#include "tribound/contact/nitsche/penalty.h"
#include "tribound/contact/nitsche/springs.h"
#include "tribound/mesh/bisect.h"
#include "tribound/mesh/share_out.h"

namespace tribound::test
{
namespace
{

/// What admissible_displacements() makes of a wave, by place: both kinds, one after the other.
template <int dim>
struct Displacements
{
  Displacements(const mesh::Mesh<dim>& mesh, int degree, bool fits)
  {
    const ProblemData<dim> data = {.boundaries = {clamped<dim>("left"),
                                                  obstacle<dim>("bottom", Tresca(0.1), fits ? 0.01 : -0.01),
                                                  obstacle<dim>("right", Coulomb(0.3), 0.02)}};
    const problem::Problem<dim> problem = data.on(mesh);
    const fem::LagrangeSpace<dim> space(mesh, degree);
    const contact::NitscheForm<dim> form(problem, space, contact::default_gamma0(degree));
    const std::vector<Point<dim>> points = space.node_points();
    std::vector<double> u;
    for (const Point<dim>& x : points)
      for (int a = 0; a < dim; ++a)
        u.push_back(form.constraints().fixed[u.size()] ? 0 : 0.05 * std::sin(5 * x[0] + 3 * x[dim - 1] + a));
    const auto result = certify::admissible_displacements<dim>(form, u, form.traction(u));
    has_transition = result.has_transition;
    numbers = {result.gap_remainder, result.excess_open, result.excess_closed};
    is_given = result.open.has_value() && result.closed.has_value();
    if (!is_given) return;
    for (Index node = 0; node < space.n_nodes(); ++node)
    {
      std::array<std::int64_t, dim> key;
      for (int a = 0; a < dim; ++a) key[a] = std::llround(points[node][a] * 1e9);
      for (const std::vector<double>* v : {&*result.open, &*result.closed})
        at[key].insert(at[key].end(), &(*v)[dim * node], &(*v)[dim * node] + dim);
    }
  }

  bool has_transition = false;
  bool is_given = false;
  std::array<double, 3> numbers{};
  std::map<std::array<std::int64_t, dim>, std::vector<double>> at;
};

template <int dim>
void expect_same(int degree, bool fits)
{
  const Ranks ranks = Ranks::world();
  const mesh::Mesh<dim> whole(distorted(block<dim>({6, 4}, {4, 3, 2}), degree));
  const mesh::Mesh<dim> part = mesh::share_out<dim>(ranks, ranks.is_first() ? &whole : nullptr);
  const Displacements<dim> all(whole, degree, fits);
  const Displacements<dim> here(part, degree, fits);
  EXPECT_EQ(all.is_given, fits);
  EXPECT_EQ(here.is_given, fits);
  EXPECT_EQ(here.has_transition, all.has_transition);
  for (std::size_t i = 0; i < all.numbers.size(); ++i) EXPECT_NEAR(here.numbers[i], all.numbers[i], 1e-14);
  for (const auto& [place, values] : here.at)  // own nodes and ghosts
  {
    const std::vector<double>& expected = all.at.at(place);
    ASSERT_EQ(values.size(), expected.size());
    // compromises magnify rounding by the inverse of their small weight
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(values[i], expected[i], 1e-10);
  }
}

TEST(AdmissibleDisplacements, AreThoseOfTheWhole)
{
  for (int degree = 1; degree <= 4; ++degree)
    for (const bool fits : {true, false})
    {
      SCOPED_TRACE("degree " + std::to_string(degree));
      expect_same<2>(degree, fits);
      expect_same<3>(degree, fits);
    }
}

/// Without conditions, pressed onto a floor by its loads.
template <int dim>
ProblemData<dim> resting_block()
{
  return {.boundaries = {obstacle<dim>("bottom", Tresca(0.05)), loaded<dim>("top", 0.01, -0.1)}};
}

/// A function that is 0 where displacements are fixed.
template <int dim>
std::vector<double> wave(const contact::NitscheForm<dim>& form)
{
  std::vector<double> u;
  for (const Point<dim>& x : form.space().node_points())
    for (int a = 0; a < dim; ++a)
      u.push_back(form.constraints().fixed[u.size()] ? 0 : 0.05 * std::sin(5 * x[0] + 3 * x[dim - 1] + a));
  return u;
}

/// The parts of the bound of a wave.
template <int dim>
std::vector<double> energy_bound(const mesh::Mesh<dim>& mesh, const ProblemData<dim>& data, int degree,
                                 double korn)
{
  const problem::Problem<dim> problem = data.on(mesh);
  const fem::LagrangeSpace<dim> space(mesh, degree);
  const contact::NitscheForm<dim> form(problem, space, contact::default_gamma0(degree));
  const std::vector<double> u = wave(form);
  const certify::EnergyBound eta =
      certify::EnergyEstimator<dim>(form, {.method = algebra::LinearMethod::direct}, {}, korn)(u);
  EXPECT_EQ(eta.reason, "");
  double cells = 0;
  for (const double square : eta.cells) cells += square;
  return {eta.bound, eta.b_v,        eta.mid,     eta.dist,
          eta.gap,   eta.correction, eta.contact, mesh.ranks().sum(cells)};
}

/// A block pressed on obstacles.
template <int dim>
ProblemData<dim> on_obstacles()
{
  ProblemData<dim> data = pressed_block<dim>(Coulomb(0.3));
  data.boundaries.push_back(obstacle<dim>(dim == 2 ? "right" : "front", Tresca(0.1), 0.02));
  if (dim == 2) std::erase_if(data.boundaries, [](const auto& b) { return b.name == "right" && !b.contact; });
  return data;
}

/// A block pressed on another block; each is free where the other is fixed.
template <int dim>
ProblemData<dim> on_another()
{
  return {.boundaries = {clamped<dim>("left"), clamped<dim>("bottom_below"), loaded<dim>("top", 0.01, -0.1)},
          .pairs = {pair<dim>("bottom", "top_below", Coulomb(0.3))}};
}

/// The same with directions of contact that vary along facets.
template <int dim>
ProblemData<dim> turned(ProblemData<dim> data)
{
  std::vector<problem::Field> direction = {formula("x/sqrt(9 + x^2)"), formula("-3/sqrt(9 + x^2)")};
  if (dim == 3) direction.emplace_back(0.0);
  problem::Contact& contact = data.pairs.empty() ? *data.boundaries.back().contact : data.pairs[0].contact;
  contact.normal = problem::NormalField(std::move(direction));
  return data;
}

/// The same with springs on the loaded side.
template <int dim>
ProblemData<dim> sprung(ProblemData<dim> data)
{
  const auto top = std::ranges::find(data.boundaries, "top", &problem::BoundaryCondition<dim>::name);
  top->spring.emplace(problem::Spring<dim>{formula("0.5 + 0.1*x"), 0.2});
  top->spring->rest[1] = 0.01;
  return data;
}

/// A block on springs and an obstacle, with a rigid part above.
template <int dim>
ProblemData<dim> under_a_platen()
{
  ProblemData<dim> data{.boundaries = {loaded<dim>("left", 0, 0), loaded<dim>("top", 0, 0),
                                       obstacle<dim>("bottom", Coulomb(0.3))}};
  data.boundaries[0].spring.emplace(problem::Spring<dim>{0.7, 0.4});
  problem::RigidPart<dim>& platen = data.boundaries[1].rigid.emplace();
  platen.force[1] = -0.1;
  platen.moment[0] = 0.02;
  return data;
}

/// Ends and values of the intervals of a wave, with the sizes that rounding is measured by.
template <int dim>
std::vector<std::array<double, 2>> intervals(const mesh::Mesh<dim>& mesh, const ProblemData<dim>& data,
                                             int degree)
{
  using problem::QuantityKind;
  const problem::Problem<dim> problem = data.on(mesh);
  const fem::LagrangeSpace<dim> space(mesh, degree);
  const contact::NitscheForm<dim> form(problem, space, contact::default_gamma0(degree));
  const std::vector<double> u = wave(form);
  std::vector<problem::Quantity<dim>> quantities = {
      {.name = "energy"},
      {.name = "work", .kind = QuantityKind::load_work},
      {.name = "force", .kind = QuantityKind::contact_force, .boundary = "bottom"},
      {.name = "moment", .kind = QuantityKind::contact_moment, .boundary = "bottom"},
      {.name = "safety", .kind = QuantityKind::safety_factor, .boundary = "bottom"},
      {.name = "u", .kind = QuantityKind::mean_displacement, .boundary = "top"},
      {.name = "u of contact", .kind = QuantityKind::mean_displacement, .boundary = "bottom"}};
  for (const problem::BoundaryCondition<dim>& boundary : problem.boundaries())
    if (boundary.spring)
      quantities.push_back({.name = "spring", .kind = QuantityKind::spring_force, .boundary = boundary.name});
  EXPECT_EQ(certify::obstacles_unfit(form), "");
  const certify::EnergyBound bound =
      certify::EnergyEstimator<dim>(form, {.method = algebra::LinearMethod::direct}, quantities)(u);
  EXPECT_EQ(bound.reason, "");
  std::vector<std::array<double, 2>> result;
  for (const certify::QuantityInterval& q : bound.quantities)
  {
    const double size = std::max(std::abs(q.lower), std::abs(q.upper));
    double cells = 0;
    for (const double cell : q.cells) cells += cell;
    cells = mesh.ranks().sum(cells);
    for (const double x : {q.lower, q.upper, q.value, cells}) result.push_back({x, size});
  }
  return result;
}

TEST(Quantities, HaveTheIntervalsOfTheWhole)
{
  const Ranks ranks = Ranks::world();
  const auto expect_same_intervals = [&]<int dim>(int degree)
  {
    for (const bool is_on_another : {false, true})
    {
      const mesh::Mesh<dim> whole(is_on_another ? renumbered(matching_blocks<dim>(2), degree)
                                                : distorted(block<dim>({6, 4}, {4, 3, 2}), degree));
      const ProblemData<dim> plain = is_on_another ? on_another<dim>() : on_obstacles<dim>();
      for (const ProblemData<dim>& data : {plain, turned<dim>(sprung<dim>(plain)), under_a_platen<dim>()})
      {
        if (is_on_another && data.pairs.empty()) continue;
        const mesh::Mesh<dim> part = contact::with_partners<dim>(
            mesh::share_out<dim>(ranks, ranks.is_first() ? &whole : nullptr), data.pairs);
        const auto expected = intervals<dim>(whole, data, degree);
        const auto found = intervals<dim>(part, data, degree);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i)
          EXPECT_NEAR(found[i][0], expected[i][0], 1e-9 * (expected[i][1] + std::abs(expected[i][0])))
              << dim << "D, p = " << degree << ", " << i;
      }
    }
  };
  for (int degree = 1; degree <= 3; ++degree) expect_same_intervals.template operator()<2>(degree);
  for (int degree = 1; degree <= 2; ++degree) expect_same_intervals.template operator()<3>(degree);
}

/// On meshes that ranks refine, the weights are still those of the first mesh.
TEST(Quantities, OfFinerMeshesHaveTheIntervalsOfTheWhole)
{
  const Ranks ranks = Ranks::world();
  const auto expect_same_intervals = [&]<int dim>(int degree)
  {
    const ProblemData<dim> data = on_obstacles<dim>();
    const mesh::Mesh<dim> whole(distorted(block<dim>({4, 2}, {3, 2, 2}), degree));
    const auto near_the_corner = [](const mesh::Mesh<dim>& mesh)
    {
      std::vector<Index> marked;
      for (Index c = 0; c < mesh.n_owned_cells(); ++c)
        if (mesh::cell_map(mesh, c)(Point<dim>::Constant(1.0 / (dim + 1))).sum() < 1) marked.push_back(c);
      return marked;
    };
    const mesh::Mesh<dim> part = mesh::share_out<dim>(ranks, ranks.is_first() ? &whole : nullptr);
    const fem::LagrangeSpace<dim> space(part, degree);
    const mesh::Mesh<dim> fine = adapt::finer_mesh<dim>(space, {}, near_the_corner(part)).mesh();
    const auto expected = intervals<dim>(mesh::bisect<dim>(whole, near_the_corner(whole)).mesh, data, degree);
    const auto found = intervals<dim>(fine, data, degree);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_NEAR(found[i][0], expected[i][0], 1e-9 * (expected[i][1] + std::abs(expected[i][0])))
          << dim << "D, p = " << degree << ", " << i;
  };
  for (int degree = 1; degree <= 2; ++degree)
  {
    expect_same_intervals.template operator()<2>(degree);
    expect_same_intervals.template operator()<3>(degree);
  }
}

TEST(EnergyBound, IsThatOfTheWhole)
{
  const Ranks ranks = Ranks::world();
  const auto expect_same_bound = [&]<int dim>(int degree)
  {
    const mesh::Mesh<dim> whole(distorted(block<dim>({6, 4}, {4, 3, 2}), degree));
    const mesh::Mesh<dim> part = mesh::share_out<dim>(ranks, ranks.is_first() ? &whole : nullptr);
    ProblemData<dim> with_sine = pressed_block<dim>();  // quadrature misses a part of it
    with_sine.body_force[0] = formula("0.1*sin(3*x + y)");
    for (const ProblemData<dim>& data :
         {pressed_block<dim>(), resting_block<dim>(), with_sine, turned(pressed_block<dim>())})
    {
      const double korn = certify::korn_constant(data.on(whole), whole);
      const std::vector<double> expected = energy_bound<dim>(whole, data, degree, korn);
      const std::vector<double> found = energy_bound<dim>(part, data, degree, korn);
      for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_NEAR(found[i], expected[i], 1e-9 * expected[i]) << dim << "D, p = " << degree << ", " << i;
    }
  };
  for (int degree = 1; degree <= 3; ++degree)
  {
    expect_same_bound.template operator()<2>(degree);
    expect_same_bound.template operator()<3>(degree);
  }
}

/// Where the state of contact changes on facets: for a body on obstacles, and for two bodies whose facets
/// match, or are made to match in 2D, or do not in 3D.
template <int dim>
void expect_same_where_it_is_finer(const mesh::MeshData<dim>& mesh_data, const ProblemData<dim>& data,
                                   int degree)
{
  const Ranks ranks = Ranks::world();
  const mesh::Mesh<dim> whole(mesh_data);
  const auto numbers = [&](const mesh::Mesh<dim>& mesh)
  {
    const problem::Problem<dim> problem = data.on(mesh);
    const fem::LagrangeSpace<dim> space(mesh, degree);
    const contact::NitscheForm<dim> form(problem, space, contact::default_gamma0(degree));
    std::vector<double> u = wave(form);
    std::vector<char> is_below(space.n_nodes(), 0);
    for (Index c = 0; c < mesh.n_cells(); ++c)
      for (const Index node : space.cell_nodes(c)) is_below[node] = mesh.region(c) == 1 ? 1 : 0;
    for (std::size_t i = 0; i < u.size(); ++i)
      if (is_below[i / dim]) u[i] /= 2;
    const auto matching = adapt::matching_contact<dim>(form, u);
    const auto finer =
        adapt::finer_contact<dim>(matching ? *matching->form : form, matching ? matching->u : u);
    EXPECT_TRUE(finer) << dim << "D, p = " << degree;
    if (!finer) return std::vector<double>{};
    const certify::EnergyBound eta = adapt::energy_bound<dim>(form, {.degree = degree}, u);
    EXPECT_EQ(eta.reason, "");
    EXPECT_EQ(static_cast<Index>(eta.cells.size()), mesh.n_owned_cells());
    std::vector<double> result{static_cast<double>(finer->grid->mesh.n_global_cells()), eta.bound,
                               eta.contact, eta.correction, 0};
    for (const double square : eta.cells) result.back() += square;
    result.back() = mesh.ranks().sum(result.back());
    return result;
  };
  const std::vector<double> expected = numbers(whole);
  ASSERT_FALSE(expected.empty());
  EXPECT_GT(expected.front(), whole.n_cells());
  const std::vector<double> found = numbers(contact::with_partners<dim>(
      mesh::share_out<dim>(ranks, ranks.is_first() ? &whole : nullptr), data.pairs));
  ASSERT_EQ(found.size(), expected.size());
  const double square = expected[1] * expected[1];  // what contact contributes may be rounding
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], 1e-9 * std::max(expected[i], square))
        << dim << "D, p = " << degree << ", " << i;
}

TEST(EnergyBound, IsThatOfTheWholeWhereFacetsAreCut)
{
  const auto expect_in = [&]<int dim>(int degree)
  {
    expect_same_where_it_is_finer<dim>(distorted(block<dim>({6, 4}, {4, 3, 2}), degree),
                                       pressed_block<dim>(Coulomb(0.3)), degree);
    const ProblemData<dim> pressed{
        .boundaries = {clamped<dim>("left_below"), loaded<dim>("top", 0, -0.1)},  // contact holds the other
        .pairs = {pair<dim>("bottom", "top_below", Tresca(0.03))}};
    expect_same_where_it_is_finer<dim>(renumbered(matching_blocks<dim>(2), degree), pressed, degree);
    expect_same_where_it_is_finer<dim>(renumbered(two_blocks<dim>(), degree), pressed, degree);
    if constexpr (dim == 3)
    {
      ProblemData<3> tied{
          .boundaries = {clamped<3>("left"), clamped<3>("bottom_below"), loaded<3>("top", 0, -0.1)},
          .pairs = {pressed.pairs[0], pair<3>("right", "left_b", problem::Tied())}};
      tied.pairs[0].slave.emplace_back("bottom_b");
      expect_same_where_it_is_finer<3>(renumbered(three_blocks_on_another_mesh(), degree), tied, degree);
    }
  };
  for (int degree = 1; degree <= 3; ++degree) expect_in.template operator()<2>(degree);
  for (int degree = 1; degree <= 2; ++degree) expect_in.template operator()<3>(degree);
}

}  // namespace
}  // namespace tribound::test
