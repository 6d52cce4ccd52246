#include "tribound/mesh/import/vtk_cell_type.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace tribound::mesh
{

namespace
{

constexpr std::array pixel = {0, 1, 3, 2};
constexpr std::array voxel = {0, 1, 3, 2, 4, 5, 7, 6};
// VTK has the centres of the faces in the order x = 0, 1, y = 0, 1, z = 0, 1.
constexpr std::array triquadratic = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13,
                                     14, 15, 16, 17, 18, 19, 24, 25, 22, 21, 23, 20, 26};
constexpr std::array old_hexahedron = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13,
                                       14, 15, 16, 17, 19, 18, 24, 25, 22, 21, 23, 20, 26};

constexpr std::int64_t lagrange_hexahedron = 72;

const std::array<VtkCellType, 38> vtk_types = {{{3, {Shape::segment, 2}, {}},
                                                {21, {Shape::segment, 3}, {}},
                                                {68, {Shape::segment, 2}, {}},
                                                {68, {Shape::segment, 3}, {}},
                                                {68, {Shape::segment, 4}, {}},
                                                {68, {Shape::segment, 5}, {}},
                                                {5, {Shape::triangle, 3}, {}},
                                                {22, {Shape::triangle, 6}, {}},
                                                {69, {Shape::triangle, 3}, {}},
                                                {69, {Shape::triangle, 6}, {}},
                                                {69, {Shape::triangle, 10}, {}},
                                                {69, {Shape::triangle, 15}, {}},
                                                {8, {Shape::quadrilateral, 4}, pixel},
                                                {9, {Shape::quadrilateral, 4}, {}},
                                                {23, {Shape::quadrilateral, 8}, {}},
                                                {28, {Shape::quadrilateral, 9}, {}},
                                                {70, {Shape::quadrilateral, 4}, {}},
                                                {70, {Shape::quadrilateral, 9}, {}},
                                                {10, {Shape::tetrahedron, 4}, {}},
                                                {24, {Shape::tetrahedron, 10}, {}},
                                                {71, {Shape::tetrahedron, 4}, {}},
                                                {71, {Shape::tetrahedron, 10}, {}},
                                                {71, {Shape::tetrahedron, 20}, {}},
                                                {71, {Shape::tetrahedron, 35}, {}},
                                                {11, {Shape::hexahedron, 8}, voxel},
                                                {12, {Shape::hexahedron, 8}, {}},
                                                {25, {Shape::hexahedron, 20}, {}},
                                                {29, {Shape::hexahedron, 27}, triquadratic},
                                                {lagrange_hexahedron, {Shape::hexahedron, 8}, {}},
                                                {lagrange_hexahedron, {Shape::hexahedron, 27}, triquadratic},
                                                {13, {Shape::prism, 6}, {}},
                                                {26, {Shape::prism, 15}, {}},
                                                {32, {Shape::prism, 18}, {}},
                                                {73, {Shape::prism, 6}, {}},
                                                {73, {Shape::prism, 18}, {}},
                                                {14, {Shape::pyramid, 5}, {}},
                                                {27, {Shape::pyramid, 13}, {}},
                                                {74, {Shape::pyramid, 5}, {}}}};

const VtkCellType old_type = {lagrange_hexahedron, {Shape::hexahedron, 27}, old_hexahedron};

constexpr std::array<std::pair<std::int64_t, std::string_view>, 27> names = {
    {{0, "empty cell"},
     {1, "vertex"},
     {2, "set of vertices"},
     {4, "polyline"},
     {6, "strip of triangles"},
     {7, "polygon"},
     {15, "pentagonal prism"},
     {16, "hexagonal prism"},
     {30, "quadratic-linear quadrilateral"},
     {31, "quadratic-linear wedge"},
     {33, "hexahedron of 24 nodes"},
     {34, "triangle of 7 nodes"},
     {35, "cubic line"},
     {36, "quadratic polygon"},
     {37, "pyramid of 19 nodes"},
     {42, "polyhedron"},
     {68, "Lagrange curve"},
     {69, "Lagrange triangle"},
     {70, "Lagrange quadrilateral"},
     {71, "Lagrange tetrahedron"},
     {lagrange_hexahedron, "Lagrange hexahedron"},
     {73, "Lagrange wedge"},
     {74, "Lagrange pyramid"},
     {75, "Bezier curve"},
     {76, "Bezier triangle"},
     {79, "Bezier hexahedron"},
     {78, "Bezier tetrahedron"}}};

}  // namespace

const VtkCellType* find_vtk_type(std::int64_t number, std::size_t n_nodes, bool has_old_hexahedra)
{
  const auto n = static_cast<int>(std::min<std::size_t>(n_nodes, 1000));
  if (has_old_hexahedra && number == lagrange_hexahedron && n == old_type.type.n_nodes) return &old_type;
  const auto found = std::ranges::find_if(
      vtk_types, [&](const VtkCellType& known) { return known.number == number && known.type.n_nodes == n; });
  return found == vtk_types.end() ? nullptr : &*found;
}

std::string vtk_type_name(std::int64_t number)
{
  const auto found = std::ranges::find(names, number, &std::pair<std::int64_t, std::string_view>::first);
  if (found != names.end()) return std::string(found->second);
  const auto known = std::ranges::find(vtk_types, number, &VtkCellType::number);
  return known == vtk_types.end() ? "unknown cell" : std::string(table_of(known->type.shape).name);
}

}  // namespace tribound::mesh
