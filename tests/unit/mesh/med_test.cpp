/// Meshes of Salome: versions, groups, orientations, damaged files. HDF5 writes them here; those of libmed
/// and meshio: read_foreign.cpp.

#include "tribound/mesh/import/med.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "unit/mesh/imported_testing.h"
#include "unit/mesh/mesh_testing.h"

namespace tribound
{

namespace
{

using testing_mesh::cell_types;
using testing_mesh::Directory;
using testing_mesh::ImportedBox;
using testing_mesh::message_of;
using testing_mesh::volume;

/// Writes groups, attributes and arrays by their whole names.
class MedFile
{
 public:
  explicit MedFile(const std::filesystem::path& file)
      : file_(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)),
        links_(H5Pcreate(H5P_LINK_CREATE))
  {
    H5Pset_create_intermediate_group(links_, 1);
  }
  ~MedFile()
  {
    H5Pclose(links_);
    H5Fclose(file_);
  }
  MedFile(const MedFile&) = delete;
  MedFile& operator=(const MedFile&) = delete;

  void group(const std::string& name) const
  {
    H5Gclose(H5Gcreate2(file_, name.c_str(), links_, H5P_DEFAULT, H5P_DEFAULT));
  }
  void attribute(const std::string& object, const std::string& name, int value) const
  {
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t id = H5Acreate_by_name(file_, object.c_str(), name.c_str(), H5T_NATIVE_INT, space,
                                       H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(id, H5T_NATIVE_INT, &value);
    H5Aclose(id);
    H5Sclose(space);
  }
  void array(const std::string& name, hid_t type, hsize_t n, const void* values) const
  {
    const hid_t space = H5Screate_simple(1, &n, nullptr);
    const hid_t id = H5Dcreate2(file_, name.c_str(), type, space, links_, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    H5Dclose(id);
    H5Sclose(space);
  }
  void integers(const std::string& name, const std::vector<int>& values) const
  {
    array(name, H5T_NATIVE_INT, values.size(), values.data());
  }

 private:
  hid_t file_;
  hid_t links_;
};

std::string med_type(const mesh::ElementType& type)
{
  constexpr std::array<std::string_view, 7> letters = {"SE", "TR", "QU", "TE", "HE", "PE", "PY"};
  const std::string letter(letters[static_cast<std::size_t>(type.shape)]);
  return type.n_nodes < 10 ? fmt::format("{}{}", letter, type.n_nodes)
                           : fmt::format("{}{}", letter[0], type.n_nodes);
}

struct MedOptions
{
  bool has_step = true;         ///< from version 3 on
  bool has_flat_names = false;  ///< characters in one row, as in version 2
  std::vector<std::vector<std::string>> groups = {{"left"}, {"right", "rest"}, {"bottom"}, {"top"}};
};

void write_block(const MedFile& file, const std::string& path, const mesh::ElementBlock& block,
                 const std::vector<int>& families)
{
  std::vector<int> nodes;
  for (int i = 0; i < block.type.n_nodes; ++i)
    for (std::size_t e = 0; e < block.size(); ++e) nodes.push_back(block.element(e)[i] + 1);
  const std::string group = path + "/MAI/" + med_type(block.type);
  file.integers(group + "/NOD", nodes);
  file.integers(group + "/FAM", families);
}

void write_family(const MedFile& file, const std::string& path, int number,
                  const std::vector<std::string>& groups, bool is_flat)
{
  std::string names;
  for (const std::string& group : groups)
    names += group + std::string(80 - group.size(), is_flat ? ' ' : '\0');
  file.group(path);
  file.attribute(path, "NUM", number);
  const hsize_t length = 80;
  const hid_t type = is_flat ? H5Tcopy(H5T_NATIVE_CHAR) : H5Tarray_create2(H5T_NATIVE_CHAR, 1, &length);
  file.array(path + "/GRO/NOM", type, is_flat ? names.size() : groups.size(), names.data());
  H5Tclose(type);
}

/// Families -1 and -2: cells left and right; -3: the facets of the bottom; 4: the nodes of the top.
void write_med(const std::filesystem::path& to, const mesh::ImportedMesh& box, const MedOptions& options)
{
  const MedFile file(to);
  const int dim = mesh::table_of(box.cells[0].type.shape).dim;
  const std::string mesh = "/ENS_MAA/box";
  const std::string path = options.has_step ? mesh + "/-0000000000000000001-0000000000000000001" : mesh;
  std::vector<double> x;
  for (int i = 0; i < dim; ++i)
    for (const Point<3>& node : box.nodes) x.push_back(node[i]);
  file.array(path + "/NOE/COO", H5T_NATIVE_DOUBLE, x.size(), x.data());
  file.attribute(mesh, "DIM", dim);
  if (options.has_step) file.attribute(mesh, "ESP", dim);
  std::vector<int> of_nodes(box.nodes.size(), 0);
  for (const Index node : box.node_sets[0].nodes) of_nodes[node] = 4;
  file.integers(path + "/NOE/FAM", of_nodes);
  std::vector<int> of_cells(box.cells[0].size(), -1);
  for (const Index cell : box.cell_sets[1].cells) of_cells[cell] = -2;
  write_block(file, path, box.cells[0], of_cells);
  for (const mesh::ElementBlock& facets : box.facet_sets[0].facets)
    write_block(file, path, facets, std::vector<int>(facets.size(), -3));
  for (int k = 0; k < 4; ++k)
    write_family(file, fmt::format("/FAS/box/{}/F{}", k < 3 ? "ELEME" : "NOEUD", k), k < 3 ? -1 - k : 4,
                 options.groups[k], options.has_flat_names);
}

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
