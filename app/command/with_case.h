#pragma once

/// @file with_case.h
/// The case of a command, read with its mesh.

#include <utility>
#include <variant>

#include "app/command/commands.h"
#include "tribound/case/config.h"
#include "tribound/mesh/gmsh.h"

namespace tribound::app
{

/// Calls work(config, mesh) in the dimension of the mesh; `stop` may interrupt reading.
template <class Work>
auto with_case(const CaseRequest& request, const std::atomic<bool>* stop, const Work& work)
{
  const case_file::Config config = case_file::read_config(request.case_file, request.overrides);
  mesh::AnyMesh mesh = mesh::read_mesh(config.mesh, case_file::find_seams(config), stop);
  return std::visit([&](auto& m) { return work(config, std::move(m)); }, mesh);
}

}  // namespace tribound::app
