#pragma once

/// @file damaged.h
/// Texts damaged at random.

#include <cstddef>
#include <random>
#include <string>

namespace tribound::test
{

/// Up to three damages: a byte changed, a piece copied, a piece lost, a long number put in, the end lost.
[[nodiscard]] inline std::string damaged(std::string text, std::mt19937& random)
{
  const auto below = [&](std::size_t n)
  { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  for (std::size_t n = below(4); n > 0; --n)
  {
    const std::size_t at = below(text.size());
    switch (below(5))
    {
      case 0:
        text[at] = static_cast<char>(below(256));
        break;
      case 1:
        text.insert(at, text.substr(below(text.size()), below(40)));
        break;
      case 2:
        text.erase(at, 1 + below(20));
        break;
      case 3:
        text.insert(at, std::to_string(random()) + std::to_string(random()));
        break;
      default:
        text.resize(at + 1);
    }
    if (text.empty()) text = "*";
  }
  return text;
}

}  // namespace tribound::test
