#include "contact/rigid_motion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "contact/body.h"
#include "contact/body_support.h"
#include "contact/cone.h"
#include "fem/quadrature.h"
#include "mesh/geometry.h"

namespace tribound
{

namespace
{

template <int dim>
using Coefficients = typename RigidModes<dim>::Coefficients;

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
    const Point<3> first = cross(n, Point<3>::Unit(smallest)).normalized();
    const Point<3> second = cross(n, first);
    for (int i = 0; i < 8; ++i)
      directions.push_back(std::cos(i * std::numbers::pi / 4) * first +
                           std::sin(i * std::numbers::pi / 4) * second);
  }
  return directions;
}

/// Whether Coulomb friction obeys its coefficient or holds whatever is pressed.
enum class CoulombFriction
{
  limited,
  unlimited
};

/// One body with what holds and drives it.
template <int dim>
class BodyCheck
{
 public:
  BodyCheck(const Problem<dim>& problem, const Mesh<dim>& mesh, const Body<dim>& body, std::string name)
      : problem_(problem), mesh_(mesh), body_(body), support_(problem, mesh, body), name_(std::move(name))
  {
  }

  /// Throws InputError for a motion that nothing stops.
  void check_held() const;
  /// Throws InputError for loads that contact cannot balance; work(z) = L(z) up to `round_off`.
  void check_balanced(const Coefficients<dim>& work, double round_off, int quadrature_degree) const;

 private:
  /// The work in each motion of the contact forces, one column for each generator of their cone. Tresca
  /// friction is unlimited in both cases: its bound does not scale with the pressure.
  [[nodiscard]] Eigen::MatrixXd contact_cone(const MotionBasis& motions, CoulombFriction coulomb) const;
  /// Integral of s |z^t| over Tresca contact, the most that its friction can hold back; infinite where other
  /// friction resists z.
  [[nodiscard]] double tresca_capacity(const Coefficients<dim>& motion, int quadrature_degree) const;
  /// What to do against motions that nothing stops, with a component for each of them.
  [[nodiscard]] std::string hint(std::span<const Coefficients<dim>> free) const;
  [[noreturn]] void fail(const Coefficients<dim>& motion, const std::string& reason) const;

  const Problem<dim>& problem_;
  const Mesh<dim>& mesh_;
  const Body<dim>& body_;
  BodySupport<dim> support_;
  std::string name_;
};

template <int dim>
std::string BodyCheck<dim>::hint(std::span<const Coefficients<dim>> free) const
{
  std::vector<std::string> remedies;
  for (const Coefficients<dim>& z : free)
    if (const std::optional<Remedy> remedy = support_.remedy(z))
      if (const std::string words = describe(*remedy); std::ranges::find(remedies, words) == remedies.end())
        remedies.push_back(words);
  const auto has_smooth_contact = [&](const BoundaryFacet& facet)
  {
    const auto& contact = problem_.boundary(facet.tag).contact;
    return contact && !has_friction(contact->friction);
  };
  const bool friction_may_help = std::ranges::any_of(body_.facets, has_smooth_contact);
  return fmt::format(
      "fix a displacement component that such a motion would change{} (symmetry: the component normal to the "
      "plane of symmetry){}",
      remedies.empty() ? ", on a boundary of this body"
                       : fmt::format(", for example {}", fmt::join(remedies, ", ")),
      friction_may_help ? ", or give its contact friction" : "");
}

template <int dim>
void BodyCheck<dim>::check_held() const
{
  const std::vector<Coefficients<dim>> free = readable_basis<dim>(support_.left_by_contact(true));
  if (free.empty()) return;
  std::vector<std::string> motions;
  motions.reserve(free.size());
  for (const Coefficients<dim>& z : free) motions.push_back(body_.modes.describe(z));
  const auto named = std::ranges::find_if(
      problem_.boundaries(), [](const auto& boundary) { return boundary.where.line > 0; });  // not a --set
  const std::string file = named == problem_.boundaries().end() ? "" : named->where.file;
  throw InputError({.file = file, .key = "boundary"},
                   fmt::format("nothing stops {} from: {}", name_, fmt::join(motions, "; ")), hint(free));
}

template <int dim>
Eigen::MatrixXd BodyCheck<dim>::contact_cone(const MotionBasis& motions, CoulombFriction limit) const
{
  std::vector<Eigen::VectorXd> generators;
  const auto add = [&](const Point<dim>& push, const Point<dim>& x)
  {
    const Eigen::VectorXd work = motions.transpose() * (body_.modes.at(x).transpose() * push);
    if (work.norm() > 1e-12) generators.push_back(work.normalized());
  };
  support_.for_each_facet_vertex(
      [&](const BoundaryCondition<dim>& condition, const Point<dim>& n, const Point<dim>& x)
      {
        if (!condition.contact) return;
        const FrictionLaw& law = condition.contact->friction;
        add(n, x);
        if (!has_friction(law)) return;
        const auto* coulomb = std::get_if<Coulomb>(&law);
        const double around = dim == 2 ? 1 : std::cos(std::numbers::pi / 8);  // the circle in the octagon
        for (const Point<dim>& t : tangents<dim>(n))
          add(coulomb && limit == CoulombFriction::limited ? Point<dim>(n + coulomb->coefficient / around * t)
                                                           : t,
              x);
      });
  Eigen::MatrixXd cone(motions.cols(), static_cast<Eigen::Index>(generators.size()));
  for (Eigen::Index j = 0; j < cone.cols(); ++j) cone.col(j) = generators[j];
  return cone;
}

