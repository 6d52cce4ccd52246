#include "tribound/mesh/import/middle_rule.h"

#include <algorithm>
#include <span>

namespace tribound::mesh
{

namespace
{

using Rule = std::vector<std::pair<int, double>>;

/// The centre of corners and of the edges between them, in a face or in a solid: of order 2 without a node
/// there, the weights of the corners are -1/4, those of the edges share what is missing.
Rule centre(const ElementType& type, std::span<const int> corners)
{
  const ShapeTable& table = table_of(type.shape);
  Rule rule;
  const double n = static_cast<double>(corners.size());
  for (const int corner : corners) rule.emplace_back(corner, has_middles(type) ? -0.25 : 1 / n);
  if (!has_middles(type)) return rule;
  std::vector<int> middles;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (const int edge = edge_number(table, corners[i], corners[j]); edge >= 0)
        middles.push_back(table.n_corners + edge);
  for (const int middle : middles)
    rule.emplace_back(middle, (1 + n / 4) / static_cast<double>(middles.size()));
  return rule;
}

}  // namespace

Rule middle_rule(const ElementType& type, int a, int b)
{
  const ShapeTable& table = table_of(type.shape);
  if (const int edge = edge_number(table, a, b); edge >= 0)
    return has_middles(type) ? Rule{{table.n_corners + edge, 1.0}} : Rule{{a, 0.5}, {b, 0.5}};
  if (table.dim == 2)
  {
    if (type.n_nodes > table.n_corners + table.n_edges) return {{type.n_nodes - 1, 1.0}};
    return centre(type, std::vector<int>{0, 1, 2, 3});
  }
  for (int f = 0; f < table.n_faces; ++f)
  {
    const std::span<const int> corners = table.faces[f].span();
    if (std::ranges::find(corners, a) == corners.end() || std::ranges::find(corners, b) == corners.end())
      continue;
    const FaceElement face = face_element(type, f);
    if (face.type.n_nodes == 9) return {{face.nodes[8], 1.0}};
    return centre(type, corners);
  }
  if (type.n_nodes == 27) return {{26, 1.0}};
  return centre(type, std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7});
}

}  // namespace tribound::mesh
