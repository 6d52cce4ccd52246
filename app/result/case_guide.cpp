#include "app/result/case_guide.h"

#include <algorithm>
#include <sstream>
#include <vector>

namespace tribound::app
{

namespace
{

/// "[text](address)" becomes "text".
std::string without_links(std::string text)
{
  for (std::size_t middle = text.find("]("); middle != std::string::npos; middle = text.find("](", middle))
  {
    const std::size_t end = text.find(')', middle);
    std::size_t begin = middle;
    for (int depth = 1; depth > 0 && begin > 0;)
    {
      --begin;
      if (text[begin] == ']') ++depth;
      if (text[begin] == '[') --depth;
    }
    if (end == std::string::npos) return text;
    text.erase(middle, end - middle + 1);
    text.erase(begin, 1);
    --middle;
  }
  return text;
}

std::string trimmed(std::string_view text)
{
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return without_links(std::string(text.substr(first, text.find_last_not_of(' ') - first + 1)));
}

/// The cells of "| a | b |".
std::vector<std::string> cells_of(const std::string& line)
{
  std::vector<std::string> cells;
  std::istringstream stream(line.substr(1));
  for (std::string cell; std::getline(stream, cell, '|');) cells.push_back(trimmed(cell));
  return cells;
}

/// The texts in backquotes.
std::vector<std::string> quoted(const std::string& text)
{
  std::vector<std::string> words;
  std::istringstream stream(text);
  std::string word;
  for (bool inside = false; std::getline(stream, word, '`'); inside = !inside)
    if (inside) words.push_back(word);
  return words;
}

/// The table named by a heading, as in "## [[contact]]".
std::string table_of(const std::string& heading)
{
  const std::size_t first = heading.find_first_not_of('[', heading.find('['));
  return first == std::string::npos ? "" : heading.substr(first, heading.find(']') - first);
}

std::string dotted(const std::string& table, const std::string& key)
{
  return table.empty() ? key : table + "." + key;
}

class Reader
{
 public:
  void line(const std::string& line)
  {
    if (line.starts_with("```")) in_code_ = !in_code_;
    if (in_code_ || line.starts_with("```")) return;
    if (line.starts_with("#"))
      heading(line);
    else if (line.starts_with("|"))
      row(cells_of(line));
    else
      prose(line);
  }
  [[nodiscard]] const CaseGuide& guide() const { return guide_; }

 private:
  void heading(const std::string& line)
  {
    columns_.clear();
    says_ = !line.starts_with("## [");
    if (line.starts_with("## ")) section_ = table_of(line);
  }

  void row(const std::vector<std::string>& cells)
  {
    if (columns_.empty())
    {
      columns_ = cells;
      const std::vector<std::string> inner = quoted(cells[0]);
      table_ = inner.empty() ? section_ : dotted(section_, inner[0]);
      return;
    }
    if (!columns_[0].starts_with("key") || cells.size() < columns_.size()) return;
    const auto cell = [&](std::string_view column) -> std::string
    {
      const auto place = std::ranges::find(columns_, column) - columns_.begin();
      return place < std::ssize(columns_) ? cells[static_cast<std::size_t>(place)] : std::string();
    };
    for (const std::string& key : quoted(cells[0]))
      guide_.keys[dotted(table_, key)] = {cell("default"), cell("meaning")};
  }

  /// The first sentence of a section.
  void prose(const std::string& line)
  {
    columns_.clear();
    if (says_) return;
    std::string& text = guide_.tables[section_];
    text += (text.empty() || line.empty() ? "" : " ") + line;
    const std::size_t end = text.find(". ");
    says_ = end != std::string::npos || (line.empty() && !text.empty());
    if (says_) text = without_links(text.substr(0, end == std::string::npos ? end : end + 1));
  }

  CaseGuide guide_;
  std::string section_;
  std::string table_;
  std::vector<std::string> columns_;
  bool in_code_ = false;
  bool says_ = true;  ///< whether the sentence of the section is complete
};

}  // namespace

CaseGuide read_case_guide(std::string_view markdown)
{
  Reader reader;
  std::istringstream stream{std::string(markdown)};
  for (std::string line; std::getline(stream, line);) reader.line(line);
  return reader.guide();
}

}  // namespace tribound::app