template <int dim>
double BodyCheck<dim>::tresca_capacity(const Coefficients<dim>& motion, int quadrature_degree) const
{
  const Quadrature<dim - 1> rule = quadrature<dim - 1>(quadrature_degree);
  double capacity = 0;
  for (const BoundaryFacet& facet : body_.facets)
  {
    const auto& contact = problem_.boundary(facet.tag).contact;
    if (!contact || !has_friction(contact->friction)) continue;
    const auto* tresca = std::get_if<Tresca>(&contact->friction);
    const CellMap<dim> map = cell_map(mesh_, facet.cell);
    const FacetGeometry<dim> geometry = facet_geometry(mesh_, facet.cell, facet.local);
    const double scale = geometry.measure * (dim - 1);  // |F| / |reference facet|
    for (int q = 0; q < rule.size(); ++q)
    {
      const Point<dim> x = map(facet_to_cell<dim>(facet.local, rule.points[q]));
      const Point<dim> z = body_.modes.at(x) * motion;
      const double z_t = (z - z.dot(geometry.normal) * geometry.normal).norm();
      if (!tresca && z_t > 1e-12 * motion.norm()) return HUGE_VAL;
      if (tresca) capacity += scale * rule.weights[q] * threshold_at<dim>(*tresca, x) * z_t;
    }
  }
  return capacity;
}

template <int dim>
void BodyCheck<dim>::fail(const Coefficients<dim>& motion, const std::string& reason) const
{
  const auto facet = std::ranges::find_if(
      body_.facets, [&](const BoundaryFacet& f) { return problem_.boundary(f.tag).contact.has_value(); });
  throw InputError(problem_.boundary(facet->tag).where,
                   fmt::format("contact cannot hold {}: the loads drive it into {}; {}", name_,
                               body_.modes.describe(motion), reason),
                   "fix a displacement component that this motion would change, or mend the loads "
                   "(tractions are forces on the body, a pressure acts against the outward normal)");
}

template <int dim>
void BodyCheck<dim>::check_balanced(const Coefficients<dim>& work, double round_off,
                                    int quadrature_degree) const
{
  constexpr double relative = 1e-8;
  const MotionBasis motions = support_.left_by_displacements();  // what contact alone has to stop
  const Eigen::VectorXd c = motions.transpose() * work;          // L(z) for each of them
  if (motions.cols() == 0 || c.norm() <= round_off) return;

  const double tolerance = relative * c.norm() + round_off;
  const Eigen::VectorXd lifted = remainder_outside_cone(contact_cone(motions, CoulombFriction::unlimited), c);
  if (lifted.norm() > tolerance) fail(motions * lifted, "contact only pushes");

  // Motions that slide along all of the contact boundary, and the one in which the loads do most work.
  const Eigen::MatrixXd pressed = support_.contact_gram(false);
  const MotionBasis sliding = motions * null_space(motions.transpose() * pressed * motions, pressed.trace());
  const Coefficients<dim> slide = sliding * (sliding.transpose() * work);
  const Eigen::VectorXd slipped = remainder_outside_cone(contact_cone(motions, CoulombFriction::limited), c);
  if (slipped.norm() > tolerance)
    fail(slide.norm() > tolerance ? slide : Coefficients<dim>(motions * slipped),
         "friction is too weak for the load along the contact boundary");

  if (slide.norm() <= tolerance) return;
  const double driving = slide.dot(work);
  const double capacity = tresca_capacity(slide, quadrature_degree);
  if (driving > (1 + relative) * capacity)
    fail(slide, fmt::format("the friction threshold takes up only {:.3g} % of their work in it",
                            100 * capacity / driving));
}

}  // namespace

template <int dim>
void check_rigid_motions(const Problem<dim>& problem, const LagrangeSpace<dim>& space,
                         std::span<const double> load)
{
  constexpr double relative_round_off = 1e-11;
  const std::vector<Body<dim>> bodies = find_bodies(space);
  const std::vector<Point<dim>> points = space.node_points();
  for (const Body<dim>& body : bodies)
  {
    const BodyCheck<dim> check(problem, space.mesh(), body, describe(body, problem, bodies.size() > 1));
    check.check_held();

    Coefficients<dim> work = Coefficients<dim>::Zero();  // L(z) for each rigid motion z
    double terms = 0;
    for (const Index i : body.nodes)
    {
      const Point<dim> force(load.data() + static_cast<std::size_t>(dim) * i);
      work += body.modes.at(points[i]).transpose() * force;
      terms += force.norm();
    }
    check.check_balanced(work, relative_round_off * terms, data_quadrature_degree(space.degree()));
  }
}

template void check_rigid_motions(const Problem<2>&, const LagrangeSpace<2>&, std::span<const double>);
template void check_rigid_motions(const Problem<3>&, const LagrangeSpace<3>&, std::span<const double>);

}  // namespace tribound
