#pragma once

/// @file deck.h
/// What a deck for CalculiX or Abaqus says beside its mesh.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/case/deck/course.h"
#include "tribound/mesh/import/inp_lines.h"

namespace tribound::case_file
{

struct DeckMaterial
{
  std::string name;
  std::optional<double> E{};
  std::optional<double> nu{};
  std::optional<double> density{};
  std::optional<double> alpha{};
};

/// *SURFACE INTERACTION.
struct DeckInteraction
{
  std::string name;
  bool is_tied = false;
  double coefficient = 0;
};

/// A line of *CONTACT PAIR or *TIE.
struct DeckPair
{
  mesh::InpPlace place;
  std::string slave;
  std::string master;
  std::string interaction;         ///< empty: *TIE
  std::string type{};              ///< "NODE TO SURFACE", ...
  std::optional<double> adjust{};  ///< distance within which nodes of the slave are moved onto the master
  std::optional<double> clearance{};
  std::optional<double> tolerance{};  ///< of a *TIE
};

/// *RIGID BODY, *COUPLING with *KINEMATIC: faces that move with a reference node.
struct DeckRigid
{
  mesh::InpPlace place;
  std::string keyword;  ///< "RIGID BODY" or "COUPLING"
  std::string target;
  std::vector<Index> faces;
  Index reference;      ///< its node
  Index rotation = -1;  ///< the node whose displacements are the rotations; -1: the reference node has them
};

enum class DeckLoadKind : char
{
  displacement,  ///< of nodes, one component
  force,         ///< of nodes, spread over faces, one component per area
  traction,      ///< on faces, one component
  pressure,      ///< on faces
  gravity,       ///< on cells: acceleration; data: its direction
  rotation,      ///< on cells: square of the angular velocity; data: a point and the direction of the axis
  temperature,   ///< of nodes
  rigid_motion,  ///< members: the number of the rigid body; component 0 to 5: displacement, rotation
  rigid_force    ///< the same for force and moment
};

struct DeckLoad
{
  DeckLoadKind kind;
  mesh::InpPlace place;        ///< where it first stands
  std::string target;          ///< the set, or "line 12"
  std::vector<Index> members;  ///< nodes, faces or cells, ascending
  int component = 0;
  std::vector<double> data{};
  Course course{};
  std::string amplitude{};  ///< empty: none
  double magnitude = 0;     ///< what multiplies the amplitude, or is reached at the end of the step
  bool is_active = true;    ///< not ended by OP=NEW
  bool is_in_step = false;  ///< the present step names it
};

struct DeckStep
{
  mesh::InpPlace place;
  double begin;
  double end;
  double increment;  ///< the first
};

struct DeckAmplitude
{
  bool is_of_total_time = false;
  std::vector<Course::Point> points{};

  /// Constant before the first and after the last point.
  [[nodiscard]] double at(double t) const;
};

struct DeckPrint
{
  mesh::InpPlace place;
  std::string target;
};

struct Deck
{
  std::string title{};
  std::vector<DeckMaterial> materials{};
  std::vector<DeckInteraction> interactions{};
  std::vector<DeckPair> pairs{};
  std::vector<DeckRigid> rigids{};
  std::map<std::string, DeckAmplitude> amplitudes{};  ///< by name, in capitals
  std::vector<DeckLoad> loads{};
  std::vector<DeckLoad> initial_temperatures{};
  std::vector<DeckStep> steps{};
  std::vector<DeckPrint> displacements_of_nodes{};  ///< *NODE PRINT with U
};

}  // namespace tribound::case_file
