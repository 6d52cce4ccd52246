#include "tribound/adapt/excerpt.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "tribound/fem/nested.h"
#include "tribound/mesh/share_out.h"

namespace tribound::adapt
{

namespace
{

/// sigma_h of cells, one behind the other.
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

/// What all ranks have, one behind the other, on the first.
template <class T>
std::vector<T> gathered(const Ranks& ranks, std::span<const T> items)
{
  std::vector<T> all;
  for (const std::vector<T>& of_rank : ranks.gather(items))
    all.insert(all.end(), of_rank.begin(), of_rank.end());
  return all;
}

/// Blocks of `size` numbers, that of cell number[k] in place number[k].
std::vector<double> in_order(std::span<const double> blocks, std::size_t size, std::span<const Index> number)
{
  std::vector<double> result(blocks.size());
  for (std::size_t k = 0; k < number.size(); ++k)
    std::ranges::copy(blocks.subspan(k * size, size),
                      result.begin() + static_cast<std::ptrdiff_t>(size) * number[k]);
  return result;
}

}  // namespace

template <int dim>
std::optional<Excerpt<dim>> excerpt(const LevelView<dim>& view, const Method& method,
                                    std::span<const Index> cells)
{
  const Discretisation<dim>& discrete = view.discrete;
  const Ranks& ranks = discrete.mesh.ranks();
  const bool has_bound = !view.level.stress.dis.empty() || view.level.estimate.total_sharp > 0;
  std::vector<certify::BoundComponents> components;
  for (const Index c : cells)
    if (!view.level.estimate.cells.empty()) components.push_back(view.level.estimate.cells[c]);
  const auto records = gathered<mesh::CellRecord<dim>>(ranks, mesh::records_of(discrete.mesh, cells));
  const auto u = gathered<double>(ranks, fem::cell_values<dim>(discrete.space, view.level.u, cells));
  const auto stress =
      gathered<double>(ranks, has_bound ? stress_of(view.level.stress, cells) : std::vector<double>{});
  components = gathered<certify::BoundComponents>(ranks, components);

  return ranks.together(
      [&]() -> std::optional<Excerpt<dim>>
      {
        if (!ranks.is_first()) return std::nullopt;
        mesh::PickedOut<dim> picked = mesh::pick_out<dim>(discrete.mesh, records);
        Excerpt<dim> result;
        result.discrete = std::make_shared<const Discretisation<dim>>(std::move(picked.mesh),
                                                                      discrete.form.problem(), method);
        CertifiedLevel<dim>& level = result.level;
        level.steps = view.level.steps;
        level.norms = view.level.norms;
        level.delta_updates = view.level.delta_updates;
        level.u = fem::from_cell_values<dim>(result.discrete->space, picked.number, u);
        level.estimate.Bound::operator=(view.level.estimate.bound());
        level.estimate.cells.resize(components.size());
        for (std::size_t k = 0; k < components.size(); ++k)
          level.estimate.cells[picked.number[k]] = components[k];
        level.stress.degree = view.level.stress.degree;
        level.stress.n = view.level.stress.n;
        level.stress.dis = in_order(stress, level.stress.block_size(), picked.number);
        level.stress.lin_block.assign(records.size(), -1);
        return result;
      });
}

template std::optional<Excerpt<2>> excerpt(const LevelView<2>&, const Method&, std::span<const Index>);
template std::optional<Excerpt<3>> excerpt(const LevelView<3>&, const Method&, std::span<const Index>);

}  // namespace tribound::adapt
