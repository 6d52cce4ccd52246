#pragma once

/// @file mesh.h
/// Meshes in Python.

#include <pybind11/pybind11.h>

#include "tribound/mesh/mesh.h"

namespace tribound::python
{

/// points, cells, region (number of each cell's region), region_names, facets, facet_group, boundary_names:
/// of the own
/// cells of this rank, with views of a mesh that `owner` keeps.
template <int dim>
[[nodiscard]] pybind11::dict mesh_arrays(const mesh::Mesh<dim>& mesh, const pybind11::object& owner);

void bind_meshes(pybind11::module_& module);

}  // namespace tribound::python
