#include "tribound/certify/energy/energy_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "tribound/certify/bound/checks.h"
#include "tribound/certify/bound/korn.h"
#include "tribound/certify/bound/rigid_remainder.h"
#include "tribound/certify/energy/admissible_displacement.h"
#include "tribound/certify/energy/admissible_traction.h"
#include "tribound/certify/energy/balanced_solution.h"
#include "tribound/certify/energy/balanced_traction.h"
#include "tribound/certify/energy/cell_distances.h"
#include "tribound/certify/energy/edge_moments.h"
#include "tribound/certify/energy/free_motions.h"
#include "tribound/certify/energy/load_oscillation.h"
#include "tribound/certify/energy/meridian_distances.h"
#include "tribound/certify/energy/meridian_edge_forces.h"
#include "tribound/certify/energy/quantity_bounds.h"
#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/contact/nitsche/form_history.h"
#include "tribound/contact/nitsche/residual.h"
#include "tribound/fem/degree.h"
#include "tribound/mesh/mesh.h"

namespace tribound::certify
{

namespace
{

/// Degree 2 is the lowest in which a stress can be symmetric and in equilibrium with any affine load.
constexpr int lowest_degree = 2;

/// R(psi_a psi_b e_i) for each edge: a quarter of R at the basis function of its midpoint node.
template <int dim>
std::vector<Point<dim>> edge_forces(const fem::LagrangeSpace<dim>& space, std::span<const double> residual)
{
  const mesh::Mesh<dim>& mesh = space.mesh();
  constexpr auto edges = mesh::local_edges<dim>;
  std::vector<Point<dim>> forces(mesh.topology().edges.size(), Point<dim>::Zero());
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    int middle = 0;
    while (space.basis().node(middle)[edges[e][0]] != 1 || space.basis().node(middle)[edges[e][1]] != 1)
      ++middle;
    for (Index c = 0; c < mesh.n_cells(); ++c)
      for (int a = 0; a < dim; ++a)
        forces[mesh.topology().cell_edges[c][e]][a] = residual[dim * space.cell_nodes(c)[middle] + a] / 4;
  }
  return forces;
}

}  // namespace

template <int dim>
EnergyBound no_energy_bound(const contact::NitscheForm<dim>& form, std::span<const double> u,
                            std::span<const problem::Quantity<dim>> quantities, const std::string& reason)
{
  return {.reason = reason, .quantities = QuantityBounds<dim>(form, quantities).from_equilibrium(u, reason)};
}

/// What the functions on a mesh share. For p = 1 the form has degree 2, except on a meridian, where stresses
/// have a degree more than displacements.
template <int dim>
struct EnergyEstimator<dim>::Parts
{
  Parts(const contact::NitscheForm<dim>& given, const algebra::SolverOptions& solver, bool has_quantities,
        double of_body, PatchStress patches)
      : form(given.space().degree() >= lowest_degree || given.problem().is_axisymmetric() ? given
                                                                                          : richer(given)),
        equilibrator(form, patches),
        systems(form, solver, has_quantities),
        facets(form),
        gaps(form, facets),
        motions(form.problem(), form.space().mesh()),
        terms(form, ContactRule::reference),
        korn(of_body)
  {
  }

  const contact::NitscheForm<dim>& richer(const contact::NitscheForm<dim>& given)
  {
    rich_space.emplace(given.space().mesh(), lowest_degree);
    rich_form.emplace(given.problem(), *rich_space, given.gamma0(),
                      std::vector(given.segments().begin(), given.segments().end()));
    if (given.history()) rich_form->set_history(contact::raised_history(given, *rich_form));
    return *rich_form;
  }

  std::optional<fem::LagrangeSpace<dim>> rich_space;
  std::optional<contact::NitscheForm<dim>> rich_form;
  const contact::NitscheForm<dim>& form;
  mutable Equilibrator<dim> equilibrator;
  mutable ContactSystems<dim> systems;
  ObstacleFacets<dim> facets;
  ContactGap<dim> gaps;
  FreeMotions<dim> motions;
  ContactTerms<dim> terms;
  double korn;
};

