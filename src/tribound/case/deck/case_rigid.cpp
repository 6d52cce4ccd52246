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
  const auto given = courses_of(number, DeckLoadKind::rigid_motion);
  const std::vector<int> motions = faces_.dim() == 2 ? std::vector{0, 1, 5} : std::vector{0, 1, 2, 3, 4, 5};
  if (std::ranges::all_of(motions, [&](int m) { return given[m] != nullptr; }))
    return put(table, "displacement", rigid_displacement(rigid, given));

  Node::Table content;
  const auto loads = courses_of(number, DeckLoadKind::rigid_force);
  const auto datum = [&](int m) {
    return loads[m] == nullptr ? Node{0.0, {}} : loads[m]->datum(1, times_.empty());
  };
  Node::Array force;
  Node::Array point;
  for (int c = 0; c < faces_.dim(); ++c)
  {
    // What widens or tilts a section of revolution goes into its supports.
    force.push_back(faces_.is_axisymmetric() && c == 0 ? Node{0.0, {}} : datum(c));
    point.push_back({assembler_.mesh().nodes[rigid.reference][c], {}});
  }
  put(content, "force", {std::move(force), {}});
  if (faces_.dim() == 3)
    put(content, "moment", {Node::Array{datum(3), datum(4), datum(5)}, {}});
  else if (!faces_.is_axisymmetric())
    put(content, "moment", datum(5));
  put(content, "point", {std::move(point), {}});
  if (Node::Array fixed = fixed_motions(rigid, motions, given); !fixed.empty())
    put(content, "fixed", {std::move(fixed), {}});
  put(table, "rigid", {std::move(content), {}});
}

/// Their names. A body of revolution needs all but that along the axis.
Node::Array CaseMaker::fixed_motions(const DeckRigid& rigid, const std::vector<int>& motions,
                                     const std::array<const Course*, 6>& given) const
{
  constexpr std::array<const char*, 6> names = {"x", "y", "z", "rx", "ry", "rz"};
  Node::Array fixed;
  for (const int m : motions)
  {
    if (given[m] == nullptr)
    {
      if (faces_.is_axisymmetric() && m != 1)
        log_.drop(rigid.place, rigid.keyword,
                  fmt::format("{}: {} of the reference node is free, and the deck widens or tilts the "
                              "section; a rigid part of revolution moves along the axis alone",
                              rigid.target, names[m]),
                  "components 1 and 6 of the reference node held at 0");
      continue;
    }
    if (!given[m]->is_constant() || given[m]->last() != 0)
      log_.refuse(rigid.place, rigid.keyword,
                  fmt::format("{}: {} is given, and other motions are free", rigid.target, names[m]),
                  "give all motions, or hold them at 0");
    fixed.push_back({std::string(names[m]), {}});
  }
  return fixed;
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
