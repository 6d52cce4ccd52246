#pragma once

/// @file with_case.h
/// The case of a command, read with its mesh.

#include <atomic>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/command/commands.h"
#include "app/console/text.h"
#include "tribound/case/config.h"
#include "tribound/mesh/import/read.h"

namespace tribound::app
{

[[nodiscard]] inline case_file::Config read_config(const CaseRequest& request)
{
  return request.document ? case_file::make_config(*request.document, request.case_file, request.overrides)
                          : case_file::read_config(request.case_file, request.overrides);
}

/// The mesh of a case; what its reader leaves out is said, unless `quiet`.
[[nodiscard]] inline mesh::AnyMesh read_mesh(const case_file::Config& config, const mesh::MeshSource& source,
                                             const std::atomic<bool>* stop, bool quiet)
{
  std::vector<std::string> notes;
  mesh::AnyMesh mesh = mesh::read_mesh(source, case_file::find_seams(config), stop, &notes, config.groups);
  for (const std::string& text : notes)
    if (!quiet) note(text);
  return mesh;
}

/// Calls work(config, mesh) in the dimension of the mesh; `stop` may interrupt reading.
template <class Work>
auto with_case(const CaseRequest& request, const std::atomic<bool>* stop, const Work& work)
{
  const case_file::Config config = read_config(request);
  mesh::AnyMesh mesh = read_mesh(config, config.mesh, stop, request.quiet);
  return std::visit([&](auto& m) { return work(config, std::move(m)); }, mesh);
}

}  // namespace tribound::app
