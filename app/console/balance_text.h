#pragma once

/// @file balance_text.h
/// The balance of forces in words.

#include <string>

#include "tribound/base/types.h"
#include "tribound/case/config.h"
#include "tribound/certify/bound/balance.h"
#include "tribound/mesh/mesh.h"

namespace tribound::app
{

/// A table, for the screen. What is below 1e-9 of the largest number of its kind is shown as 0.
[[nodiscard]] std::string balance_text(const certify::Balance& balance);

/// output.moment_about, by default the centroid. Throws InputError where it has not one number per dimension.
template <int dim>
[[nodiscard]] Point<dim> moment_point(const case_file::OutputConfig& output, const mesh::Mesh<dim>& mesh);

}  // namespace tribound::app
