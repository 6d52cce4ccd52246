#include "tribound/contact/support/assembly_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/contact/support/cone.h"
#include "tribound/contact/support/contact_cone.h"
#include "tribound/mesh/geometry.h"

namespace tribound::contact
{

namespace
{

/// The rule on the halves (2D) or quarters (3D) of the facet.
template <int k>
fem::Quadrature<k> on_halves(const fem::Quadrature<k>& rule)
{
  fem::Quadrature<k> result;
  const auto add = [&](const Point<k>& origin, double scale)
  {
    for (int q = 0; q < rule.size(); ++q)
    {
      result.points.push_back(origin + scale * rule.points[q]);
      result.weights.push_back(rule.weights[q] / (2 * k));
    }
  };
  add(Point<k>::Zero(), 0.5);
  for (int i = 0; i < k; ++i) add(0.5 * Point<k>::Unit(i), 0.5);
  if constexpr (k == 2) add(Point<k>::Constant(0.5), -0.5);
  return result;
}

}  // namespace

template <int dim>
std::string AssemblyCheck<dim>::hint(std::span<const Eigen::VectorXd> free) const
{
  std::vector<std::string> remedies;
  for (const Eigen::VectorXd& z : free)
    if (const std::optional<Remedy> remedy = support_.remedy(z))
      if (const std::string words = describe(*remedy); std::ranges::find(remedies, words) == remedies.end())
        remedies.push_back(words);
  const bool friction_may_help =
      std::ranges::any_of(assembly_.segments, [&](const AssemblySegment& entry)
                          { return !cone(form_.segments()[entry.number].contact->law).resists_sliding(); });
  return fmt::format(
      "fix a displacement component that such a motion would change{} (symmetry: the component normal to the "
      "plane of symmetry){}",
      remedies.empty() ? assembly_.bodies.size() > 1 ? ", on a boundary of one of these bodies"
                                                     : ", on a boundary of this body"
                       : fmt::format(", for example {}", fmt::join(remedies, ", ")),
      friction_may_help ? ", or give its contact friction" : "");
}

template <int dim>
void AssemblyCheck<dim>::check_held() const
{
  const std::vector<Eigen::VectorXd> free = assembly_.readable_basis(support_.left_by_contact(true));
  if (free.empty()) return;
  std::vector<std::string> motions;
  motions.reserve(free.size());
  for (const Eigen::VectorXd& z : free) motions.push_back(assembly_.describe(problem_, z));
  const auto named = std::ranges::find_if(
      problem_.boundaries(), [](const auto& boundary) { return boundary.where.line > 0; });  // not a --set
  const std::string file = named == problem_.boundaries().end() ? "" : named->where.file;
  throw InputError({.file = file, .key = "boundary"},
                   fmt::format("nothing stops {} from: {}", name_, fmt::join(motions, "; ")), hint(free));
}

/// On the parts of the segments on which the rule integrates s; |[z]^t| is convex, so it is largest at a
/// vertex.
template <int dim>
auto AssemblyCheck<dim>::strength_work(const MotionBasis& motions, const Eigen::VectorXd& z,
                                       const fem::Quadrature<dim - 1>& rule) const -> FrictionWork
{
  FrictionWork result{Eigen::VectorXd::Zero(motions.cols())};
  const ContactDatumPart<dim> whole{fem::reference_simplex<dim - 1>(), 0, 0, 0};
  for (const AssemblySegment& entry : assembly_.segments)
  {
    const ContactSegment<dim>& segment = form_.segments()[entry.number];
    const problem::ContactLaw& law = segment.contact->law;
    if (problem::cone(law).strength == nullptr) continue;
    const MotionJump<dim> jump(mesh_, assembly_, entry, segment);
    const Eigen::MatrixXd of_segment = motions(jump.coefficients(), Eigen::all);
    const SimplexMap<dim - 1, dim> map = simplex_map(mesh_, segment.slave);
    const auto tangential = [&](const Point<dim>& v, const Point<dim>& x) -> Point<dim>
    {
      const Point<dim> n = segment.normal_at(x);
      return v - v.dot(n) * n;
    };
    const std::span<const ContactDatumPart<dim>> parts = form_.data().contact_parts(entry.number);
    for (const auto& [part, gap, strength, water] : parts.empty() ? std::span(&whole, 1) : parts)
    {
      const double measure = segment.measure * fem::fraction<dim - 1>(part);
      double largest = 0;
      for (const Point<dim - 1>& s : part)
        largest = std::max(
            largest, form_.problem().weight(map(s)) * tangential(jump(s) * (of_segment * z), map(s)).norm());
      result.missed += 2 * strength * measure * largest;
      for (int q = 0; q < rule.size(); ++q)
      {
        const Point<dim - 1> s = fem::point_in<dim - 1>(part, rule.points[q]);
        const Eigen::MatrixXd jumps = jump(s) * of_segment;
        const Point<dim> z_t = tangential(jumps * z, map(s));
        if (z_t.norm() <= 1e-12 * z.norm()) continue;
        const double force = measure * mesh::factorial<dim - 1> * rule.weights[q] *
                             form_.problem().weight(map(s)) * problem::strength_at<dim>(law, map(s));
        result.in_motions += force / z_t.norm() * (jumps.transpose() * z_t);
        result.most += force * z_t.norm();
      }
    }
  }
  return result;
}

/// The remainders of the integrals also cover affine weights, whose values are largest at vertices.
template <int dim>
double AssemblyCheck<dim>::missed_work(const Eigen::VectorXd& motion) const
{
  const DiscreteData<dim>& data = form_.data();
  double missed = 0;
  for (int b = 0; b < static_cast<int>(assembly_.bodies.size()); ++b)
  {
    const Body<dim>& body = assembly_.bodies[b];
    const auto largest = [&](const auto& vertices)
    {
      double size = 0;
      for (const Index v : vertices)
        size = std::max(
            size, form_.problem().weight(mesh_.vertex(v)) *
                      Point<dim>(assembly_.modes.at(mesh_.vertex(v)) * assembly_.part(motion, b)).norm());
      return size;
    };
    for (const Index c : body.cells)
      if (const double mean = data.body_remainder(c).mean; mean > 0) missed += mean * largest(mesh_.cell(c));
    for (std::size_t k = 0; k < body.facets.size(); ++k)
      if (const double mean = data.traction_remainder(body.numbers[k]).mean; mean > 0)
        missed += mean * largest(mesh::facet_vertices(mesh_.cell(body.facets[k].cell), body.facets[k].local));
  }
  for (const AssemblySegment& entry : assembly_.segments)
  {
    const ContactSegment<dim>& segment = form_.segments()[entry.number];
    const MotionJump<dim> jump(mesh_, assembly_, entry, segment);
    for (const ContactDatumPart<dim>& part : data.contact_parts(entry.number))
      for (const Point<dim - 1>& s : part.part)
        missed += 2 * part.water * segment.measure * fem::fraction<dim - 1>(part.part) *
                  (jump(s) * motion(jump.coefficients())).norm();
  }
  return std::sqrt(dim) * missed;  // the remainders are per component
}

// Tresca friction can do work in a convex set Z, all other contact forces in the cone K. The loads c are
// balanced if c lies in K + Z. The point of K + Z nearest to c is sought with K and those points of Z that
// proved useful, among them 0 (fully corrective Frank-Wolfe method); one more row makes their weights add up
// to at most 1. The remainder of c is a motion r against which K can do nothing, and c is outside as soon as
// c.r exceeds what Z can do.
template <int dim>
std::optional<Eigen::VectorXd> AssemblyCheck<dim>::beyond_tresca(const MotionBasis& motions,
                                                                 const Eigen::VectorXd& loads,
                                                                 double tolerance) const
{
  constexpr int max_points = 200;
  constexpr double relative = 1e-8;
  const Eigen::Index m = loads.size();
  const double one = loads.norm();
  const ContactCone<dim> cone(form_, assembly_, motions, ConeFriction::no_strength);
  const Eigen::Index n = cone.generators().cols();
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(m + 1, n + 1);
  columns.topLeftCorner(m, n) = cone.generators();
  columns(m, n) = one;
  const auto add = [&columns](const Eigen::VectorXd& work, double weight)
  {
    columns.conservativeResize(Eigen::NoChange, columns.cols() + 1);
    columns.rightCols(1) << work, weight;
  };
  Eigen::VectorXd target(m + 1);
  target << loads, one;
  for (int i = 0; i < max_points; ++i)
  {
    const Eigen::VectorXd r = project_on_polar_cone(columns, target).head(m);
    if (r.norm() <= tolerance) return {};
    if (const std::optional<Eigen::VectorXd> outside = cone.steepest(r))
    {
      add(*outside, 0);
      continue;
    }
    const FrictionWork friction = strength_work(motions, r, form_.data().facet_rule());
    const double driving = r.dot(loads) - missed_work(motions * r);
    if (driving > (1 + relative) * friction.most + tolerance * r.norm())
    {
      // |z^t| has kinks: refuse only what still holds after refinement of the rule.
      const double finer = strength_work(motions, r, on_halves(on_halves(form_.data().facet_rule()))).most;
      const double most = std::max(friction.most, finer) + std::abs(finer - friction.most) + friction.missed;
      return driving > (1 + relative) * most + tolerance * r.norm() ? std::optional(r) : std::nullopt;
    }
    add(friction.in_motions, one);
  }
  return {};
}

template <int dim>
void AssemblyCheck<dim>::fail(const Eigen::VectorXd& motion, const std::string& reason) const
{
  const ContactSegment<dim>& first = form_.segments()[assembly_.segments.front().number];
  throw InputError(
      first.pair < 0 ? problem_.boundary(first.slave.facet.tag).where : problem_.pairs()[first.pair].where,
      fmt::format("contact cannot hold {}: the loads drive it into {}; {}", name_,
                  assembly_.describe(problem_, motion), reason),
      "fix a displacement component that this motion would change, or mend the loads "
      "(tractions are forces on the body, a pressure acts against the outward normal)");
}

template <int dim>
void AssemblyCheck<dim>::check_balanced(const Eigen::VectorXd& work, double round_off) const
{
  const auto is_bonded = [&](const AssemblySegment& entry)
  { return problem::cone(form_.segments()[entry.number].contact->law).is_bonded; };
  if (std::ranges::any_of(assembly_.segments, is_bonded)) return;  // the strength of a bond is not known here
  constexpr double relative = 1e-8;
  const MotionBasis motions = support_.left_by_fixing();  // motions that only contact can stop
  const Eigen::VectorXd c = motions.transpose() * work;   // L(z) for each of them
  if (motions.cols() == 0 || c.norm() <= round_off) return;

  const double tolerance = relative * c.norm() + round_off;
  const auto left_by = [&](ConeFriction friction)
  { return ContactCone<dim>(form_, assembly_, motions, friction).project_on_polar(c); };
  const Eigen::VectorXd lifted = left_by(ConeFriction::unlimited);
  // The work of the loads in r, their projection on the polar cone, is |r|^2.
  const auto is_free = [&](const Eigen::VectorXd& r)
  { return r.squaredNorm() > tolerance * r.norm() + missed_work(motions * r); };
  if (is_free(lifted)) fail(motions * lifted, "contact only pushes");

  const Eigen::VectorXd slipped = left_by(ConeFriction::strong);
  if (is_free(slipped))
  {
    // Motions that slide along the whole contact boundary, and the one in which the loads do most work.
    const Eigen::MatrixXd pressed = support_.contact_gram(false);
    const MotionBasis sliding =
        motions * null_space(motions.transpose() * pressed * motions, pressed.trace());
    const Eigen::VectorXd slide = sliding * (sliding.transpose() * work);
    fail(slide.norm() > tolerance ? slide : Eigen::VectorXd(motions * slipped),
         "friction is too weak for the load along the contact boundary");
  }

  if (const std::optional<Eigen::VectorXd> z = beyond_tresca(motions, c, tolerance))
  {
    const FrictionWork friction = strength_work(motions, *z, form_.data().facet_rule());
    fail(motions * *z, fmt::format("the friction threshold takes up only {:.3g} % of their work in it",
                                   100 * (friction.most + friction.missed) / z->dot(c)));
  }
}

template class AssemblyCheck<2>;
template class AssemblyCheck<3>;

}  // namespace tribound::contact
