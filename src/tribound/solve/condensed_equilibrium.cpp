#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "tribound/algebra/condensation.h"
#include "tribound/base/norm.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/solve/equilibrium.h"

namespace tribound::solve
{

template <int dim>
CondensedDofs condensed_dofs(const contact::NitscheForm<dim>& form)
{
  enum Place : char
  {
    elsewhere,
    on_layer,
    on_trace
  };
  std::vector<Place> place(form.space().n_dofs(), elsewhere);
  const algebra::Triplets pattern = form.contact_pattern();
  for (std::size_t e = 0; e < pattern.rows.size(); ++e)
  {
    if (pattern.rows[e] < 0 || pattern.cols[e] < 0) continue;
    place[pattern.rows[e]] = on_trace;
    place[pattern.cols[e]] = std::max(place[pattern.cols[e]], on_layer);
  }
  CondensedDofs dofs;
  for (Index k = 0; k < form.space().n_owned_nodes(); ++k)
    for (int a = 0; a < dim; ++a)
    {
      const Index i = dim * form.space().owned_node(k) + a;
      if (place[i] == on_layer) dofs.layer.push_back(i);
      if (place[i] == on_trace) dofs.trace.push_back(i);
    }
  return dofs;
}

template <int dim>
std::vector<double> diagonal(const algebra::SparseRows& matrix, const fem::LagrangeSpace<dim>& space)
{
  std::vector<double> result(space.n_dofs(), 0.0);
  for (Index k = 0; k < space.n_owned_nodes(); ++k)
    for (int a = 0; a < dim; ++a)
    {
      const Index i = dim * space.owned_node(k) + a;
      result[i] = matrix.entry(dim * k + a, i);
    }
  return result;
}

namespace
{

/// The unknowns x are the displacement on the contact boundary; every rank has those of all ranks.
template <int dim>
class CondensedEquilibrium final : public Equilibrium<dim>
{
 public:
  /// `diagonal`: of the stiffness, at own unknowns.
  CondensedEquilibrium(const contact::NitscheForm<dim>& form, algebra::SparseRows stiffness,
                       std::span<const double> diagonal, const ExternalForces& forces, CondensedDofs dofs)
      : form_(&form),
        condensed_(dim, std::move(stiffness), std::move(dofs.layer), std::move(dofs.trace), forces.load,
                   form.space().numbers()),
        diagonal_(condensed_.on_layer_and_trace(diagonal)),
        contact_(form.contact_pattern()),
        force_scale_(forces.scale)
  {
  }

  void follow(const contact::NitscheForm<dim>& form) override
  {
    form_ = &form;
    const ExternalForces forces = external_forces(form);
    condensed_.set_load(forces.load);
    force_scale_ = forces.scale;
  }

  std::vector<double> unknowns(std::span<const double> u) const override { return condensed_.on_trace(u); }

  void displace_contact(std::span<const double> x, std::span<double> u) const override
  {
    condensed_.put(condensed_.near(x), u);
  }

  std::vector<double> displacement(std::span<const double> x) const override
  {
    std::vector<double> u = condensed_.expand(x);
    for (std::size_t i = 0; i < u.size(); ++i)
      if (form_->constraints().fixed[i]) u[i] = form_->constraints().values[i];
    form_->space().update(std::span(u));
    return u;
  }

  std::vector<double> internal_forces(std::span<const double> x) const override
  {
    return condensed_.multiply(x);
  }

  std::vector<double> residual(std::span<const double> internal_forces,
                               std::span<const Point<dim>> traction) const override
  {
    std::vector<double> contact(form_->space().n_dofs(), 0.0);
    form_->add_contact_load(traction, contact);
    std::vector<double> r = condensed_.on_trace(contact);
    for (std::size_t i = 0; i < r.size(); ++i) r[i] += condensed_.load()[i] - internal_forces[i];
    return r;
  }

  double norm(std::span<const double> x) const override { return tribound::norm(x); }
  double round_off(std::span<const double> x) const override
  {
    return norm(solve::round_off(diagonal_, condensed_.near(x)));
  }

  algebra::LinearSolve solve(const contact::NitscheForm<dim>& form, const Linearised<dim>& contact,
                             std::span<const double> r, double tolerance, std::span<double> d,
                             const algebra::ResidualTest& /*small_enough*/) override
  {
    contact_.values = contact.tangent(form);
    std::ranges::copy(condensed_.solve(contact_, r, tolerance), d.begin());
    return {.factorised = !std::exchange(used_, true)};
  }
  algebra::LinearMethod method() const override { return algebra::LinearMethod::condensed; }
  double force_scale() const override { return force_scale_; }

 private:
  const contact::NitscheForm<dim>* form_;
  algebra::Condensation condensed_;
  std::vector<double> diagonal_;  ///< of the stiffness, on layer and trace
  algebra::Triplets contact_;
  double force_scale_;
  bool used_ = false;
};

}  // namespace

template <int dim>
std::unique_ptr<Equilibrium<dim>> condensed_equilibrium(const contact::NitscheForm<dim>& form,
                                                        const ExternalForces& forces, CondensedDofs dofs)
{
  algebra::SparseRows stiffness =
      contact::stiffness(form.problem(), form.space(), form.constraints(), &form.springs(), form.meridian());
  const std::vector<double> of_stiffness = diagonal(stiffness, form.space());
  return std::make_unique<CondensedEquilibrium<dim>>(form, std::move(stiffness), of_stiffness, forces,
                                                     std::move(dofs));
}

template std::vector<double> diagonal(const algebra::SparseRows&, const fem::LagrangeSpace<2>&);
template std::vector<double> diagonal(const algebra::SparseRows&, const fem::LagrangeSpace<3>&);
template CondensedDofs condensed_dofs(const contact::NitscheForm<2>&);
template CondensedDofs condensed_dofs(const contact::NitscheForm<3>&);
template std::unique_ptr<Equilibrium<2>> condensed_equilibrium(const contact::NitscheForm<2>&,
                                                               const ExternalForces&, CondensedDofs);
template std::unique_ptr<Equilibrium<3>> condensed_equilibrium(const contact::NitscheForm<3>&,
                                                               const ExternalForces&, CondensedDofs);

}  // namespace tribound::solve
