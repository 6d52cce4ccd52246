#pragma once

/// @file meridian_oscillation.h
/// What loads that are no polynomials add to the energy bound of bodies of revolution.

#include <array>
#include <span>

#include "tribound/certify/energy/load_oscillation.h"

namespace tribound::certify
{

/// C_A with |(rho, w_z)_T| <= C_A ||r^{-1/2} rho||_T (int_T r (|eps(w)|^2 + (w_r / r)^2))^{1/2} for all rho
/// of mean 0 on the triangle with these vertices (r, z), r >= 0.
[[nodiscard]] double axial_constant(std::array<Point<2>, 3> vertices);

/// load_oscillation() for rho = r (f - f~), f~ of MeridianFields::load(), r (g_N - Pi g_N), Pi the projection
/// onto P^p with the weight r, and r (sigma_0 - Pi^p sigma_0) without it, with the entry around the axis. On
/// cells that touch the axis what springs lose counts with their own energy: the squares of ||w||_en,T
/// contain (r K w, w) on facets of T.
[[nodiscard]] LoadOscillation meridian_load_oscillation(const contact::NitscheForm<2>& form,
                                                        std::span<const double> u, double korn);

/// The factor of ||t - Pi t||_F in O_T min(2 mu, ...)^{1/2} for a contact traction t on facet `local`, Pi the
/// projection onto P^p; infinite on cells that touch the axis.
[[nodiscard]] double meridian_traction_constant(const contact::NitscheForm<2>& form, Index cell, int local);

}  // namespace tribound::certify
