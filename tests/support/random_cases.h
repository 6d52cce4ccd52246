#pragma once

/// @file random_cases.h
/// The number of random cases of a test.

#include <cstdlib>

namespace tribound::test
{

/// n, multiplied by TRIBOUND_RANDOM_CASES if that is set.
inline unsigned n_cases(unsigned n)
{
  const char* const factor = std::getenv("TRIBOUND_RANDOM_CASES");
  return factor == nullptr ? n : n * static_cast<unsigned>(std::atoi(factor));
}

}  // namespace tribound::test
