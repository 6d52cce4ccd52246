#pragma once

/// @file text.h
/// What the texts on the screen share.

#include <fmt/format.h>

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

namespace tribound::app
{

constexpr std::size_t caption_width = 14;

/// A line with a caption in the first column.
[[nodiscard]] inline std::string line(std::string_view caption, std::string_view text)
{
  return fmt::format("{:<{}}{}\n", caption, caption_width, text);
}

/// Writes to stdout at once. A reader that has gone, such as `head`, is no reason to end, nor to throw.
inline void print(std::string_view text)
{
  (void)std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

}  // namespace tribound::app
