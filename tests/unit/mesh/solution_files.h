#pragma once

/// One displacement and one stress, written as table and for VTK, and compared with what is read.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "tribound/mesh/import/imported_solution.h"
#include "tribound/mesh/import/vtk_cell_type.h"
#include "unit/mesh/imported_testing.h"

namespace tribound::testing_mesh
{

inline Point<3> displacement_at(const Point<3>& x)
{
  return {1e-3 * (x[0] + 2 * x[1] * x[2]), 2e-3 * x[1] - 1e-3 * x[0] * x[0], -3e-3 * x[2]};
}

/// xx yy zz xy yz xz.
inline std::array<double, 6> stress_at(const Point<3>& x)
{
  return {100 + x[0], 10 * x[1] - 7, 3 + x[2], 2 * x[0] * x[1], 5 + x[1], -4 - x[2]};
}

inline std::array<double, 9> tensor_at(const Point<3>& x)
{
  const auto s = stress_at(x);
  return {s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]};
}

inline std::string numbers(const auto& values)
{
  return fmt::format("{:.17g}", fmt::join(values, " "));
}

inline std::string numbers(const Point<3>& x)
{
  return fmt::format("{:.17g} {:.17g} {:.17g}", x[0], x[1], x[2]);
}

/// `columns` of x y z ux uy uz sxx syy szz sxy syz sxz.
inline std::string csv(const mesh::ImportedMesh& mesh, const std::vector<std::string>& columns,
                       const std::string& separator)
{
  std::string text = fmt::format("# another program\n{}\n", fmt::join(columns, separator));
  for (const Point<3>& x : mesh.nodes)
  {
    const Point<3> u = displacement_at(x);
    const auto s = stress_at(x);
    const std::map<std::string, double> values = {{"x", x[0]},   {"y", x[1]},   {"z", x[2]},   {"ux", u[0]},
                                                  {"uy", u[1]},  {"uz", u[2]},  {"sxx", s[0]}, {"syy", s[1]},
                                                  {"szz", s[2]}, {"sxy", s[3]}, {"syz", s[4]}, {"sxz", s[5]}};
    std::vector<std::string> row;
    for (const std::string& column : columns) row.push_back(fmt::format("{:.17g}", values.at(column)));
    text += fmt::format("{}\n", fmt::join(row, separator));
  }
  return text;
}

inline std::string vtk_array(const std::string& name, int n_components, const std::string& values,
                             const std::string& type = "Float64")
{
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">{}</DataArray>\n", type,
      name, n_components, values);
}

/// Vectors of 3 components and tensors of 9, cells of Lagrange's types, as FEniCSx writes them.
inline std::string vtu(const mesh::ImportedMesh& mesh)
{
  static const std::map<mesh::Shape, int> types = {{mesh::Shape::triangle, 69},
                                                   {mesh::Shape::quadrilateral, 70},
                                                   {mesh::Shape::tetrahedron, 71},
                                                   {mesh::Shape::hexahedron, 72},
                                                   {mesh::Shape::prism, 73}};
  std::string x;
  std::string u;
  std::string s;
  for (const Point<3>& point : mesh.nodes)
  {
    x += numbers(point) + "\n";
    u += numbers(displacement_at(point)) + "\n";
    s += numbers(tensor_at(point)) + "\n";
  }
  std::string nodes;
  std::string ends;
  std::string kinds;
  std::size_t end = 0;
  for (const mesh::ElementBlock& block : mesh.cells)
    for (std::size_t e = 0; e < block.size(); ++e)
    {
      const int number = types.at(block.type.shape);
      const auto& order = mesh::find_vtk_type(number, block.type.n_nodes, false)->order;
      std::vector<Index> cell(block.type.n_nodes);
      for (std::size_t i = 0; i < cell.size(); ++i) cell[order.empty() ? i : order[i]] = block.element(e)[i];
      nodes += fmt::format("{}\n", fmt::join(cell, " "));
      ends += fmt::format("{} ", end += cell.size());
      kinds += fmt::format("{} ", number);
    }
  std::size_t n_cells = 0;
  for (const mesh::ElementBlock& block : mesh.cells) n_cells += block.size();
  return fmt::format(
             "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" "
             "version=\"2.2\">\n<UnstructuredGrid>"
             "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
             mesh.nodes.size(), n_cells) +
         "<Points>" + vtk_array("Points", 3, x) + "</Points>\n<Cells>" +
         vtk_array("connectivity", 1, nodes, "Int64") + vtk_array("offsets", 1, ends, "Int64") +
         vtk_array("types", 1, kinds, "UInt8") + "</Cells>\n<PointData>" +
         vtk_array("p", 1, numbers(std::vector<double>(mesh.nodes.size(), 1))) + vtk_array("u", 3, u) +
         vtk_array("sigma", 9, s) + "</PointData></Piece></UnstructuredGrid></VTKFile>\n";
}

inline mesh::ImportedMesh box(const mesh::ElementType& type)
{
  std::mt19937 random(7);
  return ImportedBox(type, {2, 1, 1}, random).take();
}

inline double stress_error(const std::array<double, 6>& stress, const Point<3>& x)
{
  double largest = 0;
  for (std::size_t i = 0; i < stress.size(); ++i)
    largest = std::max(largest, std::abs(stress[i] - stress_at(x)[i]));
  return largest;
}

/// Every value belongs to its node.
inline void expect_field(const mesh::ImportedSolution& solution, std::size_t n_nodes,
                         double tolerance = 1e-12)
{
  ASSERT_EQ(solution.mesh.nodes.size(), n_nodes);
  ASSERT_EQ(solution.displacement.size(), n_nodes);
  for (std::size_t v = 0; v < n_nodes; ++v)
    EXPECT_LT((solution.displacement[v] - displacement_at(solution.mesh.nodes[v])).norm(), tolerance);
  if (!solution.stress_of_elements)
  {
    ASSERT_EQ(solution.stress.size(), n_nodes);
    for (std::size_t v = 0; v < n_nodes; ++v)
      EXPECT_LT(stress_error(solution.stress[v], solution.mesh.nodes[v]), 1e5 * tolerance);
  }
  EXPECT_EQ(misplaced_nodes(solution.mesh), "");
}

inline void expect_steps(const mesh::ImportedSolution& solution,
                         const std::vector<mesh::SolutionStep>& expected)
{
  ASSERT_EQ(solution.steps.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
  {
    EXPECT_EQ(solution.steps[i].number, expected[i].number);
    EXPECT_EQ(solution.steps[i].t, expected[i].t);
  }
}

}  // namespace tribound::testing_mesh