template <int dim>
EnergyEstimator<dim>::EnergyEstimator(const contact::NitscheForm<dim>& form,
                                      const algebra::SolverOptions& solver,
                                      const std::vector<problem::Quantity<dim>>& quantities,
                                      std::optional<double> korn, PatchStress patches)
    : form_(form), solver_(solver), reason_(obstacles_unfit(form))
{
  if (!quantities.empty()) quantities_ = std::make_unique<QuantityBounds<dim>>(form, quantities);
  if (!reason_.empty()) return;
  if (!korn) korn = korn_constant(form.problem(), form.space().mesh());
  parts_ = std::make_unique<Parts>(form, solver, quantities_ != nullptr, *korn, patches);
  if (parts_->motions.is_unclear()) reason_ = "conditions hardly stop a rigid motion of a body";
  if (std::string why = parts_->form.springs().why_unclear(); !why.empty()) reason_ = std::move(why);
  if (reason_.empty() && quantities_)
    quantities_->prepare(parts_->form, parts_->facets, parts_->systems, parts_->motions.size() == 0);
}

template <int dim>
EnergyEstimator<dim>::~EnergyEstimator() = default;

namespace
{

/// `known`, `known_v`: of cell_distances().
template <int dim>
CellDistances distances(const contact::NitscheForm<dim>& form, const Stress<dim>& stress,
                        std::span<const double> u, std::span<const double> v, const CellDistances& known,
                        std::span<const double> known_v)
{
  if constexpr (dim == 2)
    if (form.problem().is_axisymmetric()) return meridian_distances(form, stress, u, v);
  CellDistances result;
  fem::with_degree<lowest_degree>(form.space().degree(), [&](auto q)
                                  { result = cell_distances<dim, q>(form, stress, u, v, known, known_v); });
  return result;
}

/// E of v and the stress that carries t_h and the springs at u~, and the bounds that follow.
template <int dim, class Parts>
EnergyBound bound_with(const Parts& parts, const AdmissibleTraction<dim>& t_h,
                       std::span<const double> transfer, const LoadOscillation& loads,
                       std::span<const double> balanced, std::span<const double> v,
                       const CellDistances& cells)
{
  const contact::NitscheForm<dim>& form = parts.form;
  std::vector<double> apart(v.begin(), v.end());  // of the springs at v and at u~
  for (std::size_t i = 0; i < apart.size(); ++i) apart[i] -= balanced[i];
  std::vector<double> of_springs(cells.square.size(), 0.0);
  form.springs().add_products(apart, apart, of_springs);
  EnergyBound result;
  result.cells.resize(cells.square.size());
  // ||tau - sigma(v)||^2, A^2, ||O||^2, of transfer, ||c||^2, dist^2, G_c, of springs
  std::array<double, 8> sums{};
  auto& [square, a_square, o_square, e_square, c_square, dist_square, g, s_square] = sums;
  for (std::size_t k = 0; k < cells.square.size(); ++k)
  {
    const double o = loads.cells[k] + transfer[k];
    const double distance = cells.square[k] + of_springs[k];
    square += distance;
    s_square += of_springs[k];
    result.cells[k] = std::pow(std::sqrt(distance) + o, 2);
    a_square += result.cells[k];
    o_square += o * o;
    e_square += transfer[k] * transfer[k];
    c_square += cells.correction[k];
    dist_square += cells.to_discrete[k];
  }
  for (std::size_t k = 0; k < form.n_owned_segments(); ++k)
  {
    const double gap = parts.gaps(k, t_h, v);
    g += gap;
    result.cells[form.segments()[k].slave.facet.cell] += 4 * gap;
  }
  const Ranks& ranks = form.space().mesh().ranks();
  ranks.sum(std::span(sums));
  result.cell_balance = ranks.max(cells.unbalanced);
  if (!(result.cell_balance <= cell_balance_limit)) result.reason = "a cell does not balance";
  const double a = std::sqrt(a_square) + loads.missed;
  result.contact = g;
  result.springs = s_square;
  result.oscillation = std::sqrt(o_square) + loads.missed;
  result.transfer = std::sqrt(e_square);
  result.correction = std::sqrt(c_square);
  result.dist = std::sqrt(dist_square);
  result.b_v = a / 2 + std::sqrt(a * a / 4 + g);
  result.gap = square / 2 + g + result.oscillation * result.b_v;
  result.mid = std::sqrt(square / 4 + g + result.oscillation * result.b_v);
  result.bound = std::min(result.b_v + result.correction, result.mid + result.dist);
  if (!std::isfinite(result.bound)) result.reason = "the bound is not a finite number";
  return result;
}

}  // namespace

template <int dim>
EnergyBound EnergyEstimator<dim>::operator()(std::span<const double> u) const
{
  std::vector<QuantityInterval> intervals;
  const auto use = [&](const BoundedState<dim>& state)
  {
    if (!quantities_) return;
    intervals = quantities_->from_equilibrium(u, {});
    quantities_->add_bounded(state, intervals);
  };
  EnergyBound result = reason_.empty() ? bound(u, use) : EnergyBound{.reason = reason_};
  if (quantities_ && intervals.empty()) intervals = quantities_->from_equilibrium(u, result.reason);
  result.quantities = std::move(intervals);
  return result;
}

