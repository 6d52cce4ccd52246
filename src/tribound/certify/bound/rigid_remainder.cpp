#include "tribound/certify/bound/rigid_remainder.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "tribound/base/dense_factors.h"
#include "tribound/certify/bound/checked_stress.h"
#include "tribound/certify/bound/constants.h"
#include "tribound/fem/evaluation.h"
#include "tribound/mesh/geometry.h"
#include "tribound/problem/weights.h"

namespace tribound::certify
{

namespace
{

/// The forces on the parts in chi_i: given, less those of the stress; the sum of the absolute values of
/// what they consist of; and (chi_i, chi_j)_S by columns. On a meridian the stress is tau = r sigma_h.
template <int dim>
struct PartForces
{
  Eigen::VectorXd missing;
  double absolute = 0;
  Eigen::MatrixXd gram;

  PartForces(const contact::NitscheForm<dim>& form, const Stress<dim>& stress)
  {
    const contact::RigidParts<dim>& parts = form.rigid_parts();
    const mesh::Mesh<dim>& mesh = form.space().mesh();
    const auto n = static_cast<Eigen::Index>(parts.size());
    const fem::Quadrature<dim - 1> rule = fem::quadrature<dim - 1>(stress.degree + 1);
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(n + 1 + n * n);  // work, absolute values, gram
    Eigen::Map<Eigen::MatrixXd> products(sums.data() + n + 1, n, n);
    for (const mesh::BoundaryFacet& facet : mesh.owned_boundary())
    {
      const auto* const part = parts.on(facet.tag);
      if (part == nullptr) continue;
      const auto first = static_cast<Eigen::Index>(part->first);
      const Eigen::Index m = part->motions.cols();
      const Point<dim> normal = mesh::facet_geometry(mesh, facet.cell, facet.local).normal;
      const CheckedStress<dim> sigma(mesh, stress, facet.cell);
      for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, rule))
      {
        const Eigen::MatrixXd chi = part->at(x);
        const Eigen::VectorXd work = dx * (chi.transpose() * sigma.normal_trace_at(x, normal));
        sums.segment(first, m) += work;
        sums[n] += work.cwiseAbs().sum();
        products.block(first, first, m, m) += form.problem().weight(x) * dx * chi.transpose() * chi;
      }
    }
    mesh.ranks().sum(std::span(sums.data(), sums.size()));
    const Eigen::Map<const Eigen::VectorXd> given(parts.load().data(), n);
    missing = given - sums.head(n);
    absolute = sums[n] + given.cwiseAbs().sum();
    gram = products;
  }
};

/// The norms of tau and div tau on a cell, tau = sum_a t(a) (a - o)^T lambda_a / H with the vertices a of the
/// facet, the vertex o opposite to it and its distance H from the facet: tau n = t there, and 0 on others.
template <int dim>
std::array<double, 2> lifted(const mesh::Mesh<dim>& mesh, const mesh::BoundaryFacet& facet,
                             const std::array<Point<dim>, dim>& t)
{
  const Point<dim>& o = mesh.vertex(mesh.cell(facet.cell)[facet.local]);
  const auto vertices = mesh::facet_vertices(mesh.cell(facet.cell), facet.local);
  const Point<dim> normal = mesh::facet_geometry(mesh, facet.cell, facet.local).normal;
  const double height = normal.dot(mesh.vertex(vertices[0]) - o);
  const double measure = mesh::cell_map(mesh, facet.cell).measure();
  double square = 0;
  Point<dim> divergence = Point<dim>::Zero();
  for (int a = 0; a < dim; ++a)
  {
    divergence += t[a] / height;
    for (int b = 0; b < dim; ++b)
      square += (a == b ? 2 : 1) * t[a].dot(t[b]) *
                (mesh.vertex(vertices[a]) - o).dot(mesh.vertex(vertices[b]) - o);
  }
  square *= measure / ((dim + 1) * (dim + 2) * height * height);
  return {std::sqrt(std::max(0.0, square)), std::sqrt(measure) * divergence.norm()};
}

