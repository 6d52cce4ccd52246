#pragma once

/// @file output_directory.h
/// The directory of results of a case.

#include <memory>
#include <string>

#include "tribound/case/config.h"
#include "tribound/io/file/output_directory.h"

namespace tribound::app
{

/// Throws InputError where the mesh of the case is adapted.msh in output.directory, which a run removes.
void require_mesh_elsewhere(const case_file::Config& config);

/// Takes the directory of results of a run, and removes what an earlier one has left there, the certificate
/// first, unless its results are kept. Throws InputError where nothing can be written.
[[nodiscard]] std::unique_ptr<io::OutputDirectory> take_directory(const case_file::Config& config,
                                                                  bool keeps_results);

/// case.toml; case_effective.toml where the former is the file that was read and holds something else:
/// it is not replaced.
[[nodiscard]] std::string effective_file_name(const case_file::Config& config);

}  // namespace tribound::app
