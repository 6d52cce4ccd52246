#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "tribound/mesh/import/file_text.h"
#include "tribound/mesh/import/solution_values.h"
#include "tribound/mesh/import/text_lines.h"

namespace tribound::mesh
{

namespace
{

class CsvReader
{
 public:
  CsvReader(const std::filesystem::path& file, const SolutionChoice& choice)
      : where_{.file = file.string()},
        content_(content_of(file, where_, {})),
        lines_(content_, where_),
        displacement_(choice.field.empty() ? "u" : small_letters(choice.field)),
        stress_(choice.stress.empty() ? "s" : small_letters(choice.stress)),
        needs_stress_(!choice.stress.empty())
  {
  }

  ImportedSolution read();

 private:
  [[nodiscard]] bool next_row();
  [[nodiscard]] std::vector<std::string_view> fields_of(std::string_view line) const;
  [[nodiscard]] bool find_header();
  void read_header();
  void choose_columns();
  void choose_stress_columns();
  void note_other_columns();
  [[nodiscard]] int column(const std::string& name) const;
  [[nodiscard]] int needed(const std::string& name) const;
  [[nodiscard]] double number(std::span<const std::string_view> row, int column) const;
  void read_row();

  Where where_;
  std::string content_;
  TextLines lines_;
  std::string displacement_;  ///< the letter, or letters, before x, y, z
  std::string stress_;
  bool needs_stress_;
  char separator_ = ',';  ///< ' ': any number of blanks
  std::vector<std::string> names_{};
  std::array<int, 3> x_{};  ///< columns; -1: there is none
  std::array<int, 3> u_{};
  std::array<int, 6> s_{};
  bool has_stress_ = false;
  ImportedSolution solution_{};
};

/// Goes on to a line that is neither empty nor a comment.
bool CsvReader::next_row()
{
  while (lines_.next())
    if (const std::string_view line = trimmed(lines_.line()); !line.empty() && line[0] != '#') return true;
  return false;
}

std::vector<std::string_view> CsvReader::fields_of(std::string_view line) const
{
  std::vector<std::string_view> result;
  std::string_view rest = line.substr(0, line.find('#'));
  if (separator_ != '\t') rest = trimmed(rest);
  while (true)
  {
    const std::size_t end = separator_ == ' ' ? rest.find_first_of(" \t") : rest.find(separator_);
    std::string_view field = trimmed(rest.substr(0, end));
    if (field.size() > 1 && field.front() == '"' && field.back() == '"')
      field = trimmed(field.substr(1, field.size() - 2));
    result.push_back(field);
    if (end == std::string_view::npos) return result;
    rest.remove_prefix(end + 1);
    if (separator_ == ' ') rest = trimmed(rest);
  }
}

/// The first line, or the first comment with the columns: NumPy writes its header as a comment.
bool CsvReader::find_header()
{
  constexpr std::string_view separators = ";,\t";
  while (lines_.next())
  {
    std::string_view line = trimmed(lines_.line());
    const bool is_comment = line.starts_with('#');
    if (is_comment) line = trimmed(line.substr(1));
    if (line.empty()) continue;
    const auto separator =
        std::ranges::find_if(separators, [&](char c) { return line.find(c) != std::string_view::npos; });
    separator_ = separator == separators.end() ? ' ' : *separator;
    names_.clear();
    for (const std::string_view name : fields_of(line)) names_.push_back(small_letters(name));
    if (!is_comment || (column("x") >= 0 && column(displacement_ + "x") >= 0)) return true;
  }
  return false;
}

void CsvReader::read_header()
{
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  if (content_.starts_with(byte_order_mark)) content_.replace(0, byte_order_mark.size(), "   ");
  if (!find_header())
    throw InputError(where_, "has no rows", "a header, x,y,z,ux,uy,uz, and a row for each node");
  for (const std::string& name : names_)
  {
    if (number_of(name))
      lines_.fail("there is no header: the first row has numbers",
                  "the names of the columns, x,y,z,ux,uy,uz");
    if (!name.empty() && std::ranges::count(names_, name) > 1)
      lines_.fail(fmt::format("column \"{}\" stands there twice", name), "give one of them another name");
  }
}

int CsvReader::column(const std::string& name) const
{
  const auto found = std::ranges::find(names_, name);
  return found == names_.end() ? -1 : static_cast<int>(found - names_.begin());
}

int CsvReader::needed(const std::string& name) const
{
  const int place = column(name);
  if (place < 0)
    lines_.fail(fmt::format("there is no column \"{}\": the file has {}", name, fmt::join(names_, ", ")),
                fmt::format("in 2D x,y,{0}x,{0}y, in 3D x,y,z,{0}x,{0}y,{0}z", displacement_));
  return place;
}

void CsvReader::choose_columns()
{
  const bool is_plane = column("z") < 0 && column(displacement_ + "z") < 0;
  for (int i = 0; i < 3; ++i)
  {
    const char axis = "xyz"[i];
    x_[i] = i == 2 && is_plane ? -1 : needed(std::string(1, axis));
    u_[i] = i == 2 && is_plane ? -1 : needed(displacement_ + axis);
  }
  choose_stress_columns();
}

/// In 2D what has a z is not needed.
void CsvReader::choose_stress_columns()
{
  constexpr std::array<std::string_view, 6> components = {"xx", "yy", "zz", "xy", "yz", "xz"};
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < s_.size(); ++i)
  {
    const std::string name = stress_ + std::string(components[i]);
    s_[i] = column(name);
    has_stress_ = has_stress_ || s_[i] >= 0;
    if (s_[i] < 0 && (x_[2] >= 0 || components[i].find('z') == std::string_view::npos))
      missing.push_back(name);
  }
  solution_.stress_has_zz = s_[2] >= 0;
  if ((has_stress_ || needs_stress_) && !missing.empty())
    lines_.fail(fmt::format("the stress has no column {}: the file has {}", fmt::join(missing, ", "),
                            fmt::join(names_, ", ")),
                fmt::format("all of {0}xx,{0}yy,{0}zz,{0}xy,{0}yz,{0}xz (in 2D {0}xx,{0}yy,{0}xy), or none",
                            stress_));
}

void CsvReader::note_other_columns()
{
  std::vector<std::string> others;
  for (int i = 0; i < std::ssize(names_); ++i)
    if (std::ranges::count(x_, i) + std::ranges::count(u_, i) + std::ranges::count(s_, i) == 0)
      others.push_back(fmt::format("\"{}\"", names_[i]));
  if (!others.empty())
    solution_.notes.push_back(
        fmt::format("{}: left out are the columns {}", where_.file, fmt::join(others, ", ")));
}

/// NaN for an empty field, 0 for a column that is not there.
double CsvReader::number(std::span<const std::string_view> row, int column) const
{
  if (column < 0) return 0;
  const std::string_view field = row[column];
  if (field.empty()) return std::nan("");
  const auto value = number_of(field);
  if (!value)
    lines_.fail(
        fmt::format("column \"{}\" has \"{}\" where a number is needed", names_[column], field.substr(0, 40)),
        "numbers with a decimal point, such as 1.5e-3; no field, or nan, where there is none");
  return *value;
}

void CsvReader::read_row()
{
  const std::vector<std::string_view> row = fields_of(lines_.line());
  if (row.size() != names_.size())
    lines_.fail(fmt::format("the row has {} fields, the header {}", row.size(), names_.size()),
                "is the file cut off, or a comma the decimal point?");
  const auto values = [&](const std::array<int, 3>& columns) {
    return std::array{number(row, columns[0]), number(row, columns[1]), number(row, columns[2])};
  };
  const auto [x, y, z] = values(x_);
  if (!std::isfinite(x + y + z))
    lines_.fail("the point has no finite coordinates", "x, y and in 3D z in every row");
  solution_.mesh.nodes.emplace_back(x, y, z);
  solution_.mesh.node_numbers.push_back(lines_.number());
  solution_.displacement.push_back(displacement_of(values(u_)));
  if (!has_stress_) return;
  StressValues stress{};
  for (std::size_t i = 0; i < stress.size(); ++i) stress[i] = number(row, s_[i]);
  solution_.stress.push_back(finite_stress(stress));
}

ImportedSolution CsvReader::read()
{
  read_header();
  choose_columns();
  note_other_columns();
  while (next_row()) read_row();
  if (solution_.mesh.nodes.empty())
    throw InputError(where_, "has a header and no rows", "a row for each node");
  solution_.mesh.source = where_;
  solution_.description =
      fmt::format("table of {} points in {}D", solution_.mesh.nodes.size(), x_[2] < 0 ? 2 : 3);
  return std::move(solution_);
}

}  // namespace

ImportedSolution read_csv(const std::filesystem::path& file, const SolutionChoice& choice)
{
  return CsvReader(file, choice).read();
}

}  // namespace tribound::mesh
