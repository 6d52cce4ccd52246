#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "tribound/mesh/import/file_text.h"
#include "tribound/mesh/import/vtk_legacy.h"

namespace tribound::mesh
{

namespace
{

/// "gmsh%3Aphysical" is "gmsh:physical".
std::string without_percents(std::string_view word)
{
  const auto digit = [](char c)
  {
    return std::string_view("0123456789abcdef")
        .find(static_cast<char>(c >= 'A' && c <= 'F' ? c - 'A' + 'a' : c));
  };
  std::string result;
  for (std::size_t i = 0; i < word.size(); ++i)
    if (word[i] == '%' && i + 2 < word.size() && digit(word[i + 1]) < 16 && digit(word[i + 2]) < 16)
    {
      result += static_cast<char>(16 * digit(word[i + 1]) + digit(word[i + 2]));
      i += 2;
    }
    else
      result += word[i];
  return result;
}

}  // namespace

void VtkLegacy::read_cells()
{
  const std::size_t n = next_count();
  const std::size_t size = next_count();
  if (version_ < 5)
  {
    piece_.n_cells = n;
    piece_.n_connectivity = size;
    (void)next_line();
    piece_.connectivity = next_array("CELLS", "int", size, 1);
    return;
  }
  piece_.n_cells = n == 0 ? 0 : n - 1;
  piece_.begins_with_zero = true;
  for (const auto& [name, array, count] :
       {std::tuple{"offsets", &piece_.offsets, n}, std::tuple{"connectivity", &piece_.connectivity, size}})
  {
    if (n == 0) return;
    const std::string_view word = next_word();
    if (small_letters(word) != name)
      fail(fmt::format("has \"{}\" where the {} of the cells are needed", word.substr(0, 40), name));
    *array = next_array(name, last_word(), count, 1);
    if (!is_integer(array->type)) fail(fmt::format("the {} of the cells are no integers", name));
  }
}

void VtkLegacy::read_field()
{
  (void)next_word();  // its name
  for (std::size_t n = next_count(); n > 0; --n)
  {
    std::string_view word = next_word();
    if (word == "METADATA")
    {
      skip_metadata();
      word = next_word();
    }
    const std::string name = without_percents(word);
    const std::size_t n_components = next_count();
    const std::size_t n_tuples = next_count();
    VtkArray array = next_array(name, last_word(), n_tuples, n_components);
    if (data_ && n_tuples == n_data_) data_->push_back(std::move(array));
  }
}

void VtkLegacy::skip_metadata()
{
  (void)next_line();
  while (at_ < content_.size() && !next_line().empty()) continue;
}

/// "SCALARS name type n", n may be missing; then "LOOKUP_TABLE name".
void VtkLegacy::read_scalars(const std::string& name)
{
  const std::string type(next_word());
  const std::string_view line = next_line();
  const std::size_t digit = std::min(line.find_first_not_of(blanks), line.size());
  const std::size_t n_components =
      digit < line.size() && line[digit] >= '1' && line[digit] <= '9' ? line[digit] - '0' : 1;
  const std::size_t begin = at_;
  if (small_letters(next_word()) == "lookup_table")
    (void)next_line();
  else
    at_ = begin;
  data_->push_back(next_array(name, type, n_data_, n_components));
}

/// A table of colours, RGBA.
void VtkLegacy::read_lookup_table()
{
  (void)next_word();
  const std::size_t n = next_count();
  (void)next_line();
  (void)next_array("LOOKUP_TABLE", type_of_colours(), n, 4);
}

void VtkLegacy::read_attribute(const std::string& word)
{
  if (!data_) fail(fmt::format("has {} before POINT_DATA and CELL_DATA", word));
  const std::string name = without_percents(next_word());
  if (word == "scalars") return read_scalars(name);
  std::size_t n_components = word == "tensors" ? 9 : word == "tensors6" ? 6 : 3;
  if (word == "global_ids" || word == "pedigree_ids" || word == "edge_flags") n_components = 1;
  if (word == "texture_coordinates" || word == "color_scalars") n_components = next_count();
  const std::string type = word == "color_scalars" ? type_of_colours() : std::string(next_word());
  (void)next_line();
  data_->push_back(next_array(name, type, n_data_, n_components));
}

}  // namespace tribound::mesh
