#include "tribound/io/fields/gmsh_file.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string_view>
#include <vector>

#include "tribound/base/ranks.h"
#include "tribound/fem/node_numbers.h"
#include "tribound/io/file/atomic_file.h"

namespace tribound::io
{

namespace
{

/// Gmsh's numbers for line, triangle, tetrahedron.
constexpr std::array element_types = {1, 2, 4};

/// Number of vertices, facets or cells whose text is in memory at a time.
constexpr std::int64_t batch = 50'000;

/// Writes the text added by say(text, i) for the n items of each rank into the file of the first rank, rank
/// by rank.
template <class Say>
void write_in_turn(const Ranks& ranks, std::optional<AtomicFile>& file, std::int64_t n, const Say& say)
{
  std::vector<std::int64_t> n_of_rank(ranks.size(), 0);
  n_of_rank[ranks.rank()] = n;
  ranks.sum(std::span(n_of_rank));
  for (int turn = 0; turn < ranks.size(); ++turn)
    for (std::int64_t first = 0; first < n_of_rank[turn]; first += batch)
    {
      std::string text;
      if (turn == ranks.rank())
        for (std::int64_t i = first; i < std::min(first + batch, n); ++i) say(text, i);
      const std::vector<char> told = ranks.gather<char>(text);
      ranks.on_first([&] { file->write(std::string_view(told.data(), told.size())); });
    }
}

/// The physical groups: boundaries, then regions.
template <int dim>
std::string head(const mesh::Mesh<dim>& mesh, std::span<const std::string> left_out)
{
  std::string groups;
  long n_groups = 0;
  const auto add = [&](int dimension, std::span<const std::string> names)
  {
    for (std::size_t i = 0; i < names.size(); ++i)
    {
      if (dimension < dim && std::ranges::count(left_out, names[i]) > 0) continue;
      fmt::format_to(std::back_inserter(groups), "{} {} \"{}\"\n", dimension, i + 1, names[i]);
      ++n_groups;
    }
  };
  add(dim - 1, mesh.boundary_names());
  add(dim, mesh.region_names());
  return fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{}\n{}$EndPhysicalNames\n",
                     n_groups, groups);
}

/// Own facets in groups that are written.
template <int dim>
std::vector<mesh::BoundaryFacet> written_facets(const mesh::Mesh<dim>& mesh,
                                                std::span<const std::string> left_out)
{
  std::vector<mesh::BoundaryFacet> facets;
  for (const mesh::BoundaryFacet& facet : mesh.owned_boundary())
    if (facet.tag >= 0 && std::ranges::count(left_out, mesh.boundary_names()[facet.tag]) == 0)
      facets.push_back(facet);
  return facets;
}

}  // namespace

template <int dim>
void write_gmsh(const std::filesystem::path& path, const mesh::Mesh<dim>& mesh,
                std::span<const std::string> left_out)
{
  const Ranks& ranks = mesh.ranks();
  std::optional<AtomicFile> file;
  ranks.on_first([&] { file.emplace(path); });
  const auto write = [&](const std::string& text) { ranks.on_first([&] { file->write(text); }); };
  const std::span corners(mesh.n_cells() > 0 ? mesh.cell(0).data() : nullptr,
                          mesh.cells().size() * (dim + 1));
  const auto shared = fem::number_nodes<dim>(mesh, mesh.n_vertices(), corners, dim + 1);

  write(head<dim>(mesh, left_out) + fmt::format("$Nodes\n{}\n", mesh.n_global_vertices()));
  write_in_turn(ranks, file, shared ? static_cast<std::int64_t>(shared->owned.size()) : mesh.n_vertices(),
                [&](std::string& text, std::int64_t i)
                {
                  const Index v = shared ? shared->owned[i] : static_cast<Index>(i);
                  fmt::format_to(std::back_inserter(text), FMT_COMPILE("{}"),
                                 (shared ? shared->first : 0) + i + 1);
                  for (const double x : mesh.vertex(v))
                    fmt::format_to(std::back_inserter(text), FMT_COMPILE(" {}"), x);
                  text += dim == 2 ? " 0\n" : "\n";
                });

  const auto add = [&](std::string& text, std::int64_t number, int group, const auto& vertices)
  {
    fmt::format_to(std::back_inserter(text), FMT_COMPILE("{} {} 2 {} {}"), number + 1,
                   element_types[vertices.size() - 2], group + 1, group + 1);
    for (const Index v : vertices)
      fmt::format_to(std::back_inserter(text), FMT_COMPILE(" {}"), (shared ? shared->global[v] : v) + 1);
    text += '\n';
  };
  const std::vector<mesh::BoundaryFacet> facets = written_facets<dim>(mesh, left_out);
  const auto n_facets = static_cast<std::int64_t>(facets.size());
  const std::int64_t n_all_facets = ranks.sum(n_facets);
  const std::int64_t first_facet = ranks.before(n_facets);
  const std::int64_t first_cell = n_all_facets + ranks.before(std::int64_t{mesh.n_owned_cells()});
  write(fmt::format("$EndNodes\n$Elements\n{}\n", n_all_facets + mesh.n_global_cells()));
  write_in_turn(ranks, file, n_facets,
                [&](std::string& text, std::int64_t i)
                {
                  const mesh::BoundaryFacet& facet = facets[i];
                  add(text, first_facet + i, facet.tag,
                      mesh::facet_vertices(mesh.cell(facet.cell), facet.local));
                });
  write_in_turn(ranks, file, mesh.n_owned_cells(),
                [&](std::string& text, std::int64_t i)
                {
                  const auto c = static_cast<Index>(i);
                  add(text, first_cell + i, mesh.region(c), mesh.cell(c));
                });
  write("$EndElements\n");
  ranks.on_first([&] { file->commit(); });
}

template void write_gmsh(const std::filesystem::path&, const mesh::Mesh<2>&, std::span<const std::string>);
template void write_gmsh(const std::filesystem::path&, const mesh::Mesh<3>&, std::span<const std::string>);

}  // namespace tribound::io
