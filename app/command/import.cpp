#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <system_error>

#include "app/command/commands.h"
#include "app/console/text.h"
#include "tribound/base/error.h"
#include "tribound/case/deck/import_deck.h"
#include "tribound/io/fields/imported_msh.h"
#include "tribound/io/file/atomic_file.h"

namespace tribound::app
{

namespace
{

void require_absent(const std::filesystem::path& path)
{
  std::error_code ignored;  // a file that cannot be looked at cannot be written either, which says why
  if (std::filesystem::exists(std::filesystem::symlink_status(path, ignored)))
    throw InputError({.file = path.string()}, "exists already, nothing is written",
                     "tribound import overwrites no case: move it away, or use another --directory");
}

/// What the case does otherwise than the deck.
std::string changes_text(const case_file::ImportedDeck& imported)
{
  std::string text;
  for (const case_file::DeckRemark& remark : imported.remarks)
    if (remark.fate == case_file::Fate::changed || remark.fate == case_file::Fate::dropped)
      text += line(remark.fate == case_file::Fate::changed ? "changed" : "dropped",
                   fmt::format("*{}: {}", remark.keyword, remark.text));
  return text;
}

}  // namespace

void import_deck(const ImportRequest& request)
{
  const std::filesystem::path deck = request.deck;
  const std::filesystem::path directory = request.directory;
  const std::filesystem::path case_file = directory / deck.stem().concat(".toml");
  const std::filesystem::path mesh_file = directory / deck.stem().concat(".msh");
  if (mesh::capitals(deck.extension().string()) != ".INP")
    throw InputError({.file = request.deck}, "is not an .inp",
                     "decks of CalculiX and Abaqus are imported; other meshes: [mesh] file = \"...\"");
  require_absent(case_file);
  require_absent(mesh_file);
  std::set<std::string> accepted;
  for (const std::string& keyword : request.accepted)
    accepted.insert(mesh::capitals(keyword.starts_with('*') ? keyword.substr(1) : keyword));
  const case_file::ImportedDeck imported =
      case_file::import_deck(deck, mesh_file.filename().string(), accepted);
  std::error_code error;
  if (!directory.empty()) std::filesystem::create_directories(directory, error);
  if (error)
    throw InputError({.file = directory.string()}, "cannot create this directory: " + error.message(),
                     "choose another --directory");
  io::write_msh(mesh_file, imported.mesh);
  io::write_file(case_file, imported.case_text);
  if (request.quiet) return;
  print(changes_text(imported));
  print(fmt::format("written: {}, {}\n\n", case_file.string(), mesh_file.string()));
  check({.case_file = case_file.string(), .overrides = {}, .quiet = false}, false);
  print(fmt::format("\nnext: tribound run {}\n", case_file.string()));
  const std::filesystem::path results = std::filesystem::path(request.deck).replace_extension(".frd");
  if (std::filesystem::exists(results))
    print(fmt::format("or:   tribound judge {} --solution {}\n", case_file.string(), results.string()));
}

}  // namespace tribound::app
