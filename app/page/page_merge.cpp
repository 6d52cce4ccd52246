#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "app/page/page_surface.h"

namespace tribound::app
{

namespace
{

/// For each vertex, the body of its faces.
std::vector<Index> bodies_of_vertices(const Surface& surface, int dim)
{
  std::vector<Index> body(surface.points.size() / dim);
  for (std::size_t i = 0; i < surface.faces.size(); ++i)
    body[surface.faces[i]] = surface.bodies[i / surface.n_face_points()];
  return body;
}

/// For each vertex, the first vertex of the same body in the same square or cube of a grid.
std::vector<Index> first_in_grid_cell(const Surface& surface, int dim, double width)
{
  const std::size_t n = surface.points.size() / dim;
  const std::vector<Index> body = bodies_of_vertices(surface, dim);
  std::vector<std::array<std::int64_t, 5>> keys(n);
  for (std::size_t v = 0; v < n; ++v)
  {
    for (int i = 0; i < dim; ++i)
      keys[v][i] = static_cast<std::int64_t>(std::floor(surface.points[dim * v + i] / width));
    keys[v][3] = body[v];
    keys[v][4] = static_cast<std::int64_t>(v);
  }
  std::ranges::sort(keys);
  std::vector<Index> first(n);
  for (std::size_t i = 0, begin = 0; i < n; ++i)
  {
    if (!std::equal(keys[i].begin(), keys[i].begin() + 4, keys[begin].begin())) begin = i;
    first[keys[i][4]] = static_cast<Index>(keys[begin][4]);
  }
  return first;
}

bool survives(const Surface& surface, std::size_t face, std::span<const Index> first)
{
  const Index a = first[surface.faces[3 * face]];
  const Index b = first[surface.faces[3 * face + 1]];
  const Index c = first[surface.faces[3 * face + 2]];
  return a != b && b != c && c != a;
}

std::size_t n_surviving(const Surface& surface, std::span<const Index> first)
{
  std::size_t n = 0;
  for (std::size_t face = 0; face < surface.n_faces(); ++face) n += survives(surface, face, first) ? 1 : 0;
  return n;
}

/// Keeps the flagged blocks of `size` numbers; blocks beyond the end of a column do not exist.
template <typename T>
void keep(std::vector<T>& column, std::span<const char> kept, std::size_t size)
{
  std::size_t end = 0;
  for (std::size_t block = 0; block * size < column.size(); ++block)
    if (kept[block])
      for (std::size_t i = 0; i < size; ++i) column[end++] = column[block * size + i];
  column.resize(end);
}

/// Renumbers the vertices in the order of their first use by faces.
void drop_unused_vertices(Surface& surface, int dim)
{
  std::vector<Index> number(surface.points.size() / dim, -1);
  Index n = 0;
  std::vector<double> points;
  std::vector<double> displacement;
  for (Index& vertex : surface.faces)
  {
    if (number[vertex] < 0)
    {
      number[vertex] = n++;
      const auto place = static_cast<std::ptrdiff_t>(dim) * vertex;
      points.insert(points.end(), surface.points.begin() + place, surface.points.begin() + place + dim);
      displacement.insert(displacement.end(), surface.displacement.begin() + place,
                          surface.displacement.begin() + place + dim);
    }
    vertex = number[vertex];
  }
  surface.points = std::move(points);
  surface.displacement = std::move(displacement);
}

}  // namespace

void merge_details(Surface& surface, int dim, std::size_t max_triangles)
{
  assert(surface.subdivision == 1);
  const auto [low, high] = std::ranges::minmax(surface.points);
  double fine = 1e-7 * (high - low);  // too fine to merge anything
  double coarse = high - low;
  while (coarse > 1.2 * fine)
  {
    const double width = std::sqrt(fine * coarse);
    (n_surviving(surface, first_in_grid_cell(surface, dim, width)) > max_triangles ? fine : coarse) = width;
  }
  const std::vector<Index> first = first_in_grid_cell(surface, dim, coarse);
  std::vector<char> kept(surface.n_faces());
  for (std::size_t face = 0; face < kept.size(); ++face) kept[face] = survives(surface, face, first) ? 1 : 0;

  for (Index& vertex : surface.faces) vertex = first[vertex];
  keep(surface.faces, kept, 3);
  for (std::vector<double>& component : surface.stress) keep(component, kept, component.size() / kept.size());
  for (auto* column : {&surface.cells, &surface.bodies, &surface.facets}) keep(*column, kept, 1);
  SurfaceContact& contact = surface.contact;
  for (const auto column : value_columns) keep(contact.*column, kept, 3);
  keep(contact.point_status, kept, 3);
  keep(contact.status, kept, 1);

  drop_unused_vertices(surface, dim);
  surface.merged_below = coarse;
}

}  // namespace tribound::app
