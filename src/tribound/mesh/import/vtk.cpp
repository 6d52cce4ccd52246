#include "tribound/mesh/import/vtk.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

#include "tribound/mesh/import/cell_faces.h"
#include "tribound/mesh/import/coincident_nodes.h"
#include "tribound/mesh/import/vtk_cell_type.h"
#include "tribound/mesh/import/vtk_file.h"

namespace tribound::mesh
{

namespace
{

/// Of Gmsh and Medit through meshio, FEniCSx, MFEM, deal.II, OpenGeoSys and others.
constexpr std::array<std::string_view, 14> usual_region_arrays = {
    "gmsh:physical", "medit:ref",   "cell_tags", "CellEntityIds", "attribute", "material", "MaterialID",
    "MaterialIDs",   "material_id", "EntityId",  "RegionId",      "region",    "regions",  "physical"};
/// The last one, of DOLFINx, may be something else in files of ParaView: points at different places are then
/// two.
constexpr std::array<std::string_view, 5> global_number_arrays = {
    "GlobalPointIds", "GlobalNodeId", "GlobalNodeIds", "vtkGlobalIds", "vtkOriginalPointIds"};

/// A type of cells of one dimension, with the values of the region array.
struct VtkBlock
{
  const VtkCellType* type;
  ElementBlock elements;
  std::vector<std::int64_t> values{};
};

class VtkReader
{
 public:
  VtkReader(const std::filesystem::path& path, const std::string& region_array,
            std::vector<std::string>& notes)
      : file_(open_vtk(path)), notes_(notes), mesh_{.source = {.file = path.string()}}
  {
    choose_region_array(region_array);
  }

  ImportedMesh read()
  {
    for (const VtkPiece& piece : file_.pieces)
    {
      read_points(piece);
      read_cells(piece);
    }
    const auto solid = std::ranges::find(blocks_, 3, dimension);
    dim_ = solid != blocks_.end() ? 3 : 2;
    if (std::ranges::find(blocks_, dim_, dimension) == blocks_.end())
      throw InputError(mesh_.source, "the mesh has neither plane elements nor solids",
                       "triangles, quadrilaterals, tetrahedra, hexahedra, prisms and pyramids are read");
    add_cells();
    add_facets();
    add_notes();
    return std::move(mesh_);
  }

 private:
  static int dimension(const VtkBlock& block) { return table_of(block.elements.type.shape).dim; }
  void choose_region_array(const std::string& wanted);
  [[nodiscard]] bool has_integers(std::string_view name) const;
  void read_points(const VtkPiece& piece);
  void read_cells(const VtkPiece& piece);
  [[nodiscard]] std::vector<std::int64_t> cell_values(const VtkPiece& piece, std::string_view name) const;
  [[nodiscard]] std::vector<char> ghosts(const VtkPiece& piece) const;
  void add_cell(const VtkPiece& piece, std::int64_t type, std::span<const std::int64_t> nodes,
                std::int64_t value);
  VtkBlock& block_of(const VtkCellType& type);
  void add_cells();
  void add_facets();
  void add_notes();
  void note(const std::string& text) { notes_.push_back(fmt::format("{}: {}", mesh_.source.file, text)); }

