#include <algorithm>
#include <utility>

#include "tribound/contact/nitsche/part_motions.h"
#include "tribound/contact/nitsche/residual.h"
#include "tribound/solve/equilibrium.h"

namespace tribound::solve
{

namespace
{

/// u = u_0 + sum_i r_i chi_i, with u_0 = u_D on Gamma_D and 0 on rigid parts. Whatever the accuracy of the
/// systems with the parts held, r is such that the linearised forces on the parts are the given ones up to
/// rounding.
template <int dim>
class RigidEquilibrium final : public Equilibrium<dim>
{
 public:
  RigidEquilibrium(const contact::NitscheForm<dim>& form, const algebra::SolverOptions& options)
      : form_(&form),
        forces_(external_forces(form)),
        held_(sparse_equilibrium(form, ExternalForces(forces_), options))
  {
  }

  void follow(const contact::NitscheForm<dim>& form) override
  {
    form_ = &form;
    forces_ = external_forces(form);
    held_->follow(form);
  }

  std::vector<double> unknowns(std::span<const double> u) const override { return {u.begin(), u.end()}; }
  void displace_contact(std::span<const double> x, std::span<double> u) const override
  {
    std::ranges::copy(x, u.begin());
  }
  std::vector<double> displacement(std::span<const double> x) const override { return {x.begin(), x.end()}; }

  std::vector<double> internal_forces(std::span<const double> x) const override
  {
    std::vector<double> u(x.begin(), x.end());
    form_->keep_free(u);
    return contact::internal_forces<dim>(*form_, u);
  }

  std::vector<double> residual(std::span<const double> internal_forces,
                               std::span<const Point<dim>> traction) const override
  {
    std::vector<double> r = forces_.load;
    for (std::size_t i = 0; i < r.size(); ++i) r[i] -= internal_forces[i];
    form_->add_contact_load(traction, r);
    form_->keep_free(r);
    return r;
  }

  double norm(std::span<const double> x) const override { return form_->space().norm(x); }
  double round_off(std::span<const double> x) const override { return held_->round_off(x); }
  algebra::LinearMethod method() const override { return held_->method(); }
  double force_scale() const override { return forces_.scale; }

  algebra::LinearSolve solve(const contact::NitscheForm<dim>& form, const Linearised<dim>& contact,
                             std::span<const double> r, double tolerance, std::span<double> d,
                             const algebra::ResidualTest& small_enough) override
  {
    constexpr double tight = 1e-12;  // of the forces that a motion of a part causes
    const contact::RigidParts<dim>& parts = form.rigid_parts();
    const Tangent tangent{form, contact, contact.traction(form, std::vector<double>(d.size(), 0.0))};
    algebra::LinearSolve result = held_->solve(form, contact, without_parts(r), tolerance, d, small_enough);
    const auto held = [&](std::span<const double> all)
    {
      const std::vector<double> forces = without_parts(all);
      std::vector<double> others(d.size(), 0.0);
      result.iterations += held_->solve(form, contact, forces, tight * norm(forces), others, {}).iterations;
      return others;
    };
    contact::move_parts(parts, contact::part_motions(parts, tangent, held), tangent, r, d);
    return result;
  }

 private:
  /// w to a(w, phi_i) - (DT_lin[w], [phi_i])_C.
  struct Tangent
  {
    const contact::NitscheForm<dim>& form;
    const Linearised<dim>& contact;
    std::vector<Point<dim>> at_rest;  ///< T_lin(0)

    [[nodiscard]] std::vector<double> operator()(std::span<const double> w) const
    {
      std::vector<Point<dim>> t = contact.traction(form, w);
      for (std::size_t k = 0; k < t.size(); ++k) t[k] = at_rest[k] - t[k];
      std::vector<double> result = contact::internal_forces<dim>(form, w);
      form.add_contact_load(t, result);
      return result;
    }
  };

  /// 0 at all fixed degrees of freedom.
  [[nodiscard]] std::vector<double> without_parts(std::span<const double> vector) const
  {
    std::vector<double> result(vector.begin(), vector.end());
    for (std::size_t i = 0; i < result.size(); ++i)
      if (form_->constraints().fixed[i]) result[i] = 0;
    return result;
  }

  const contact::NitscheForm<dim>* form_;
  ExternalForces forces_;
  std::unique_ptr<Equilibrium<dim>> held_;  ///< with the rigid parts at rest
};

}  // namespace

template <int dim>
std::unique_ptr<Equilibrium<dim>> whole_equilibrium(const contact::NitscheForm<dim>& form,
                                                    const algebra::SolverOptions& options)
{
  if (form.rigid_parts().size() == 0) return sparse_equilibrium(form, external_forces(form), options);
  return std::make_unique<RigidEquilibrium<dim>>(form, options);
}

template std::unique_ptr<Equilibrium<2>> whole_equilibrium(const contact::NitscheForm<2>&,
                                                           const algebra::SolverOptions&);
template std::unique_ptr<Equilibrium<3>> whole_equilibrium(const contact::NitscheForm<3>&,
                                                           const algebra::SolverOptions&);

}  // namespace tribound::solve
