#pragma once

/// @file import_deck.h
/// Decks for CalculiX and Abaqus as cases.

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "tribound/case/deck/deck_log.h"
#include "tribound/mesh/import/imported_mesh.h"

namespace tribound::case_file
{

struct ImportedDeck
{
  std::string case_text;      ///< TOML; its head tells line by line what became of the deck
  mesh::ImportedMesh mesh{};  ///< with the regions and boundaries of the case
  std::vector<DeckRemark> remarks{};
};

/// Reads a static, linear elastic deck with its contact, supports, loads, steps and amplitudes. The case
/// names `mesh_name` as the file of its mesh. Contact is rigid, strains are small; what the case does
/// otherwise than the deck stands in its head and in its `not_covered`.
///
/// Times of the steps become t. Sets that overlap are cut into boundaries that do not. Forces at nodes become
/// tractions: of that size where they are the forces of a uniform traction, else with their sum.
///
/// Throws InputError with file and line for a damaged deck, and with a list for all keywords that the answer
/// depends on and a case cannot have, unless they are in `accepted` (in capitals, without asterisk).
[[nodiscard]] ImportedDeck import_deck(const std::filesystem::path& deck, const std::string& mesh_name,
                                       const std::set<std::string>& accepted = {});

}  // namespace tribound::case_file
