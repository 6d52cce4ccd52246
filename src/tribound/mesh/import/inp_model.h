#pragma once

/// @file inp_model.h
/// What a deck for Abaqus or CalculiX says about its mesh: parts, their instances and sets.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/mesh/import/element_type.h"
#include "tribound/mesh/import/inp_lines.h"

namespace tribound::mesh
{

/// What the elements of a type stand for: C3D*; CPS*, CPE*, CAX*; S*, M3D*; T2D*, T3D*; none of these.
enum class InpFamily : char
{
  solid,
  plane,
  shell,
  truss,
  other  ///< only its number is read
};

struct InpElements
{
  std::string type_name;  ///< "C3D8R"
  InpFamily family;
  ElementType type;
  int set;  ///< that of the keyword's ELSET in InpPart::element_sets; -1: none
  std::vector<std::int64_t> numbers{};
  std::vector<std::int64_t> nodes{};
  std::vector<InpPlace> places{};  ///< per element
};

/// Numbers first, first + step, ..., last of an instance, or another set.
struct InpMembers
{
  std::int64_t first;
  std::int64_t last;
  std::int64_t step = 1;
  int instance = -1;      ///< -1: of the part of the set itself
  int set = -1;           ///< place of another set of the same kind, of the part or of that of the instance
  bool may_miss = false;  ///< whether numbers in between need not exist
};

struct InpSet
{
  std::string name;
  InpPlace place;
  bool is_from_set_keyword = false;  ///< *ELSET or *NSET, not a parameter of *ELEMENT or *NODE
  std::vector<InpMembers> members{};

  /// Consecutive numbers take one entry.
  void add(const InpMembers& more);
};

/// Sets by name, in capitals, in the order of their definition.
struct InpSets
{
  std::vector<InpSet> all{};
  std::unordered_map<std::string, int> by_name{};

  [[nodiscard]] int find(std::string_view name) const;
  /// Adds it unless there is one with the name.
  int add(std::string_view name, const InpPlace& place);
};

/// Faces "S1" ... of the elements of a set or of one element; of node surfaces nodes.
struct InpSurfacePart
{
  InpMembers elements;
  int face;  ///< 0-based; -1 for nodes
  InpPlace place;
};

struct InpSurface
{
  std::string name;
  bool is_of_nodes;
  InpPlace place;
  std::vector<InpSurfacePart> parts{};
};

/// "*SOLID SECTION, ELSET=body, MATERIAL=steel", also of shells and beams.
struct InpSection
{
  std::string keyword;
  int set;
  InpPlace place;
  std::string material{};
  std::string first_datum{};  ///< of plane elements the thickness; empty: none
};

/// A keyword that says nothing about the mesh, with its data.
struct InpBlock
{
  struct Line
  {
    InpPlace place;
    std::vector<std::string> fields;
  };

  InpKeyword keyword;
  int part;  ///< in which it stands
  std::vector<Line> lines{};
};

/// A *PART, or what is outside of parts: the assembly.
struct InpPart
{
  std::string name;
  InpPlace place;
  std::vector<std::int64_t> node_numbers{};
  std::vector<Point<3>> nodes{};
  std::vector<InpPlace> node_places{};
  std::vector<InpElements> elements{};
  InpSets element_sets{};
  InpSets node_sets{};
  std::vector<InpSurface> surfaces{};
  std::vector<InpSection> sections{};
};

/// x -> rotation x + shift.
struct InpInstance
{
  std::string name;
  int part;
  InpPlace place;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Point<3> shift = Point<3>::Zero();
};

struct InpModel
{
  std::vector<InpPart> parts{{}};  ///< the first is the assembly, which is its own instance
  std::vector<InpInstance> instances{{.name = {}, .part = 0, .place = {}}};
  std::vector<InpBlock> blocks{};  ///< in their order; empty unless they are kept

  /// "5", "body", "part-1.5" or "part-1.body" as members of sets of one kind: of the instance, or of the
  /// part, if there is no instance (-1). Nothing if there is no such set.
  [[nodiscard]] std::optional<InpMembers> find_members(std::string_view field, int part, int instance,
                                                       InpSets InpPart::*kind) const;
  /// -1 if there is none.
  [[nodiscard]] int instance_named(std::string_view name) const;
};

/// Finds family and type by the number of nodes in the name, "C3D20R": the letters behind it concern the
/// integration. False if it is not read.
[[nodiscard]] bool find_type(std::string_view name, InpElements& elements);

struct InpOptions
{
  bool ignores_elements = false;  ///< elements of an unknown type are left out
  bool keeps_blocks = false;      ///< InpModel::blocks
};

/// Reads all keywords that say something about the mesh; the others are kept as they are, or passed over.
/// Throws InputError with file and line, also for elements of an unknown type unless they are to be ignored.
[[nodiscard]] InpModel parse_inp(InpLines& lines, const InpOptions& options);

}  // namespace tribound::mesh
