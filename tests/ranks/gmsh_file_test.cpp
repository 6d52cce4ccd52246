/// @file gmsh_file_test.cpp
/// A mesh shared by several ranks; the first rank writes it without having its cells.

#include "tribound/io/fields/gmsh_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "support/meshes.h"
#include "support/meshes_by_place.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/mesh/import/read.h"
#include "tribound/mesh/share_out.h"

namespace tribound::test
{
namespace
{

/// In 2D the cells come in several batches.
template <int dim>
mesh::Mesh<dim> whole_mesh()
{
  mesh::MeshData<dim> data;
  if constexpr (dim == 2)
    data = box<2>({0, 0}, {2, 1}, {400, 200});
  else
    data = box<3>({0, 0, 0}, {2, 1, 1}, {5, 4, 3});
  data.region_names = {"soft ground", "wall"};
  for (std::size_t c = 0; c < data.regions.size(); ++c) data.regions[c] = c % 3 == 0;
  return mesh::Mesh<dim>(std::move(data));
}

template <int dim>
void expect_written_whole()
{
  const Ranks ranks = Ranks::world();
  const mesh::Mesh<dim> whole = whole_mesh<dim>();
  const mesh::Mesh<dim> part = mesh::share_out<dim>(ranks, ranks.is_first() ? &whole : nullptr);
  const std::filesystem::path file =
      std::filesystem::path(::testing::TempDir()) / ("shared_" + std::to_string(::getpid()) + ".msh");
  const std::vector<std::string> left_out = {"top"};
  io::write_gmsh<dim>(file, part, left_out);
  if (!ranks.is_first()) return;
  const auto again = std::get<mesh::Mesh<dim>>(mesh::read_mesh(mesh::MeshFile{file, {}}));
  std::filesystem::remove(file);
  EXPECT_EQ(again.n_vertices(), whole.n_vertices());
  EXPECT_EQ(cells_by_place(again), cells_by_place(whole));
  NamedPlaces facets = facets_by_place(whole);
  for (auto& [name, _] : facets)
    if (name == "top") name = "";
  std::ranges::sort(facets);
  EXPECT_EQ(facets_by_place(again), facets);
}

TEST(GmshFile, OfSeveralRanksIsTheWholeMesh)
{
  expect_written_whole<2>();
  expect_written_whole<3>();
}

TEST(GmshFile, ThatCannotBeWrittenEndsAllRanks)
{
  const Ranks ranks = Ranks::world();
  const mesh::Mesh<3> whole = whole_mesh<3>();
  const mesh::Mesh<3> part = mesh::share_out<3>(ranks, ranks.is_first() ? &whole : nullptr);
  EXPECT_ANY_THROW(io::write_gmsh<3>("/nowhere/at/all.msh", part));
}

}  // namespace
}  // namespace tribound::test
