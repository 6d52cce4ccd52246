#include "tribound/io/record/probes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <compare>
#include <limits>
#include <tuple>
#include <utility>

#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/fem/evaluation.h"
#include "tribound/io/fields/tensor_field.h"
#include "tribound/io/record/solution_figures.h"
#include "tribound/mesh/bodies.h"
#include "tribound/mesh/box_tree.h"
#include "tribound/mesh/geometry.h"

namespace tribound::io
{

namespace
{

/// A point of a probe.
struct ProbePlace
{
  std::size_t probe;
  std::size_t point;
};

template <int dim>
struct ProbePoints
{
  std::vector<ProbePlace> places;
  std::vector<Point<dim>> x;

  explicit ProbePoints(std::span<const Probe<dim>> probes)
  {
    for (std::size_t k = 0; k < probes.size(); ++k)
      for (std::size_t i = 0; i < probes[k].points.size(); ++i)
      {
        places.push_back({k, i});
        x.push_back(probes[k].points[i]);
      }
  }
};

/// Whether no facet of the cell has the point farther outside than `tolerance`, a length.
template <int dim>
bool contains(const mesh::CellMap<dim>& map, const Point<dim>& xhat, double tolerance)
{
  if (1 - xhat.sum() < -tolerance * map.inverse_transpose.rowwise().sum().norm()) return false;
  for (int i = 0; i < dim; ++i)
    if (xhat[i] < -tolerance * map.inverse_transpose.col(i).norm()) return false;
  return true;
}

/// Calls visit(k, cell, xhat) for every own cell that has point k.
template <int dim, class Visit>
void for_each_cell_at(const mesh::Mesh<dim>& mesh, std::span<const Point<dim>> points, double tolerance,
                      const Visit& visit)
{
  std::vector<mesh::BoundingBox<dim>> boxes(points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    boxes[k].add(points[k] - Point<dim>::Constant(tolerance));
    boxes[k].add(points[k] + Point<dim>::Constant(tolerance));
  }
  const mesh::BoxTree<dim> tree(boxes);
  for (Index c = 0; c < mesh.n_owned_cells(); ++c)
  {
    const auto vertices = mesh::points_of(mesh.vertices(), mesh.cell(c));
    const mesh::BoundingBox<dim> box = mesh::bounding_box<dim>(vertices);
    tree.traverse([&](const mesh::BoundingBox<dim>& other) { return mesh::meet(box, other); },
                  [&](std::size_t k)
                  {
                    const mesh::CellMap<dim> map = mesh::cell_map(mesh, c);
                    const Point<dim> xhat = map.inverse_transpose.transpose() * (points[k] - map.origin);
                    if (contains(map, xhat, tolerance)) visit(k, c, xhat);
                  });
  }
}

constexpr double on_cell = 1e-10;  // of the diagonal of the box around the mesh

/// Distance from a simplex of one, two or three vertices.
template <int dim>
double distance(const std::vector<Point<dim>>& simplex, const Point<dim>& x)
{
  const Point<dim> from = x - simplex[0];
  if (simplex.size() == 1) return from.norm();
  const Point<dim> a = simplex[1] - simplex[0];
  const Point<dim> b =
      simplex.size() == 3 ? Point<dim>(simplex[2] - simplex[0]) : Point<dim>(Point<dim>::Zero());
  const double det = simplex.size() == 3 ? a.dot(a) * b.dot(b) - a.dot(b) * a.dot(b) : a.dot(a);
  const double bb = simplex.size() == 3 ? b.dot(b) : 1;
  const double s = (bb * a.dot(from) - a.dot(b) * b.dot(from)) / det;
  const double t = (a.dot(a) * b.dot(from) - a.dot(b) * a.dot(from)) / det;
  if (s >= 0 && t >= 0 && s + t <= 1) return (from - s * a - t * b).norm();
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < simplex.size(); ++i)
  {
    std::vector<Point<dim>> face = simplex;
    face.erase(face.begin() + static_cast<std::ptrdiff_t>(i));
    nearest = std::min(nearest, distance<dim>(face, x));
  }
  return nearest;
}

/// Of a point outside the mesh, over all ranks.
template <int dim>
double distance(const mesh::Mesh<dim>& mesh, const Point<dim>& x)
{
  double nearest = std::numeric_limits<double>::infinity();
  for (const mesh::BoundaryFacet& facet : mesh.owned_boundary())
  {
    const auto vertices =
        mesh::points_of(mesh.vertices(), mesh::facet_vertices(mesh.cell(facet.cell), facet.local));
    nearest = std::min(nearest, distance<dim>({vertices.begin(), vertices.end()}, x));
  }
  return -mesh.ranks().max(-nearest);
}

/// What a cell says of a point; plain data.
template <int dim>
struct CellValue
{
  std::size_t probe;
  std::size_t point;
  int body;
  int region;
  std::array<double, dim> u;
  std::array<double, 6> stress;
  std::array<double, 6> equilibrated;
  double difference;

