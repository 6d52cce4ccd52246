#include "tribound/adapt/finer_contact.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "tribound/adapt/contact_functions.h"
#include "tribound/adapt/finer.h"
#include "tribound/base/error.h"
#include "tribound/certify/energy/admissible_displacement.h"
#include "tribound/certify/energy/obstacle_facets.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/contact/nitsche/facet_cuts.h"
#include "tribound/fem/nested.h"

namespace tribound::adapt
{

namespace
{

/// The local facet of a cell that contains the centre of a smaller facet; -1: none.
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

/// The segment, among those on a facet of a slave, that contains the point.
template <int dim>
const contact::ContactSegment<dim>& around_point(
    const mesh::Mesh<dim>& mesh, std::span<const contact::ContactSegment<dim>* const> segments,
    const Point<dim>& x)
{
  const auto distance = [&](const contact::ContactSegment<dim>* segment)
  {
    const auto map = contact::simplex_map(mesh, segment->slave);
    return (map(Point<dim - 1>::Constant(1.0 / dim)) - x).norm() / segment->measure;
  };
  return **std::ranges::min_element(segments, {}, distance);
}

/// Gives each segment gamma and the weights of the sides in {sigma} of the segment that contains it.
template <int dim>
void inherit(const contact::NitscheForm<dim>& from, const FinerContact<dim>& to,
             std::span<contact::ContactSegment<dim>> segments)
{
  const mesh::Mesh<dim>& coarse = from.space().mesh();
  const mesh::Mesh<dim>& fine = to.grid->mesh;
  std::map<std::pair<Index, int>, std::vector<const contact::ContactSegment<dim>*>> before;  // by facet
  for (const contact::ContactSegment<dim>& segment : from.segments().first(from.n_owned_segments()))
    before[{segment.slave.facet.cell, segment.slave.facet.local}].push_back(&segment);
  constexpr int n_each = 3 * (dim + 1);
  std::vector<double> inherited(static_cast<std::size_t>(n_each) * fine.n_cells(), 0.0);
  const auto of_facet = [&](const mesh::BoundaryFacet& facet)
  {
    return &inherited[static_cast<std::size_t>(n_each) * facet.cell +
                      3 * static_cast<std::size_t>(facet.local)];
  };
  for (const contact::ContactSegment<dim>& segment : segments)
  {
    const mesh::BoundaryFacet& facet = segment.slave.facet;
    if (facet.cell >= fine.n_owned_cells()) continue;
    const Point<dim> centre = contact::simplex_map(fine, segment.slave)(Point<dim - 1>::Constant(1.0 / dim));
    const Index parent = to.parent[facet.cell];
    const auto found = before.find({parent, facet_around<dim>(mesh::cell_map(coarse, parent), centre)});
    const contact::ContactSegment<dim>& origin =
        found == before.end() ? segment : around_point<dim>(coarse, found->second, centre);
    double* const values = of_facet(facet);
    values[0] = origin.gamma;
    values[1] = origin.slave.stress_direction.norm();
    if (origin.master) values[2] = origin.master->stress_direction.norm();
  }
  if (fine.partition())
  {
    const GhostUpdate from_owners = mesh::cell_update<dim>(*fine.partition());
    from_owners(std::span(inherited), n_each);
  }
  for (contact::ContactSegment<dim>& segment : segments)
  {
    const double* const values = of_facet(segment.slave.facet);
    segment.gamma = values[0];
    segment.slave.stress_direction = values[1] * segment.slave.stress_direction.normalized();
    if (segment.master)
      segment.master->stress_direction = values[2] * segment.master->stress_direction.normalized();
  }
}

/// The measure of Gamma_C on slaves. All ranks together.
template <int dim>
double contact_measure(const contact::NitscheForm<dim>& form)
{
  double sum = 0;
  for (const contact::ContactSegment<dim>& segment : form.segments().first(form.n_owned_segments()))
    sum += segment.measure;
  return form.space().mesh().ranks().sum(sum);
}

/// (w, w)_C, w the slip of earlier load steps. All ranks together.
template <int dim>
double square_of_slip(const contact::NitscheForm<dim>& form)
{
  double sum = 0;
  for (std::size_t k = 0; k < form.n_owned_segments(); ++k)
    for (int q = 0; q < form.n_segment_points(); ++q)
      sum += form.contact_points(k)[q].weight *
             form.history()->uncut(k, form.facet_rule().points[q]).slip.squaredNorm();
  return form.space().mesh().ranks().sum(sum);
}

/// u and the form on a finer mesh, as the same functions; null where Gamma_C would not be the same.
template <int dim>
std::unique_ptr<FinerContact<dim>> carried(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                           const Finer<dim>& finer)
{
  auto result = std::make_unique<FinerContact<dim>>();
  result->grid = std::make_unique<const Grid<dim>>(
      contact::with_partners<dim>(finer.mesh(), form.problem().pairs()), form.space().degree());
  result->u = std::move(finer.carry(result->grid->space).front());
  result->parent.assign(finer.parent.begin(), finer.parent.end());
  const mesh::Mesh<dim>& mesh = result->grid->mesh;
  std::vector<contact::ContactSegment<dim>> segments =
      contact::contact_segments<dim>(form.problem(), mesh, form.gamma0());
  contact::erase_slivers(mesh, segments);
  inherit<dim>(form, *result, segments);
  auto finer_form = std::make_unique<contact::NitscheForm<dim>>(form.problem(), result->grid->space,
                                                                form.gamma0(), std::move(segments));
  constexpr double rounding = 1e-8;
  const double measure = contact_measure(form);
  if (!(std::abs(contact_measure(*finer_form) - measure) <= rounding * measure)) return nullptr;
  if (form.history())
  {
    finer_form->set_history(carried_history<dim>(*form.history(), form, *finer_form));
    const double slip = square_of_slip(form);
    if (!(std::abs(square_of_slip(*finer_form) - slip) <= rounding * slip)) return nullptr;
  }
  result->form = std::move(finer_form);
  require_carried<dim>(form, u, *result);
  return result;
}

/// The effect of rounding of u and of coordinates on the energy in a cell, as its square root.
template <int dim>
double rounding_on(const contact::NitscheForm<dim>& form, Index cell, double largest_u)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const problem::Material& material = form.problem().material(mesh.region(cell));
  const mesh::CellMap<dim> map = mesh::cell_map(mesh, cell);
  double farthest = 0;
  for (const Index v : mesh.cell(cell)) farthest = std::max(farthest, mesh.vertex(v).cwiseAbs().maxCoeff());
  const double derivative = form.space().degree() * map.inverse_transpose.norm();  // per unit of nodal value
  constexpr double unit_round_offs = 1e-13;
  constexpr double of_places = 1e-15;
  return (unit_round_offs + of_places * farthest * derivative) * largest_u * derivative *
         std::sqrt((2 * material.mu + dim * std::abs(material.lambda)) * map.measure());
}

}  // namespace

