#include "tribound/certify/bound/estimate.h"

#include <array>
#include <cmath>
#include <iterator>

#include "tribound/base/norm.h"
#include "tribound/base/parallel.h"
#include "tribound/contact/nitsche/elasticity.h"

namespace tribound::certify
{

namespace
{

/// Component by component the root of the sum of squares over all ranks, and both totals with what no cell
/// has.
void add_up(Estimate& estimate, double quad, const Ranks& ranks)
{
  std::array<double, std::size(all_components) + 2> sums{};
  auto& total = sums[std::size(all_components)];
  auto& total_sharp = sums[std::size(all_components) + 1];
  for (const BoundComponents& cell : estimate.cells)
  {
    for (std::size_t i = 0; i < std::size(all_components); ++i)
      sums[i] += std::pow(cell.*all_components[i].value, 2);
    total += std::pow(cell.total(), 2);
    total_sharp += std::pow(cell.total_sharp(), 2);
  }
  ranks.sum(std::span(sums));
  for (std::size_t i = 0; i < std::size(all_components); ++i)
    estimate.global.*all_components[i].value = std::sqrt(sums[i]);
  estimate.global.quad = quad;
  estimate.total = std::sqrt(total) + quad;
  estimate.total_sharp = std::sqrt(total_sharp) + quad;
}

}  // namespace

template <int dim>
Estimator<dim>::Estimator(const contact::NitscheForm<dim>& form, ContactRule rule,
                          const std::optional<FriedrichsConstant>& known)
    : form_(form),
      data_(data_terms(form)),
      friedrichs_(known),
      contact_(form, rule),
      rule_(fem::quadrature<dim>(2 * form.space().degree())),
      stress_table_(form.space().degree(), rule_.points)
{
  if (data_.missed > 0 && !friedrichs_)
    friedrichs_ = friedrichs_constant(form.problem(), form.space().mesh());
  const fem::Tabulation<dim> table = form.space().basis().tabulate(rule_.points);
  const int n_points = rule_.size();
  gradient_.resize(static_cast<std::size_t>(dim) * table.n_nodes * n_points);
  for (int q = 0; q < n_points; ++q)
    for (int i = 0; i < table.n_nodes; ++i)
      for (int k = 0; k < dim; ++k)
        gradient_[(k * table.n_nodes + i) * n_points + q] = table.gradients_at(q)[i][k];
}

template <int dim>
Estimate Estimator<dim>::operator()(std::span<const double> u, const Stress<dim>& stress, int n_threads) const
{
  Estimate result;
  const mesh::Mesh<dim>& mesh = form_.space().mesh();
  result.cells.resize(mesh.n_owned_cells());
  for (std::size_t c = 0; c < result.cells.size(); ++c)
  {
    result.cells[c].osc = data_.osc[c];
    result.cells[c].neu = data_.neu[c];
  }
  mesh.ranks().together(
      [&]
      {
        stress_terms(u, stress, n_threads > 0 ? n_threads : max_threads(), result);
        contact_terms(u, stress, result);
      });
  add_up(result, data_.missed > 0 ? friedrichs_->value * data_.missed : 0, mesh.ranks());
  return result;
}

template <int dim>
BoundComponents Estimator<dim>::linearisation(const Stress<dim>& stress) const
{
  std::array<double, 3> sums{};
  auto& [lin1, lin2n, lin2t] = sums;
  for (const double x : stress.lin) lin1 += x * x;
  for (std::size_t k = 0; k < form_.n_owned_segments(); ++k)
  {
    const ContactSquares facet = contact_.linearisation(static_cast<int>(k), stress);
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

/// ||sigma_dis - sigma(u)||_T at quadrature points, which shares nothing with the way sigma_dis is made, and
/// ||sigma_lin||_T and ||sigma_reg||_T from their coefficients.
template <int dim>
void Estimator<dim>::stress_terms(std::span<const double> u, const Stress<dim>& stress, int n_threads,
                                  Estimate& result) const
{
  const fem::LagrangeSpace<dim>& space = form_.space();
  const mesh::Mesh<dim>& mesh = space.mesh();
  const int n_points = rule_.size();
  const auto on_thread = [&](int thread)
  {
    std::vector<double> dis(static_cast<std::size_t>(dim) * dim * n_points);
    std::vector<double> derivative(dis.size());  // [(a dim + k) n_points + q]: d_k u_a, reference coordinates
    const auto first = [&](int i)
    { return static_cast<Index>(std::int64_t{mesh.n_owned_cells()} * i / n_threads); };
    for (Index c = first(thread); c < first(thread + 1); ++c)
    {
      stress_table_.evaluate(make_sorted_cell(mesh, c), stress.dis_in(c), dis);
      const std::span<const Index> nodes = space.cell_nodes(c);
      std::ranges::fill(derivative, 0);
      for (int a = 0; a < dim; ++a)
        for (int k = 0; k < dim; ++k)
          for (std::size_t i = 0; i < nodes.size(); ++i)
          {
            const double value = u[static_cast<std::size_t>(dim) * nodes[i] + a];
            const double* const row = &gradient_[(k * nodes.size() + i) * n_points];
            double* const sum = &derivative[(a * dim + k) * n_points];
            for (int q = 0; q < n_points; ++q) sum[q] += value * row[q];
          }

      const mesh::CellMap<dim> map = cell_map(mesh, c);
      const problem::Material& material = form_.problem().material(mesh.region(c));
      double squares = 0;
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
        const Tensor<dim> discrete =
            contact::sigma<dim>(material, reference * map.inverse_transpose.transpose());
        squares += rule_.weights[q] * (equilibrated - discrete).squaredNorm();
      }
      result.cells[c].str = std::sqrt(map.det * squares);
      result.cells[c].lin1 = norm(stress.lin_in(c));
      result.cells[c].reg1 = norm(stress.reg_in(c));
    }
  };
  in_threads(n_threads, on_thread);
}

template <int dim>
void Estimator<dim>::contact_terms(std::span<const double> u, const Stress<dim>& stress,
                                   Estimate& result) const
{
  const auto segments = form_.segments();
  std::vector<Index> touched;
  for (std::size_t k = 0; k < form_.n_owned_segments(); ++k)  // squares first: a cell may have several
  {
    const ContactSquares squares = contact_(static_cast<int>(k), u, stress);
    BoundComponents& cell = result.cells[segments[k].slave.facet.cell];
    cell.cnt += squares.cnt;
    cell.frc += squares.frc;
    cell.lin2n += squares.lin2n;
    cell.lin2t += squares.lin2t;
    cell.reg2n += squares.reg2n;
    cell.reg2t += squares.reg2t;
    touched.push_back(segments[k].slave.facet.cell);
  }
  std::ranges::sort(touched);
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  for (const Index cell : touched)
    for (const Component& c : all_components)
      if (c.is_on_contact()) result.cells[cell].*c.value = std::sqrt(result.cells[cell].*c.value);
}

template class Estimator<2>;
template class Estimator<3>;

}  // namespace tribound::certify
