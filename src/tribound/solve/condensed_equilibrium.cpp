#include <algorithm>
#include <utility>

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
  const algebra::Triplets pattern =
      form.contact_tangent(contact::Linearisation::closed_sticking, std::vector<double>(place.size(), 0.0));
  for (std::size_t e = 0; e < pattern.rows.size(); ++e)
  {
    if (pattern.rows[e] < 0 || pattern.cols[e] < 0) continue;
    place[pattern.rows[e]] = on_trace;
    place[pattern.cols[e]] = std::max(place[pattern.cols[e]], on_layer);
  }
  CondensedDofs dofs;
  for (Index i = 0; i < static_cast<Index>(place.size()); ++i)
  {
    if (place[i] == on_layer) dofs.layer.push_back(i);
    if (place[i] == on_trace) dofs.trace.push_back(i);
  }
  return dofs;
}

namespace
{

template <int dim>
class CondensedEquilibrium final : public Equilibrium<dim>
{
 public:
  CondensedEquilibrium(const contact::NitscheForm<dim>& form, algebra::SparseRows stiffness,
                       const ExternalForces& forces, CondensedDofs dofs)
      : form_(form),
        diagonal_(diagonal(stiffness, dofs)),
        condensed_(dim, std::move(stiffness), std::move(dofs.layer), std::move(dofs.trace), forces.load),
        force_scale_(forces.scale)
  {
  }

  std::vector<double> unknowns(std::span<const double> u) const override
  {
    std::vector<double> x;
    x.reserve(condensed_.trace().size());
    for (const Index i : condensed_.trace()) x.push_back(u[i]);
    return x;
  }

  void displace_contact(std::span<const double> x, std::span<double> u) const override
  {
    const std::vector<double> layer = condensed_.on_layer(x);
    for (std::size_t i = 0; i < layer.size(); ++i) u[condensed_.layer()[i]] = layer[i];
    for (std::size_t i = 0; i < x.size(); ++i) u[condensed_.trace()[i]] = x[i];
  }

  std::vector<double> displacement(std::span<const double> x) const override
  {
    std::vector<double> u = condensed_.expand(x);
    displace_contact(x, u);
    for (std::size_t i = 0; i < u.size(); ++i)
      if (form_.constraints().fixed[i]) u[i] = form_.constraints().values[i];
    return u;
  }

  std::vector<double> internal_forces(std::span<const double> x) const override
  {
    return condensed_.multiply(x);
  }

  std::vector<double> residual(std::span<const double> internal_forces,
                               std::span<const Point<dim>> traction) const override
  {
    std::vector<double> contact(form_.space().n_dofs(), 0.0);
    form_.add_contact_load(traction, contact);
    std::vector<double> r(condensed_.load().begin(), condensed_.load().end());
    for (std::size_t i = 0; i < r.size(); ++i) r[i] += contact[condensed_.trace()[i]] - internal_forces[i];
    return r;
  }

  double norm(std::span<const double> x) const override { return tribound::norm(x); }
  double round_off(std::span<const double> x) const override
  {
    std::vector<double> u = condensed_.on_layer(x);
    u.insert(u.end(), x.begin(), x.end());
    return norm(solve::round_off(diagonal_, u));
  }

  algebra::LinearSolve solve(const algebra::Triplets& contact, std::span<const double> r, double tolerance,
                             std::span<double> d) override
  {
    std::ranges::copy(condensed_.solve(contact, r, tolerance), d.begin());
    return {.factorised = !std::exchange(used_, true)};
  }
  algebra::LinearMethod method() const override { return algebra::LinearMethod::condensed; }
  double force_scale() const override { return force_scale_; }

 private:
  static std::vector<double> diagonal(algebra::SparseRows& stiffness, const CondensedDofs& dofs)
  {
    std::vector<double> result;
    for (const std::span<const Index> kept : {std::span(dofs.layer), std::span(dofs.trace)})
      for (const Index i : kept) result.push_back(stiffness.diagonal(i));
    return result;
  }

  const contact::NitscheForm<dim>& form_;
  std::vector<double> diagonal_;  ///< of the stiffness, [layer, trace]
  algebra::Condensation condensed_;
  double force_scale_;
  bool used_ = false;
};

}  // namespace

template <int dim>
std::unique_ptr<Equilibrium<dim>> condensed_equilibrium(const contact::NitscheForm<dim>& form,
                                                        const ExternalForces& forces, CondensedDofs dofs)
{
  return std::make_unique<CondensedEquilibrium<dim>>(
      form, contact::stiffness(form.problem(), form.space(), form.constraints()), forces, std::move(dofs));
}

template CondensedDofs condensed_dofs(const contact::NitscheForm<2>&);
template CondensedDofs condensed_dofs(const contact::NitscheForm<3>&);
template std::unique_ptr<Equilibrium<2>> condensed_equilibrium(const contact::NitscheForm<2>&,
                                                               const ExternalForces&, CondensedDofs);
template std::unique_ptr<Equilibrium<3>> condensed_equilibrium(const contact::NitscheForm<3>&,
                                                               const ExternalForces&, CondensedDofs);

}  // namespace tribound::solve
