#include "tribound/certify/energy/load_oscillation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "tribound/certify/bound/poincare_korn.h"
#include "tribound/certify/bound/transfer_terms.h"
#include "tribound/certify/energy/meridian_oscillation.h"
#include "tribound/certify/energy/traction_fit.h"
#include "tribound/contact/nitsche/residual.h"
#include "tribound/fem/polynomials.h"

namespace tribound::certify
{

namespace
{

template <int dim>
PoincareKorn<dim> constants_of(const mesh::Mesh<dim>& mesh, Index cell)
{
  return poincare_korn<dim>(mesh::points_of(mesh.vertices(), mesh.cell(cell)));
}

}  // namespace

template <int dim>
double least_stiffness(const contact::NitscheForm<dim>& form, Index cell)
{
  const problem::Material& material = form.problem().material(form.space().mesh().region(cell));
  const int n = std::max(dim, form.problem().is_axisymmetric() ? 3 : 2);
  return std::min(2 * material.mu, 2 * material.mu + n * material.lambda);
}

/// f - Pi f and g - Pi g are orthogonal to rigid motions by quadrature. Their projections on them are at
/// most (d + 1) e_T |T|^{-1/2} and d e_F |F|^{-1/2}, if e bounds what it misses, since affine functions are
/// at most n + 1 times their root mean square on simplices with n + 1 vertices. That on F is tested with w
/// less the nearest rigid motion r on T, and with r.
template <int dim>
LoadOscillation load_oscillation(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                 double korn)
{
  if constexpr (dim == 2)
    if (form.problem().is_axisymmetric()) return meridian_load_oscillation(form, u, korn);
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const contact::DiscreteData<dim>& data = form.data();
  const Index n_cells = mesh.n_owned_cells();
  LoadOscillation result{.cells = std::vector<double>(n_cells, 0.0)};
  std::vector<double> missed(n_cells, 0.0);
  for (Index c = 0; c < n_cells; ++c)
  {
    const auto [oscillation, mean] = data.body_remainder(c);
    missed[c] = mean;
    if (oscillation > 0) result.cells[c] = constants_of(mesh, c).cell * oscillation;
  }
  for (std::size_t k = 0; k < mesh.n_owned_boundary(); ++k)
  {
    const auto [oscillation, mean] = contact::traction_remainder(form, k, u);
    if (oscillation == 0 && mean == 0) continue;
    const mesh::BoundaryFacet& facet = mesh.boundary()[k];
    const PoincareKorn<dim> of_cell = constants_of(mesh, facet.cell);
    const double measure = mesh::facet_geometry(mesh, facet.cell, facet.local).measure;
    result.cells[facet.cell] += of_cell.facets[facet.local] * oscillation +
                                of_cell.traces[facet.local] * dim * mean / std::sqrt(measure);
    missed[facet.cell] += dim * mean;
  }
  double squares = 0;
  double least = std::numeric_limits<double>::infinity();  // of the stiffness
  for (Index c = 0; c < n_cells; ++c)
  {
    const double stiffness = least_stiffness(form, c);
    least = std::min(least, stiffness);
    result.cells[c] += data.initial_stress().remainder(c).added_to(0);
    result.cells[c] /= std::sqrt(stiffness);
    if (missed[c] > 0) squares += missed[c] * missed[c] / mesh::cell_map(mesh, c).measure();
  }
  squares = mesh.ranks().sum(squares);
  least = -mesh.ranks().max(-least);
  if (squares > 0) result.missed = korn * (dim + 1) * std::sqrt(squares / least);
  if (!std::isfinite(result.missed))
    result.reason = "quadrature may miss a part of the loads, and contact or springs alone hold a body";
  return result;
}

namespace
{

/// Squares of ||t - Pi_k t|| on facets, by cell and local facet, on segments where N varies and t is of
/// higher degree. On the master t acts as -J t, J = dS/dM.
template <int dim>
std::map<std::pair<Index, int>, double> turning_losses(const contact::NitscheForm<dim>& form,
                                                       const ContactTerms<dim>& terms,
                                                       std::span<const Point<dim>> t)
{
  const fem::Quadrature<dim - 1>& rule = form.facet_rule();
  const auto n = static_cast<std::size_t>(rule.size());
  const int degree = form.space().degree();
  std::vector<double> theta(fem::polynomial_dimension(dim - 1, degree));
  const ContactFrames<dim> frames(form);
  std::map<std::pair<Index, int>, double> squares;
  for (std::size_t k = 0; k < form.segments().size(); ++k)
  {
    const contact::ContactSegment<dim>& segment = form.segments()[k];
    if (segment.varying_normal == nullptr || is_low(form, frames, k)) continue;
    const std::vector<Point<dim>> projected = terms.project_plainly(t.subspan(k * n, n));
    double sum = 0;
    for (std::size_t q = 0; q < n; ++q)
    {
      fem::orthonormal_values<dim - 1>(degree, rule.points[q], theta);
      Point<dim> rest = t[k * n + q];
      for (std::size_t i = 0; i < theta.size(); ++i) rest -= theta[i] * projected[i];
      sum += segment.det() * rule.weights[q] * rest.squaredNorm();
    }
    const auto add = [&](const contact::SegmentSide<dim>& side)
    {
      const double measure = contact::simplex_map(form.space().mesh(), side).measure;
      squares[{side.facet.cell, side.facet.local}] += segment.measure / measure * sum;
    };
    segment.for_each_side(add);
  }
  return squares;
}

/// Of ||t - Pi t|| on a facet, in the bracket of O_T.
template <int dim>
double loss_factor(const contact::NitscheForm<dim>& form, Index cell, int facet)
{
  if constexpr (dim == 2)
    if (form.problem().is_axisymmetric()) return meridian_traction_constant(form, cell, facet);
  return constants_of(form.space().mesh(), cell).facets[facet];
}

}  // namespace

/// The facets carry projections of degree >= 1, so the rest is orthogonal to rigid motions.
template <int dim>
std::vector<double> transfer_oscillation(const contact::NitscheForm<dim>& form,
                                         const ContactTerms<dim>& terms, std::span<const Point<dim>> t)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  std::vector<double> result(mesh.n_owned_cells(), 0.0);
  const auto add = [&](Index cell, int facet, double loss)
  {
    if (cell < mesh.n_owned_cells() && loss > 0)
      result[cell] += loss_factor(form, cell, facet) * loss / std::sqrt(least_stiffness(form, cell));
  };
  // With the weight r the constant is infinite at the axis, and rounding would count.
  const auto is_whole = [&](std::span<const TractionPiece<dim>> pieces)
  {
    constexpr double rounding = 1e-9;
    return form.problem().is_axisymmetric() && pieces.size() == 1 &&
           fem::fraction<dim - 1>(pieces[0].part) >= 1 - rounding;
  };
  for (const auto& [cell, transfers] : facet_transfers<dim>(form, terms, t))
    for (const FacetTransfer<dim>& transfer : transfers)
      for (const auto& pieces : transfer.groups)
        if (!is_whole(pieces))
          add(cell, transfer.facet.local,
              transfer_loss<dim>(mesh, transfer.facet, form.space().degree(), pieces));
  for (const auto& [facet, square] : turning_losses(form, terms, t))
    add(facet.first, facet.second, std::sqrt(square));
  return result;
}

template double least_stiffness(const contact::NitscheForm<2>&, Index);
template double least_stiffness(const contact::NitscheForm<3>&, Index);
template LoadOscillation load_oscillation(const contact::NitscheForm<2>&, std::span<const double>, double);
template LoadOscillation load_oscillation(const contact::NitscheForm<3>&, std::span<const double>, double);

template std::vector<double> transfer_oscillation(const contact::NitscheForm<2>&, const ContactTerms<2>&,
                                                  std::span<const Point<2>>);
template std::vector<double> transfer_oscillation(const contact::NitscheForm<3>&, const ContactTerms<3>&,
                                                  std::span<const Point<3>>);

}  // namespace tribound::certify
