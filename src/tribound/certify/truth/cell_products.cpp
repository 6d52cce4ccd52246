#include "tribound/certify/truth/cell_products.h"

#include <algorithm>

#include "tribound/fem/evaluation.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

template <int dim>
CellProducts<dim>::CellProducts(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space)
    : space_(space), reference_(fem::gradient_products(space.basis()))
{
  if constexpr (dim == 2)
    if (problem.is_axisymmetric())
    {
      rules_.emplace(space.mesh(), 2 * space.degree());
      for (int i = 0; i < rules_->size(); ++i) tables_.push_back(space.basis().tabulate((*rules_)[i].points));
    }
}

template <int dim>
void CellProducts<dim>::operator()(Index cell, int component, std::span<double> block) const
{
  if (rules_) return on_meridian(cell, component == 0, block);
  const mesh::CellMap<dim> map = mesh::cell_map(space_.mesh(), cell);
  const Tensor<dim> metric = map.det * (map.inverse_transpose.transpose() * map.inverse_transpose);
  for (std::size_t k = 0; k < block.size(); ++k) block[k] = metric.cwiseProduct(reference_[k]).sum();
}

template <int dim>
void CellProducts<dim>::on_meridian(Index cell, bool is_radial, std::span<double> block) const
{
  std::ranges::fill(block, 0.0);
  if constexpr (dim == 2)
  {
    const mesh::CellMap<dim> map = mesh::cell_map(space_.mesh(), cell);
    const fem::Tabulation<dim>& table = tables_[rules_->number(cell)];
    const auto n = static_cast<std::size_t>(table.n_nodes);
    std::vector<Point<dim>> gradients(n);
    for (const auto& [q, x, dx] : fem::cell_points(map, rules_->of_cell(cell)))
    {
      const std::span<const double> phi = table.values_at(q);
      for (std::size_t i = 0; i < n; ++i) gradients[i] = map.inverse_transpose * table.gradients_at(q)[i];
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
          block[i * n + j] +=
              dx * (x[0] * gradients[i].dot(gradients[j]) + (is_radial ? phi[i] * phi[j] / x[0] : 0));
    }
  }
}

template class CellProducts<2>;
template class CellProducts<3>;

}  // namespace tribound::certify
