#include "tribound/io/fields/contact_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "support/contact_points.h"
#include "support/discrete_problem.h"
#include "support/fields.h"
#include "support/meshes.h"

namespace tribound::test
{
namespace
{

DiscreteProblem<2> two_contacts(const mesh::MeshData<2>& mesh = block<2>({4, 2}))
{
  return {mesh,
          {.boundaries = {clamped<2>("left"), obstacle<2>("bottom", Tresca(0.03), 0.25),
                          obstacle<2>("top", Frictionless(), 0.5)}},
          {.degree = 2}};
}

/// A cube on a rough floor z = 0.
DiscreteProblem<3> cube()
{
  return {box<3>({0, 0, 0}, {1, 1, 1}, {2, 2, 2}),
          {.boundaries = {clamped<3>("top"), obstacle<3>("back", Coulomb(0.5))}}};
}

int number_of(const mesh::MeshData<2>& mesh, const std::string& boundary)
{
  return static_cast<int>(std::ranges::find(mesh.boundary_names, boundary) - mesh.boundary_names.begin());
}

template <int dim>
int tag_of(const DiscreteProblem<dim>& c, const std::string& boundary)
{
  int tag = 0;
  while (c.problem.boundary(tag).name != boundary) ++tag;
  return tag;
}

/// A table of numbers, with columns by name.
class Table
{
 public:
  explicit Table(const std::string& csv)
  {
    std::istringstream in(csv);
    std::string line;
    std::getline(in, line);
    names_ = split(line);
    while (std::getline(in, line)) rows_.push_back(split(line));
  }

  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] const std::string& text(std::size_t row, const std::string& name) const
  {
    return rows_[row].at(std::ranges::find(names_, name) - names_.begin());
  }
  [[nodiscard]] double operator()(std::size_t row, const std::string& name) const
  {
    return std::stod(text(row, name));
  }

