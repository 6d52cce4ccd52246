#include "tribound/certify/bound/estimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "tribound/base/norm.h"
#include "tribound/base/parallel.h"
#include "tribound/base/sorted.h"
#include "tribound/certify/bound/meridian_transfer.h"
#include "tribound/certify/bound/rigid_remainder.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/fem/polynomials.h"

namespace tribound::certify
{

namespace
{

/// The root of the sum of squares over all ranks for each component, and both totals, with the components
/// that are not attributed to cells.
void add_up(Estimate& estimate, double quad, double alg, const Ranks& ranks)
{
  std::array<double, std::size(all_components) + 3> sums{};
  auto& total = sums[std::size(all_components)];
  auto& total_sharp = sums[std::size(all_components) + 1];
  auto& stresses = sums[std::size(all_components) + 2];
  for (const BoundComponents& cell : estimate.cells)
  {
    for (std::size_t i = 0; i < std::size(all_components); ++i)
      sums[i] += std::pow(cell.*all_components[i].value, 2);
    total += std::pow(cell.total(), 2);
    total_sharp += std::pow(cell.total_sharp(), 2);
    stresses += std::pow(cell.stress(), 2);
  }
  ranks.sum(std::span(sums));
  for (std::size_t i = 0; i < std::size(all_components); ++i)
    estimate.global.*all_components[i].value = std::sqrt(sums[i]);
  if (estimate.global.mor > 0) estimate.global.str_mor = std::sqrt(stresses);
  estimate.global.quad = quad;
  estimate.global.alg = alg;
  estimate.total = std::sqrt(total) + quad + alg;
  estimate.total_sharp = std::sqrt(total_sharp) + quad + alg;
}

}  // namespace

template <int dim>
Estimator<dim>::Estimator(const contact::NitscheForm<dim>& form, ContactRule rule,
                          const std::optional<FriedrichsConstant>& known)
    : form_(form),
      friedrichs_(known ? *known : friedrichs_constant(form.problem(), form.space().mesh())),
      algebraic_(form),
      contact_(form, rule),
      rule_(fem::quadrature<dim>(2 * form.space().degree())),
      stress_table_(form.space().degree(), rule_.points)
{
  const fem::Tabulation<dim> table = form.space().basis().tabulate(rule_.points);
  const int n_points = rule_.size();
  gradient_.resize(static_cast<std::size_t>(dim) * table.n_nodes * n_points);
  for (int q = 0; q < n_points; ++q)
    for (int i = 0; i < table.n_nodes; ++i)
      for (int k = 0; k < dim; ++k)
        gradient_[(k * table.n_nodes + i) * n_points + q] = table.gradients_at(q)[i][k];
  if constexpr (dim == 2)
    if (form.problem().is_axisymmetric()) meridian_.emplace(form);
  if (!form.problem().has_initial_stress()) return;
  const auto n_theta = static_cast<std::size_t>(fem::polynomial_dimension(dim, form.space().degree()));
  theta_.resize(n_theta * n_points);
  for (int q = 0; q < n_points; ++q)
    fem::orthonormal_values<dim>(form.space().degree(), rule_.points[q],
                                 std::span(theta_).subspan(q * n_theta, n_theta));
}

template <int dim>
Estimate Estimator<dim>::operator()(std::span<const double> u, const Stress<dim>& stress,
                                    const AffineFields<dim>& rho, int n_threads) const
{
  Estimate result;
  const mesh::Mesh<dim>& mesh = form_.space().mesh();
  result.cells.resize(mesh.n_owned_cells());
  const DataTerms data = data_terms<dim>(form_, u);
  for (std::size_t c = 0; c < result.cells.size(); ++c)
  {
    result.cells[c].osc = data.osc[c];
    result.cells[c].neu = data.neu[c];
  }
  mesh.ranks().together(
      [&]
      {
        if (meridian_)
          meridian_terms(u, stress, rho, result);
        else
          stress_terms(u, stress, n_threads > 0 ? n_threads : max_threads(), result);
        contact_terms(u, stress, result);
        transfer_terms(u, stress, result);
      });
  const double alg = std::isfinite(friedrichs_.value)
                         ? algebraic_error<dim>(form_.problem(), mesh, rho, friedrichs_.value)
                         : 0;
  const double quad = (data.missed > 0 ? friedrichs_.value * data.missed : 0) +
                      rigid_remainder<dim>(form_, stress, friedrichs_.value);
  add_up(result, quad, alg, mesh.ranks());
  return result;
}

template <int dim>
BoundComponents Estimator<dim>::linearisation(const Stress<dim>& stress) const
{
  std::array<double, 3> sums{};
  auto& [lin1, lin2n, lin2t] = sums;
  lin1 = square_of_lin(stress);
  std::vector<ContactSquares> facets(form_.n_owned_segments());
  parallel_for(
      facets.size(),
      [&](std::size_t k) { facets[k] = contact_.linearisation(static_cast<int>(k), stress.tractions); }, 1);
  for (const ContactSquares& facet : facets)
  {
    lin2n += facet.lin2n;
    lin2t += facet.lin2t;
  }
  form_.space().mesh().ranks().sum(std::span(sums));
  BoundComponents result;
  result.lin1 = std::sqrt(lin1);
  result.lin2n = std::sqrt(lin2n);
  result.lin2t = std::sqrt(lin2t);
  return result;
}

/// sigma_dis - sigma(u) at quadrature points, sigma_0 projected on P^p; shares nothing with the construction
/// of sigma_dis.
template <int dim>
void Estimator<dim>::evaluate(std::span<const double> u, const Stress<dim>& stress, Index cell,
                              CellFields& fields) const
{
  const fem::LagrangeSpace<dim>& space = form_.space();
  const int n_points = rule_.size();
  auto& [dis, derivative, difference] = fields;
  dis.resize(static_cast<std::size_t>(dim) * dim * n_points);
  derivative.assign(dis.size(), 0);
  difference.resize(n_points);
  stress_table_.evaluate(make_sorted_cell(space.mesh(), cell), stress.dis_in(cell), dis);
  const std::span<const Index> nodes = space.cell_nodes(cell);
  for (int a = 0; a < dim; ++a)
    for (int k = 0; k < dim; ++k)
      for (std::size_t i = 0; i < nodes.size(); ++i)
      {
        const double value = u[static_cast<std::size_t>(dim) * nodes[i] + a];
        const double* const row = &gradient_[(k * nodes.size() + i) * n_points];
        double* const sum = &derivative[(a * dim + k) * n_points];
        for (int q = 0; q < n_points; ++q) sum[q] += value * row[q];
      }

  const Tensor<dim> to_physical = cell_map(space.mesh(), cell).inverse_transpose.transpose();
  const problem::Material& material = form_.problem().material(space.mesh().region(cell));
  for (int q = 0; q < n_points; ++q)
  {
    Tensor<dim> reference;
    Tensor<dim> equilibrated;
    for (int r = 0; r < dim; ++r)
      for (int s = 0; s < dim; ++s)
      {
        reference(r, s) = derivative[(r * dim + s) * n_points + q];
        equilibrated(r, s) = dis[(r * dim + s) * n_points + q];
      }
    difference[q] = equilibrated - contact::sigma<dim>(material, reference * to_physical);
  }
  const std::span<const Tensor<dim>> initial = form_.data().initial_stress().coefficients(cell);
  const std::size_t n_theta = theta_.size() / n_points;
  for (std::size_t j = 0; j < std::min(n_theta, initial.size()); ++j)
    for (int q = 0; q < n_points; ++q) difference[q] -= theta_[q * n_theta + j] * initial[j];
}

/// The norm of their difference on the cell.
template <int dim>
double Estimator<dim>::norm_of_difference(Index cell, const CellFields& fields) const
{
  double squares = 0;
  for (int q = 0; q < rule_.size(); ++q) squares += rule_.weights[q] * fields.difference[q].squaredNorm();
  return std::sqrt(cell_map(form_.space().mesh(), cell).det * squares);
}

/// ||sigma_dis - sigma(u)||_T with the given initial stress, and ||sigma_lin||_T and ||sigma_reg||_T from
/// their coefficients.
template <int dim>
void Estimator<dim>::stress_terms(std::span<const double> u, const Stress<dim>& stress, int n_threads,
                                  Estimate& result) const
{
  const mesh::Mesh<dim>& mesh = form_.space().mesh();
  const auto on_thread = [&](int thread)
  {
    CellFields fields;
    const auto first = [&](int i)
    { return static_cast<Index>(std::int64_t{mesh.n_owned_cells()} * i / n_threads); };
    for (Index c = first(thread); c < first(thread + 1); ++c)
    {
      evaluate(u, stress, c, fields);
      result.cells[c].str =
          form_.data().initial_stress().remainder(c).added_to(norm_of_difference(c, fields));
      result.cells[c].lin1 = norm(stress.lin_in(c));
      result.cells[c].reg1 = norm(stress.reg_in(c));
    }
  };
  in_threads(n_threads, on_thread);
}

/// The same of an axisymmetric problem, and the rest of osc.
template <int dim>
void Estimator<dim>::meridian_terms(std::span<const double> u, const Stress<dim>& stress,
                                    const AffineFields<dim>& rho, Estimate& result) const
{
  if constexpr (dim == 2)
    parallel_for(result.cells.size(),
                 [&](std::size_t c)
                 {
                   const double rho_z = rho.empty() ? 0 : rho[c][0][1];
                   meridian_->add(static_cast<Index>(c), u, stress, rho_z, result.cells[c]);
                 });
}

template <int dim>
double Estimator<dim>::square_of_lin(const Stress<dim>& stress) const
{
  if constexpr (dim == 2)
    if (meridian_)
      return parallel_sum(static_cast<std::size_t>(form_.space().mesh().n_owned_cells()), 0.0,
                          [&](std::size_t c)
                          {
                            const auto cell = static_cast<Index>(c);
                            return meridian_->square(cell, stress.lin_in(cell));
                          });
  double sum = 0;
  for (const double x : stress.lin) sum += x * x;
  return sum;
}

/// For a cell with several liftings (facets and groups), the largest is added to the stress; the norms of the
/// others are added after that. On a meridian nothing is lifted.
template <int dim>
void Estimator<dim>::transfer_terms(std::span<const double> u, const Stress<dim>& stress,
                                    Estimate& result) const
{
  if constexpr (dim == 2)
    if (meridian_)
    {
      for (const auto& [cell, lost] : meridian_transfers(form_, stress.tractions.running()))
      {
        BoundComponents& eta = result.cells[cell];
        eta.mor = lost;
        eta.str_mor = eta.str + lost;
      }
      return;
    }
  CellFields fields;
  std::vector<TransferLifting<dim>> liftings;
  for (const auto& [cell, transfers] : facet_transfers<dim>(form_, contact_, stress.tractions.running()))
  {
    BoundComponents& eta = result.cells[cell];
    liftings.clear();
    for (const FacetTransfer<dim>& transfer : transfers)
      for (const auto& pieces : transfer.groups)
        eta.mor += liftings.emplace_back(form_.space().mesh(), transfer.facet, form_.space().degree(), pieces)
                       .norm();
    if (eta.mor == 0) continue;
    const TransferLifting<dim>& most = *std::ranges::max_element(liftings, {}, &TransferLifting<dim>::norm);
    const double change = most.change(difference(u, stress, cell));
    evaluate(u, stress, cell, fields);
    const double norm = norm_of_difference(cell, fields);
    eta.str_mor =
        std::min(eta.str + most.norm(), std::sqrt(std::max(0.0, norm * norm + change)) +
                                            form_.data().initial_stress().remainder(cell).added_to(0)) +
        (eta.mor - most.norm());
  }
}

/// sigma_dis - sigma(u) on a cell, as a function of reference points.
template <int dim>
std::function<Tensor<dim>(const Point<dim>&)> Estimator<dim>::difference(std::span<const double> u,
                                                                         const Stress<dim>& stress,
                                                                         Index cell) const
{
  const int degree = form_.space().degree();
  CellFields fields;
  evaluate(u, stress, cell, fields);
  std::vector<double> phi(fem::polynomial_dimension(dim, degree));
  std::vector<Tensor<dim>> coefficients(phi.size(), Tensor<dim>::Zero());
  for (int q = 0; q < rule_.size(); ++q)
  {
    fem::orthonormal_values<dim>(degree, rule_.points[q], phi);
    for (std::size_t i = 0; i < phi.size(); ++i)
      coefficients[i] += rule_.weights[q] * phi[i] * fields.difference[q];
  }
  return [degree, phi, coefficients](const Point<dim>& x) mutable
  {
    fem::orthonormal_values<dim>(degree, x, phi);
    Tensor<dim> sum = Tensor<dim>::Zero();
    for (std::size_t i = 0; i < phi.size(); ++i) sum += phi[i] * coefficients[i];
    return sum;
  };
}

/// A segment between bodies gives half of its square to each of its two cells, which may be on another rank.
template <int dim>
void Estimator<dim>::contact_terms(std::span<const double> u, const Stress<dim>& stress,
                                   Estimate& result) const
{
  std::vector<Index> touched;
  const auto is_own = [&](const contact::SegmentSide<dim>& side)
  { return side.facet.cell < static_cast<Index>(result.cells.size()); };
  const auto add = [&](Index cell, double share, const ContactSquares& squares)  // a cell may get several
  {
    BoundComponents& eta = result.cells[cell];
    eta.cnt += share * squares.cnt;
    eta.frc += share * squares.frc;
    eta.lin2n += share * squares.lin2n;
    eta.lin2t += share * squares.lin2t;
    eta.reg2n += share * squares.reg2n;
    eta.reg2t += share * squares.reg2t;
    touched.push_back(cell);
  };
  const std::span<const contact::ContactSegment<dim>> segments = form_.segments();
  std::vector<ContactSquares> squares(segments.size());
  parallel_for(
      segments.size(),
      [&](std::size_t k)
      {
        if (is_own(segments[k].slave) || (segments[k].master && is_own(*segments[k].master)))
          squares[k] = contact_(static_cast<int>(k), u, stress.tractions);
      },
      1);
  for (std::size_t k = 0; k < segments.size(); ++k)
    segments[k].for_each_side(
        [&](const contact::SegmentSide<dim>& side)
        {
          if (is_own(side)) add(side.facet.cell, segments[k].master ? 0.5 : 1, squares[k]);
        });
  sort_and_unite(touched);
  for (const Index cell : touched)
    for (const Component& c : all_components)
      if (c.is_on_contact()) result.cells[cell].*c.value = std::sqrt(result.cells[cell].*c.value);
}

template <int dim>
AffineFields<dim> Estimator<dim>::algebraic_remainder(std::span<const double> u,
                                                      const Stress<dim>& stress) const
{
  if (!std::isfinite(friedrichs_.value)) return {};
  return algebraic_.body_force(algebraic_.residual(u, stress.tractions.running()), stress.patches);
}

template class Estimator<2>;
template class Estimator<3>;

}  // namespace tribound::certify
