#pragma once

/// @file material.h
/// Linear elastic materials.

namespace tribound::problem
{

enum class PlaneModel
{
  strain,
  stress
};

/// Lame coefficients as used by sigma(u) = lambda tr eps(u) I + 2 mu eps(u); stress units.
struct Material
{
  double lambda = 0.0;
  double mu = 0.0;
  PlaneModel plane = PlaneModel::strain;  ///< 2D: whether eps_zz or sigma_zz vanishes
  double expansion = 0;                   ///< alpha: strain per temperature
};

/// lambda = E nu / ((1+nu)(1-2nu)), mu = E / (2(1+nu)); plane stress: lambda replaced by
/// 2 lambda mu / (lambda + 2 mu). E > 0, -1 < nu < 1/2.
[[nodiscard]] Material lame(double E, double nu, PlaneModel plane = PlaneModel::strain);

/// beta: the pressure that one degree causes where nothing can expand in the plane, (3 lambda + 2 mu) alpha;
/// in plane stress E alpha / (1 - nu) = (2 lambda + 2 mu) alpha.
[[nodiscard]] double thermal_modulus(const Material& material);

}  // namespace tribound::problem