template <int dim>
void require_carried(const contact::NitscheForm<dim>& form, std::span<const double> u,
                     const FinerContact<dim>& finer)
{
  const std::vector<double> before =
      contact::cell_energies<dim>(form.problem(), form.space(), u, form.meridian());
  const std::vector<double> parts =
      contact::cell_energies<dim>(form.problem(), finer.form->space(), finer.u, finer.form->meridian());
  double largest_u = 0;
  for (const double component : u) largest_u = std::max(largest_u, std::abs(component));
  std::vector<double> after(before.size(), 0.0);
  std::vector<double> rounding(before.size(), 0.0);
  for (std::size_t c = 0; c < parts.size(); ++c)
  {
    after[finer.parent[c]] += parts[c];
    rounding[finer.parent[c]] += rounding_on<dim>(*finer.form, static_cast<Index>(c), largest_u);
  }
  constexpr double share = 1e-8;
  const auto norm = [](double energy) { return std::sqrt(std::max(0.0, energy)); };
  bool is_other = false;
  for (std::size_t c = 0; c < before.size(); ++c)
    is_other =
        is_other || !(std::abs(norm(after[c]) - norm(before[c])) <= share * norm(before[c]) + rounding[c]);
  if (form.space().mesh().ranks().any(is_other))
    throw SolveError("the solution changes its energy when it is transferred to the finer mesh");
}

