#include "app/page/page_surface.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <numeric>
#include <utility>

#include "tribound/fem/evaluation.h"
#include "tribound/io/fields/vtu.h"
#include "tribound/mesh/bodies.h"

namespace tribound::app
{

namespace
{

/// A triangle of the picture: a cell in 2D, a boundary facet in 3D.
struct Face
{
  Index cell;
  int local;    ///< 3D: local facet
  Index facet;  ///< 3D: number in Mesh::boundary()
};

/// The segments against rigid obstacles, each a facet; they precede all others.
template <int dim>
std::span<const contact::ContactSegment<dim>> obstacle_segments(const contact::NitscheForm<dim>& form)
{
  const auto end =
      std::ranges::partition_point(form.segments(), &contact::ContactSegment<dim>::is_obstacle_facet);
  return form.segments().first(end - form.segments().begin());
}

template <int dim>
std::vector<Face> contact_faces(const contact::NitscheForm<dim>& form)
{
  std::vector<Face> faces;
  if constexpr (dim == 3)
    for (const contact::ContactSegment<3>& segment : obstacle_segments(form))
      faces.push_back(
          {segment.slave.facet.cell, segment.slave.facet.local, static_cast<Index>(segment.slave.number)});
  return faces;
}

/// All faces, those of contact_faces() first.
template <int dim>
std::vector<Face> all_faces(const contact::NitscheForm<dim>& form)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  std::vector<Face> faces = contact_faces(form);
  if constexpr (dim == 2)
    for (Index c = 0; c < mesh.n_cells(); ++c) faces.push_back({c, 0, 0});
  else
    for (Index k = 0; k < static_cast<Index>(mesh.boundary().size()); ++k)
      if (const mesh::BoundaryFacet& facet = mesh.boundary()[k]; !form.problem().boundary(facet.tag).contact)
        faces.push_back({facet.cell, facet.local, k});
  return faces;
}

template <int dim>
int shown_degree(const contact::NitscheForm<dim>& form, const PageLimits& limits)
{
  return std::max(form.space().degree(), limits.degree);
}

/// The corners of a face in the cell, anticlockwise as seen from outside.
template <int dim>
std::array<int, 3> corners(int local)
{
  if constexpr (dim == 2) return {0, 1, 2};
  std::array<int, 3> vertices = mesh::facet_vertices(std::array<Index, 4>{0, 1, 2, 3}, local);
  if (turns_the_other_way(local)) std::swap(vertices[1], vertices[2]);
  return vertices;
}

/// The lattice of a face in the nodes of degree k of the cell.
template <int dim>
std::vector<int> face_lattice(const fem::LagrangeBasis<dim>& basis, int local)
{
  const int k = basis.degree();
  const std::array<int, 3> corner = corners<dim>(local);
  std::vector<int> nodes;
  for (int j = 0; j <= k; ++j)
    for (int i = 0; i + j <= k; ++i)
    {
      std::array<int, dim + 1> weights{};
      weights[corner[0]] = k - i - j;
      weights[corner[1]] = i;
      weights[corner[2]] = j;
      int node = 0;
      while (basis.node(node) != weights) ++node;
      nodes.push_back(node);
    }
  return nodes;
}

/// Fills a Surface face by face.
template <int dim>
class SurfaceSampler
{
 public:
  SurfaceSampler(const contact::NitscheForm<dim>& form, std::span<const double> u,
                 const StressAt<dim>& stress, int subdivision)
      : form_(form),
        u_(u),
        space_(form.space().mesh(), subdivision),
        stress_(stress(space_)),
        body_of_(mesh::number_bodies(space_.mesh()).of_cell),
        vertex_of_node_(space_.n_nodes(), -1)
  {
    surface_.subdivision = subdivision;
    has_rest_ = stress_.hoop != nullptr ||
                std::ranges::any_of(form.problem().regions(), &io::has_out_of_plane_rest<dim>);
    surface_.stress.resize(stress_entries<dim>.size() + (has_rest_ ? 1 : 0));
    at_nodes_ = form.space().basis().tabulate(space_.basis().node_points());
    values_.resize(at_nodes_.n_points);
    for (int local = 0; local < (dim == 2 ? 1 : dim + 1); ++local)
      lattices_.push_back(face_lattice<dim>(space_.basis(), local));
  }

