#include "tribound/certify/equilibrate/equilibrate.h"

#include <algorithm>
#include <vector>

#include "tribound/certify/equilibrate/meridian_equilibrator.h"
#include "tribound/certify/equilibrate/mesh_equilibrator.h"
#include "tribound/fem/degree.h"

namespace tribound::certify
{

namespace
{

/// C of the regions, relative to 2 mu of the stiffest: patches see nothing but ratios. None for L2. Any
/// lambda gives a stress that balances: beyond nu = 0.49998 it does not grow any more, which would cost
/// digits.
template <int dim>
std::vector<StressMetric> metrics_of(const problem::Problem<dim>& problem, PatchStress kind)
{
  std::vector<StressMetric> metrics;
  if (kind != PatchStress::afw_compliance) return metrics;
  double stiffest = 0;
  for (const problem::Region<dim>& region : problem.regions())
    stiffest = std::max(stiffest, 2 * region.material.mu);
  constexpr double largest_ratio = 1e4;  // of lambda and 2 mu
  metrics.reserve(problem.regions().size());
  for (const problem::Region<dim>& region : problem.regions())
  {
    const double scale = 2 * region.material.mu / stiffest;
    metrics.push_back({scale, std::min(region.material.lambda / stiffest, largest_ratio * scale)});
  }
  return metrics;
}

}  // namespace

template <int dim>
Equilibrator<dim>::Equilibrator(const contact::NitscheForm<dim>& form, PatchStress kind, int n_threads)
    : form_(form)
{
  form.space().mesh().ranks().together(
      [&]
      {
        const bool by_rows = kind == PatchStress::rows;
        if constexpr (dim == 2)
          if (form.problem().is_axisymmetric())
          {
            implementation_ =
                make_meridian_equilibrator(form, n_threads, by_rows, metrics_of(form.problem(), kind));
            return;
          }
        fem::with_degree(form.space().degree(),
                         [&](auto p)
                         {
                           implementation_ = make_mesh_equilibrator<dim, p>(form, n_threads, by_rows,
                                                                            metrics_of(form.problem(), kind));
                         });
      });
}

template <int dim>
Equilibrator<dim>::~Equilibrator() = default;

namespace
{

/// What the parts of the stress of an iterate carry on Gamma_C.
template <int dim>
typename Stress<dim>::Tractions tractions_of(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                             std::span<const Point<dim>> t, double delta)
{
  typename Stress<dim>::Tractions tractions{form.traction(u), {t.begin(), t.end()}, {}};
  auto& [dis, lin, reg, springs] = tractions;  // FacetData and MeridianFacets add those of springs
  if (delta > 0) reg = form.traction(u, delta);
  for (std::size_t i = 0; i < lin.size(); ++i) lin[i] -= delta > 0 ? reg[i] : dis[i];
  for (std::size_t i = 0; i < reg.size(); ++i) reg[i] -= dis[i];
  return tractions;
}

}  // namespace

template <int dim>
Stress<dim> Equilibrator<dim>::operator()(std::span<const double> u, std::span<const Point<dim>> t,
                                          double delta)
{
  return form_.space().mesh().ranks().together(
      [&] { return implementation_->run(u, tractions_of(form_, u, t, delta), true, {}); });
}

template <int dim>
Stress<dim> Equilibrator<dim>::linearisation(std::span<const double> u, std::span<const Point<dim>> t)
{
  return form_.space().mesh().ranks().together(
      [&] { return implementation_->run(u, tractions_of(form_, u, t, 0), false, {}); });
}

template <int dim>
Stress<dim> Equilibrator<dim>::balanced(std::span<const double> u, std::span<const Point<dim>> t,
                                        std::span<const Tensor<dim>> turning)
{
  return form_.space().mesh().ranks().together(
      [&] {
        return implementation_->run(u, {{t.begin(), t.end()}, {}, {}}, true, turning);
      });
}

template class Equilibrator<2>;
template class Equilibrator<3>;

}  // namespace tribound::certify
