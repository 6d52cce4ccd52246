#include "tribound/certify/bound/friedrichs_potential.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "tribound/algebra/petsc.h"
#include "tribound/base/norm.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

namespace
{

/// x with A x = b up to `tolerance` times the norm of b, by conjugate gradients from the given x. Residuals
/// are measured with the diagonal of A.
std::vector<double> conjugate_gradients(const algebra::SparseMatrix& a, std::span<const double> b,
                                        std::vector<double> x, double tolerance)
{
  constexpr int max_steps = 5000;
  const std::size_t n = b.size();
  const std::vector<double> diagonal = a.diagonal();
  std::vector<double> r = a.multiply(x);
  std::vector<double> z(n);
  std::vector<double> p(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) r[i] = b[i] - r[i];
  for (std::size_t i = 0; i < n; ++i) z[i] = b[i] / diagonal[i];
  const double enough = tolerance * tolerance * inner_product(b, z);
  double rz = 0;
  for (int step = 0; step < max_steps; ++step)
  {
    for (std::size_t i = 0; i < n; ++i) z[i] = r[i] / diagonal[i];
    const double before = rz;
    rz = inner_product(r, z);
    if (!(rz > enough)) break;
    for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + (step > 0 ? rz / before : 0) * p[i];
    const std::vector<double> ap = a.multiply(p);
    const double length = rz / inner_product(p, ap);
    for (std::size_t i = 0; i < n; ++i)
    {
      x[i] += length * p[i];
      r[i] -= length * ap[i];
    }
  }
  return x;
}

/// A_ij = (grad lambda_i, grad lambda_j) + sum_{F in C} (|F|/h_F) mean_F(lambda_i) mean_F(lambda_j), b_i =
/// (1, lambda_i), for the vertices off the fixed facets.
template <int dim>
struct VertexSystem
{
  VertexSystem(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh, std::span<const char> fixed)
      : number(mesh.vertices().size(), 0)
  {
    const auto& cell_facets = mesh.topology().cell_facets;
    for (const mesh::BoundaryFacet& facet : mesh.boundary())
      if (fixed[cell_facets[facet.cell][facet.local]])
        for (const Index v : mesh::facet_vertices(mesh.cell(facet.cell), facet.local)) number[v] = -1;
    Index n = 0;
    for (Index& i : number)
      if (i == 0) i = n++;
    b.assign(n, 0.0);
    a.reserve((dim + 1) * (dim + 1) * static_cast<std::size_t>(mesh.n_cells()));
    for (Index c = 0; c < mesh.n_cells(); ++c) add_cell(mesh, c);
    for (const mesh::BoundaryFacet& facet : mesh.boundary())
      if (problem.boundary(facet.tag).is_in_norm() && !fixed[cell_facets[facet.cell][facet.local]])
        add_contact(mesh, facet);
  }

  void add(Index v, Index w, double value)
  {
    if (number[v] >= 0 && number[w] >= 0) a.add(number[v], number[w], value);
  }

  void add_cell(const mesh::Mesh<dim>& mesh, Index c)
  {
    const mesh::CellMap<dim> map = mesh::cell_map(mesh, c);
    const std::array<Point<dim>, dim + 1> gradients = map.barycentric_gradients();
    for (int i = 0; i <= dim; ++i)
    {
      const Index v = mesh.cell(c)[i];
      if (number[v] >= 0) b[number[v]] += map.measure() / (dim + 1);
      for (int j = 0; j <= dim; ++j) add(v, mesh.cell(c)[j], map.measure() * gradients[i].dot(gradients[j]));
    }
  }

  void add_contact(const mesh::Mesh<dim>& mesh, const mesh::BoundaryFacet& facet)
  {
    const mesh::FacetGeometry<dim> geometry = mesh::facet_geometry(mesh, facet.cell, facet.local);
    const auto vertices = mesh::facet_vertices(mesh.cell(facet.cell), facet.local);
    for (const Index v : vertices)
      for (const Index w : vertices) add(v, w, geometry.measure / geometry.diameter / (dim * dim));
  }

  std::vector<Index> number;  ///< of each vertex, -1 where fixed
  algebra::Triplets a;
  std::vector<double> b;
};

}  // namespace

template <int dim>
std::vector<double> potential_means(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                    std::span<const char> fixed, Pencil pencil)
{
  constexpr double tolerance = 1e-2;  // costs sharpness alone: C_F of block3d grew by 0.7 %
  std::vector<double> start(pencil.n, 0.0);
  VertexSystem<dim> coarse(problem, mesh, fixed);
  if (!coarse.b.empty())
  {
    const auto n = static_cast<Index>(coarse.b.size());
    const std::vector<double> phi =
        conjugate_gradients({n, 1, std::move(coarse.a)}, coarse.b, std::vector<double>(n, 0.0), tolerance);
    for (Index c = 0; c < mesh.n_cells(); ++c)
      for (int i = 0; i <= dim; ++i)
        if (const Index f = pencil.number[mesh.topology().cell_facets[c][i]]; f >= 0)
        {
          start[f] = 0;
          for (const Index v : mesh::facet_vertices(mesh.cell(c), i))
            if (coarse.number[v] >= 0) start[f] += phi[coarse.number[v]] / dim;
        }
  }
  std::vector<double> b(pencil.n, 0.0);
  for (std::size_t k = 0; k < pencil.m.size(); ++k) b[pencil.a.rows[k]] += pencil.m[k];
  const std::vector<double> x =
      conjugate_gradients({pencil.n, 1, std::move(pencil.a)}, b, std::move(start), tolerance);
  std::vector<double> means(pencil.number.size(), 0.0);
  for (std::size_t f = 0; f < means.size(); ++f)
    if (pencil.number[f] >= 0) means[f] = std::max(0.0, x[pencil.number[f]]);
  return means;
}

template std::vector<double> potential_means(const problem::Problem<2>&, const mesh::Mesh<2>&,
                                             std::span<const char>, Pencil);
template std::vector<double> potential_means(const problem::Problem<3>&, const mesh::Mesh<3>&,
                                             std::span<const char>, Pencil);

}  // namespace tribound::certify
