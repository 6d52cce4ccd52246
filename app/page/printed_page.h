#pragma once

/// @file printed_page.h
/// Pages as PDF, printed by Chromium without a window.

#include <filesystem>
#include <string>

namespace tribound::app
{

/// Chromium: the program that the variable CHROMIUM names, else the first of its usual names on PATH; empty
/// if there is none. Throws InputError where CHROMIUM names no program.
[[nodiscard]] std::filesystem::path find_browser();

/// The address of a file, with the part behind # that the page reads.
[[nodiscard]] std::string page_address(const std::filesystem::path& page, const std::string& fragment);

/// Prints the page for paper, once it has drawn everything, to a PDF of the same name beside it, whose path
/// is returned. `record_hash`: of the file that the page shows, to be printed on it. Throws InputError where
/// the page cannot be shown, and WriteError where nothing is printed.
std::filesystem::path print_page(const std::filesystem::path& browser, const std::filesystem::path& page,
                                 const std::string& record_hash);

}  // namespace tribound::app
