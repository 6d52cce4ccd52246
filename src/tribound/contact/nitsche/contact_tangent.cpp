#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "tribound/base/parallel.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::contact
{

template <int dim>
Eigen::MatrixXd NitscheForm<dim>::tested_derivative(Linearisation kind, std::span<const double> u,
                                                    std::size_t k, double delta) const
{
  constexpr int squared = dim * dim;
  const Columns at_u = augmented_traction(u, k);
  Eigen::Matrix<double, squared, Eigen::Dynamic> weighted(squared, n_segment_points());
  for (int q = 0; q < n_segment_points(); ++q)
    Eigen::Map<Tensor<dim>>(weighted.col(q).data()) =
        -contact_points(k)[q].weight * traction_derivative(kind, k, q, at_u.col(q), delta);
  const Eigen::Matrix<double, squared, Eigen::Dynamic> tested = weighted * nodes_.products();
  const Eigen::Index n = nodes_.values().rows();
  Eigen::MatrixXd result(dim * n, dim * n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index l = 0; l < n; ++l)
      result.template block<dim, dim>(dim * i, dim * l) =
          Eigen::Map<const Tensor<dim>>(tested.col(i * n + l).data());
  return result;
}

template <int dim>
void NitscheForm<dim>::add_tangent_block(Linearisation kind, std::span<const double> u, std::size_t k,
                                         double delta, Eigen::Ref<Eigen::MatrixXd> block) const
{
  const Eigen::MatrixXd of_nodes = tested_derivative(kind, u, k, delta);
  if (of_nodes.isZero(0)) return;  // open
  const fem::LagrangeBasis<dim>& basis = space_->basis();
  const SegmentValues<dim> on_segment = at_nodes(k);
  const Eigen::Index n = of_nodes.rows() / dim;
  Eigen::MatrixXd tested = Eigen::MatrixXd::Zero(block.rows(), of_nodes.cols());
  Eigen::MatrixXd derivative(of_nodes.cols(), block.cols());  // (dim l + b, j): P_b(phi_j) at node l
  Eigen::Index row = 0;
  Eigen::Index column = 0;
  for (const auto& side : on_segment.sides())
    for (int i = 0; i < basis.n_nodes(); ++i, column += dim)
    {
      for (int l = 0; l < n; ++l)
        derivative.template block<dim, dim>(dim * l, column) = on_segment.augmented_derivative(side, i, l);
      if (basis.node(i)[side.side->facet.local] > 0) continue;  // phi_i vanishes on the facet
      for (int l = 0; l < n; ++l)                               // phi_i = sum_l phi_i(node l) theta_l
        tested.template middleRows<dim>(row) +=
            side.side->sign * side.table->values_at(l)[i] * of_nodes.template middleRows<dim>(dim * l);
      row += dim;
    }
  block.noalias() += tested * derivative;
}

template <int dim>
auto NitscheForm<dim>::tangent_blocks() const -> std::vector<TangentBlock>
{
  const auto facets = [](const ContactSegment<dim>& segment)
  {
    return std::pair(segment.slave.number,
                     segment.master ? std::optional(segment.master->number) : std::nullopt);
  };
  const fem::LagrangeBasis<dim>& basis = space_->basis();
  std::vector<TangentBlock> blocks;
  std::size_t position = 0;
  for (std::size_t k = 0; k < segments_.size(); ++k)
  {
    if (k > 0 && facets(segments_[k]) == facets(segments_[k - 1]))
    {
      blocks.back().last = k + 1;
      continue;
    }
    TangentBlock block{k, k + 1, position, 0, 0};
    segments_[k].for_each_side(
        [&](const SegmentSide<dim>& side)
        {
          block.n_columns += dim * basis.n_nodes();
          for (int i = 0; i < basis.n_nodes(); ++i)
            if (basis.node(i)[side.facet.local] == 0) block.n_rows += dim;
        });
    blocks.push_back(block);
    position = block.end();
  }
  return blocks;
}

template <int dim>
algebra::Triplets NitscheForm<dim>::contact_pattern() const
{
  const fem::LagrangeBasis<dim>& basis = space_->basis();
  const std::vector<TangentBlock> blocks = tangent_blocks();
  algebra::Triplets pattern;
  pattern.reserve(blocks.empty() ? 0 : blocks.back().end());
  std::vector<int> rows;
  std::vector<int> columns;
  const auto add = [&](Index node, std::vector<int>& dofs)
  {
    for (int a = 0; a < dim; ++a) dofs.push_back(constraints_.fixed[dim * node + a] ? -1 : dim * node + a);
  };
  for (const TangentBlock& block : blocks)
  {
    rows.clear();
    columns.clear();
    segments_[block.first].for_each_side(
        [&](const SegmentSide<dim>& side)
        {
          const std::span<const Index> nodes = space_->cell_nodes(side.facet.cell);
          for (int i = 0; i < basis.n_nodes(); ++i)
          {
            add(nodes[i], columns);
            if (basis.node(i)[side.facet.local] == 0) add(nodes[i], rows);
          }
        });
    for (const int column : columns)
      for (const int row : rows) pattern.add(row, column, 0);
  }
  return pattern;
}

template <int dim>
std::vector<double> NitscheForm<dim>::contact_tangent_values(Linearisation kind, std::span<const double> u,
                                                             double delta) const
{
  const std::vector<TangentBlock> blocks = tangent_blocks();
  std::vector<double> values(blocks.empty() ? 0 : blocks.back().end());
  parallel_for(blocks.size(),
               [&](std::size_t g)
               {
                 const auto& [first, last, position, n_rows, n_columns] = blocks[g];
                 Eigen::Map<Eigen::MatrixXd> block(values.data() + position, n_rows, n_columns);
                 for (std::size_t k = first; k < last; ++k) add_tangent_block(kind, u, k, delta, block);
               });
  return values;
}

template <int dim>
algebra::Triplets NitscheForm<dim>::contact_tangent(Linearisation kind, std::span<const double> u,
                                                    double delta) const
{
  algebra::Triplets entries = contact_pattern();
  entries.values = contact_tangent_values(kind, u, delta);
  return entries;
}

template algebra::Triplets NitscheForm<2>::contact_pattern() const;
template std::vector<double> NitscheForm<2>::contact_tangent_values(Linearisation, std::span<const double>,
                                                                    double) const;
template algebra::Triplets NitscheForm<2>::contact_tangent(Linearisation, std::span<const double>,
                                                           double) const;
template algebra::Triplets NitscheForm<3>::contact_pattern() const;
template std::vector<double> NitscheForm<3>::contact_tangent_values(Linearisation, std::span<const double>,
                                                                    double) const;
template algebra::Triplets NitscheForm<3>::contact_tangent(Linearisation, std::span<const double>,
                                                           double) const;

}  // namespace tribound::contact
