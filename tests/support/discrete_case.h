#pragma once

/// @file discrete_case.h
/// A case from TOML text with everything up to the discrete problem, for tests.

#include <string>
#include <utility>

#include "tribound/case/resolve.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/mesh/gmsh.h"
#include "tribound/solve/newton.h"

namespace tribound::test
{

template <int dim>
struct DiscreteCase
{
  explicit DiscreteCase(const std::string& toml) : DiscreteCase(case_file::parse_config(toml)) {}
  /// On the given mesh; the text has no [mesh].
  DiscreteCase(const std::string& toml, mesh::MeshData<dim> data)
      : DiscreteCase(toml, mesh::Mesh<dim>(std::move(data)))
  {
  }
  DiscreteCase(const std::string& toml, mesh::Mesh<dim> m)
      : DiscreteCase(
            case_file::parse_config("mesh.box = { lower = [0, 0], upper = [1, 1], cells = [1, 1] }\n" + toml),
            std::move(m))
  {
  }
  /// As read from a case file.
  explicit DiscreteCase(const case_file::Config& c)
      : DiscreteCase(c, std::get<mesh::Mesh<dim>>(mesh::read_mesh(c.mesh)))
  {
  }
  DiscreteCase(const DiscreteCase&) = delete;
  DiscreteCase& operator=(const DiscreteCase&) = delete;

  /// With T_delta for delta > 0.
  [[nodiscard]] solve::NewtonResult<dim> solve(double delta = 0) const
  {
    return tribound::solve::solve<dim>(form, {}, config.method.newton, config.method.solver, {}, delta);
  }

  case_file::Config config;  ///< what solve() obeys
  mesh::Mesh<dim> mesh;
  problem::Problem<dim> problem;
  fem::LagrangeSpace<dim> space;
  contact::NitscheForm<dim> form;

 private:
  DiscreteCase(case_file::Config c, mesh::Mesh<dim> m)
      : config(std::move(c)),
        mesh(std::move(m)),
        problem(case_file::resolve(config, mesh)),
        space(mesh, config.method.degree),
        form(problem, space, config.method.gamma_0())
  {
  }
};

}  // namespace tribound::test
