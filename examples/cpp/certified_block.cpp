/// @file certified_block.cpp
/// A program of your own: presses an elastic block on a rigid floor with Tresca friction, once step by step
/// on one mesh, once by the adaptive loop. Exit code 0 if the bound reaches the tolerance and the floor
/// carries the load.

#include <tribound/tribound.h>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

using namespace tribound;

namespace
{

constexpr double load = 0.1 * 2 - 0.06 * 1;  // pressed down on the top, lifted on the right side

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
bool certify_on_one_mesh(const case_file::Config& config, const mesh::Mesh<2>& mesh,
                         const problem::Problem<2>& problem)
{
  // The discrete problem: a(u, v) - (T(u), v)_C = L(v) in the Lagrange elements of the degree.
  const fem::LagrangeSpace<2> space(mesh, config.degree);
  const contact::NitscheForm<2> form(problem, space, config.gamma0());
  contact::check_rigid_motions<2>(problem, space, form.data(), form.load());

  // Its solution u^k by Newton's method, from scratch, with the traction t^k in equilibrium with it.
  const solve::NewtonResult<2> newton = solve::solve<2>(form, {}, config.newton, config.solver);
  if (newton.status != solve::NewtonStatus::converged) return false;

  // The equilibrated stress, the identities that make it one, and the bound.
  const certify::Stress<2> stress = certify::equilibrate<2>(form, newton.u, newton.traction);
  const certify::IdentityDefects identities = certify::check_identities<2>(form, newton.traction, stress);
  const certify::Estimate eta = certify::estimate(form, newton.u, stress);
  const contact::StressNorms norms = contact::stress_norms(problem, space, newton.u);
  const certify::Verdict verdict =
      certify::judge(eta, identities, config.degree, norms, config.adapt.tolerance);

  std::printf("one mesh: %zu Newton steps, bound %.4g, that is %.3g %% of ||sigma(u_h)||: %s\n",
              newton.steps.size(), eta.total_sharp, 100 * eta.total_sharp / norms.sigma,
              to_string(verdict.status));
  return verdict.status != certify::RunStatus::not_certified && std::abs(lift(form, newton.u) - load) < 1e-8;
}

/// Refines where the bound asks for it, until it is below the tolerance.
bool adapt_until_certified(const case_file::Config& config, mesh::Mesh<2> mesh,
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
  const certify::Verdict verdict = adapt::adapt<2>(
      problem, config, std::make_unique<adapt::Discretisation<2>>(std::move(mesh), problem, config), observer,
      stop);
  std::printf("%s %s\n", to_string(verdict.status), verdict.reason.c_str());
  return verdict.status == certify::RunStatus::certified;
}

}  // namespace

int main()
{
  const algebra::Environment environment;  // MPI and PETSc
  try
  {
    // The case, here from text; read_config("case.toml") reads a file.
    const case_file::Config config = case_file::parse_config(R"(
      degree = 2
      mesh.box = { lower = [0, 0], upper = [2, 1], cells = [8, 4] }
      material = { E = 1.0, nu = 0.3 }
      adapt.tolerance = 0.01
      [boundary]
      left.displacement = [0, "free"]
      top.traction = [0, -0.1]
      right.traction = [0.04, 0.06]
      bottom.contact = { friction = "tresca", threshold = 0.03 }
    )");

    // The mesh, and the problem on it: data, material and friction by the names of regions and boundaries.
    mesh::Mesh<2> mesh(mesh::box_mesh<2>(std::get<case_file::BoxMesh>(config.mesh)));
    const problem::Problem<2> problem(config, mesh.region_names(), mesh.boundary_names());

    std::printf("tribound %s\n", version());
    const bool certified = certify_on_one_mesh(config, mesh, problem);
    return adapt_until_certified(config, std::move(mesh), problem) && certified ? 0 : 1;
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
