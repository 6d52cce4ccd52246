#include "tribound/certify/energy/meridian_edge_forces.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "tribound/certify/equilibrate/meridian_fields.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/meridian_rules.h"
#include "tribound/fem/polynomials.h"

namespace tribound::certify
{

namespace
{

constexpr auto edges = mesh::local_edges<2>;

class EdgeForces
{
 public:
  explicit EdgeForces(const contact::NitscheForm<2>& form)
      : form_(form),
        mesh_(form.space().mesh()),
        fields_(form),
        rules_(mesh_, form.space().degree() + 2),
        forces_(mesh_.topology().edges.size(), Point<2>::Zero())
  {
  }

  [[nodiscard]] std::vector<Point<2>> operator()(std::span<const double> u, std::span<const Point<2>> t)
  {
    for (Index c = 0; c < mesh_.n_cells(); ++c)
    {
      add_body_force(c);
      subtract_stress(c, u);
    }
    for (std::size_t number = 0; number < mesh_.boundary().size(); ++number) add_traction(number, u);
    for (std::size_t k = 0; k < form_.segments().size(); ++k)
      form_.segments()[k].for_each_side([&](const contact::SegmentSide<2>& side)
                                        { add_contact(k, side, t); });
    for (const mesh::BoundaryFacet& facet : mesh_.boundary()) fix(facet);
    return forces_;
  }

 private:
  [[nodiscard]] Point<2>& of(Index cell, std::size_t edge)
  {
    return forces_[mesh_.topology().cell_edges[cell][edge]];
  }
  [[nodiscard]] Point<2>& of(const mesh::BoundaryFacet& facet)
  {
    std::size_t e = 0;
    while (edges[e][0] == facet.local || edges[e][1] == facet.local) ++e;
    return of(facet.cell, e);
  }

  void add_body_force(Index c)
  {
    if (!form_.data().has_body_force(c)) return;
    const fem::Quadrature<2>& rule = form_.data().cell_rule();
    std::vector<Point<2>> f(rule.size());
    form_.data().body_force(c, f);
    for (const auto& [q, x, dx] : fem::cell_points(mesh::cell_map(mesh_, c), rule))
    {
      const std::array<double, 3> lambda = fem::barycentric<2>(rule.points[q]);
      for (std::size_t e = 0; e < edges.size(); ++e)
        of(c, e) += dx * x[0] * lambda[edges[e][0]] * lambda[edges[e][1]] * f[q];
    }
  }

  /// (r sigma, grad (psi_a psi_b)) and (sigma_tt, psi_a psi_b) of a cell.
  void subtract_stress(Index c, std::span<const double> u)
  {
    const SortedCell<2> sorted = make_sorted_cell(mesh_, c);
    MeridianFields::WeightedStress stress = fields_.stress(c, sorted, u);
    fields_.add_initial_stress(c, sorted, stress);
    const Eigen::Index m = stress.hoop.size();
    const auto integral = [&](const Eigen::VectorXd& field, int vertex)  // of psi_a times it
    { return std::sqrt(sorted.det / 2) * fields_.reference().hat[vertex].col(0).head(m).dot(field); };
    std::array<int, 3> in_sorted{};
    for (int i = 0; i < 3; ++i) in_sorted[sorted.local[i]] = i;
    for (std::size_t e = 0; e < edges.size(); ++e)
    {
      const int a = in_sorted[edges[e][0]];
      const int b = in_sorted[edges[e][1]];
      for (int row = 0; row < 2; ++row)
        for (int k = 0; k < 2; ++k)
          of(c, e)[row] -= integral(stress.plane[row][k], a) * sorted.grad[b][k] +
                           integral(stress.plane[row][k], b) * sorted.grad[a][k];
    }
    const fem::Quadrature<2>& rule = rules_.of_cell(c);
    std::vector<double> phi(m);
    for (const auto& [q, x, dx] : fem::cell_points(mesh::cell_map(mesh_, c), rule))
    {
      fem::orthonormal_values<2>(form_.space().degree(), to_sorted_cell<2>(sorted.local, rule.points[q]),
                                 phi);
      const double hoop = stress.hoop.dot(Eigen::Map<const Eigen::VectorXd>(phi.data(), m)) / x[0];
      const std::array<double, 3> lambda = fem::barycentric<2>(rule.points[q]);
      for (std::size_t e = 0; e < edges.size(); ++e)
        of(c, e)[0] -= dx / std::sqrt(sorted.det) * hoop * lambda[edges[e][0]] * lambda[edges[e][1]];
    }
  }

  /// g_N - K (u - u_0).
  void add_traction(std::size_t number, std::span<const double> u)
  {
    const contact::SpringFacet<2>* const spring = form_.springs().on(number);
    if (spring == nullptr && !form_.data().has_traction(number)) return;
    const mesh::BoundaryFacet& facet = mesh_.boundary()[number];
    const fem::Quadrature<1>& rule = form_.facet_rule();
    std::vector<Point<2>> g(rule.size());
    form_.data().traction(number, g);
    for (const auto& [q, x, dx] : fem::facet_points(mesh_, facet.cell, facet.local, rule))
    {
      if (spring != nullptr) g[q] += form_.springs().traction(*spring, u, q);
      of(facet) += dx * x[0] * rule.points[q][0] * (1 - rule.points[q][0]) * g[q];
    }
  }

  void add_contact(std::size_t k, const contact::SegmentSide<2>& side, std::span<const Point<2>> t)
  {
    for (int q = 0; q < form_.n_segment_points(); ++q)
    {
      const double s = side.on_facet(form_.facet_rule().points[q])[0];
      of(side.facet) +=
          side.sign * form_.contact_points(k)[q].weight * s * (1 - s) * t[k * form_.n_segment_points() + q];
    }
  }

  void fix(const mesh::BoundaryFacet& facet)
  {
    const auto ends = mesh::facet_vertices(mesh_.cell(facet.cell), facet.local);
    const bool on_axis = mesh_.vertex(ends[0])[0] == 0 && mesh_.vertex(ends[1])[0] == 0;
    for (int row = 0; row < 2; ++row)
      if (form_.problem().boundary(facet.tag).fixes(row) || (row == 0 && on_axis)) of(facet)[row] = 0;
  }

  const contact::NitscheForm<2>& form_;
  const mesh::Mesh<2>& mesh_;
  MeridianFields fields_;
  fem::MeridianRules rules_;
  std::vector<Point<2>> forces_;
};

}  // namespace

std::vector<Point<2>> meridian_edge_forces(const contact::NitscheForm<2>& form, std::span<const double> u,
                                           std::span<const Point<2>> t)
{
  return EdgeForces(form)(u, t);
}

}  // namespace tribound::certify
