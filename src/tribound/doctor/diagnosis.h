#pragma once

/// @file diagnosis.h
/// Everything that `tribound check` finds out about a case before it is solved.

#include <optional>
#include <string>
#include <vector>

#include "tribound/adapt/loop.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/doctor/contact_facts.h"
#include "tribound/doctor/cost.h"
#include "tribound/doctor/load_facts.h"
#include "tribound/doctor/mesh_quality.h"
#include "tribound/doctor/pair_facts.h"
#include "tribound/doctor/path_facts.h"
#include "tribound/doctor/support_facts.h"
#include "tribound/doctor/units.h"

namespace tribound::doctor
{

struct Diagnosis
{
  int degree = 1;
  bool refines = true;  ///< whether the mesh is adapted
  std::vector<ContactHeldMotion> held_by_contact;
  std::optional<LoadBeyondContact> beyond_contact;  ///< on a load path
  std::vector<OverconstrainedCorner> corners;
  std::vector<ContactBoundaryFacts> contacts;
  std::vector<PairFacts> pairs;
  LoadFacts loads;
  problem::Units units{};               ///< that the case names
  std::vector<problem::Units> guesses;  ///< plausible_units()
  MeshQuality mesh;
  std::vector<CostEstimate> costs;
  double multigrid_bytes = 0;  ///< for the degree of the case with solver.method = "iterative"
  adapt::MemoryLimit memory;

  /// " MPa", to be appended to a number; empty where no units are named.
  [[nodiscard]] std::string behind(problem::UnitOf what) const
  {
    return units.behind(what, static_cast<int>(loads.extent.size()));
  }
};

/// For a case with supported bodies, see check_rigid_motions().
template <int dim>
[[nodiscard]] Diagnosis diagnose(const contact::NitscheForm<dim>& form, const adapt::Method& method,
                                 const adapt::AdaptOptions& options, const problem::Units& units = {})
{
  Diagnosis result;
  result.degree = method.degree;
  result.refines = options.max_levels > 0;
  result.held_by_contact = motions_held_by_contact(form);
  result.corners = overconstrained_corners(form);
  result.contacts = contact_boundary_facts(form);
  result.pairs = pair_facts(form);
  result.loads = load_facts(form);
  result.units = units;
  result.guesses = plausible_units(result.loads);
  result.mesh = mesh_quality(form.space().mesh());
  result.costs = cost_estimates(form.space().mesh(), method.solver);
  algebra::SolverOptions multigrid = method.solver;
  multigrid.method = algebra::LinearMethod::iterative;
  result.multigrid_bytes = cost_estimates(form.space().mesh(), multigrid)[method.degree - 1].bytes;
  result.memory = adapt::memory_limit(options);
  return result;
}

}  // namespace tribound::doctor
