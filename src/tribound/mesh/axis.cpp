#include "tribound/mesh/axis.h"

#include <fmt/format.h>

#include <cmath>

#include "tribound/base/error.h"
#include "tribound/mesh/describe.h"
#include "tribound/mesh/geometry.h"

namespace tribound::mesh
{

template <int dim>
void meet_axis(MeshData<dim>& data)
{
  if (dim == 3)
    throw InputError(data.source, "the mesh is 3D, and the case says model = \"axisymmetric\"",
                     "a mesh of the meridian: x is the distance from the axis, y runs along it");
  const double tolerance = 1e-10 * bounding_box<dim>(data.vertices).longest_edge();
  for (Point<dim>& x : data.vertices)
  {
    if (x[0] < -tolerance)
      throw InputError(data.source,
                       fmt::format("the vertex {} lies on the other side of the axis x = 0", describe(x)),
                       "one half of the section: x >= 0 is the distance from the axis");
    if (std::abs(x[0]) <= tolerance) x[0] = 0;
  }
}

template void meet_axis(MeshData<2>&);
template void meet_axis(MeshData<3>&);

}  // namespace tribound::mesh
