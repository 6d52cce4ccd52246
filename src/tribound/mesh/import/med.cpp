#include "tribound/mesh/import/med.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <span>
#include <utility>

#include "tribound/mesh/import/cell_faces.h"
#include "tribound/mesh/import/cell_sets.h"
#include "tribound/mesh/import/face_centres.h"
#include "tribound/mesh/import/file_text.h"
#include "tribound/mesh/import/hdf5_group.h"
#include "tribound/mesh/import/imported_bytes.h"
#include "tribound/mesh/import/read_apart.h"

namespace tribound::mesh
{

namespace
{

/// Corners and edges are numbered as in VTK, in the opposite orientation.
constexpr std::array<std::pair<std::string_view, ElementType>, 18> med_types = {
    {{"SE2", {Shape::segment, 2}},
     {"SE3", {Shape::segment, 3}},
     {"TR3", {Shape::triangle, 3}},
     {"TR6", {Shape::triangle, 6}},
     {"QU4", {Shape::quadrilateral, 4}},
     {"QU8", {Shape::quadrilateral, 8}},
     {"QU9", {Shape::quadrilateral, 9}},
     {"TE4", {Shape::tetrahedron, 4}},
     {"T10", {Shape::tetrahedron, 10}},
     {"HE8", {Shape::hexahedron, 8}},
     {"H20", {Shape::hexahedron, 20}},
     {"H27", {Shape::hexahedron, 27}},
     {"PE6", {Shape::prism, 6}},
     {"P15", {Shape::prism, 15}},
     {"P18", {Shape::prism, 18}},
     {"PY5", {Shape::pyramid, 5}},
     {"P13", {Shape::pyramid, 13}},
     {"P14", {Shape::pyramid, 14}}}};

/// Elements of one type with the families that they are in.
struct MedBlock
{
  ElementBlock elements;
  std::vector<std::int64_t> families;
};

class MedReader
{
 public:
  explicit MedReader(const std::filesystem::path& path)
      : file_(path), mesh_{.source = {.file = path.string()}}, name_(name_of_mesh()), step_(step_of_mesh())
  {
  }

  ImportedMesh read(bool has_groups)
  {
    read_nodes();
    read_elements();
    if (has_groups) read_families();
    add_cells();
    add_facets();
    add_node_sets();
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem, const std::string& hint = {}) const
  {
    throw InputError(mesh_.source, problem, hint);
  }
  [[nodiscard]] std::string name_of_mesh() const;
  [[nodiscard]] Hdf5Group step_of_mesh() const;
  void read_nodes();
  void read_elements();
  void read_block(const Hdf5Group& group, const ElementType& type);
  void read_families();
  void read_family(const Hdf5Group& family);
  [[nodiscard]] static int dimension(const MedBlock& block)
  {
    return table_of(block.elements.type.shape).dim;
  }
  /// The groups of a family; none of family 0.
  [[nodiscard]] std::span<const std::string> groups_of(std::int64_t family) const;
  [[nodiscard]] std::vector<std::int64_t> families_of(const Hdf5Group& group, std::size_t n) const;
  [[nodiscard]] std::vector<std::int64_t> numbers_of(const Hdf5Group& group, std::size_t n) const;
  void add_cells();
  void add_facets();
  void add_node_sets();

