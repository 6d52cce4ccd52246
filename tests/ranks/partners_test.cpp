/// @file partners_test.cpp
/// Pairs of bodies whose cells are distributed at random: what each rank has, against the whole mesh.

#include "tribound/contact/pairing/partners.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ranks/hidden_wall.h"
#include "support/meshes.h"
#include "support/problem_data.h"
#include "support/random_pair.h"
#include "tribound/contact/nitsche/segment.h"
#include "tribound/mesh/bodies.h"
#include "tribound/mesh/partition.h"
#include "tribound/mesh/share_out.h"
#include "tribound/mesh/verify.h"

namespace tribound::test
{
namespace
{

/// A facet by its cell in the first mesh and its vertices there: an identity that all ranks share.
using FacetKey = std::pair<std::int64_t, std::set<std::uint64_t>>;

template <int dim>
FacetKey key_of(const mesh::Mesh<dim>& mesh, const mesh::BoundaryFacet& facet)
{
  const mesh::Partition<dim>* partition = mesh.partition();
  FacetKey key{partition ? partition->names[facet.cell].root : facet.cell, {}};
  for (const Index v : mesh::facet_vertices(mesh.cell(facet.cell), facet.local))
    key.second.insert(partition ? partition->vertices[v].origin : static_cast<std::uint64_t>(v));
  return key;
}

/// The centre of a segment and the opposite point, measure, gamma, h and gap.
template <int dim>
using Facts = std::array<double, 2 * dim + 4>;

/// All segments on this rank, by their facets, in an order independent of numbering.
template <int dim>
std::map<std::pair<FacetKey, FacetKey>, std::vector<Facts<dim>>> segments_of(
    const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh)
{
  std::map<std::pair<FacetKey, FacetKey>, std::vector<Facts<dim>>> result;
  const Point<dim - 1> centre = Point<dim - 1>::Constant(1.0 / dim);
  for (const contact::ContactSegment<dim>& segment : contact::contact_segments<dim>(problem, mesh, 10))
  {
    if (!segment.master) continue;
    const Point<dim> x = contact::simplex_map(mesh, segment.slave)(centre);
    const Point<dim> y = contact::simplex_map(mesh, *segment.master)(centre);
    Facts<dim>& facts =
        result[{key_of(mesh, segment.slave.facet), key_of(mesh, segment.master->facet)}].emplace_back();
    std::ranges::copy(x, facts.begin());
    std::ranges::copy(y, facts.begin() + dim);
    facts[2 * dim] = segment.measure;
    facts[2 * dim + 1] = segment.gamma;
    facts[2 * dim + 2] = segment.h;
    facts[2 * dim + 3] = segment.gap(centre, x, segment.normal_at(x));
  }
  for (auto& [facets, segments] : result)
    std::ranges::sort(segments, {},
                      [](const Facts<dim>& facts)
                      { return facts[0] + 0.7 * facts[1] + 0.3 * facts[dim - 1]; });
  return result;
}

/// Cells are distributed at random. Each rank must have, as in the whole mesh, all segments of every facet
/// whose cell touches one of its own.
template <int dim>
void expect_partners(const mesh::MeshData<dim>& data, const ProblemData<dim>& problem_data, unsigned seed)
{
  const Ranks ranks = Ranks::world();
  const mesh::Mesh<dim> whole(data);
  const problem::Problem<dim> problem = problem_data.on(whole);
  std::vector<mesh::CellRecord<dim>> owned;
  for (const mesh::CellRecord<dim>& record : mesh::first_records(whole, 0, whole.n_cells()))
    if (static_cast<int>(mesh::mix(mesh::mix(record.name.root + 1) ^ seed) % ranks.size()) == ranks.rank())
      owned.push_back(record);
  mesh::Mesh<dim> part(
      mesh::with_ghosts<dim>(ranks, mesh::cube_around<dim>(whole.vertices()), std::move(owned)),
      {data.region_names, data.boundary_names, {}});
  part = contact::with_partners<dim>(std::move(part), problem.pairs());

  const auto all = segments_of(problem, whole);
  const auto here = segments_of(problem, part);
  std::set<FacetKey> near;
  for (const mesh::BoundaryFacet& facet : part.boundary())
    if (std::ranges::any_of(part.cell(facet.cell), [&](Index v) { return part.has_patch(v); }))
      near.insert(key_of(part, facet));
  std::size_t n_near = 0;
  for (const auto& [facets, expected] : all)
  {
    if (!near.contains(facets.first) && !near.contains(facets.second)) continue;
    ++n_near;
    const auto found = here.find(facets);
    EXPECT_NE(found, here.end()) << "seed " << seed;
    if (found == here.end()) continue;
    EXPECT_EQ(found->second.size(), expected.size()) << "seed " << seed;
    for (std::size_t k = 0; k < std::min(expected.size(), found->second.size()); ++k)
      for (std::size_t i = 0; i < expected[k].size(); ++i)
        EXPECT_NEAR(found->second[k][i], expected[k][i], 1e-11 * std::max(1.0, std::abs(expected[k][i])))
            << i;
  }
  const auto n_here = std::ranges::count_if(
      here, [&](const auto& entry)
      { return near.contains(entry.first.first) || near.contains(entry.first.second); });
  EXPECT_EQ(static_cast<std::size_t>(n_here), n_near) << "seed " << seed;

  const mesh::Bodies expected = mesh::number_bodies(whole);
  const mesh::Bodies found = mesh::number_bodies(part);
  EXPECT_EQ(found.n, expected.n);
  for (Index c = 0; c < part.n_owned_cells(); ++c)
    EXPECT_EQ(found.of_cell[c], expected.of_cell[part.partition()->names[c].root]);
}

TEST(Partners, OfRandomPairs)
{
  for (unsigned seed = 0; seed < 30; ++seed)
  {
    const auto [data, problem] = RandomPair<2>(seed).make();
    expect_partners(renumbered(data, seed), problem, seed);
  }
  for (unsigned seed = 0; seed < 10; ++seed)
  {
    const auto [data, problem] = RandomPair<3>(seed).make();
    expect_partners(renumbered(data, seed), problem, seed);
  }
}

TEST(Partners, HiddenByNearerOnes)
{
  const auto check = [](const auto& bodies)
  {
    for (unsigned seed = 0; seed < 5; ++seed)
      expect_partners(renumbered(bodies.first, seed), bodies.second, seed);
  };
  check(hidden_wall<2>());
  check(hidden_wall<3>());
}

TEST(Partners, ADirectionAlongTheSlaveFailsOnAllRanks)
{
  const Ranks ranks = Ranks::world();
  auto [data, problem_data] = RandomPair<2>(3).make();
  problem_data.pairs[0].pairing.direction = Point<2>(1, 0);
  const mesh::Mesh<2> whole(data);
  const problem::Problem<2> problem = problem_data.on(whole);
  mesh::Mesh<2> part = mesh::share_out<2>(ranks, ranks.is_first() ? &whole : nullptr);
  const auto segments = [&]
  {
    part = contact::with_partners<2>(std::move(part), problem.pairs());
    return contact::contact_segments<2>(problem, part, 10);
  };
  EXPECT_THROW((void)segments(), InputError);  // on all ranks
}

}  // namespace
}  // namespace tribound::test
