#include "tribound/adapt/finer.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <utility>

#include "tribound/fem/nested.h"
#include "tribound/mesh/bisect.h"
#include "tribound/mesh/share_out.h"

namespace tribound::adapt
{

namespace
{

using Functions = std::vector<std::span<const double>>;

template <int dim>
mesh::Bisected<dim> pieces(const mesh::Mesh<dim>& mesh, std::span<const Index> marked,
                           const Refinement<dim>& refinement)
{
  if constexpr (dim == 2)
    if (refinement.cuts) return mesh::cut_facets(mesh, *refinement.cuts);
  return mesh::bisect<dim>(mesh, marked, refinement.times, refinement.twins);
}

template <int dim>
mesh::BisectedPart<dim> pieces_of_part(const mesh::Mesh<dim>& mesh, std::span<const Index> marked,
                                       const Refinement<dim>& refinement)
{
  if constexpr (dim == 2)
    if (refinement.cuts) return mesh::cut_facets_part(mesh, *refinement.cuts);
  return mesh::bisect_part<dim>(mesh, marked, refinement.times, refinement.twins);
}

template <int dim>
Finer<dim> bisected(const fem::LagrangeSpace<dim>& from, const Functions& functions,
                    std::span<const Index> marked, const Refinement<dim>& refinement)
{
  auto finer = std::make_shared<mesh::Bisected<dim>>(pieces<dim>(from.mesh(), marked, refinement));
  return {finer->mesh.n_cells(), [finer] { return std::move(finer->mesh); },
          [finer, &from, functions](const fem::LagrangeSpace<dim>& space)
          {
            std::vector<std::vector<double>> carried;
            for (const std::span<const double> u : functions)
              carried.push_back(fem::nested_interpolant<dim>(from, u, finer->parent, space));
            return carried;
          },
          finer->parent};
}

/// The same for a distributed mesh: cells take the values at their nodes with them.
template <int dim>
Finer<dim> bisected_part(const fem::LagrangeSpace<dim>& from, const Functions& functions,
                         std::span<const Index> marked, const Refinement<dim>& refinement)
{
  auto part = std::make_shared<mesh::BisectedPart<dim>>(pieces_of_part<dim>(from.mesh(), marked, refinement));
  const std::int64_t n_cells = from.mesh().ranks().sum(static_cast<std::int64_t>(part->cells.size()));
  auto balanced = std::make_shared<std::optional<mesh::Balanced<dim>>>();
  const std::size_t n_each = static_cast<std::size_t>(dim) * from.basis().n_nodes();
  const std::size_t n_functions = functions.size();
  const mesh::Move move = refinement.move;
  return {n_cells,
          [=, &from]
          {
            std::vector<std::vector<double>> rows;
            for (const std::span<const double> u : functions)
              rows.push_back(fem::nested_values<dim>(from, u, part->cells, part->parent));
            std::vector<fem::CellColumn> columns;
            columns.reserve(rows.size());
            for (const std::vector<double>& row : rows) columns.push_back({row, n_each});
            const std::vector<double> values = fem::beside_each_other(columns, part->cells.size());
            *balanced = mesh::balance<dim>(from.mesh(), std::move(part->cells), values,
                                           static_cast<int>(n_functions * n_each), move);
            return std::move((*balanced)->mesh);
          },
          [=](const fem::LagrangeSpace<dim>& space)
          {
            std::vector<std::vector<double>> carried;
            for (std::size_t k = 0; k < n_functions; ++k)
              carried.push_back(fem::from_cell_values<dim>(
                  space, (*balanced)->cells,
                  fem::cell_column((*balanced)->values, n_functions * n_each, k * n_each, n_each)));
            return carried;
          },
          part->parent};
}

}  // namespace

template <int dim>
Finer<dim> finer_mesh(const fem::LagrangeSpace<dim>& space, std::vector<std::span<const double>> functions,
                      std::span<const Index> marked, const Refinement<dim>& refinement)
{
  return space.mesh().partition() ? bisected_part<dim>(space, functions, marked, refinement)
                                  : bisected<dim>(space, functions, marked, refinement);
}

template Finer<2> finer_mesh(const fem::LagrangeSpace<2>&, std::vector<std::span<const double>>,
                             std::span<const Index>, const Refinement<2>&);
template Finer<3> finer_mesh(const fem::LagrangeSpace<3>&, std::vector<std::span<const double>>,
                             std::span<const Index>, const Refinement<3>&);

}  // namespace tribound::adapt
