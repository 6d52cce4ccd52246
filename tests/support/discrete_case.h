#pragma once

/// @file discrete_case.h
/// A case from TOML text with everything up to the discrete problem, for tests.

#include <string>
#include <utility>

#include "tribound/case/config.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/mesh/gmsh.h"
#include "tribound/solve/newton.h"

namespace tribound::test
{

template <int dim>
struct DiscreteCase
{
  explicit DiscreteCase(const std::string& toml) : DiscreteCase(parse_config(toml)) {}
  /// On the given mesh; the text has no [mesh].
  DiscreteCase(const std::string& toml, MeshData<dim> data) : DiscreteCase(toml, Mesh<dim>(std::move(data)))
  {
  }
  DiscreteCase(const std::string& toml, Mesh<dim> m)
      : DiscreteCase(parse_config("mesh.box = { lower = [0, 0], upper = [1, 1], cells = [1, 1] }\n" + toml),
                     std::move(m))
  {
  }
  /// As read from a case file.
  explicit DiscreteCase(const Config& c) : DiscreteCase(c, std::get<Mesh<dim>>(read_mesh(c.mesh))) {}
  DiscreteCase(const DiscreteCase&) = delete;
  DiscreteCase& operator=(const DiscreteCase&) = delete;

  /// With T_delta for delta > 0.
  [[nodiscard]] NewtonResult<dim> solve(double delta = 0) const
  {
    return tribound::solve<dim>(form, {}, config.newton, config.solver, {}, delta);
  }

  Config config;  ///< what solve() obeys
  Mesh<dim> mesh;
  Problem<dim> problem;
  LagrangeSpace<dim> space;
  NitscheForm<dim> form;

 private:
  DiscreteCase(Config c, Mesh<dim> m)
      : config(std::move(c)),
        mesh(std::move(m)),
        problem(config, mesh.region_names(), mesh.boundary_names()),
        space(mesh, config.degree),
        form(problem, space, config.gamma0())
  {
  }
};

}  // namespace tribound::test
