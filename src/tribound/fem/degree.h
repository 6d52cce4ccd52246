#pragma once

/// @file degree.h
/// The polynomial degrees of the method.

#include <string>
#include <type_traits>

#include "tribound/base/error.h"

namespace tribound::fem
{

/// The largest degree p of the method: the equilibration has kernels up to it. Spaces in which a richer
/// solution is sought may have a higher degree.
inline constexpr int max_degree = 4;

/// Throws InputError unless 1 <= p <= max_degree.
inline void require_degree(int p)
{
  if (p < 1 || p > max_degree)
    throw InputError({.file = {}, .key = "degree"}, "is " + std::to_string(p),
                     "the polynomial degree p, 1 to " + std::to_string(max_degree));
}

/// f(std::integral_constant<int, p>()) for a degree known at run time only. Throws as require_degree() does.
template <int lowest = 1, class Function>
void with_degree(int p, const Function& f)
{
  require_degree(p);
  if (p == lowest)
    f(std::integral_constant<int, lowest>());
  else if constexpr (lowest < max_degree)
    with_degree<lowest + 1>(p, f);
}

}  // namespace tribound::fem
