#pragma once

/// @file sweep_values.h
/// The cases that a sweep solves.

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tribound::case_file
{

/// Keys of a case and rows of values for them, as written after --set KEY=.
struct SweepTable
{
  std::vector<std::string> keys;
  std::vector<std::vector<std::string>> rows;  ///< one value per key
};

/// The cells of every nonempty line of comma-separated values (RFC 4180). A quoted cell may contain commas,
/// line breaks and doubled quotes. Throws InputError in `file` for unbalanced quotes.
[[nodiscard]] std::vector<std::vector<std::string>> parse_csv(std::string_view text, const std::string& file);

/// All combinations of "key=first:last:count" (equal steps), "key=[value, ...]" and "key=value"; the first
/// key varies slowest. Throws InputError.
[[nodiscard]] SweepTable sweep_grid(std::span<const std::string> assignments);

/// From comma-separated values: a line of keys, then a line for each run. Messages give `file` for it. Throws
/// InputError.
[[nodiscard]] SweepTable sweep_rows(std::string_view csv, const std::string& file);

}  // namespace tribound::case_file
