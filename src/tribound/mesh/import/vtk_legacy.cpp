#include "tribound/mesh/import/vtk_legacy.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "tribound/mesh/import/file_text.h"

namespace tribound::mesh
{

namespace
{

/// VTK writes vtkIdType as int.
constexpr std::array<std::pair<std::string_view, VtkType>, 23> legacy_types = {
    {{"char", VtkType::int8},
     {"signed_char", VtkType::int8},
     {"unsigned_char", VtkType::uint8},
     {"short", VtkType::int16},
     {"unsigned_short", VtkType::uint16},
     {"int", VtkType::int32},
     {"vtkidtype", VtkType::int32},
     {"unsigned_int", VtkType::uint32},
     {"long", VtkType::int64},
     {"unsigned_long", VtkType::uint64},
     {"float", VtkType::float32},
     {"double", VtkType::float64},
     {"vtktypeint8", VtkType::int8},
     {"vtktypeuint8", VtkType::uint8},
     {"vtktypeint16", VtkType::int16},
     {"vtktypeuint16", VtkType::uint16},
     {"vtktypeint32", VtkType::int32},
     {"vtktypeuint32", VtkType::uint32},
     {"vtktypeint64", VtkType::int64},
     {"vtktypeuint64", VtkType::uint64},
     {"vtktypefloat32", VtkType::float32},
     {"vtktypefloat64", VtkType::float64},
     {"bit", VtkType::other}}};

}  // namespace

VtkLegacy::VtkLegacy(const std::filesystem::path& path, VtkFile& file)
    : where_{.file = path.string()}, file_(file)
{
  file.contents.push_back(std::make_unique<std::string>(content_of(path, where_, {})));
  content_ = *file.contents.back();
}

std::string_view VtkLegacy::next_line()
{
  const std::string_view rest = content_.substr(at_);
  const std::string_view line = rest.substr(0, rest.find('\n'));
  at_ = std::min(at_ + line.size() + 1, content_.size());
  return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
}

/// Empty at the end of the file.
std::string_view VtkLegacy::next_word()
{
  at_ = std::min(content_.find_first_not_of(blanks, at_), content_.size());
  const std::string_view rest = content_.substr(at_);
  const std::string_view word = rest.substr(0, rest.find_first_of(blanks));
  at_ += word.size();
  return word;
}

std::string VtkLegacy::last_word()
{
  std::string word(next_word());
  (void)next_line();
  return word;
}

std::size_t VtkLegacy::next_count()
{
  const std::string_view word = next_word();
  const auto number = integer_of(word);
  if (!number || *number < 0 || *number > std::ssize(content_))
    fail(fmt::format("has \"{}\" where a number of points, cells or values is needed", word.substr(0, 40)),
         "is the file cut off?");
  return static_cast<std::size_t>(*number);
}

void VtkLegacy::read_header()
{
  constexpr std::string_view first = "# vtk DataFile Version ";
  const std::string_view line = next_line();
  const auto version = line.starts_with(first) ? number_of(line.substr(first.size(), 3)) : std::nullopt;
  if (!version || *version < 2 || *version >= 6)
    fail("does not begin with \"# vtk DataFile Version\" 2.0 to 5.1",
         "save it as .vtu, or in VTK's legacy format");
  version_ = *version;
  piece_.has_old_hexahedra = version_ < 5.1;
  (void)next_line();  // the title
  const std::string format = small_letters(next_word());
  if (format != "ascii" && format != "binary")
    fail(fmt::format("has \"{}\" where ASCII or BINARY is needed", format.substr(0, 40)));
  coding_.format = format == "ascii" ? VtkCoding::Format::text : VtkCoding::Format::raw;
  coding_.is_swapped = std::endian::native == std::endian::little;
  const std::string keyword = small_letters(next_word());
  const std::string_view type = next_word();
  if (keyword != "dataset" || small_letters(type) != "unstructured_grid")
    fail(fmt::format("has the dataset \"{}\", not UNSTRUCTURED_GRID", type.substr(0, 40)),
         "ParaView's filter Append Datasets makes an unstructured grid of other ones");
}

/// The end of n words that begin at the present place.
std::size_t VtkLegacy::end_of_texts(std::size_t n) const
{
  std::size_t end = at_;
  for (; n > 0; --n)
  {
    const std::size_t begin = content_.find_first_not_of(blanks, end);
    if (begin == std::string_view::npos) return std::string_view::npos;
    end = std::min(content_.find_first_of(blanks, begin), content_.size());
  }
  return end;
}

VtkArray VtkLegacy::next_array(const std::string& name, const std::string& type, std::size_t n,
                               std::size_t n_components)
{
  const auto known =
      std::ranges::find(legacy_types, small_letters(type), &std::pair<std::string_view, VtkType>::first);
  if (known == legacy_types.end())
    fail(fmt::format("array \"{}\" is of type \"{}\", which is not read", name, type.substr(0, 40)),
         "leave it out, or save the file as .vtu");
  const std::size_t n_bits = known->second == VtkType::other ? 1 : 8 * size_of(known->second);
  const std::size_t rest = content_.size() - at_;
  const bool is_too_long = n_components > 0 && n > 8 * rest / n_components;
  const std::size_t end = is_too_long ? std::string_view::npos
                          : is_text() ? end_of_texts(n * n_components)
                                      : at_ + (n * n_components * n_bits + 7) / 8;
  if (end > content_.size())
    fail(fmt::format("array \"{}\" ends too early", name), "the file is damaged or cut off: write it again");
  VtkArray array{name, known->second, n_components, coding_, content_.substr(at_, end - at_)};
  at_ = end;
  return array;
}

void VtkLegacy::read_section(const std::string& word)
{
  constexpr std::array<std::string_view, 10> attributes = {
      "scalars",    "vectors",      "normals",    "tensors",       "tensors6",
      "global_ids", "pedigree_ids", "edge_flags", "color_scalars", "texture_coordinates"};
  if (word == "points")
  {
    piece_.n_points = next_count();
    piece_.points = next_array("POINTS", last_word(), piece_.n_points, 3);
  }
  else if (word == "cells")
    read_cells();
  else if (word == "cell_types")
  {
    const std::size_t n = next_count();
    if (n != piece_.n_cells) fail(fmt::format("has {} CELL_TYPES for {} CELLS", n, piece_.n_cells));
    (void)next_line();
    piece_.types = next_array("CELL_TYPES", "int", n, 1);
  }
  else if (word == "cell_data" || word == "point_data")
  {
    n_data_ = next_count();
    data_ = word == "cell_data" ? &piece_.cell_data : &piece_.point_data;
    if (n_data_ != (word == "cell_data" ? piece_.n_cells : piece_.n_points))
      fail(fmt::format("has {} for {} points or cells, which is not their number", word, n_data_));
  }
  else if (word == "field")
    read_field();
  else if (word == "metadata")
    skip_metadata();
  else if (word == "lookup_table")
    read_lookup_table();
  else if (std::ranges::count(attributes, word) > 0)
    read_attribute(word);
  else
    fail(fmt::format("has \"{}\" where a keyword such as POINTS, CELLS, CELL_DATA is needed",
                     word.substr(0, 40)),
         "an array before it may have another length than the file says");
}

void VtkLegacy::read()
{
  read_header();
  for (std::string word = small_letters(next_word()); !word.empty(); word = small_letters(next_word()))
    read_section(word);
  piece_.where = where_;
  if (piece_.n_cells > 0) file_.pieces.push_back(std::move(piece_));
}

void open_vtk_legacy(const std::filesystem::path& path, VtkFile& file)
{
  VtkLegacy(path, file).read();
}

}  // namespace tribound::mesh
