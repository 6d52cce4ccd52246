#pragma once

/// @file t2d.h
/// Problem T2D (Tresca friction on a block) and the numbers of an independent program for it.

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace tribound::test
{

/// The results in tests/verification/data/t2d.json: p = 1, 2 on four meshes.
inline nlohmann::json t2d_reference()
{
  std::ifstream file(T2D_REFERENCE);
  return nlohmann::json::parse(file).at("results");
}

inline std::string t2d_toml(int p, int nx, int ny)
{
  return "degree = " + std::to_string(p) + "\nmesh.box = { lower = [0, 0], upper = [2, 1], cells = [" +
         std::to_string(nx) + ", " + std::to_string(ny) + R"(] }
material = { E = 1.0, nu = 0.3 }
newton = { tolerance = 1e-12, damping = false }
boundary.left.displacement = [0, 0]
boundary.top.traction = [0, -0.1]
boundary.right.traction = [0.04, 0.06]
boundary.bottom.contact = { friction = "tresca", threshold = 0.03 }
)";
}

}  // namespace tribound::test
