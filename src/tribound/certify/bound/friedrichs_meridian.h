#pragma once

/// @file friedrichs_meridian.h
/// The Friedrichs constant of bodies of revolution, method section 19.3.

#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::certify
{

/// C_F with ||v|| <= C_F ||v||_{C,h} on the meridian of an axisymmetric problem,
///     ||v||^2 = int r |v|^2,   ||v||_{C,h}^2 = int r (|grad v|^2 + (v_r / r)^2)
///                                              + sum_{F in C} (1/h_F) int_F r |v|^2 + sum_k (1/h_k) int_k r
///                                              |[v]|^2,
/// for this mesh and its refinements; infinite if a body has no facet where u_z is prescribed or in contact.
/// C_F = max(R, C_z), R the largest r, since ||v_r|| <= R ||v_r / r||.
///
/// C_z: let m be means with the weight r. In a cell, |m_T - m_F| <= c_{T,F} ||grad v||_T with the constant of
/// the trace over |F|_r^{1/2}; between bodies |m_F - m_F'| <= (h_k / |F|_r)^{1/2} g_k with g_k^2 = (1/h_k)
/// int_k r [v]^2, as if that were one more step. Each cell T is joined through facets with a root: a facet
/// with m_F = 0, or one in contact, where |m_F| <= (h_F / |F|_r)^{1/2} g_F, g_F^2 = (1/h_F) int_F r v^2. On
/// this path m_T is the sum of at most c_e g_e, g_e = ||grad v|| on a cell with c_e the sum of its two
/// c_{T,F}, of T itself one, or g_F. So m_T^2 <= L_T sum g_e^2, L_T = sum c_e^2, and
///     ||v_z||^2 = sum_T (||v_z - m_T||_T^2 + |T|_r m_T^2) <= sum_T ((h_T/pi)^2 ||grad v_z||_T^2 + |T|_r L_T
///     sum_e g_e^2)
/// bounds it by g_T^2 times (h_T/pi)^2 + S_T and g_F^2 times S_F, S the sums of |T'|_r L_T' over the cells T'
/// whose paths use g. C_z^2 is the largest of these numbers.
[[nodiscard]] double meridian_friedrichs(const problem::Problem<2>& problem, const mesh::Mesh<2>& mesh);

}  // namespace tribound::certify
