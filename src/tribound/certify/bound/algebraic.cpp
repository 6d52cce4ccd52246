#include "tribound/certify/bound/algebraic.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

#include "tribound/base/dense_factors.h"
#include "tribound/base/parallel.h"
#include "tribound/contact/nitsche/residual.h"
#include "tribound/mesh/geometry.h"
#include "tribound/problem/weights.h"

namespace tribound::certify
{

template <int dim>
AlgebraicResidual<dim>::AlgebraicResidual(const contact::NitscheForm<dim>& form)
    : form_(form), fixed_begin_(form.space().mesh().n_vertices() + 1, 0)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const auto for_each_fixed = [&](const auto& take)
  {
    for (const mesh::BoundaryFacet& facet : mesh.boundary())
      if (form.problem().boundary(facet.tag).fixes_any())
        for (const Index v : mesh::facet_vertices(mesh.cell(facet.cell), facet.local)) take(v, facet);
  };
  for_each_fixed([&](Index v, const mesh::BoundaryFacet&) { ++fixed_begin_[v + 1]; });
  std::partial_sum(fixed_begin_.begin(), fixed_begin_.end(), fixed_begin_.begin());
  fixed_.resize(fixed_begin_.back());
  std::vector<Index> next(fixed_begin_.begin(), fixed_begin_.end() - 1);
  for_each_fixed(
      [&](Index v, const mesh::BoundaryFacet& facet)
      {
        FixedFacet<dim>& fixed = fixed_[next[v]++];
        fixed.vertices =
            mesh::points_of(mesh.vertices(), mesh::facet_vertices(mesh.cell(facet.cell), facet.local));
        for (int c = 0; c < dim; ++c) fixed.fixed[c] = form.problem().boundary(facet.tag).fixes(c);
      });
}

template <int dim>
std::vector<double> AlgebraicResidual<dim>::residual(std::span<const double> u,
                                                     std::span<const Point<dim>> t) const
{
  return contact::residual<dim>(form_, u, t);
}

template <int dim>
auto AlgebraicResidual<dim>::forces_at_vertices(std::span<const double> residual) const -> std::vector<Forces>
{
  const fem::LagrangeSpace<dim>& space = form_.space();
  const mesh::Mesh<dim>& mesh = space.mesh();
  std::vector<Forces> forces(mesh.n_vertices());
  std::vector<char> visited(space.n_nodes(), 0);
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    const auto vertices = mesh::points_of(mesh.vertices(), mesh.cell(c));
    const std::span<const Index> nodes = space.cell_nodes(c);
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      if (std::exchange(visited[nodes[i]], 1) != 0) continue;
      Point<dim> r;
      Point<dim> x = Point<dim>::Zero();
      for (int k = 0; k < dim; ++k)
      {
        const std::size_t dof = static_cast<std::size_t>(dim) * nodes[i] + k;
        r[k] = form_.constraints().fixed[dof] ? 0 : residual[dof];
      }
      const std::array<int, dim + 1>& node = space.basis().node(static_cast<int>(i));
      for (int v = 0; v <= dim; ++v) x += node[v] * vertices[v] / space.degree();
      for (int v = 0; v <= dim; ++v)
      {
        const Point<dim> share = node[v] * r / space.degree();
        Forces& at_vertex = forces[mesh.cell(c)[v]];
        at_vertex.sum += share;
        at_vertex.moment += share * (x - vertices[v]).transpose();
      }
    }
  }
  return forces;
}

