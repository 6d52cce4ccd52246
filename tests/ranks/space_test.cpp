/// @file space_test.cpp
/// Numbers, owners and constraints of nodes on several ranks, against the whole mesh.

#include "tribound/fem/space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "support/meshes.h"
#include "support/problem_data.h"
#include "tribound/algebra/condensation.h"
#include "tribound/algebra/petsc.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/fem/nested.h"
#include "tribound/mesh/share_out.h"

namespace tribound::test
{
namespace
{

/// A mesh whose cells all differ in shape, whole and as the part of this rank.
template <int dim>
struct Shared
{
  explicit Shared(int seed)
      : ranks(Ranks::world()),
        whole(std::make_shared<const mesh::Mesh<dim>>(distorted(block<dim>({5, 4}, {4, 3, 2}), seed))),
        part(mesh::share_out<dim>(ranks, ranks.is_first() ? whole.get() : nullptr))
  {
  }

  Ranks ranks;
  std::shared_ptr<const mesh::Mesh<dim>> whole;
  mesh::Mesh<dim> part;
};

/// A point up to rounding.
template <int dim>
std::array<std::int64_t, dim> key(const Point<dim>& x)
{
  std::array<std::int64_t, dim> result;
  for (int i = 0; i < dim; ++i) result[i] = std::llround(x[i] * 1e9);
  return result;
}

template <int dim>
void expect_numbers(int degree)
{
  const Shared<dim> mesh(degree);
  const fem::LagrangeSpace<dim> whole(*mesh.whole, degree);
  const fem::LagrangeSpace<dim> part(mesh.part, degree);
  const std::vector<Point<dim>> points = part.node_points();
  ASSERT_TRUE(part.numbers());
  EXPECT_FALSE(whole.numbers());
  EXPECT_EQ(part.n_global_dofs(), whole.n_dofs());

  // Every number from 0 on has one owner and one place, the same on all ranks that have it.
  std::vector<double> at(whole.n_dofs(), 0.0);
  std::vector<std::int64_t> owners(whole.n_nodes(), 0);
  for (Index k = 0; k < part.n_owned_nodes(); ++k)
  {
    const Index node = part.owned_node(k);
    const std::int64_t number = part.numbers()->global[node];
    ++owners[number];
    std::copy_n(points[node].data(), dim, &at[dim * number]);
  }
  mesh.ranks.sum(std::span(owners));
  mesh.ranks.sum(std::span(at));
  EXPECT_TRUE(std::ranges::all_of(owners, [](std::int64_t n) { return n == 1; }));
  for (Index node = 0; node < part.n_nodes(); ++node)
    EXPECT_EQ(key<dim>(points[node]), key<dim>(Point<dim>(&at[dim * part.numbers()->global[node]])));
  std::set<std::array<std::int64_t, dim>> places;
  for (const Point<dim>& x : whole.node_points()) places.insert(key<dim>(x));
  for (Index number = 0; number < whole.n_nodes(); ++number)
    EXPECT_EQ(places.count(key<dim>(Point<dim>(&at[dim * number]))), 1);

  // update() gives ghosts the owner's values.
  std::vector<double> values(part.n_dofs(), -1.0);
  for (Index k = 0; k < part.n_owned_nodes(); ++k)
    for (int a = 0; a < dim; ++a) values[dim * part.owned_node(k) + a] = points[part.owned_node(k)][a];
  EXPECT_NEAR(part.norm(values), whole.norm(std::vector<double>(at)), 1e-12 * part.norm(values));
  part.update(std::span(values));
  for (Index node = 0; node < part.n_nodes(); ++node)
    EXPECT_EQ(key<dim>(Point<dim>(&values[dim * node])), key<dim>(points[node]));
}

/// Values at the nodes of the whole space, looked up by place.
template <int dim>
class ByPlace
{
 public:
  ByPlace(const fem::LagrangeSpace<dim>& space, std::span<const double> values)
  {
    const std::vector<Point<dim>> points = space.node_points();
    for (Index node = 0; node < space.n_nodes(); ++node)
      values_[key<dim>(points[node])] = &values[dim * node];
  }
  [[nodiscard]] const double* at(const Point<dim>& x) const { return values_.at(key<dim>(x)); }

