#include "tribound/io/record/hydraulic_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "tribound/contact/nitsche/crack_mouth.h"
#include "tribound/fem/evaluation.h"
#include "tribound/mesh/bodies.h"

namespace tribound::io
{

namespace
{

/// Directions on the base: e from heel to toe, n the mean normal, m its part perpendicular to e.
template <int dim>
struct Frame
{
  Point<dim> heel;
  Point<dim> toe;
  Point<dim> e;
  Point<dim> n;
  Point<dim> m;

  /// r x f in the plane of e and m: positive from e to m.
  [[nodiscard]] double moment(const Point<dim>& r, const Point<dim>& f) const
  {
    return r.dot(e) * f.dot(m) - r.dot(m) * f.dot(e);
  }
};

/// Calls visit(point, number) for own contact points of the slave.
template <int dim, class Visit>
void for_each_point(const contact::NitscheForm<dim>& form, int tag, const Visit& visit)
{
  for (std::size_t i = 0; i < form.n_owned_contact_points(); ++i)
    if (form.segments()[i / form.n_segment_points()].slave.facet.tag == tag)
      visit(form.contact_points()[i], i);
}

template <int dim>
Frame<dim> frame_of(const contact::NitscheForm<dim>& form, const problem::BaseLine& line, int tag)
{
  Frame<dim> frame;
  frame.heel = Point<dim>(line.heel.data());
  frame.toe = Point<dim>(line.toe.data());
  frame.e = (frame.toe - frame.heel).normalized();
  frame.n.setZero();
  for_each_point(form, tag, [&](const auto& point, std::size_t) { frame.n += point.weight * point.normal; });
  form.space().mesh().ranks().sum(std::span(frame.n.data(), dim));
  frame.n.normalize();
  frame.m = (frame.n - frame.n.dot(frame.e) * frame.e).normalized();
  return frame;
}

/// Integrals over the interface.
template <int dim>
struct Forces
{
  Point<dim> total = Point<dim>::Zero();  ///< of t
  Point<dim> water = Point<dim>::Zero();  ///< of p_w n
  double total_about_heel = 0;            ///< moments in the frame
  double water_about_heel = 0;
  double water_about_toe = 0;
  double intact = 0;  ///< integral of the strength at D = 0
  double now = 0;     ///< integral of the strength at the current D, where closed
};

/// The shear strength of a law besides friction at a given damage; nothing where the law has none.
std::optional<double> strength(const problem::ContactLaw& law, double threshold, double damage)
{
  if (const auto* joint = std::get_if<problem::JointLaw>(&law))
    return joint->stick ? std::nullopt : std::optional(threshold + joint->cohesion * (1 - damage));
  if (const auto* mixed = std::get_if<problem::MixedLaw>(&law))
    return mixed->shear_ratio * mixed->tension.strength * (1 - damage);
  if (std::holds_alternative<problem::EndoLaw>(law)) return std::nullopt;
  return threshold;
}

template <int dim>
Forces<dim> integrate(const adapt::LoadStep<dim>& step, const problem::ContactLaw& law,
                      const Frame<dim>& frame, int tag)
{
  const contact::NitscheForm<dim>& form = step.at->discrete.form;
  std::array<double, 2 * dim + 5> sums{};
  for_each_point(form, tag,
                 [&](const contact::ContactPoint<dim>& point, std::size_t i)
                 {
                   const Point<dim> t = point.weight * step.level.traction[i];
                   const Point<dim> water = point.weight * point.water * point.normal;
                   for (int a = 0; a < dim; ++a) sums[a] += t[a];
                   for (int a = 0; a < dim; ++a) sums[dim + a] += water[a];
                   double* const others = sums.data() + 2 * dim;
                   others[0] += frame.moment(point.x - frame.heel, t);
                   others[1] += frame.moment(point.x - frame.heel, water);
                   others[2] += frame.moment(point.x - frame.toe, water);
                   const problem::InterfaceResponse<dim>& response = step.responses[i];
                   others[3] += point.weight * strength(law, point.strength, 0).value_or(0);
                   if (response.opening <= 0)
                     others[4] +=
                         point.weight * strength(law, point.strength, response.state.damage).value_or(0);
                 });
  form.space().mesh().ranks().sum(std::span(sums));
  const double* const others = sums.data() + 2 * dim;
  return {Point<dim>(sums.data()),
          Point<dim>(sums.data() + dim),
          others[0],
          others[1],
          others[2],
          others[3],
          others[4]};
}

/// Marks the cells of bodies that own the slave.
template <int dim>
std::vector<char> cells_above(const contact::NitscheForm<dim>& form, int tag)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const mesh::Bodies bodies = mesh::number_bodies(mesh);
  std::vector<double> owns(bodies.n, 0.0);
  for (const mesh::BoundaryFacet& facet : mesh.owned_boundary())
    if (facet.tag == tag) owns[bodies.of_cell[facet.cell]] = 1;
  mesh.ranks().max(std::span(owns));
  std::vector<char> above(mesh.n_owned_cells());
  for (std::size_t c = 0; c < above.size(); ++c) above[c] = owns[bodies.of_cell[c]] > 0 ? 1 : 0;
  return above;
}

/// Moments about the toe, stabilising ones positive: of each region, then of each component of the load on
/// each boundary.
template <int dim>
std::vector<double> load_moments(const contact::NitscheForm<dim>& form, const Frame<dim>& frame, int tag)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const std::vector<char> above = cells_above(form, tag);
  const std::size_t n_regions = form.problem().regions().size();
  std::vector<double> moments(n_regions + dim * form.problem().boundaries().size(), 0.0);
  std::vector<Point<dim>> f(form.data().cell_rule().size());
  for (Index c = 0; c < mesh.n_owned_cells(); ++c)
  {
    if (above[c] == 0 || !form.data().has_body_force(c)) continue;
    form.data().body_force(c, f);
    for (const auto& [q, x, dx] : fem::cell_points(mesh::cell_map(mesh, c), form.data().cell_rule()))
      moments[mesh.region(c)] -= dx * frame.moment(x - frame.toe, f[q]);
  }
  std::vector<Point<dim>> g(form.facet_rule().size());
  for (std::size_t k = 0; k < mesh.n_owned_boundary(); ++k)
  {
    const mesh::BoundaryFacet& facet = mesh.boundary()[k];
    if (facet.tag < 0 || above[facet.cell] == 0 || !form.data().has_traction(k)) continue;
    form.data().traction(k, g);
    for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, form.facet_rule()))
      for (int a = 0; a < dim; ++a)
        moments[n_regions + dim * facet.tag + a] -=
            dx * frame.moment(x - frame.toe, g[q][a] * Point<dim>::Unit(a));
  }
  mesh.ranks().sum(std::span(moments));
  return moments;
}

