#include "tribound/case/deck/deck_log.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "tribound/base/error.h"
#include "tribound/mesh/import/file_text.h"

namespace tribound::case_file
{

std::string printable(std::string text)
{
  if (mesh::is_utf8(text)) return text;
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
  return text;
}

void DeckLog::add(const mesh::InpPlace& place, const std::string& keyword, Fate fate, const std::string& text)
{
  const bool is_known = std::ranges::any_of(remarks_,
                                            [&](const DeckRemark& other)
                                            {
                                              return other.place.file == place.file &&
                                                     other.place.line == place.line && other.fate == fate &&
                                                     other.keyword == keyword && other.text == text;
                                            });
  if (!is_known) remarks_.push_back({place, printable(keyword), fate, printable(text)});
}

void DeckLog::refuse(const mesh::InpPlace& place, const std::string& keyword, const std::string& text,
                     const std::string& hint)
{
  const Where where = lines_.where(place);
  std::string problem = fmt::format("{}:{}: *{}: {}{}", where.file, where.line, keyword, text,
                                    hint.empty() ? "" : "\n  hint: " + hint);
  if (std::ranges::find(problems_, problem) == problems_.end()) problems_.push_back(std::move(problem));
}

void DeckLog::drop(const mesh::InpPlace& place, const std::string& keyword, const std::string& text,
                   const std::string& hint)
{
  if (accepted_.contains(keyword)) return add(place, keyword, Fate::dropped, text);
  refuse(place, keyword, text,
         fmt::format("{}{}to go on without it: --accept \"{}\"", hint, hint.empty() ? "" : "; ", keyword));
}

void DeckLog::throw_problems() const
{
  constexpr std::size_t most = 20;
  if (problems_.empty()) return;
  const std::size_t n = std::min(most, problems_.size());
  std::string text = fmt::format("{}", fmt::join(problems_.begin(), problems_.begin() + n, "\n"));
  if (n < problems_.size()) text += fmt::format("\nand {} more", problems_.size() - n);
  throw InputError({}, fmt::format("the deck says what a case cannot:\n{}", text));
}

std::string DeckLog::table() const
{
  constexpr std::array<std::string_view, 4> fates = {"taken", "changed", "left out", "DROPPED"};
  std::vector<DeckRemark> sorted = remarks_;
  std::ranges::stable_sort(sorted, {},
                           [](const DeckRemark& r) { return std::pair(r.place.file, r.place.line); });
  std::string text;
  for (const DeckRemark& remark : sorted)
  {
    const Where where = lines_.where(remark.place);
    text += fmt::format(
        "# {:>5}  {:<24} {:<9} {}\n",
        remark.place.file == 0
            ? fmt::format("{}", where.line)
            : fmt::format("{}:{}", std::filesystem::path(where.file).filename().string(), where.line),
        "*" + remark.keyword, fates[static_cast<std::size_t>(remark.fate)], remark.text);
  }
  return text;
}

std::vector<std::string> DeckLog::not_covered() const
{
  std::vector<std::string> result;
  for (const DeckRemark& remark : remarks_)
    if (remark.fate == Fate::changed || remark.fate == Fate::dropped)
    {
      std::string text = fmt::format("the deck's *{}: {}", remark.keyword, remark.text);
      if (std::ranges::find(result, text) == result.end()) result.push_back(std::move(text));
    }
  return result;
}

}  // namespace tribound::case_file
