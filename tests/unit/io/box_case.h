#pragma once

/// @file box_case.h
/// Everything that the output of a small case needs, from the text of the case.

#include <functional>
#include <string_view>
#include <variant>

#include "tribound/case/config.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/fem/space.h"
#include "tribound/mesh/box.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::test
{

template <int dim>
struct BoxCase
{
  case_file::Config config;
  mesh::Mesh<dim> mesh;
  problem::Problem<dim> problem;
  fem::LagrangeSpace<dim> space;
  contact::NitscheForm<dim> form;

  /// `change` may alter the mesh before it is built.
  explicit BoxCase(std::string_view text, const std::function<void(mesh::MeshData<dim>&)>& change = {})
      : config(case_file::parse_config(text)),
        mesh(changed_mesh(std::get<case_file::BoxMesh>(config.mesh), change)),
        problem(config, mesh.region_names(), mesh.boundary_names()),
        space(mesh, config.degree),
        form(problem, space, config.gamma0())
  {
  }

  BoxCase(const BoxCase&) = delete;
  BoxCase& operator=(const BoxCase&) = delete;

  /// Nodal interpolant of f.
  [[nodiscard]] std::vector<double> interpolate(const std::function<Point<dim>(const Point<dim>&)>& f) const
  {
    std::vector<double> u;
    for (const Point<dim>& x : space.node_points())
    {
      const Point<dim> value = f(x);
      u.insert(u.end(), value.begin(), value.end());
    }
    return u;
  }

 private:
  static mesh::Mesh<dim> changed_mesh(const case_file::BoxMesh& box,
                                      const std::function<void(mesh::MeshData<dim>&)>& change)
  {
    mesh::MeshData<dim> data = mesh::box_mesh<dim>(box);
    if (change) change(data);
    return mesh::Mesh<dim>(std::move(data));
  }
};

}  // namespace tribound::test
