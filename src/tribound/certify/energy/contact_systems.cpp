#include "tribound/certify/energy/contact_systems.h"

#include <algorithm>
#include <utility>

#include "tribound/base/error.h"
#include "tribound/base/rank_failure.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/contact/nitsche/residual.h"
#include "tribound/solve/equilibrium.h"

namespace tribound::certify
{

template <int dim>
ContactSystems<dim>::ContactSystems(const contact::NitscheForm<dim>& form,
                                    const algebra::SolverOptions& solver, bool many)
    : form_(form),
      solver_(solver),
      may_condense_(many && dim == 2 && form.rigid_parts().empty() &&
                    solve::choose_method(form, solver, true) == algebra::LinearMethod::condensed)
{
}

template <int dim>
void ContactSystems<dim>::set_springs(algebra::Triplets springs)
{
  springs_ = std::move(springs);
  systems_[static_cast<int>(OnContact::springs)].reset();
}

template <int dim>
void ContactSystems<dim>::condense()
{
  may_condense_ = false;
  solve::CondensedDofs dofs = solve::condensed_dofs(form_);
  const Ranks& ranks = form_.space().mesh().ranks();
  try
  {
    const std::vector<double> no_load(form_.space().n_dofs(), 0.0);
    algebra::SparseRows k = contact::stiffness(form_.problem(), form_.space(), form_.constraints(),
                                               &form_.springs(), form_.meridian());
    diagonal_ = solve::diagonal(k, form_.space());
    condensed_ = std::make_unique<algebra::Condensation>(
        dim, std::move(k), std::vector<Index>{}, std::move(dofs.trace), no_load, form_.space().numbers());
  }
  catch (const SolveError& error)  // one system after another may still be possible
  {
    require_all_failed(ranks, error.what());
  }
}

template <int dim>
std::vector<char> ContactSystems<dim>::fixed(OnContact how) const
{
  std::vector<char> result = form_.constraints().fixed;
  if (how != OnContact::held) return result;
  const fem::LagrangeSpace<dim>& space = form_.space();
  const auto hold = [&](const contact::SegmentSide<dim>& side)
  {
    const mesh::BoundaryFacet& facet = side.facet;
    for (int i = 0; i < space.basis().n_nodes(); ++i)
      for (int a = 0; a < dim && space.basis().node(i)[facet.local] == 0; ++a)
        result[dim * space.cell_nodes(facet.cell)[i] + a] = 1;
  };
  for (const contact::ContactSegment<dim>& segment : form_.segments()) segment.for_each_side(hold);
  space.update(std::span(result));
  return result;
}

template <int dim>
const ElasticSystem<dim>& ContactSystems<dim>::system(OnContact how)
{
  std::unique_ptr<ElasticSystem<dim>>& system = systems_[static_cast<int>(how)];
  if (!system)
    system = std::make_unique<ElasticSystem<dim>>(form_.problem(), form_.space(), fixed(how), solver_,
                                                  how == OnContact::springs ? springs_ : algebra::Triplets{});
  return *system;
}

template <int dim>
std::vector<std::vector<double>> ContactSystems<dim>::solve(OnContact how,
                                                            std::span<const std::vector<double>> b,
                                                            std::span<const std::vector<double>> starts,
                                                            double tolerance)
{
  if (may_condense_) condense();
  if (condensed_)
    if (auto u = solve_condensed(how, b, {starts.begin(), starts.end()}, tolerance)) return *u;
  std::vector<std::vector<double>> u;
  u.reserve(b.size());
  for (std::size_t k = 0; k < b.size(); ++k) u.push_back(system(how).solve(b[k], starts[k], tolerance));
  return u;
}

template <int dim>
std::vector<std::vector<double>> ContactSystems<dim>::corrections(OnContact how,
                                                                  std::span<const std::vector<double>> r)
{
  // in one pass where it was tried, on one process
  if (how == OnContact::free && shares_passes()) return condensed_->solve_whole(r);
  if (how == OnContact::held) return condensed_->solve_held(r);
  std::vector<std::vector<double>> result;
  for (const std::vector<double>& forces : r)
  {
    condensed_->set_load(forces);
    result.push_back(condensed_->expand(condensed_->solve(
        how == OnContact::springs ? springs_ : algebra::Triplets{}, condensed_->load(), 0)));
  }
  return result;
}

template <int dim>
std::optional<std::vector<std::vector<double>>> ContactSystems<dim>::solve_condensed(
    OnContact how, std::span<const std::vector<double>> b, std::vector<std::vector<double>> u,
    double tolerance)
{
  constexpr int most_attempts = 3;
  const fem::LagrangeSpace<dim>& space = form_.space();
  const std::vector<char> fixed = this->fixed(how);
  std::vector<double> scales;
  for (int attempt = 0;; ++attempt)
  {
    std::vector<std::vector<double>> residuals;
    bool is_solved = attempt > 0;
    for (std::size_t k = 0; k < u.size(); ++k)
    {
      std::vector<double>& r = residuals.emplace_back(contact::internal_forces<dim>(form_, u[k]));
      if (attempt == 0) scales.push_back(space.norm(b[k]) + space.norm(r));
      if (how == OnContact::springs)
        for (std::size_t e = 0; e < springs_.rows.size(); ++e)
          r[springs_.rows[e]] += springs_.values[e] * u[k][springs_.cols[e]];
      for (std::size_t i = 0; i < r.size(); ++i) r[i] = fixed[i] != 0 ? 0 : b[k][i] - r[i];
      const double round_off = space.norm(solve::round_off(diagonal_, u[k]));
      is_solved = is_solved && space.norm(r) <= std::max(tolerance * scales[k], round_off);
    }
    if (is_solved) return u;
    if (attempt == most_attempts) return std::nullopt;
    const std::vector<std::vector<double>> changes = corrections(how, residuals);
    for (std::size_t k = 0; k < u.size(); ++k)
    {
      for (std::size_t i = 0; i < u[k].size(); ++i)
        if (fixed[i] == 0) u[k][i] += changes[k][i];
      space.update(std::span(u[k]));
    }
  }
}

template class ContactSystems<2>;
template class ContactSystems<3>;

}  // namespace tribound::certify
