#pragma once

/// @file box_case.h
/// Everything that the output of a small case needs, from the text of the case.

#include <functional>
#include <string_view>
#include <variant>

#include "tribound/case/resolve.h"
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
        mesh(changed_mesh(std::get<mesh::BoxMesh>(config.mesh), change)),
        problem(case_file::resolve(config, mesh)),
        space(mesh, config.method.degree),
        form(problem, space, config.method.gamma_0())
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
  static mesh::Mesh<dim> changed_mesh(const mesh::BoxMesh& box,
                                      const std::function<void(mesh::MeshData<dim>&)>& change)
  {
    mesh::MeshData<dim> data = mesh::box_mesh<dim>(box);
    if (change) change(data);
    return mesh::Mesh<dim>(std::move(data));
  }
};

}  // namespace tribound::test
