#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "tribound/case/deck/deck_reader.h"

namespace tribound::case_file
{

Index DeckReader::node_of(const Block& block, std::string_view parameter)
{
  const std::vector<Index> nodes = assembler_.nodes_named(required(block, parameter), block.keyword.place);
  if (nodes.size() != 1)
    assembler_.lines().fail(block.keyword.place, fmt::format("{} is not one node", parameter));
  return nodes[0];
}

void DeckReader::read_rigid_body(const Block& block)
{
  const std::optional<std::string> set = block.keyword.find("NSET");
  if (!set) return drop(block);
  const std::vector<Index> nodes = assembler_.nodes_named(*set, block.keyword.place);
  DeckRigid rigid{block.keyword.place, block.keyword.name, *set, faces_.with_all_nodes(nodes),
                  node_of(block, "REFNODE")};
  if (block.keyword.find("ROTNODE")) rigid.rotation = node_of(block, "ROTNODE");
  std::vector<Index> lone;
  std::ranges::set_difference(nodes, faces_.nodes_on(rigid.faces), std::back_inserter(lone));
  std::erase(lone, rigid.reference);
  std::erase(lone, rigid.rotation);
  if (!lone.empty())
    return log_.drop(block.keyword.place, "RIGID BODY",
                     fmt::format("{}: node {} lies on no face all of whose nodes are in the set", *set,
                                 assembler_.mesh().node_numbers[lone[0]]),
                     "faces can be rigid");
  deck_.rigids.push_back(std::move(rigid));
  take(block, fmt::format("{} moves as a rigid body", *set));
}

/// *KINEMATIC or *DISTRIBUTING follows and says what it is.
void DeckReader::read_coupling(const Block& block)
{
  if (coupling_ != nullptr) drop(*coupling_);
  coupling_ = &block;
}

void DeckReader::read_distributing(const Block& block)
{
  coupling_ = nullptr;
  drop(block);
}

void DeckReader::read_kinematic(const Block& block)
{
  if (coupling_ == nullptr) return drop(block);
  const Block& coupling = *std::exchange(coupling_, nullptr);
  std::vector<bool> is_coupled(7, false);
  for (const Line& line : block.lines)
  {
    const auto first = static_cast<int>(number(line, 0));
    for (int c = std::max(first, 1); c <= std::min(static_cast<int>(number(line, 1, first)), 6); ++c)
      is_coupled[c] = true;
  }
  for (int c = 1; c <= faces_.dim(); ++c)
    if (!is_coupled[c] && !block.lines.empty())
      return log_.drop(coupling.keyword.place, "COUPLING",
                       fmt::format("component {} of the surface does not follow the reference node", c),
                       "*KINEMATIC with 1, 3");
  if (coupling.keyword.find("ORIENTATION"))
    return log_.drop(coupling.keyword.place, "COUPLING", "its axes are not those of the deck");
  const std::string surface = required(coupling, "SURFACE");
  deck_.rigids.push_back({coupling.keyword.place, coupling.keyword.name, surface,
                          faces_of_surface(assembler_, faces_, surface, coupling.keyword.place),
                          node_of(coupling, "REFNODE")});
  take(coupling, fmt::format("{} moves as a rigid body", surface));
}

bool DeckReader::apply_to_rigid(const Block& block, const Line& line, std::span<const Index> nodes)
{
  if (nodes.size() != 1) return false;
  const auto rigid = std::ranges::find_if(
      deck_.rigids, [&](const DeckRigid& r) { return r.reference == nodes[0] || r.rotation == nodes[0]; });
  if (rigid == deck_.rigids.end()) return false;
  const auto component = [&](const std::string& text)
  {
    if (mesh::capitals(text) == "ENCASTRE") return 1;
    const std::optional<std::int64_t> value = mesh::integer_of(text);
    if (!value || *value < 1 || *value > 6)
      assembler_.lines().fail(line.place, fmt::format("\"{}\" is no component", text), "1 to 6");
    return static_cast<int>(*value);
  };
  const bool is_force = block.keyword.name == "CLOAD";
  const int first = component(field(line, 1));
  const bool is_clamped = mesh::capitals(field(line, 1)) == "ENCASTRE";
  const int last = is_clamped ? 6 : is_force || field(line, 2).empty() ? first : component(field(line, 2));
  // The displacements of the node of the rotations are these; solids have no other use for 4 to 6.
  const bool is_rotation = nodes[0] == rigid->rotation;
  const std::vector<Index> member = {static_cast<Index>(rigid - deck_.rigids.begin())};
  for (int c = first; c <= last; ++c)
  {
    const int motion = is_rotation && c <= 3 ? c + 2 : c - 1;
    if (c > 3 && (is_rotation || rigid->rotation >= 0)) continue;
    if (faces_.dim() == 2 && motion != 0 && motion != 1 && motion != 5) continue;
    apply(load_on(is_force ? DeckLoadKind::rigid_force : DeckLoadKind::rigid_motion, block, line.place,
                  rigid->target, member, motion),
          is_force ? number(line, 2) / thickness_ : number(line, 3), block);
  }
  return true;
}

}  // namespace tribound::case_file
