#pragma once

/// @file deck_reader.h
/// The keywords of a deck that say something about materials, contact, supports and loads.

#include <array>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "tribound/case/deck/deck.h"
#include "tribound/case/deck/deck_faces.h"
#include "tribound/case/deck/deck_log.h"
#include "tribound/mesh/import/inp_assembler.h"

namespace tribound::case_file
{

/// Keeps references.
class DeckReader
{
 public:
  /// `thickness`: of a plane mesh, by which forces at nodes are divided; 1 in 3D.
  DeckReader(mesh::InpAssembler& assembler, const DeckFaces& faces, double thickness, DeckLog& log)
      : assembler_(assembler), faces_(faces), thickness_(thickness), log_(log)
  {
  }

  /// Throws InputError with file and line for what is no number, or has no set; what a case cannot have goes
  /// into the log.
  Deck read();

 private:
  using Block = mesh::InpBlock;
  using Line = mesh::InpBlock::Line;
  using Handler = void (DeckReader::*)(const Block&);

  static const std::map<std::string_view, Handler>& handlers();

  void check_parameters(const Block& block);
  void read_heading(const Block& block);
  void read_material(const Block& block);
  void read_elastic(const Block& block);
  void read_expansion(const Block& block);
  void read_density(const Block& block);
  void read_interaction(const Block& block);
  void read_behaviour(const Block& block);
  void read_friction(const Block& block);
  void read_contact_pair(const Block& block);
  void read_tie(const Block& block);
  void read_clearance(const Block& block);
  void read_initial_conditions(const Block& block);
  void read_amplitude(const Block& block);
  void read_rigid_body(const Block& block);
  void read_coupling(const Block& block);
  void read_distributing(const Block& block);
  void read_kinematic(const Block& block);
  void read_node_print(const Block& block);
  void begin_step(const Block& block);
  void read_static(const Block& block);
  void end_step(const Block& block);
  void read_boundary(const Block& block);
  void read_nodal_forces(const Block& block);
  void read_element_loads(const Block& block);
  void read_surface_loads(const Block& block);
  void read_temperature(const Block& block);
  void pass_over(const Block& block);
  void drop(const Block& block);
  void refuse(const Block& block);

  /// Applies a line of *BOUNDARY or *CLOAD that is meant for a rigid body; false: it is not.
  bool apply_to_rigid(const Block& block, const Line& line, std::span<const Index> nodes);
  [[nodiscard]] Index node_of(const Block& block, std::string_view parameter);
  void fix(const Block& block, const Line& line, const std::string& target, const std::vector<Index>& nodes);
  void fix_components(const Block& block, const Line& line, const std::string& target,
                      const std::vector<Index>& nodes);
  void spread_forces(const Block& block, const Line& line, const std::string& target,
                     const std::map<Index, Point<3>>& forces, const std::array<bool, 3>& is_named);
  [[nodiscard]] double initial_temperature(Index node) const;
  [[nodiscard]] bool can_act(bool is_gravity, std::span<const double> data) const;
  void read_acceleration(const Block& block, const Line& line, const std::string& label);

  /// The load of this kind on these members, or a new one.
  DeckLoad& load_on(DeckLoadKind kind, const Block& block, const mesh::InpPlace& place,
                    const std::string& target, std::vector<Index> members, int component = 0,
                    std::vector<double> data = {});
  /// It reaches this value in the present step, or multiplies the amplitude of the keyword.
  void apply(DeckLoad& load, double value, const Block& block);
  /// Goes through the present step.
  void follow(DeckLoad& load) const;
  void end_load(DeckLoad& load, const DeckStep& step);
  void note_new(const Block& block, std::span<const DeckLoadKind> kinds);

  [[nodiscard]] double number(const Line& line, std::size_t field, double missing = 0) const;
  [[nodiscard]] const std::string& field(const Line& line, std::size_t field) const;
  [[nodiscard]] std::string required(const Block& block, std::string_view parameter) const
  {
    return assembler_.lines().required(block.keyword, parameter);
  }
  [[nodiscard]] std::vector<Index> outer(const std::vector<mesh::FaceNodes>& faces,
                                         const mesh::InpPlace& place) const;
  [[nodiscard]] std::string line_name(const Line& line) const;
  void take(const Block& block, const std::string& text)
  {
    log_.add(block.keyword.place, block.keyword.name, Fate::taken, text);
  }

  mesh::InpAssembler& assembler_;
  const DeckFaces& faces_;
  double thickness_;
  DeckLog& log_;
  Deck deck_{};
  using LoadKey = std::tuple<DeckLoadKind, int, std::size_t, Index>;  ///< size and first of the members
  std::multimap<LoadKey, std::size_t> places_of_loads_{};
  const Block* coupling_ = nullptr;  ///< the last *COUPLING, before what says of which kind it is
  bool in_step_ = false;
  std::set<std::string> cards_{};     ///< keywords of loads that the step has named
  std::set<DeckLoadKind> renewed_{};  ///< kinds of which OP=NEW ends what the step does not name
};

/// The outer faces of a surface, ascending. Throws InputError for one inside the mesh, or for nodes without a
/// face.
[[nodiscard]] std::vector<Index> faces_of_surface(mesh::InpAssembler& assembler, const DeckFaces& faces,
                                                  std::string_view name, const mesh::InpPlace& place);

}  // namespace tribound::case_file
