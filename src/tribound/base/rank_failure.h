#pragma once

/// @file rank_failure.h
/// Failures that one rank has alone, where something else is tried after those of all.

#include <stdexcept>
#include <string>

#include "tribound/base/ranks.h"

namespace tribound
{

/// What fails on one rank while the others wait for it: neither a SolveError nor a bad_alloc, after which
/// something else might be tried.
class RankFailure : public std::runtime_error
{
 public:
  using std::runtime_error::runtime_error;
};

/// Time that a rank which gives up leaves the others, which may still write files or free what they have; s.
constexpr double failure_patience = 20;

/// To be called by whoever catches a failure and goes on: throws RankFailure if it is not that of all ranks.
inline void require_all_failed(const Ranks& ranks, const std::string& what,
                               double patience = failure_patience)
{
  if (!ranks.all_arrive(patience)) throw RankFailure(what);
}

}  // namespace tribound
