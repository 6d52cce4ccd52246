/// @file bisect_test.cpp
/// A mesh bisected by several ranks against the same mesh bisected by one, cell by cell and bit by bit.

#include "tribound/mesh/bisect.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "support/joined_meshes.h"
#include "support/meshes.h"
#include "tribound/base/error.h"

namespace tribound::test
{
namespace
{

using mesh::CellName;
using mesh::CellRecord;
using mesh::MeshData;

std::uint64_t hash(const CellName& name, std::uint64_t seed)
{
  return mesh::mix(mesh::mix(mesh::mix(name.root + seed) ^ name.path[0]) + name.depth);
}

/// A random share of all cells, or those at the vertex with the least name, so that closure has to travel.
enum class Marks
{
  some,
  at_a_corner
};

/// Cells on several ranks, with the operations that lead from one mesh to the next.
template <int dim>
class Parts
{
 public:
  Parts(const Ranks& ranks, const MeshData<dim>& data)
      : ranks_(ranks),
        cube_(mesh::cube_around<dim>(data.vertices)),
        labels_{data.region_names, data.boundary_names, {}}
  {
    for (const CellRecord<dim>& cell : all_records(data))
      if (anywhere(cell.name, 0) == ranks.rank()) owned_.push_back(cell);
  }

  void bisect(Marks marks, std::uint64_t round, int times)
  {
    const mesh::Mesh<dim> local(mesh::with_ghosts<dim>(ranks_, cube_, owned_), labels_);
    std::vector<Index> marked;
    for (Index c = 0; c < local.n_owned_cells(); ++c)
      if (is_marked(marks, local.partition()->names[c], local, c, round)) marked.push_back(c);
    mesh::BisectedPart<dim> finer = mesh::bisect_part<dim>(local, marked, times);
    ASSERT_EQ(finer.parent.size(), finer.cells.size());
    for (std::size_t c = 0; c < finer.cells.size(); ++c)
      EXPECT_EQ(finer.cells[c].name.root, local.partition()->names[finer.parent[c]].root);
    EXPECT_TRUE(std::ranges::is_sorted(finer.cells, {}, &CellRecord<dim>::name));
    owned_ = std::move(finer.cells);
  }

  /// Moves cells along the curve or anywhere; anywhere makes nearly all edges shared.
  void move(bool along_curve, std::uint64_t round)
  {
    std::vector<int> to;
    if (along_curve)
      to = mesh::balanced_ranks(ranks_, mesh::centre_keys<dim>(cube_, owned_),
                                std::vector<std::int64_t>(owned_.size(), 1));
    else
      for (const CellRecord<dim>& cell : owned_) to.push_back(anywhere(cell.name, round));
    owned_ = ranks_.send_to<CellRecord<dim>>(to, owned_);
  }

  /// The cells of all ranks in the order of their names, on every rank.
  [[nodiscard]] std::vector<CellRecord<dim>> all() const
  {
    std::vector<CellRecord<dim>> result;
    for (const auto& cells : ranks_.send(std::vector<std::vector<CellRecord<dim>>>(ranks_.size(), owned_)))
      result.insert(result.end(), cells.begin(), cells.end());
    std::ranges::sort(result, {}, &CellRecord<dim>::name);
    return result;
  }

  static bool is_marked(Marks marks, const CellName& name, const mesh::Mesh<dim>& mesh, Index c,
                        std::uint64_t round)
  {
    if (marks == Marks::some) return hash(name, round) % 6 == 0;
    return std::ranges::any_of(mesh.cell(c), [&](Index v) { return mesh.vertex(v).isZero(0); });
  }

 private:
  [[nodiscard]] int anywhere(const CellName& name, std::uint64_t seed) const
  {
    return static_cast<int>(hash(name, seed + 100) % ranks_.size());
  }