  VtkFile file_;
  std::vector<std::string>& notes_;
  ImportedMesh mesh_;
  int dim_ = 3;
  std::string region_array_{};  ///< empty: none
  std::vector<VtkBlock> blocks_{};
  std::vector<Index> place_{};  ///< of the points of the piece among all nodes
  std::unordered_map<std::int64_t, Index> node_of_global_{};
  std::int64_t n_points_ = 0;  ///< of all pieces so far
  std::int64_t n_cells_ = 0;
  std::size_t n_ghosts_ = 0;
  std::size_t n_vertices_ = 0;
};

bool VtkReader::has_integers(std::string_view name) const
{
  return std::ranges::all_of(file_.pieces,
                             [&](const VtkPiece& piece)
                             {
                               const VtkArray* array = find(piece.cell_data, name);
                               return array && array->n_components == 1 && is_integer(array->type);
                             });
}

void VtkReader::choose_region_array(const std::string& wanted)
{
  if (file_.pieces.empty()) throw InputError(mesh_.source, "the grid has no cells", "is it cut off?");
  if (wanted.empty())
  {
    const auto known =
        std::ranges::find_if(usual_region_arrays, [&](std::string_view name) { return has_integers(name); });
    if (known != usual_region_arrays.end()) region_array_ = *known;
    return;
  }
  region_array_ = wanted;
  for (const VtkPiece& piece : file_.pieces)
  {
    const VtkArray* array = find(piece.cell_data, wanted);
    if (array && array->n_components == 1) continue;
    std::vector<std::string> names;
    for (const VtkArray& known : piece.cell_data)
      if (known.n_components == 1 && known.type != VtkType::other)
        names.push_back(fmt::format("\"{}\"", known.name));
    throw InputError(piece.where, fmt::format("there is no cell array \"{}\" of one number per cell", wanted),
                     names.empty() ? "the file has no such arrays: leave mesh.region_array out"
                                   : fmt::format("mesh.region_array is one of {}", fmt::join(names, ", ")));
  }
}

/// Points of several pieces that have the same global number are one node.
void VtkReader::read_points(const VtkPiece& piece)
{
  if (n_points_ + static_cast<std::int64_t>(piece.n_points) > std::numeric_limits<Index>::max())
    throw InputError(piece.where, "there are too many points for 32-bit numbers");
  const std::vector<double> x = values_of<double>(piece.points, 3 * piece.n_points, piece.where);
  const VtkArray* global = nullptr;
  for (const std::string_view name : global_number_arrays)
    if (!global && file_.pieces.size() > 1) global = find(piece.point_data, name);
  std::vector<std::int64_t> numbers;
  if (global) numbers = values_of<std::int64_t>(*global, piece.n_points, piece.where);
  place_.resize(piece.n_points);
  for (std::size_t i = 0; i < piece.n_points; ++i, ++n_points_)
  {
    const Point<3> point(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
    place_[i] = static_cast<Index>(mesh_.nodes.size());
    if (global)
    {
      const auto [known, is_new] = node_of_global_.try_emplace(numbers[i], place_[i]);
      const bool is_same = !is_new && mesh_.nodes[known->second] == point;
      if (!is_new && !is_same && global->name != global_number_arrays.back())
        throw InputError(
            piece.where,
            fmt::format("points {} and {} have the global number {}, and are not at the same place",
                        mesh_.node_numbers[known->second], n_points_, numbers[i]),
            "are the parts of one mesh, and of one time?");
      if (is_same)
      {
        place_[i] = known->second;
        continue;
      }
    }
    mesh_.nodes.push_back(point);
    mesh_.node_numbers.push_back(n_points_);
  }
}

std::vector<std::int64_t> VtkReader::cell_values(const VtkPiece& piece, std::string_view name) const
{
  const VtkArray* array = name.empty() ? nullptr : find(piece.cell_data, name);
  return array ? values_of<std::int64_t>(*array, piece.n_cells, piece.where)
               : std::vector<std::int64_t>(piece.n_cells, 0);
}

/// Which cells are copies of those of another piece, or hidden.
std::vector<char> VtkReader::ghosts(const VtkPiece& piece) const
{
  constexpr std::int64_t duplicate_or_hidden = 1 | 32;
  const auto types = cell_values(piece, "vtkGhostType");
  const auto levels = cell_values(piece, "vtkGhostLevels");
  std::vector<char> result(piece.n_cells);
  for (std::size_t c = 0; c < result.size(); ++c)
    result[c] = (types[c] & duplicate_or_hidden) != 0 || levels[c] > 0 ? 1 : 0;
  return result;
}

void VtkReader::read_cells(const VtkPiece& piece)
{
  const VtkCells cells = cells_of(piece);
  const std::vector<char> is_ghost = ghosts(piece);
  const std::vector<std::int64_t> values = cell_values(piece, region_array_);
  for (std::size_t c = 0; c < piece.n_cells; ++c, ++n_cells_)
  {
    if (is_ghost[c] != 0)
      ++n_ghosts_;
    else
      add_cell(piece, cells.types[c],
               std::span(cells.nodes).subspan(cells.begin[c], cells.begin[c + 1] - cells.begin[c]),
               values[c]);
  }
}

void VtkReader::add_cell(const VtkPiece& piece, std::int64_t type, std::span<const std::int64_t> nodes,
                         std::int64_t value)
{
  if (type == 1 || type == 2)
  {
    ++n_vertices_;
    return;
  }
  const VtkCellType* known = find_vtk_type(type, nodes.size(), piece.has_old_hexahedra);
  if (!known)
    throw InputError(
        piece.where,
        fmt::format("cell {} is of type {} ({}) with {} points, which is not read", n_cells_, type,
                    vtk_type_name(type), nodes.size()),
        "triangles and tetrahedra of order 1 to 4; quadrilaterals, hexahedra, prisms and pyramids "
        "of order 1 or 2");
  VtkBlock& block = block_of(*known);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    block.elements.nodes.push_back(place_[nodes[known->order.empty() ? i : known->order[i]]]);
  block.elements.numbers.push_back(n_cells_);
  block.values.push_back(value);
}

VtkBlock& VtkReader::block_of(const VtkCellType& type)
{
  const auto known = std::ranges::find(blocks_, &type, &VtkBlock::type);
  if (known != blocks_.end()) return *known;
  return blocks_.emplace_back(VtkBlock{&type, {.type = type.type}});
}

void VtkReader::add_cells()
{
  std::map<std::int64_t, std::vector<Index>> regions;
  Index n = 0;
  for (VtkBlock& block : blocks_)
  {
    if (dimension(block) != dim_) continue;
    for (const std::int64_t value : block.values) regions[value].push_back(n++);
    mesh_.cells.push_back(std::move(block.elements));
  }
  if (region_array_.empty()) return;
  for (auto& [value, cells] : regions) mesh_.cell_sets.push_back({std::to_string(value), std::move(cells)});
}

/// Cells of one dimension less.
void VtkReader::add_facets()
{
  std::map<std::int64_t, std::vector<ElementBlock>> boundaries;
  std::size_t n_unnamed = 0;
  for (const VtkBlock& block : blocks_)
  {
    if (dimension(block) != dim_ - 1) continue;
    for (std::size_t f = 0; f < block.values.size(); ++f)
    {
      n_unnamed += block.values[f] == 0 ? 1 : 0;
      if (block.values[f] == 0) continue;
      FaceNodes nodes{block.elements.type, {}};
      std::ranges::copy(block.elements.element(f), nodes.nodes.begin());
      append(boundaries[block.values[f]], nodes, block.elements.numbers[f]);
    }
  }
  for (auto& [value, facets] : boundaries)
  {
    if (const auto stranger = first_without_cell(mesh_.cells, mesh_.nodes.size(), facets))
      throw InputError(
          mesh_.source,
          fmt::format("cell {} ({}) is not {} of a cell of {} dimensions",
                      facets[stranger->block].numbers[stranger->element],
                      describe(facets[stranger->block].type), dim_ == 3 ? "a face" : "an edge", dim_),
          "shells and beams have no counterpart: leave them out; do cells share their points?");
    mesh_.facet_sets.push_back({std::to_string(value), std::move(facets)});
  }
  if (n_unnamed > 0)
    note(region_array_.empty()
             ? fmt::format("{} {} are in no boundary, since no array of the cells names them", n_unnamed,
                           dim_ == 3 ? "faces" : "edges")
             : fmt::format("{} {} are in no boundary, since they have 0 in \"{}\"", n_unnamed,
                           dim_ == 3 ? "faces" : "edges", region_array_));
}

void VtkReader::add_notes()
{
  if (n_ghosts_ > 0) note(fmt::format("{} ghost cells are left out", n_ghosts_));
  std::size_t n_lower = n_vertices_;
  for (const VtkBlock& block : blocks_)
    if (dimension(block) < dim_ - 1) n_lower += block.values.size();
  if (n_lower > 0) note(fmt::format("{} vertices{} are left out", n_lower, dim_ == 3 ? " and lines" : ""));
  if (const std::size_t n = n_coincident(mesh_); n > 0)
    note(fmt::format(
        "{} of {} points lie where another point of the same region lies: cells that do not share "
        "their points are not connected; mesh.merge joins such points",
        n, mesh_.nodes.size()));
}

}  // namespace

ImportedMesh read_vtk(const std::filesystem::path& file, const std::string& region_array,
                      std::vector<std::string>& notes)
{
  return VtkReader(file, region_array, notes).read();
}

}  // namespace tribound::mesh
