#pragma once

/// @file deck_log.h
/// What becomes of the keywords of a deck.

#include <set>
#include <string>
#include <vector>

#include "tribound/mesh/import/inp_lines.h"

namespace tribound::case_file
{

enum class Fate : char
{
  taken,
  changed,   ///< the case does something else: its results say so
  left_out,  ///< nothing depends on it
  dropped    ///< the answer depends on it: its results say so
};

struct DeckRemark
{
  mesh::InpPlace place;
  std::string keyword;  ///< "CONTACT PAIR"
  Fate fate;
  std::string text;
};

/// Text of a deck as it can stand in a case: question marks for what is not UTF-8, or no text at all.
[[nodiscard]] std::string printable(std::string text);

/// Collects remarks and problems. Keeps a reference to the lines.
class DeckLog
{
 public:
  /// `accepted`: keywords, in capitals, that may be dropped although the answer depends on them.
  DeckLog(const mesh::InpLines& lines, std::set<std::string> accepted)
      : lines_(lines), accepted_(std::move(accepted))
  {
  }

  /// The same remark twice is one.
  void add(const mesh::InpPlace& place, const std::string& keyword, Fate fate, const std::string& text);
  /// The answer depends on something that cannot be had: a problem, unless the keyword is accepted.
  void drop(const mesh::InpPlace& place, const std::string& keyword, const std::string& text,
            const std::string& hint = {});
  /// A problem in any case.
  void refuse(const mesh::InpPlace& place, const std::string& keyword, const std::string& text,
              const std::string& hint = {});
  /// Throws InputError with all problems, if there are any.
  void throw_problems() const;

  /// The remarks in the order of the lines, as comments of a TOML file.
  [[nodiscard]] std::string table() const;
  /// What the results must say: everything changed or dropped.
  [[nodiscard]] std::vector<std::string> not_covered() const;
  [[nodiscard]] const std::vector<DeckRemark>& remarks() const { return remarks_; }

 private:
  const mesh::InpLines& lines_;
  std::set<std::string> accepted_;
  std::vector<DeckRemark> remarks_{};
  std::vector<std::string> problems_{};
};

}  // namespace tribound::case_file
