#include "tribound/adapt/finer_contact.h"

#include <utility>

#include "tribound/adapt/finer.h"
#include "tribound/certify/energy/admissible_displacement.h"
#include "tribound/certify/energy/energy_bound.h"
#include "tribound/fem/nested.h"

namespace tribound::adapt
{

namespace
{

/// The local facet of a cell that contains a facet inside it; -1: none.
template <int dim>
int facet_around(const mesh::CellMap<dim>& cell, const Point<dim>& centre)
{
  constexpr double close = 1e-6;
  const Point<dim> x = fem::reference_point(cell, centre);
  if (1 - x.sum() <= close) return 0;
  for (int i = 0; i < dim; ++i)
    if (x[i] <= close) return i + 1;
  return -1;
}

/// gamma of the slave of each segment, from the facet that it lies on.
template <int dim>
void inherit_gamma(const contact::NitscheForm<dim>& from, const FinerContact<dim>& to,
                   std::span<contact::ContactSegment<dim>> segments)
{
  constexpr int n = dim + 1;
  const mesh::Mesh<dim>& coarse = from.space().mesh();
  const mesh::Mesh<dim>& fine = to.grid->mesh;
  std::vector<double> before(static_cast<std::size_t>(n) * coarse.n_owned_cells(), 0.0);
  for (std::size_t k = 0; k < from.n_owned_segments(); ++k)
  {
    const auto& [cell, local, tag] = from.segments()[k].slave.facet;
    before[static_cast<std::size_t>(n) * cell + local] = from.segments()[k].gamma;
  }
  std::vector<double> gamma(static_cast<std::size_t>(n) * fine.n_cells(), 0.0);
  for (const contact::ContactSegment<dim>& segment : segments)
  {
    const auto& [cell, local, tag] = segment.slave.facet;
    if (cell >= fine.n_owned_cells()) continue;
    Point<dim> centre = Point<dim>::Zero();
    for (const Index v : mesh::facet_vertices(fine.cell(cell), local)) centre += fine.vertex(v) / dim;
    const Index parent = to.parent[cell];
    const int around = facet_around<dim>(mesh::cell_map(coarse, parent), centre);
    gamma[static_cast<std::size_t>(n) * cell + local] = before[static_cast<std::size_t>(n) * parent + around];
  }
  if (fine.partition())
  {
    const GhostUpdate from_owners = mesh::cell_update<dim>(*fine.partition());
    from_owners(std::span(gamma), n);
  }
  for (contact::ContactSegment<dim>& segment : segments)
    segment.gamma = gamma[static_cast<std::size_t>(n) * segment.slave.facet.cell + segment.slave.facet.local];
}

}  // namespace

template <int dim>
std::unique_ptr<FinerContact<dim>> finer_contact(const contact::NitscheForm<dim>& form,
                                                 std::span<const double> u)
{
  constexpr int times = dim == 2 ? 6 : 3;
  if (!certify::why_no_energy_bound(form).empty()) return nullptr;
  const fem::LagrangeSpace<dim>& space = form.space();
  std::vector<Index> marked;
  for (const std::size_t k : certify::facets_in_transition<dim>(form, form.traction(u)))
    if (k < form.n_owned_segments()) marked.push_back(form.segments()[k].slave.facet.cell);
  if (!space.mesh().ranks().any(!marked.empty())) return nullptr;
  const Finer<dim> finer = finer_mesh<dim>(space, {u}, marked,
                                           {.twins = contact::twin_facets<dim>(space.mesh(), form.segments()),
                                            .times = times,
                                            .move = mesh::Move::never});
  auto result = std::make_unique<FinerContact<dim>>();
  result->grid = std::make_unique<const Grid<dim>>(
      contact::with_partners<dim>(finer.mesh(), form.problem().pairs()), space.degree());
  result->u = std::move(finer.carry(result->grid->space).front());
  result->parent.assign(finer.parent.begin(), finer.parent.end());
  std::vector<contact::ContactSegment<dim>> segments =
      contact::contact_segments<dim>(form.problem(), result->grid->mesh, form.gamma0());
  inherit_gamma<dim>(form, *result, segments);
  result->form = std::make_unique<const contact::NitscheForm<dim>>(form.problem(), result->grid->space,
                                                                   form.gamma0(), std::move(segments));
  return result;
}

template std::unique_ptr<FinerContact<2>> finer_contact(const contact::NitscheForm<2>&,
                                                        std::span<const double>);
template std::unique_ptr<FinerContact<3>> finer_contact(const contact::NitscheForm<3>&,
                                                        std::span<const double>);

}  // namespace tribound::adapt
