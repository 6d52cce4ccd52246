#include "tribound/adapt/persistent.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "tribound/adapt/regularisation.h"
#include "tribound/base/error.h"
#include "tribound/base/rank_failure.h"
#include "tribound/contact/nitsche/penalty.h"
#include "tribound/fem/nested.h"

namespace tribound::adapt
{

namespace
{

using Record = std::function<void(const solve::NewtonStep&)>;

/// The solution with a small delta, found by reducing delta; nothing where this also fails.
template <int dim>
std::optional<std::vector<double>> regularised_start(const contact::NitscheForm<dim>& form,
                                                     std::span<const double> start, const Method& method,
                                                     const Record& record)
{
  // In units of the mean contact traction of the first step.
  constexpr double first = 10;
  constexpr double last = 1e-3;
  constexpr double factor = 0.25;
  solve::NewtonOptions newton = method.newton;
  newton.tolerance = std::max(newton.tolerance, 1e-4);
  newton.balanced = false;
  double scale = 0;
  double delta = 0;
  const solve::NewtonObserver<dim> shrink = [&](const solve::NewtonIterate<dim>& iterate)
  {
    record(iterate.step);
    solve::NewtonAdvice advice = false;
    if (delta == 0)
    {
      scale = mean_contact_traction<dim>(form, iterate.traction);
      delta = first * scale;
      if (delta > 0) advice.delta = delta;
    }
    else if (iterate.converged)
    {
      delta *= factor;
      if (delta > last * scale)
        advice.delta = delta;
      else
        advice.good_enough = true;
    }
    return advice;
  };
  solve::NewtonResult<dim> result = solve::solve<dim>(form, start, newton, method.solver, shrink);
  if (result.status == solve::NewtonStatus::diverged || delta == 0) return std::nullopt;
  return std::move(result.u);
}

/// The solution of another form as a start, with the equilibrium used for it; nothing where Newton's method
/// fails.
template <int dim>
struct Start
{
  std::vector<double> u;
  std::shared_ptr<solve::Equilibrium<dim>> equilibrium = {};
  double residual = 0;  ///< relative
};

/// When the solution is accurate enough.
struct Until
{
  double tolerance;                            ///< of the relative residual
  int step = std::numeric_limits<int>::max();  ///< whatever the residual is
};

template <int dim>
std::optional<Start<dim>> solution_of(const contact::NitscheForm<dim>& other, Start<dim> start,
                                      const Method& method, const Until& until, const Record& record)
{
  solve::NewtonOptions newton = method.newton;
  newton.tolerance = std::max(newton.tolerance, until.tolerance);
  newton.balanced = false;
  const solve::NewtonObserver<dim> watch = [&](const solve::NewtonIterate<dim>& iterate)
  {
    record(iterate.step);
    return iterate.step.step == until.step;
  };
  solve::NewtonResult<dim> result =
      solve::solve<dim>(other, start.u, newton, method.solver, watch, 0, std::move(start.equilibrium));
  if (!result.message.empty()) return std::nullopt;
  return Start<dim>{std::move(result.u), std::move(result.equilibrium), result.steps.back().residual};
}

/// The solution with gamma times `factor`; nothing where this also fails.
template <int dim>
std::optional<std::vector<double>> start_with_gamma(double factor, const contact::NitscheForm<dim>& form,
                                                    std::span<const double> start, const Method& method,
                                                    const Record& record)
{
  const contact::NitscheForm<dim> other = form.with_gamma0(factor * form.gamma0());
  std::optional<Start<dim>> found =
      solution_of<dim>(other, {{start.begin(), start.end()}}, method, {.tolerance = 0}, record);
  if (!found) return std::nullopt;
  return std::move(found->u);
}

/// Number of stages of soft_start(): the number of factors 3 between the sizes of a contact facet and of the
/// contact boundary.
template <int dim>
int n_soft_stages(const contact::NitscheForm<dim>& form)
{
  const auto n_segments = form.space().mesh().ranks().sum(static_cast<std::int64_t>(form.n_owned_segments()));
  const double n_across = std::pow(static_cast<double>(n_segments), 1.0 / (dim - 1));
  return static_cast<int>(std::lround(std::log(std::max(1.0, n_across)) / std::log(3.0)));
}

/// The solution with a third of gamma. It is found from that with a third of this, and so on, beginning with
/// the gamma of a mesh with a single facet on the contact boundary, each only as accurately as a start needs.
/// The contact state then spreads by a share of the boundary in a step, instead of by a facet or two as on a
/// fine mesh. Returns no displacement where the first step is close enough: nearly all facets are then closed
/// and sticking, and few steps can be saved.
template <int dim>
std::optional<Start<dim>> soft_start(const contact::NitscheForm<dim>& form, const Method& method,
                                     const Record& record)
{
  constexpr double tolerance = 0.1;
  const auto soft = [&](int stage) { return form.with_gamma0(form.gamma0() * std::pow(3, -stage)); };
  int stage = n_soft_stages(form);
  Start<dim> nothing{{}, solve::make_equilibrium<dim>(form, method.solver, true)};
  std::optional<Start<dim>> found =
      solution_of<dim>(soft(stage), std::move(nothing), method, {.tolerance = tolerance, .step = 1}, record);
  if (found && found->residual <= tolerance)
  {
    found->u.clear();
    return found;
  }
  for (; stage > 0 && found; --stage)
    found = solution_of<dim>(soft(stage), *std::move(found), method, {.tolerance = tolerance}, record);
  return found;
}

/// A start for the first mesh in 3D. With degree 1, on a fine mesh, it is that of soft_start(). With a higher
/// degree it is the solution with half the degree, rounded up, on the same mesh, as accurate as a start
/// needs, which is found likewise. Nothing where there is none or Newton's method fails.
template <int dim>
std::optional<Start<dim>> start_from_scratch(const contact::NitscheForm<dim>& form, const Method& method,
                                             const Record& record)
{
  // Below some 16 facets across the contact boundary, the steps saved are not worth the effort.
  constexpr int fewest_stages = 3;
  constexpr double tolerance = 1e-4;
  try
  {
    if (form.space().degree() == 1)
      return n_soft_stages(form) < fewest_stages ? std::nullopt : soft_start(form, method, record);
    const int degree = (form.space().degree() + 1) / 2;
    const fem::LagrangeSpace<dim> space(form.space().mesh(), degree);
    const contact::NitscheForm<dim> other(form.problem(), space, contact::default_gamma0(degree));
    std::optional<Start<dim>> start = start_from_scratch(other, method, record);
    const auto found = solution_of<dim>(other, std::move(start).value_or(Start<dim>{}), method,
                                        {.tolerance = tolerance}, record);
    if (!found) return std::nullopt;
    std::vector<Index> itself(space.mesh().n_cells());
    std::iota(itself.begin(), itself.end(), 0);
    return Start<dim>{fem::nested_interpolant<dim>(space, found->u, itself, form.space())};
  }
  catch (const SolveError& error)
  {
    require_all_failed(form.space().mesh().ranks(), error.what());
    return std::nullopt;
  }
}

/// Whether T is affine: one step then gives the solution.
template <int dim>
bool is_linear(const contact::NitscheForm<dim>& form)
{
  const bool all_hold = std::ranges::all_of(form.segments(), &problem::Contact::is_bilateral,
                                            &contact::ContactSegment<dim>::contact);
  return !form.space().mesh().ranks().any(!all_hold);
}

}  // namespace

template <int dim>
solve::NewtonResult<dim> solve_persistently(const contact::NitscheForm<dim>& form,
                                            std::span<const double> start, const Method& method,
                                            const solve::NewtonObserver<dim>& observer, double delta,
                                            const Record& record,
                                            std::shared_ptr<solve::Equilibrium<dim>> equilibrium)
{
  const bool may_start_anew =
      method.other_starts && method.newton.damping && !method.regularisation && form.problem().has_contact();
  std::optional<Start<dim>> easier;
  const Ranks& ranks = form.space().mesh().ranks();  // a rank without cells has no displacement
  if (dim == 3 && !ranks.any(!start.empty()) && may_start_anew && !is_linear(form))
    easier = start_from_scratch(form, method, record);

  solve::NewtonResult<dim> first;
  first.equilibrium = easier ? easier->equilibrium : std::move(equilibrium);
  const auto attempt = [&](std::span<const double> u)
  {
    if (method.newton.damping && method.full_steps > 0)
    {
      solve::NewtonOptions full = method.newton;
      full.damping = false;
      full.max_steps = std::min(method.full_steps, full.max_steps);
      try
      {
        auto result = solve::solve<dim>(form, u, full, method.solver, observer, delta, first.equilibrium);
        if (result.message.empty()) return result;
        first.equilibrium = std::move(result.equilibrium);
      }
      catch (const SolveError& error)  // far off, where everything slides, a tangent may be singular
      {
        require_all_failed(ranks, error.what());
      }
    }
    return solve::solve<dim>(form, u, method.newton, method.solver, observer, delta, first.equilibrium);
  };
  std::exception_ptr failure;
  try
  {
    first = attempt(easier ? easier->u : start);
  }
  catch (const SolveError& error)
  {
    require_all_failed(ranks, error.what());
    failure = std::current_exception();
  }
  if (!failure && first.message.empty()) return first;

  using FindStart = std::function<std::optional<std::vector<double>>()>;
  std::vector<FindStart> others;
  if (easier && ranks.any(!easier->u.empty())) others.emplace_back([] { return std::vector<double>{}; });
  if (may_start_anew)
    others.insert(others.end(), {[&] { return regularised_start(form, start, method, record); },
                                 [&] { return start_with_gamma(3, form, start, method, record); },
                                 [&] { return start_with_gamma(1. / 3, form, start, method, record); }});
  for (const FindStart& other : others) try
    {
      if (const auto better = other())
        if (solve::NewtonResult<dim> result = attempt(*better); result.message.empty()) return result;
    }
    catch (const SolveError& error)
    {
      require_all_failed(ranks, error.what());
    }
  if (failure) std::rethrow_exception(failure);
  return first;
}

template solve::NewtonResult<2> solve_persistently(const contact::NitscheForm<2>&, std::span<const double>,
                                                   const Method&, const solve::NewtonObserver<2>&, double,
                                                   const std::function<void(const solve::NewtonStep&)>&,
                                                   std::shared_ptr<solve::Equilibrium<2>>);
template solve::NewtonResult<3> solve_persistently(const contact::NitscheForm<3>&, std::span<const double>,
                                                   const Method&, const solve::NewtonObserver<3>&, double,
                                                   const std::function<void(const solve::NewtonStep&)>&,
                                                   std::shared_ptr<solve::Equilibrium<3>>);

}  // namespace tribound::adapt