template <int dim>
template <class Use>
EnergyBound EnergyEstimator<dim>::bound(std::span<const double> u, const Use& use) const
{
  const contact::NitscheForm<dim>& form = parts_->form;
  const Ranks& ranks = form.space().mesh().ranks();
  const bool is_raised = &form != &form_;
  const std::vector<double> rich_u =
      is_raised ? raised(form_.space(), u, form.space()) : std::vector<double>(u.begin(), u.end());
  const std::vector<Point<dim>> t = form.traction(rich_u);
  const std::optional<AdmissibleTraction<dim>> traction = balanced_traction<dim>(form, parts_->motions, t);
  if (!traction) return {.reason = "no contact traction was found that obeys the law and holds a body"};
  const AdmissibleTraction<dim>& t_h = *traction;
  const std::vector<double> balanced = balanced_solution<dim>(form, form_.space(), u, t_h.at_points,
                                                              parts_->motions, solver_, parts_->systems);
  std::vector<Tensor<dim>> turning;
  if (is_raised)
    turning = edge_moments<dim>(
        form.space().mesh(),
        edge_forces<dim>(form.space(), contact::residual<dim>(form, balanced, t_h.at_points)));
  else if constexpr (dim == 2)
    if (form.space().degree() < lowest_degree)
      turning = edge_moments<2>(form.space().mesh(), meridian_edge_forces(form, balanced, t_h.at_points));
  const Stress<dim> stress = parts_->equilibrator.balanced(balanced, t_h.at_points, turning);

  const IdentityDefects identities = check_identities<dim>(form, t_h.at_points, stress);
  if (!(identities.largest() <= cell_balance_limit))
    return {.reason = "an identity of the equilibrated stress is violated"};
  if (!(rigid_defect<dim>(form, stress) <= cell_balance_limit))
    return {.reason = "the equilibrated stress does not carry the forces on a rigid part"};
  const AdmissibleDisplacements v = admissible_displacements<dim>(form, rich_u, t);
  if (!v.reason.empty()) return {.reason = v.reason};
  const std::vector<double> transfer = transfer_oscillation<dim>(form, parts_->terms, t_h.at_points);
  if (ranks.any(!std::ranges::all_of(transfer, [](double of_cell) { return std::isfinite(of_cell); })))
    return {.reason = "contact tractions are no polynomials on a facet of a cell that touches the axis"};
  const LoadOscillation loads = load_oscillation<dim>(form, balanced, parts_->korn);
  if (!loads.reason.empty()) return {.reason = loads.reason};
  EnergyBound best{.reason = parts_->facets.touch(form.rigid_parts())
                                 ? "a rigid part that touches a contact boundary would have to move"
                                 : "no displacement near the computed one is admissible"};
  CellDistances cells;
  std::span<const double> cells_of;  // the candidate to which they belong
  for (const bool is_open : {true, false})
  {
    const std::optional<std::vector<double>>& candidate = is_open ? v.open : v.closed;
    if (!candidate || (!is_open && !v.has_transition && v.open)) continue;
    cells = distances(form, stress, rich_u, *candidate, cells, cells_of);
    cells_of = *candidate;
    EnergyBound bound = bound_with<dim>(*parts_, t_h, transfer, loads, balanced, *candidate, cells);
    bound.is_open = is_open;
    if (!best.reason.empty() || (bound.reason.empty() && bound.bound < best.bound)) best = std::move(bound);
  }
  best.gap_remainder = v.gap_remainder;
  best.direction_remainder = v.direction_remainder;
  best.threshold_remainder = ranks.max(t_h.threshold_remainder);
  if (ranks.any(std::ranges::any_of(form.segments(), [](const contact::ContactSegment<dim>& segment)
                                    { return problem::cone(segment.contact->law).coefficient > 0; })))
    best.target = EnergyTarget::computed_friction;
  if (best.reason.empty())
    use(BoundedState<dim>(form, parts_->facets, best.is_open ? *v.open : *v.closed, balanced, stress, t_h,
                          best));
  return best;
}

template EnergyBound no_energy_bound(const contact::NitscheForm<2>&, std::span<const double>,
                                     std::span<const problem::Quantity<2>>, const std::string&);
template EnergyBound no_energy_bound(const contact::NitscheForm<3>&, std::span<const double>,
                                     std::span<const problem::Quantity<3>>, const std::string&);
template class EnergyEstimator<2>;
template class EnergyEstimator<3>;

}  // namespace tribound::certify
