#pragma once

/// @file inp_parser.h
/// The keywords of a deck that say something about its mesh.

#include <cstdint>
#include <string>
#include <string_view>

#include "tribound/mesh/import/inp_lines.h"
#include "tribound/mesh/import/inp_model.h"

namespace tribound::mesh
{

class InpParser
{
 public:
  InpParser(InpLines& lines, const InpOptions& options) : lines_(lines), options_(options) {}

  InpModel parse();

 private:
  using Handler = void (InpParser::*)(const InpKeyword&);

  static Handler handler_of(const std::string& keyword);

  InpPart& part() { return model_.parts[part_]; }
  /// Goes on to the next line of data of the present keyword; false if there is none.
  bool next_data();
  void read_nodes(const InpKeyword& keyword);
  void read_elements(const InpKeyword& keyword);
  void read_element(InpElements& elements);
  void read_number(InpElements& elements);
  void add_number(InpElements& elements, std::int64_t element, const InpPlace& place);
  void read_element_set(const InpKeyword& keyword) { read_set(keyword, part().element_sets, "ELSET"); }
  void read_node_set(const InpKeyword& keyword) { read_set(keyword, part().node_sets, "NSET"); }
  void read_set(const InpKeyword& keyword, InpSets& sets, const std::string& parameter);
  void read_surface(const InpKeyword& keyword);
  void read_section(const InpKeyword& keyword);
  void begin_part(const InpKeyword& keyword);
  void end_part(const InpKeyword& keyword);
  void read_instance(const InpKeyword& keyword);
  void read_include(const InpKeyword& keyword) { lines_.include(keyword.find("INPUT").value_or("")); }
  void read_block(const InpKeyword& keyword);
  void refuse(const InpKeyword& keyword);

  /// A name that can be shown.
  [[nodiscard]] const std::string& checked_name(const std::string& name, const InpPlace& place) const;
  /// "5", "body", "part-1.5" or "part-1.body" as members of sets of one kind.
  [[nodiscard]] InpMembers members_of(std::string_view field, int instance, InpSets InpPart::*kind) const;
  [[nodiscard]] std::int64_t integer(std::string_view field) const;

  InpLines& lines_;
  InpOptions options_;
  InpModel model_{};
  int part_ = 0;
  bool has_line_ = false;  ///< the present line has not been dealt with
};

}  // namespace tribound::mesh
