#include "tribound/case/deck/nodal_forces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>
#include <utility>

namespace tribound::case_file
{

namespace
{

/// Weights: what a uniform traction of 1 is at the nodes of the faces.
SpreadForce spread_on(const DeckFaces& faces, const std::map<Index, double>& weight_of_node,
                      const std::map<Index, Point<3>>& forces)
{
  SpreadForce result;
  Point<3> resultant = Point<3>::Zero();
  double largest = 0;
  for (const auto& [node, _] : weight_of_node)
    if (const auto force = forces.find(node); force != forces.end())
    {
      resultant += force->second;
      largest = std::max(largest, force->second.norm());
    }
  Point<3> centre = Point<3>::Zero();
  for (const auto& [node, weight] : weight_of_node)
  {
    result.area += weight;
    centre += weight * faces.point(node);
  }
  centre /= result.area;
  double size = 0;
  double sum = 0;
  Point<3> moment = Point<3>::Zero();  // about the centre, where a uniform traction has none
  for (const auto& [node, _] : weight_of_node)
    if (const auto force = forces.find(node); force != forces.end())
    {
      const Point<3> arm = faces.point(node) - centre;
      size = std::max(size, arm.norm());
      sum += force->second.norm();
      moment += arm.cross(force->second);
    }
  constexpr double hundredth = 1e-2;
  result.keeps_resultant =
      resultant.norm() >= (1 - hundredth) * sum && moment.norm() <= hundredth * sum * size;
  result.traction = resultant / result.area;
  result.is_exact = std::ranges::all_of(
      weight_of_node,
      [&](const auto& entry)
      {
        constexpr double tolerance = 1e-3;  // of forces that a deck gives with a few digits
        const auto force = forces.find(entry.first);
        const Point<3> given = force == forces.end() ? Point<3>(Point<3>::Zero()) : force->second;
        return (given - entry.second * result.traction).norm() <= tolerance * largest;
      });
  return result;
}

}  // namespace

SpreadForces spread(const DeckFaces& faces, const std::map<Index, Point<3>>& forces)
{
  std::vector<Index> nodes;
  nodes.reserve(forces.size());
  for (const auto& [node, _] : forces) nodes.push_back(node);
  SpreadForces result;
  std::vector<Index> reached;
  for (std::vector<Index>& part : faces.connected(faces.loaded_by(nodes)))
  {
    std::map<Index, double> weight_of_node;
    for (const Index face : part)
    {
      const mesh::FaceNodes of_face = faces.nodes(face);
      const std::vector<double> weights = faces.weights(face);
      for (int i = 0; i < of_face.type.n_nodes; ++i) weight_of_node[of_face.nodes[i]] += weights[i];
    }
    for (const auto& [node, _] : weight_of_node) reached.push_back(node);
    result.parts.push_back(spread_on(faces, weight_of_node, forces));
    result.parts.back().faces = std::move(part);
  }
  std::ranges::sort(reached);
  std::ranges::set_difference(nodes, reached, std::back_inserter(result.lone_nodes));
  return result;
}

}  // namespace tribound::case_file