/// `uplift`: its moment about the toe, > 0.
template <int dim>
std::optional<double> overturning(const contact::NitscheForm<dim>& form, const Frame<dim>& frame, int tag,
                                  double uplift)
{
  double stabilising = 0;
  double against = uplift;
  for (const double moment : load_moments(form, frame, tag))
    (moment > 0 ? stabilising : against) += std::abs(moment);
  if (against <= 0) return std::nullopt;
  return stabilising / against;
}

}  // namespace

template <int dim>
std::optional<HydraulicFigures> hydraulic_figures(const adapt::LoadStep<dim>& step, int tag)
{
  constexpr double smallest_shear = 1e-10;  // relative to |N|
  const contact::NitscheForm<dim>& form = step.at->discrete.form;
  const problem::Contact* contact = form.problem().contact(tag);
  if (contact == nullptr || !contact->base) return std::nullopt;
  const Frame<dim> frame = frame_of(form, *contact->base, tag);
  const Forces<dim> forces = integrate(step, contact->law, frame, tag);
  const double length = contact->base->length();

  HydraulicFigures figures;
  const double normal = forces.total.dot(frame.n);
  const double shear = (forces.total - normal * frame.n).norm();
  figures.uplift = forces.water.dot(frame.n);
  figures.effective_normal = normal + figures.uplift;
  if (figures.effective_normal < 0)
  {
    figures.resultant_x =
        (forces.total_about_heel + forces.water_about_heel) / (forces.total + forces.water).dot(frame.m);
    figures.in_kernel = length / 3 <= *figures.resultant_x && *figures.resultant_x <= 2 * length / 3;
  }
  if (normal < 0) figures.resultant_x_total = forces.total_about_heel / forces.total.dot(frame.m);
  if (shear > smallest_shear * std::abs(normal))
  {
    const double rubbing = cone(contact->law).coefficient * std::max(-figures.effective_normal, 0.0);
    figures.sliding_safety = rubbing / shear;
    if (strength(contact->law, 0, 0))
    {
      figures.sff_intact = (forces.intact + rubbing) / shear;
      figures.sff_now = (forces.now + rubbing) / shear;
    }
  }
  figures.overturning = overturning(form, frame, tag, -forces.water_about_toe);
  const std::vector<const problem::Contact*> contacts = form.problem().contacts();
  const contact::CrackTip& tip = step.crack_tips.at(std::ranges::find(contacts, contact) - contacts.begin());
  figures.crack_tip = tip.distance;
  figures.crack_farthest = tip.farthest;
  const contact::CrackMouth mouth = contact::crack_mouth(form, tag);
  const auto sliding = [&](std::size_t i)
  {
    const std::size_t n = form.n_segment_points();
    return form.contact_states(step.level.u, i / n)[i % n].slip.dot(frame.e);
  };
  figures.cmod = contact::mean_at(mouth, form, [&](std::size_t i) { return step.responses[i].opening; });
  figures.csd = contact::mean_at(mouth, form, sliding);
  return figures;
}

template std::optional<HydraulicFigures> hydraulic_figures(const adapt::LoadStep<2>&, int);
template std::optional<HydraulicFigures> hydraulic_figures(const adapt::LoadStep<3>&, int);

}  // namespace tribound::io
