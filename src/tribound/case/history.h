#pragma once

/// @file history.h
/// The load steps of a case.

#include <vector>

#include "tribound/base/error.h"

namespace tribound::case_file
{

/// [history]: the values of t that are gone through, one after the other.
struct HistoryConfig
{
  std::vector<double> steps = {1.0};
  Where where{};
};

}  // namespace tribound::case_file