namespace
{

/// Without the cuts that would leave facets so narrow that the bound is better without them.
std::vector<mesh::FacetCuts> without_slivers(std::vector<mesh::FacetCuts> cuts)
{
  constexpr double narrow = 0.04;  // of a facet
  for (mesh::FacetCuts& facet : cuts)
  {
    double last = 0;
    std::erase_if(facet.at,
                  [&](double at)
                  {
                    const bool is_sliver = at - last < narrow || 1 - at < narrow;
                    if (!is_sliver) last = at;
                    return is_sliver;
                  });
  }
  std::erase_if(cuts, [](const mesh::FacetCuts& facet) { return facet.at.empty(); });
  return cuts;
}

}  // namespace

template <int dim>
std::unique_ptr<FinerContact<dim>> matching_contact(const contact::NitscheForm<dim>& form,
                                                    std::span<const double> u)
{
  if constexpr (dim == 2)
  {
    const mesh::Mesh<2>& mesh = form.space().mesh();
    if (contact::facets_match(mesh, form.segments())) return nullptr;
    const bool all_have_to_match = mesh.ranks().any(std::ranges::any_of(
        form.segments(), &problem::Contact::is_bilateral, &contact::ContactSegment<2>::contact));
    std::vector<mesh::FacetCuts> cuts = contact::facet_cuts(mesh, form.segments());
    if (!all_have_to_match) cuts = without_slivers(std::move(cuts));
    if (!mesh.ranks().any(!cuts.empty())) return nullptr;
    auto result =
        carried<2>(form, u, finer_mesh<2>(form.space(), {u}, {}, {.cuts = cuts, .move = mesh::Move::never}));
    if (!all_have_to_match || (result && contact::facets_match(result->grid->mesh, result->form->segments())))
      return result;
  }
  return nullptr;
}

template <int dim>
std::unique_ptr<FinerContact<dim>> finer_contact(const contact::NitscheForm<dim>& form,
                                                 std::span<const double> u)
{
  constexpr int times = dim == 2 ? 6 : 3;
  if (!certify::obstacles_unfit(form).empty()) return nullptr;
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  if (dim == 3 && form.history() && !contact::facets_match(mesh, form.segments())) return nullptr;
  std::vector<Index> marked;
  for (const std::size_t k : certify::facets_in_transition<dim>(form, form.traction(u)))
  {
    const contact::ContactSegment<dim>& segment = form.segments()[k];
    const auto mark = [&](const contact::SegmentSide<dim>& side)
    {
      if (side.facet.cell < mesh.n_owned_cells()) marked.push_back(side.facet.cell);
    };
    mark(segment.slave);
    if (segment.master && !contact::is_whole(mesh, segment)) mark(*segment.master);  // no twin follows
  }
  if (!mesh.ranks().any(!marked.empty())) return nullptr;
  return carried<dim>(form, u,
                      finer_mesh<dim>(form.space(), {u}, marked,
                                      {.twins = contact::twin_facets<dim>(mesh, form.segments()),
                                       .times = times,
                                       .move = mesh::Move::never}));
}

template void require_carried(const contact::NitscheForm<2>&, std::span<const double>,
                              const FinerContact<2>&);
template void require_carried(const contact::NitscheForm<3>&, std::span<const double>,
                              const FinerContact<3>&);
template std::unique_ptr<FinerContact<2>> matching_contact(const contact::NitscheForm<2>&,
                                                           std::span<const double>);
template std::unique_ptr<FinerContact<3>> matching_contact(const contact::NitscheForm<3>&,
                                                           std::span<const double>);
template std::unique_ptr<FinerContact<2>> finer_contact(const contact::NitscheForm<2>&,
                                                        std::span<const double>);
template std::unique_ptr<FinerContact<3>> finer_contact(const contact::NitscheForm<3>&,
                                                        std::span<const double>);

}  // namespace tribound::adapt
