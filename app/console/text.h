#pragma once

/// @file text.h
/// Common functions for the texts on the screen.

#include <fmt/format.h>

#include <cstddef>
#include <optional>
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

/// line(), or nothing for an empty text.
[[nodiscard]] inline std::string line_if_any(std::string_view caption, std::string_view text)
{
  return text.empty() ? std::string{} : line(caption, text);
}

/// A text broken into lines of at most 80 characters, the later ones indented below the first.
[[nodiscard]] std::string paragraph(std::string_view caption, std::string_view text);

/// "1 cell", "2 cells".
[[nodiscard]] inline std::string count(long n, std::string_view singular, std::string_view plural)
{
  return fmt::format("{} {}", n, n == 1 ? singular : plural);
}

/// The number in a format such as "{:.3g}", or a dash.
[[nodiscard]] inline std::string number(const char* format, const std::optional<double>& value)
{
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

/// Writes to stdout at once, or to the host. If the reader is gone, such as `head`, this neither ends the
/// program nor throws.
void print(std::string_view text);
/// Writes what a reader has left out to stderr, or to the host.
void note(std::string_view text);

}  // namespace tribound::app
