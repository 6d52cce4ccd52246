#pragma once

/// @file vtk_legacy.h
/// The words and arrays of a .vtk, one after another.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tribound/mesh/import/vtk_file.h"

namespace tribound::mesh
{

class VtkLegacy
{
 public:
  VtkLegacy(const std::filesystem::path& path, VtkFile& file);

  void read();

 private:
  static constexpr std::string_view blanks = " \t\r\n\v\f";
  [[noreturn]] void fail(const std::string& problem, const std::string& hint = {}) const
  {
    throw InputError(where_, problem, hint);
  }
  std::string_view next_line();
  std::string_view next_word();
  /// The last one of its line, behind which an array begins.
  std::string last_word();
  std::size_t next_count();
  void read_header();
  void read_section(const std::string& word);
  void read_cells();
  void read_field();
  void read_attribute(const std::string& word);
  void read_scalars(const std::string& name);
  void read_lookup_table();
  void skip_metadata();
  /// The n * n_components numbers that follow.
  VtkArray next_array(const std::string& name, const std::string& type, std::size_t n,
                      std::size_t n_components);
  [[nodiscard]] std::size_t end_of_texts(std::size_t n) const;
  [[nodiscard]] bool is_text() const { return coding_.format == VtkCoding::Format::text; }
  [[nodiscard]] std::string type_of_colours() const { return is_text() ? "float" : "unsigned_char"; }

  Where where_;
  VtkFile& file_;
  std::string_view content_{};
  std::size_t at_ = 0;
  VtkCoding coding_{};
  double version_ = 0;
  VtkPiece piece_{};
  std::vector<VtkArray>* data_ = nullptr;  ///< of points or of cells
  std::size_t n_data_ = 0;
};

}  // namespace tribound::mesh
