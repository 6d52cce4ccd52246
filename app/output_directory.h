#pragma once

/// @file output_directory.h
/// The output directory of a case.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "tribound/case/config.h"
#include "tribound/io/file/output_directory.h"

namespace tribound::app
{

/// Throws InputError where the mesh of the case is adapted.msh in output.directory, which a run removes.
void require_mesh_elsewhere(const case_file::Config& config);

/// Takes the output directory of a run, and removes the results of an earlier one, the certificate first,
/// unless they are kept. Throws InputError where nothing can be written.
[[nodiscard]] std::unique_ptr<io::OutputDirectory> take_directory(const case_file::Config& config,
                                                                  bool keeps_results);

/// The directory of a load step that was judged, below that of the judgement; steps are counted from 0.
[[nodiscard]] std::filesystem::path judged_step_directory(std::size_t step);

/// case.toml, or case_effective.toml where the former is the input file and has other contents: it is not
/// replaced.
[[nodiscard]] std::string effective_file_name(const case_file::Config& config);

}  // namespace tribound::app
