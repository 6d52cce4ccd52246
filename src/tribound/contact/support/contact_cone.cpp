#include "tribound/contact/support/contact_cone.h"

#include <cmath>
#include <numbers>

#include "tribound/contact/support/cone.h"
#include "tribound/mesh/geometry.h"

namespace tribound::contact
{

namespace
{

/// Unit vectors perpendicular to n: both in 2D, eight at equal angles in 3D.
template <int dim>
std::vector<Point<dim>> tangents(const Point<dim>& n)
{
  std::vector<Point<dim>> directions;
  if constexpr (dim == 2)
    directions = {Point<2>(-n[1], n[0]), Point<2>(n[1], -n[0])};
  else
  {
    Eigen::Index smallest = 0;
    n.cwiseAbs().minCoeff(&smallest);
    const Point<3> first = mesh::cross(n, Point<3>::Unit(smallest)).normalized();
    const Point<3> second = mesh::cross(n, first);
    for (int i = 0; i < 8; ++i)
      directions.push_back(std::cos(i * std::numbers::pi / 4) * first +
                           std::sin(i * std::numbers::pi / 4) * second);
  }
  return directions;
}

}  // namespace

template <int dim>
ContactCone<dim>::ContactCone(const NitscheForm<dim>& form, const Assembly<dim>& assembly,
                              const MotionBasis& motions, ConeFriction friction)
{
  std::vector<Eigen::VectorXd> generators;
  const auto add_corner = [&](const AssemblySegment&, const ContactSegment<dim>& segment, const Point<dim>& n,
                              const std::vector<int>& coefficients, const auto& jump)
  {
    const problem::FrictionCone law = problem::cone(segment.contact->law);
    if (law.glues() || law.is_bilateral) return;  // the motions satisfy it
    const Eigen::MatrixXd jumps = jump * motions(coefficients, Eigen::all);
    const auto add = [&](const Point<dim>& push)
    {
      const Eigen::VectorXd work = jumps.transpose() * push;
      if (work.norm() > 1e-12) generators.push_back(work.normalized());
    };
    add(n);
    if (!law.resists_sliding()) return;
    if (law.coefficient == 0 && friction == ConeFriction::no_strength) return;
    const bool holds =
        friction == ConeFriction::unlimited || (friction == ConeFriction::strong && law.strength != nullptr);
    for (const Point<dim>& t : tangents<dim>(n)) add(holds ? t : Point<dim>(n + law.coefficient * t));
    if (dim == 3 && !holds) round_.push_back({jumps, n, law.coefficient});
  };
  for_each_corner(form.space().mesh(), form.segments(), assembly, add_corner);
  generators_.resize(motions.cols(), static_cast<Eigen::Index>(generators.size()));
  for (Eigen::Index j = 0; j < generators_.cols(); ++j) generators_.col(j) = generators[j];
}

template <int dim>
std::optional<Eigen::VectorXd> ContactCone<dim>::steepest(const Eigen::VectorXd& r) const
{
  constexpr double perpendicular = 1e-10;  // of |r|
  double most = perpendicular * r.norm();
  std::optional<Eigen::VectorXd> result;
  for (const RoundCorner& corner : round_)
  {
    const Point<dim> z = corner.jumps * r;
    const Point<dim> z_t = z - z.dot(corner.normal) * corner.normal;
    if (z_t.norm() == 0) continue;
    const Point<dim> push = corner.normal + corner.coefficient / z_t.norm() * z_t;
    const Eigen::VectorXd work = corner.jumps.transpose() * push;
    if (work.norm() <= 1e-12 || work.dot(r) <= most * work.norm()) continue;
    most = work.dot(r) / work.norm();
    result = work.normalized();
  }
  return result;
}

template <int dim>
Eigen::VectorXd ContactCone<dim>::project_on_polar(const Eigen::VectorXd& b)
{
  constexpr int max_generators = 200;  // in addition to the initial ones; about 10 are usual
  constexpr double inside = 1e-9;      // of |b|
  for (int i = 0; i < max_generators; ++i)
  {
    Eigen::VectorXd r = project_on_polar_cone(generators_, b);
    if (r.norm() <= inside * b.norm()) return r;
    const std::optional<Eigen::VectorXd> outside = steepest(r);
    if (!outside) return r;
    generators_.conservativeResize(Eigen::NoChange, generators_.cols() + 1);
    generators_.rightCols(1) = *outside;
  }
  return Eigen::VectorXd::Zero(b.size());
}

template class ContactCone<2>;
template class ContactCone<3>;

}  // namespace tribound::contact
