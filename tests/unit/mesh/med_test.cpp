/// Meshes of Salome: versions, groups, orientations, damaged files. HDF5 writes them here; those of libmed
/// and meshio: read_foreign.cpp.

#include "tribound/mesh/import/med.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "unit/mesh/med_files.h"
#include "unit/mesh/mesh_testing.h"

namespace tribound
{

namespace
{

using testing_mesh::cell_types;
using testing_mesh::Directory;
using testing_mesh::ImportedBox;
using testing_mesh::MedFile;
using testing_mesh::message_of;
using testing_mesh::volume;
using testing_mesh::write_block;
using testing_mesh::write_med;

mesh::ImportedMesh hexahedra()
{
  std::mt19937 random(5);
  return ImportedBox({mesh::Shape::hexahedron, 8}, {3, 2, 2}, random).take();
}

template <class Mesh>
double measure_of_med(const Mesh& mesh, const std::string& name)
{
  const auto names = mesh.boundary_names();
  return testing_mesh::boundary_measure(mesh,
                                        static_cast<int>(std::ranges::find(names, name) - names.begin()));
}

class ImportFromMed : public testing::TestWithParam<mesh::ElementType>
{
};

TEST_P(ImportFromMed, OfThisTypeIsRead)
{
  std::mt19937 random(13);
  const mesh::ImportedMesh box = ImportedBox(GetParam(), {3, 2, 2}, random).take();
  const Directory directory;
  for (const bool is_old : {false, true})
  {
    write_med(directory / "box.med", box,
              {.has_step = !is_old,
               .has_flat_names = is_old,
               .groups = {{"left"}, {"right"}, {"bottom"}, {"top"}}});
    EXPECT_EQ(testing_mesh::misplaced_nodes(mesh::read_med(directory / "box.med")), "");
    std::visit(
        [&]<int d>(const mesh::Mesh<d>& mesh)
        {
          EXPECT_NEAR(volume(mesh), d == 2 ? 6 : 12, 1e-12);
          EXPECT_THAT(mesh.region_names(), testing::ElementsAre("left", "right"));
          EXPECT_THAT(mesh.boundary_names(), testing::ElementsAre("bottom", "top"));
          EXPECT_NEAR(measure_of_med(mesh, "bottom"), d == 2 ? 3 : 6, 1e-12);
          EXPECT_NEAR(measure_of_med(mesh, "top"), d == 2 ? 3 : 6, 1e-12);
        },
        mesh::read_mesh(mesh::MeshFile{directory / "box.med"}));
  }
}

INSTANTIATE_TEST_SUITE_P(Med, ImportFromMed, testing::ValuesIn(cell_types),
                         [](const auto& info) {
                           return std::string(mesh::table_of(info.param.shape).name) +
                                  std::to_string(info.param.n_nodes);
                         });

std::vector<std::string> regions_of(const std::vector<std::vector<std::string>>& groups)
{
  const Directory directory;
  write_med(directory / "box.med", hexahedra(), {.groups = groups});
  std::vector<std::string> names;
  for (const mesh::CellSet& set : mesh::read_med(directory / "box.med").cell_sets) names.push_back(set.name);
  return names;
}

TEST(Med, RegionsAreTheGroupsThatHaveEveryElementOnce)
{
  EXPECT_THAT(regions_of({{"all", "a"}, {"b", "all"}, {"c"}, {}}), testing::ElementsAre("a", "b"));
  EXPECT_THAT(regions_of({{"all", "a"}, {"all"}, {}, {}}), testing::ElementsAre("all"));
  EXPECT_THAT(regions_of({{"all"}, {"every", "all"}, {}, {}}), testing::ElementsAre("all"));
  EXPECT_THAT(regions_of({{}, {}, {}, {}}), testing::IsEmpty());
  const std::string message = message_of([] { (void)regions_of({{"a"}, {}, {}, {}}); });
  EXPECT_THAT(message, testing::HasSubstr("do not say which region an element is in: element"));
  EXPECT_THAT(message, testing::HasSubstr("is in no set"));
}

TEST(Med, WhatIsNotReadIsNamed)
{
  const Directory directory;
  const auto message = [&](const std::function<void(const MedFile&)>& write)
  {
    {
      const MedFile file(directory / "bad.med");
      write(file);
    }
    return message_of([&] { (void)mesh::read_med(directory / "bad.med"); });
  };
  EXPECT_THAT(message([](const MedFile&) {}), testing::HasSubstr("bad.med: is no .med"));
  EXPECT_THAT(message(
                  [](const MedFile& file)
                  {
                    file.group("/ENS_MAA/a");
                    file.group("/ENS_MAA/b");
                  }),
              testing::HasSubstr("has 2 meshes: a, b"));
  const auto nodes = [](const MedFile& file)
  {
    const std::vector<double> x = {0, 1, 0, 0, 0, 1};
    file.array("/ENS_MAA/m/NOE/COO", H5T_NATIVE_DOUBLE, x.size(), x.data());
    file.attribute("/ENS_MAA/m", "DIM", 2);
  };
  EXPECT_THAT(message(
                  [&](const MedFile& file)
                  {
                    nodes(file);
                    file.integers("/ENS_MAA/m/MAI/PO3/NOD", {1, 2, 3});
                  }),
              testing::HasSubstr("has elements of type PO3, which are not read"));
  EXPECT_THAT(
      message(
          [&](const MedFile& file)
          {
            nodes(file);
            file.integers("/ENS_MAA/m/MAI/TR3/NOD", {1, 2, 4});
          }),
      testing::HasSubstr("node 4 of element 1 (triangle of 3 nodes) does not exist: there are 3 nodes"));
  EXPECT_THAT(message(
                  [&](const MedFile& file)
                  {
                    nodes(file);
                    file.integers("/ENS_MAA/m/MAI/SE2/NOD", {1, 2});
                  }),
              testing::HasSubstr("neither plane elements nor solids"));
  EXPECT_THAT(message_of([&] { (void)mesh::read_mesh(directory.write("text.med", "hello")); }),
              testing::HasSubstr("text.med: is no HDF5 file"));
}

/// HDF5 crashes at some of them.
TEST(Med, DamagedFilesEndInAMessage)
{
  const Directory directory;
  write_med(directory / "box.med", hexahedra(), {});
  std::ifstream in(directory / "box.med", std::ios::binary);
  const std::string sound((std::istreambuf_iterator<char>(in)), {});
  std::mt19937 random(17);
  const auto below = [&](std::size_t n)
  { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  int n_read = 0;
  for (int k = 0; k < 200; ++k)
  {
    std::string text = sound;
    for (std::size_t n = 1 + below(2); n > 0; --n)
    {
      const std::size_t at = below(text.size());
      if (below(8) == 0)
        text.resize(at + 1);
      else
        text[at] = static_cast<char>(below(2) == 0 ? 255 : below(256));
    }
    if (testing_mesh::gives_mesh_or_message(directory.write("damaged.med", text))) ++n_read;
  }
  EXPECT_GT(n_read, 0);
}

}  // namespace

}  // namespace tribound
