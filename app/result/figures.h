#pragma once

/// @file figures.h
/// The figures of a study, drawn by the script `study_figures`.

#include <filesystem>
#include <optional>
#include <string>

namespace tribound::app
{

/// The script study_figures, see find_shared_file(); nothing where there is none that may be run.
[[nodiscard]] std::optional<std::filesystem::path> find_figure_script();

/// Runs `script` with the directory of a study as its argument and waits for it. Returns what went wrong;
/// empty when it succeeded.
[[nodiscard]] std::string run_figure_script(const std::filesystem::path& script,
                                            const std::filesystem::path& directory);

/// Draws the figures of the study in `directory` and says on stdout where they are or why there are none.
void draw_figures(const std::filesystem::path& directory);

}  // namespace tribound::app
