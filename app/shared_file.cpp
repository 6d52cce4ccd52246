#include "app/shared_file.h"

#include "app/host.h"

#include <system_error>

namespace tribound::app
{

namespace
{

/// `name` in a folder relative to the one above that of this program, or else below the prefix.
std::filesystem::path find_installed(const char* relative, const char* absolute, const std::string& name)
{
  std::error_code error;
  const std::filesystem::path program =
      host().program.empty() ? std::filesystem::read_symlink("/proc/self/exe", error) : host().program;
  for (const std::filesystem::path& folder :
       {program.parent_path() / ".." / relative, std::filesystem::path(absolute)})
  {
    std::filesystem::path file = std::filesystem::canonical(folder / name, error);
    if (!error) return file;
  }
  return {};
}

}  // namespace

std::filesystem::path find_shared_file(const std::string& name)
{
  return find_installed(TRIBOUND_RELATIVE_SHARE, TRIBOUND_SHARE, name);
}

std::filesystem::path guide_directory()
{
  const std::filesystem::path found = find_installed(TRIBOUND_RELATIVE_DOC, TRIBOUND_DOC, "docs");
  return found.empty() ? std::filesystem::path(TRIBOUND_DOC) / "docs" : found;
}

}  // namespace tribound::app
