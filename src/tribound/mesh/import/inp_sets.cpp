#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <utility>

#include "tribound/mesh/import/inp_parser.h"

namespace tribound::mesh
{

InpMembers InpParser::members_of(std::string_view field, int instance, InpSets InpPart::*kind) const
{
  const std::optional<InpMembers> members = model_.find_members(field, part_, instance, kind);
  if (!members)
    lines_.fail(lines_.place(), fmt::format("there is no set \"{}\" so far", field.substr(0, 80)),
                "sets stand before what uses them");
  return *members;
}

void InpParser::read_set(const InpKeyword& keyword, InpSets& sets, const std::string& parameter)
{
  const std::string name = lines_.required(keyword, parameter);
  int instance = -1;
  if (const auto of = keyword.find("INSTANCE"))
    if (instance = model_.instance_named(*of); instance < 0)
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
  const std::string name = lines_.required(keyword, "NAME");
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
  // The same name again adds to the surface.
  const auto same = std::ranges::find_if(
      part().surfaces, [&](const InpSurface& other) { return capitals(other.name) == capitals(name); });
  if (same == part().surfaces.end())
    part().surfaces.push_back(std::move(surface));
  else if (same->is_of_nodes == surface.is_of_nodes)
    same->parts.insert(same->parts.end(), surface.parts.begin(), surface.parts.end());
  else
    lines_.fail(keyword.place, fmt::format("surface \"{}\" is of nodes and of elements", name));
}

void InpParser::read_section(const InpKeyword& keyword)
{
  const auto name = keyword.find("ELSET");
  if (!name) return;
  const int set = part().element_sets.find(*name);
  if (set < 0) lines_.fail(keyword.place, fmt::format("there is no set \"{}\" so far", *name));
  InpSection section{keyword.name, set, keyword.place, keyword.find("MATERIAL").value_or("")};
  while (next_data())
    if (const auto fields = lines_.fields(); section.first_datum.empty() && !fields.empty())
      section.first_datum = fields[0];
  part().sections.push_back(std::move(section));
}

void InpParser::begin_part(const InpKeyword& keyword)
{
  if (part_ != 0)
    lines_.fail(keyword.place, fmt::format("a part inside part \"{}\"", part().name), "*END PART is missing");
  const std::string name = checked_name(lines_.required(keyword, "NAME"), keyword.place);
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
  InpInstance instance{checked_name(lines_.required(keyword, "NAME"), keyword.place), -1, keyword.place};
  const std::string name = capitals(lines_.required(keyword, "PART"));
  for (std::size_t p = 1; p < model_.parts.size(); ++p)
    if (capitals(model_.parts[p].name) == name) instance.part = static_cast<int>(p);
  if (instance.part < 0 || part_ != 0)
    lines_.fail(keyword.place,
                fmt::format("instance \"{}\" of part \"{}\", which is not defined here", instance.name, name),
                "parts stand before the assembly");
  if (model_.instance_named(instance.name) > 0)
    lines_.fail(keyword.place, fmt::format("there are two instances \"{}\"", instance.name));
  for (int line = 0; next_data(); ++line)
  {
    const auto fields = lines_.fields();
    if (line > 1 || fields.size() > (line == 0 ? 3U : 7U) || (line == 1 && fields.size() < 7))
      lines_.fail(
          lines_.place(),
          "an instance has a line of 3 numbers and one of 7: translation; two points of an axis, angle");
    std::array<double, 7> x{};
    for (std::size_t i = 0; i < fields.size(); ++i)
      x[i] = fields[i].empty() ? 0 : lines_.number(fields[i], lines_.place());
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

}  // namespace tribound::mesh
