#include "tribound/mesh/share_out.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <numeric>
#include <utility>

#include "tribound/base/sorted.h"
#include "tribound/mesh/box.h"
#include "tribound/mesh/first_facets.h"
#include "tribound/mesh/quadratic_facets.h"
#include "tribound/mesh/shared_labels.h"

namespace tribound::mesh
{

namespace
{

/// The new rank of each cell.
template <int dim>
std::vector<int> destinations(const Ranks& ranks, const Cube<dim>& cube,
                              std::span<const CellRecord<dim>> cells, Move move)
{
  constexpr double much = 1.05;  // of the mean: what goes on a rank for itself is too short to gain more
  const auto n = static_cast<double>(cells.size());
  if (move == Move::never) return std::vector<int>(cells.size(), ranks.rank());
  if (move == Move::where_unbalanced && ranks.max(n) * ranks.size() <= much * ranks.sum(n))
    return std::vector<int>(cells.size(), ranks.rank());
  return balanced_ranks(ranks, centre_keys<dim>(cube, cells), std::vector<std::int64_t>(cells.size(), 1));
}

/// The positions of names in an ascending list of them.
std::vector<Index> numbers_in(std::span<const CellName> all, std::span<const CellName> names)
{
  std::vector<Index> numbers;
  numbers.reserve(names.size());
  for (const CellName& name : names)
    numbers.push_back(static_cast<Index>(std::ranges::lower_bound(all, name) - all.begin()));
  return numbers;
}

template <int dim>
std::vector<CellName> names_of(std::span<const CellRecord<dim>> cells)
{
  std::vector<CellName> names;
  names.reserve(cells.size());
  for (const CellRecord<dim>& cell : cells) names.push_back(cell.name);
  return names;
}

template <int dim>
Mesh<dim> make_part(const Ranks& ranks, const Cube<dim>& cube, std::vector<CellRecord<dim>> cells,
                    MeshLabels labels)
{
  MeshPart<dim> part = with_ghosts<dim>(ranks, cube, std::move(cells));
  return ranks.together([&] { return Mesh<dim>(std::move(part), std::move(labels)); });
}

/// What all ranks know of the first mesh.
template <int dim>
struct Origin
{
  Cube<dim> cube;
  MeshLabels labels;
};

template <int dim>
Origin<dim> origin_of(const Ranks& ranks, const Mesh<dim>* first)
{
  Origin<dim> origin;
  if (first) origin.labels = first->labels();
  copy_labels(ranks, origin.labels);
  const std::array<double, dim + 1> ends = ranks.on_first(
      [&]
      {
        const Cube<dim> around = cube_around<dim>(first->vertices());
        std::array<double, dim + 1> numbers{};
        std::ranges::copy(around.lower, numbers.begin());
        numbers[dim] = around.size;
        return numbers;
      });
  origin.cube = {Point<dim>(ends.data()), ends[dim]};
  return origin;
}

template <int dim>
Balanced<dim> balance_cells(const Ranks& ranks, Origin<dim> origin, std::vector<CellRecord<dim>> cells,
                            std::span<const double> values, int n_values, Move move)
{
  assert(values.size() == cells.size() * n_values);
  const std::vector<int> rank_of = destinations<dim>(ranks, origin.cube, cells, move);
  std::vector<double> arrived = ranks.send_to<double>(rank_of, values, n_values);
  cells = ranks.send_to<CellRecord<dim>>(rank_of, cells);
  const std::vector<CellName> names = names_of<dim>(cells);
  Balanced<dim> result{
      make_part<dim>(ranks, origin.cube, std::move(cells), std::move(origin.labels)), {}, std::move(arrived)};
  const auto own = std::span(result.mesh.partition()->names).first(result.mesh.n_owned_cells());
  result.cells = numbers_in(own, names);
  return result;
}

/// The cells of a part without ghosts as a whole mesh, in their order.
template <int dim>
Mesh<dim> whole_mesh(const MeshPart<dim>& part, const MeshLabels& labels)
{
  MeshData<dim> data{labels};
  for (const VertexName<dim>& vertex : part.partition.vertices) data.vertices.push_back(vertex.point());
  data.cells = part.corners;
  for (std::size_t c = 0; c < part.cells.size(); ++c)
  {
    data.regions.push_back(part.cells[c].region);
    data.bisection_types.push_back(static_cast<std::uint8_t>(part.cells[c].bisection_type));
    for (int i = 0; i <= dim; ++i)
      if (part.cells[c].tags[i] >= 0)
        data.facets.push_back({facet_vertices(part.corners[c], i), part.cells[c].tags[i]});
  }
  return Mesh<dim>(std::move(data));
}

/// work(first, last) for the cells number first, ..., last - 1, one batch after the other.
template <class Work>
void in_batches(Index n_cells, Index batch, const Work& work)
{
  for (Index first = 0; first < n_cells; first += batch) work(first, std::min(n_cells, first + batch));
}

/// The cells of one or several boxes that a rank makes.
template <int dim, class Source>
std::vector<CellRecord<dim>> share_of_boxes(const Ranks& ranks, const Source& source)
{
  const std::int64_t n = n_box_cells(source);
  return box_records<dim>(source, n * ranks.rank() / ranks.size(), n * (ranks.rank() + 1) / ranks.size());
}

template <int dim>
std::shared_ptr<const QuadraticFacets> facets_of_cells(const Ranks& ranks,
                                                       std::span<const CellRecord<dim>> cells)
{
  return std::make_shared<const QuadraticFacets>(QuadraticFacets{.first = first_facets<dim>(ranks, cells)});
}

/// `source`: one or several boxes, listed in `all`.
template <int dim, class Source>
Mesh<dim> share_out_boxes(const Ranks& ranks, const Source& source, std::span<const BoxMesh> all)
{
  MeshLabels labels = box_labels<dim>(source);
  std::vector<Point<dim>> corners;
  for (const BoxMesh& box : all)
    for (const std::vector<double>& corner : {box.lower, box.upper}) corners.emplace_back(corner.data());
  const Cube<dim> cube = cube_around<dim>(corners);
  std::vector<CellRecord<dim>> cells = share_of_boxes<dim>(ranks, source);
  labels.quadratic_facets = facets_of_cells<dim>(ranks, cells);
  // They come in stretches of the last axis; sorted along the curve they have few neighbours.
  const std::vector<int> rank_of = destinations<dim>(ranks, cube, cells, Move::always);
  cells = ranks.send_to<CellRecord<dim>>(rank_of, cells);
  return make_part<dim>(ranks, cube, std::move(cells), std::move(labels));
}

}  // namespace

template <int dim>
Mesh<dim> share_out(const Ranks& ranks, const Mesh<dim>* whole, Index batch)
{
  assert(ranks.is_first() == (whole != nullptr));
  Origin<dim> origin = origin_of(ranks, whole);
  const Index n_cells = ranks.on_first([&] { return whole->n_cells(); });
  std::vector<std::uint64_t> keys;
  if (whole)
    in_batches(n_cells, batch,
               [&](Index first, Index last)
               {
                 const std::vector<std::uint64_t> of_batch =
                     centre_keys<dim>(origin.cube, first_records(*whole, first, last));
                 keys.insert(keys.end(), of_batch.begin(), of_batch.end());
               });
  const std::vector<int> rank_of = balanced_ranks(ranks, keys, std::vector<std::int64_t>(keys.size(), 1));
  std::vector<CellRecord<dim>> own;
  in_batches(n_cells, batch,
             [&](Index first, Index last)
             {
               std::vector<CellRecord<dim>> cells;
               if (whole) cells = first_records(*whole, first, last);
               const auto to = std::span(rank_of).subspan(whole ? first : 0, cells.size());
               cells = ranks.send_to<CellRecord<dim>>(to, cells);
               own.insert(own.end(), cells.begin(), cells.end());
             });
  return make_part<dim>(ranks, origin.cube, std::move(own), std::move(origin.labels));
}

template <int dim>
Mesh<dim> share_out(const Ranks& ranks, const BoxMesh& box)
{
  return share_out_boxes<dim>(ranks, box, std::span(&box, 1));
}

template <int dim>
Mesh<dim> share_out(const Ranks& ranks, const Boxes& boxes)
{
  std::vector<BoxMesh> all;
  for (const NamedBox& named : boxes) all.push_back(named.box);
  return share_out_boxes<dim>(ranks, boxes, all);
}

template <int dim>
Balanced<dim> balance(const Mesh<dim>& before, std::vector<CellRecord<dim>> cells,
                      std::span<const double> values, int n_values, Move move)
{
  const Partition<dim>& partition = *before.partition();
  return balance_cells<dim>(partition.ranks, {partition.cube, before.labels()}, std::move(cells), values,
                            n_values, move);
}

template <int dim>
std::shared_ptr<const QuadraticFacets> box_facets(const Ranks& ranks, const MeshSource& source)
{
  const auto facets = [&ranks](const auto& boxes)
  { return facets_of_cells<dim>(ranks, share_of_boxes<dim>(ranks, boxes)); };
  if (const auto* box = std::get_if<BoxMesh>(&source)) return facets(*box);
  const auto* boxes = std::get_if<Boxes>(&source);
  return boxes ? facets(*boxes) : nullptr;
}

template <int dim>
Balanced<dim> restore(const Ranks& ranks, const Mesh<dim>* first, std::vector<CellRecord<dim>> cells,
                      std::span<const double> values, int n_values,
                      const std::shared_ptr<const QuadraticFacets>& facets)
{
  Origin<dim> origin = origin_of(ranks, first);
  if (facets) origin.labels.quadratic_facets = facets;
  if (ranks.size() > 1)
    return balance_cells<dim>(ranks, std::move(origin), std::move(cells), values, n_values, Move::always);
  const std::vector<CellName> names = names_of<dim>(cells);
  const MeshPart<dim> part = with_ghosts<dim>(ranks, origin.cube, std::move(cells));
  std::vector<Index> numbers = numbers_in(part.partition.names, names);
  return {whole_mesh<dim>(part, origin.labels), std::move(numbers), {values.begin(), values.end()}};
}

template <int dim>
std::vector<CellRecord<dim>> records_of(const Mesh<dim>& mesh, std::span<const Index> cells)
{
  const Partition<dim>& partition = *mesh.partition();
  const std::vector<CellTags<dim>> tags = cell_tags<dim>(mesh.n_cells(), mesh.boundary());
  std::vector<CellRecord<dim>> records;
  records.reserve(cells.size());
  for (const Index c : cells)
  {
    CellRecord<dim>& record = records.emplace_back();
    record.name = partition.names[c];
    for (int i = 0; i <= dim; ++i) record.vertices[i] = partition.vertices[mesh.cell(c)[i]];
    record.tags = tags[c];
    record.region = mesh.region(c);
    record.bisection_type = mesh.bisection_types()[c];
  }
  return records;
}

template <int dim>
Mesh<dim> with_more_ghosts(Mesh<dim> mesh, std::vector<Ghost<dim>> more)
{
  const Partition<dim>& partition = *mesh.partition();
  const auto own = std::span(partition.names).first(partition.n_owned_cells);
  const auto ghosts = std::span(partition.names).subspan(partition.n_owned_cells);
  const auto name = [](const Ghost<dim>& ghost) -> const auto&
  {
    return ghost.cell.name;
  };
  std::erase_if(more,
                [&](const Ghost<dim>& ghost) {
                  return std::ranges::binary_search(own, name(ghost)) ||
                         std::ranges::binary_search(ghosts, name(ghost));
                });
  if (more.empty()) return mesh;
  sort_and_unite(more, name);
  std::vector<Index> all(mesh.n_cells());
  std::iota(all.begin(), all.end(), 0);
  std::vector<CellRecord<dim>> cells = records_of<dim>(mesh, all);
  for (std::size_t g = 0; g < ghosts.size(); ++g)
    more.push_back({cells[partition.n_owned_cells + g], partition.ghost_owners[g]});
  cells.resize(partition.n_owned_cells);
  return {with_these_ghosts<dim>(partition, std::move(cells), std::move(more)), mesh.labels()};
}

template <int dim>
PickedOut<dim> pick_out(const Mesh<dim>& from, std::span<const CellRecord<dim>> cells,
                        std::span<const int> bodies)
{
  MeshPart<dim> part = with_ghosts<dim>(Ranks(), from.partition()->cube, {cells.begin(), cells.end()});
  part.partition.n_cells = from.n_global_cells();
  part.partition.n_vertices = from.n_global_vertices();
  std::ranges::fill(part.partition.has_patch, 0);
  std::vector<Index> number = numbers_in(part.partition.names, names_of<dim>(cells));
  part.partition.bodies.resize(cells.size());
  for (std::size_t k = 0; k < cells.size(); ++k) part.partition.bodies[number[k]] = bodies[k];
  Mesh<dim> mesh(std::move(part), from.labels());
  return {std::move(mesh), std::move(number)};
}

template Mesh<2> share_out(const Ranks&, const Mesh<2>*, Index);
template Mesh<3> share_out(const Ranks&, const Mesh<3>*, Index);
template std::shared_ptr<const QuadraticFacets> box_facets<2>(const Ranks&, const MeshSource&);
template Balanced<2> restore(const Ranks&, const Mesh<2>*, std::vector<CellRecord<2>>,
                             std::span<const double>, int, const std::shared_ptr<const QuadraticFacets>&);
template std::vector<CellRecord<2>> records_of(const Mesh<2>&, std::span<const Index>);
template Mesh<2> with_more_ghosts(Mesh<2>, std::vector<Ghost<2>>);
template PickedOut<2> pick_out(const Mesh<2>&, std::span<const CellRecord<2>>, std::span<const int>);
template Mesh<2> share_out(const Ranks&, const BoxMesh&);
template Mesh<2> share_out(const Ranks&, const Boxes&);
template Balanced<2> balance(const Mesh<2>&, std::vector<CellRecord<2>>, std::span<const double>, int, Move);
template std::shared_ptr<const QuadraticFacets> box_facets<3>(const Ranks&, const MeshSource&);
template Balanced<3> restore(const Ranks&, const Mesh<3>*, std::vector<CellRecord<3>>,
                             std::span<const double>, int, const std::shared_ptr<const QuadraticFacets>&);
template std::vector<CellRecord<3>> records_of(const Mesh<3>&, std::span<const Index>);
template Mesh<3> with_more_ghosts(Mesh<3>, std::vector<Ghost<3>>);
template PickedOut<3> pick_out(const Mesh<3>&, std::span<const CellRecord<3>>, std::span<const int>);
template Mesh<3> share_out(const Ranks&, const BoxMesh&);
template Mesh<3> share_out(const Ranks&, const Boxes&);
template Balanced<3> balance(const Mesh<3>&, std::vector<CellRecord<3>>, std::span<const double>, int, Move);

}  // namespace tribound::mesh
