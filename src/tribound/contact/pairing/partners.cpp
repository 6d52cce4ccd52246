#include "tribound/contact/pairing/partners.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tribound/base/sorted.h"
#include "tribound/contact/pairing/slave_facet.h"
#include "tribound/mesh/share_out.h"

namespace tribound::contact
{

namespace
{

/// A box around the master facets of a rank: its lower corner, then its upper one.
template <int dim>
using Ends = std::array<double, 2 * dim>;

/// A slave facet for which opposite facets are sought.
template <int dim>
struct Question
{
  mesh::CellRecord<dim> cell;
  std::int32_t local;
  std::int32_t pair;
  std::int32_t slave;  ///< its number on the asking rank
};

/// A cell with an opposite facet, and the number of ranks that need the pairs of this facet.
template <int dim>
struct Answer
{
  mesh::CellRecord<dim> cell;
  std::int32_t slave;
  std::int32_t n_ranks;
};

/// Own facets of one side of a pair.
template <int dim>
struct OwnSide
{
  std::vector<mesh::BoundaryFacet> facets;
  std::vector<mesh::CellRecord<dim>> cells;
  std::vector<FacetShape<dim>> shapes;  ///< numbered in this order
};

/// The data of a slave facet.
template <int dim>
struct Slave
{
  mesh::CellRecord<dim> cell;
  std::vector<mesh::Ghost<dim>> opposite{};
  std::vector<int> needed_by{};  ///< the ranks that need it
};

template <int dim>
FacetShape<dim> shape_of(const mesh::CellRecord<dim>& cell, int local, std::size_t number)
{
  const auto vertices = mesh::facet_vertices(cell.vertices, local);
  std::array<Point<dim>, dim> points;
  std::ranges::transform(vertices, points.begin(), &mesh::VertexName<dim>::point);
  return {number, points, local};
}

/// The sides of all pairs, slave and master in turn: first their facets, then the records of their cells.
template <int dim>
std::vector<OwnSide<dim>> own_sides(const mesh::Mesh<dim>& mesh,
                                    std::span<const problem::ContactPair<dim>> pairs)
{
  std::vector<OwnSide<dim>> sides;
  std::vector<Index> cells;
  for (const problem::ContactPair<dim>& pair : pairs)
    for (const auto* names : {&pair.slave, &pair.master})
    {
      OwnSide<dim>& side = sides.emplace_back();
      for (const std::size_t number : mesh::facets_named(mesh, *names))
      {
        if (number >= mesh.n_owned_boundary()) continue;
        side.facets.push_back(mesh.boundary()[number]);
        cells.push_back(mesh.boundary()[number].cell);
      }
    }
  const std::vector<mesh::CellRecord<dim>> records = mesh::records_of<dim>(mesh, cells);
  auto next = records.begin();
  for (OwnSide<dim>& side : sides)
  {
    const auto begin = next;
    next += std::ssize(side.facets);
    side.cells.assign(begin, next);
    for (std::size_t i = 0; i < side.facets.size(); ++i)
      side.shapes.push_back(shape_of(side.cells[i], side.facets[i].local, i));
  }
  return sides;
}

/// The ranks with own cells around the vertices of an own cell, this one included.
template <int dim>
std::vector<int> ranks_around(const mesh::Mesh<dim>& mesh, Index cell)
{
  std::vector<int> result = {mesh.ranks().rank()};
  for (const Index v : mesh.cell(cell))
  {
    const std::span<const int> sharers = mesh.partition()->sharers_of(v);
    result.insert(result.end(), sharers.begin(), sharers.end());
  }
  return result;
}

/// For each rank and pair, a box around its masters. All ranks call it together.
template <int dim>
std::vector<std::vector<Ends<dim>>> boxes_of_all(const Ranks& ranks, std::span<const OwnSide<dim>> masters)
{
  std::vector<Ends<dim>> own;
  for (const OwnSide<dim>& side : masters)
  {
    mesh::BoundingBox<dim> box;
    for (const FacetShape<dim>& facet : side.shapes)
    {
      box.add(facet.box.lower);
      box.add(facet.box.upper);
    }
    Ends<dim>& ends = own.emplace_back();
    std::ranges::copy(box.lower, ends.begin());
    std::ranges::copy(box.upper, ends.begin() + dim);
  }
  return ranks.send(std::vector<std::vector<Ends<dim>>>(ranks.size(), own));
}

template <int dim>
class Partners
{
 public:
  Partners(const mesh::Mesh<dim>& mesh, std::span<const problem::ContactPair<dim>> pairs)
      : mesh_(mesh), pairs_(pairs), ranks_(mesh.ranks())
  {
    std::vector<OwnSide<dim>> sides = own_sides<dim>(mesh, pairs);
    for (std::size_t k = 0; k < pairs.size(); ++k)
    {
      slave_sides_.push_back(std::move(sides[2 * k]));
      master_sides_.push_back(std::move(sides[2 * k + 1]));
    }
  }

  /// The cells of other ranks that are needed here. All ranks call it together.
  [[nodiscard]] std::vector<mesh::Ghost<dim>> find()
  {
    const std::vector<std::vector<Ends<dim>>> boxes = boxes_of_all<dim>(ranks_, master_sides_);
    std::vector<std::vector<Question<dim>>> questions(ranks_.size());
    ranks_.together([&] { ask(boxes, questions); });
    questions = ranks_.send(questions);
    std::vector<std::vector<Answer<dim>>> answers(ranks_.size());
    std::vector<std::vector<int>> needed_by(ranks_.size());
    ranks_.together([&] { answer(questions, answers, needed_by); });
    answers = ranks_.send(answers);
    needed_by = ranks_.send(needed_by);
    hear(answers, needed_by);
    return tell();
  }

