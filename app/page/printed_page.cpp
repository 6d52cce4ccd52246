#include "app/page/printed_page.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <vector>

#include "app/child_process.h"
#include "tribound/base/error.h"
#include "tribound/base/temporary_directory.h"
#include "tribound/io/file/atomic_file.h"

namespace tribound::app
{

namespace
{

constexpr std::array browser_names = {"chromium", "chromium-browser", "google-chrome"};

/// The title of report/src/index.html, which a page keeps until everything is drawn. A PDF has it as it is
/// written here: other titles have a dash and are stored as UTF-16.
constexpr std::string_view title_of_unfinished = "/Title (Tribound report)";

/// A new directory for the profile of the browser, which is removed with this.
class Profile
{
 public:
  Profile() : path_(make_temporary_directory()) {}
  ~Profile()
  {
    std::error_code none;
    if (!path_.empty()) std::filesystem::remove_all(path_, none);
  }
  Profile(const Profile&) = delete;
  Profile& operator=(const Profile&) = delete;

  /// Empty if it cannot be made.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

bool is_program(const std::filesystem::path& path)
{
  std::error_code none;
  return std::filesystem::is_regular_file(path, none) && ::access(path.c_str(), X_OK) == 0;
}

/// What it is to do. WebGL by software, as there need not be a graphics card, gives the same pictures
/// everywhere; twice the resolution of a screen is sharp on paper. Time passes for the page as fast as it
/// draws, so that it is printed when nothing is left to do.
std::vector<std::string> arguments_for(const std::filesystem::path& browser,
                                       const std::filesystem::path& directory, const std::string& address)
{
  std::vector<std::string> arguments = {browser.string(),
                                        "--headless",
                                        "--no-first-run",
                                        "--disable-dev-shm-usage",
                                        "--use-gl=angle",
                                        "--use-angle=swiftshader",
                                        "--enable-unsafe-swiftshader",
                                        "--window-size=1240,1600",
                                        "--force-device-scale-factor=2",
                                        "--virtual-time-budget=600000",
                                        "--no-pdf-header-footer",
                                        "--generate-pdf-document-outline",
                                        "--user-data-dir=" + (directory / "profile").string(),
                                        "--print-to-pdf=" + (directory / "page.pdf").string()};
  if (::geteuid() == 0) arguments.emplace_back("--no-sandbox");  // root cannot have one
  arguments.push_back(address);
  return arguments;
}

/// The last line of a text that is not empty.
std::string last_line(std::string_view text)
{
  const std::size_t end = text.find_last_not_of(" \n");
  if (end == std::string_view::npos) return {};
  const std::size_t begin = text.find_last_of('\n', end);
  return std::string(text.substr(begin + 1, end - begin));
}

}  // namespace

std::filesystem::path find_browser()
{
  if (const char* named = std::getenv("CHROMIUM"); named != nullptr && *named != '\0')
  {
    if (is_program(named)) return named;
    throw InputError({}, fmt::format("CHROMIUM names no program: {}", named), "the path of Chromium");
  }
  const char* variable = std::getenv("PATH");
  std::string_view rest = variable != nullptr ? variable : "";
  while (!rest.empty())
  {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    for (const char* name : browser_names)
      if (std::filesystem::path path = std::filesystem::path(rest.substr(0, end)) / name; is_program(path))
        return path;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return {};
}

std::string page_address(const std::filesystem::path& page, const std::string& fragment)
{
  std::string address = "file://";
  for (const char c : std::filesystem::absolute(page).string())
  {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                          std::string_view("/-._~").find(c) != std::string_view::npos;
    address += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return address + "#" + fragment;
}

std::filesystem::path print_page(const std::filesystem::path& browser, const std::filesystem::path& page,
                                 const std::string& record_hash)
{
  const std::string address = page_address(page, "paper=" + record_hash);
  std::filesystem::path file = page;
  file.replace_extension(".pdf");
  const auto fail = [&](const std::string& problem)
  { throw io::WriteError(file, problem, fmt::format("or print {} in a browser", address)); };
  const Profile profile;
  if (profile.path().empty()) fail("Chromium needs a temporary directory, which cannot be made");
  const std::filesystem::path log = profile.path() / "log.txt";
  const std::string ended =
      run_program(browser, arguments_for(browser, profile.path(), address), {.log = log});
  const std::string pdf = io::read_text(profile.path() / "page.pdf");
  if (!ended.empty() || pdf.empty())
    fail(fmt::format("{} {}: {}", browser.string(), ended.empty() ? "prints nothing" : ended,
                     last_line(io::read_text(log))));
  if (pdf.find(title_of_unfinished) != std::string::npos)
    throw InputError({.file = page.string()}, "cannot be shown, so it is not printed",
                     "run the case again if it is damaged; Chromium has to be of 2023 or newer");
  io::write_file(file, pdf);
  return file;
}

}  // namespace tribound::app