 private:
  std::map<std::array<std::int64_t, dim>, const double*> values_;
};

/// K u, with conditions on two boundaries that meet.
template <int dim>
void expect_same_products(int degree)
{
  const Shared<dim> mesh(10 + degree);
  const ProblemData<dim> data{.boundaries = {fixed<dim>("left", formula("1 + y"), free, free),
                                             fixed<dim>("top", free, formula("x"), free)}};
  const auto product = [&](const mesh::Mesh<dim>& m, const auto& use)
  {
    const problem::Problem<dim> problem = data.on(m);
    const fem::LagrangeSpace<dim> space(m, degree);
    const fem::Constraints constraints = fem::dirichlet(problem, space);
    const algebra::SparseMatrix k(dim, contact::stiffness(problem, space, constraints), space.numbers());
    std::vector<double> u;
    for (const Point<dim>& x : space.node_points())
      for (int a = 0; a < dim; ++a) u.push_back(std::sin(3 * x[0] + a) + x[1] * x[1]);
    use(space, constraints, k.multiply(u), k.diagonal());
  };
  product(*mesh.whole,
          [&](const auto& whole, const auto& all, const auto& all_products, const auto& all_diagonal)
          {
            const ByPlace<dim> fixed_values(whole, all.values);
            const ByPlace<dim> expected(whole, all_products);
            const ByPlace<dim> expected_diagonal(whole, all_diagonal);
            product(mesh.part,
                    [&](const auto& part, const auto& constraints, const auto& products, const auto& diagonal)
                    {
                      const std::vector<Point<dim>> points = part.node_points();
                      for (Index node = 0; node < part.n_nodes(); ++node)
                        for (int a = 0; a < dim; ++a)
                          EXPECT_NEAR(constraints.values[dim * node + a], fixed_values.at(points[node])[a],
                                      1e-12);
                      for (Index i = 0; i < part.n_owned_nodes(); ++i)
                        for (int a = 0; a < dim; ++a)
                        {
                          const Index node = part.owned_node(i);
                          EXPECT_NEAR(products[dim * node + a], expected.at(points[node])[a], 1e-10);
                          EXPECT_NEAR(diagonal[dim * node + a], expected_diagonal.at(points[node])[a], 1e-10);
                        }
                      EXPECT_EQ(fem::n_free_dofs(part, constraints), fem::n_free_dofs(whole, all));
                    });
          });
}

/// K u of the whole mesh. A bug that gives a node of another rank its neighbour's number is seen in the
/// products.
TEST(Nodes, NumberedTwiceMakeAnotherMatrix)
{
  const Shared<2> mesh(3);
  const ProblemData<2> data{.boundaries = {fixed<2>("left", formula("y"), free, free)}};
  const problem::Problem<2> problem = data.on(mesh.part);
  const fem::LagrangeSpace<2> space(mesh.part, 2);
  const fem::Constraints constraints = fem::dirichlet(problem, space);
  std::vector<double> u;
  for (const Point<2>& x : space.node_points())
    for (int a = 0; a < 2; ++a) u.push_back(std::sin(3 * x[0] + a) + x[1] * x[1]);
  const auto product = [&](const std::shared_ptr<const fem::NodeNumbers>& numbers)
  { return algebra::SparseMatrix(2, contact::stiffness(problem, space, constraints), numbers).multiply(u); };
  const fem::NodeNumbers& good = *space.numbers();
  fem::NodeNumbers bad = good;
  const auto is_ghost = [&](Index node)
  { return good.global[node] < good.first || good.global[node] >= good.first + std::ssize(good.owned); };
  Index ghost = 0;
  while (ghost < space.n_nodes() && !is_ghost(ghost)) ++ghost;
  if (ghost < space.n_nodes()) bad.global[ghost] = good.global[ghost == 0 ? 1 : ghost - 1];
  const std::vector<double> right = product(space.numbers());
  const std::vector<double> wrong = product(std::make_shared<const fem::NodeNumbers>(bad));
  double largest = 0;
  for (std::size_t i = 0; i < right.size(); ++i) largest = std::max(largest, std::abs(wrong[i] - right[i]));
  EXPECT_EQ(mesh.ranks.max(largest) > 1e-3, mesh.ranks.size() > 1);
}

TEST(Nodes, AreNumberedOnceAndAgreeByPlace)
{
  for (int degree = 1; degree <= 4; ++degree)
  {
    SCOPED_TRACE("degree " + std::to_string(degree));
    expect_numbers<2>(degree);
    expect_numbers<3>(degree);
  }
}

/// The condensation onto x_1 < 0.3 with a layer up to 0.6: all its results, at its unknowns.
template <int dim>
struct Condensed
{
  Condensed(const mesh::Mesh<dim>& mesh, int degree)
      : space(mesh, degree),
        problem(
            ProblemData<dim>{.boundaries = {fixed<dim>("top", formula("0"), formula("0"), formula("0"))}}.on(
                mesh)),
        constraints(fem::dirichlet(problem, space))
  {
    const std::vector<Point<dim>> points = space.node_points();
    std::vector<Index> layer;
    std::vector<Index> trace;
    std::vector<double> b(space.n_dofs(), 0.0);
    std::vector<double> at_nodes(space.n_dofs(), 0.0);
    for (Index k = 0; k < space.n_owned_nodes(); ++k)
      for (int a = 0; a < dim; ++a)
      {
        const Index node = space.owned_node(k);
        const Index i = dim * node + a;
        if (constraints.fixed[i]) continue;
        b[i] = std::cos(2 * points[node][0] + a) - points[node][1];
        at_nodes[i] = std::sin(3 * points[node][0] + a) + points[node][1] * points[node][1];
        if (points[node][1] < 0.6) (points[node][1] < 0.3 ? trace : layer).push_back(i);
      }
    const algebra::Condensation condensed(dim, contact::stiffness(problem, space, constraints), layer, trace,
                                          b, space.numbers());
    const std::vector<double> x = condensed.on_trace(at_nodes);
    u = condensed.expand(x);
    const std::vector<double> force = condensed.multiply(x);
    std::vector<double> kept(condensed.on_layer_and_trace(at_nodes).size(), 0.0);
    for (std::size_t i = 0; i < force.size(); ++i)
      kept[kept.size() - force.size() + i] = force[i] - condensed.load()[i];
    forces.resize(space.n_dofs(), 0.0);
    condensed.put(kept, forces);
    std::vector<double> near = u;
    condensed.put(condensed.near(x), near);
    distance = 0;
    for (std::size_t i = 0; i < near.size(); ++i) distance = std::max(distance, std::abs(near[i] - u[i]));
    algebra::Triplets springs;
    for (const Index i : trace) springs.add(i, i, 2.0);
    for (const Index i : trace)
      if (!layer.empty()) springs.add(i, layer.front(), 0.0);
    const std::vector<double> d = condensed.solve(springs, force, 1e-14);
    const std::vector<double> again = condensed.multiply(d);
    residual = 0;
    for (std::size_t i = 0; i < d.size(); ++i)
      residual = std::max(residual, std::abs(again[i] + 2 * d[i] - force[i]));
  }

