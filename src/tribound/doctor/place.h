#pragma once

/// @file place.h

#include <vector>

#include "tribound/base/types.h"

namespace tribound::doctor
{

/// A point whose dimension is known only at run time; empty: no particular point.
using Place = std::vector<double>;

template <int dim>
[[nodiscard]] Place place(const Point<dim>& x)
{
  return {x.begin(), x.end()};
}

}  // namespace tribound::doctor
