#include <algorithm>
#include <utility>

#include "tribound/algebra/petsc.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/solve/equilibrium.h"

namespace tribound::solve
{

namespace
{

template <int dim>
class SparseEquilibrium final : public Equilibrium<dim>
{
 public:
  SparseEquilibrium(const contact::NitscheForm<dim>& form, ExternalForces forces,
                    const algebra::SolverOptions& options)
      : form_(&form),
        stiffness_(dim,
                   contact::stiffness(form.problem(), form.space(), form.constraints(), &form.springs(),
                                      form.meridian()),
                   form.space().numbers()),
        contact_(form.space().n_dofs(), dim, form.contact_pattern(), form.space().numbers()),
        tangent_(algebra::SparseMatrix::sum(stiffness_, contact_)),
        diagonal_(stiffness_.diagonal()),
        forces_(std::move(forces)),
        linear_solver_(options, form.space())
  {
    linear_solver_.set_changing_part(contact_);
  }

  void follow(const contact::NitscheForm<dim>& form) override
  {
    form_ = &form;
    forces_ = external_forces(form);
  }

  std::vector<double> unknowns(std::span<const double> u) const override { return {u.begin(), u.end()}; }
  void displace_contact(std::span<const double> x, std::span<double> u) const override
  {
    std::ranges::copy(x, u.begin());
  }
  std::vector<double> displacement(std::span<const double> x) const override { return {x.begin(), x.end()}; }
  std::vector<double> internal_forces(std::span<const double> x) const override
  {
    return stiffness_.multiply(x);
  }

  std::vector<double> residual(std::span<const double> internal_forces,
                               std::span<const Point<dim>> traction) const override
  {
    std::vector<double> r = forces_.load;
    for (std::size_t i = 0; i < r.size(); ++i) r[i] -= internal_forces[i];
    form_->add_contact_load(traction, r);
    for (std::size_t i = 0; i < r.size(); ++i)
      if (form_->constraints().fixed[i]) r[i] = 0;
    return r;
  }

  double norm(std::span<const double> x) const override { return form_->space().norm(x); }
  double round_off(std::span<const double> x) const override { return norm(solve::round_off(diagonal_, x)); }

  algebra::LinearSolve solve(const contact::NitscheForm<dim>& form, const Linearised<dim>& contact,
                             std::span<const double> r, double tolerance, std::span<double> d,
                             const algebra::ResidualTest& small_enough) override
  {
    contact_.set_values(contact.tangent(form));
    tangent_.assign_sum(stiffness_, contact_);
    const algebra::LinearSolve result = linear_solver_.solve(tangent_, r, tolerance, d, small_enough);
    for (std::size_t i = 0; i < d.size(); ++i)  // multigrid moves fixed ones within its tolerance
      if (form_->constraints().fixed[i]) d[i] = 0;
    return result;
  }
  algebra::LinearMethod method() const override { return linear_solver_.method(); }
  double force_scale() const override { return forces_.scale; }

 private:
  const contact::NitscheForm<dim>* form_;
  algebra::SparseMatrix stiffness_;  ///< a(phi_j, phi_i)
  algebra::SparseMatrix contact_;    ///< -(DT(u)[phi_j], phi_i)_C
  algebra::SparseMatrix tangent_;    ///< their sum
  std::vector<double> diagonal_;     ///< of the stiffness
  ExternalForces forces_;
  algebra::LinearSolver linear_solver_;
};

}  // namespace

template <int dim>
std::unique_ptr<Equilibrium<dim>> sparse_equilibrium(const contact::NitscheForm<dim>& form,
                                                     ExternalForces forces,
                                                     const algebra::SolverOptions& options)
{
  return std::make_unique<SparseEquilibrium<dim>>(form, std::move(forces), options);
}

template std::unique_ptr<Equilibrium<2>> sparse_equilibrium(const contact::NitscheForm<2>&, ExternalForces,
                                                            const algebra::SolverOptions&);
template std::unique_ptr<Equilibrium<3>> sparse_equilibrium(const contact::NitscheForm<3>&, ExternalForces,
                                                            const algebra::SolverOptions&);

}  // namespace tribound::solve
