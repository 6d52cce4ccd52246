#include "tribound/io/record/solution_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>

#include "tribound/contact/nitsche/contact_moments.h"
#include "tribound/contact/nitsche/elasticity.h"
#include "tribound/mesh/bodies.h"
#include "tribound/mesh/geometry.h"

namespace tribound::io
{

namespace
{

constexpr double round_off = 1e-12;  // relative, of sums over many points

/// The components of a vector with accuracy `resolution`.
template <int n>
std::vector<double> known_components(const Point<n>& vector, double resolution)
{
  std::vector<double> result;
  for (const double component : vector) result.push_back(known_digits(component, resolution));
  return result;
}

/// The resultants of T(u) and of t^k on the boundary group `tag`, or on all of Gamma_C for tag < 0.
template <int dim>
Resultants resultants(const contact::NitscheForm<dim>& form, std::span<const Point<dim>> of_u,
                      std::span<const Point<dim>> running, int tag = -1)
{
  const contact::ContactResultants<dim> r = contact::contact_resultants(form, of_u, tag);
  const contact::ContactResultants<dim> in_equilibrium = contact::contact_resultants(form, running, tag);
  Resultants result;
  result.resolution = (r.force - in_equilibrium.force).norm() + std::abs(r.normal - in_equilibrium.normal) +
                      std::abs(r.tangential - in_equilibrium.tangential) +
                      round_off * (r.abs_normal + r.abs_tangential);
  const auto known = [&](double value) { return known_digits(value, result.resolution); };
  result.force = known_components<dim>(r.force, result.resolution);
  if (form.problem().is_axisymmetric()) result.force[0] = 0;  // around the axis the radial forces cancel
  result.normal = known(r.normal);
  result.tangential = known(r.tangential);
  result.abs_tangential = known(r.abs_tangential);
  return result;
}

/// Adds the moments of T(u), with the digits justified by their distance from those of t^k.
template <int dim>
void add_moments(Resultants& result, const contact::NitscheForm<dim>& form, std::span<const Point<dim>> of_u,
                 std::span<const Point<dim>> running, int tag = -1)
{
  const contact::ContactMoments<dim> m = contact::contact_moments(form, of_u, tag);
  const contact::ContactMoments<dim> in_equilibrium = contact::contact_moments(form, running, tag);
  const double rounding = round_off * m.scale;
  result.moment = known_components(m.slave, (m.slave - in_equilibrium.slave).norm() + rounding);
  if (result.pair)
    result.pair->moment_on_master =
        known_components(m.master, (m.master - in_equilibrium.master).norm() + rounding);
  if (!form.problem().is_axisymmetric()) return;
  result.moment.assign(result.moment.size(), 0.0);  // around the axis they cancel, too
  if (result.pair) result.pair->moment_on_master = result.moment;
}

template <int dim>
PairFigures pair_figures(const contact::NitscheForm<dim>& form, std::span<const double> u, int tag,
                         const problem::ContactPair<dim>& pair, const problem::Units& units)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  PairFigures figures{.master = pair.master,
                      .law = problem::words(pair.contact.law, units),
                      .smallest_gap = std::numeric_limits<double>::infinity(),
                      .largest_gap = -std::numeric_limits<double>::infinity()};
  std::array<double, 4> sums{};
  auto& [segments, covered, covered_master, all] = sums;
  const Point<dim - 1> middle = Point<dim - 1>::Constant(1.0 / dim);
  const auto swept = [&](const auto& map, double measure)
  { return form.problem().full_circle() * form.problem().weight(map(middle)) * measure; };
  for (std::size_t k = 0; k < form.n_owned_segments(); ++k)
  {
    const contact::ContactSegment<dim>& segment = form.segments()[k];
    if (segment.slave.facet.tag != tag) continue;
    ++segments;
    covered += swept(contact::simplex_map(mesh, segment.slave), segment.measure);
    const auto master = contact::simplex_map(mesh, *segment.master);
    covered_master += swept(master, master.measure);
    for (const contact::ContactState<dim>& state : form.contact_states(u, k))
    {
      figures.smallest_gap = std::min(figures.smallest_gap, state.gap);
      figures.largest_gap = std::max(figures.largest_gap, state.gap);
      figures.largest_tension = std::max(figures.largest_tension, -state.pressure);
    }
  }
  for (const mesh::BoundaryFacet& facet : mesh.owned_boundary())
    if (facet.tag == tag)
      all += swept(mesh::facet_map(mesh, facet.cell, facet.local),
                   mesh::facet_geometry(mesh, facet.cell, facet.local).measure);
  const Ranks& ranks = mesh.ranks();
  ranks.sum(std::span(sums));
  figures.segments = static_cast<decltype(figures.segments)>(segments);
  figures.covered = covered;
  figures.covered_master = covered_master;
  figures.covered_share = covered / all;
  figures.smallest_gap = -ranks.max(-figures.smallest_gap);
  figures.largest_gap = ranks.max(figures.largest_gap);
  figures.largest_tension = ranks.max(figures.largest_tension);
  return figures;
}

/// Numbers parts of the mesh with the same name.
void number_alike(std::vector<std::string>& names)
{
  std::map<std::string, std::vector<std::string*>> of_name;
  for (std::string& name : names) of_name[name].push_back(&name);
  for (const auto& [name, alike] : of_name)
    for (std::size_t i = 0; alike.size() > 1 && i < alike.size(); ++i) *alike[i] += fmt::format(" {}", i + 1);
}

template <int dim>
std::vector<BodyFigures> body_figures(const contact::NitscheForm<dim>& form,
                                      const adapt::CertifiedLevel<dim>& level)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const mesh::Bodies found = mesh::number_bodies(mesh);
  const std::vector<double> energies =
      contact::cell_energies<dim>(form.problem(), form.space(), level.u, form.meridian());
  constexpr std::size_t width = 3;  // cells, energy, bound^2
  std::vector<double> sums(found.n * width, 0.0);
  for (Index c = 0; c < mesh.n_owned_cells(); ++c)
  {
    const int body = found.of_cell[c];
    double* of_body = &sums[body * width];
    ++of_body[0];
    of_body[1] += energies[c];
    if (!level.estimate.cells.empty()) of_body[2] += std::pow(level.estimate.cells[c].total_sharp(), 2);
  }
  mesh.ranks().sum(std::span(sums));
  const std::vector<std::string> names = body_names<dim>(mesh, found);
  std::vector<BodyFigures> bodies(found.n);
  for (std::size_t b = 0; b < bodies.size(); ++b)
  {
    bodies[b].name = names[b];
    bodies[b].cells = static_cast<decltype(bodies[b].cells)>(sums[b * width]);
    bodies[b].energy = form.problem().full_circle() * sums[b * width + 1];
    bodies[b].bound = std::sqrt(sums[b * width + 2]);
  }
  return bodies;
}

}  // namespace

