#pragma once

/// @file parallel.h
/// Loops distributed to threads.

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

namespace tribound
{

/// How many threads OpenMP offers here.
[[nodiscard]] int max_threads();
/// From now on at most `n` threads.
void set_max_threads(int n);

/// body(i) for i = 0, ..., n - 1, distributed to the threads that OpenMP offers, `grain` at a time, if n is
/// large enough. Of the exceptions thrown, that of the smallest i is rethrown, so that a message does not
/// depend on the number of threads.
void parallel_for(std::size_t n, const std::function<void(std::size_t)>& body, int grain = 64);

/// zero + term(0) + ... + term(n - 1), distributed to threads. The order of the sum depends on n alone, and
/// so does its round-off.
template <class Sum, class Term>
[[nodiscard]] Sum parallel_sum(std::size_t n, const Sum& zero, const Term& term)
{
  constexpr std::size_t block = 64;
  std::vector<Sum> sums((n + block - 1) / block, zero);
  parallel_for(
      sums.size(),
      [&](std::size_t b)
      {
        for (std::size_t i = b * block; i < std::min(n, (b + 1) * block); ++i) sums[b] += term(i);
      },
      1);
  Sum sum = zero;
  for (const Sum& of_block : sums) sum += of_block;
  return sum;
}

/// work(i) for i = 0, ..., n - 1, each in a thread of its own. Of the exceptions thrown, that of the smallest
/// i is rethrown.
void in_threads(int n, const std::function<void(int)>& work);

}  // namespace tribound
