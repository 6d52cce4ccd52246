#pragma once

/// @file history.h
/// The load steps of a case.

#include <string>
#include <vector>

#include "tribound/adapt/path_program.h"
#include "tribound/base/error.h"

namespace tribound::case_file
{

/// Where the meshes of a path come from.
enum class Refine
{
  replay,
  transfer,
  none
};

/// [history]: the values of t that are gone through, one after the other, and what comes after them.
struct HistoryConfig
{
  adapt::PathProgram program{.targets = {1.0}};
  std::vector<adapt::Watch> watch{};
  Refine refine = Refine::replay;
  bool check = false;  ///< whether the path is followed once more, with half the steps on a finer mesh
  Where where{};
};

}  // namespace tribound::case_file
