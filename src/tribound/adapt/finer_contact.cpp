#include "tribound/adapt/finer_contact.h"

#include <cmath>
#include <numeric>
#include <utility>

#include "tribound/certify/energy/admissible_displacement.h"
#include "tribound/certify/energy/energy_bound.h"
#include "tribound/fem/nested.h"
#include "tribound/mesh/bisect.h"
#include "tribound/mesh/share_out.h"

namespace tribound::adapt
{

namespace
{

/// A grid with the function that it is made for.
template <int dim>
struct Carried
{
  std::unique_ptr<const Grid<dim>> grid;
  std::vector<double> u;
  std::vector<Index> parent;
};

template <int dim>
Carried<dim> bisected(const contact::NitscheForm<dim>& form, std::span<const double> u,
                      std::span<const Index> marked)
{
  constexpr int times = dim == 2 ? 6 : 3;
  const fem::LagrangeSpace<dim>& space = form.space();
  const std::vector<mesh::TwinFacets<dim>> twins = contact::twin_facets<dim>(space.mesh(), form.segments());
  Carried<dim> result;
  if (!space.mesh().partition())
  {
    mesh::Bisected<dim> finer = mesh::bisect<dim>(space.mesh(), marked, times, twins);
    result.grid = std::make_unique<const Grid<dim>>(std::move(finer.mesh), space.degree());
    result.u = fem::nested_interpolant<dim>(space, u, finer.parent, result.grid->space);
    result.parent = std::move(finer.parent);
    return result;
  }
  mesh::BisectedPart<dim> finer = mesh::bisect_part<dim>(space.mesh(), marked, times, twins);
  const std::vector<double> values = fem::nested_values<dim>(space, u, finer.cells, finer.parent);
  result.grid = std::make_unique<const Grid<dim>>(
      contact::with_partners<dim>(mesh::in_place<dim>(space.mesh(), std::move(finer.cells)),
                                  form.problem().pairs()),
      space.degree());
  std::vector<Index> cells(finer.parent.size());
  std::iota(cells.begin(), cells.end(), 0);
  result.u = fem::from_cell_values<dim>(result.grid->space, cells, values);
  result.parent = std::move(finer.parent);
  return result;
}

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
void inherit_gamma(const contact::NitscheForm<dim>& from, const Carried<dim>& to,
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
  if (fine.partition()) mesh::cell_update<dim> (*fine.partition())(std::span(gamma), n);
  for (contact::ContactSegment<dim>& segment : segments)
    segment.gamma = gamma[static_cast<std::size_t>(n) * segment.slave.facet.cell + segment.slave.facet.local];
}

}  // namespace

template <int dim>
std::unique_ptr<FinerContact<dim>> finer_contact(const contact::NitscheForm<dim>& form,
                                                 std::span<const double> u)
{
  if (!certify::why_no_energy_bound(form).empty()) return nullptr;
  std::vector<Index> marked;
  for (const std::size_t k : certify::facets_in_transition<dim>(form, form.traction(u)))
    if (k < form.n_owned_segments()) marked.push_back(form.segments()[k].slave.facet.cell);
  if (!form.space().mesh().ranks().any(!marked.empty())) return nullptr;
  Carried<dim> carried = bisected<dim>(form, u, marked);
  std::vector<contact::ContactSegment<dim>> segments =
      contact::contact_segments<dim>(form.problem(), carried.grid->mesh, form.gamma0());
  inherit_gamma<dim>(form, carried, segments);
  auto result = std::make_unique<FinerContact<dim>>();
  result->grid = std::move(carried.grid);
  result->form = std::make_unique<const contact::NitscheForm<dim>>(form.problem(), result->grid->space,
                                                                   form.gamma0(), std::move(segments));
  result->u = std::move(carried.u);
  result->parent = std::move(carried.parent);
  return result;
}

template std::unique_ptr<FinerContact<2>> finer_contact(const contact::NitscheForm<2>&,
                                                        std::span<const double>);
template std::unique_ptr<FinerContact<3>> finer_contact(const contact::NitscheForm<3>&,
                                                        std::span<const double>);

}  // namespace tribound::adapt
