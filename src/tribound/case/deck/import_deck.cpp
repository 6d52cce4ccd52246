#include "tribound/case/deck/import_deck.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "tribound/case/deck/case_maker.h"
#include "tribound/case/deck/deck_faces.h"
#include "tribound/case/deck/deck_reader.h"
#include "tribound/case/node.h"
#include "tribound/mesh/import/inp_assembler.h"

namespace tribound::case_file
{

namespace
{

/// Of the sections of a plane mesh; 1 in 3D and of bodies of revolution. Throws InputError where they differ.
double thickness_of(const mesh::InpAssembler& assembler, const DeckFaces& faces)
{
  std::optional<double> thickness;
  if (faces.dim() == 3 || faces.is_axisymmetric()) return 1;
  for (const mesh::InpPart& part : assembler.model().parts)
    for (const mesh::InpSection& section : part.sections)
    {
      const std::optional<double> given =
          section.first_datum.empty() ? 1.0 : mesh::number_of(section.first_datum);
      if (!given || !(*given > 0))
        assembler.lines().fail(section.place,
                               fmt::format("the thickness \"{}\" is not positive", section.first_datum));
      if (thickness && *thickness != *given)
        assembler.lines().fail(section.place, "the sections of a plane mesh have different thicknesses",
                               "a plane case is one of unit thickness");
      thickness = given;
    }
  return thickness.value_or(1);
}

}  // namespace

ImportedDeck import_deck(const std::filesystem::path& deck, const std::string& mesh_name,
                         const std::set<std::string>& accepted)
{
  mesh::InpAssembler assembler(deck,
                               {.ignores_elements = accepted.contains("ELEMENT"), .keeps_blocks = true});
  assembler.put_together();
  DeckLog log(assembler.lines(), accepted);
  if (const std::string ignored = assembler.ignored(); !ignored.empty())
    log.add({}, "ELEMENT", Fate::dropped, ignored);
  const DeckFaces faces(assembler.mesh(), assembler.is_axisymmetric());
  const double thickness = thickness_of(assembler, faces);
  if (thickness != 1)
    log.add(
        {}, "SOLID SECTION", Fate::changed,
        fmt::format("forces are those of unit thickness: times {} they are those of the deck", thickness));
  const Deck read = DeckReader(assembler, faces, thickness, log).read();
  CaseMaker maker(read, assembler, faces, log);
  Node::Table document = maker.make();
  log.throw_problems();

  const Node::Table mesh_table = {{"file", {}, {mesh_name, {}}}};
  document.insert(document.begin(), {"mesh", {}, {mesh_table, {}}});
  if (const std::vector<std::string> outside = log.not_covered(); !outside.empty())
  {
    Node::Array texts;
    texts.reserve(outside.size());
    for (const std::string& text : outside) texts.push_back({text, {}});
    document.insert(document.begin(), {"not_covered", {}, {std::move(texts), {}}});
  }
  const std::string head =
      fmt::format("# Made by tribound import of {}. What became of it, line by line:\n#\n{}\n",
                  deck.filename().string(), log.table());
  return {head + to_toml({std::move(document), {}}), maker.mesh(), log.remarks()};
}

}  // namespace tribound::case_file
