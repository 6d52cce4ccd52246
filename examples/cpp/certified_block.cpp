/// @file certified_block.cpp
/// A program of your own: presses an elastic block on a rigid floor with Tresca friction, once step by step
/// on one mesh, once by the adaptive loop. Exit code 0 if the bound reaches the tolerance and the floor
/// carries the load.

#include <tribound/tribound.h>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

using namespace tribound;

namespace
{

constexpr double load = 0.1 * 2 - 0.06 * 1;  // pressed down on the top, lifted on the right side

/// The data: the material of the block and the conditions on its sides, by their names in the mesh.
problem::Problem<2> block(const mesh::Mesh<2>& mesh)
{
  return problem::Problem<2>(
      mesh, {{.name = {}, .material = problem::lame(1.0, 0.3)}},
      {problem::with_displacement<2>("left", {0.0, std::nullopt}),
       problem::with_traction<2>("top", {0.0, -0.1}), problem::with_traction<2>("right", {0.04, 0.06}),
       problem::with_contact<2>("bottom", problem::Tresca(0.03))});
}

/// The vertical force of the floor on the body: (T, (0, 1))_C.
double lift(const contact::NitscheForm<2>& form, const std::vector<double>& u)
{
  std::vector<double> contact_load(form.space().n_dofs(), 0.0);
  form.add_contact_load(form.traction(u), contact_load);
  double sum = 0.0;
  for (Index node = 0; node < form.space().n_nodes(); ++node) sum += contact_load[2 * node + 1];
  return sum;
}

/// Solves and certifies on one mesh; true if the bound is one.
bool certify_on_one_mesh(const adapt::Method& method, const mesh::Mesh<2>& mesh,
                         const problem::Problem<2>& problem)
{
  // The discrete problem: a(u, v) - (T(u), v)_C = L(v) in the Lagrange elements of the degree.
  const fem::LagrangeSpace<2> space(mesh, method.degree);
  const contact::NitscheForm<2> form(problem, space, method.gamma_0());
  contact::check_rigid_motions(form);

  // Its solution u^k by Newton's method, from scratch, with the traction t^k in equilibrium with it.
  const solve::NewtonResult<2> newton = solve::solve<2>(form, {}, method.newton, method.solver);
  if (newton.status != solve::NewtonStatus::converged) return false;

  // The equilibrated stress, the identities that it must satisfy, and the bound.
  const certify::Stress<2> stress = certify::equilibrate<2>(form, newton.u, newton.traction);
  const certify::IdentityDefects identities = certify::check_identities<2>(form, newton.traction, stress);
  const certify::Estimate eta = certify::estimate(form, newton.u, stress);
  const contact::StressNorms norms = contact::stress_norms(problem, space, newton.u);
  const certify::Verdict verdict = certify::judge(eta, identities, norms, 0.01);

  std::printf("one mesh: %zu Newton steps, bound %.4g, that is %.3g %% of ||sigma(u_h)||: %s\n",
              newton.steps.size(), eta.total_sharp, 100 * eta.total_sharp / norms.sigma,
              certify::to_string(verdict.status));
  return verdict.status != certify::RunStatus::not_certified && std::abs(lift(form, newton.u) - load) < 1e-8;
}

/// Refines according to the bound until it is below the tolerance.
bool adapt_until_certified(const adapt::Method& method, mesh::Mesh<2> mesh,
                           const problem::Problem<2>& problem)
{
  const adapt::LoopObserver<2> observer = {
      .step = {},
      .level = [](const adapt::LevelView<2>& view)
      {
        std::printf("level %2d: %4d cells, bound %6.3f %%\n", view.number, view.discrete.mesh.n_cells(),
                    100 * view.level.estimate.total_sharp / view.level.norms.sigma);
      }};
  const std::atomic<bool> stop = false;
  auto first = std::make_unique<adapt::Discretisation<2>>(std::move(mesh), problem, method);
  const certify::Verdict verdict =
      adapt::adapt<2>(problem, method, {.tolerance = 0.01}, std::move(first), observer, stop);
  return verdict.status == certify::RunStatus::certified;
}

}  // namespace

int main()
{
  const algebra::Environment environment;  // MPI and PETSc
  try
  {
    mesh::Mesh<2> mesh(mesh::box_mesh<2>({.lower = {0, 0}, .upper = {2, 1}, .cells = {8, 4}}));
    const problem::Problem<2> problem = block(mesh);
    const adapt::Method method{.degree = 2};

    std::printf("tribound %s\n", version());
    const bool certified = certify_on_one_mesh(method, mesh, problem);
    return adapt_until_certified(method, std::move(mesh), problem) && certified ? 0 : 1;
  }
  catch (const InputError& error)  // says where, what is wrong, and what would be right
  {
    std::fprintf(stderr, "%s\n", error.what());
  }
  catch (const SolveError& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
  }
  return 1;
}
