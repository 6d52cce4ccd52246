#pragma once

/// @file meridian_equilibrator.h
/// The implementation of Equilibrator for axisymmetric problems: Stress has tau = r sigma, of degree p + 1.

#include <memory>
#include <vector>

#include "tribound/certify/equilibrate/mesh_equilibrator.h"

namespace tribound::certify
{

/// Arguments are those of make_mesh_equilibrator().
[[nodiscard]] std::unique_ptr<Equilibrator<2>::Implementation> make_meridian_equilibrator(
    const contact::NitscheForm<2>& form, int n_threads, bool by_rows, std::vector<StressMetric> metrics);

}  // namespace tribound::certify
