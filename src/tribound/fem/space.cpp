#include "tribound/fem/space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tribound/fem/polynomials.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/partition.h"

namespace tribound::fem
{

namespace
{

/// Where a reference node sits: inside which vertex, edge, facet (3D) or the cell.
enum class Entity
{
  vertex,
  edge,
  facet,
  cell
};

template <int dim>
struct NodePlace
{
  Entity entity = Entity::cell;
  int number = 0;                                ///< local vertex, edge or facet, or rank inside the cell
  int n_vertices = 0;                            ///< of the entity
  std::array<std::pair<int, int>, dim> weights;  ///< local vertex and weight, for edges and facets
};

template <int dim>
int local_edge(int a, int b)
{
  const auto& edges = mesh::local_edges<dim>;
  return static_cast<int>(std::ranges::find(edges, std::array{a, b}) - edges.begin());
}

/// Places of all reference nodes.
template <int dim>
std::vector<NodePlace<dim>> node_places(const LagrangeBasis<dim>& basis)
{
  std::vector<NodePlace<dim>> places;
  int n_interior = 0;
  for (int i = 0; i < basis.n_nodes(); ++i)
  {
    const auto& node = basis.node(i);
    NodePlace<dim> place;
    place.n_vertices = dim + 1 - static_cast<int>(std::ranges::count(node, 0));
    if (place.n_vertices <= dim)
      for (int v = 0, n = 0; v <= dim; ++v)
        if (node[v] > 0) place.weights[n++] = {v, node[v]};
    if (place.n_vertices == dim + 1)
      place.number = n_interior++;
    else if (place.n_vertices == 1)
      place = {Entity::vertex, place.weights[0].first, 1, place.weights};
    else if (place.n_vertices == 2)
      place = {Entity::edge, local_edge<dim>(place.weights[0].first, place.weights[1].first), 2,
               place.weights};
    else
      place = {Entity::facet, static_cast<int>(std::ranges::find(node, 0) - node.begin()), 3, place.weights};
    places.push_back(place);
  }
  return places;
}

/// Rank of a node among those inside its edge or facet, the same from every cell: weights are taken in
/// ascending order of the global vertex numbers.
template <int dim>
int rank_in_entity(const NodePlace<dim>& place, const mesh::Cell<dim>& cell, int p)
{
  auto weights = place.weights;
  const auto by_vertex = [&](const auto& w) { return cell[w.first]; };
  std::ranges::sort(weights.begin(), weights.begin() + place.n_vertices, {}, by_vertex);
  if (place.n_vertices == 2) return weights[1].second - 1;
  if constexpr (dim == 3)
  {
    const int i = weights[1].second - 1;
    const int j = weights[2].second - 1;
    return j * (p - 2) - j * (j - 1) / 2 + i;
  }
  return 0;
}

}  // namespace

template <int dim>
LagrangeSpace<dim>::LagrangeSpace(const mesh::Mesh<dim>& mesh, int degree) : mesh_(&mesh), basis_(degree)
{
  const int p = degree;
  const mesh::Topology<dim>& topology = mesh.topology();
  const int per_edge = p - 1;
  const int per_facet = dim == 3 ? (p - 1) * (p - 2) / 2 : 0;
  const int per_cell = polynomial_dimension(dim, p - dim - 1);
  const auto edge_base = mesh.n_vertices();
  const auto facet_base = edge_base + per_edge * static_cast<Index>(topology.edges.size());
  const auto cell_base = facet_base + per_facet * static_cast<Index>(topology.facets.size());
  n_nodes_ = cell_base + per_cell * mesh.n_cells();

  const std::vector<NodePlace<dim>> places = node_places(basis_);
  cell_nodes_.reserve(static_cast<std::size_t>(mesh.n_cells()) * places.size());
  for (Index c = 0; c < mesh.n_cells(); ++c)
    for (const NodePlace<dim>& place : places) switch (place.entity)
      {
        case Entity::vertex:
          cell_nodes_.push_back(mesh.cell(c)[place.number]);
          break;
        case Entity::edge:
          cell_nodes_.push_back(edge_base + per_edge * topology.cell_edges[c][place.number] +
                                rank_in_entity(place, mesh.cell(c), p));
          break;
        case Entity::facet:
          cell_nodes_.push_back(facet_base + per_facet * topology.cell_facets[c][place.number] +
                                rank_in_entity(place, mesh.cell(c), p));
          break;
        case Entity::cell:
          cell_nodes_.push_back(cell_base + per_cell * c + place.number);
          break;
      }
  numbers_ = number_nodes<dim>(mesh, n_nodes_, cell_nodes_, basis_.n_nodes());
}

template <int dim>
double LagrangeSpace<dim>::dot(std::span<const double> a, std::span<const double> b) const
{
  double sum = 0;
  for (Index k = 0; k < n_owned_nodes(); ++k)
    for (Index i = dim * owned_node(k); i < dim * (owned_node(k) + 1); ++i) sum += a[i] * b[i];
  return mesh_->ranks().sum(sum);
}

template <int dim>
double LagrangeSpace<dim>::norm(std::span<const double> values) const
{
  return std::sqrt(dot(values, values));
}

template <int dim>
std::vector<Point<dim>> LagrangeSpace<dim>::node_points() const
{
  std::vector<Point<dim>> points(n_nodes_);
  const std::vector<Point<dim>> reference = basis_.node_points();
  for (Index c = 0; c < mesh_->n_cells(); ++c)
  {
    const mesh::CellMap<dim> map = mesh::cell_map(*mesh_, c);
    const std::span<const Index> nodes = cell_nodes(c);
    for (std::size_t i = 0; i < nodes.size(); ++i) points[nodes[i]] = map(reference[i]);
  }
  for (Index v = 0; v < mesh_->n_vertices(); ++v) points[v] = mesh_->vertex(v);  // free of round-off
  return points;
}

template <int dim>
std::int64_t n_free_dofs(const LagrangeSpace<dim>& space, const Constraints& constraints)
{
  std::int64_t n = 0;
  for (Index k = 0; k < space.n_owned_nodes(); ++k)
    for (int a = 0; a < dim; ++a) n += constraints.fixed[dim * space.owned_node(k) + a] == 0 ? 1 : 0;
  return space.mesh().ranks().sum(n);
}

namespace
{

/// Name of the first boundary that fixes component a at the node, empty if none does.
template <int dim>
std::string fixing_boundary(const problem::Problem<dim>& problem, const LagrangeSpace<dim>& space, Index node,
                            int a)
{
  for (const mesh::BoundaryFacet& facet : space.mesh().boundary())
  {
    const problem::BoundaryCondition<dim>& boundary = problem.boundary(facet.tag);
    const std::span<const Index> nodes = space.cell_nodes(facet.cell);
    const auto i = static_cast<int>(std::ranges::find(nodes, node) - nodes.begin());
    if (boundary.fixes(a) && i < space.basis().n_nodes() && space.basis().node(i)[facet.local] == 0)
      return boundary.name;
  }
  return {};
}

}  // namespace

namespace
{

/// Fixes u_r = 0 at the nodes whose vertices all lie on the axis, which is no surface of the body.
template <int dim>
void fix_axis(const problem::Problem<dim>& problem, const LagrangeSpace<dim>& space, Constraints& constraints)
{
  const mesh::Mesh<dim>& mesh = space.mesh();
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    const problem::BoundaryCondition<dim>& boundary = problem.boundary(facet.tag);
    if (!boundary.is_in_norm() && !boundary.is_loaded() && !boundary.fixes(1)) continue;
    if (std::ranges::all_of(mesh::facet_vertices(mesh.cell(facet.cell), facet.local),
                            [&](Index v) { return mesh.vertex(v)[0] == 0; }))
      throw InputError(boundary.where, fmt::format("boundary \"{}\" lies on the axis", boundary.name),
                       "no contact, spring or load where x = 0, and at most displacement = [0, \"free\"]");
  }
  for (Index c = 0; c < mesh.n_cells(); ++c)
    for (int i = 0; i < space.basis().n_nodes(); ++i)
    {
      bool on_axis = true;
      for (int v = 0; v <= dim; ++v)
        on_axis = on_axis && (space.basis().node(i)[v] == 0 || mesh.vertex(mesh.cell(c)[v])[0] == 0);
      if (!on_axis) continue;
      const Index dof = dim * space.cell_nodes(c)[i];
      if (constraints.fixed[dof] && constraints.values[dof] != 0)
        throw InputError(
            problem
                .boundaries()[problem::group_number(fixing_boundary(problem, space, dof / dim, 0),
                                                    mesh.boundary_names(), {}, "boundary")]
                .where,
            fmt::format("prescribes a displacement of {:.9g} away from the axis on the axis",
                        constraints.values[dof]),
            "0 or \"free\" as the first component where x = 0");
      constraints.fixed[dof] = 1;
    }
}

}  // namespace

