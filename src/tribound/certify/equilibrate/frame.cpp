#include "tribound/certify/equilibrate/frame.h"

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
Frame<dim> make_frame(const mesh::Mesh<dim>& mesh, Index c)
{
  Frame<dim> frame;
  const mesh::Cell<dim>& cell = mesh.cell(c);
  for (int i = 0; i <= dim; ++i) frame.local[i] = i;
  std::ranges::sort(frame.local, {}, [&](int i) { return cell[i]; });
  for (int i = 0; i <= dim; ++i) frame.vertices[i] = cell[frame.local[i]];

  frame.origin = mesh.vertex(frame.vertices[0]);
  frame.jacobian = jacobian_of(mesh, frame.vertices);
  frame.inverse = frame.jacobian.inverse();
  frame.det = std::abs(frame.jacobian.determinant());
  frame.grad[0].setZero();
  for (int j = 0; j < dim; ++j)
  {
    frame.grad[j + 1] = frame.inverse.row(j).transpose();
    frame.grad[0] -= frame.grad[j + 1];
  }
  for (int i = 0; i <= dim; ++i) frame.grad_norm[i] = frame.grad[i].norm();
  return frame;
}

template Tensor<2> jacobian_of<2>(const mesh::Mesh<2>&, const mesh::Cell<2>&);
template Tensor<3> jacobian_of<3>(const mesh::Mesh<3>&, const mesh::Cell<3>&);
template Frame<2> make_frame<2>(const mesh::Mesh<2>&, Index);
template Frame<3> make_frame<3>(const mesh::Mesh<3>&, Index);

}  // namespace tribound::certify
