#pragma once

/// @file true_error.h
/// Computes what the bound bounds: the dual norm of the residual from below, and errors against a much richer
/// solution; method section 9. Far more expensive than the bound: for verification.

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/algebra/linear_solver.h"
#include "tribound/algebra/petsc.h"
#include "tribound/certify/energy/energy_bound.h"
#include "tribound/certify/truth/refined_segments.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/mesh/refine.h"
#include "tribound/solve/newton.h"

namespace tribound::certify
{

/// The richer space in which the truth is approximated.
struct RicherSpace
{
  int refinements = 2;  ///< number of uniform refinements of the mesh, >= 1
  int degree = 0;       ///< polynomial degree, not below that of the solution
};

/// Degrees of freedom of the vector-valued space on the refined mesh, fixed ones included.
template <int dim>
[[nodiscard]] double count_dofs(const mesh::Mesh<dim>& mesh, const RicherSpace& space);

/// The dual norm of the residual of functions of one discrete problem, from below.
///
/// For z in W = P^q on the refined mesh, 0 in the components that Gamma_D fixes and a rigid motion on each
/// rigid part, with
///     (grad z, grad v) + sum_k (1/h_k) ([z], [v])_k = <R(u), v>   for all v in W, k the segments of C,
///     <R(u), v> = L(v) - a(u, v) + (T(u), [v])_C,
/// ||z||_{C,h} <= ||R(u)||_*, with equality in the limit as W grows. h_k, and gamma in T(u), are those of the
/// original mesh. Of an axisymmetric problem (z_r / r, v_r / r) is added, and all has the weight r. The
/// operator couples bodies but no components: one scalar matrix for each set of fixed nodes, factored once.
/// a(u, v) is exact. f and g_N are integrated as in a form of degree q on the refined mesh (DiscreteData, up
/// to 1e-5 of their effect, and up to its remainders if its parts run out). T(u) is integrated with the rule
/// on further divided segments, because it has kinks. Up to these errors the result is a lower bound. Keeps a
/// reference to the form.
template <int dim>
class DualNorm
{
 public:
  DualNorm(const contact::NitscheForm<dim>& form, const RicherSpace& richer);
  DualNorm(const DualNorm&) = delete;
  DualNorm& operator=(const DualNorm&) = delete;

  /// ||z||_{C,h} for any function u of the form's space. The first call factorises. Throws SolveError when
  /// that fails.
  [[nodiscard]] double operator()(std::span<const double> u) { return of(residual(u)); }
  /// The dual norm in W of a functional with the given values at the basis functions of W.
  [[nodiscard]] double of(std::span<const double> functional);

  /// W, fixed degrees of freedom included.
  [[nodiscard]] const fem::LagrangeSpace<dim>& space() const { return space_; }
  /// <R(u), phi_i> for every degree of freedom of W.
  [[nodiscard]] std::vector<double> residual(std::span<const double> u);
  /// The same with the given values for L(phi_i) + (K u_0, phi_i)_S.
  [[nodiscard]] std::vector<double> residual(std::span<const double> u, std::span<const double> load) const;

 private:
  /// The scalar problem of the components that are fixed at the same nodes.
  struct Operator
  {
    std::vector<char> fixed;  ///< per node
    std::vector<int> components;
    std::unique_ptr<algebra::SparseMatrix> matrix;
    std::unique_ptr<algebra::LinearSolver> solver;
  };
  /// The basis of W at the points of a rule on the sides of segments; tables of whole facets are shared.
  class SideTables;

  void find_operators();
  [[nodiscard]] algebra::SparseMatrix matrix(const std::vector<char>& fixed, int component) const;
  /// The terms of springs.
  void add_springs(const std::vector<char>& fixed, algebra::Triplets& entries) const;
  void add_contact_load(std::span<const double> u, std::span<double> vector) const;
  /// z in W, 0 in fixed components and on rigid parts, with (z, w) = functional for all such w.
  [[nodiscard]] std::vector<double> riesz(std::span<const double> functional);
  /// (z, phi_i) for every degree of freedom; without rigid parts only the free ones.
  [[nodiscard]] std::vector<double> product(std::span<const double> z) const;

  const contact::NitscheForm<dim>& form_;
  int n_refinements_;
  mesh::Refined<dim> refined_;
  fem::LagrangeSpace<dim> space_;
  std::shared_ptr<const contact::MeridianCells> meridian_;
  contact::Springs<dim> springs_;
  contact::RigidParts<dim> parts_;
  std::vector<double> load_;  ///< L(phi_i) + (K u_0, phi_i)_S; computed when first needed
  std::vector<RefinedSegment<dim>> segments_;
  std::vector<Operator> operators_;
  /// Without fixed nodes, of each component of axisymmetric problems, else of all; with rigid parts.
  std::vector<algebra::SparseMatrix> whole_;
};

/// bound / dual_norm, at least 1 by the theorem; nothing if both are below norms.round_off or 1e-10
/// ||sigma(u)||, the size of the round-off to which the identities of the bound hold.
[[nodiscard]] std::optional<double> effectivity(double bound, double dual_norm,
                                                const contact::StressNorms& norms);

/// bound / error in the energy norm, with `energy` = a(u_h, u_h); nothing if the two refer to different
/// solutions (Coulomb), without a bound, and if the error is rounding, below 1e-10 ||u_h||_en.
[[nodiscard]] std::optional<double> energy_effectivity(const EnergyBound& bound, double error, double energy);

/// The distance of a discrete solution from a much richer one.
struct SolutionError
{
  double energy = 0;  ///< ||u - u_ref||_en = (sigma(e), eps(e))^{1/2}
  double stress = 0;  ///< ||sigma(u - u_ref)||
};

/// The problem solved once more in a much richer space.
struct RicherSolution
{
  long cells = 0;
  long dofs = 0;  ///< free ones
  int newton_steps = 0;
  std::string failure;                 ///< why there is no solution; empty when there is
  std::optional<SolutionError> error;  ///< absent where the richer problem was not solved
};

/// Further use of a richer solution of this form.
template <int dim>
using UseOfRicher = std::function<void(const contact::NitscheForm<dim>&, std::span<const double>)>;

/// Solves the form's problem in the richer space with Nitsche's parameter gamma0 and data evaluated anew,
/// starting from u, and measures u against the result. If there is one, `use` gets it, too.
template <int dim>
[[nodiscard]] RicherSolution compare_with_richer(const contact::NitscheForm<dim>& form,
                                                 std::span<const double> u, const RicherSpace& richer,
                                                 double gamma0, const solve::NewtonOptions& newton,
                                                 const algebra::SolverOptions& solver,
                                                 const UseOfRicher<dim>& use = {});

}  // namespace tribound::certify