  [[nodiscard]] auto row() const { return std::tie(probe, point, body, region); }
};

/// Adds the values of all entries.
template <std::size_t n>
void add(std::array<double, n>& sum, const std::array<double, n>& values, double factor)
{
  for (std::size_t i = 0; i < n; ++i) sum[i] += factor * values[i];
}

/// The means of values of one row.
template <int dim>
CellValue<dim> mean(std::span<const CellValue<dim>> values)
{
  CellValue<dim> result = values[0];
  result.u = {};
  result.stress = result.equilibrated = {};
  const double share = 1 / static_cast<double>(values.size());
  for (const CellValue<dim>& value : values)
  {
    add(result.u, value.u, share);
    add(result.stress, value.stress, share);
    add(result.equilibrated, value.equilibrated, share);
    result.difference = std::max(result.difference, value.difference);
  }
  return result;
}

/// sigma(u_h) at a point of a cell, and what the hoop strain adds to the stress around the axis.
template <int dim>
std::pair<Tensor<dim>, double> stress_at(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                         const TensorField<dim>& field, Index cell, const Point<dim>& xhat)
{
  const fem::LagrangeSpace<dim>& space = form.space();
  const std::array<Point<dim>, 1> at = {xhat};
  if constexpr (dim == 2)
    if (form.problem().is_axisymmetric())  // u_r / r is no polynomial
    {
      const mesh::CellMap<2> map = mesh::cell_map(space.mesh(), cell);
      const int region = space.mesh().region(cell);
      const problem::Material& material = form.problem().material(region);
      const fem::Tabulation<2> table = space.basis().tabulate(at);
      const Tensor<2> gradient =
          fem::gradient_at<2>(space.cell_nodes(cell), u, table.gradients_at(0), map.inverse_transpose);
      const double u_r = fem::value_at<2>(space.cell_nodes(cell), u, table.values_at(0))[0];
      const double hoop = contact::hoop_strain(map(xhat)[0], u_r, gradient(0, 0));
      Tensor<2> sigma = contact::sigma<2>(material, gradient, hoop);
      if (form.problem().regions()[region].has_initial_stress())
        sigma += form.problem().initial_stress(region, inside<2>(map, xhat));
      return {sigma, added_around_axis(material, hoop)};
    }
  return {values_at<dim>(field, space.basis(), cell, at)[0], 0.0};
}

/// The values of own cells at the points.
template <int dim>
std::vector<CellValue<dim>> cell_values(const contact::NitscheForm<dim>& form,
                                        const adapt::CertifiedLevel<dim>& level, bool has_bound,
                                        const ProbePoints<dim>& points, const mesh::Bodies& bodies)
{
  const fem::LagrangeSpace<dim>& space = form.space();
  const mesh::Mesh<dim>& mesh = space.mesh();
  // Points are allowed to be a little farther outside than when they were checked: rounding never loses one.
  const double tolerance = 2 * on_cell * mesh::box_around(mesh).diagonal();
  const TensorField<dim> stress = stress_field(form.problem(), space, level.u);
  const TensorField<dim> equilibrated = equilibrated_stress_field(space, level.stress);
  std::vector<CellValue<dim>> values;
  for_each_cell_at<dim>(mesh, points.x, tolerance,
                        [&](std::size_t k, Index c, const Point<dim>& xhat)
                        {
                          const std::array<Point<dim>, 1> at = {xhat};
                          const Point<dim> u = fem::value_at<dim>(space.cell_nodes(c), level.u,
                                                                  space.basis().tabulate(at).values_at(0));
                          const double ratio = out_of_plane_ratio(form.problem().material(mesh.region(c)));
                          const double rest = out_of_plane_rest(form.problem(), mesh.region(c), points.x[k]);
                          const auto [sigma, hoop] = stress_at<dim>(form, level.u, stress, c, xhat);
                          CellValue<dim>& value = values.emplace_back(CellValue<dim>{points.places[k].probe,
                                                                                     points.places[k].point,
                                                                                     bodies.of_cell[c],
                                                                                     mesh.region(c),
                                                                                     {},
                                                                                     {},
                                                                                     {},
                                                                                     0});
                          std::ranges::copy(u, value.u.begin());
                          value.stress = symmetric_part<dim>(sigma, ratio);
                          value.stress[2] += rest + hoop;
                          if (!has_bound || form.problem().is_axisymmetric()) return;
                          const Tensor<dim> sigma_h = values_at<dim>(equilibrated, space.basis(), c, at)[0];
                          value.equilibrated = symmetric_part<dim>(sigma_h, ratio);
                          value.equilibrated[2] += rest;
                          value.difference = (sigma - sigma_h).norm();
                        });
  return values;
}

}  // namespace

