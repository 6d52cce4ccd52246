#include "tribound/adapt/excerpt.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "tribound/adapt/gathered_history.h"
#include "tribound/adapt/merged_cells.h"
#include "tribound/base/sorted.h"
#include "tribound/fem/nested.h"
#include "tribound/mesh/bodies.h"
#include "tribound/mesh/share_out.h"

namespace tribound::adapt
{

namespace
{

/// sigma_h of cells, concatenated.
template <int dim>
std::vector<double> stress_of(const certify::Stress<dim>& stress, std::span<const Index> cells)
{
  std::vector<double> values;
  values.reserve(cells.size() * stress.block_size());
  for (const Index c : cells)
  {
    const auto dis = stress.dis_in(c);
    const auto begin = values.insert(values.end(), dis.begin(), dis.end());
    for (const std::span<const double> part : {stress.lin_in(c), stress.reg_in(c)})
      std::ranges::transform(part, std::span(begin, part.size()), begin, std::plus<>());
  }
  return values;
}

/// Permutes blocks of `size` numbers: block k moves to place number[k].
std::vector<double> in_order(std::span<const double> blocks, std::size_t size, std::span<const Index> number)
{
  std::vector<double> result(blocks.size());
  for (std::size_t k = 0; k < number.size(); ++k)
    std::ranges::copy(blocks.subspan(k * size, size),
                      result.begin() + static_cast<std::ptrdiff_t>(size) * number[k]);
  return result;
}

/// The bodies of cells, which may have been merged, found by their ancestors in the first mesh. All ranks
/// call it together.
template <int dim>
std::vector<int> bodies_of(const mesh::Mesh<dim>& mesh, std::span<const mesh::CellRecord<dim>> cells)
{
  const mesh::Bodies bodies = mesh::number_bodies(mesh);
  std::vector<std::pair<std::int64_t, int>> of_root;  // own cells are ordered by their roots
  for (Index c = 0; c < mesh.n_owned_cells(); ++c)
    if (const std::int64_t root = mesh.partition()->names[c].root;
        of_root.empty() || of_root.back().first != root)
      of_root.emplace_back(root, bodies.of_cell[c]);
  std::vector<int> result;
  result.reserve(cells.size());
  for (const mesh::CellRecord<dim>& cell : cells)
    result.push_back(
        std::ranges::lower_bound(of_root, cell.name.root, {}, &std::pair<std::int64_t, int>::first)->second);
  return result;
}

template <int dim>
FieldCells<dim> field_cells(const LevelView<dim>& view, std::span<const Index> cells)
{
  FieldCells<dim> fields;
  fields.cells = mesh::records_of(view.discrete.mesh, cells);
  fields.u = fem::cell_values<dim>(view.discrete.space, view.level.u, cells);
  if (!view.level.stress.dis.empty()) fields.stress = stress_of(view.level.stress, cells);
  if (!view.level.estimate.cells.empty())
    for (const Index c : cells) fields.components.push_back(view.level.estimate.cells[c]);
  return fields;
}

/// The excerpts of all ranks, on the first rank.
template <int dim>
std::optional<Excerpt<dim>> gathered(const LevelView<dim>& view, const Method& method, FieldCells<dim> fields)
{
  const Discretisation<dim>& discrete = view.discrete;
  const Ranks& ranks = discrete.mesh.ranks();
  const std::vector<int> bodies = ranks.gather<int>(bodies_of<dim>(discrete.mesh, fields.cells));
  fields.cells = ranks.gather<mesh::CellRecord<dim>>(fields.cells);
  fields.u = ranks.gather<double>(fields.u);
  fields.stress = ranks.gather<double>(fields.stress);
  fields.components = ranks.gather<certify::BoundComponents>(fields.components);
  const GatheredHistory<dim> history = gather_history(discrete.form);
  return ranks.together(
      [&]() -> std::optional<Excerpt<dim>>
      {
        if (!ranks.is_first()) return std::nullopt;
        mesh::PickedOut<dim> picked = mesh::pick_out<dim>(discrete.mesh, fields.cells, bodies);
        Excerpt<dim> result;
        auto merged =
            std::make_shared<Discretisation<dim>>(std::move(picked.mesh), discrete.form.problem(), method);
        if (!history.states.empty())
        {
          auto remembered = history_on(merged->form, history);
          if (!remembered) return std::nullopt;
          merged->form.set_history(std::move(remembered));
        }
        result.discrete = merged;
        CertifiedLevel<dim>& level = result.level;
        level.steps = view.level.steps;
        level.norms = view.level.norms;
        level.delta_updates = view.level.delta_updates;
        level.u = fem::from_cell_values<dim>(result.discrete->space, picked.number, fields.u);
        level.estimate.Bound::operator=(view.level.estimate.bound());
        level.estimate.cells.resize(fields.components.size());
        for (std::size_t k = 0; k < fields.components.size(); ++k)
          level.estimate.cells[picked.number[k]] = fields.components[k];
        level.stress.degree = view.level.stress.degree;
        level.stress.n = view.level.stress.n;
        level.stress.patches = view.level.stress.patches;
        level.stress.dis = in_order(fields.stress, level.stress.block_size(), picked.number);
        level.stress.lin_block.assign(fields.cells.size(), -1);
        return result;
      });
}

}  // namespace

template <int dim>
std::optional<Excerpt<dim>> excerpt(const LevelView<dim>& view, const Method& method, std::int64_t most)
{
  const mesh::Mesh<dim>& mesh = view.discrete.mesh;
  std::vector<Index> cells(mesh.n_owned_cells());
  std::iota(cells.begin(), cells.end(), 0);
  FieldCells<dim> fields = field_cells(view, cells);
  const bool is_merged = mesh.n_global_cells() > most;
  if (is_merged && !merge_cells<dim>(mesh.ranks(), view.discrete.space.basis(), most, fields))
    return boundary_excerpt<dim>(view, method);
  std::optional<Excerpt<dim>> result = gathered<dim>(view, method, std::move(fields));
  if (result) result->is_merged = is_merged;
  return result;
}

template <int dim>
std::optional<Excerpt<dim>> boundary_excerpt(const LevelView<dim>& view, const Method& method)
{
  std::vector<Index> cells;
  for (const mesh::BoundaryFacet& facet : view.discrete.mesh.owned_boundary()) cells.push_back(facet.cell);
  sort_and_unite(cells);
  return gathered<dim>(view, method, field_cells<dim>(view, cells));
}

template std::optional<Excerpt<2>> excerpt(const LevelView<2>&, const Method&, std::int64_t);
template std::optional<Excerpt<3>> excerpt(const LevelView<3>&, const Method&, std::int64_t);
template std::optional<Excerpt<2>> boundary_excerpt(const LevelView<2>&, const Method&);
template std::optional<Excerpt<3>> boundary_excerpt(const LevelView<3>&, const Method&);

}  // namespace tribound::adapt
