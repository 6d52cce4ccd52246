#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <system_error>

#include "app/command/commands.h"
#include "app/console/text.h"
#include "app/shared_file.h"
#include "tribound/base/error.h"
#include "tribound/io/file/atomic_file.h"

namespace tribound::app
{

namespace
{

/// The name of the case it belongs to; empty: none.
std::string stem(const EmbeddedFile& file)
{
  return file.name.ends_with(".md") ? "" : std::filesystem::path(file.name).stem().string();
}

std::vector<EmbeddedFile> files_of(const std::string& name)
{
  std::vector<EmbeddedFile> files;
  std::ranges::copy_if(embedded_files(), std::back_inserter(files),
                       [&](const EmbeddedFile& file) { return stem(file) == name; });
  if (!files.empty()) return files;
  const std::vector<std::string> names = template_names();
  const std::string near = closest(name, names);
  throw InputError(
      {}, fmt::format("there is no case \"{}\" to start from", name),
      fmt::format("{}the cases are {}", near.empty() ? "" : fmt::format("did you mean \"{}\"? ", near),
                  fmt::join(names, ", ")));
}

void write(const std::filesystem::path& path, std::string_view text)
{
  try
  {
    io::write_file(path, text);
  }
  catch (const io::WriteError& error)
  {
    throw InputError({.file = path.string()}, error.problem(), "choose another --directory");
  }
}

}  // namespace

std::vector<std::string> template_names()
{
  std::vector<std::string> names;
  for (const EmbeddedFile& file : embedded_files())
    if (!stem(file).empty() && std::ranges::find(names, stem(file)) == names.end())
      names.push_back(stem(file));
  return names;
}

void init(const std::string& name, const std::filesystem::path& directory)
{
  const std::vector<EmbeddedFile> files = files_of(name);
  for (const EmbeddedFile& file : files)
  {
    std::error_code ignored;  // a file that cannot be looked at cannot be written either, which says why
    const std::filesystem::path path = directory / file.name;
    if (std::filesystem::exists(std::filesystem::symlink_status(path, ignored)))
      throw InputError({.file = path.string()}, "exists already, nothing is written",
                       "tribound init overwrites no file: move it away, or use another --directory");
  }
  std::error_code error;
  if (!directory.empty()) std::filesystem::create_directories(directory, error);
  if (error)
    throw InputError({.file = directory.string()}, "cannot create this directory: " + error.message(),
                     "choose another --directory");
  for (const EmbeddedFile& file : files)
  {
    write(directory / file.name, file.text);
    print((directory / file.name).string() + "\n");
  }
  const std::string case_file = (directory / (name + ".toml")).string();
  print(fmt::format("next: tribound check {0}; tribound run {0}\n", case_file));
}

}  // namespace tribound::app
