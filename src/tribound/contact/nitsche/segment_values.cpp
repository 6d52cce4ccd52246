#include "tribound/contact/nitsche/segment_values.h"

#include <algorithm>
#include <iterator>

#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/fem/evaluation.h"

namespace tribound::contact
{

template <int dim>
fem::Tabulation<dim> tabulate(const fem::LagrangeBasis<dim>& basis, const SegmentSide<dim>& side,
                              std::span<const Point<dim - 1>> points)
{
  std::vector<Point<dim - 1>> on_facet;
  for (const Point<dim - 1>& s : points) on_facet.push_back(side.on_facet(s));
  return basis.tabulate(fem::points_on_facet<dim>(side.facet.local, on_facet));
}

template <int dim>
SegmentTables<dim>::SegmentTables(const fem::LagrangeBasis<dim>& basis,
                                  std::span<const ContactSegment<dim>> segments,
                                  std::span<const Point<dim - 1>> points)
    : points_(points.begin(), points.end())
{
  std::ranges::move(fem::tabulate_on_facets<dim>(basis, points).on_facet, std::back_inserter(tables_));
  const auto table_of = [&](const SegmentSide<dim>& side)
  {
    if (!side.part) return side.facet.local;
    tables_.push_back(tabulate(basis, side, points));
    return static_cast<int>(tables_.size()) - 1;
  };
  for (const ContactSegment<dim>& segment : segments)
  {
    const int slave = table_of(segment.slave);
    tables_of_.push_back({slave, segment.master ? table_of(*segment.master) : -1});
  }
}

template <int dim>
SegmentNodes<dim>::SegmentNodes(int degree, std::span<const Point<dim - 1>> points)
{
  const fem::LagrangeBasis<dim - 1> basis(degree);
  const int n = basis.n_nodes();
  nodes_ = basis.node_points();
  const fem::Tabulation<dim - 1> table = basis.tabulate(points);
  values_.assign(table.values.begin(), table.values.end());
  multiply(n);
}

template <int dim>
SegmentNodes<dim>::SegmentNodes(std::span<const Point<dim - 1>> points)
    : nodes_(points.begin(), points.end()), values_(points.size() * points.size(), 0.0)
{
  for (std::size_t i = 0; i < points.size(); ++i) values_[i * points.size() + i] = 1;
  multiply(static_cast<int>(points.size()));
}

template <int dim>
void SegmentNodes<dim>::multiply(int n_nodes)
{
  const std::size_t n_points = values_.size() / n_nodes;
  products_.reserve(values_.size() * n_nodes);
  for (int i = 0; i < n_nodes; ++i)
    for (int l = 0; l < n_nodes; ++l)
      for (std::size_t q = 0; q < n_points; ++q)
        products_.push_back(values_[q * n_nodes + i] * values_[q * n_nodes + l]);
}

namespace
{

/// gamma n n^T + gamma_t (I - n n^T).
template <int dim>
Tensor<dim> penalty(const ContactSegment<dim>& segment)
{
  const double weight = problem::tangential_weight(segment.contact->law);
  return segment.gamma *
         (weight * Tensor<dim>::Identity() + (1 - weight) * segment.normal * segment.normal.transpose());
}

}  // namespace

template <int dim>
SegmentValues<dim>::SegmentValues(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                                  const ContactSegment<dim>& segment, const SegmentTable<dim>& table)
    : mesh_(space.mesh()),
      points_(table.points),
      is_axisymmetric_(problem.is_axisymmetric()),
      gamma_(penalty(segment)),
      n_sides_(segment.master ? 2 : 1)
{
  const mesh::Mesh<dim>& mesh = space.mesh();
  const auto make_side = [&](const SegmentSide<dim>& side, const fem::Tabulation<dim>* tabulation) -> Side
  {
    const Index cell = side.facet.cell;
    return {&side, tabulation, &problem.material(mesh.region(cell)), space.cell_nodes(cell),
            mesh::cell_map(mesh, cell).inverse_transpose};
  };
  sides_[0] = make_side(segment.slave, table.slave);
  if (segment.master) sides_[1] = make_side(*segment.master, table.master);
}

template <int dim>
Point<dim> SegmentValues<dim>::jump(std::span<const double> u, int q) const
{
  Point<dim> result = Point<dim>::Zero();
  for (const Side& side : sides())
    result += side.side->sign * fem::value_at<dim>(side.nodes, u, side.table->values_at(q));
  return result;
}

template <int dim>
double SegmentValues<dim>::radius(const Side& side, int q) const
{
  const mesh::BoundaryFacet& facet = side.side->facet;
  return mesh::facet_map(mesh_, facet.cell, facet.local)(side.side->on_facet(points_[q]))[0];
}

template <int dim>
Point<dim> SegmentValues<dim>::augmented_traction(std::span<const double> u, int q) const
{
  Point<dim> stress = Point<dim>::Zero();
  for (const Side& side : sides())
  {
    const Tensor<dim> gradient =
        fem::gradient_at<dim>(side.nodes, u, side.table->gradients_at(q), side.inverse_transpose);
    stress += sigma<dim>(*side.material, gradient) * side.side->stress_direction;
    if (!is_axisymmetric_) continue;
    const double u_r = fem::value_at<dim>(side.nodes, u, side.table->values_at(q))[0];
    stress += side.material->lambda * hoop_strain(radius(side, q), u_r, gradient(0, 0)) *
              side.side->stress_direction;
  }
  return stress - gamma_ * jump(u, q);
}

/// Column b is sigma(phi e_b) m - Gamma [phi e_b] = lambda (d_b phi) m + mu m_b grad phi + mu grad phi . m
/// e_b
/// - sign phi Gamma e_b, Gamma = gamma n n^T + gamma_t (I - n n^T); on a meridian plus lambda phi / r m for
/// b = r.
template <int dim>
Tensor<dim> SegmentValues<dim>::augmented_derivative(const Side& side, int i, int q) const
{
  const Point<dim>& m = side.side->stress_direction;
  const Point<dim> gradient = side.inverse_transpose * side.table->gradients_at(q)[i];
  Tensor<dim> block =
      side.material->lambda * m * gradient.transpose() + side.material->mu * gradient * m.transpose();
  block.diagonal().array() += side.material->mu * gradient.dot(m);
  if (is_axisymmetric_)
    block.col(0) +=
        side.material->lambda * hoop_strain(radius(side, q), side.table->values_at(q)[i], gradient[0]) * m;
  block -= side.side->sign * side.table->values_at(q)[i] * gamma_;
  return block;
}

template fem::Tabulation<2> tabulate(const fem::LagrangeBasis<2>&, const SegmentSide<2>&,
                                     std::span<const Point<1>>);
template fem::Tabulation<3> tabulate(const fem::LagrangeBasis<3>&, const SegmentSide<3>&,
                                     std::span<const Point<2>>);
template class SegmentTables<2>;
template class SegmentTables<3>;
template class SegmentNodes<2>;
template class SegmentNodes<3>;
template class SegmentValues<2>;
template class SegmentValues<3>;

}  // namespace tribound::contact
