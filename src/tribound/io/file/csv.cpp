#include "tribound/io/file/csv.h"

#include <fmt/format.h>

#include <iterator>

namespace tribound::io
{

std::string csv_cell(std::string_view value)
{
  if (value.find_first_of(",\"\n") == std::string_view::npos) return std::string(value);
  std::string cell = "\"";
  for (const char c : value) cell.append(c == '"' ? 2 : 1, c);
  return cell + '"';
}

void CsvTable::add(double value)
{
  separate();
  fmt::format_to(std::back_inserter(text_), "{}", value + 0.0);
}

void CsvTable::add(long value)
{
  separate();
  fmt::format_to(std::back_inserter(text_), "{}", value);
}

std::string csv_text(const TableRow& any, std::span<const TableRow> rows)
{
  std::string names;
  for (const TableCell& cell : any) names += (names.empty() ? "" : ",") + csv_cell(cell.name);
  CsvTable table(names);
  for (const TableRow& row : rows)
  {
    for (const TableCell& cell : row)
      std::visit([&table](const auto& value) { table.add(value); }, cell.value);
    table.end_row();
  }
  return table.text();
}

}  // namespace tribound::io
