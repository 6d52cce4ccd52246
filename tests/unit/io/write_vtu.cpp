/// @file write_vtu.cpp
/// Writes VTU files of polynomial displacements for read_vtu.py, which also knows the polynomials.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/discrete_problem.h"
#include "support/fields.h"
#include "support/meshes.h"
#include "tribound/io/fields/vtu.h"

namespace tribound::test
{
namespace
{

/// An interior vertex, moved so that no two cells are alike.
template <int dim>
Point<dim> moved(Point<dim> x)
{
  double bubble = x[0] * (2.0 - x[0]);
  for (int i = 1; i < dim; ++i) bubble *= 4.0 * x[i] * (1.0 - x[i]);
  for (int i = 0; i < dim; ++i) x[i] += 0.1 * bubble * std::sin(5.0 * x[0] + 3.0 * i);
  return x;
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
  const DiscreteProblem<dim> box(
      mapped(block<dim>({3, 2}, {2, 2, 2}), moved<dim>),
      {.boundaries = {clamped<dim>("right"),
                      obstacle<dim>(dim == 2 ? "bottom" : "back", Tresca(0.03), 0.25)}},
      {.degree = degree});
  const auto u =
      interpolate(box.space, [degree](const Point<dim>& x) { return displacement<dim>(degree, x); });
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
  io::write_level_vtu<dim>({directory / ("level_" + name)}, {degree}, box.problem, box.space, u, cell_fields,
                           tensors);
  io::write_contact_vtu<dim>(directory / ("contact_" + name), {degree}, box.form, u);
  manifest["files"].push_back({{"level", "level_" + name},
                               {"contact", "contact_" + name},
                               {"dimension", dim},
                               {"degree", degree},
                               {"cells", box.mesh.n_cells()},
                               {"contact_facets", box.form.segments().size()}});
}

/// An empty contact file is still a valid file.
void write_without_contact(const std::filesystem::path& directory)
{
  const DiscreteProblem<2> box(test::box<2>({0, 0}, {1, 1}, {1, 1}), {.boundaries = {clamped<2>("left")}},
                               {.degree = 2});
  const std::vector<double> u(box.space.n_dofs(), 0.0);
  io::write_contact_vtu<2>(directory / "no_contact.vtu", {0}, box.form, u);
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
  for (const int level : {0, 1})
    std::ofstream(directory / tribound::io::level_file_name("level", level)) << '\n';
  tribound::io::write_series(directory, 0, 1);
  tribound::test::write_without_contact(directory);
  std::ofstream(directory / "manifest.json") << manifest.dump(2) << '\n';
}