template <int dim>
void check_probes(const mesh::Mesh<dim>& mesh, std::span<const Probe<dim>> probes)
{
  if (probes.empty()) return;
  const ProbePoints<dim> points(probes);
  std::vector<double> n_cells(points.x.size(), 0.0);
  for_each_cell_at<dim>(mesh, points.x, on_cell * mesh::box_around(mesh).diagonal(),
                        [&](std::size_t k, Index, const Point<dim>&) { n_cells[k] += 1; });
  mesh.ranks().sum(std::span(n_cells));
  const auto outside = std::ranges::find(n_cells, 0.0);
  if (outside == n_cells.end()) return;
  const std::size_t k = outside - n_cells.begin();
  const Probe<dim>& probe = probes[points.places[k].probe];
  throw InputError(
      probe.where,
      fmt::format("the point ({:g}) lies outside the mesh, {:.3g} from it",
                  fmt::join(points.x[k].begin(), points.x[k].end(), ", "), distance(mesh, points.x[k])),
      "points of the body; cells are straight, a curved side lies partly outside them");
}

template <int dim>
std::vector<ProbeRecord> read_probes(const contact::NitscheForm<dim>& form,
                                     const adapt::CertifiedLevel<dim>& level, bool has_bound,
                                     std::span<const Probe<dim>> probes)
{
  if (probes.empty()) return {};
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const ProbePoints<dim> points(probes);
  const mesh::Bodies bodies = mesh::number_bodies(mesh);
  const std::vector<std::string> names = body_names<dim>(mesh, bodies);
  std::vector<CellValue<dim>> values = cell_values<dim>(form, level, has_bound, points, bodies);
  values = mesh.ranks().template gather<CellValue<dim>>(values);
  mesh.ranks().copy_from_first(values);
  std::ranges::stable_sort(values, std::less(), &CellValue<dim>::row);
  std::vector<ProbeRecord> records;
  records.reserve(probes.size());
  for (const Probe<dim>& probe : probes) records.push_back({probe.name});
  for (std::span<const CellValue<dim>> rest = values; !rest.empty();)
  {
    const auto end =
        std::ranges::find_if(rest, [&](const CellValue<dim>& v) { return v.row() != rest[0].row(); });
    const auto n = static_cast<std::size_t>(end - rest.begin());
    const CellValue<dim> value = mean<dim>(rest.first(n));
    rest = rest.subspan(n);
    const Point<dim>& x = probes[value.probe].points[value.point];
    ProbeRow& row =
        records[value.probe].rows.emplace_back(ProbeRow{value.point,
                                                        {x.begin(), x.end()},
                                                        names[value.body],
                                                        std::string(mesh.region_names()[value.region]),
                                                        {value.u.begin(), value.u.end()},
                                                        value.stress});
    if (!has_bound || form.problem().is_axisymmetric()) continue;
    row.equilibrated = value.equilibrated;
    row.difference = value.difference;
  }
  return records;
}

template void check_probes(const mesh::Mesh<2>&, std::span<const Probe<2>>);
template void check_probes(const mesh::Mesh<3>&, std::span<const Probe<3>>);
template std::vector<ProbeRecord> read_probes(const contact::NitscheForm<2>&, const adapt::CertifiedLevel<2>&,
                                              bool, std::span<const Probe<2>>);
template std::vector<ProbeRecord> read_probes(const contact::NitscheForm<3>&, const adapt::CertifiedLevel<3>&,
                                              bool, std::span<const Probe<3>>);

}  // namespace tribound::io