template <int dim>
std::vector<std::string> body_names(const mesh::Mesh<dim>& mesh, const mesh::Bodies& bodies)
{
  std::set<std::array<int, 2>> regions;  // of bodies
  for (Index c = 0; c < mesh.n_owned_cells(); ++c) regions.insert({bodies.of_cell[c], mesh.region(c)});
  std::vector<std::array<int, 2>> all(regions.begin(), regions.end());
  all = mesh.ranks().template gather<std::array<int, 2>>(all);
  mesh.ranks().copy_from_first(all);
  regions = {all.begin(), all.end()};
  std::vector<std::string> names(bodies.n);
  for (const auto& [body, region] : regions)
    names[body] += (names[body].empty() ? "" : "+") + mesh.region_names()[region];
  number_alike(names);
  return names;
}

double known_digits(double value, double resolution)
{
  constexpr int all_digits = 16;
  if (std::abs(value) <= resolution) return 0;
  const double digits = std::floor(std::log10(std::abs(value))) - std::floor(std::log10(resolution));
  if (!(digits < all_digits)) return value;
  return std::stod(fmt::format("{:.{}e}", value, static_cast<int>(digits)));
}

std::optional<Sliding> sliding(const Resultants& resultants)
{
  const double N = -resultants.normal;
  const double H = std::abs(resultants.tangential);
  const double resolution = resultants.resolution;
  if (!resultants.coefficient || N <= resolution) return std::nullopt;
  const double mu_F = *resultants.coefficient;
  const double ratio = H / N;
  constexpr double round_off = 1e-10;
  Sliding result{mu_F, known_digits(ratio, (1 + ratio) * resolution / N), {}};
  if (H > std::max(resolution, round_off * N))
    result.safety_factor = known_digits(mu_F / ratio, mu_F / ratio * (1 + 1 / ratio) * resolution / N);
  return result;
}

