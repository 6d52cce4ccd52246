#pragma once

/// @file dense_patch.h
/// The equilibrated stress a second time, as plainly as method section 4 states it: per vertex one dense
/// minimum norm problem over the broken stresses of the patch. Shares no code with src/certify but the type
/// of the result. Can be told to make one mistake, to see which check notices.

#include <span>

#include "tribound/certify/equilibrate/stress.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::test
{

enum class Mutation
{
  none,
  sign_of_f,           ///< + psi_a f in b
  sign_of_t,           ///< - psi_a g_N and - psi_a T(u) on the facets
  no_y,                ///< y_a = 0
  no_y_in_lin,         ///< y_a in the dis problem only
  coarse_rule_for_t,   ///< T(u) with a rule exact to degree p only
  one_patch_left_out,  ///< a vertex of Gamma_C
  t_replaced_by_T,     ///< T(u^k) for t^k
  no_lin               ///< sigma_lin = 0
};

/// sigma_dis and sigma_lin of the iterate u^k with running traction t^k, method section 4; `patches`: rows
/// (section 4.6) or afw. The integrals are those of the form: the same rules in the same order of the
/// vertices.
template <int dim>
[[nodiscard]] certify::Stress<dim> dense_equilibrate(const contact::NitscheForm<dim>& form,
                                                     std::span<const double> u, std::span<const Point<dim>> t,
                                                     certify::PatchStress patches,
                                                     Mutation mutation = Mutation::none);

}  // namespace tribound::test
