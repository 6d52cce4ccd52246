#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>

#include "tribound/mesh/import/file_text.h"
#include "tribound/mesh/import/solution_values.h"
#include "tribound/mesh/import/text_lines.h"

namespace tribound::mesh
{

namespace
{

/// A file of a collection of ParaView.
struct PvdEntry
{
  std::filesystem::path file;
  double t;
};

PvdEntry entry_of(const pugi::xml_node& node, const Where& where)
{
  const std::filesystem::path file = node.attribute("file").value();
  const std::string suffix = suffix_of(file);
  if (suffix != ".vtu" && suffix != ".pvtu" && suffix != ".vtk")
    throw InputError(where, fmt::format("has a <DataSet> with the file \"{}\"", file.string()),
                     "a .vtu, .pvtu or .vtk for each time");
  const std::string_view time = node.attribute("timestep").value();
  const auto t = number_of(trimmed(time));
  if (!t || !std::isfinite(*t))
    throw InputError(where, fmt::format("has a <DataSet> with the timestep \"{}\"", time.substr(0, 40)),
                     "a number");
  return {std::filesystem::path(where.file).parent_path() / file, *t};
}

std::vector<PvdEntry> entries_of(const Where& where)
{
  const std::string content = content_of(where.file, where, {});
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(content.data(), content.size());
  if (!result)
    throw InputError(where, fmt::format("is no XML: {}", result.description()),
                     "a .pvd as ParaView and DOLFINx write it; is it cut off?");
  std::vector<PvdEntry> entries;
  for (const pugi::xml_node& node : document.child("VTKFile").child("Collection").children("DataSet"))
  {
    entries.push_back(entry_of(node, where));
    if (std::ranges::count(entries, entries.back().t, &PvdEntry::t) > 1)
      throw InputError(where, fmt::format("has several files for t = {:.9g}", entries.back().t),
                       "one file for each time: a .pvtu joins parts");
  }
  if (entries.empty())
    throw InputError(where, "has no <DataSet> in a <Collection>", "a .vtu, .pvtu or .vtk for each time");
  return entries;
}

}  // namespace

ImportedSolution read_pvd(const std::filesystem::path& file, const SolutionChoice& choice)
{
  const Where where{.file = file.string()};
  const std::vector<PvdEntry> entries = entries_of(where);
  const int n = static_cast<int>(entries.size());
  const int step = choice.step.value_or(n);
  if (step < 1 || step > n)
    throw InputError(where, fmt::format("has no step {}", step), fmt::format("its steps are 1 to {}", n));
  const PvdEntry& entry = entries[step - 1];
  ImportedSolution solution = read_vtk_solution(entry.file, {choice.field, choice.stress});
  solution.description += fmt::format(", step {} (t = {:g}) of {}", step, entry.t, file.filename().string());
  for (int i = 0; i < n; ++i) solution.steps.push_back({i + 1, entries[i].t});
  return solution;
}

}  // namespace tribound::mesh
