#include "tribound/mesh/import/inp_parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>

namespace tribound::mesh
{

namespace
{

constexpr std::string_view to_split =
    "C3D4, C3D10, C3D8, C3D20, C3D6, C3D15 and C3D5; CPS, CPE and CAX with 3, 4, 6 or 8 nodes in the plane";

}  // namespace

InpParser::Handler InpParser::handler_of(const std::string& keyword)
{
  static const std::unordered_map<std::string, Handler> handlers = [&]
  {
    std::unordered_map<std::string, Handler> result = {
        {"NODE", &InpParser::read_nodes},        {"ELEMENT", &InpParser::read_elements},
        {"ELSET", &InpParser::read_element_set}, {"NSET", &InpParser::read_node_set},
        {"SURFACE", &InpParser::read_surface},   {"PART", &InpParser::begin_part},
        {"END PART", &InpParser::end_part},      {"INSTANCE", &InpParser::read_instance},
        {"INCLUDE", &InpParser::read_include}};
    for (const char* section : {"SOLID SECTION", "SHELL SECTION", "SHELL GENERAL SECTION", "MEMBRANE SECTION",
                                "BEAM SECTION", "BEAM GENERAL SECTION"})
      result[section] = &InpParser::read_section;
    for (const char* generator : {"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM"})
      result[generator] = &InpParser::refuse;
    return result;
  }();
  const auto found = handlers.find(keyword);
  return found == handlers.end() ? nullptr : found->second;
}

InpModel InpParser::parse()
{
  while (has_line_ || lines_.next())
  {
    has_line_ = false;
    if (!lines_.is_keyword()) continue;  // data of a keyword that is passed over
    const InpKeyword keyword = lines_.keyword();
    if (const Handler handler = handler_of(keyword.name))
      (this->*handler)(keyword);
    else if (options_.keeps_blocks)
      read_block(keyword);
  }
  if (part_ != 0)
    lines_.fail(part().place, fmt::format("part \"{}\" has no *END PART", part().name),
                "is the file complete?");
  return std::move(model_);
}

bool InpParser::next_data()
{
  if (has_line_) return false;
  while (lines_.next())
  {
    if (!lines_.is_keyword()) return true;
    const InpKeyword keyword = lines_.keyword();
    if (keyword.name != "INCLUDE")
    {
      has_line_ = true;
      return false;
    }
    read_include(keyword);  // the file may go on with the data
  }
  return false;
}

void InpParser::read_block(const InpKeyword& keyword)
{
  InpBlock block{keyword, part_};
  while (next_data())
  {
    const auto fields = lines_.fields();
    block.lines.push_back({lines_.place(), {fields.begin(), fields.end()}});
  }
  model_.blocks.push_back(std::move(block));
}

void InpParser::refuse(const InpKeyword& keyword)
{
  lines_.fail(keyword.place, fmt::format("*{} is not read", keyword.name),
              "write the mesh with all its nodes and elements, as preprocessors and ccx do");
}

const std::string& InpParser::checked_name(const std::string& name, const InpPlace& place) const
{
  if (!is_utf8(name))
    lines_.fail(place, "a name has bytes that are not UTF-8", "save the deck as UTF-8, or rename the set");
  return name;
}

std::int64_t InpParser::integer(std::string_view field) const
{
  const std::optional<std::int64_t> value = integer_of(field);
  if (!value) lines_.fail(lines_.place(), fmt::format("\"{}\" is not an integer", field.substr(0, 80)));
  return *value;
}

void InpParser::read_nodes(const InpKeyword& keyword)
{
  if (const auto system = keyword.find("SYSTEM"); system && !system->empty() && capitals(*system) != "R")
    lines_.fail(keyword.place, "nodes in a cylindrical or spherical system are not read",
                "write the nodes in Cartesian coordinates");
  if (const auto file = keyword.find("INPUT")) lines_.include(*file);
  const std::optional<std::string> set = keyword.find("NSET");
  const int number_of_set = set ? part().node_sets.add(checked_name(*set, keyword.place), keyword.place) : -1;
  while (next_data())
  {
    const auto fields = lines_.fields();
    if (fields.size() < 2 || fields.size() > 7)
      lines_.fail(lines_.place(), fmt::format("a node with {} numbers", fields.size()), "number, x, y, z");
    Point<3> x = Point<3>::Zero();
    for (std::size_t i = 1; i < std::min<std::size_t>(fields.size(), 4); ++i)
      if (!fields[i].empty()) x[static_cast<Index>(i) - 1] = lines_.number(fields[i], lines_.place());
    const std::int64_t n = integer(fields[0]);
    part().node_numbers.push_back(n);
    part().nodes.push_back(x);
    part().node_places.push_back(lines_.place());
    if (set) part().node_sets.all[number_of_set].add({n, n});
  }
}

void InpParser::read_elements(const InpKeyword& keyword)
{
  const std::string type = capitals(lines_.required(keyword, "TYPE"));
  InpElements elements{.type_name = type, .family = {}, .type = {}, .set = -1};
  const bool is_read = find_type(type, elements);
  if (const auto file = keyword.find("INPUT")) lines_.include(*file);
  if (const auto set = keyword.find("ELSET"))
    elements.set = part().element_sets.add(checked_name(*set, keyword.place), keyword.place);
  while (next_data())
  {
    if (!is_read && options_.ignores_elements)
    {
      elements.family = InpFamily::other;
      read_number(elements);
      continue;
    }
    if (!is_read)
      lines_.fail(
          lines_.place(),
          fmt::format("element {} is of type {}, which is not read", lines_.fields()[0].substr(0, 80), type),
          fmt::format("{}; springs, beams and rigid elements have no counterpart: ignore_elements = true "
                      "leaves them out",
                      to_split));
    read_element(elements);
  }
  if (!elements.numbers.empty()) part().elements.push_back(std::move(elements));
}

/// An element, whose nodes may go on in the next lines.
void InpParser::read_element(InpElements& elements)
{
  const auto n_nodes = static_cast<std::size_t>(elements.type.n_nodes);
  const InpPlace place = lines_.place();
  std::span<const std::string_view> fields = lines_.fields();
  const std::int64_t element = integer(fields[0]);
  fields = fields.subspan(1);
  const auto fail = [&](const std::string& problem)
  { lines_.fail(place, fmt::format("element {} ({}) {}", element, elements.type_name, problem)); };
  std::size_t n = 0;
  while (true)
  {
    for (const std::string_view field : fields) elements.nodes.push_back(integer(field));
    n += fields.size();
    if (n > n_nodes) fail(fmt::format("has more than {} nodes", n_nodes));
    if (n == n_nodes) break;
    if (!next_data()) fail(fmt::format("has only {} of its {} nodes", n, n_nodes));
    fields = lines_.fields();
  }
  add_number(elements, element, place);
}

/// The number of an element of unknown type; a line that ends with a comma goes on in the next one.
void InpParser::read_number(InpElements& elements)
{
  const InpPlace place = lines_.place();
  const std::int64_t element = integer(lines_.fields()[0]);
  while (lines_.text().ends_with(',') && next_data())
  {
  }
  add_number(elements, element, place);
}

void InpParser::add_number(InpElements& elements, std::int64_t element, const InpPlace& place)
{
  elements.numbers.push_back(element);
  elements.places.push_back(place);
  if (elements.set >= 0) part().element_sets.all[elements.set].add({element, element});
}

InpModel parse_inp(InpLines& lines, const InpOptions& options)
{
  return InpParser(lines, options).parse();
}

}  // namespace tribound::mesh
