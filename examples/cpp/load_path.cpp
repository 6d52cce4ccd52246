/// @file load_path.cpp
/// A program of your own: presses a block on a base to which it is bonded, and pushes it to and fro until the
/// bond is lost. Every load step has its bound. Exit code 0 if all steps are solved and their bounds hold.

#include <tribound/tribound.h>

#include <cstdio>
#include <optional>
#include <string>
#include <utility>

using namespace tribound;

namespace
{

/// Formulas may contain t, the load factor.
problem::Problem<2> pushed_block(const mesh::Mesh<2>& mesh)
{
  const problem::Joint bond{.tension = {.strength = 0.05, .fracture_energy = 5e-4},
                            .cohesion = 0.04,
                            .slip_length = 0.02,
                            .coefficient = 0.5};
  return problem::Problem<2>(
      mesh, {{.name = {}, .material = problem::lame(1.0, 0.3)}},
      {problem::with_traction<2>("top", {0.0, -0.05}),
       problem::with_displacement<2>("right", {problem::Field("0.1*t", {.key = "push"}), std::nullopt}),
       problem::with_contact<2>("bottom", problem::JointLaw(bond))});
}

/// Integrals over the base of a committed step.
struct Base
{
  double damage = 0;  ///< over all of it
  double dissipated = 0;
  double force = 0;  ///< along it

  explicit Base(const adapt::LoadStep<2>& step)
  {
    const contact::NitscheForm<2>& form = step.at->discrete.form;
    double length = 0;
    for (std::size_t i = 0; i < step.responses.size(); ++i)
    {
      const double weight = form.contact_points()[i].weight;
      damage += weight * step.responses[i].state.damage;
      dissipated += weight * step.responses[i].dissipated;
      force += weight * step.responses[i].traction[0];
      length += weight;
    }
    damage /= length;
  }
};

}  // namespace

int main()
{
  const algebra::Environment environment;  // MPI and PETSc
  try
  {
    mesh::Mesh<2> mesh(mesh::box_mesh<2>({.lower = {0, 0}, .upper = {2, 1}, .cells = {16, 8}}));
    const problem::Problem<2> problem = pushed_block(mesh);
    const adapt::Method method{.degree = 2, .stopping = {.criterion = adapt::Stopping::tolerance}};
    adapt::LoadPath<2> path(problem, method, {.tolerance = 0.05}, std::move(mesh));

    bool holds = true;
    for (const double t : {0.25, 0.5, 0.75, 1.0, 0.0, -1.0, 0.0, 1.0})
    {
      const std::string failure = path.advance(
          t,
          [&](const adapt::LoadStep<2>& step)
          {
            const Base base(step);
            std::printf("step %2d: t = %5.2f, force %8.5f, damage %5.3f, dissipated %.6f, bound %.2f %%\n",
                        step.number, step.t, base.force, base.damage, base.dissipated,
                        100 * step.level.estimate.total_sharp / step.level.norms.sigma);
            holds = holds && step.verdict.status != certify::RunStatus::not_certified;
          });
      if (failure.empty()) continue;
      std::fprintf(stderr, "%s\n", failure.c_str());
      return 1;
    }
    return holds ? 0 : 1;
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
