#include "tribound/certify/equilibrate/sorted_cell.h"

#include <Eigen/LU>
#include <cmath>

namespace tribound::certify
{

template <int dim>
Tensor<dim> jacobian_of(const mesh::Mesh<dim>& mesh, const mesh::Cell<dim>& vertices)
{
  Tensor<dim> jacobian;
  for (int j = 0; j < dim; ++j) jacobian.col(j) = mesh.vertex(vertices[j + 1]) - mesh.vertex(vertices[0]);
  return jacobian;
}

template <int dim>
SortedCell<dim> make_sorted_cell(const mesh::Mesh<dim>& mesh, Index c)
{
  SortedCell<dim> sorted;
  const mesh::Cell<dim>& cell = mesh.cell(c);
  for (int i = 0; i <= dim; ++i) sorted.local[i] = i;
  std::ranges::sort(sorted.local, {}, [&](int i) { return cell[i]; });
  for (int i = 0; i <= dim; ++i) sorted.vertices[i] = cell[sorted.local[i]];

  sorted.origin = mesh.vertex(sorted.vertices[0]);
  sorted.jacobian = jacobian_of(mesh, sorted.vertices);
  sorted.inverse = sorted.jacobian.inverse();
  sorted.det = std::abs(sorted.jacobian.determinant());
  sorted.grad[0].setZero();
  for (int j = 0; j < dim; ++j)
  {
    sorted.grad[j + 1] = sorted.inverse.row(j).transpose();
    sorted.grad[0] -= sorted.grad[j + 1];
  }
  for (int i = 0; i <= dim; ++i) sorted.grad_norm[i] = sorted.grad[i].norm();
  return sorted;
}

template Tensor<2> jacobian_of<2>(const mesh::Mesh<2>&, const mesh::Cell<2>&);
template Tensor<3> jacobian_of<3>(const mesh::Mesh<3>&, const mesh::Cell<3>&);
template SortedCell<2> make_sorted_cell<2>(const mesh::Mesh<2>&, Index);
template SortedCell<3> make_sorted_cell<3>(const mesh::Mesh<3>&, Index);

}  // namespace tribound::certify