  Ranks ranks_;
  mesh::Cube<dim> cube_;
  mesh::MeshLabels labels_;
  std::vector<CellRecord<dim>> owned_;
};

/// On all ranks together and on each alone.
template <int dim>
void expect_same_on_any_number(const MeshData<dim>& data, Marks marks, int n_rounds, int times)
{
  Parts<dim> parts(Ranks::world(), data);
  Parts<dim> alone(Ranks(), data);
  for (int round = 0; round < n_rounds; ++round)
  {
    SCOPED_TRACE(round);
    parts.bisect(marks, round, times);
    alone.bisect(marks, round, times);
    EXPECT_TRUE(parts.all() == alone.all());
    parts.move(round % 2 == 0, round);
  }
}

/// A part that is the whole mesh, against bisect().
template <int dim>
void expect_as_a_whole(const MeshData<dim>& data, Marks marks, int n_rounds, int times)
{
  Parts<dim> part(Ranks(), data);
  mesh::Mesh<dim> whole(data);
  for (int round = 0; round < n_rounds; ++round)
  {
    SCOPED_TRACE(round);
    const std::vector<CellRecord<dim>> before = part.all();
    std::vector<Index> marked;
    for (Index c = 0; c < whole.n_cells(); ++c)
      if (Parts<dim>::is_marked(marks, before[c].name, whole, c, round)) marked.push_back(c);
    whole = mesh::bisect<dim>(whole, marked, times).mesh;
    part.bisect(marks, round, times);
    const std::vector<CellRecord<dim>> cells = part.all();
    ASSERT_EQ(static_cast<Index>(cells.size()), whole.n_cells());
    std::vector<std::array<std::int32_t, dim + 1>> tags(cells.size());
    for (auto& of_cell : tags) of_cell.fill(mesh::facet_inside);
    for (const auto& [cell, local, tag] : whole.boundary()) tags[cell][local] = tag;
    for (Index c = 0; c < whole.n_cells(); ++c)
    {
      EXPECT_EQ(cells[c].region, whole.region(c));
      EXPECT_EQ(cells[c].bisection_type, whole.bisection_types()[c]);
      EXPECT_EQ(cells[c].tags, tags[c]);
      for (int i = 0; i <= dim; ++i) EXPECT_EQ(cells[c].vertices[i].point(), whole.vertex(whole.cell(c)[i]));
    }
  }
}

template <int dim>
void expect_same(const MeshData<dim>& data, int n_rounds)
{
  for (const int times : {1, dim})
  {
    SCOPED_TRACE(times);
    expect_same_on_any_number(data, Marks::some, n_rounds, times);
    expect_same_on_any_number(data, Marks::at_a_corner, 2 * n_rounds, times);
  }
}

TEST(BisectPart, IsBisectToTheBit)
{
  expect_same(renumbered(block<2>({8, 4}), 1), 4);
  expect_same(renumbered(block<3>({4, 2}, {4, 2, 2}), 1), 3);
  if (!Ranks::world().is_first()) return;
  for (const Marks marks : {Marks::some, Marks::at_a_corner})
  {
    expect_as_a_whole(renumbered(block<2>({8, 4}), 1), marks, 5, 2);
    expect_as_a_whole(renumbered(block<3>({4, 2}, {4, 2, 2}), 1), marks, 4, 3);
    expect_as_a_whole(renumbered(block<3>({4, 2}, {4, 2, 2}), 1), marks, 4, 1);
  }
}

/// Coinciding vertices on the two sides of a joint or a contact have different names, and so do the midpoints
/// of their edges.
TEST(BisectPart, OfBodiesThatTouchAndOfJoints)
{
  expect_same(crossing_joints<2>(), 3);
  expect_same(crossing_joints<3>(), 2);
  expect_same(touching_boxes<2>(4), 3);
  expect_same(touching_boxes<2>(6), 3);
  expect_same(touching_boxes<3>(6), 2);
}

/// Of the vertices that ranks 0 and 1 share, makes both forget that the other has vertex number `which`;
/// false if they share no such vertex.
template <int dim>
bool skip_sharer(mesh::Partition<dim>& partition, Index which)
{
  const int other = 1 - partition.ranks.rank();
  bool skipped = false;
  for (Index v = 0; v < static_cast<Index>(partition.vertices.size()) && other >= 0 && !skipped; ++v)
  {
    const std::span<const int> sharers = partition.sharers_of(v);
    const auto found = std::ranges::find(sharers, other);
    if (found == sharers.end() || which-- > 0) continue;
    partition.sharers.erase(partition.sharers.begin() + partition.sharers_begin[v] +
                            (found - sharers.begin()));
    for (std::size_t w = v + 1; w < partition.sharers_begin.size(); ++w) --partition.sharers_begin[w];
    skipped = true;
  }
  return partition.ranks.any(skipped);
}

/// A bug that loses one sharer of a vertex either makes the mesh non-conforming or changes nothing.
template <int dim>
void expect_all_sharers_needed(const MeshData<dim>& data)
{
  const Ranks ranks = Ranks::world();
  const auto cube = mesh::cube_around<dim>(data.vertices);
  const mesh::MeshLabels labels{data.region_names, data.boundary_names, {}};
  std::vector<CellRecord<dim>> owned;
  for (const CellRecord<dim>& cell : all_records(data))
    if (static_cast<int>(hash(cell.name, 7) % ranks.size()) == ranks.rank()) owned.push_back(cell);
  const auto bisected = [&](mesh::MeshPart<dim> part)
  {
    const mesh::Mesh<dim> local(std::move(part), labels);
    std::vector<Index> marked;
    for (Index c = 0; c < local.n_owned_cells(); ++c)
      if (hash(local.partition()->names[c], 8) % 3 == 0) marked.push_back(c);
    return mesh::bisect_part<dim>(local, marked, 1).cells;
  };
  const mesh::MeshPart<dim> good = mesh::with_ghosts<dim>(ranks, cube, owned);
  const std::vector<CellRecord<dim>> right = bisected(good);
  int n_seen = 0;
  for (Index which = 0;; ++which)
  {
    mesh::MeshPart<dim> part = good;
    if (!skip_sharer(part.partition, which)) break;
    const std::vector<CellRecord<dim>> cells = bisected(std::move(part));
    const bool differs = ranks.any(cells != right);
    const mesh::MeshPart<dim> finer = mesh::with_ghosts<dim>(ranks, cube, cells);
    bool is_seen = false;
    try
    {
      const mesh::Mesh<dim> mesh(finer, labels);
    }
    catch (const InputError&)
    {
      is_seen = true;
    }
    is_seen = ranks.any(is_seen);
    EXPECT_EQ(is_seen, differs) << "vertex " << which;
    n_seen += is_seen ? 1 : 0;
  }
  if (ranks.size() <= 4)  // with cells of more ranks at a vertex, a third rank passes the news on
  {
    EXPECT_EQ(n_seen > 0, ranks.size() > 1);
  }
}

TEST(BisectPart, NeedsAllSharers)
{
  expect_all_sharers_needed(block<2>({8, 4}));
  expect_all_sharers_needed(block<3>({4, 2}, {3, 2, 2}));
}

/// Bisecting too deep on one rank is an error on all.
TEST(BisectPart, FailsOnAllRanks)
{
  const Ranks ranks = Ranks::world();
  const MeshData<2> data = block<2>({8, 4});
  std::vector<CellRecord<2>> owned;
  for (CellRecord<2> cell : all_records(data))
  {
    if (cell.name.root == 0) cell.name.depth = CellName::max_depth;
    if (cell.name.root % ranks.size() == ranks.rank()) owned.push_back(cell);
  }
  const mesh::Mesh<2> local(mesh::with_ghosts<2>(ranks, mesh::cube_around<2>(data.vertices), owned),
                            {data.region_names, data.boundary_names, {}});
  const std::vector<Index> marked = ranks.is_first() ? std::vector<Index>{0} : std::vector<Index>{};
  EXPECT_THROW(static_cast<void>(mesh::bisect_part<2>(local, marked)), InputError);
}

}  // namespace
}  // namespace tribound::test
