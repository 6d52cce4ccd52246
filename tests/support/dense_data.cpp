#include "support/dense_data.h"

#include <Eigen/LU>

#include "tribound/fem/evaluation.h"
#include "tribound/fem/quadrature.h"

namespace tribound::test
{

namespace
{

template <int dim>
DenseCell<dim> make_cell(const contact::NitscheForm<dim>& form, std::span<const double> u, Index c)
{
  const fem::LagrangeSpace<dim>& space = form.space();
  const mesh::Mesh<dim>& mesh = space.mesh();
  DenseCell<dim> cell;
  cell.vertices = mesh.cell(c);
  std::ranges::sort(cell.vertices);
  cell.origin = mesh.vertex(cell.vertices[0]);
  Tensor<dim> jacobian;
  for (int j = 0; j < dim; ++j) jacobian.col(j) = mesh.vertex(cell.vertices[j + 1]) - cell.origin;
  cell.inverse = jacobian.inverse();
  cell.det = std::abs(jacobian.determinant());
  cell.hat_gradient[0].setZero();
  for (int j = 0; j < dim; ++j)
  {
    cell.hat_gradient[j + 1] = cell.inverse.row(j).transpose();
    cell.hat_gradient[0] -= cell.hat_gradient[j + 1];
  }

  const int p = space.degree();
  const int n = fem::polynomial_dimension(dim, p);
  const fem::Quadrature<dim> rule = fem::quadrature<dim>(fem::data_quadrature_degree(p));
  const fem::Tabulation<dim> table = space.basis().tabulate(rule.points);
  const mesh::CellMap<dim> map = mesh::cell_map(mesh, c);
  std::vector<double> values(n);
  std::vector<Point<dim>> gradients(n);
  cell.f.resize(rule.size());
  form.data().body_force(c, cell.f);
  for (int q = 0; q < rule.size(); ++q)
  {
    const Point<dim> x = map(rule.points[q]);
    cell.x.push_back(x);
    cell.weight.push_back(rule.weights[q] * map.det);
    cell.sigma.push_back(contact::sigma<dim>(
        form.problem().material(mesh.region(c)),
        fem::gradient_at<dim>(space.cell_nodes(c), u, table.gradients_at(q), map.inverse_transpose)));
    fem::orthonormal_gradients<dim>(p, cell.reference(x), values, gradients);
    cell.phi.push_back(cell.basis(p, x));
    auto& dphi = cell.dphi.emplace_back();
    for (const Point<dim>& g : gradients) dphi.push_back(cell.inverse.transpose() * g / std::sqrt(cell.det));
  }
  return cell;
}

/// The points of a rule on local facet `local`; moments of theta do not depend on its numbering.
template <int dim>
std::vector<FacetPoint<dim>> points_on(const mesh::Mesh<dim>& mesh, Index cell, int local, int p,
                                       const fem::Quadrature<dim - 1>& rule)
{
  const mesh::CellMap<dim> map = mesh::cell_map(mesh, cell);
  const double scale = mesh::facet_geometry(mesh, cell, local).measure * (dim - 1);
  std::vector<FacetPoint<dim>> points;
  for (int q = 0; q < rule.size(); ++q)
  {
    Eigen::VectorXd theta(fem::polynomial_dimension(dim - 1, p));
    fem::orthonormal_values<dim - 1>(p, rule.points[q], std::span(theta.data(), theta.size()));
    points.push_back({map(mesh::facet_to_cell<dim>(local, rule.points[q])), rule.weights[q] * scale,
                      theta / std::sqrt(scale)});
  }
  return points;
}

/// T(u) enters t with another rule; t^k - T(u) does not change.
template <int dim>
void coarsen(const contact::NitscheForm<dim>& form, const mesh::BoundaryFacet& boundary,
             std::span<const double> u, int contact, DenseFacet<dim>& facet)
{
  const int p = form.space().degree();
  const fem::Quadrature<dim - 1> wrong = fem::quadrature<dim - 1>(p);
  const contact::SegmentTables<dim> tables(form.space().basis(), form.segments(), wrong.points);
  const auto points = points_on(form.space().mesh(), boundary.cell, boundary.local, p, wrong);
  const std::vector<contact::ContactState<dim>> states = form.contact_states(u, contact, tables[contact]);
  for (DataPoint<dim>& point : facet.data) point.traction[0].setZero();
  for (std::size_t q = 0; q < points.size(); ++q)
    facet.data.push_back({points[q], {states[q].traction, Point<dim>::Zero()}});
}

template <int dim>
std::vector<DenseCell<dim>> dense_cells(const contact::NitscheForm<dim>& form, std::span<const double> u)
{
  std::vector<DenseCell<dim>> cells;
  for (Index c = 0; c < form.space().mesh().n_cells(); ++c) cells.push_back(make_cell(form, u, c));
  return cells;
}

template <int dim>
std::vector<DenseFacet<dim>> dense_facets(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                          std::span<const Point<dim>> t, Mutation mutation)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const int p = form.space().degree();
  std::vector<DenseFacet<dim>> facets(mesh.topology().facets.size());
  const mesh::Topology<dim>& topology = mesh.topology();
  for (std::size_t f = 0; f < facets.size(); ++f)
  {
    DenseFacet<dim>& facet = facets[f];
    facet.vertices = topology.facets[f];
    facet.cells = topology.facet_cells[f];
    const auto& of_cell = topology.cell_facets[facet.cells[0]];
    const auto local = static_cast<int>(std::ranges::find(of_cell, static_cast<Index>(f)) - of_cell.begin());
    facet.normal = mesh::facet_geometry(mesh, facet.cells[0], local).normal;
    facet.points = points_on(mesh, facet.cells[0], local, p, form.facet_rule());
  }
  const std::vector<Point<dim>> T = form.traction(u);
  int contact = 0;
  std::vector<Point<dim>> load(form.facet_rule().size());
  for (std::size_t number = 0; number < mesh.boundary().size(); ++number)
  {
    const mesh::BoundaryFacet& boundary = mesh.boundary()[number];
    form.data().traction(number, load);
    DenseFacet<dim>& facet = facets[topology.cell_facets[boundary.cell][boundary.local]];
    facet.condition = &form.problem().boundary(boundary.tag);
    for (std::size_t q = 0; q < facet.points.size(); ++q)
    {
      const std::size_t i = contact * facet.points.size() + q;
      facet.traction.push_back(facet.condition->contact ? T[i] : load[q]);
      const bool running = facet.condition->contact && mutation != Mutation::t_replaced_by_T;
      const Point<dim> lin = running ? Point<dim>(t[i] - T[i]) : Point<dim>(Point<dim>::Zero());
      facet.data.push_back({facet.points[q], {facet.traction[q], lin}});
    }
    if (!facet.condition->contact) continue;
    if (mutation == Mutation::coarse_rule_for_t) coarsen(form, boundary, u, contact, facet);
    ++contact;
  }
  return facets;
}

}  // namespace

template <int dim>
DenseData<dim>::DenseData(const contact::NitscheForm<dim>& form, std::span<const double> u,
                          std::span<const Point<dim>> t, certify::PatchStress patches, Mutation mistake)
    : mesh(form.space().mesh()),
      by_rows(patches == certify::PatchStress::rows),
      mutation(mistake),
      p(form.space().degree()),
      n(fem::polynomial_dimension(dim, p)),
      m(fem::polynomial_dimension(dim, p - 1)),
      cells(dense_cells(form, u)),
      facets(dense_facets(form, u, t, mutation))
{
}

template struct DenseData<2>;
template struct DenseData<3>;

}  // namespace tribound::test