  Hdf5Group file_;
  ImportedMesh mesh_;
  std::string name_;
  Hdf5Group step_;
  int dim_ = 3;
  std::vector<MedBlock> blocks_{};
  std::vector<std::int64_t> families_of_nodes_{};
  std::map<std::int64_t, std::vector<std::string>> groups_{};
};

std::string MedReader::name_of_mesh() const
{
  if (!file_.has("ENS_MAA")) fail("is no .med: it has no meshes (ENS_MAA)", "save the mesh again, by Salome");
  const std::vector<std::string> names = file_.group("ENS_MAA").names();
  if (names.size() != 1)
    fail(fmt::format("has {} meshes{} {}", names.size(), names.empty() ? "" : ":", fmt::join(names, ", ")),
         "a file with one mesh: export the one that is wanted");
  return names[0];
}

/// The group with the nodes: that of the mesh (2.2, 2.3), or that of its only time.
Hdf5Group MedReader::step_of_mesh() const
{
  Hdf5Group mesh = file_.group("ENS_MAA").group(name_);
  if (mesh.attribute("TYP").value_or(0) != 0)
    fail(fmt::format("mesh \"{}\" is structured", name_), "save it as an unstructured mesh");
  if (mesh.has("NOE")) return mesh;
  const std::vector<std::string> steps = mesh.names();
  if (steps.size() != 1)
    fail(fmt::format("mesh \"{}\" has {} times", name_, steps.size()), "a mesh of one time");
  return mesh.group(steps[0]);
}

/// Numbers of the file, or 1, 2, ...
std::vector<std::int64_t> MedReader::numbers_of(const Hdf5Group& group, std::size_t n) const
{
  std::vector<std::int64_t> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 1);
  if (group.has("NUM")) numbers = group.integers("NUM");
  if (numbers.size() != n) fail(fmt::format("has {} numbers for {} nodes or elements", numbers.size(), n));
  return numbers;
}

std::vector<std::int64_t> MedReader::families_of(const Hdf5Group& group, std::size_t n) const
{
  std::vector<std::int64_t> families(n, 0);
  if (group.has("FAM")) families = group.integers("FAM");
  if (families.size() != n) fail(fmt::format("has {} families for {} nodes or elements", families.size(), n));
  return families;
}

/// All x, all y, all z.
void MedReader::read_nodes()
{
  const Hdf5Group group = step_.group("NOE");
  const std::vector<double> x = group.numbers("COO");
  const Hdf5Group mesh = file_.group("ENS_MAA").group(name_);
  const std::int64_t space = mesh.attribute("ESP").value_or(mesh.attribute("DIM").value_or(3));
  if ((space != 2 && space != 3) || x.size() % static_cast<std::size_t>(space) != 0)
    fail(fmt::format("mesh \"{}\" has {} coordinates in {} dimensions", name_, x.size(), space));
  const std::size_t n = x.size() / static_cast<std::size_t>(space);
  if (n > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
    fail("there are too many nodes for 32-bit numbers");
  mesh_.nodes.reserve(n);
  for (std::size_t i = 0; i < n; ++i)
    mesh_.nodes.emplace_back(x[i], x[n + i], space == 3 ? x[2 * n + i] : 0.0);
  mesh_.node_numbers = numbers_of(group, n);
  families_of_nodes_ = families_of(group, n);
}

/// All first nodes, all second nodes, ..., counted from 1.
void MedReader::read_block(const Hdf5Group& group, const ElementType& type)
{
  const std::vector<std::int64_t> nodes = group.integers("NOD");
  const auto stride = static_cast<std::size_t>(type.n_nodes);
  const std::size_t n = nodes.size() / stride;
  if (nodes.size() % stride != 0)
    fail(fmt::format("has {} nodes of elements of type {}", nodes.size(), describe(type)));
  MedBlock block{{type, std::vector<Index>(nodes.size()), numbers_of(group, n)}, families_of(group, n)};
  for (std::size_t e = 0; e < n; ++e)
    for (std::size_t i = 0; i < stride; ++i)
    {
      const std::int64_t node = nodes[i * n + e];
      if (node < 1 || node > std::ssize(mesh_.nodes))
        fail(fmt::format("node {} of element {} ({}) does not exist: there are {} nodes", node,
                         block.elements.numbers[e], describe(type), mesh_.nodes.size()),
             "the file is damaged: save the mesh again");
      block.elements.nodes[e * stride + i] = static_cast<Index>(node - 1);
    }
  order_face_centres(block.elements, mesh_.nodes);
  blocks_.push_back(std::move(block));
}

void MedReader::read_elements()
{
  const Hdf5Group elements = step_.group("MAI");
  for (const std::string& name : elements.names())
  {
    if (name == "PO1") continue;
    const auto known = std::ranges::find(med_types, name, &std::pair<std::string_view, ElementType>::first);
    if (known == med_types.end())
      fail(fmt::format("has elements of type {}, which are not read", name),
           "triangles, quadrilaterals, tetrahedra, hexahedra, prisms and pyramids of order 1 or 2");
    read_block(elements.group(name), known->second);
  }
  dim_ = std::ranges::find(blocks_, 3, dimension) != blocks_.end() ? 3 : 2;
  if (std::ranges::find(blocks_, dim_, dimension) == blocks_.end())
    fail("the mesh has neither plane elements nor solids", "mesh a face or a solid in Salome");
}

/// Families of elements have negative numbers, those of nodes positive ones.
void MedReader::read_families()
{
  if (!file_.has("FAS") || !file_.group("FAS").has(name_)) return;
  const Hdf5Group families = file_.group("FAS").group(name_);
  for (const std::string kind : {"ELEME", "NOEUD"})
    if (families.has(kind))
      for (const std::string& family : families.group(kind).names())
        read_family(families.group(kind).group(family));
}

void MedReader::read_family(const Hdf5Group& family)
{
  constexpr std::size_t length = 80;
  const auto number = family.attribute("NUM");
  if (!number) fail("a family has no number");
  if (!family.has("GRO")) return;
  const std::string names = family.group("GRO").bytes("NOM");
  for (std::size_t begin = 0; begin < names.size(); begin += length)
  {
    std::string name = names.substr(begin, length);
    name = name.substr(0, name.find('\0'));
    name.erase(name.find_last_not_of(' ') + 1);
    if (!is_utf8(name))
      fail(fmt::format("a group of family {} has a name that is not UTF-8", *number), "rename it in Salome");
    if (!name.empty()) groups_[*number].push_back(std::move(name));
  }
}

std::span<const std::string> MedReader::groups_of(std::int64_t family) const
{
  const auto found = groups_.find(family);
  return found == groups_.end() ? std::span<const std::string>{}
                                : std::span<const std::string>(found->second);
}

void MedReader::add_cells()
{
  std::map<std::string, std::vector<Index>> groups;
  Index n = 0;
  for (MedBlock& block : blocks_)
  {
    if (dimension(block) != dim_) continue;
    for (const std::int64_t family : block.families)
    {
      for (const std::string& group : groups_of(family)) groups[group].push_back(n);
      ++n;
    }
    mesh_.cells.push_back(std::move(block.elements));
  }
  std::vector<CellSet> sets;
  sets.reserve(groups.size());
  for (auto& [name, cells] : groups) sets.push_back({name, std::move(cells)});
  if (sets.empty()) return;
  mesh_.cell_sets = partition_of(sets, n);
  if (!mesh_.cell_sets.empty()) return;
  const auto all = std::ranges::find_if(sets, [n](const CellSet& set) { return std::ssize(set.cells) == n; });
  if (all == sets.end())
    fail(fmt::format("the groups do not say which region an element is in: {}",
                     fault_of_partition(sets, n, [&](Index cell) { return number_of_cell(mesh_, cell); })),
         "groups of solids (in 2D of faces) that have every element once; or take out the others");
  mesh_.cell_sets = {*all};
}

void MedReader::add_facets()
{
  std::map<std::string, std::vector<ElementBlock>> groups;
  for (const MedBlock& block : blocks_)
  {
    if (dimension(block) != dim_ - 1) continue;
    for (std::size_t f = 0; f < block.families.size(); ++f)
      for (const std::string& group : groups_of(block.families[f]))
      {
        FaceNodes nodes{block.elements.type, {}};
        std::ranges::copy(block.elements.element(f), nodes.nodes.begin());
        append(groups[group], nodes, block.elements.numbers[f]);
      }
  }
  for (auto& [name, facets] : groups)
  {
    if (const auto stranger = first_without_cell(mesh_.cells, mesh_.nodes.size(), facets))
      fail(fmt::format("element {} ({}) of group \"{}\" is not {} of a cell",
                       facets[stranger->block].numbers[stranger->element],
                       describe(facets[stranger->block].type), name, dim_ == 3 ? "a face" : "an edge"),
           "shells and beams have no counterpart: leave them out");
    mesh_.facet_sets.push_back({name, std::move(facets)});
  }
}

void MedReader::add_node_sets()
{
  std::map<std::string, std::vector<Index>> groups;
  for (std::size_t node = 0; node < families_of_nodes_.size(); ++node)
    for (const std::string& group : groups_of(families_of_nodes_[node]))
      groups[group].push_back(static_cast<Index>(node));
  for (auto& [name, nodes] : groups) mesh_.node_sets.push_back({name, std::move(nodes)});
}

ImportedMesh read(const std::filesystem::path& file, bool has_groups)
{
  std::vector<std::string> no_notes;
  return mesh_from(read_apart(file, "HDF5", [&] { return bytes_of(MedReader(file).read(has_groups)); }),
                   {.file = file.string()}, no_notes);
}

}  // namespace

ImportedMesh read_med(const std::filesystem::path& file)
{
  return read(file, true);
}

ImportedMesh read_med_without_groups(const std::filesystem::path& file)
{
  return read(file, false);
}

}  // namespace tribound::mesh
