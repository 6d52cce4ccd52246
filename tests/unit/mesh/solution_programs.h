#pragma once

/// The displacement and the stress of solution_files.h as Gmsh and CalculiX write them.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "tribound/mesh/gmsh_elements.h"
#include "unit/mesh/solution_files.h"

namespace tribound::testing_mesh
{

/// A section with values, "tag numbers" a line.
inline std::string gmsh_data(const std::string& section, const std::string& name, int step, int n_components,
                             const std::vector<std::string>& lines)
{
  return fmt::format("${0}\n1\n\"{1}\"\n1\n{2}.5\n3\n{2}\n{3}\n{4}\n{5}\n$End{0}\n", section, name, step,
                     n_components, lines.size(), fmt::join(lines, "\n"));
}

/// The values of nodes; those of step 0 are twice as large.
inline std::string gmsh_nodal_data(const mesh::ImportedMesh& mesh)
{
  std::vector<std::string> twice;
  std::vector<std::string> u;
  std::vector<std::string> s;
  for (std::size_t v = 0; v < mesh.nodes.size(); ++v)
  {
    const Point<3> value = displacement_at(mesh.nodes[v]);
    twice.push_back(fmt::format("{} {}", v + 1, numbers(Point<3>(2 * value))));
    u.push_back(fmt::format("{} {}", v + 1, numbers(value)));
    s.push_back(fmt::format("{} {}", v + 1, numbers(tensor_at(mesh.nodes[v]))));
  }
  return gmsh_data("NodeData", "u", 0, 3, twice) + gmsh_data("NodeData", "u", 1, 3, u) +
         gmsh_data("NodeData", "sigma", 1, 9, s);
}

inline std::vector<Index> gmsh_nodes(const mesh::ElementBlock& block, std::size_t e)
{
  const std::vector<int> order = mesh::to_gmsh(block.type).order;
  std::vector<Index> cell(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) cell[order[i]] = block.element(e)[i];
  return cell;
}

/// The values of the nodes of elements, in Gmsh's order.
inline std::string gmsh_data_of_elements(const mesh::ImportedMesh& mesh)
{
  std::vector<std::string> u;
  std::vector<std::string> s;
  const mesh::ElementBlock& block = mesh.cells[0];
  for (std::size_t e = 0; e < block.size(); ++e)
  {
    u.push_back(fmt::format("{} {}", e + 1, block.type.n_nodes));
    s.push_back(u.back());
    for (const Index v : gmsh_nodes(block, e))
    {
      u.back() += " " + numbers(displacement_at(mesh.nodes[v]));
      s.back() += " " + numbers(tensor_at(mesh.nodes[v]));
    }
  }
  return gmsh_data("ElementNodeData", "u", 0, 3, u) + gmsh_data("ElementNodeData", "sigma", 0, 9, s);
}

/// A mesh of one block, in format 2.2 or 4.1.
inline std::string msh(const mesh::ImportedMesh& mesh, bool is_new)
{
  const mesh::ElementBlock& block = mesh.cells[0];
  const int dim = mesh::table_of(block.type.shape).dim;
  const int type = mesh::to_gmsh(block.type).number;
  const std::size_t n = mesh.nodes.size();
  std::string tags;
  std::string nodes;
  std::string elements;
  for (std::size_t v = 0; v < n; ++v)
  {
    tags += fmt::format("{}\n", v + 1);
    nodes += (is_new ? "" : fmt::format("{} ", v + 1)) + numbers(mesh.nodes[v]) + "\n";
  }
  for (std::size_t e = 0; e < block.size(); ++e)
  {
    elements += is_new ? fmt::format("{}", e + 1) : fmt::format("{} {} 2 0 1", e + 1, type);
    for (const Index v : gmsh_nodes(block, e)) elements += fmt::format(" {}", v + 1);
    elements += "\n";
  }
  if (!is_new)
    return fmt::format(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n{}$EndNodes\n$Elements\n{}\n{}$EndElements\n", n,
        nodes, block.size(), elements);
  return fmt::format(
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 {}\n1 0 0 0 9 9 9 0 0\n$EndEntities\n"
      "$Nodes\n1 {} 1 {}\n{} 1 0 {}\n{}{}$EndNodes\n$Elements\n1 {} 1 {}\n{} 1 {} {}\n{}$EndElements\n",
      dim == 2 ? "1 0" : "0 1", n, n, dim, n, tags, nodes, block.size(), block.size(), dim, type,
      block.size(), elements);
}

/// As ccx writes it: two steps, of which the first has twice the displacement.
inline std::string frd(const mesh::ImportedMesh& mesh)
{
  static const std::map<std::pair<mesh::Shape, int>, std::pair<int, std::vector<int>>> types = {
      {{mesh::Shape::hexahedron, 8}, {1, {}}},
      {{mesh::Shape::prism, 6}, {2, {}}},
      {{mesh::Shape::tetrahedron, 4}, {3, {}}},
      {{mesh::Shape::hexahedron, 20},
       {4, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15}}},
      {{mesh::Shape::prism, 15}, {5, {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11}}},
      {{mesh::Shape::tetrahedron, 10}, {6, {}}},
      {{mesh::Shape::triangle, 3}, {7, {}}},
      {{mesh::Shape::triangle, 6}, {8, {}}},
      {{mesh::Shape::quadrilateral, 4}, {9, {}}},
      {{mesh::Shape::quadrilateral, 8}, {10, {}}}};
  const auto of_nodes = [&](const auto& values_at)
  {
    std::string text;
    for (std::size_t v = 0; v < mesh.nodes.size(); ++v)
    {
      text += fmt::format(" -1{:10}", v + 1);
      for (const double value : values_at(mesh.nodes[v])) text += fmt::format("{:12.5E}", value);
      text += "\n";
    }
    return text + " -3\n";
  };
  std::string text = "    1C\n    1UPGM               CalculiX\n" +
                     fmt::format("    2C{:30}{:38}\n", mesh.nodes.size(), 1) +
                     of_nodes(
                         [](const Point<3>& x) {
                           return std::array{x[0], x[1], x[2]};
                         }) +
                     fmt::format("    3C{:30}{:38}\n", 0, 1);
  int label = 0;
  for (const mesh::ElementBlock& block : mesh.cells)
    for (std::size_t e = 0; e < block.size(); ++e)
    {
      const auto& [type, order] = types.at({block.type.shape, block.type.n_nodes});
      text += fmt::format(" -1{:10}{:5}{:5}{:5}", ++label, type, 0, 1);
      for (int i = 0; i < block.type.n_nodes; ++i)
        text += (i % 10 == 0 ? "\n -2" : "") +
                fmt::format("{:10}", block.element(e)[order.empty() ? i : order[i]] + 1);
      text += "\n";
    }
  text += " -3\n";
  for (const int step : {1, 2})
  {
    const auto head = [&](const std::string& name, int n, const std::vector<std::string>& components)
    {
      std::string lines = fmt::format("    1PSTEP{:26}{:12}{:12}\n  100CL  10{}{:12.9f}{:12}{:22}{:5}{:12}\n",
                                      2 * step, 1, step, step, double(step), mesh.nodes.size(), 0, step, 1) +
                          fmt::format(" -4  {:8}{:5}    1\n", name, n);
      for (const std::string& component : components)
        lines += fmt::format(" -5  {:8}    1    2    1{:5}{:5}\n", component, 0, component == "ALL" ? 1 : 0);
      return lines;
    };
    const double factor = step == 1 ? 2 : 1;
    text += head("DISP", 4, {"D1", "D2", "D3", "ALL"}) + of_nodes(
                                                             [&](const Point<3>& x)
                                                             {
                                                               const Point<3> u = factor * displacement_at(x);
                                                               return std::array{u[0], u[1], u[2]};
                                                             });
    text += head("STRESS", 6, {"SXX", "SYY", "SZZ", "SXY", "SYZ", "SZX"}) + of_nodes(stress_at);
  }
  return text + " 9999\n";
}

}  // namespace tribound::testing_mesh
