#pragma once

/// @file rank_failure.h
/// Failures of a single rank, as opposed to failures of all ranks, after which something else is tried.

#include <stdexcept>
#include <string>

#include "tribound/base/ranks.h"

namespace tribound
{

/// A failure of one rank while the others wait for it. It is neither a SolveError nor a bad_alloc: after
/// those something else might be tried.
class RankFailure : public std::runtime_error
{
 public:
  using std::runtime_error::runtime_error;
};

/// Time that a rank which gives up allows the others, which may still be writing files or freeing memory; s.
constexpr double failure_patience = 20;

/// To be called by code that catches a failure and goes on: throws RankFailure unless all ranks have failed.
inline void require_all_failed(const Ranks& ranks, const std::string& what,
                               double patience = failure_patience)
{
  if (!ranks.all_arrive(patience)) throw RankFailure(what);
}

}  // namespace tribound
