#include <fmt/format.h>

#include <algorithm>

#include "tribound/case/deck/case_maker.h"

namespace tribound::case_file
{

std::array<const Course*, 6> CaseMaker::courses_of(Index rigid, DeckLoadKind kind) const
{
  std::array<const Course*, 6> result{};
  for (const DeckLoad& load : deck_.loads)
    if (load.kind == kind && load.members[0] == rigid) result[load.component] = &load.course;
  return result;
}

void CaseMaker::add_rigid(const DeckRigid& rigid, Index number, Node::Table& table) const
{
  const bool is_plane = faces_.dim() == 2;
  const std::vector<int> motions = is_plane ? std::vector<int>{0, 1, 5} : std::vector<int>{0, 1, 2, 3, 4, 5};
  const auto given = courses_of(number, DeckLoadKind::rigid_motion);
  const auto is_held = [&](int m) { return given[m] != nullptr; };
  if (std::ranges::all_of(motions, is_held))
    return put(table, "displacement", rigid_displacement(rigid, given));

  constexpr std::array<const char*, 6> names = {"x", "y", "z", "rx", "ry", "rz"};
  Node::Table content;
  const auto loads = courses_of(number, DeckLoadKind::rigid_force);
  const auto datum = [&](int m) {
    return loads[m] == nullptr ? Node{0.0, {}} : loads[m]->datum(1, times_.empty());
  };
  Node::Array force;
  for (int c = 0; c < faces_.dim(); ++c) force.push_back(datum(c));
  put(content, "force", {std::move(force), {}});
  put(content, "moment", is_plane ? datum(5) : Node{Node::Array{datum(3), datum(4), datum(5)}, {}});
  Node::Array point;
  for (int c = 0; c < faces_.dim(); ++c) point.push_back({assembler_.mesh().nodes[rigid.reference][c], {}});
  put(content, "point", {std::move(point), {}});
  Node::Array fixed;
  for (const int m : motions)
  {
    if (!is_held(m)) continue;
    if (!given[m]->is_constant() || given[m]->last() != 0)
      log_.refuse(rigid.place, "RIGID BODY",
                  fmt::format("{}: {} is given, and other motions are free", rigid.target, names[m]),
                  "give all motions, or hold them at 0");
    fixed.push_back({std::string(names[m]), {}});
  }
  if (!fixed.empty()) put(content, "fixed", {std::move(fixed), {}});
  put(table, "rigid", {std::move(content), {}});
}

/// u = t + w x (x - point), for small rotations w.
Node CaseMaker::rigid_displacement(const DeckRigid& rigid, const std::array<const Course*, 6>& motions) const
{
  const Point<3>& point = assembler_.mesh().nodes[rigid.reference];
  Node::Array components;
  for (int c = 0; c < faces_.dim(); ++c)
  {
    Node shift = motions[c]->datum(1, times_.empty());
    std::string turns;
    // (w x r)_c = w_a r_b - w_b r_a, with c, a, b in cyclic order
    const int a = (c + 1) % 3;
    const int b = (c + 2) % 3;
    for (const auto& [w, r, sign] : {std::array{a, b, 1}, std::array{b, a, -1}})
    {
      const Course* turn = motions[3 + w];
      if (turn == nullptr || (turn->is_constant() && turn->last() == 0) || r >= faces_.dim()) continue;
      turns +=
          fmt::format(" + {}*({} - ({}))", as_factor(turn->datum(sign, times_.empty())), "xyz"[r], point[r]);
    }
    components.push_back(turns.empty() ? std::move(shift) : Node{as_factor(shift) + turns, {}});
  }
  return {std::move(components), {}};
}

}  // namespace tribound::case_file
