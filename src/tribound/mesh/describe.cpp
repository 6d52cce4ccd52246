#include "tribound/mesh/describe.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tribound::mesh
{

std::string describe_point(std::span<const double> x)
{
  return fmt::format("({:.9g})", fmt::join(x, ", "));
}

}  // namespace tribound::mesh
