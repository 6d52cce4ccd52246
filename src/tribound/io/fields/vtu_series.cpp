#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/io/fields/vtu.h"
#include "tribound/io/file/atomic_file.h"

namespace tribound::io
{

namespace
{

constexpr std::string_view series_name = "series.pvd";

/// The number in a name that consists of `stem`, at least `least` digits and `extension`.
std::optional<int> number_in(std::string_view name, std::string_view stem, std::size_t least,
                             std::string_view extension)
{
  if (!name.starts_with(stem) || !name.ends_with(extension)) return std::nullopt;
  name.remove_prefix(stem.size());
  if (name.size() < least + extension.size()) return std::nullopt;
  name.remove_suffix(extension.size());
  int number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  const bool is_number = error == std::errc() && end == name.data() + name.size() && name.front() != '-';
  return is_number ? std::optional(number) : std::nullopt;
}

struct NamedSeries
{
  std::string_view stem;
  std::string_view extension;
};

/// The names given by level_file_name(), level_files() and checkpoint_name_of(), except directories.
constexpr std::array<NamedSeries, 6> series_names = {{{"contact_", ".vtu"},
                                                      {"level_", ".vtu"},
                                                      {"level_", ".pvtu"},
                                                      {"step_", ".vtu"},
                                                      {"step_", ".pvtu"},
                                                      {"checkpoint_", ".h5"}}};

bool is_series_file(std::string_view name, int first)
{
  return std::ranges::any_of(series_names,
                             [&](const NamedSeries& series)
                             {
                               const auto number = number_in(name, series.stem, 3, series.extension);
                               return number && *number >= first;
                             });
}

/// Whether it is level_NNN or step_NNN.
bool is_series_directory(std::string_view name, int first)
{
  for (const std::string_view stem : {"level_", "step_"})
    if (const auto number = number_in(name, stem, 3, "")) return *number >= first;
  return false;
}

/// series.pvd and the series files in a directory, from number `first` on; those in directories of several
/// ranks come before the directories.
std::vector<std::filesystem::path> series_files(const std::filesystem::path& directory, int first)
{
  std::error_code error;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error))
  {
    const std::string name = entry.path().filename().string();
    const bool is_directory = entry.is_directory(error);
    if (!is_directory && name == series_name) files.insert(files.begin(), entry.path());
    if (!is_directory && is_series_file(name, first)) files.push_back(entry.path());
    if (!is_directory || !is_series_directory(name, first)) continue;
    bool has_others = false;
    for (const auto& piece : std::filesystem::directory_iterator(entry.path(), error))
      if (number_in(piece.path().filename().string(), "part_", 1, ".vtu"))
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
    for (const std::string& name : {fmt::format("{}_{:03}.pvtu", stem, level), level_file_name(stem, level)})
      if (std::filesystem::exists(directory / name, error))
      {
        text += fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", level, name);
        break;
      }
  text += "</Collection>\n</VTKFile>\n";
  write_file(directory / series_name, text);
}

void remove_series(const std::filesystem::path& directory, int first)
{
  std::error_code error;
  for (const std::filesystem::path& file : series_files(directory, first))
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
}

void remove_series_directory(const std::filesystem::path& directory)
{
  remove_series(directory);
  std::error_code error;
  std::filesystem::remove(directory, error);  // fails if it has other contents
}

void move_series(const std::filesystem::path& from, const std::filesystem::path& to)
{
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
