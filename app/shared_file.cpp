#include "app/shared_file.h"

#include <system_error>

namespace tribound::app
{

namespace
{

/// The folder of this program; empty where the system does not tell.
std::filesystem::path program_directory()
{
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
}

}  // namespace

std::filesystem::path find_shared_file(const std::string& name)
{
  for (const std::filesystem::path& folder :
       {program_directory() / ".." / TRIBOUND_RELATIVE_SHARE, std::filesystem::path(TRIBOUND_SCRIPTS),
        std::filesystem::path(TRIBOUND_PAGE), std::filesystem::path(TRIBOUND_SHARE)})
  {
    std::error_code error;
    std::filesystem::path file = (folder / name).lexically_normal();
    if (std::filesystem::is_regular_file(file, error)) return file;
  }
  return {};
}

std::filesystem::path guide_directory()
{
  for (const std::filesystem::path& folder :
       {program_directory() / ".." / TRIBOUND_RELATIVE_DOC / "docs", std::filesystem::path(TRIBOUND_GUIDE)})
  {
    std::error_code error;
    std::filesystem::path directory = folder.lexically_normal();
    if (std::filesystem::is_regular_file(directory / "case-format.md", error)) return directory;
  }
  return std::filesystem::path(TRIBOUND_DOC) / "docs";
}

}  // namespace tribound::app
