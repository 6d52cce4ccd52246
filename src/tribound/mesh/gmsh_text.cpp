#include "tribound/mesh/gmsh_text.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

namespace tribound::mesh
{

namespace
{

/// Gmsh's numbers for line, triangle, tetrahedron.
constexpr std::array element_types = {1, 2, 4};

template <std::size_t n>
void add_element(std::string& text, long number, int group, const std::array<Index, n>& vertices)
{
  fmt::format_to(std::back_inserter(text), FMT_COMPILE("{} {} 2 {} {}"), number, element_types[n - 2],
                 group + 1, group + 1);
  for (const Index v : vertices) fmt::format_to(std::back_inserter(text), FMT_COMPILE(" {}"), v + 1);
  text += '\n';
}

}  // namespace

template <int dim>
std::string gmsh_text(const Mesh<dim>& mesh, std::span<const std::string> left_out)
{
  const auto regions = mesh.region_names();
  const auto boundaries = mesh.boundary_names();
  const auto is_written = [&](const BoundaryFacet& facet)
  { return facet.tag >= 0 && std::ranges::count(left_out, boundaries[facet.tag]) == 0; };
  std::string groups;
  long n_groups = 0;
  const auto add_group = [&](int dimension, std::size_t number, const std::string& name)
  {
    fmt::format_to(std::back_inserter(groups), "{} {} \"{}\"\n", dimension, number + 1, name);
    ++n_groups;
  };
  for (std::size_t b = 0; b < boundaries.size(); ++b)
    if (std::ranges::count(left_out, boundaries[b]) == 0) add_group(dim - 1, b, boundaries[b]);
  for (std::size_t r = 0; r < regions.size(); ++r) add_group(dim, r, regions[r]);

  std::string text = fmt::format(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{}\n{}$EndPhysicalNames\n$Nodes\n{}\n", n_groups,
      groups, mesh.n_vertices());
  for (Index v = 0; v < mesh.n_vertices(); ++v)
  {
    fmt::format_to(std::back_inserter(text), FMT_COMPILE("{}"), v + 1);
    for (const double x : mesh.vertex(v)) fmt::format_to(std::back_inserter(text), FMT_COMPILE(" {}"), x);
    text += dim == 2 ? " 0\n" : "\n";
  }
  const long n_facets = std::ranges::count_if(mesh.boundary(), is_written);
  text += fmt::format("$EndNodes\n$Elements\n{}\n", n_facets + mesh.n_cells());
  long number = 0;
  for (const BoundaryFacet& facet : mesh.boundary())
    if (is_written(facet))
      add_element(text, ++number, facet.tag, facet_vertices(mesh.cell(facet.cell), facet.local));
  for (Index c = 0; c < mesh.n_cells(); ++c) add_element(text, ++number, mesh.region(c), mesh.cell(c));
  return text + "$EndElements\n";
}

template std::string gmsh_text(const Mesh<2>&, std::span<const std::string>);
template std::string gmsh_text(const Mesh<3>&, std::span<const std::string>);

}  // namespace tribound::mesh
