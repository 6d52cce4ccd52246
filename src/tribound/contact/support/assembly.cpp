#include "tribound/contact/support/assembly.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "tribound/mesh/describe.h"

namespace tribound::contact
{

namespace
{

/// Sets centre and size of the modes.
template <int dim>
void measure(const mesh::Mesh<dim>& mesh, Assembly<dim>& assembly)
{
  RigidModes<dim>& modes = assembly.modes;
  std::size_t n = 0;
  for (const Body<dim>& body : assembly.bodies)
  {
    modes.centre += static_cast<double>(body.vertices.size()) * body.centre;
    n += body.vertices.size();
  }
  modes.centre /= static_cast<double>(n);
  modes.size = 0;
  for (const Body<dim>& body : assembly.bodies)
    for (const Index v : body.vertices)
      modes.size = std::max(modes.size, (mesh.vertex(v) - modes.centre).norm());
}

/// For each body, the first body to which segments connect it.
template <int dim>
std::vector<int> connect(std::size_t n_bodies, std::span<const ContactSegment<dim>> segments,
                         std::span<const int> body_of)
{
  std::vector<int> first(n_bodies);
  std::iota(first.begin(), first.end(), 0);
  const auto root = [&](int b)
  {
    while (first[b] != b) b = first[b] = first[first[b]];
    return b;
  };
  for (const ContactSegment<dim>& segment : segments)
  {
    if (!segment.master) continue;
    const auto [low, high] =
        std::minmax({root(body_of[segment.slave.number]), root(body_of[segment.master->number])});
    first[high] = low;
  }
  for (std::size_t b = 0; b < n_bodies; ++b) first[b] = root(static_cast<int>(b));
  return first;
}

}  // namespace

template <int dim>
std::vector<int> Assembly<dim>::coefficients(int b)
{
  std::vector<int> numbers(RigidModes<dim>::n_modes);
  std::iota(numbers.begin(), numbers.end(), RigidModes<dim>::n_modes * b);
  return numbers;
}

// In the coordinates (z_1, z_2 - z_1, z_3 - z_1, ...), the motions that are left after the elimination of all
// differences move all bodies together.
template <int dim>
std::vector<Eigen::VectorXd> Assembly<dim>::readable_basis(const MotionBasis& motions) const
{
  constexpr int n = RigidModes<dim>::n_modes;
  Eigen::MatrixXd relative = motions;
  for (int b = 1; b < static_cast<int>(bodies.size()); ++b)
    relative.middleRows<n>(n * b) -= motions.topRows<n>();
  std::vector<Eigen::VectorXd> basis = contact::readable_basis<dim>(relative);
  for (Eigen::VectorXd& z : basis)
  {
    for (int b = 1; b < static_cast<int>(bodies.size()); ++b) z.segment<n>(n * b) += z.head<n>();
    Eigen::Index largest = 0;
    z.cwiseAbs().maxCoeff(&largest);
    if (bodies.size() > 1 && z[largest] < 0) z = -z;
  }
  return basis;
}

template <int dim>
std::string Assembly<dim>::describe(const problem::Problem<dim>& problem, bool several) const
{
  if (bodies.size() == 1) return contact::describe(bodies[0], problem, several);
  std::vector<std::string> names;
  for (const Body<dim>& body : bodies) names.push_back(contact::describe(body, problem, true));
  return fmt::format("{} in contact", fmt::join(names, ", "));
}

template <int dim>
std::string Assembly<dim>::describe(const problem::Problem<dim>& problem, const Eigen::VectorXd& motion) const
{
  constexpr double negligible = 1e-6;
  const auto n_bodies = static_cast<int>(bodies.size());
  const auto moves_along = [&](int b)
  { return (part(motion, b) - part(motion, 0)).norm() <= negligible * motion.norm(); };
  bool together = true;
  for (int b = 1; b < n_bodies; ++b) together = together && moves_along(b);
  if (together) return modes.describe(part(motion, 0));
  std::vector<std::string> parts;
  for (int b = 0; b < n_bodies; ++b)
    if (part(motion, b).norm() > negligible * motion.norm())
      parts.push_back(fmt::format("{} of {}", modes.describe(part(motion, b)),
                                  contact::describe(bodies[b], problem, true)));
  return fmt::format("{}", fmt::join(parts, " with "));
}

template <int dim>
MotionJump<dim>::MotionJump(const mesh::Mesh<dim>& mesh, const Assembly<dim>& assembly,
                            const AssemblySegment& entry, const ContactSegment<dim>& segment)
    : modes_(assembly.modes),
      slave_(simplex_map(mesh, segment.slave)),
      coefficients_(Assembly<dim>::coefficients(entry.slave))
{
  if (!entry.master) return;
  master_ = simplex_map(mesh, *segment.master);
  const std::vector<int> of_master = Assembly<dim>::coefficients(*entry.master);
  coefficients_.insert(coefficients_.end(), of_master.begin(), of_master.end());
}

template <int dim>
Eigen::Matrix<double, dim, Eigen::Dynamic> MotionJump<dim>::operator()(const Point<dim - 1>& s) const
{
  constexpr int n = RigidModes<dim>::n_modes;
  Eigen::Matrix<double, dim, Eigen::Dynamic> result(dim, static_cast<Eigen::Index>(coefficients_.size()));
  result.template leftCols<n>() = modes_.at(slave_(s));
  if (master_) result.template rightCols<n>() = -modes_.at((*master_)(s));
  return result;
}

template <int dim>
std::vector<Assembly<dim>> find_assemblies(const fem::LagrangeSpace<dim>& space,
                                           std::span<const ContactSegment<dim>> segments)
{
  std::vector<Body<dim>> bodies = find_bodies(space);
  std::vector<int> body_of(space.mesh().boundary().size());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (const std::size_t number : bodies[b].numbers) body_of[number] = static_cast<int>(b);

  const std::vector<int> first = connect<dim>(bodies.size(), segments, body_of);
  std::vector<Assembly<dim>> assemblies;
  std::vector<std::pair<std::size_t, int>> position(bodies.size());  // assembly, number in it
  for (std::size_t b = 0; b < bodies.size(); ++b)
  {
    if (first[b] == static_cast<int>(b)) assemblies.emplace_back();
    const std::size_t k = first[b] == static_cast<int>(b) ? assemblies.size() - 1 : position[first[b]].first;
    position[b] = {k, static_cast<int>(assemblies[k].bodies.size())};
    assemblies[k].bodies.push_back(std::move(bodies[b]));
  }
  for (Assembly<dim>& assembly : assemblies) measure(space.mesh(), assembly);
  for (std::size_t k = 0; k < segments.size(); ++k)
  {
    const auto& [assembly, slave] = position[body_of[segments[k].slave.number]];
    std::optional<int> master;
    if (segments[k].master) master = position[body_of[segments[k].master->number]].second;
    assemblies[assembly].segments.push_back({k, slave, master});
  }
  return assemblies;
}

template struct Assembly<2>;
template struct Assembly<3>;
template class MotionJump<2>;
template class MotionJump<3>;
template std::vector<Assembly<2>> find_assemblies(const fem::LagrangeSpace<2>&,
                                                  std::span<const ContactSegment<2>>);
template std::vector<Assembly<3>> find_assemblies(const fem::LagrangeSpace<3>&,
                                                  std::span<const ContactSegment<3>>);

}  // namespace tribound::contact
