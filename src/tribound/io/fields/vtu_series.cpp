#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "tribound/base/error.h"
#include "tribound/io/fields/vtu.h"
#include "tribound/io/file/atomic_file.h"

namespace tribound::io
{

namespace
{

/// Whether a name is `stem`, at least `least` digits and `extension`.
bool is_numbered(std::string_view name, std::string_view stem, std::size_t least, std::string_view extension)
{
  if (!name.starts_with(stem) || !name.ends_with(extension)) return false;
  name.remove_prefix(stem.size());
  if (name.size() < least + extension.size()) return false;
  name.remove_suffix(extension.size());
  return std::ranges::all_of(name, [](char c) { return '0' <= c && c <= '9'; });
}

/// Whether the name is series.pvd, or one that level_file_name() or level_files() give.
bool is_series_file(std::string_view name)
{
  return name == "series.pvd" || is_numbered(name, "contact_", 3, ".vtu") ||
         is_numbered(name, "level_", 3, ".vtu") || is_numbered(name, "level_", 3, ".pvtu") ||
         is_numbered(name, "step_", 3, ".vtu") || is_numbered(name, "step_", 3, ".pvtu") ||
         is_numbered(name, "checkpoint_", 3, ".h5");
}

/// The files of a series in a directory, those in directories of several ranks first, and then these.
std::vector<std::filesystem::path> series_files(const std::filesystem::path& directory)
{
  std::error_code error;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error))
  {
    const std::string name = entry.path().filename().string();
    const bool is_directory = entry.is_directory(error);
    if (is_series_file(name) && !is_directory) files.push_back(entry.path());
    if ((!is_numbered(name, "level_", 3, "") && !is_numbered(name, "step_", 3, "")) || !is_directory)
      continue;
    bool has_others = false;
    for (const auto& piece : std::filesystem::directory_iterator(entry.path(), error))
      if (is_numbered(piece.path().filename().string(), "part_", 1, ".vtu"))
        files.push_back(piece.path());
      else
        has_others = true;
    if (!has_others) files.push_back(entry.path());
  }
  return files;
}

}  // namespace

LevelFiles level_files(const std::filesystem::path& directory, const SeriesPlace& place, const Ranks& ranks)
{
  if (ranks.size() == 1) return {directory / level_file_name(place.stem(), place.number)};
  const std::string stem = fmt::format("{}_{:03}", place.stem(), place.number);
  const auto piece = [&stem](int rank) { return fmt::format("{}/part_{:04}.vtu", stem, rank); };
  std::error_code error;
  std::filesystem::create_directories(directory / stem, error);
  if (error) throw WriteError(directory / stem, "cannot be made: " + error.message(), "a place to write to");
  LevelFiles files{directory / piece(ranks.rank())};
  if (!ranks.is_first()) return files;
  files.list = directory / (stem + ".pvtu");
  for (int rank = 0; rank < ranks.size(); ++rank) files.pieces.push_back(piece(rank));
  return files;
}

std::string level_file_name(std::string_view stem, int level)
{
  return fmt::format("{}_{:03}.vtu", stem, level);
}

void write_series(const std::filesystem::path& directory, int first, int last, std::string_view stem)
{
  std::error_code error;
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  for (int level = first; level <= last; ++level)
  {
    const std::string list = fmt::format("{}_{:03}.pvtu", stem, level);
    text +=
        fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", level,
                    std::filesystem::exists(directory / list, error) ? list : level_file_name(stem, level));
  }
  text += "</Collection>\n</VTKFile>\n";
  write_file(directory / "series.pvd", text);
}

void remove_series(const std::filesystem::path& directory)
{
  std::error_code error;
  for (const std::filesystem::path& file : series_files(directory))
  {
    std::filesystem::remove(file, error);
    if (error)
      throw InputError({.file = file.string(), .key = {}},
                       "cannot remove this file of an earlier run: " + error.message(),
                       "choose another output.directory, or remove the file");
  }
}

void make_series_directory(const std::filesystem::path& directory)
{
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw WriteError(directory, "cannot be made: " + error.message(), "a place to write to");
  remove_series(directory);
}

void remove_series_directory(const std::filesystem::path& directory)
{
  remove_series(directory);
  std::error_code error;
  std::filesystem::remove(directory, error);  // stays where there is anything else in it
}

void move_series(const std::filesystem::path& from, const std::filesystem::path& to)
{
  remove_series(to);
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(from, error))
  {
    const std::filesystem::path target = to / entry.path().filename();
    std::filesystem::rename(entry.path(), target, error);
    if (error) throw WriteError(target, "cannot be moved here: " + error.message(), "a place to write to");
  }
  std::filesystem::remove(from, error);
}

}  // namespace tribound::io
