/// @file write_vtu.cpp
/// Writes VTU files of polynomial displacements for read_vtu.py, which knows the polynomials too.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "tribound/io/fields/vtu.h"
#include "unit/io/box_case.h"

namespace tribound::test
{
namespace
{

template <int dim>
std::string case_text(int degree)
{
  const std::string box = dim == 2 ? "{ lower = [0, 0], upper = [2, 1], cells = [3, 2] }"
                                   : "{ lower = [0, 0, 0], upper = [2, 1, 1], cells = [2, 2, 2] }";
  const std::string obstacle = dim == 2 ? "bottom" : "back";
  return "degree = " + std::to_string(degree) + "\nmesh = { box = " + box +
         " }\nmaterial = { E = 1.0, nu = 0.3 }\n[boundary.right]\ndisplacement = [0, 0" +
         (dim == 3 ? ", 0" : "") + "]\n[boundary." + obstacle +
         "]\ncontact = { friction = \"tresca\", threshold = 0.03, gap = 0.25 }\n";
}

/// Moves inner vertices, so that no two cells are alike.
template <int dim>
void distort(mesh::MeshData<dim>& data)
{
  for (Point<dim>& x : data.vertices)
  {
    double bubble = x[0] * (2.0 - x[0]);
    for (int i = 1; i < dim; ++i) bubble *= 4.0 * x[i] * (1.0 - x[i]);
    for (int i = 0; i < dim; ++i) x[i] += 0.1 * bubble * std::sin(5.0 * x[0] + 3.0 * i);
  }
}

/// u_a = 0.1 sum_{j <= p} (c_a . x - 0.1 a)^j with c_a = (1 + a, 0.5 a - 2, 0.5 + a).
template <int dim>
Point<dim> displacement(int degree, const Point<dim>& x)
{
  Point<dim> u;
  for (int a = 0; a < dim; ++a)
  {
    double s = (1.0 + a) * x[0] + (0.5 * a - 2.0) * x[1] - 0.1 * a;
    if (dim == 3) s += (0.5 + a) * x[dim - 1];
    u[a] = 0.0;
    for (int j = 0; j <= degree; ++j) u[a] += 0.1 * std::pow(s, j);
  }
  return u;
}

template <int dim>
void write(const std::filesystem::path& directory, int degree, nlohmann::json& manifest)
{
  const BoxCase<dim> box(case_text<dim>(degree), distort<dim>);
  const auto u = box.interpolate([degree](const Point<dim>& x) { return displacement<dim>(degree, x); });
  std::vector<double> eta;
  for (Index c = 0; c < box.mesh.n_cells(); ++c) eta.push_back(0.5 * c);
  const io::TensorField<dim> stress = io::stress_field(box.problem, box.space, u);
  const std::vector<io::TensorField<dim>> tensors{{"twice_stress",
                                                   [&stress](Index cell, std::span<Tensor<dim>> values)
                                                   {
                                                     stress.at_nodes(cell, values);
                                                     for (Tensor<dim>& value : values) value *= 2.0;
                                                   }}};
  const std::vector<io::CellField> cell_fields{{"eta_tot", eta}};

  const std::string name = std::to_string(dim) + "d_p" + std::to_string(degree) + ".vtu";
  io::write_level_vtu<dim>(directory / ("level_" + name), degree, box.problem, box.space, u, cell_fields,
                           tensors);
  io::write_contact_vtu<dim>(directory / ("contact_" + name), degree, box.form, u);
  manifest["files"].push_back({{"level", "level_" + name},
                               {"contact", "contact_" + name},
                               {"dimension", dim},
                               {"degree", degree},
                               {"cells", box.mesh.n_cells()},
                               {"contact_facets", box.form.contact_facets().size()}});
}

/// An empty contact file is a file all the same.
void write_without_contact(const std::filesystem::path& directory)
{
  const BoxCase<2> box(
      "degree = 2\nmesh = { box = { lower = [0, 0], upper = [1, 1], cells = [1, 1] } }\n"
      "material = { E = 1.0, nu = 0.3 }\n[boundary.left]\ndisplacement = [0, 0]\n");
  const std::vector<double> u(box.space.n_dofs(), 0.0);
  io::write_contact_vtu<2>(directory / "no_contact.vtu", 0, box.form, u);
}

}  // namespace
}  // namespace tribound::test

int main(int argc, char** argv)
{
  if (argc != 2)
  {
    std::cerr << "usage: io_write_vtu DIRECTORY\n";
    return 1;
  }
  const std::filesystem::path directory = argv[1];
  std::filesystem::create_directories(directory);
  nlohmann::json manifest;
  for (int degree = 1; degree <= 4; ++degree)
  {
    tribound::test::write<2>(directory, degree, manifest);
    tribound::test::write<3>(directory, degree, manifest);
  }
  tribound::io::write_series(directory, 2);
  tribound::test::write_without_contact(directory);
  std::ofstream(directory / "manifest.json") << manifest.dump(2) << '\n';
}