/// On a meridian, where t is a constant along z: with the means m of v_z, int_F r t v_z = t |F|_r m_F is at
/// most t |F|_r (c_{T,F} ||grad v||_r + |T|_r^{-1/2} ||v||_r) on the cell T; these two factors.
std::array<double, 2> by_means(const contact::NitscheForm<2>& form, const mesh::BoundaryFacet& facet,
                               const Point<2>& t)
{
  const mesh::Mesh<2>& mesh = form.space().mesh();
  const auto vertices = mesh::facet_vertices(mesh.cell(facet.cell), facet.local);
  const double length = mesh::facet_geometry(mesh, facet.cell, facet.local).measure;
  const double area = mesh::cell_map(mesh, facet.cell).measure();
  const double on_facet =
      length * problem::mean_weight<2>(form.problem(), mesh::points_of(mesh.vertices(), vertices));
  const double in_cell =
      area * problem::mean_weight<2>(form.problem(), mesh::points_of(mesh.vertices(), mesh.cell(facet.cell)));
  const double trace = meridian_trace_constant(mesh::cell_diameter(mesh, facet.cell), length, area);
  return {t.norm() * std::sqrt(on_facet) * trace, t.norm() * on_facet / std::sqrt(in_cell)};
}

}  // namespace

template <int dim>
double rigid_remainder(const contact::NitscheForm<dim>& form, const Stress<dim>& stress, double friedrichs)
{
  const contact::RigidParts<dim>& parts = form.rigid_parts();
  if (parts.size() == 0) return 0;
  constexpr double rounding = 1e-11;
  const PartForces<dim> forces(form, stress);
  if (!std::isfinite(friedrichs))
    return forces.missing.cwiseAbs().sum() <= rounding * forces.absolute
               ? 0
               : std::numeric_limits<double>::infinity();
  const Eigen::VectorXd y = solve_regular(forces.gram, forces.missing);
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  std::map<Index, std::array<double, 2>> cells;  // a cell may have several facets
  for (const mesh::BoundaryFacet& facet : mesh.owned_boundary())
  {
    const auto* const part = parts.on(facet.tag);
    if (part == nullptr) continue;
    const auto of_part = y.segment(static_cast<Eigen::Index>(part->first), part->motions.cols());
    std::array<Point<dim>, dim> t;
    const auto vertices = mesh::facet_vertices(mesh.cell(facet.cell), facet.local);
    for (int a = 0; a < dim; ++a) t[a] = part->at(mesh.vertex(vertices[a])) * of_part;
    std::array<double, 2> norms{};
    if constexpr (dim == 2)
      norms = form.problem().is_axisymmetric() ? by_means(form, facet, t[0]) : lifted<dim>(mesh, facet, t);
    else
      norms = lifted<dim>(mesh, facet, t);
    for (std::size_t i = 0; i < norms.size(); ++i) cells[facet.cell][i] += norms[i];
  }
  std::array<double, 2> squares{};
  for (const auto& [cell, norms] : cells)
    for (std::size_t i = 0; i < norms.size(); ++i) squares[i] += norms[i] * norms[i];
  mesh.ranks().sum(std::span(squares));
  return std::sqrt(squares[0]) + friedrichs * std::sqrt(squares[1]);
}

template <int dim>
double rigid_defect(const contact::NitscheForm<dim>& form, const Stress<dim>& stress)
{
  if (form.rigid_parts().size() == 0) return 0;
  const PartForces<dim> forces(form, stress);
  return forces.absolute > 0 ? forces.missing.cwiseAbs().sum() / forces.absolute : 0;
}

template double rigid_remainder(const contact::NitscheForm<2>&, const Stress<2>&, double);
template double rigid_remainder(const contact::NitscheForm<3>&, const Stress<3>&, double);
template double rigid_defect(const contact::NitscheForm<2>&, const Stress<2>&);
template double rigid_defect(const contact::NitscheForm<3>&, const Stress<3>&);

}  // namespace tribound::certify
