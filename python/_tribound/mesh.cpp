#include "python/_tribound/mesh.h"

#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <vector>

#include "app/command/commands.h"
#include "app/console/text.h"
#include "python/_tribound/arrays.h"
#include "tribound/mesh/box.h"
#include "tribound/mesh/import/read.h"

namespace tribound::python
{

namespace py = pybind11;

namespace
{

/// A mesh by itself, without a case that would cut it open or give it groups.
py::object arrays_of(const mesh::MeshSource& source)
{
  std::vector<std::string> notes;
  auto any = std::make_unique<mesh::AnyMesh>(
      [&]
      {
        const py::gil_scoped_release others_run;
        return mesh::read_mesh(source, {}, &app::stop_on_signals(), &notes);
      }());
  for (const std::string& text : notes) app::note(text);
  const mesh::AnyMesh& mesh = *any;
  const py::capsule owner(any.release(), [](void* data) { delete static_cast<mesh::AnyMesh*>(data); });
  return std::visit([&](const auto& read) -> py::object { return mesh_arrays(read, owner); }, mesh);
}

py::object read_file(const std::string& path, double size, double merge, bool ignore_elements,
                     const std::string& region_array, const std::vector<std::string>& boundaries)
{
  return arrays_of(mesh::MeshFile{.path = path,
                                  .where = {.file = path},
                                  .options = {size, merge, ignore_elements, region_array, boundaries}});
}

py::object make_box(const std::vector<double>& lower, const std::vector<double>& upper,
                    const std::vector<int>& cells)
{
  const mesh::BoxMesh box{.lower = lower, .upper = upper, .cells = cells, .where = {.key = "box"}};
  mesh::require_valid(box);
  return arrays_of(box);
}

}  // namespace

template <int dim>
py::dict mesh_arrays(const mesh::Mesh<dim>& mesh, const py::object& owner)
{
  std::vector<int> regions;
  regions.reserve(mesh.n_owned_cells());
  for (Index c = 0; c < mesh.n_owned_cells(); ++c) regions.push_back(mesh.region(c));
  std::vector<Index> facets;
  std::vector<int> groups;
  for (const mesh::BoundaryFacet& facet : mesh.owned_boundary())
  {
    const auto vertices = mesh::facet_vertices(mesh.cell(facet.cell), facet.local);
    facets.insert(facets.end(), vertices.begin(), vertices.end());
    groups.push_back(facet.tag);
  }
  const auto n_facets = static_cast<py::ssize_t>(groups.size());
  py::dict arrays;
  arrays["points"] = view(mesh.vertices().front().data(), {mesh.n_vertices(), dim}, owner);
  arrays["cells"] = view(mesh.cells().front().data(), {mesh.n_owned_cells(), dim + 1}, owner);
  arrays["region"] = owned(std::move(regions), {mesh.n_owned_cells()});
  arrays["region_names"] = std::vector<std::string>(mesh.region_names().begin(), mesh.region_names().end());
  arrays["facets"] = owned(std::move(facets), {n_facets, dim});
  arrays["facet_group"] = owned(std::move(groups), {n_facets});
  arrays["boundary_names"] =
      std::vector<std::string>(mesh.boundary_names().begin(), mesh.boundary_names().end());
  return arrays;
}

template py::dict mesh_arrays(const mesh::Mesh<2>&, const py::object&);
template py::dict mesh_arrays(const mesh::Mesh<3>&, const py::object&);

void bind_meshes(py::module_& module)
{
  module.def("read_mesh", &read_file, py::arg("path"), py::arg("size") = 0, py::arg("merge") = 0,
             py::arg("ignore_elements") = false, py::arg("region_array") = "",
             py::arg("boundaries") = std::vector<std::string>{});
  module.def("box_mesh", &make_box, py::arg("lower"), py::arg("upper"), py::arg("cells"));
}

}  // namespace tribound::python
