#pragma once

/// @file parallel.h
/// Loops shared out to threads.

#include <cstddef>
#include <functional>

namespace tribound
{

/// body(i) for i = 0, ..., n - 1, shared out to the threads that OpenMP offers if there are enough of them.
/// Of the exceptions thrown, the one with the smallest i is thrown on, so that a message does not depend on
/// the number of threads.
void parallel_for(std::size_t n, const std::function<void(std::size_t)>& body);

/// work(i) for i = 0, ..., n - 1, each in a thread of its own. Of the exceptions thrown, that of the smallest
/// i is thrown on.
void in_threads(int n, const std::function<void(int)>& work);

}  // namespace tribound
