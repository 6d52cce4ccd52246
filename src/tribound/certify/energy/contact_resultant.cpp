#include "tribound/certify/energy/contact_resultant.h"

namespace tribound::certify
{

template <int dim>
RigidMotion<dim> rotation(const Point<dim>& point, const Point<dim>& axis)
{
  RigidMotion<dim> motion{.centre = point};
  if constexpr (dim == 2)
    motion.spin << 0, -1, 1, 0;
  else
    motion.spin << 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0;
  return motion;
}

template RigidMotion<2> rotation(const Point<2>&, const Point<2>&);
template RigidMotion<3> rotation(const Point<3>&, const Point<3>&);

}  // namespace tribound::certify
