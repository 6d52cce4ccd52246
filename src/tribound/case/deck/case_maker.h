#pragma once

/// @file case_maker.h
/// The case and the mesh that a deck stands for.

#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tribound/case/deck/deck.h"
#include "tribound/case/deck/deck_faces.h"
#include "tribound/case/deck/deck_log.h"
#include "tribound/case/deck/groups.h"
#include "tribound/case/node.h"
#include "tribound/mesh/import/inp_assembler.h"
#include "tribound/mesh/import/node_sets.h"

namespace tribound::case_file
{

inline void put(Node::Table& table, const std::string& name, Node node)
{
  table.push_back({name, {}, std::move(node)});
}

/// Keeps references.
class CaseMaker
{
 public:
  CaseMaker(const Deck& deck, mesh::InpAssembler& assembler, const DeckFaces& faces, DeckLog& log)
      : deck_(deck), assembler_(assembler), faces_(faces), log_(log), whole_bodies_(assembler.mesh())
  {
  }

  /// Writes the tables of the case; what cannot be written goes into the log.
  Node::Table make();
  /// The mesh with the regions and boundaries of the case.
  [[nodiscard]] mesh::ImportedMesh mesh() const;

 private:
  struct PairGroups
  {
    const DeckPair* pair;
    const DeckInteraction* interaction;  ///< null: tied
    int slave;
    int master;
  };

  /// What the nodes of a region say.
  struct RegionTemperature
  {
    const DeckLoad* load = nullptr;   ///< null: none
    const DeckLoad* other = nullptr;  ///< the first that differs
    bool has_nodes_without = false;
  };

  void find_history();
  void find_regions();
  void check_plane(const mesh::InpModel& model);
  void find_boundaries();
  /// The faces that it holds; `faces` are those all of whose nodes are its members.
  [[nodiscard]] std::vector<Index> faces_of_displacement(const DeckLoad& load, std::vector<Index> faces);
  /// The faces of bodies all of whose nodes are held in one direction that lie across it.
  void add_faces_across(const DeckLoad& load, const std::set<Index>& whole, std::vector<Index>& faces);

  /// Whether all corners of these bodies lie on the faces.
  [[nodiscard]] bool are_corners_on(const std::vector<Index>& faces, const std::set<Index>& whole) const;
  [[nodiscard]] const DeckMaterial* material_of(const std::string& region) const;
  [[nodiscard]] Node material(const Groups::Part& region) const;
  [[nodiscard]] Node::Table load(std::size_t region) const;
  void add_body_force(const Groups::Part& region, Node::Table& table) const;
  void add_temperature(std::size_t region, Node::Table& table) const;
  [[nodiscard]] std::vector<RegionTemperature> temperatures(const std::vector<DeckLoad>& loads) const;
  /// The course of the temperature at all nodes of a region; null if there is none.
  [[nodiscard]] const Course* course_of(const RegionTemperature& temperature,
                                        const std::string& region) const;
  [[nodiscard]] Node::Table boundary(const Groups::Part& part) const;
  /// The motion of a rigid body: `rigid`, or `displacement` where all of it is given.
  void add_rigid(const DeckRigid& rigid, Index number, Node::Table& table) const;
  [[nodiscard]] Node::Array fixed_motions(const DeckRigid& rigid, const std::vector<int>& motions,
                                          const std::array<const Course*, 6>& given) const;
  [[nodiscard]] Node rigid_displacement(const DeckRigid& rigid,
                                        const std::array<const Course*, 6>& motions) const;
  /// The loads or motions of a rigid body by component; null where there is none.
  [[nodiscard]] std::array<const Course*, 6> courses_of(Index rigid, DeckLoadKind kind) const;
  [[nodiscard]] Node displacement(const Groups::Part& part, bool& is_given) const;
  [[nodiscard]] std::vector<std::pair<double, const Course*>> terms(const Groups::Part& part,
                                                                    DeckLoadKind kind, int component) const;
  [[nodiscard]] Node::Table contact(const PairGroups& pair);
  /// Names the curved sides whose faces of second order are the true surfaces.
  void add_shape(const PairGroups& pair, Node::Table& table);
  [[nodiscard]] double reach_of_tie(const PairGroups& pair);
  void add_gap(const PairGroups& pair, Node::Table& table);
  [[nodiscard]] Node sides(int group) const;
  void add_quantities(Node::Table& table) const;
  void add_probes(Node::Table& table) const;

  const Deck& deck_;
  mesh::InpAssembler& assembler_;
  const DeckFaces& faces_;
  DeckLog& log_;
  mesh::WholeBodies whole_bodies_;
  Groups cell_groups_{};
  Groups face_groups_{};
  std::vector<Groups::Part> regions_{};
  std::vector<RegionTemperature> temperatures_{};  ///< of the regions
  std::vector<RegionTemperature> initial_temperatures_{};
  std::vector<Groups::Part> boundaries_{};
  std::vector<Node::Table> tables_{};  ///< of the boundaries; empty for those that only touch
  std::vector<int> group_of_load_{};   ///< -1: none
  std::vector<int> group_of_rigid_{};
  std::vector<PairGroups> pairs_{};
  std::map<std::string, mesh::InpSection> sections_{};  ///< by the name of the region
  Node::Table shapes_{};
  std::vector<double> times_{};  ///< empty: only the end of the last step counts
};

}  // namespace tribound::case_file
