#include "tribound/io/record/solution_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tribound::io
{

namespace
{

/// The resultants of T(u) and of t^k on the boundary group `tag`, or on all of Gamma_C for tag < 0.
template <int dim>
Resultants resultants(const contact::NitscheForm<dim>& form, std::span<const Point<dim>> of_u,
                      std::span<const Point<dim>> running, int tag = -1)
{
  constexpr double round_off = 1e-12;  // of sums over many points
  const contact::ContactResultants<dim> r = contact::contact_resultants(form, of_u, tag);
  const contact::ContactResultants<dim> in_equilibrium = contact::contact_resultants(form, running, tag);
  Resultants result;
  result.resolution = (r.force - in_equilibrium.force).norm() + std::abs(r.normal - in_equilibrium.normal) +
                      std::abs(r.tangential - in_equilibrium.tangential) +
                      round_off * (std::abs(r.normal) + r.abs_tangential);
  const auto known = [&](double value) { return known_digits(value, result.resolution); };
  for (const double component : r.force) result.force.push_back(known(component));
  result.normal = known(r.normal);
  result.tangential = known(r.tangential);
  result.abs_tangential = known(r.abs_tangential);
  return result;
}

}  // namespace

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
                                 const adapt::CertifiedLevel<dim>& level, const std::vector<bool>& slides)
{
  SolutionFigures figures;
  figures.round_off = level.norms.round_off;
  if (!level.solved() || !is_round_off(level.estimate, level.norms))
  {
    figures.energy = level.norms.energy;
    figures.sigma_norm = level.norms.sigma;
  }
  for (std::size_t node = 0; node < level.u.size(); node += dim)
    figures.max_displacement = std::max(figures.max_displacement, Point<dim>(level.u.data() + node).norm());
  figures.max_displacement = form.space().mesh().ranks().max(figures.max_displacement);
  const std::vector<Point<dim>> t = form.traction(level.u);
  figures.contact = resultants<dim>(form, t, level.traction);
  const auto boundaries = form.problem().boundaries();
  for (int tag = 0; tag < static_cast<int>(boundaries.size()); ++tag)
  {
    if (!boundaries[tag].contact) continue;
    Resultants part = resultants<dim>(form, t, level.traction, tag);
    part.boundary = boundaries[tag].name;
    const problem::FrictionCone friction = cone(boundaries[tag].contact->law);
    const bool coefficient_alone = friction.strength == nullptr && friction.coefficient > 0;
    if (coefficient_alone && slides[tag] && adapt::bound_holds(level, form.space().degree()))
      part.coefficient = friction.coefficient;
    figures.boundary_contact.push_back(std::move(part));
  }
  return figures;
}

template SolutionFigures solution_figures(const contact::NitscheForm<2>&, const adapt::CertifiedLevel<2>&,
                                          const std::vector<bool>&);
template SolutionFigures solution_figures(const contact::NitscheForm<3>&, const adapt::CertifiedLevel<3>&,
                                          const std::vector<bool>&);

}  // namespace tribound::io