 private:
  /// The questions to each rank, for own slave facets that may see its masters.
  void ask(const std::vector<std::vector<Ends<dim>>>& boxes,
           std::vector<std::vector<Question<dim>>>& questions)
  {
    for (std::size_t k = 0; k < pairs_.size(); ++k)
      for (std::size_t i = 0; i < slave_sides_[k].facets.size(); ++i)
      {
        const auto& [cell, local, tag] = slave_sides_[k].facets[i];
        const mesh::CellRecord<dim>& record = slave_sides_[k].cells[i];
        const SlaveFacet<dim> facet(slave_sides_[k].shapes[i], pairs_[k].pairing, pairs_[k].where);
        for (int r = 0; r < ranks_.size(); ++r)
        {
          const Ends<dim>& ends = boxes[r][k];
          const mesh::BoundingBox<dim> box{Point<dim>(ends.data()), Point<dim>(ends.data() + dim)};
          if (box.lower[0] <= box.upper[0] && facet.may_see(box))
            questions[r].push_back(
                {record, local, static_cast<std::int32_t>(k), static_cast<std::int32_t>(slaves_.size())});
        }
        slaves_.push_back({record, {}, ranks_around(mesh_, cell)});
      }
  }

  /// Own master facets that lie opposite, and the ranks that need their pairs.
  void answer(const std::vector<std::vector<Question<dim>>>& questions,
              std::vector<std::vector<Answer<dim>>>& answers, std::vector<std::vector<int>>& needed_by) const
  {
    std::vector<MasterFacets<dim>> masters;
    for (const OwnSide<dim>& side : master_sides_) masters.emplace_back(side.shapes);
    for (int r = 0; r < ranks_.size(); ++r)
      for (const auto& [cell, local, pair, slave] : questions[r])
      {
        const FacetShape<dim> shape = shape_of(cell, local, 0);
        SlaveFacet<dim> facet(shape, pairs_[pair].pairing, pairs_[pair].where);
        masters[pair].add_to(facet);
        for (const Candidate<dim>& found : facet.candidates())
        {
          const OwnSide<dim>& side = master_sides_[pair];
          const std::vector<int> who = ranks_around(mesh_, side.facets[found.master].cell);
          answers[r].push_back({side.cells[found.master], slave, static_cast<std::int32_t>(who.size())});
          needed_by[r].insert(needed_by[r].end(), who.begin(), who.end());
        }
      }
  }

  void hear(const std::vector<std::vector<Answer<dim>>>& answers,
            const std::vector<std::vector<int>>& needed_by)
  {
    for (int r = 0; r < ranks_.size(); ++r)
      for (auto who = needed_by[r].begin(); const Answer<dim>& found : answers[r])
      {
        Slave<dim>& slave = slaves_[found.slave];
        slave.opposite.push_back({found.cell, r});
        slave.needed_by.insert(slave.needed_by.end(), who, who + found.n_ranks);
        who += found.n_ranks;
      }
  }

  /// Sends slaves and the cells opposite to all ranks that need them.
  [[nodiscard]] std::vector<mesh::Ghost<dim>> tell()
  {
    const auto name = [](const mesh::Ghost<dim>& ghost) -> const auto&
    {
      return ghost.cell.name;
    };
    std::vector<std::vector<mesh::Ghost<dim>>> parcels(ranks_.size());
    for (Slave<dim>& slave : slaves_)
    {
      sort_and_unite(slave.needed_by);
      if (slave.opposite.empty()) continue;
      for (const int r : slave.needed_by)
      {
        parcels[r].push_back({slave.cell, ranks_.rank()});
        parcels[r].insert(parcels[r].end(), slave.opposite.begin(), slave.opposite.end());
      }
    }
    for (std::vector<mesh::Ghost<dim>>& parcel : parcels) sort_and_unite(parcel, name);
    std::vector<mesh::Ghost<dim>> result;
    for (const std::vector<mesh::Ghost<dim>>& parcel : ranks_.send(parcels))
      result.insert(result.end(), parcel.begin(), parcel.end());
    return result;
  }

  const mesh::Mesh<dim>& mesh_;
  std::span<const problem::ContactPair<dim>> pairs_;
  Ranks ranks_;
  std::vector<OwnSide<dim>> slave_sides_;  ///< of each pair
  std::vector<OwnSide<dim>> master_sides_;
  std::vector<Slave<dim>> slaves_;  ///< of all pairs
};

}  // namespace

template <int dim>
mesh::Mesh<dim> with_partners(mesh::Mesh<dim> mesh, std::span<const problem::ContactPair<dim>> pairs)
{
  const Ranks ranks = mesh.ranks();
  if (ranks.size() == 1 || pairs.empty()) return mesh;
  std::vector<mesh::Ghost<dim>> ghosts = Partners<dim>(mesh, pairs).find();
  mesh::Mesh<dim> result =
      ranks.together([&] { return mesh::with_more_ghosts<dim>(std::move(mesh), std::move(ghosts)); });
  result.set_has_partners();
  return result;
}

template mesh::Mesh<2> with_partners(mesh::Mesh<2>, std::span<const problem::ContactPair<2>>);
template mesh::Mesh<3> with_partners(mesh::Mesh<3>, std::span<const problem::ContactPair<3>>);

}  // namespace tribound::contact
