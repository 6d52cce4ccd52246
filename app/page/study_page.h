#pragma once

/// @file study_page.h
/// report.html of a study: its data, put into the template of app/page/page_template.h.

#include <filesystem>

#include "app/result/study.h"

namespace tribound::app
{

/// Writes report.html into the directory, with links to the tables, the figures and the pages of the variants
/// that are there. Does nothing without a template. Throws WriteError when the file cannot be written.
void write_study_page(const std::filesystem::path& page_template, const std::filesystem::path& directory,
                      const Study& study);

}  // namespace tribound::app
