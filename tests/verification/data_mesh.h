#pragma once

/// @file data_mesh.h
/// The meshes in tests/verification/data.

#include <fmt/format.h>

#include <string>
#include <variant>

#include "tribound/mesh/import/read.h"

namespace tribound::test
{

/// The mesh of <name>2.geo or <name>3.geo.
template <int dim>
mesh::Mesh<dim> data_mesh(const std::string& name)
{
  return std::get<mesh::Mesh<dim>>(
      mesh::read_mesh(mesh::MeshFile{fmt::format("{}/{}{}.geo", VERIFICATION_DATA, name, dim)}));
}

}  // namespace tribound::test
