/// @file partition_test.cpp
/// Meshes distributed over ranks, against what each rank finds from all cells.

#include "tribound/mesh/partition.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "support/joined_meshes.h"
#include "support/meshes.h"
#include "tribound/base/error.h"
#include "tribound/mesh/box.h"
#include "tribound/mesh/share_out.h"

namespace tribound::test
{
namespace
{

using mesh::CellName;
using mesh::CellRecord;
using mesh::MeshData;
using mesh::VertexName;

/// A random rank for each cell, the same on all ranks.
int anywhere(const CellName& name, int round, int n_ranks)
{
  return static_cast<int>(mesh::mix(mesh::mix(name.root + 1) ^ round) % n_ranks);
}

/// What every rank must have if `rank_of` gives the rank of each cell of `all`.
template <int dim>
void expect_part(const mesh::MeshPart<dim>& part, const std::vector<CellRecord<dim>>& all,
                 const std::vector<int>& rank_of)
{
  const auto& partition = part.partition;
  const int me = partition.ranks.rank();
  std::map<VertexName<dim>, std::set<int>> ranks_around;
  std::set<VertexName<dim>> own_vertices;
  for (std::size_t c = 0; c < all.size(); ++c)
    for (const VertexName<dim>& v : all[c].vertices)
    {
      ranks_around[v].insert(rank_of[c]);
      if (rank_of[c] == me) own_vertices.insert(v);
    }

  std::vector<CellRecord<dim>> expected;
  std::vector<int> owners;
  for (const bool own : {true, false})
    for (std::size_t c = 0; c < all.size(); ++c)
    {
      const bool here =
          std::ranges::any_of(all[c].vertices, [&](const auto& v) { return own_vertices.contains(v); });
      if (!here || (rank_of[c] == me) != own) continue;
      expected.push_back(all[c]);
      if (!own) owners.push_back(rank_of[c]);
    }
  EXPECT_EQ(part.cells, expected);
  EXPECT_EQ(partition.ghost_owners, owners);
  EXPECT_EQ(partition.n_owned_cells, static_cast<Index>(expected.size() - owners.size()));
  EXPECT_EQ(partition.n_cells, static_cast<std::int64_t>(all.size()));
  EXPECT_EQ(partition.n_vertices, static_cast<std::int64_t>(ranks_around.size()));

  for (std::size_t c = 0; c < part.cells.size(); ++c)
    for (int i = 0; i <= dim; ++i)
      EXPECT_EQ(partition.vertices[part.corners[c][i]], part.cells[c].vertices[i]);
  const auto key = [&](const VertexName<dim>& v)
  { return std::pair(mesh::morton_key<dim>(partition.cube, v.point()), v); };
  for (std::size_t v = 1; v < partition.vertices.size(); ++v)
    EXPECT_LT(key(partition.vertices[v - 1]), key(partition.vertices[v]));
  for (Index v = 0; v < static_cast<Index>(partition.vertices.size()); ++v)
  {
    std::set<int> others = ranks_around[partition.vertices[v]];
    const bool has_patch = others.erase(me) > 0;
    EXPECT_EQ(partition.has_patch[v] != 0, has_patch);
    if (!has_patch) others.clear();
    const std::span<const int> sharers = partition.sharers_of(v);
    EXPECT_EQ(std::set<int>(sharers.begin(), sharers.end()), others);
    EXPECT_EQ(sharers.size(), others.size());
  }

  const auto topology =
      mesh::build_topology<dim>(static_cast<Index>(partition.vertices.size()), part.corners);
  for (Index c = 0; c < partition.n_owned_cells; ++c)
    for (int i = 0; i <= dim; ++i)
      EXPECT_EQ(part.cells[c].tags[i] == mesh::facet_inside,
                topology.facet_cells[topology.cell_facets[c][i]][1] >= 0);
}

/// The part as a mesh: its cells; only facets on the boundary of the whole are boundary facets.
template <int dim>
void expect_mesh(const mesh::MeshPart<dim>& part, const MeshData<dim>& whole)
{
  const mesh::Mesh<dim> local(part, {whole.region_names, whole.boundary_names, {}});
  ASSERT_EQ(local.n_cells(), static_cast<Index>(part.cells.size()));
  EXPECT_EQ(local.n_owned_cells(), part.partition.n_owned_cells);
  for (Index v = 0; v < local.n_vertices(); ++v)
  {
    EXPECT_EQ(local.vertex(v), part.partition.vertices[v].point());
    EXPECT_EQ(local.has_patch(v), part.partition.has_patch[v] != 0);
  }
  std::size_t n_boundary = 0;
  for (Index c = 0; c < local.n_cells(); ++c)
  {
    EXPECT_EQ(local.cell(c), part.corners[c]);
    EXPECT_EQ(local.region(c), part.cells[c].region);
    for (const std::int32_t tag : part.cells[c].tags) n_boundary += tag != mesh::facet_inside ? 1 : 0;
  }
  EXPECT_EQ(local.boundary().size(), n_boundary);
  for (const auto& [cell, facet, tag] : local.boundary()) EXPECT_EQ(part.cells[cell].tags[facet], tag);
}

/// The rank that each cell of `all` goes to along the curve; `to` gets those of `own`. Checks that the cells
/// would go to the same ranks from the first rank.
template <int dim>
std::vector<int> along_the_curve(const mesh::Partition<dim>& partition,
                                 const std::vector<CellRecord<dim>>& all,
                                 std::span<const CellRecord<dim>> own, std::vector<int>& to)
{
  const Ranks& ranks = partition.ranks;
  const auto shared_out = [&](std::span<const CellRecord<dim>> cells)
  {
    const std::vector<std::int64_t> weights(cells.size(), 1);
    return mesh::balanced_ranks(ranks, mesh::centre_keys<dim>(partition.cube, cells), weights);
  };
  to = shared_out(own);
  struct Told
  {
    std::int64_t cell;
    int rank;
  };
  std::vector<Told> mine;
  for (std::size_t c = 0; c < own.size(); ++c) mine.push_back({own[c].name.root, to[c]});
  std::vector<int> rank_of(all.size(), -1);
  for (const std::vector<Told>& told : ranks.send(std::vector<std::vector<Told>>(ranks.size(), mine)))
    for (const auto& [cell, rank] : told) rank_of[cell] = rank;
  const std::vector<int> from_the_first =
      shared_out(ranks.is_first() ? std::span(all) : std::span(all).first(0));
  EXPECT_TRUE(!ranks.is_first() || from_the_first == rank_of);
  return rank_of;
}

/// Distributed at random, then along the curve, then at random again.
template <int dim>
void expect_parts(const MeshData<dim>& data)
{
  const Ranks ranks = Ranks::world();
  const std::vector<CellRecord<dim>> all = all_records(data);
  const auto cube = mesh::cube_around<dim>(data.vertices);
  const auto at_random = [&](std::span<const CellRecord<dim>> cells, int round)
  {
    std::vector<int> to;
    for (const CellRecord<dim>& cell : cells) to.push_back(anywhere(cell.name, round, ranks.size()));
    return to;
  };
  std::vector<int> rank_of = at_random(all, 0);
  std::vector<CellRecord<dim>> owned;
  for (std::size_t c = 0; c < all.size(); ++c)
    if (rank_of[c] == ranks.rank()) owned.push_back(all[c]);

  for (int round = 0; round < 3; ++round)
  {
    SCOPED_TRACE(round);
    const mesh::MeshPart<dim> part = mesh::with_ghosts<dim>(ranks, cube, owned);
    expect_part(part, all, rank_of);
    expect_mesh(part, data);
    const auto own = std::span(part.cells).first(part.partition.n_owned_cells);
    std::vector<int> to = at_random(own, 1);
    rank_of = round == 0 ? along_the_curve<dim>(part.partition, all, own, to) : at_random(all, 1);
    owned = ranks.send_to<CellRecord<dim>>(to, own);
  }
}

TEST(Partition, HasTheCellsAroundItsOwn)
{
  expect_parts(renumbered(block<2>({12, 6}), 1));
  expect_parts(renumbered(block<3>({4, 3}, {4, 3, 3}), 1));
}

TEST(Partition, TellsVerticesInOnePlaceApart)
{
  expect_parts(crossing_joints<2>());
  expect_parts(crossing_joints<3>());
  expect_parts(touching_boxes<2>(4));
  expect_parts(touching_boxes<2>(6));
  expect_parts(touching_boxes<3>(4));
  expect_parts(touching_boxes<3>(6));
}

/// The part does not conform without one of its ghosts, nor with a boundary between two cells.
TEST(Partition, IsVerified)
{
  const MeshData<2> data = block<2>({8, 4});
  const std::vector<CellRecord<2>> all = all_records(data);
  const auto cube = mesh::cube_around<2>(data.vertices);
  const mesh::MeshPart<2> good = mesh::with_ghosts<2>(Ranks(), cube, all);
  const mesh::MeshLabels labels{data.region_names, data.boundary_names, {}};
  EXPECT_NO_THROW(mesh::Mesh<2>(good, labels));
  mesh::MeshPart<2> bad = good;
  const auto inside = std::ranges::find(bad.cells[20].tags, mesh::facet_inside);
  ASSERT_NE(inside, bad.cells[20].tags.end());
  *inside = mesh::facet_ungrouped;
  EXPECT_THROW(mesh::Mesh<2>(bad, labels), InputError);
  std::vector<CellRecord<2>> some = all;
  some.erase(some.begin() + 20);
  EXPECT_THROW(mesh::Mesh<2>(mesh::with_ghosts<2>(Ranks(), cube, some), labels), InputError);
}

/// A bug that loses any one ghost is seen at once.
template <int dim>
void expect_all_ghosts_needed(const MeshData<dim>& data)
{
  const Ranks ranks = Ranks::world();
  std::vector<CellRecord<dim>> owned;
  for (const CellRecord<dim>& cell : all_records(data))
    if (anywhere(cell.name, 3, ranks.size()) == ranks.rank()) owned.push_back(cell);
  const auto good = mesh::with_ghosts<dim>(ranks, mesh::cube_around<dim>(data.vertices), owned);
  const mesh::MeshLabels labels{data.region_names, data.boundary_names, {}};
  for (std::size_t g = 0; g < good.partition.ghost_owners.size(); ++g)
  {
    mesh::MeshPart<dim> part = good;
    const auto cell = static_cast<std::ptrdiff_t>(good.partition.n_owned_cells + g);
    part.cells.erase(part.cells.begin() + cell);
    part.corners.erase(part.corners.begin() + cell);
    part.partition.names.erase(part.partition.names.begin() + cell);
    part.partition.ghost_owners.erase(part.partition.ghost_owners.begin() + static_cast<std::ptrdiff_t>(g));
    EXPECT_THROW(mesh::Mesh<dim>(part, labels), InputError) << "ghost " << g;
  }
}

TEST(Partition, NeedsAllItsGhosts)
{
  expect_all_ghosts_needed(block<2>({8, 4}));
  expect_all_ghosts_needed(block<3>({4, 3}, {3, 3, 3}));
}

TEST(Partition, SharesAreEqualAlongTheCurve)
{
  const Ranks ranks = Ranks::world();
  const std::vector<CellRecord<2>> all = all_records(block<2>({64, 32}));
  const auto cube = mesh::cube_around<2>(block<2>({64, 32}).vertices);
  std::vector<CellRecord<2>> owned;  // all on the last rank
  if (ranks.rank() == ranks.size() - 1) owned = all;
  std::vector<std::int64_t> weights(owned.size());
  for (std::size_t c = 0; c < owned.size(); ++c) weights[c] = 1 + 9 * (owned[c].name.root % 50 == 0 ? 1 : 0);
  const std::vector<int> to = mesh::balanced_ranks(ranks, mesh::centre_keys<2>(cube, owned), weights);
  std::vector<std::int64_t> loads(ranks.size(), 0);
  for (std::size_t c = 0; c < owned.size(); ++c) loads[to[c]] += weights[c];
  ranks.sum(std::span(loads));
  std::int64_t all_weight = 0;
  for (const std::int64_t load : loads) all_weight += load;
  for (const std::int64_t load : loads) EXPECT_NEAR(load, double(all_weight) / ranks.size(), 10);
}

TEST(GhostUpdate, BringsTheValuesOfTheOwners)
{
  const Ranks ranks = Ranks::world();
  const MeshData<3> data = block<3>({4, 3}, {4, 3, 3});
  std::vector<CellRecord<3>> owned;
  for (const CellRecord<3>& cell : all_records(data))
    if (anywhere(cell.name, 5, ranks.size()) == ranks.rank()) owned.push_back(cell);
  const auto part = mesh::with_ghosts<3>(ranks, mesh::cube_around<3>(data.vertices), owned);
  const auto& partition = part.partition;
  const GhostUpdate update = mesh::cell_update(partition);
  std::vector<double> values(2 * part.cells.size(), -1.0);
  for (Index c = 0; c < partition.n_owned_cells; ++c)
    for (int i = 0; i < 2; ++i) values[2 * c + i] = 10.0 * partition.names[c].root + i;
  update(std::span(values), 2);
  for (std::size_t c = 0; c < part.cells.size(); ++c)
    for (int i = 0; i < 2; ++i) EXPECT_EQ(values[2 * c + i], 10.0 * partition.names[c].root + i);
  std::vector<char> nothing;
  GhostUpdate()(std::span(nothing));
}

template <int dim>
std::vector<CellRecord<dim>> own_records(const mesh::Mesh<dim>& mesh)
{
  std::vector<Index> own(mesh.n_owned_cells());
  std::iota(own.begin(), own.end(), 0);
  return mesh::records_of<dim>(mesh, own);
}

/// Each rank makes its section of the cells of one or several boxes, whose whole mesh is `data`. Distributing
/// the whole mesh in batches gives the same cells.
template <int dim, class Source>
void expect_same_cells(const Source& box, mesh::MeshData<dim> data)
{
  const Ranks ranks = Ranks::world();
  const mesh::Mesh<dim> whole(std::move(data));
  const std::vector<CellRecord<dim>> all = mesh::first_records(whole, 0, whole.n_cells());
  ASSERT_EQ(mesh::n_box_cells(box), static_cast<std::int64_t>(all.size()));
  EXPECT_TRUE(mesh::box_records<dim>(box, 0, mesh::n_box_cells(box)) == all);
  const auto n_all = static_cast<std::int64_t>(all.size());
  const mesh::Mesh<dim> by_formula = mesh::share_out<dim>(ranks, box);
  const std::vector<CellRecord<dim>> own = own_records(by_formula);
  for (const CellRecord<dim>& cell : own) EXPECT_TRUE(cell == all[cell.name.root]);
  EXPECT_EQ(ranks.sum(static_cast<std::int64_t>(own.size())), n_all);
  EXPECT_EQ(by_formula.n_global_cells(), n_all);
  for (const Index batch : {1'000'000, 7})
  {
    const mesh::Mesh<dim> from_first =
        mesh::share_out<dim>(ranks, ranks.is_first() ? &whole : nullptr, batch);
    EXPECT_TRUE(own_records(from_first) == own);
    EXPECT_EQ(by_formula.n_global_vertices(), from_first.n_global_vertices());
    EXPECT_TRUE(std::ranges::equal(by_formula.boundary_names(), from_first.boundary_names()));
    EXPECT_TRUE(std::ranges::equal(by_formula.region_names(), from_first.region_names()));
  }
  EXPECT_LE(mesh::n_box_cells(mesh::coarser_box(box, 40)), 40);
  EXPECT_EQ(mesh::n_box_cells(mesh::coarser_box(box, n_all)), n_all);
}

template <int dim>
void expect_same_box(const mesh::BoxMesh& box)
{
  expect_same_cells<dim>(box, mesh::box_mesh<dim>(box));
  const mesh::BoxMesh coarser = mesh::coarser_box(box, 40);
  EXPECT_TRUE(coarser.lower == box.lower && coarser.upper == box.upper);
}

/// Each box on top of the one before.
template <int dim>
void expect_same_boxes(const mesh::Boxes& boxes)
{
  mesh::MeshData<dim> data = mesh::box_meshes<dim>(boxes);
  for (std::size_t k = 1; k < boxes.size(); ++k)
    data.interfaces.push_back({{{{boxes[k - 1].name + ".top"}, {boxes[k].name + ".bottom"}}}});
  expect_same_cells<dim>(boxes, std::move(data));
}

TEST(Box, IsMadeByAllRanks)
{
  expect_same_box<2>({.lower = {0, -1}, .upper = {2.5, 0.7}, .cells = {7, 5}});
  const mesh::BoxMesh upper{.lower = {0, 0}, .upper = {1, 1}, .cells = {5, 4}};
  const mesh::BoxMesh lower{.lower = {-0.5, -2}, .upper = {2, 0}, .cells = {7, 3}};
  expect_same_boxes<2>({{"lower", lower}, {"upper", upper}});
  expect_same_boxes<3>({{"a", {.lower = {0, 0, 0}, .upper = {1, 1, 2}, .cells = {2, 1, 3}}},
                        {"b", {.lower = {0, 1, 0}, .upper = {2, 2, 2}, .cells = {3, 2, 2}}},
                        {"c", {.lower = {0, 2, 0}, .upper = {2, 3, 2}, .cells = {1, 1, 4}}}});
  expect_same_box<3>({.lower = {0, -1, 3}, .upper = {2.5, 0.7, 4}, .cells = {5, 3, 4}});
}

/// Bytes of a rank's part of a mesh; counts only what grows with the mesh.
template <int dim>
double bytes_of(const mesh::Mesh<dim>& mesh)
{
  const auto size = [](const auto& values) { return static_cast<double>(std::span(values).size_bytes()); };
  const mesh::Topology<dim>& t = mesh.topology();
  const mesh::Partition<dim>& p = *mesh.partition();
  double bytes =
      size(mesh.vertices()) + size(mesh.cells()) + size(mesh.boundary()) + size(mesh.bisection_types());
  bytes += size(t.facets) + size(t.facet_cells) + size(t.cell_facets) + size(t.edges) + size(t.cell_edges) +
           size(t.vertex_cells_begin) + size(t.vertex_cells);
  bytes += size(p.names) + size(p.ghost_owners) + size(p.vertices) + size(p.has_patch) +
           size(p.sharers_begin) + size(p.sharers);
  return bytes;
}

/// Each rank has a share of the cells, plus what grows like the surface between the parts.
TEST(Box, LeavesNoRankTheWhole)
{
  const Ranks ranks = Ranks::world();
  constexpr double per_cell = 350;
  for (const int n : {8, 16, 32})
  {
    const mesh::BoxMesh box{.lower = {0, 0, 0}, .upper = {1, 1, 1}, .cells = {n, n, n}};
    const mesh::Mesh<3> part = mesh::share_out<3>(ranks, box);
    const double share = static_cast<double>(part.n_global_cells()) / ranks.size();
    const double surface = ranks.size() == 1 ? 0 : 40.0 * n * n;
    EXPECT_LT(bytes_of(part), per_cell * (1.05 * share + surface) + 3e5) << n;
  }
}

}  // namespace
}  // namespace tribound::test
