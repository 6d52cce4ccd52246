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

}  // namespace tribound
