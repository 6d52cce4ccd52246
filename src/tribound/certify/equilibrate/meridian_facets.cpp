#include "tribound/certify/equilibrate/meridian_facets.h"

#include <cmath>
#include <utility>

#include "tribound/fem/evaluation.h"
#include "tribound/fem/polynomials.h"

namespace tribound::certify
{

MeridianFacets::MeridianFacets(const contact::NitscheForm<2>& form, const MeridianReference& reference,
                               std::span<const double> u, Stress<2>::Tractions tractions)
    : form_(form),
      reference_(reference),
      tractions_(std::move(tractions)),
      n_parts_(!tractions_.reg.empty()   ? 3
               : !tractions_.lin.empty() ? 2
                                         : 1),
      number_(form.space().mesh().topology().facets.size(), -1),
      traces_(form.space().mesh().boundary().size()),
      on_contact_(form.space().mesh().n_vertices(), 0)
{
  const mesh::Mesh<2>& mesh = form.space().mesh();
  for (std::size_t number = 0; number < mesh.boundary().size(); ++number)
  {
    const mesh::BoundaryFacet& facet = mesh.boundary()[number];
    number_[mesh.topology().cell_facets[facet.cell][facet.local]] = static_cast<int>(number);
    add_load(number, u);
  }
  for (std::size_t k = 0; k < form.segments().size(); ++k)
    form.segments()[k].for_each_side([&](const contact::SegmentSide<2>& side) { add_contact(k, side); });
  project();
}

void MeridianFacets::add_load(std::size_t number, std::span<const double> u)
{
  const contact::SpringFacet<2>* const spring = form_.springs().on(number);
  if (spring == nullptr && !form_.data().has_traction(number)) return;
  const mesh::Mesh<2>& mesh = form_.space().mesh();
  const mesh::BoundaryFacet& facet = mesh.boundary()[number];
  const fem::Quadrature<1>& rule = form_.facet_rule();
  std::vector<Point<2>> load(rule.size());
  form_.data().traction(number, load);
  for (int q = 0; spring != nullptr && q < rule.size(); ++q)
    load[q] += tractions_.springs.emplace_back(form_.springs().traction(*spring, u, q));
  Ends& moments = traces_of(number, 0);
  for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, rule))
    add(facet, rule.points[q], x[0] * dx, load[q], moments);
}

bool MeridianFacets::fixes(Index facet, int component) const
{
  if (number_[facet] < 0) return false;
  return form_.problem().boundary(form_.space().mesh().boundary()[number_[facet]].tag).fixes(component);
}

const Eigen::MatrixXd* MeridianFacets::trace(Index facet, int part, int end) const
{
  if (number_[facet] < 0) return nullptr;
  const Eigen::MatrixXd& trace = traces_[number_[facet]][part][end];
  return trace.size() == 0 ? nullptr : &trace;
}

MeridianFacets::Ends& MeridianFacets::traces_of(std::size_t number, int part)
{
  Ends& ends = traces_[number][part];
  if (ends[0].size() == 0) ends.fill(Eigen::MatrixXd::Zero(reference_.n_facet - 1, 2));
  return ends;
}

void MeridianFacets::add(const mesh::BoundaryFacet& facet, const Point<1>& s, double weight,
                         const Point<2>& t, Ends& moments) const
{
  const mesh::Mesh<2>& mesh = form_.space().mesh();
  const std::array<Index, 2> ends = mesh::facet_vertices(mesh.cell(facet.cell), facet.local);
  const Point<1> ascending(ends[0] < ends[1] ? s[0] : 1 - s[0]);
  std::vector<double> theta(reference_.n_facet - 1);
  fem::orthonormal_values<1>(reference_.n_facet - 2, ascending, theta);
  const double scale = 1 / std::sqrt(mesh::facet_geometry(mesh, facet.cell, facet.local).det());
  const std::array<double, 2> hat = fem::barycentric<1>(ascending);
  for (int v = 0; v < 2; ++v)
    for (std::size_t i = 0; i < theta.size(); ++i)
      moments[v].row(i) += weight * scale * hat[v] * theta[i] * t.transpose();
}

void MeridianFacets::add_contact(std::size_t k, const contact::SegmentSide<2>& side)
{
  const mesh::Mesh<2>& mesh = form_.space().mesh();
  for (const Index v : mesh::facet_vertices(mesh.cell(side.facet.cell), side.facet.local)) on_contact_[v] = 1;
  const std::array<std::span<const Point<2>>, 3> parts = {tractions_.dis, tractions_.lin, tractions_.reg};
  for (int part = 0; part < n_parts_; ++part)
    for (int q = 0; q < form_.n_segment_points(); ++q)
      add(side.facet, side.on_facet(form_.facet_rule().points[q]),
          side.sign * form_.contact_points(k)[q].weight, parts[part][k * form_.n_segment_points() + q],
          traces_of(side.number, part));
}

void MeridianFacets::project()
{
  const mesh::Mesh<2>& mesh = form_.space().mesh();
  for (std::size_t number = 0; number < traces_.size(); ++number)
  {
    const mesh::BoundaryFacet& facet = mesh.boundary()[number];
    const std::array<Index, 2>& vertices =
        mesh.topology().facets[mesh.topology().cell_facets[facet.cell][facet.local]];
    const Eigen::MatrixXd times_r = mesh.vertex(vertices[0])[0] * reference_.hat_on_facet[0] +
                                    mesh.vertex(vertices[1])[0] * reference_.hat_on_facet[1];
    for (Ends& ends : traces_[number])
    {
      if (ends[0].size() == 0) continue;
      const CholeskyFactors mass(times_r.topRows(reference_.n_facet - 1));
      for (Eigen::MatrixXd& trace : ends) trace = times_r * mass.solve(trace);
    }
  }
}

}  // namespace tribound::certify
