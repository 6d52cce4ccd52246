#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "app/command/commands.h"
#include "app/console/text.h"
#include "app/page/printed_page.h"
#include "tribound/base/error.h"
#include "tribound/base/sha256.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/file/json.h"

namespace tribound::app
{

namespace
{

/// A page, and the result that it shows.
struct ResultPage
{
  std::filesystem::path page;
  std::string record_hash;  ///< SHA-256 of the JSON file
};

/// The result of a page, by the name of the data in it.
constexpr std::array<std::pair<const char*, const char*>, 4> records = {
    {{"run-data", "certificate.json"},
     {"study-data", "study.json"},
     {"sweep-data", "sweep.json"},
     {"judgement-data", "judgement.json"}}};

/// The page with its result. Throws InputError where one of them is damaged.
ResultPage read_page(const std::filesystem::path& page)
{
  const std::string text = io::read_text(page);
  const auto known = std::ranges::find_if(
      records,
      [&](const auto& kind)
      {
        return text.find(fmt::format("<script type=\"application/json\" id=\"{}\">", kind.first)) !=
               std::string::npos;
      });
  if (known == records.end())
    throw InputError({.file = page.string()}, "is damaged: it has no data", "run the case again");
  const std::filesystem::path record = page.parent_path() / known->second;
  const std::string result = io::read_text(record);
  if (result.empty())
    throw InputError({.file = record.string()}, "cannot be read, but the page beside it shows it",
                     "run the case again");
  if (!io::Json::parse(result, nullptr, false).is_object())
    throw InputError({.file = record.string()}, "is damaged: it is not the JSON that tribound has written",
                     "run the case again");
  return {page, sha256(result)};
}

/// The pages of a directory. Throws InputError if there are none.
std::vector<ResultPage> pages_of(const std::filesystem::path& directory)
{
  std::error_code none;
  if (!std::filesystem::is_directory(directory, none))
    throw InputError({.file = directory.string()}, "is no directory",
                     "a directory of results, which output.directory of the case names");
  std::vector<ResultPage> pages;
  for (const char* name : {"report.html", "judgement.html"})
    if (std::filesystem::exists(directory / name, none)) pages.push_back(read_page(directory / name));
  if (!pages.empty()) return pages;
  if (std::filesystem::exists(directory / "certificate.json", none))
    throw InputError({.file = directory.string()}, "has no report.html to print",
                     "run the case to its end, with output.report = true");
  throw InputError({.file = directory.string()}, "has no results to report: no certificate.json",
                   "a directory into which tribound has written results");
}

std::filesystem::path require_browser(const ResultPage& first)
{
  std::filesystem::path browser = find_browser();
  if (!browser.empty()) return browser;
  throw InputError({}, "Chromium is not installed, which prints the report",
                   fmt::format("apt install chromium, or name it in CHROMIUM, or print {} in any browser",
                               page_address(first.page, "paper")));
}

}  // namespace

void print_report(const ReportRequest& request)
{
  const std::vector<ResultPage> pages = pages_of(request.directory);
  if (!request.pdf)
  {
    for (const auto& [page, record_hash] : pages)
      print(line("print", page_address(page, "paper=" + record_hash)));
    print(line("", "in a browser, or let --pdf do it"));
    return;
  }
  const std::filesystem::path browser = require_browser(pages.front());
  for (const auto& [page, record_hash] : pages)
    print(line("report", print_page(browser, page, record_hash).string()));
}

}  // namespace tribound::app