template <int dim>
Constraints dirichlet(const problem::Problem<dim>& problem, const LagrangeSpace<dim>& space)
{
  const mesh::Mesh<dim>& mesh = space.mesh();
  const LagrangeBasis<dim>& basis = space.basis();
  const double size =
      mesh.partition() ? mesh.partition()->cube.size : mesh::bounding_box(mesh.vertices()).longest_edge();
  const double tolerance = 1e-12 * size;
  Constraints constraints{std::vector<char>(space.n_dofs(), 0), std::vector<double>(space.n_dofs(), 0.0)};

  const auto fix =
      [&](const problem::BoundaryCondition<dim>& boundary, int a, Index node, const Point<dim>& x)
  {
    const Index dof = dim * node + a;
    const double value = boundary.prescribed(a)(x);
    const double known = constraints.values[dof];
    if (constraints.fixed[dof] && std::abs(value - known) > tolerance + 1e-9 * std::abs(known))
      throw InputError(
          boundary.rigid ? boundary.where : boundary.displacement[a]->where(),
          fmt::format("is {:.9g} at the point ({:.9g}), where boundary \"{}\" prescribes {:.9g}", value,
                      fmt::join(x.data(), x.data() + dim, ", "), fixing_boundary(problem, space, node, a),
                      known),
          "let the values agree where the boundaries meet, or leave the component \"free\" on one");
    if (!constraints.fixed[dof]) constraints.values[dof] = value;
    constraints.fixed[dof] = 1;
  };

  const auto fix_on = [&](const mesh::BoundaryFacet& facet)
  {
    const problem::BoundaryCondition<dim>& boundary = problem.boundary(facet.tag);
    if (!boundary.fixes_any()) return;
    const mesh::FacetMap<dim> map = mesh::facet_map(mesh, facet.cell, facet.local);
    const std::span<const Index> nodes = space.cell_nodes(facet.cell);
    for (int i = 0; i < basis.n_nodes(); ++i)
    {
      if (basis.node(i)[facet.local] > 0) continue;  // not on the facet
      const Point<dim> x = nodes[i] < mesh.n_vertices()
                               ? mesh.vertex(nodes[i])  // the same from all facets
                               : map(mesh::cell_to_facet<dim>(facet.local, basis.node_point(i)));
      for (int a = 0; a < dim; ++a)
        if (boundary.fixes(a)) fix(boundary, a, nodes[i], x);
    }
  };
  mesh.ranks().together(
      [&]
      {
        std::ranges::for_each(mesh.boundary(), fix_on);
        if (problem.is_axisymmetric()) fix_axis(problem, space, constraints);
      });
  // A node of a ghost cell may be on Gamma_D through a cell that this rank does not have.
  space.update(std::span(constraints.fixed));
  space.update(std::span(constraints.values));
  return constraints;
}

template class LagrangeSpace<2>;
template class LagrangeSpace<3>;
template std::int64_t n_free_dofs(const LagrangeSpace<2>&, const Constraints&);
template std::int64_t n_free_dofs(const LagrangeSpace<3>&, const Constraints&);
template Constraints dirichlet(const problem::Problem<2>&, const LagrangeSpace<2>&);
template Constraints dirichlet(const problem::Problem<3>&, const LagrangeSpace<3>&);

}  // namespace tribound::fem
