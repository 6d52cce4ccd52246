#pragma once

/// @file sweep_values.h
/// Which cases a sweep solves.

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tribound::case_file
{

/// Keys of a case and rows of values for them, each as it would stand behind --set KEY=.
struct SweepTable
{
  std::vector<std::string> keys;
  std::vector<std::vector<std::string>> rows;  ///< a value per key
};

/// The cells of every line of comma-separated values (RFC 4180) that is not empty; a quoted cell may hold
/// commas, line breaks and doubled quotes. Throws InputError in `file` for quotes that do not match.
[[nodiscard]] std::vector<std::vector<std::string>> parse_csv(std::string_view text, const std::string& file);

/// All combinations of "key=first:last:count" (equal steps), "key=[value, ...]" and "key=value"; the first
/// key varies slowest. Throws InputError.
[[nodiscard]] SweepTable sweep_grid(std::span<const std::string> assignments);

/// From comma-separated values: a line of keys, then a line for each run. `file` stands for it in
/// messages. Throws InputError.
[[nodiscard]] SweepTable sweep_rows(std::string_view csv, const std::string& file);

}  // namespace tribound::case_file
