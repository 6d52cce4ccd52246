#pragma once

/// @file history.h
/// The load steps of a case.

#include <string>
#include <vector>

#include "tribound/adapt/path_program.h"
#include "tribound/base/error.h"

namespace tribound::case_file
{

/// The origin of the meshes of a path.
enum class Refine
{
  replay,
  transfer,
  none
};

/// [history]: the sequence of values of t, and what follows them.
struct HistoryConfig
{
  adapt::PathProgram program{.targets = {1.0}};
  std::vector<adapt::Watch> watch{};
  Refine refine = Refine::replay;
  bool check = false;  ///< whether the path is followed once more, with half the steps on a finer mesh
  Where where{};
};

}  // namespace tribound::case_file
