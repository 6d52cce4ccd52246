#pragma once

/// @file history.h
/// The load steps of a case.

#include <string>
#include <vector>

#include "tribound/adapt/path_program.h"
#include "tribound/base/error.h"

namespace tribound::case_file
{

/// [history]: the values of t that are gone through, one after the other, and what comes after them.
struct HistoryConfig
{
  adapt::PathProgram program{.targets = {1.0}};
  std::vector<adapt::Watch> watch{};
  bool refines = true;  ///< whether the path is followed again on finer meshes
  Where where{};
};

}  // namespace tribound::case_file
