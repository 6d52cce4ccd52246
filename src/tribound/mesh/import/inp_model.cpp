#include "tribound/mesh/import/inp_model.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

namespace tribound::mesh
{

void InpSet::add(const InpMembers& more)
{
  if (!members.empty())
  {
    InpMembers& last = members.back();
    const bool is_next = more.set < 0 && last.set < 0 && more.instance == last.instance && !more.may_miss &&
                         !last.may_miss && more.first == more.last && more.first == last.last + 1;
    if (is_next)
    {
      last.last = more.last;
      return;
    }
  }
  members.push_back(more);
}

int InpSets::find(std::string_view name) const
{
  const auto found = by_name.find(capitals(name));
  return found == by_name.end() ? -1 : found->second;
}

int InpSets::add(std::string_view name, const InpPlace& place)
{
  const auto [it, is_new] = by_name.try_emplace(capitals(name), static_cast<int>(all.size()));
  if (is_new) all.push_back({std::string(name), place});
  return it->second;
}

namespace
{

struct FamilyName
{
  std::string_view prefix;
  InpFamily family;
};

/// The first that fits counts.
constexpr std::array<FamilyName, 11> family_names = {{{"C3D", InpFamily::solid},
                                                      {"CPS", InpFamily::plane},
                                                      {"CPEG", InpFamily::plane},
                                                      {"CPE", InpFamily::plane},
                                                      {"M3D", InpFamily::shell},
                                                      {"SFM3D", InpFamily::shell},
                                                      {"STRI", InpFamily::shell},
                                                      {"DS", InpFamily::shell},
                                                      {"S", InpFamily::shell},
                                                      {"T3D", InpFamily::truss},
                                                      {"T2D", InpFamily::truss}}};

/// By the number of nodes in the name, "C3D20R": the letters behind it concern the integration.
bool find_type(std::string_view name, InpElements& elements)
{
  const auto* family =
      std::ranges::find_if(family_names, [&](const FamilyName& f) { return name.starts_with(f.prefix); });
  if (family == family_names.end()) return false;
  const std::string_view rest = name.substr(family->prefix.size());
  int n = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), n);
  if (error != std::errc{}) return false;
  if (family->family == InpFamily::solid && rest.starts_with("15V")) n = 18;
  elements.family = family->family;
  const auto has_dim = [&](int dim)
  {
    return family->family == InpFamily::solid   ? dim == 3
           : family->family == InpFamily::truss ? dim == 1
                                                : dim == 2;
  };
  for (const Shape shape : {Shape::segment, Shape::triangle, Shape::quadrilateral, Shape::tetrahedron,
                            Shape::hexahedron, Shape::prism, Shape::pyramid})
    if (has_dim(table_of(shape).dim) && is_known({shape, n}))
    {
      elements.type = {shape, n};
      return true;
    }
  return false;
}

constexpr std::string_view to_split =
    "C3D4, C3D10, C3D8, C3D20, C3D6, C3D15 and C3D5; CPS and CPE with 3, 4, 6 or 8 nodes in the plane";

class InpParser
{
 public:
  explicit InpParser(InpLines& lines) : lines_(lines) {}

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
  void read_element_set(const InpKeyword& keyword) { read_set(keyword, part().element_sets, "ELSET"); }
  void read_node_set(const InpKeyword& keyword) { read_set(keyword, part().node_sets, "NSET"); }
  void read_set(const InpKeyword& keyword, InpSets& sets, const std::string& parameter);
  void read_surface(const InpKeyword& keyword);
  void read_section(const InpKeyword& keyword);
  void begin_part(const InpKeyword& keyword);
  void end_part(const InpKeyword& keyword);
  void read_instance(const InpKeyword& keyword);
  void read_include(const InpKeyword& keyword) { lines_.include(keyword.find("INPUT").value_or("")); }
  void refuse(const InpKeyword& keyword);

  [[nodiscard]] std::string required(const InpKeyword& keyword, std::string_view parameter) const;
  /// A name that can be shown.
  [[nodiscard]] const std::string& checked_name(const std::string& name, const InpPlace& place) const;
  [[nodiscard]] int instance_named(std::string_view name) const;
  /// "5", "body", "part-1.5" or "part-1.body" as members of sets of one kind.
  [[nodiscard]] InpMembers members_of(std::string_view field, int instance, InpSets InpPart::*kind) const;
  [[nodiscard]] std::int64_t integer(std::string_view field) const;
  [[nodiscard]] double number(std::string_view field) const;