template <int dim>
SolutionFigures solution_figures(const contact::NitscheForm<dim>& form,
                                 const adapt::CertifiedLevel<dim>& level, const std::vector<bool>& slides,
                                 const problem::Units& units)
{
  SolutionFigures figures;
  figures.round_off = level.norms.round_off;
  if (!level.solved() || !is_round_off(level.estimate, level.norms))
  {
    figures.energy = form.problem().full_circle() * level.norms.energy;
    figures.sigma_norm = level.norms.sigma;
  }
  if (form.problem().has_springs())
    figures.spring_energy = form.problem().full_circle() * form.springs().energy(level.u);
  for (const contact::PartMotion<dim>& part : form.rigid_parts().motions(form.problem(), level.u))
    figures.rigid_parts.push_back({form.problem().boundary(part.tag).name,
                                   {part.translation.begin(), part.translation.end()},
                                   {part.rotation.begin(), part.rotation.end()}});
  for (std::size_t node = 0; node < level.u.size(); node += dim)
    figures.max_displacement = std::max(figures.max_displacement, Point<dim>(level.u.data() + node).norm());
  figures.max_displacement = form.space().mesh().ranks().max(figures.max_displacement);
  const std::vector<Point<dim>> t = form.traction(level.u);
  figures.contact = resultants<dim>(form, t, level.traction);
  add_moments<dim>(figures.contact, form, t, level.traction);
  const auto boundaries = form.problem().boundaries();
  for (int tag = 0; tag < static_cast<int>(boundaries.size()); ++tag)
  {
    const problem::Contact* contact = form.problem().contact(tag);
    if (contact == nullptr) continue;
    Resultants part = resultants<dim>(form, t, level.traction, tag);
    part.boundary = boundaries[tag].name;
    if (const problem::ContactPair<dim>* pair = form.problem().pair_of_slave(tag))
      part.pair = pair_figures(form, level.u, tag, *pair, units);
    add_moments<dim>(part, form, t, level.traction, tag);
    const problem::FrictionCone friction = cone(contact->law);
    const bool coefficient_alone = friction.strength == nullptr && friction.coefficient > 0;
    if (coefficient_alone && slides[tag] && adapt::bound_holds(level))
      part.coefficient = friction.coefficient;
    figures.boundary_contact.push_back(std::move(part));
  }
  if (!form.problem().pairs().empty()) figures.bodies = body_figures(form, level);
  return figures;
}

template SolutionFigures solution_figures(const contact::NitscheForm<2>&, const adapt::CertifiedLevel<2>&,
                                          const std::vector<bool>&, const problem::Units&);
template SolutionFigures solution_figures(const contact::NitscheForm<3>&, const adapt::CertifiedLevel<3>&,
                                          const std::vector<bool>&, const problem::Units&);

template std::vector<std::string> body_names(const mesh::Mesh<2>&, const mesh::Bodies&);
template std::vector<std::string> body_names(const mesh::Mesh<3>&, const mesh::Bodies&);

}  // namespace tribound::io
