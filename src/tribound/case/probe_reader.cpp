#include "tribound/case/probe_reader.h"

#include <fmt/format.h>

#include <utility>

#include "tribound/case/dimension.h"

namespace tribound::case_file
{

namespace
{

constexpr auto place_hint = "point = [1, 0.5], or a line: from = [0, 0], to = [1, 0], points = 11";
constexpr long most_points = 10'000;

const Table& probe_table()
{
  static const Table table{
      .name = "probe.NAME",
      .keys = {{"point", numbers()},
               {"from", numbers()},
               {"to", numbers()},
               {"points",
                integer_from(2, "how many points of the line, both ends included, such as 11", most_points)}},
      .one_of = {"point", "from"},
      .relations = {{.key = "point", .excludes = {"to", "points"}},
                    {.key = "from", .needs = {"to", "points"}},
                    {.key = "to", .needs = {"from"}},
                    {.key = "points", .needs = {"from"}}}};
  return table;
}

ProbeConfig read_probe(const Entry& entry)
{
  const TableReader table(entry.node, probe_table());
  ProbeConfig probe{.name = entry.name, .where = entry.where};
  if (table.only(place_hint).empty()) throw InputError(entry.where, "has neither point nor from", place_hint);
  if (const Node* of_line = table.excluded_by("point"))
    throw InputError(of_line->where, "belongs to a line, and a single point is given", place_hint);
  if (table.has("from"))
    for (const char* key : {"to", "points"}) (void)table.require(key, place_hint);
  table.read("point", probe.point);
  table.read("from", probe.from);
  table.read("to", probe.to);
  table.read("points", probe.n_points);
  return probe;
}

const Table& section_table()
{
  static const Table table{.name = "section.NAME",
                           .keys = {{"point", numbers(), "a point of the plane: point = [0, 1]"},
                                    {"normal", direction("a vector across the plane, such as [0, 1]"),
                                     "a vector across the plane: normal = [0, 1]"},
                                    {"within", formula()}}};
  return table;
}

SectionConfig read_section(const Entry& entry)
{
  const TableReader table(entry.node, section_table());
  SectionConfig section{.name = entry.name, .where = entry.where};
  section.point = table.get<std::vector<double>>("point");
  section.normal = table.get<std::vector<double>>("normal");
  const Node* within = table.find("within");
  if (within == nullptr) return section;
  section.within.emplace(to_text(*within), within->where);
  if (section.within->uses_time())
    throw InputError(within->where, "contains the load factor t, but a section stays where it is",
                     "a formula of the coordinates, such as \"x - 1\"");
  return section;
}

/// read(entry) for every table named by the user.
template <class Read>
auto read_named(const Node& node, const std::string& hint, const Read& read)
{
  const auto* table = std::get_if<Node::Table>(&node.value);
  if (table == nullptr) fail_type(node, "a table", hint);
  std::vector<decltype(read(table->front()))> all;
  all.reserve(table->size());
  for (const Entry& entry : *table) all.push_back(read(entry));
  return all;
}

template <int dim>
Point<dim> to_point(const std::vector<double>& x, std::string_view key, const Where& where)
{
  check_length<dim>(x.size(), inside(where, key));
  return Eigen::Map<const Point<dim>>(x.data());
}

template <int dim>
io::Probe<dim> to_probe(const ProbeConfig& given)
{
  io::Probe<dim> probe{.name = given.name, .points = {}, .where = given.where};
  if (!given.point.empty())
  {
    probe.points = {to_point<dim>(given.point, "point", given.where)};
    return probe;
  }
  const Point<dim> from = to_point<dim>(given.from, "from", given.where);
  const Point<dim> to = to_point<dim>(given.to, "to", given.where);
  const int last = given.n_points - 1;
  probe.points.reserve(given.n_points);
  for (int i = 0; i <= last; ++i)  // both ends to the last bit
    probe.points.push_back((static_cast<double>(last - i) * from + static_cast<double>(i) * to) /
                           static_cast<double>(last));
  return probe;
}

template <int dim>
io::Section<dim> to_section(const SectionConfig& given)
{
  if (dim == 2 && given.within && given.within->uses_z())
    throw InputError(given.within->where(), "uses z in a 2D case", "only x and y vary");
  return {.name = given.name,
          .point = to_point<dim>(given.point, "point", given.where),
          .normal = to_point<dim>(given.normal, "normal", given.where).stableNormalized(),
          .within = given.within,
          .where = given.where};
}

}  // namespace

const Table& probes_table()
{
  static const Table table{.name = "probe", .named = keys_of(probe_table())};
  return table;
}

const Table& sections_table()
{
  static const Table table{.name = "section", .named = keys_of(section_table())};
  return table;
}

std::vector<ProbeConfig> read_probes(const Node& node)
{
  return read_named(node, "one table for each probe, such as [probe.crest]", read_probe);
}

std::vector<SectionConfig> read_sections(const Node& node)
{
  return read_named(node, "one table for each section, such as [section.base]", read_section);
}

template <int dim>
io::Observations<dim> observations(const Config& config, const mesh::Mesh<dim>& mesh)
{
  io::Observations<dim> result;
  for (const ProbeConfig& probe : config.probes) result.probes.push_back(to_probe<dim>(probe));
  for (const SectionConfig& section : config.sections) result.sections.push_back(to_section<dim>(section));
  io::check_probes<dim>(mesh, result.probes);
  io::check_sections<dim>(mesh, result.sections);
  return result;
}

template io::Observations<2> observations(const Config&, const mesh::Mesh<2>&);
template io::Observations<3> observations(const Config&, const mesh::Mesh<3>&);

}  // namespace tribound::case_file