  void add(const Face& face)
  {
    const mesh::CellMap<dim> map = mesh::cell_map(space_.mesh(), face.cell);
    stress_.at_nodes(face.cell, values_);
    const std::vector<double> hoop = stress_.hoop_at_nodes(face.cell, space_.basis().n_nodes());
    for (const int node : lattices_[face.local])
    {
      Index& vertex = vertex_of_node_[space_.cell_nodes(face.cell)[node]];
      if (vertex < 0) vertex = add_vertex(face.cell, node, map);
      surface_.faces.push_back(vertex);
      const std::array<double, 6> sigma = io::symmetric_part<dim>(values_[node], 0.0);
      for (std::size_t i = 0; i < stress_entries<dim>.size(); ++i)
        surface_.stress[i].push_back(sigma[stress_entries<dim>[i]]);
      if (has_rest_)
        surface_.stress.back().push_back(
            hoop[node] + io::out_of_plane_rest(form_.problem(), space_.mesh().region(face.cell),
                                               map(space_.basis().node_point(node))));
    }
    surface_.cells.push_back(face.cell);
    surface_.bodies.push_back(body_of_[face.cell]);
    if constexpr (dim == 3) surface_.facets.push_back(face.facet);
  }

  [[nodiscard]] Surface take() && { return std::move(surface_); }

 private:
  Index add_vertex(Index cell, int node, const mesh::CellMap<dim>& map)
  {
    const Point<dim> x = map(space_.basis().node_point(node));
    const Point<dim> u = fem::value_at<dim>(form_.space().cell_nodes(cell), u_, at_nodes_.values_at(node));
    surface_.points.insert(surface_.points.end(), x.begin(), x.end());
    surface_.displacement.insert(surface_.displacement.end(), u.begin(), u.end());
    return static_cast<Index>(surface_.points.size() / dim) - 1;
  }

  const contact::NitscheForm<dim>& form_;
  std::span<const double> u_;
  fem::LagrangeSpace<dim> space_;  ///< of degree k: its nodes are the vertices of the lattices
  io::TensorField<dim> stress_;
  fem::Tabulation<dim> at_nodes_;    ///< the basis of u at these nodes
  std::vector<Tensor<dim>> values_;  ///< the stress at the nodes of a cell
  bool has_rest_ = false;            ///< out_of_plane_rest() or the hoop part is not 0
  std::vector<std::vector<int>> lattices_;
  std::vector<int> body_of_;  ///< by cells
  std::vector<Index> vertex_of_node_;
  Surface surface_;
};

/// Replaces the values at the lattice points by their mean on each face.
void average_stress(Surface& surface)
{
  const std::size_t n = surface.n_face_points();
  for (std::vector<double>& component : surface.stress)
  {
    for (std::size_t face = 0; face < surface.n_faces(); ++face)
    {
      const auto first = component.begin() + static_cast<std::ptrdiff_t>(face * n);
      component[face] = std::reduce(first, first + static_cast<std::ptrdiff_t>(n)) / static_cast<double>(n);
    }
    component.resize(surface.n_faces());
  }
}

SurfaceContact sample_contact(const contact::NitscheForm<3>& form, std::span<const double> u, int k)
{
  SurfaceContact contact;
  const std::span<const contact::ContactSegment<3>> segments = obstacle_segments(form);
  const std::size_t n = lattice_points(k, false).size();
  const std::size_t n_middles = triangle_middles(k, false).size();
  contact.resize(segments.size() * n, segments.size() * n_middles);
  for (const bool swapped : {false, true})
  {
    // Facets with the same orientation share their tables; the values are put in their places afterwards.
    const contact::SegmentTables<3> at_points(form.space().basis(), segments, lattice_points(k, swapped));
    const contact::SegmentTables<3> at_middles(form.space().basis(), segments, triangle_middles(k, swapped));
    for (std::size_t segment = 0; segment < segments.size(); ++segment)
    {
      if (turns_the_other_way(segments[segment].slave.facet.local) != swapped) continue;
      std::size_t i = segment * n;
      for (const contact::ContactState<3>& state : form.contact_states(u, segment, at_points[segment]))
        contact.set_point(i++, state);
      i = segment * n_middles;
      for (const contact::ContactState<3>& state : form.contact_states(u, segment, at_middles[segment]))
        contact.status[i++] = static_cast<Index>(state.status);
    }
  }
  return contact;
}

}  // namespace

