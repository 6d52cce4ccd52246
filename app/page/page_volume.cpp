#include "app/page/page_volume.h"

#include <array>

#include "app/page/page_surface.h"
#include "tribound/fem/evaluation.h"
#include "tribound/io/fields/vtu.h"
#include "tribound/mesh/geometry.h"

namespace tribound::app
{

Volume sample_volume(const contact::NitscheForm<3>& form, std::span<const double> u,
                     const certify::Stress<3>& stress)
{
  const mesh::Mesh<3>& mesh = form.space().mesh();
  const fem::LagrangeSpace<3> corners(mesh, 1);
  const fem::Tabulation<3> at_corners = form.space().basis().tabulate(corners.basis().node_points());
  const io::TensorField<3> sigma = io::equilibrated_stress_field(corners, stress);
  const std::size_t n = corners.n_nodes();
  Volume volume;
  volume.displacement.resize(3 * n);
  volume.stress.assign(stress_entries<3>.size(), std::vector<double>(n));
  for (const Point<3>& x : corners.node_points())
    volume.points.insert(volume.points.end(), x.begin(), x.end());
  volume.bodies.resize(n);
  const std::vector<int> body_of = mesh::connected_parts(mesh.topology());
  std::vector<double> weight(n);
  std::array<Tensor<3>, 4> values;
  for (Index cell = 0; cell < mesh.n_cells(); ++cell)
  {
    sigma.at_nodes(cell, values);
    const double det = mesh::cell_map(mesh, cell).det;
    for (int i = 0; i < 4; ++i)
    {
      const Index vertex = corners.cell_nodes(cell)[i];
      volume.cells.push_back(vertex);
      volume.bodies[vertex] = body_of[cell];
      weight[vertex] += det;
      const std::array<double, 6> components = io::symmetric_part<3>(values[i], 0.0);
      for (std::size_t s = 0; s < components.size(); ++s) volume.stress[s][vertex] += det * components[s];
      const Point<3> at_vertex = fem::value_at<3>(form.space().cell_nodes(cell), u, at_corners.values_at(i));
      for (int c = 0; c < 3; ++c) volume.displacement[3 * vertex + c] = at_vertex[c];
    }
  }
  for (std::vector<double>& component : volume.stress)
    for (std::size_t v = 0; v < n; ++v) component[v] /= weight[v];
  return volume;
}

}  // namespace tribound::app
