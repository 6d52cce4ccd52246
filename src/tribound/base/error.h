#pragma once

/// @file error.h
/// The exceptions of Tribound: one for errors that the user can fix, one for computations that failed.

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace tribound
{

/// A place in the input. Fields that do not apply are empty or 0.
struct Where
{
  std::string file{};  ///< case file, mesh file, or "--set"
  std::string key{};   ///< dotted TOML key such as "boundary.top.traction", or a physical group
  int line = 0;        ///< 1-based
  int column = 0;      ///< 1-based
};

/// "file:line:column: key" with the parts that are known.
[[nodiscard]] std::string to_string(const Where& where);

/// Bad input: names the place, what is wrong there and what would be right. The program ends with exit
/// code 1.
class InputError : public std::runtime_error
{
 public:
  InputError(Where where, std::string problem, std::string hint = {});

  [[nodiscard]] const Where& where() const { return where_; }
  [[nodiscard]] const std::string& problem() const { return problem_; }
  [[nodiscard]] const std::string& hint() const { return hint_; }

 private:
  Where where_;
  std::string problem_;
  std::string hint_;
};

/// A computation that could not be carried out (singular matrix, out of memory in a library). Exit code 2.
class SolveError : public std::runtime_error
{
 public:
  using std::runtime_error::runtime_error;
};

/// The candidate closest to `word` in edit distance, or empty when none is close ("did you mean ...?").
[[nodiscard]] std::string closest(std::string_view word, std::span<const std::string> candidates);

}  // namespace tribound
