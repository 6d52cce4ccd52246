#pragma once

/// Meshes written as .med by HDF5, as libmed does.

#include <fmt/format.h>
#include <hdf5.h>

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "unit/mesh/imported_testing.h"

namespace tribound::testing_mesh
{

/// Writes groups, attributes and arrays by their whole names.
class MedFile
{
 public:
  /// `access` H5F_ACC_RDWR adds to a file.
  explicit MedFile(const std::filesystem::path& file, unsigned access = H5F_ACC_TRUNC)
      : file_(access == H5F_ACC_TRUNC ? H5Fcreate(file.c_str(), access, H5P_DEFAULT, H5P_DEFAULT)
                                      : H5Fopen(file.c_str(), access, H5P_DEFAULT)),
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
  /// A number: int or double.
  template <class T>
  void attribute(const std::string& object, const std::string& name, T value) const
  {
    const hid_t type = std::is_same_v<T, int> ? H5T_NATIVE_INT : H5T_NATIVE_DOUBLE;
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t id = H5Acreate_by_name(file_, object.c_str(), name.c_str(), type, space, H5P_DEFAULT,
                                       H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(id, type, &value);
    H5Aclose(id);
    H5Sclose(space);
  }
  void attribute(const std::string& object, const std::string& name, const std::string& text) const
  {
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, text.size() + 1);
    const hid_t id = H5Acreate_by_name(file_, object.c_str(), name.c_str(), type, space, H5P_DEFAULT,
                                       H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(id, type, text.c_str());
    H5Aclose(id);
    H5Tclose(type);
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

inline std::string med_type(const mesh::ElementType& type)
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

inline void write_block(const MedFile& file, const std::string& path, const mesh::ElementBlock& block,
                        const std::vector<int>& families)
{
  std::vector<int> nodes;
  for (int i = 0; i < block.type.n_nodes; ++i)
    for (std::size_t e = 0; e < block.size(); ++e) nodes.push_back(block.element(e)[i] + 1);
  const std::string group = path + "/MAI/" + med_type(block.type);
  file.integers(group + "/NOD", nodes);
  file.integers(group + "/FAM", families);
}

inline void write_family(const MedFile& file, const std::string& path, int number,
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
inline void write_med(const std::filesystem::path& to, const mesh::ImportedMesh& box,
                      const MedOptions& options)
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

}  // namespace tribound::testing_mesh
