#include "tribound/adapt/finer.h"

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

template <int dim>
Finer<dim> bisected(const fem::LagrangeSpace<dim>& from, std::span<const double> u,
                    std::span<const Index> marked)
{
  auto finer = std::make_shared<mesh::Bisected<dim>>(mesh::bisect<dim>(from.mesh(), marked));
  return {finer->mesh.n_cells(), [finer] { return std::move(finer->mesh); },
          [finer, &from, u](const fem::LagrangeSpace<dim>& space)
          { return fem::nested_interpolant<dim>(from, u, finer->parent, space); }};
}

/// The same of a mesh that is shared out: its cells take the values at their nodes with them.
template <int dim>
Finer<dim> bisected_part(const fem::LagrangeSpace<dim>& from, std::span<const double> u,
                         std::span<const Index> marked)
{
  auto part = std::make_shared<mesh::BisectedPart<dim>>(mesh::bisect_part<dim>(from.mesh(), marked));
  const std::int64_t n_cells = from.mesh().ranks().sum(static_cast<std::int64_t>(part->cells.size()));
  auto balanced = std::make_shared<std::optional<mesh::Balanced<dim>>>();
  return {n_cells,
          [=, &from]
          {
            const std::vector<double> values = fem::nested_values<dim>(from, u, part->cells, part->parent);
            *balanced =
                mesh::balance<dim>(from.mesh(), std::move(part->cells), values, dim * from.basis().n_nodes());
            return std::move((*balanced)->mesh);
          },
          [balanced](const fem::LagrangeSpace<dim>& space)
          { return fem::from_cell_values<dim>(space, (*balanced)->cells, (*balanced)->values); }};
}

}  // namespace

template <int dim>
Finer<dim> finer_mesh(const fem::LagrangeSpace<dim>& space, std::span<const double> u,
                      std::span<const Index> marked)
{
  return space.mesh().partition() ? bisected_part<dim>(space, u, marked) : bisected<dim>(space, u, marked);
}

template Finer<2> finer_mesh(const fem::LagrangeSpace<2>&, std::span<const double>, std::span<const Index>);
template Finer<3> finer_mesh(const fem::LagrangeSpace<3>&, std::span<const double>, std::span<const Index>);

}  // namespace tribound::adapt