template <int dim>
RigidField<dim> AlgebraicResidual<dim>::rigid_force(Index vertex, const Forces& forces, bool constant) const
{
  const mesh::Mesh<dim>& mesh = form_.space().mesh();
  const Point<dim>& a = mesh.vertex(vertex);
  double size = 0;
  double volume = 0;
  Point<dim> position = Point<dim>::Zero();             // (x - a, 1) on the patch
  Tensor<dim> position_position = Tensor<dim>::Zero();  // (x - a, x - a)
  const std::span<const Index> begin = mesh.topology().vertex_cells_begin;
  for (Index k = begin[vertex]; k < begin[vertex + 1]; ++k)
  {
    const Index cell = mesh.topology().vertex_cells[k];
    const mesh::CellMap<dim> map = mesh::cell_map(mesh, cell);
    const auto points = mesh::points_of(mesh.vertices(), mesh.cell(cell));
    const double measure = map.measure();
    const auto local = std::ranges::find(mesh.cell(cell), vertex) - mesh.cell(cell).begin();
    const double slope = map.barycentric_gradients()[local].norm();
    size = std::max(size, 1 / slope);  // the size that the patches use, so that both admit the same motions
    Point<dim> sum = Point<dim>::Zero();
    Tensor<dim> squares = Tensor<dim>::Zero();
    for (const Point<dim>& x : points)
    {
      sum += x - a;
      squares += (x - a) * (x - a).transpose();
    }
    volume += measure;
    position += measure / (dim + 1) * sum;
    position_position += measure / ((dim + 1) * (dim + 2)) * (squares + sum * sum.transpose());
  }

  const RigidMotions<dim> motions(
      a, size,
      std::span(fixed_).subspan(fixed_begin_[vertex], fixed_begin_[vertex + 1] - fixed_begin_[vertex]));
  const int n = constant ? motions.n_translations() : motions.size();
  using Gram = Eigen::Matrix<double, RigidMotions<dim>::n_all, RigidMotions<dim>::n_all>;
  Gram gram = Gram::Identity();
  Eigen::Matrix<double, RigidMotions<dim>::n_all, 1> work =
      Eigen::Matrix<double, RigidMotions<dim>::n_all, 1>::Zero();
  for (int i = 0; i < n; ++i)
  {
    const auto& [t, g] = motions[i];
    work[i] = t.dot(forces.sum) + g.cwiseProduct(forces.moment).sum();
    for (int j = 0; j < n; ++j)
      gram(i, j) = volume * t.dot(motions[j].translation) + t.dot(motions[j].gradient * position) +
                   motions[j].translation.dot(g * position) +
                   (g * position_position).cwiseProduct(motions[j].gradient).sum();
  }
  work = CholeskyFactors(gram).solve(work);
  RigidField<dim> rho{Point<dim>::Zero(), Tensor<dim>::Zero()};
  for (int i = 0; i < n; ++i)
  {
    rho.translation += work[i] * motions[i].translation;
    rho.gradient += work[i] * motions[i].gradient;
  }
  return rho;
}

template <int dim>
RigidField<dim> AlgebraicResidual<dim>::axial_force(Index vertex, const Forces& forces) const
{
  const mesh::Mesh<dim>& mesh = form_.space().mesh();
  RigidField<dim> rho{Point<dim>::Zero(), Tensor<dim>::Zero()};
  for (Index k = fixed_begin_[vertex]; k < fixed_begin_[vertex + 1]; ++k)
    if (fixed_[k].fixed[1]) return rho;
  double volume = 0;
  const std::span<const Index> begin = mesh.topology().vertex_cells_begin;
  for (Index k = begin[vertex]; k < begin[vertex + 1]; ++k)
  {
    const Index cell = mesh.topology().vertex_cells[k];
    volume += mesh::cell_map(mesh, cell).measure() *
              mean_weight<dim>(form_.problem(), mesh::points_of(mesh.vertices(), mesh.cell(cell)));
  }
  rho.translation[1] = forces.sum[1] / volume;
  return rho;
}

template <int dim>
AffineFields<dim> AlgebraicResidual<dim>::body_force(std::span<const double> residual,
                                                     PatchStress patches) const
{
  const bool constant = patches == PatchStress::rows || form_.space().degree() == 1;
  const mesh::Mesh<dim>& mesh = form_.space().mesh();
  std::vector<double> all(residual.begin(), residual.end());
  form_.space().update(std::span(all));
  const std::vector<Forces> forces = forces_at_vertices(all);
  std::vector<RigidField<dim>> at_vertex(mesh.n_vertices());
  parallel_for(at_vertex.size(),
               [&](std::size_t v)
               {
                 const auto vertex = static_cast<Index>(v);
                 if (!mesh.has_patch(vertex)) return;
                 at_vertex[v] = form_.problem().is_axisymmetric() ? axial_force(vertex, forces[v])
                                                                  : rigid_force(vertex, forces[v], constant);
               });
  AffineFields<dim> rho(mesh.n_owned_cells());
  parallel_for(rho.size(),
               [&](std::size_t c)
               {
                 const mesh::Cell<dim>& cell = mesh.cell(static_cast<Index>(c));
                 for (int b = 0; b <= dim; ++b)
                 {
                   rho[c][b] = Point<dim>::Zero();
                   for (const Index a : cell)
                     rho[c][b] += at_vertex[a].translation +
                                  at_vertex[a].gradient * (mesh.vertex(cell[b]) - mesh.vertex(a));
                 }
               });
  return rho;
}

template class AlgebraicResidual<2>;
template class AlgebraicResidual<3>;

}  // namespace tribound::certify
