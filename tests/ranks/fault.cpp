/// @file fault.cpp
/// A program in which something goes wrong on one rank, as its argument says. What do the others do?

#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>
#include <thread>

#include "tribound/algebra/petsc.h"
#include "tribound/base/error.h"
#include "tribound/base/rank_failure.h"
#include "tribound/base/ranks.h"

namespace
{

using tribound::Ranks;

/// Rank 1 throws where all have agreed to listen.
int throw_together(const Ranks& ranks)
{
  try
  {
    ranks.together(
        [&]
        {
          if (ranks.rank() == 1) throw tribound::InputError({}, "a formula", "another one");
        });
  }
  catch (const tribound::InputError& error)
  {
    const bool all = ranks.all_arrive(10);
    if (ranks.is_first()) std::printf("%s %s\n", all ? "all:" : "not all:", error.what());
    return 1;
  }
  return 0;
}

/// Rank 1 throws where nobody listens; the others wait for its numbers.
int throw_alone(const Ranks& ranks)
{
  try
  {
    if (ranks.rank() == 1) throw tribound::SolveError("alone");
    return ranks.sum(1.0) > 0 ? 0 : 1;
  }
  catch (const tribound::SolveError& error)
  {
    if (ranks.all_arrive(0.5)) return 0;
    std::printf("process %d: %s\n", ranks.rank(), error.what());
    std::fflush(stdout);
    Ranks::end_all(2);
  }
}

/// Rank 1 fails alone where all ranks are expected to fail together and try something else.
int fail_alone(const Ranks& ranks)
{
  try
  {
    if (ranks.rank() == 1) tribound::require_all_failed(ranks, "out of memory", 0.5);
    return ranks.sum(1.0) > 0 ? 0 : 1;
  }
  catch (const tribound::RankFailure& error)
  {
    std::printf("process %d: %s\n", ranks.rank(), error.what());
    std::fflush(stdout);
    Ranks::end_all(2);
  }
}

/// Rank 1 is killed.
int die(const Ranks& ranks)
{
  if (ranks.rank() == 1) std::raise(SIGKILL);
  std::this_thread::sleep_for(std::chrono::seconds(100));
  return 0;
}

}  // namespace

int main(int, char** argv)
{
  const tribound::algebra::Environment environment;
  const Ranks ranks = Ranks::world();
  const std::string what = argv[1];
  if (what == "throw_together") return throw_together(ranks);
  if (what == "throw_alone") return throw_alone(ranks);
  if (what == "fail_alone") return fail_alone(ranks);
  return die(ranks);
}
