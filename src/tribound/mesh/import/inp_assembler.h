#pragma once

/// @file inp_assembler.h
/// The instances of a deck put together.

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tribound/mesh/import/cell_faces.h"
#include "tribound/mesh/import/imported_mesh.h"
#include "tribound/mesh/import/inp_lines.h"
#include "tribound/mesh/import/inp_model.h"

namespace tribound::mesh
{

/// The places of numbers of nodes or elements.
class NumberIndex
{
 public:
  NumberIndex() = default;
  /// The numbers in the order of their places, which begin with `offset`.
  NumberIndex(std::span<const std::int64_t> numbers, std::size_t offset)
  {
    entries_.reserve(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i)
      entries_.push_back({numbers[i], static_cast<Index>(offset + i)});
    if (!std::ranges::is_sorted(entries_)) std::ranges::sort(entries_);
  }

  using Entry = std::pair<std::int64_t, Index>;
  [[nodiscard]] std::span<const Entry> entries() const { return entries_; }
  /// Those from first to last.
  [[nodiscard]] std::span<const Entry> range(std::int64_t first, std::int64_t last) const
  {
    const auto begin = lower_bound(first);
    return last < first ? std::span<const Entry>{} : std::span<const Entry>(begin, lower_bound(last + 1));
  }
  /// -1 if there is none.
  [[nodiscard]] Index find(std::int64_t number) const
  {
    // Mostly numbers have no gaps.
    const auto guess = entries_.empty() ? -1 : number - entries_.front().first;
    if (guess >= 0 && guess < std::ssize(entries_) && entries_[guess].first == number)
      return entries_[guess].second;
    const auto found = lower_bound(number);
    return found == entries_.end() || found->first != number ? -1 : found->second;
  }

 private:
  [[nodiscard]] std::vector<Entry>::const_iterator lower_bound(std::int64_t number) const
  {
    return std::ranges::lower_bound(entries_, number, {}, &Entry::first);
  }

  std::vector<Entry> entries_{};
};

/// A set of an instance, with its members as places in all instances.
struct ResolvedSet
{
  std::string name;  ///< "instance.set"
  const InpSet* set;
  std::vector<Index> members;
  bool is_section = false;
  bool is_of_surface = false;  ///< helps to define a surface
};

/// The faces of a surface, or its nodes.
struct InpSurfaceMembers
{
  std::vector<FaceNodes> faces{};
  std::vector<std::int64_t> labels{};  ///< of the element of each face
  std::vector<Index> nodes{};          ///< ascending
};

class InpAssembler
{
 public:
  /// What an element has become: a cell or a possible facet, by its number among those; -1: nothing.
  struct Element
  {
    Index number;
    bool is_cell;
    const InpElements* elements;
    std::int64_t label;
    InpPlace place;
  };

  /// Reads the deck.
  InpAssembler(const std::filesystem::path& file, const InpOptions& options)
      : lines_(file), options_(options), model_(parse_inp(lines_, options))
  {
    mesh_.source = {.file = file.string()};
  }

  /// Makes nodes, cells, regions and sets; what follows is of these.
  void put_together();
  /// The mesh with all sets and surfaces as boundaries.
  ImportedMesh assemble();
  /// What has been left out, in words; empty: nothing.
  [[nodiscard]] std::string ignored() const;
  [[nodiscard]] bool is_plane_stress() const { return !first_plane_type(plane_stress_prefix).empty(); }
  /// x is the distance from the axis, y runs along it.
  [[nodiscard]] bool is_axisymmetric() const { return !first_plane_type(axisymmetric_prefix).empty(); }
  /// These two in words, which are not the default of a case; empty: neither.
  [[nodiscard]] std::string plane_model() const;

  [[nodiscard]] const InpLines& lines() const { return lines_; }
  [[nodiscard]] const InpModel& model() const { return model_; }
  [[nodiscard]] const ImportedMesh& mesh() const { return mesh_; }
  [[nodiscard]] std::span<const Element> elements() const { return elements_; }
  /// The members of "5", "set" or "instance.set", as places of nodes and of elements. Throws InputError if
  /// there are none of the name.
  [[nodiscard]] std::vector<Index> nodes_named(std::string_view field, const InpPlace& place);
  [[nodiscard]] std::vector<Index> elements_named(std::string_view field, const InpPlace& place);
  /// "surface" or "instance.surface"; the name as it was defined, with its members. Throws InputError.
  [[nodiscard]] std::pair<std::string, InpSurfaceMembers> surface_named(std::string_view field,
                                                                        const InpPlace& place);
  /// A face of an element, 0-based. Throws InputError if it has none.
  [[nodiscard]] FaceNodes face_of(const Element& element, int face, const InpPlace& place) const;

 private:
  struct Instance
  {
    NumberIndex nodes{};
    NumberIndex elements{};
    std::vector<ResolvedSet> node_sets{};
    std::vector<ResolvedSet> element_sets{};
  };

  [[nodiscard]] const InpPart& part_of(std::size_t i) const { return model_.parts[model_.instances[i].part]; }
  [[nodiscard]] std::string full_name(std::size_t i, const std::string& name) const
  {
    return i == 0 ? name : model_.instances[i].name + "." + name;
  }
  static constexpr std::string_view plane_stress_prefix = "CPS";
  static constexpr std::string_view axisymmetric_prefix = "CAX";
  /// Of the plane elements whose type begins so; empty: there are none.
  [[nodiscard]] std::string first_plane_type(std::string_view prefix) const;
  void check_instances() const;
  void find_dimension();
  void add_nodes(std::size_t i);
  void add_elements(std::size_t i);
  void add_block(std::size_t i, const InpElements& elements);
  void resolve(std::size_t i, InpSets InpPart::*sets, std::vector<ResolvedSet> Instance::*resolved,
               NumberIndex Instance::*index);
  void add_members(const InpMembers& members, std::size_t i, const InpPlace& place,
                   std::vector<Index>& places, std::vector<ResolvedSet> Instance::*resolved,
                   NumberIndex Instance::*index);
  void mark_sets(std::size_t i);
  [[nodiscard]] std::vector<Index> members_named(std::string_view field, const InpPlace& place,
                                                 InpSets InpPart::*sets,
                                                 std::vector<ResolvedSet> Instance::*resolved,
                                                 NumberIndex Instance::*index);
  [[nodiscard]] InpSurfaceMembers members_of(std::size_t i, const InpSurface& surface);
  void add_surface(std::size_t i, const InpSurface& surface);
  void ignore(Element& element);
  void check_facets();
  void add_facets();
  void add_regions();
  [[nodiscard]] std::vector<const ResolvedSet*> sets_where(bool (*wanted)(const ResolvedSet&)) const;
  /// Their elements that are cells, or those that are none, by number.
  [[nodiscard]] std::vector<CellSet> members_of(const std::vector<const ResolvedSet*>& sets,
                                                bool cells) const;
  [[noreturn]] void throw_regions_unclear() const;

  InpLines lines_;
  InpOptions options_;
  InpModel model_;
  ImportedMesh mesh_{};
  int dim_ = 3;
  std::vector<Instance> instances_{};
  std::vector<Element> elements_{};     ///< of all instances
  std::vector<ElementBlock> facets_{};  ///< one element each that is no cell
  std::vector<Index> first_cell_{};     ///< of each block of cells
  Index n_cells_ = 0;
  std::size_t n_members_ = 0;  ///< of all sets so far
  struct Ignored
  {
    std::size_t n = 0;
    std::int64_t first = 0;
  };
  std::map<std::string, Ignored> ignored_{};  ///< elements by their type
};

}  // namespace tribound::mesh
