#pragma once

/// @file t2d.h
/// Problem T2D (Tresca friction on a block) and the numbers of an independent program for it.

#include <fstream>
#include <nlohmann/json.hpp>

#include "support/discrete_problem.h"
#include "support/meshes.h"

namespace tribound::test
{

/// The results in tests/verification/data/t2d.json: p = 1, 2 on four meshes.
inline nlohmann::json t2d_reference()
{
  std::ifstream file(T2D_REFERENCE);
  return nlohmann::json::parse(file).at("results");
}

inline adapt::Method t2d_method(int p)
{
  return {.degree = p, .newton = {.tolerance = 1e-12, .damping = false}};
}

inline DiscreteProblem<2> t2d(int p, int nx, int ny)
{
  return {block<2>({nx, ny}), pressed_block<2>(), t2d_method(p)};
}

}  // namespace tribound::test