  InpLines& lines_;
  InpModel model_{};
  int part_ = 0;
  bool has_line_ = false;  ///< the present line has not been dealt with
};

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
    if (const Handler handler = handler_of(keyword.name)) (this->*handler)(keyword);
  }
  if (part_ != 0)
    lines_.fail(part().place, fmt::format("part \"{}\" has no *END PART", part().name),
                "is the file complete?");
  return std::move(model_);
}

bool InpParser::next_data()
{
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

void InpParser::refuse(const InpKeyword& keyword)
{
  lines_.fail(keyword.place, fmt::format("*{} is not read", keyword.name),
              "write the mesh with all its nodes and elements, as preprocessors and ccx do");
}

std::string InpParser::required(const InpKeyword& keyword, std::string_view parameter) const
{
  const std::optional<std::string> value = keyword.find(parameter);
  if (!value || value->empty())
    lines_.fail(keyword.place, fmt::format("*{} without {}", keyword.name, parameter),
                fmt::format("*{}, {}=...", keyword.name, parameter));
  return *value;
}

const std::string& InpParser::checked_name(const std::string& name, const InpPlace& place) const
{
  for (std::size_t i = 0; i < name.size(); ++i)
  {
    const auto byte = static_cast<unsigned char>(name[i]);
    int n_more = byte < 0x80                   ? 0
                 : byte >= 0xc2 && byte < 0xe0 ? 1
                 : byte >= 0xe0 && byte < 0xf0 ? 2
                 : byte >= 0xf0 && byte < 0xf5 ? 3
                                               : -1;
    const bool is_control = byte < 0x20 || byte == 0x7f;
    for (; n_more > 0 && i + 1 < name.size() && (static_cast<unsigned char>(name[i + 1]) & 0xc0U) == 0x80U;
         ++i)
      --n_more;
    if (n_more != 0 || is_control)
      lines_.fail(place, "a name has bytes that are not UTF-8", "save the deck as UTF-8, or rename the set");
  }
  return name;
}

std::int64_t InpParser::integer(std::string_view field) const
{
  constexpr std::int64_t largest = std::numeric_limits<std::int64_t>::max() / 4;  // sums of them are numbers
  const std::optional<std::int64_t> value = integer_of(field);
  if (!value || *value > largest || *value < -largest)
    lines_.fail(lines_.place(), fmt::format("\"{}\" is not an integer", field.substr(0, 80)));
  return *value;
}

double InpParser::number(std::string_view field) const
{
  const std::optional<double> value = number_of(field);
  if (!value || !std::isfinite(*value))
    lines_.fail(lines_.place(), fmt::format("\"{}\" is not a number", field.substr(0, 80)));
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
      if (!fields[i].empty()) x[static_cast<Index>(i) - 1] = number(fields[i]);
    const std::int64_t n = integer(fields[0]);
    part().node_numbers.push_back(n);
    part().nodes.push_back(x);
    part().node_places.push_back(lines_.place());
    if (set) part().node_sets.all[number_of_set].add({n, n});
  }
}

