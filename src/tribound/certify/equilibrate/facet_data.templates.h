#pragma once

/// @file facet_data.templates.h
/// The definitions of facet_data.h, for the kernels alone (certify/equilibrate/kernel.cpp.in).

#include "tribound/certify/equilibrate/facet_data.h"

#include <algorithm>
#include <cmath>

#include "tribound/certify/equilibrate/sorted_cell.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"

namespace tribound::certify
{

namespace detail
{

/// Adds moments of tractions on one boundary facet of a cell.
template <int dim, int p>
class FacetMoments
{
 public:
  using Moments = typename FacetData<dim, p>::Moments;

  FacetMoments(const mesh::Mesh<dim>& mesh, const mesh::BoundaryFacet& facet)
  {
    const SortedCell<dim> sorted = make_sorted_cell(mesh, facet.cell);
    for (int i = 0, n = 0; i <= dim; ++i)
      if (sorted.local[i] != facet.local) order_[n++] = sorted.local[i] - (sorted.local[i] > facet.local);
    scale_ = 1 / std::sqrt(mesh::facet_geometry(mesh, facet.cell, facet.local).det());
  }

  /// Hat functions and theta at a point of the reference facet.
  void at(const Point<dim - 1>& s)
  {
    const std::array<double, dim> in_cell_order = fem::barycentric<dim - 1>(s);
    for (int i = 0; i < dim; ++i) hat_[i] = in_cell_order[order_[i]];
    Point<dim - 1> sorted;
    for (int i = 1; i < dim; ++i) sorted[i - 1] = hat_[i];
    fem::orthonormal_values<dim - 1>(p, sorted, theta_);
  }

  /// moments += weight psi_v theta_i t there.
  void add(double weight, const Point<dim>& t, Moments& moments) const
  {
    for (int v = 0; v < dim; ++v)
      for (int c = 0; c < dim; ++c)
        for (int i = 0; i < n; ++i) moments[v][c * n + i] += weight * scale_ * hat_[v] * theta_[i] * t[c];
  }

 private:
  static constexpr int n = Sizes<dim, p>::facet;
  std::array<int, dim> order_;  ///< order_[i]: number among the facet's vertices, in cell order, of the i-th
                                ///< ascending
  double scale_;                ///< normalises theta on the facet
  std::array<double, dim> hat_;
  std::array<double, n> theta_;
};

}  // namespace detail

template <int dim, int p>
FacetData<dim, p>::FacetData(const contact::NitscheForm<dim>& form, std::span<const double> u,
                             typename Stress<dim>::Tractions tractions)
    : number_(form.space().mesh().topology().facets.size(), -1),
      tractions_(std::move(tractions)),
      on_contact_(form.space().mesh().n_vertices(), 0),
      n_parts_(!tractions_.reg.empty()   ? 3
               : !tractions_.lin.empty() ? 2
                                         : 1)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const contact::Springs<dim>& springs = form.springs();
  for (std::size_t number = 0; number < mesh.boundary().size(); ++number)
  {
    const mesh::BoundaryFacet& facet = mesh.boundary()[number];
    Condition& condition = conditions_.emplace_back();
    number_[mesh.topology().cell_facets[facet.cell][facet.local]] = static_cast<int>(number);
    for (int c = 0; c < dim; ++c) condition.fixed[c] = form.problem().boundary(facet.tag).fixes(c);
    const std::size_t first = tractions_.springs.size();
    if (const contact::SpringFacet<dim>* spring = springs.on(number))
      for (std::size_t q = 0; q < spring->weights.size(); ++q)
        tractions_.springs.push_back(springs.traction(*spring, u, static_cast<int>(q)));
    add_load(form, number, std::span(tractions_.springs).subspan(first));
  }
  for (std::size_t k = 0; k < form.segments().size(); ++k)
    form.segments()[k].for_each_side([&](const contact::SegmentSide<dim>& side)
                                     { add_contact(form, k, side); });
}

template <int dim, int p>
auto FacetData<dim, p>::discretisation_of(Condition& condition) -> Moments&
{
  if (condition.moments < 0)
  {
    condition.moments = static_cast<int>(discretisation_.size());
    discretisation_.emplace_back();
  }
  return discretisation_[condition.moments];
}

template <int dim, int p>
void FacetData<dim, p>::add_load(const contact::NitscheForm<dim>& form, std::size_t number,
                                 std::span<const Point<dim>> springs)
{
  if (springs.empty() && !form.data().has_traction(number)) return;
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const mesh::BoundaryFacet& facet = mesh.boundary()[number];
  const fem::Quadrature<dim - 1>& rule = form.facet_rule();
  std::vector<Point<dim>> load(rule.size());
  form.data().traction(number, load);
  Moments& moments = discretisation_of(conditions_[number]);
  detail::FacetMoments<dim, p> on_facet(mesh, facet);
  for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, rule))
  {
    on_facet.at(rule.points[q]);
    on_facet.add(dx, springs.empty() ? load[q] : Point<dim>(load[q] + springs[q]), moments);
  }
}

template <int dim, int p>
void FacetData<dim, p>::add_contact(const contact::NitscheForm<dim>& form, std::size_t k,
                                    const contact::SegmentSide<dim>& side)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  Condition& condition = conditions_[side.number];
  if (condition.contact < 0)
  {
    condition.contact = static_cast<int>(linearisation_.size());
    if (n_parts_ >= 2) linearisation_.emplace_back();
    if (n_parts_ == 3) regularisation_.emplace_back();
    for (const Index v : mesh::facet_vertices(mesh.cell(side.facet.cell), side.facet.local))
      on_contact_[v] = 1;
  }
  Moments& discretisation = discretisation_of(condition);
  detail::FacetMoments<dim, p> on_facet(mesh, side.facet);
  for (int q = 0; q < form.n_segment_points(); ++q)
  {
    const std::size_t i = k * form.n_segment_points() + q;
    const double weight = side.sign * form.contact_points()[i].weight;
    on_facet.at(side.on_facet(form.facet_rule().points[q]));
    on_facet.add(weight, tractions_.dis[i], discretisation);
    if (n_parts_ >= 2) on_facet.add(weight, tractions_.lin[i], linearisation_[condition.contact]);
    if (n_parts_ == 3) on_facet.add(weight, tractions_.reg[i], regularisation_[condition.contact]);
  }
}

template <int dim, int p>
bool FacetData<dim, p>::fixes_any(Index facet) const
{
  const auto& fixed = conditions_[number_[facet]].fixed;
  return std::ranges::find(fixed, true) != fixed.end();
}

}  // namespace tribound::certify