void SurfaceContact::resize(std::size_t n_points, std::size_t n_triangles)
{
  for (const auto column : value_columns) (this->*column).resize(n_points);
  point_status.resize(n_points);
  status.resize(n_triangles);
}

void SurfaceContact::set_point(std::size_t i, const contact::ContactState<3>& state)
{
  pressure[i] = state.pressure;
  friction[i] = (state.traction + state.pressure * state.normal).norm();
  limit[i] = state.limit;
  gap[i] = state.gap;
  slip[i] = state.slip.norm();
  point_status[i] = static_cast<Index>(state.status);
}

int subdivision(std::size_t n_faces, int degree, std::size_t max_triangles)
{
  int k = degree;
  while (k > 1 && n_faces * k * k > max_triangles) --k;
  return k;
}

std::vector<Point<2>> lattice_points(int k, bool swapped)
{
  std::vector<Point<2>> points;
  for (int j = 0; j <= k; ++j)
    for (int i = 0; i + j <= k; ++i)
    {
      const Point<2> s(static_cast<double>(i) / k, static_cast<double>(j) / k);
      points.push_back(swapped ? Point<2>(s[1], s[0]) : s);
    }
  return points;
}

std::vector<Point<2>> triangle_middles(int k, bool swapped)
{
  std::vector<Point<2>> middles;
  const auto add = [&](double i, double j)
  { middles.push_back(swapped ? Point<2>(j / k, i / k) : Point<2>(i / k, j / k)); };
  for (int j = 0; j < k; ++j)
    for (int i = 0; i + j < k; ++i)
    {
      add(i + 1.0 / 3.0, j + 1.0 / 3.0);
      if (i + j + 1 < k) add(i + 2.0 / 3.0, j + 2.0 / 3.0);
    }
  return middles;
}

template <int dim>
Surface sample_surface(const contact::NitscheForm<dim>& form, std::span<const double> u,
                       const StressAt<dim>& stress, const PageLimits& limits)
{
  const std::vector<Face> faces = all_faces(form);
  const int k = subdivision(faces.size(), shown_degree(form, limits), limits.subdivided);
  SurfaceSampler<dim> sampler(form, u, stress, k);
  for (const Face& face : faces) sampler.add(face);
  Surface surface = std::move(sampler).take();
  if constexpr (dim == 3) surface.contact = sample_contact(form, u, k);
  if (surface.n_triangles() > limits.stresses) average_stress(surface);
  if (surface.n_triangles() > limits.triangles) merge_details(surface, dim, limits.triangles);
  return surface;
}

template <int dim>
Surface sample_surface(const contact::NitscheForm<dim>& form, std::span<const double> u,
                       const certify::Stress<dim>& stress, const PageLimits& limits)
{
  const StressAt<dim> at = [&](const fem::LagrangeSpace<dim>& space)
  {
    return form.problem().is_axisymmetric() ? io::stress_field(form.problem(), space, u)
                                            : io::equilibrated_stress_field(space, stress);
  };
  return sample_surface<dim>(form, u, at, limits);
}

template <int dim>
std::size_t n_triangles(const contact::NitscheForm<dim>& form, const PageLimits& limits)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const std::size_t n_faces = dim == 2 ? mesh.n_cells() : mesh.boundary().size();
  const int k = subdivision(n_faces, shown_degree(form, limits), limits.subdivided);
  return std::min(n_faces * k * k, limits.triangles);
}

template std::size_t n_triangles(const contact::NitscheForm<2>&, const PageLimits&);
template std::size_t n_triangles(const contact::NitscheForm<3>&, const PageLimits&);
template Surface sample_surface(const contact::NitscheForm<2>&, std::span<const double>, const StressAt<2>&,
                                const PageLimits&);
template Surface sample_surface(const contact::NitscheForm<3>&, std::span<const double>, const StressAt<3>&,
                                const PageLimits&);
template Surface sample_surface(const contact::NitscheForm<2>&, std::span<const double>,
                                const certify::Stress<2>&, const PageLimits&);
template Surface sample_surface(const contact::NitscheForm<3>&, std::span<const double>,
                                const certify::Stress<3>&, const PageLimits&);

}  // namespace tribound::app
