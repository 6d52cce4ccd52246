#include "app/page/page_level.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "app/page/packed_array.h"
#include "tribound/fem/evaluation.h"
#include "tribound/io/fields/vtu.h"
#include "tribound/mesh/geometry.h"

namespace tribound::app
{

namespace
{

// Bits per number: more than is visible, and close to what a reader of values needs.
constexpr int point_bits = 24;
constexpr int displacement_bits = 16;
constexpr int stress_bits = 12;
constexpr int component_bits = 10;
constexpr double component_decades = 8;

/// Component by component.
io::Json stress_json(std::span<const std::vector<double>> stress)
{
  double scale = 0;
  for (const std::vector<double>& component : stress) scale = std::max(scale, largest(component));
  io::Json components = io::Json::array();
  for (const std::vector<double>& component : stress)
    components.push_back(pack_values(component, scale, stress_bits));
  return components;
}

/// eta_tot and the components, one number per face; those that are zero everywhere are omitted.
io::Json eta_json(const Surface& surface, const certify::Estimate& estimate)
{
  io::Json eta = io::Json::object();
  std::vector<double> values(surface.n_faces());
  const auto add = [&](const char* name, const auto& value)
  {
    for (std::size_t face = 0; face < values.size(); ++face)
      values[face] = value(estimate.cells[surface.cells[face]]);
    if (std::ranges::any_of(values, [](double x) { return x > 0.0; }))
      eta[name] = pack_logarithmic(values, component_bits, component_decades);
  };
  add("tot", [](const certify::BoundComponents& cell) { return cell.total_sharp(); });
  for (const certify::Component& c : certify::all_components)
    if (estimate.global.*c.value > 0)
      add(c.name, [&c](const certify::BoundComponents& cell) { return cell.*c.value; });
  return eta;
}

/// sigma_zz / (sigma_xx + sigma_yy), by region.
io::Json out_of_plane_json(const problem::Problem<2>& problem, const mesh::Mesh<2>& mesh)
{
  io::Json ratios = io::Json::array();
  for (int region = 0; region < static_cast<int>(mesh.region_names().size()); ++region)
    ratios.push_back(io::out_of_plane_ratio(problem.material(region)));
  return ratios;
}

/// The region of each face.
template <int dim>
io::Json region_json(const Surface& surface, const mesh::Mesh<dim>& mesh)
{
  std::vector<Index> regions;
  for (const Index cell : surface.cells) regions.push_back(mesh.region(cell));
  return pack_integers(regions);
}

}  // namespace

template <int dim>
io::Json surface_json(const contact::NitscheForm<dim>& form, const Surface& surface)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  io::Json json{{"dimension", dim},
                {"cells", mesh.n_global_cells()},
                {"subdivision", surface.subdivision},
                {"merged_below", surface.merged_below},
                {"points", pack_linear(surface.points, point_bits, dim)},
                {"displacement", pack_linear(surface.displacement, displacement_bits, dim)},
                {"faces", pack_integers(surface.faces, surface.n_face_points())},
                {"stress", stress_json(surface.stress)}};
  if (mesh.region_names().size() > 1) json["region"] = region_json(surface, mesh);
  if (!surface.bodies.empty() && std::ranges::max(surface.bodies) > 0)
    json["body"] = pack_integers(surface.bodies);
  if constexpr (dim == 2) json["out_of_plane"] = out_of_plane_json(form.problem(), mesh);
  return json;
}

template <int dim>
PageLevel page_level(int number, const contact::NitscheForm<dim>& form,
                     const adapt::CertifiedLevel<dim>& level, const PageLimits& limits)
{
  const Surface surface = sample_surface(form, level.u, level.stress, limits);
  PageLevel result{number, surface.n_triangles(), {{"level", number}}};
  result.json.update(surface_json(form, surface));
  result.json["eta"] = eta_json(surface, level.estimate);
  result.json.update(page_contact(form, level.u, surface, limits));
  return result;
}

io::Json page_volume(const contact::NitscheForm<3>& form, const adapt::CertifiedLevel<3>& level)
{
  const mesh::Mesh<3>& mesh = form.space().mesh();
  if (std::cmp_greater(mesh.n_global_cells(), PageLimits().volume)) return nullptr;
  const fem::LagrangeSpace<3> corners(mesh, 1);
  const fem::Tabulation<3> at_corners = form.space().basis().tabulate(corners.basis().node_points());
  const io::TensorField<3> sigma = io::equilibrated_stress_field(corners, level.stress);
  const std::vector<int> body_of = mesh::connected_parts(mesh.topology());
  const std::size_t n = corners.n_nodes();
  std::vector<double> points;
  for (const Point<3>& x : corners.node_points()) points.insert(points.end(), x.begin(), x.end());
  std::vector<double> displacement(3 * n);
  std::vector<std::vector<double>> stress(stress_entries<3>.size(), std::vector<double>(n));
  std::vector<double> weight(n);
  std::vector<Index> cells;
  std::vector<Index> bodies(n);
  std::array<Tensor<3>, 4> values;
  for (Index cell = 0; cell < mesh.n_cells(); ++cell)
  {
    sigma.at_nodes(cell, values);
    const double det = mesh::cell_map(mesh, cell).det;
    for (int i = 0; i < 4; ++i)
    {
      const Index vertex = corners.cell_nodes(cell)[i];
      cells.push_back(vertex);
      bodies[vertex] = body_of[cell];
      weight[vertex] += det;
      const std::array<double, 6> components = io::symmetric_part<3>(values[i], 0.0);
      for (std::size_t s = 0; s < components.size(); ++s) stress[s][vertex] += det * components[s];
      const Point<3> u = fem::value_at<3>(form.space().cell_nodes(cell), level.u, at_corners.values_at(i));
      std::ranges::copy(u, displacement.begin() + 3 * static_cast<std::ptrdiff_t>(vertex));
    }
  }
  for (std::vector<double>& component : stress)
    for (std::size_t v = 0; v < n; ++v) component[v] /= weight[v];
  return {{"points", pack_linear(points, point_bits, 3)},
          {"displacement", pack_linear(displacement, displacement_bits, 3)},
          {"cells", pack_integers(cells, 4)},
          {"bodies", pack_integers(bodies)},
          {"stress", stress_json(stress)}};
}

template io::Json surface_json(const contact::NitscheForm<2>&, const Surface&);
template io::Json surface_json(const contact::NitscheForm<3>&, const Surface&);
template PageLevel page_level(int, const contact::NitscheForm<2>&, const adapt::CertifiedLevel<2>&,
                              const PageLimits&);
template PageLevel page_level(int, const contact::NitscheForm<3>&, const adapt::CertifiedLevel<3>&,
                              const PageLimits&);

}  // namespace tribound::app
