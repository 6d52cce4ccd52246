#pragma once

/// @file components.h
/// The components of the bound, method section 5: their values, and one table that describes them wherever
/// they are summed, tabulated or shown.

#include <array>
#include <span>
#include <vector>

namespace tribound::certify
{

/// Global or cell values of the components; stress units times length^(dim/2).
struct BoundComponents
{
  double osc = 0;      ///< (h_T / pi) ||f - Pi^{p-1} f||
  double str = 0;      ///< ||sigma_dis - sigma(u)||, sigma(u) = C eps(u) + sigma_0
  double neu = 0;      ///< sum over Neumann facets of C_{T,F} ||g_N - Pi^p_F g_N||
  double lin1 = 0;     ///< ||sigma_lin||
  double cnt = 0;      ///< (sum h_F ||[P^n]_- - sigma_dis^n||_F^2)^{1/2}
  double frc = 0;      ///< (sum h_F ||[P^t]_S - sigma_dis^t||_F^2)^{1/2}
  double lin2n = 0;    ///< (sum h_F ||sigma_lin^n||_F^2)^{1/2}
  double lin2t = 0;    ///< (sum h_F ||sigma_lin^t||_F^2)^{1/2}
  double quad = 0;     ///< C_F ||rho||, rho the means of what quadrature may miss of the loads, and
                       ///< rigid_remainder(); of no single cell
  double alg = 0;      ///< what the linear solver has left, see algebraic_error(); not attributed to cells
  double reg1 = 0;     ///< ||sigma_reg||; like the next two, 0 unless T is regularised, method section 7
  double reg2n = 0;    ///< (sum h_F ||sigma_reg^n||_F^2)^{1/2}
  double reg2t = 0;    ///< (sum h_F ||sigma_reg^t||_F^2)^{1/2}
  double mor = 0;      ///< ||tau||: traction lost between non-matching meshes; 0 without pairs
  double str_mor = 0;  ///< ||sigma_dis + tau - sigma(u)|| <= str + mor, in total_sharp() in their place; 0
                       ///< where mor is

  /// ||sigma_dis + tau - sigma(u)||; equals str if nothing is lost between meshes.
  [[nodiscard]] double stress() const { return mor > 0 ? str_mor : str; }
  /// osc + stress() + neu + lin1 + reg1: the part of the body.
  [[nodiscard]] double body() const;
  /// ((cnt + lin2n + reg2n)^2 + (frc + lin2t + reg2t)^2)^{1/2}: the part of the contact conditions.
  [[nodiscard]] double contact() const;
  /// (a^2 + b^2)^{1/2} with a = osc + str + mor + neu + lin1 + reg1 and b = cnt + frc + lin2n + lin2t + reg2n
  /// + reg2t [FD24].
  [[nodiscard]] double total() const;
  /// The same with a = body() and b = contact(): the normal and the tangential part are orthogonal.
  [[nodiscard]] double total_sharp() const;
  /// osc + str + mor + neu + cnt + frc + quad: without the parts of Newton's method, the regularisation and
  /// the linear solver.
  [[nodiscard]] double discretisation() const { return osc + str + mor + neu + cnt + frc + quad; }
  [[nodiscard]] double linearisation() const { return lin1 + lin2n + lin2t; }
  [[nodiscard]] double regularisation() const { return reg1 + reg2n + reg2t; }
};

/// The place of a component in eta_tot = (sum_T (body^2 + normal^2 + tangential^2))^{1/2} + whole.
enum class BoundPart
{
  body,        ///< of the cells
  normal,      ///< of the cells on Gamma_C
  tangential,  ///< of the cells on Gamma_C
  combined,    ///< of the cells: the norm of a sum, in place of the norms of its terms
  whole        ///< not attributed to cells
};

/// What has to change for a component to vanish.
enum class BoundCause
{
  discretisation,  ///< the mesh, with the data on it
  linearisation,   ///< the number of Newton steps
  regularisation,  ///< delta, method section 7
  algebra          ///< the accuracy of the linear solver
};

[[nodiscard]] const char* to_string(BoundPart part);
[[nodiscard]] const char* to_string(BoundCause cause);

/// The description of a component.
struct Component
{
  const char* name;  ///< in files and tables
  double BoundComponents::*value;
  const char* meaning;  ///< what it measures, for users
  BoundPart part;
  BoundCause cause;

  [[nodiscard]] constexpr bool is_summand() const { return part != BoundPart::combined; }
  [[nodiscard]] constexpr bool is_of_cells() const { return part != BoundPart::whole; }
  [[nodiscard]] constexpr bool is_on_contact() const
  {
    return part == BoundPart::normal || part == BoundPart::tangential;
  }
};

/// In the order of all files and tables.
inline constexpr std::array<Component, 15> all_components = {{
    {"osc", &BoundComponents::osc, "data oscillation", BoundPart::body, BoundCause::discretisation},
    {"str", &BoundComponents::str, "stress", BoundPart::body, BoundCause::discretisation},
    {"neu", &BoundComponents::neu, "Neumann data", BoundPart::body, BoundCause::discretisation},
    {"lin1", &BoundComponents::lin1, "linearisation, in the body", BoundPart::body,
     BoundCause::linearisation},
    {"cnt", &BoundComponents::cnt, "contact condition", BoundPart::normal, BoundCause::discretisation},
    {"frc", &BoundComponents::frc, "friction", BoundPart::tangential, BoundCause::discretisation},
    {"lin2n", &BoundComponents::lin2n, "linearisation, normal", BoundPart::normal, BoundCause::linearisation},
    {"lin2t", &BoundComponents::lin2t, "linearisation, tangential", BoundPart::tangential,
     BoundCause::linearisation},
    {"quad", &BoundComponents::quad, "quadrature of the loads", BoundPart::whole, BoundCause::discretisation},
    {"alg", &BoundComponents::alg, "linear solver", BoundPart::whole, BoundCause::algebra},
    {"reg1", &BoundComponents::reg1, "regularisation, body", BoundPart::body, BoundCause::regularisation},
    {"reg2n", &BoundComponents::reg2n, "regularisation, normal", BoundPart::normal,
     BoundCause::regularisation},
    {"reg2t", &BoundComponents::reg2t, "regularisation, tangential", BoundPart::tangential,
     BoundCause::regularisation},
    {"mor", &BoundComponents::mor, "transfer between meshes", BoundPart::body, BoundCause::discretisation},
    {"str_mor", &BoundComponents::str_mor, "stress with transfer", BoundPart::combined,
     BoundCause::discretisation},
}};

/// The components of every run.
inline constexpr std::span plain_components = std::span(all_components).first<10>();

/// The additional components of a regularised run.
inline constexpr std::span regularisation_components = std::span(all_components).subspan<10, 3>();

/// The additional components of a run with pairs of bodies; they come last.
inline constexpr std::span transfer_components = std::span(all_components).subspan<13, 2>();

/// How a run differs from the plain method and contact with obstacles.
struct RunKind
{
  bool regularised = false;  ///< method section 7
  bool paired = false;       ///< bodies touch each other
};

/// The components of such a run.
[[nodiscard]] std::vector<Component> components_of_run(const RunKind& kind);

}  // namespace tribound::certify
