// A program of somebody else: presses an elastic block on a rigid floor and checks the balance of forces.

#include <tribound.h>
#include <cmath>
#include <cstdio>

int main()
{
  const tribound::Environment environment;

  // 1. The case, here from text.
  const tribound::Config config = tribound::parse_config(R"(
    degree = 2
    mesh.box = { lower = [0, 0], upper = [2, 1], cells = [8, 4] }
    material = { E = 1.0, nu = 0.3 }
    [boundary]
    left.displacement = [0, "free"]
    top.traction = [0, -0.1]
    bottom.contact = { friction = "coulomb", coefficient = 0.3 }
  )");

  // 2. The mesh, the problem on it, and the discrete problem.
  const tribound::Mesh<2> mesh(tribound::box_mesh<2>(std::get<tribound::BoxMesh>(config.mesh)));
  const tribound::Problem<2> problem(config, mesh.region_names(), mesh.boundary_names());
  const tribound::LagrangeSpace<2> space(mesh, config.degree);
  const tribound::NitscheForm<2> form(problem, space, config.gamma0());

  // 3. Its solution.
  const tribound::NewtonResult<2> result = tribound::solve(form, {}, config.newton, config.solver);
  if (result.status != tribound::NewtonStatus::converged) return 1;

  // 4. The floor carries the load: (T, (0, 1))_C = 0.1 * 2.
  std::vector<double> contact_load(space.n_dofs(), 0.0);
  form.add_contact_load(form.traction(result.u), contact_load);
  double lift = 0.0;
  for (tribound::Index node = 0; node < space.n_nodes(); ++node) lift += contact_load[2 * node + 1];
  std::printf("tribound %s: %zu Newton steps, the floor carries %.12f\n", tribound::version(),
              result.steps.size(), lift);
  return std::abs(lift - 0.2) < 1e-8 ? 0 : 1;
}