  fem::LagrangeSpace<dim> space;
  problem::Problem<dim> problem;
  fem::Constraints constraints;
  std::vector<double> u;
  std::vector<double> forces;  ///< S x - g
  double distance;             ///< between expand() and near()
  double residual;             ///< from solve()
};

template <int dim>
void expect_same_condensation(int degree)
{
  const Shared<dim> mesh(20 + degree);
  const Condensed<dim> whole(*mesh.whole, degree);
  const Condensed<dim> part(mesh.part, degree);
  const ByPlace<dim> u(whole.space, whole.u);
  const ByPlace<dim> forces(whole.space, whole.forces);
  const std::vector<Point<dim>> points = part.space.node_points();
  for (Index k = 0; k < part.space.n_owned_nodes(); ++k)
    for (int a = 0; a < dim; ++a)
    {
      const Index node = part.space.owned_node(k);
      EXPECT_NEAR(part.u[dim * node + a], u.at(points[node])[a], 1e-10);
      EXPECT_NEAR(part.forces[dim * node + a], forces.at(points[node])[a], 1e-10);
    }
  EXPECT_EQ(part.distance, 0);
  EXPECT_LE(part.residual, 1e-12);
}

TEST(Condensation, IsThatOfTheWholeMesh)
{
  for (int degree = 1; degree <= 3; ++degree)
  {
    SCOPED_TRACE("degree " + std::to_string(degree));
    expect_same_condensation<2>(degree);
    expect_same_condensation<3>(degree);
  }
}

TEST(Nodes, MakeTheMatrixOfTheWholeMesh)
{
  for (int degree = 1; degree <= 3; ++degree)
  {
    SCOPED_TRACE("degree " + std::to_string(degree));
    expect_same_products<2>(degree);
    expect_same_products<3>(degree);
  }
}

}  // namespace
}  // namespace tribound::test
