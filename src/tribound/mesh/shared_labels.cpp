#include "tribound/mesh/shared_labels.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tribound/mesh/quadratic_facets.h"

namespace tribound::mesh
{

namespace
{

/// Copies texts of the first rank to all.
void copy_texts(const Ranks& ranks, std::vector<std::string>& texts)
{
  std::vector<char> bytes;
  for (const std::string& text : texts)
    bytes.insert(bytes.end(), text.c_str(), text.c_str() + text.size() + 1);
  ranks.copy_from_first(bytes);
  texts.clear();
  for (auto begin = bytes.begin(); begin != bytes.end();)
  {
    const auto end = std::find(begin, bytes.end(), '\0');
    texts.emplace_back(begin, end);
    begin = end + 1;
  }
}

/// Each side is preceded by its length.
void copy_interfaces(const Ranks& ranks, std::vector<Interface>& interfaces)
{
  std::vector<std::string> texts;
  for (const Interface& interface : interfaces)
    for (const std::vector<std::string>& side : interface.sides)
    {
      texts.push_back(std::to_string(side.size()));
      texts.insert(texts.end(), side.begin(), side.end());
    }
  copy_texts(ranks, texts);
  interfaces.clear();
  for (auto next = texts.begin(); next != texts.end();)
    for (std::vector<std::string>& side : interfaces.emplace_back().sides)
    {
      const auto begin = next + 1;
      next = begin + std::stoi(*next);
      side.assign(begin, next);
    }
}

void copy_quadratic_facets(const Ranks& ranks, std::shared_ptr<const QuadraticFacets>& facets)
{
  if (!ranks.first_says(facets != nullptr)) return;
  QuadraticFacets copy;
  if (facets) copy = *facets;
  ranks.copy_from_first(copy.tags);
  ranks.copy_from_first(copy.nodes);
  ranks.copy_from_first(copy.points);
  ranks.copy_from_first(copy.first.tags);
  ranks.copy_from_first(copy.first.vertices);
  ranks.copy_from_first(copy.first.points);
  facets = std::make_shared<const QuadraticFacets>(std::move(copy));
}

}  // namespace

void copy_labels(const Ranks& ranks, MeshLabels& labels)
{
  copy_texts(ranks, labels.region_names);
  copy_texts(ranks, labels.boundary_names);
  Where& source = labels.source;
  std::vector<std::string> place = {source.file, source.key, std::to_string(source.line),
                                    std::to_string(source.column)};
  copy_texts(ranks, place);
  source = {place[0], place[1], std::stoi(place[2]), std::stoi(place[3])};
  copy_interfaces(ranks, labels.interfaces);
  copy_quadratic_facets(ranks, labels.quadratic_facets);
}

}  // namespace tribound::mesh
