#pragma once

/// @file estimate.h
/// The components of the bound, method section 5.

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "tribound/certify/bound/contact_terms.h"
#include "tribound/certify/bound/data_terms.h"
#include "tribound/certify/bound/friedrichs.h"

namespace tribound::certify
{

/// Global or cell values of the components; stress units times length^(dim/2).
struct BoundComponents
{
  double osc = 0;    ///< (h_T / pi) ||f - Pi^{p-1} f||
  double str = 0;    ///< ||sigma_dis - sigma(u)||
  double neu = 0;    ///< sum over Neumann facets of C_{T,F} ||g_N - Pi^p_F g_N||
  double lin1 = 0;   ///< ||sigma_lin||
  double cnt = 0;    ///< (sum h_F ||[P^n]_- - sigma_dis^n||_F^2)^{1/2}
  double frc = 0;    ///< (sum h_F ||[P^t]_S - sigma_dis^t||_F^2)^{1/2}
  double lin2n = 0;  ///< (sum h_F ||sigma_lin^n||_F^2)^{1/2}
  double lin2t = 0;  ///< (sum h_F ||sigma_lin^t||_F^2)^{1/2}
  double quad =
      0;  ///< C_F ||rho||, rho the means of what quadrature may miss of the loads; of no single cell
  double reg1 = 0;   ///< ||sigma_reg||; as the next two 0 unless T is regularised, method section 7
  double reg2n = 0;  ///< (sum h_F ||sigma_reg^n||_F^2)^{1/2}
  double reg2t = 0;  ///< (sum h_F ||sigma_reg^t||_F^2)^{1/2}

  /// osc + str + neu + lin1 + reg1: what belongs to the body.
  [[nodiscard]] double body() const;
  /// ((cnt + lin2n + reg2n)^2 + (frc + lin2t + reg2t)^2)^{1/2}: what belongs to the contact conditions.
  [[nodiscard]] double contact() const;
  /// (a^2 + b^2)^{1/2} with a = body() and b = cnt + frc + lin2n + lin2t + reg2n + reg2t [FD24].
  [[nodiscard]] double total() const;
  /// The same with b = contact(): normal and tangential part are orthogonal.
  [[nodiscard]] double total_sharp() const;
  /// osc + str + neu + cnt + frc + quad: neither Newton's method nor the regularisation.
  [[nodiscard]] double discretisation() const { return osc + str + neu + cnt + frc + quad; }
  [[nodiscard]] double linearisation() const { return lin1 + lin2n + lin2t; }
  [[nodiscard]] double regularisation() const { return reg1 + reg2n + reg2t; }
};

using NamedComponent = std::pair<const char*, double BoundComponents::*>;

inline constexpr std::array<NamedComponent, 12> all_component_names{{{"osc", &BoundComponents::osc},
                                                                     {"str", &BoundComponents::str},
                                                                     {"neu", &BoundComponents::neu},
                                                                     {"lin1", &BoundComponents::lin1},
                                                                     {"cnt", &BoundComponents::cnt},
                                                                     {"frc", &BoundComponents::frc},
                                                                     {"lin2n", &BoundComponents::lin2n},
                                                                     {"lin2t", &BoundComponents::lin2t},
                                                                     {"quad", &BoundComponents::quad},
                                                                     {"reg1", &BoundComponents::reg1},
                                                                     {"reg2n", &BoundComponents::reg2n},
                                                                     {"reg2t", &BoundComponents::reg2t}}};

/// The components of every run, in the order of all tables.
inline constexpr std::span component_names = std::span(all_component_names).first<9>();

/// Those that a regularised run has beside them.
inline constexpr std::span regularisation_names = std::span(all_component_names).last<3>();

/// Those that a run has.
[[nodiscard]] constexpr std::span<const NamedComponent> names_of_components(bool regularised)
{
  return std::span(all_component_names)
      .first(regularised ? all_component_names.size() : component_names.size());
}

/// Those of cells: quad is of the whole body.
inline constexpr bool is_of_cells(double BoundComponents::*member)
{
  return member != &BoundComponents::quad;
}

/// Those that stopping Newton's method causes.
inline constexpr std::array linearisation_components{&BoundComponents::lin1, &BoundComponents::lin2n,
                                                     &BoundComponents::lin2t};

/// What the cells add up to.
struct Bound
{
  BoundComponents global;  ///< (sum of squares over the cells)^{1/2}, component by component
  double total = 0;        ///< (sum_T total_T^2)^{1/2} + quad, as in the paper
  double total_sharp = 0;  ///< the bound with total_sharp_T: ||R(u^k)||_* <= total_sharp
};

struct Estimate : Bound
{
  std::vector<BoundComponents> cells;
};

/// Evaluates every component on every cell, for the iterates on one mesh.
template <int dim>
class Estimator
{
 public:
  /// Evaluates what depends on the data alone. C_F may be `known` from a mesh of which the form's is a
  /// refinement; it is computed if it is needed and is not.
  explicit Estimator(const contact::NitscheForm<dim>& form, ContactRule rule = ContactRule::resolved,
                     const std::optional<FriedrichsConstant>& known = {});

  /// C_F, where it is known.
  [[nodiscard]] const std::optional<FriedrichsConstant>& friedrichs() const { return friedrichs_; }

  /// The components of the iterate u with its equilibrated stress. Cells are shared out to `n_threads`
  /// threads (0: as many as OpenMP offers).
  [[nodiscard]] Estimate operator()(std::span<const double> u, const Stress<dim>& stress,
                                    int n_threads = 0) const;

  /// lin1, lin2n and lin2t of an iterate, global values, from its sigma_lin alone; the others are 0.
  [[nodiscard]] BoundComponents linearisation(const Stress<dim>& stress) const;

 private:
  void stress_terms(std::span<const double> u, const Stress<dim>& stress, int n_threads,
                    Estimate& result) const;
  void contact_terms(std::span<const double> u, const Stress<dim>& stress, Estimate& result) const;

  const contact::NitscheForm<dim>& form_;
  DataTerms data_;
  std::optional<FriedrichsConstant> friedrichs_;
  ContactTerms<dim> contact_;
  fem::Quadrature<dim> rule_;     ///< exact to degree 2p
  FrameTable<dim> stress_table_;  ///< basis of the stress at its points
  std::vector<double>
      gradient_;  ///< reference derivatives of the space's basis, [(k n_nodes + i) n_points + q]
};

/// The components of one iterate.
template <int dim>
[[nodiscard]] Estimate estimate(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                const Stress<dim>& stress, ContactRule rule = ContactRule::resolved)
{
  return Estimator<dim>(form, rule)(u, stress);
}

}  // namespace tribound::certify
