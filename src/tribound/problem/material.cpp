#include "tribound/problem/material.h"

namespace tribound::problem
{

Material lame(double E, double nu, PlaneModel plane)
{
  const double mu = E / (2 * (1 + nu));
  const double lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  if (plane == PlaneModel::strain) return {lambda, mu};
  return {2 * lambda * mu / (lambda + 2 * mu), mu, plane};
}

double thermal_modulus(const Material& material)
{
  const int free_directions = material.plane == PlaneModel::stress ? 2 : 3;
  return (free_directions * material.lambda + 2 * material.mu) * material.expansion;
}

}  // namespace tribound::problem
