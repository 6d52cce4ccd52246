#pragma once

/// @file contact_tangent.h
/// The derivative of the contact forces against differences.

#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "support/fields.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::test
{

/// At u, in a random direction.
template <int dim>
void expect_contact_tangent(const contact::NitscheForm<dim>& form, std::span<const double> u, double step)
{
  const std::vector<double> w = random_free_vector(form.constraints(), 1, 2);
  const auto forces = [&](const std::vector<double>& at)
  {
    std::vector<double> result(form.space().n_dofs(), 0.0);
    form.add_contact_load(form.traction(at), result);
    return free_part(form.constraints(), result);
  };
  const std::vector<double> difference = sum(forces(sum(u, step, w)), -1, forces(sum(u, -step, w)));
  const std::vector<double> product = multiply(form.contact_tangent(contact::Linearisation::newton, u), w);
  EXPECT_GT(norm(product), 0);
  EXPECT_LE(norm(sum(product, 1 / (2 * step), difference)), 1e-6 * norm(product));
}

}  // namespace tribound::test