void InpParser::read_elements(const InpKeyword& keyword)
{
  const std::string type = capitals(required(keyword, "TYPE"));
  InpElements elements{.type_name = type, .family = {}, .type = {}, .set = -1};
  const bool is_read = find_type(type, elements);
  if (const auto file = keyword.find("INPUT")) lines_.include(*file);
  if (const auto set = keyword.find("ELSET"))
    elements.set = part().element_sets.add(checked_name(*set, keyword.place), keyword.place);
  while (next_data())
  {
    if (!is_read)
      lines_.fail(
          lines_.place(),
          fmt::format("element {} is of type {}, which is not read", lines_.fields()[0].substr(0, 80), type),
          fmt::format("{}; springs, beams, rigid and axisymmetric elements have no counterpart", to_split));
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
  { lines_.fail(place, fmt::format("element {} ({}) has {} nodes", element, elements.type_name, problem)); };
  std::size_t n = 0;
  while (true)
  {
    for (const std::string_view field : fields) elements.nodes.push_back(integer(field));
    n += fields.size();
    if (n > n_nodes) fail(fmt::format("more than {}", n_nodes));
    if (n == n_nodes) break;
    if (!next_data()) fail(fmt::format("only {} of {}", n, n_nodes));
    fields = lines_.fields();
  }
  elements.numbers.push_back(element);
  elements.places.push_back(place);
  if (elements.set >= 0) part().element_sets.all[elements.set].add({element, element});
}

int InpParser::instance_named(std::string_view name) const
{
  const std::string wanted = capitals(name);
  for (std::size_t i = 1; i < model_.instances.size(); ++i)
    if (capitals(model_.instances[i].name) == wanted) return static_cast<int>(i);
  return -1;
}

InpMembers InpParser::members_of(std::string_view field, int instance, InpSets InpPart::*kind) const
{
  int owner = instance < 0 ? part_ : model_.instances[instance].part;
  std::string_view name = field;
  if (const std::size_t dot = field.find('.'); dot != std::string_view::npos && instance < 0)
    if (const int of_name = instance_named(trimmed(field.substr(0, dot))); of_name > 0)
    {
      instance = of_name;
      owner = model_.instances[instance].part;
      name = trimmed(field.substr(dot + 1));
    }
  if (const auto one = integer_of(name); one) return {integer(name), integer(name), 1, instance};
  const int set = (model_.parts[owner].*kind).find(name);
  if (set < 0)
    lines_.fail(lines_.place(), fmt::format("there is no set \"{}\" so far", field.substr(0, 80)),
                "sets stand before what uses them");
  return {0, 0, 1, instance, set};
}

void InpParser::read_set(const InpKeyword& keyword, InpSets& sets, const std::string& parameter)
{
  const std::string name = required(keyword, parameter);
  int instance = -1;
  if (const auto of = keyword.find("INSTANCE"))
    if (instance = instance_named(*of); instance < 0)
      lines_.fail(keyword.place, fmt::format("there is no instance \"{}\"", *of));
  const int number = sets.add(checked_name(name, keyword.place), keyword.place);
  sets.all[number].is_from_set_keyword = true;
  const bool is_generated = keyword.find("GENERATE").has_value();
  InpSets InpPart::*const kind = parameter == "NSET" ? &InpPart::node_sets : &InpPart::element_sets;
  while (next_data())
  {
    const auto fields = lines_.fields();
    std::vector<InpMembers>& members = sets.all[number].members;
    if (is_generated)
    {
      if (fields.size() < 2 || fields.size() > 3)
        lines_.fail(lines_.place(), "GENERATE needs first, last, step");
      const std::int64_t step = fields.size() == 3 ? integer(fields[2]) : 1;
      if (step < 1) lines_.fail(lines_.place(), fmt::format("the step {} is not positive", step));
      members.push_back({integer(fields[0]), integer(fields[1]), step, instance, -1, true});
      continue;
    }
    for (const std::string_view field : fields)
    {
      if (field.empty()) continue;
      const InpMembers more = members_of(field, instance, kind);
      if (more.set == number && more.instance < 0) continue;  // a set in itself
      if (more.set > number && more.instance < 0)
        lines_.fail(lines_.place(),
                    fmt::format("set \"{}\" is defined after \"{}\"", field.substr(0, 80), name),
                    "sets stand before what uses them");
      sets.all[number].add(more);
    }
  }
}

void InpParser::read_surface(const InpKeyword& keyword)
{
  const std::string name = required(keyword, "NAME");
  const std::string type = capitals(keyword.find("TYPE").value_or("ELEMENT"));
  if ((type != "ELEMENT" && type != "NODE") || keyword.find("COMBINE") || keyword.find("CROP"))
    lines_.fail(keyword.place, fmt::format("surface \"{}\" is neither of elements nor of nodes", name),
                "*SURFACE, NAME=..., TYPE=ELEMENT with lines such as \"body, S1\"");
  InpSurface surface{checked_name(name, keyword.place), type == "NODE", keyword.place};
  while (next_data())
  {
    const auto fields = lines_.fields();
    InpSurfacePart one{{}, -1, lines_.place()};
    if (!surface.is_of_nodes)
    {
      if (fields.size() < 2)
        lines_.fail(lines_.place(), fmt::format("surface \"{}\" has elements without a face", name),
                    "elements and one of their faces: \"body, S1\"");
      const std::string face = capitals(fields[1]);
      if (face.size() != 2 || face[0] != 'S' || face[1] < '1' || face[1] > '6')
        lines_.fail(lines_.place(),
                    fmt::format("\"{}\" is not a face of an element", fields[1].substr(0, 80)), "S1 to S6");
      one.face = face[1] - '1';
    }
    if (fields.empty()) continue;
    one.elements =
        members_of(fields[0], -1, surface.is_of_nodes ? &InpPart::node_sets : &InpPart::element_sets);
    surface.parts.push_back(one);
  }
  part().surfaces.push_back(std::move(surface));
}

void InpParser::read_section(const InpKeyword& keyword)
{
  const auto name = keyword.find("ELSET");
  if (!name) return;
  const int set = part().element_sets.find(*name);
  if (set < 0) lines_.fail(keyword.place, fmt::format("there is no set \"{}\" so far", *name));
  part().sections.push_back({keyword.name, set, keyword.place});
}

void InpParser::begin_part(const InpKeyword& keyword)
{
  if (part_ != 0)
    lines_.fail(keyword.place, fmt::format("a part inside part \"{}\"", part().name), "*END PART is missing");
  const std::string name = checked_name(required(keyword, "NAME"), keyword.place);
  for (const InpPart& other : model_.parts)
    if (capitals(other.name) == capitals(name))
      lines_.fail(keyword.place, fmt::format("there are two parts \"{}\"", name));
  part_ = static_cast<int>(model_.parts.size());
  model_.parts.push_back({.name = name, .place = keyword.place});
}

void InpParser::end_part(const InpKeyword& keyword)
{
  if (part_ == 0) lines_.fail(keyword.place, "*END PART without *PART");
  part_ = 0;
}

/// x -> R (x + t - a) + a: first the translation t, then the rotation about the axis through a.
void InpParser::read_instance(const InpKeyword& keyword)
{
  InpInstance instance{checked_name(required(keyword, "NAME"), keyword.place), -1, keyword.place};
  const std::string name = capitals(required(keyword, "PART"));
  for (std::size_t p = 1; p < model_.parts.size(); ++p)
    if (capitals(model_.parts[p].name) == name) instance.part = static_cast<int>(p);
  if (instance.part < 0 || part_ != 0)
    lines_.fail(keyword.place,
                fmt::format("instance \"{}\" of part \"{}\", which is not defined here", instance.name, name),
                "parts stand before the assembly");
  if (instance_named(instance.name) > 0)
    lines_.fail(keyword.place, fmt::format("there are two instances \"{}\"", instance.name));
  for (int line = 0; next_data(); ++line)
  {
    const auto fields = lines_.fields();
    if (line > 1 || fields.size() > (line == 0 ? 3U : 7U) || (line == 1 && fields.size() < 7))
      lines_.fail(
          lines_.place(),
          "an instance has a line of 3 numbers and one of 7: translation; two points of an axis, angle");
    std::array<double, 7> x{};
    for (std::size_t i = 0; i < fields.size(); ++i) x[i] = fields[i].empty() ? 0 : number(fields[i]);
    if (line == 0)
    {
      instance.shift = Point<3>(x[0], x[1], x[2]);
      continue;
    }
    const Point<3> a(x[0], x[1], x[2]);
    const Point<3> axis = Point<3>(x[3], x[4], x[5]) - a;
    if (!(axis.norm() > 0)) lines_.fail(lines_.place(), "the two points of the axis are the same");
    instance.rotation =
        Eigen::AngleAxisd(x[6] * std::numbers::pi / 180, axis.normalized()).toRotationMatrix();
    instance.shift = instance.rotation * (instance.shift - a) + a;
  }
  if (has_line_)
    if (const InpKeyword next = lines_.keyword(); handler_of(next.name) && next.name != "INSTANCE")
      lines_.fail(next.place, fmt::format("*{} inside an instance is not read", next.name),
                  "put it into the part");
  model_.instances.push_back(std::move(instance));
}

}  // namespace

InpModel parse_inp(InpLines& lines)
{
  return InpParser(lines).parse();
}

}  // namespace tribound::mesh
