#pragma once

/// @file formula_calculus.h
/// Formulas made from formulas: substitution of coordinates, derivatives.

#include <span>
#include <string>
#include <vector>

#include "tribound/base/error.h"

namespace tribound::problem
{

/// `text` with the formulas coordinates[i] substituted for x, y, z. Throws as Formula does.
[[nodiscard]] std::string composed(const std::string& text, std::span<const std::string> coordinates,
                                   const Where& where);

/// The `dim` partial derivatives of `text`; where it jumps or kinks, those of the branch that is taken there.
/// Throws as Formula does.
[[nodiscard]] std::vector<std::string> gradient(const std::string& text, int dim, const Where& where);

}  // namespace tribound::problem