 private:
  static std::vector<std::string> split(const std::string& line)
  {
    std::istringstream in(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    return cells;
  }

  std::vector<std::string> names_;
  std::vector<std::vector<std::string>> rows_;
};

TEST(ContactCsv, RunsAlongEachBoundary)
{
  const DiscreteProblem<2> box = two_contacts();
  const auto u = interpolate<2>(box.space, [](const Point<2>& x) { return Point<2>(0.1 * x[0], 0.01); });
  const Table table(io::contact_csv(box.form, u, {0}));
  ASSERT_EQ(table.size(), box.form.n_contact_points());

  std::map<std::string, double> previous;
  for (std::size_t row = 0; row < table.size(); ++row)
  {
    const std::string& boundary = table.text(row, "boundary");
    const bool bottom = boundary == "bottom";
    EXPECT_EQ(table(row, "y"), bottom ? 0.0 : 1.0);
    EXPECT_EQ(table(row, "ny"), bottom ? -1.0 : 1.0);
    EXPECT_NEAR(table(row, "arc"), table(row, "x"), 1e-15) << "both chains start at x = 0";
    if (previous.contains(boundary))
    {
      EXPECT_GT(table(row, "arc"), previous[boundary]);
    }
    previous[boundary] = table(row, "arc");
    EXPECT_NEAR(table(row, "gap"), bottom ? 0.25 + 0.01 : 0.5 - 0.01, 1e-15);
    EXPECT_NEAR(table(row, "slip_x"), 0.1 * table(row, "x"), 1e-15);
    EXPECT_NEAR(table(row, "slip_y"), 0.0, 1e-15);
  }
}

TEST(ContactCsv, StatesAreThoseOfTheForm)
{
  const DiscreteProblem<2> box = two_contacts();
  const auto u =
      interpolate<2>(box.space, [](const Point<2>& x) { return Point<2>(0.1 * x[0], -0.5 * x[0]); });
  const Table table(io::contact_csv(box.form, u, {0}));
  const auto traction = box.form.traction(u);
  // Sorted along the boundary, the points of a facet need not be in the order of the rule.
  double sum = 0.0;
  for (const Point<2>& t : traction) sum += t[0] - 3.0 * t[1];
  double table_sum = 0.0;
  for (std::size_t row = 0; row < table.size(); ++row)
  {
    table_sum += table(row, "traction_x") - 3.0 * table(row, "traction_y");
    EXPECT_GE(table(row, "pressure"), 0.0);
    const double status = table(row, "status");
    EXPECT_TRUE(status == 0.0 || status == 1.0 || status == 2.0);
  }
  EXPECT_NEAR(table_sum, sum, 1e-12 * std::abs(sum));
}

TEST(ContactCsv, NumbersReadBackExactly)
{
  const DiscreteProblem<2> box = two_contacts();
  const auto u =
      interpolate<2>(box.space, [](const Point<2>& x) { return Point<2>(x[0] / 3.0, -x[0] / 7.0); });
  const Table table(io::contact_csv(box.form, u, {0}));
  std::vector<double> written;
  for (std::size_t row = 0; row < table.size(); ++row) written.push_back(table(row, "traction_x"));
  std::vector<double> computed;
  for (std::size_t k = 0; k < box.form.segments().size(); ++k)
    for (const auto& state : box.form.contact_states(u, k)) computed.push_back(state.traction[0]);
  std::ranges::sort(written);
  std::ranges::sort(computed);
  EXPECT_EQ(written, computed);
}

/// Sums over the rows are the integrals of the program.
template <int dim>
void expect_integrals(const DiscreteProblem<dim>& box, const std::vector<double>& u,
                      const std::string& boundary)
{
  const Table table(io::contact_csv(box.form, u, {3}));
  double measure = 0;
  double normal = 0;
  double force = 0;
  for (std::size_t row = 0; row < table.size(); ++row)
  {
    EXPECT_EQ(table.text(row, "level"), "3");
    if (table.text(row, "boundary") != boundary) continue;
    measure += table(row, "weight");
    normal -= table(row, "weight") * table(row, "pressure");
    force += table(row, "weight") * table(row, "traction_x");
  }
  const auto resultants =
      contact::contact_resultants<dim>(box.form, box.form.traction(u), tag_of(box, boundary));
  EXPECT_NEAR(measure, dim == 2 ? 2 : 1, 1e-14);
  EXPECT_NEAR(normal, resultants.normal, 1e-14 * std::abs(resultants.normal));
  EXPECT_NEAR(force, resultants.force[0], 1e-13 * resultants.force.norm());
}

TEST(ContactCsv, WeightsIntegrate)
{
  const DiscreteProblem<2> plane = two_contacts();
  expect_integrals<2>(
      plane, interpolate<2>(plane.space, [](const Point<2>& x) { return Point<2>(0.1 * x[0], -0.5 * x[0]); }),
      "bottom");
  const DiscreteProblem<3> space = cube();
  expect_integrals<3>(
      space,
      interpolate<3>(space.space, [](const Point<3>& x) { return Point<3>(0.1 * x[1], 0, -0.1 * x[0]); }),
      "back");
}

TEST(ContactCsv, RoundingOfCoordinatesIsZero)
{
  mesh::MeshData<2> data = block<2>({4, 2});
  data.vertices[1][1] = 5.55e-17;
  const DiscreteProblem<2> box = two_contacts(data);
  const Table table(io::contact_csv(box.form, std::vector<double>(box.space.n_dofs(), 0.0), {0}));
  for (std::size_t row = 0; row < table.size(); ++row)
    if (table.text(row, "boundary") == "bottom")
    {
      EXPECT_EQ(table.text(row, "y"), "0");
      EXPECT_EQ(table.text(row, "nx"), "0");
    }
}

TEST(ContactChains, OnePieceAroundACorner)
{
  // Top and right side are one group: the chain starts at the upper left corner and ends at the bottom.
  mesh::MeshData<2> data = block<2>({4, 2});
  for (auto& facet : data.facets)
    if (facet.tag == number_of(data, "right")) facet.tag = number_of(data, "top");
  const DiscreteProblem<2> box = two_contacts(data);
  const auto links = io::contact_chains(box.form, tag_of(box, "top"));
  ASSERT_EQ(links.size(), 6u);
  EXPECT_EQ(links[0].arc, 0.0);
  EXPECT_NEAR(links[5].arc, 2.5, 1e-15);

  const Table table(io::contact_csv(box.form, std::vector<double>(box.space.n_dofs(), 0.0), {0}));
  for (std::size_t row = 0; row < table.size(); ++row)
    if (table.text(row, "boundary") == "top")
    {
      EXPECT_NEAR(table(row, "arc"), table(row, "x") + 1.0 - table(row, "y"), 1e-14);
    }
}

TEST(ContactChains, ClosedAndInTwoPieces)
{
  // A square hole is cut out of a square, and its four sides join the bottom group. They form a closed chain
  // beside the open chain of the bottom itself.
  mesh::MeshData<2> data = test::box<2>({0, 0}, {3, 3}, {3, 3});
  data.cells.erase(data.cells.begin() + 8, data.cells.begin() + 10);
  data.regions.resize(data.cells.size());
  for (const auto& [a, b] : {std::array{5, 6}, std::array{6, 10}, std::array{10, 9}, std::array{9, 5}})
    data.facets.push_back({{a, b}, number_of(data, "bottom")});
  const DiscreteProblem<2> box(data, {.boundaries = {clamped<2>("left"), obstacle<2>("bottom")}});
  const auto links = io::contact_chains(box.form, tag_of(box, "bottom"));
  ASSERT_EQ(links.size(), 7u);
  std::vector<double> arcs;
  for (const io::ChainLink& link : links) arcs.push_back(link.arc);
  EXPECT_THAT(arcs, ::testing::Pointwise(::testing::DoubleNear(1e-14), {0., 1., 2., 3., 4., 5., 6.}));

  const Table table(io::contact_csv(box.form, std::vector<double>(box.space.n_dofs(), 0.0), {0}));
  for (std::size_t row = 1; row < table.size(); ++row)
  {
    const double distance =
        std::hypot(table(row, "x") - table(row - 1, "x"), table(row, "y") - table(row - 1, "y"));
    const double step = table(row, "arc") - table(row - 1, "arc");
    const bool new_chain = table(row - 1, "y") == 0.0 && table(row, "y") > 0.0;
    if (!new_chain)
    {
      EXPECT_LE(distance, step + 1e-14) << "row " << row;
    }
  }
}

TEST(ContactCsv, InThreeDimensions)
{
  const DiscreteProblem<3> box = cube();
  const auto u = interpolate<3>(box.space, [](const Point<3>&) { return Point<3>(0.0, 0.0, -0.1); });
  const std::string csv = io::contact_csv(box.form, u, {0});
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "boundary,facet,x,y,z,nx,ny,nz,pressure,traction_x,traction_y,traction_z,limit,status,gap,slip_x,"
            "slip_y,slip_z,weight,level,pair");
  const Table table(csv);
  ASSERT_EQ(table.size(), box.form.n_contact_points());
  for (std::size_t row = 0; row < table.size(); ++row)
  {
    EXPECT_EQ(table(row, "z"), 0.0);
    EXPECT_EQ(table(row, "nz"), -1.0);
    EXPECT_NEAR(table(row, "gap"), -0.1, 1e-15);
    EXPECT_GT(table(row, "pressure"), 0.0);
    EXPECT_NEAR(table(row, "limit"), 0.5 * table(row, "pressure"), 1e-14);
  }
}

}  // namespace
}  // namespace tribound::test
