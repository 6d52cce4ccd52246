#pragma once

/// @file balance_text.h
/// The balance of forces in words.

#include <string>

#include "base/types.h"
#include "case/config.h"
#include "certify/balance.h"
#include "mesh/mesh.h"

namespace tribound
{

/// "load", "reaction", "contact", "sum".
[[nodiscard]] std::string to_string(BalanceKind kind);

/// Why moments are missing; empty where all are there.
[[nodiscard]] std::string moment_note(const Balance& balance);

/// A table, for the screen. What is below 1e-9 of the largest number of its kind is shown as 0.
[[nodiscard]] std::string balance_text(const Balance& balance);

/// output.moment_about, by default the centroid. Throws InputError where it has not one number per dimension.
template <int dim>
[[nodiscard]] Point<dim> moment_point(const OutputConfig& output, const Mesh<dim>& mesh);

}  // namespace tribound
