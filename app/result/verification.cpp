#include "app/result/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "app/console/text.h"
#include "tribound/certify/bound/certificate.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/file/json.h"
#include "tribound/io/record/record_json.h"

namespace tribound::app
{

namespace
{

constexpr const char* verification_schema = "1";

/// Whether it is the first iterate of a load step.
bool begins_load_step(const std::vector<VerifiedIterate>& iterates, std::size_t i)
{
  return iterates[i].load_step > 0 && (i == 0 || iterates[i - 1].load_step != iterates[i].load_step);
}

std::string iterate_line(const VerifiedIterate& iterate)
{
  return fmt::format("{:>4}  {:>9.3e}  {:>12.6g}  {:>12.6g}  {:>12.6g}  {:>11}  {:>10.1e}\n",
                     iterate.step.step, iterate.step.residual, iterate.bound_plain, iterate.bound,
                     iterate.dual_norm, number("{:.4f}", iterate.effectivity()), iterate.identities);
}

/// The distance from the richer solution, and the bound.
std::string energy_text(const Verification& v)
{
  const std::string unit = v.facts.behind(problem::UnitOf::energy_norm);
  std::string error = fmt::format("{:.6g}{}", v.richer->error->energy, unit);
  if (!v.energy) return error;
  if (!v.energy->reason.empty()) return error + "; no bound: " + v.energy->reason;
  const auto effectivity = v.energy_effectivity();
  return error + fmt::format("; bound {:.6g}{}", v.energy->bound, unit) +
         (effectivity ? fmt::format(", effectivity {:.4f}", *effectivity) : std::string()) +
         (v.energy->target == certify::EnergyTarget::solution ? "" : ", for the computed friction threshold");
}

std::string richer_text(const Verification& v)
{
  if (v.iterates.back().load_step > 0) return {};
  if (!v.richer) return line("richer", "not computed, because Newton's method did not converge");
  const double sigma_norm = v.iterates.back().norms.sigma;
  const std::string where =
      fmt::format("degree {} on {} cells, {} free degrees of freedom, {} Newton steps", v.richer_degree,
                  v.richer->cells, v.richer->dofs, v.richer->newton_steps);
  if (!v.richer->error) return line("richer", where) + line("", "no solution: " + v.richer->failure);
  const double error = v.richer->error->stress;
  std::string stress = fmt::format("{:.6g}{}", error, v.facts.behind(problem::UnitOf::stress_norm));
  if (sigma_norm > 0) stress += fmt::format(", {:.3g} of ||sigma||", error / sigma_norm);
  if (error > 0) stress += fmt::format("; bound / error = {:.4g}", v.iterates.back().bound / error);
  return line("richer", where) + line("energy error", energy_text(v)) + line("stress error", stress) +
         quantities_text(v.quantities(v.iterates.back()), v.facts);
}

std::string status_text(const Verification& v)
{
  std::string problem = violation(v);
  if (!problem.empty()) return problem;
  double smallest = std::numeric_limits<double>::infinity();
  double largest = 0;
  for (const VerifiedIterate& iterate : v.iterates)
    if (const auto e = iterate.effectivity())
    {
      smallest = std::min(smallest, *e);
      largest = std::max(largest, *e);
    }
  const bool has_intervals = std::ranges::any_of(
      v.iterates, [&](const VerifiedIterate& iterate) { return hold(v.quantities(iterate)).has_value(); });
  return (largest == 0 ? std::string("bound and dual norm are both round-off")
                       : fmt::format("the bound holds at every iterate, effectivity {:.4f} to {:.4f}",
                                     smallest, largest)) +
         (has_intervals ? "; so do the intervals that can be compared" : "");
}

io::Json json(const Verification& v, const VerifiedIterate& iterate)
{
  io::Json object{{"step", iterate.step.step},
                  {"residual", iterate.step.residual},
                  {"damping", iterate.step.damping},
                  {"delta", iterate.step.delta},
                  {"bound", iterate.bound},
                  {"bound_plain", iterate.bound_plain},
                  {"dual_norm", iterate.dual_norm},
                  {"effectivity", io::number_or_null(iterate.effectivity())},
                  {"sigma_norm", iterate.norms.sigma},
                  {"identities", iterate.identities}};
  if (iterate.load_step > 0) object.update({{"load_step", iterate.load_step}, {"t", iterate.t}});
  if (const auto quantities = v.quantities(iterate); !quantities.empty())
    object["quantities"] = quantities_json(quantities);
  return object;
}

io::Json richer_json(const Verification& v)
{
  if (!v.richer) return nullptr;
  const certify::RicherSolution& richer = *v.richer;
  const bool is_bounded = v.energy && v.energy->reason.empty();
  return {{"degree", v.richer_degree},
          {"cells", richer.cells},
          {"dofs", richer.dofs},
          {"newton_steps", richer.newton_steps},
          {"energy_error", richer.error ? io::Json(richer.error->energy) : io::Json(nullptr)},
          {"stress_error", richer.error ? io::Json(richer.error->stress) : io::Json(nullptr)},
          {"failure", richer.failure},
          {"energy_bound", is_bounded ? io::Json(v.energy->bound) : io::Json(nullptr)},
          {"energy_effectivity", io::number_or_null(v.energy_effectivity())}};
}

}  // namespace

std::string VerifiedIterate::refusal() const
{
  if (std::max(bound, norms.sigma) <= norms.round_off) return {};
  return certify::identity_violation(identities);
}

namespace
{

/// For the last iterate, or the last one of a load step.
std::string refusal_of_a_solution(const Verification& v)
{
  for (std::size_t i = 0; i < v.iterates.size(); ++i)
    if (i + 1 == v.iterates.size() || begins_load_step(v.iterates, i + 1))
      if (std::string refusal = v.iterates[i].refusal(); !refusal.empty()) return refusal;
  return {};
}

}  // namespace

std::optional<double> Verification::energy_effectivity() const
{
  if (!energy || !richer || !richer->error) return std::nullopt;
  return certify::energy_effectivity(*energy, richer->error->energy, iterates.back().norms.energy);
}

std::vector<VerifiedQuantity> Verification::quantities(const VerifiedIterate& iterate) const
{
  if (!iterate.energy) return {};
  return verified_quantities(*iterate.energy, richer_energy);
}

std::string violation(const Verification& verification)
{
  for (const VerifiedIterate& iterate : verification.iterates)
    if (const auto e = iterate.effectivity(); e && *e < 1 && iterate.refusal().empty())
      return fmt::format(
          "the guarantee is violated: after Newton step {}{} the bound {:.9g} is below the dual norm of the "
          "residual, "
          "which is at least {:.9g} (effectivity {:.6f})",
          iterate.step.step,
          iterate.load_step > 0 ? fmt::format(" of load step {}", iterate.load_step) : std::string(),
          iterate.bound, iterate.dual_norm, *e);
  if (const auto e = verification.energy_effectivity(); e && *e < 1)
    return fmt::format(
        "the guarantee is violated: the bound {:.9g} of the error in the energy norm is below the distance "
        "{:.9g} "
        "from the richer solution",
        verification.energy->bound, verification.richer->error->energy);
  for (const VerifiedIterate& iterate : verification.iterates)
    if (const std::string wrong = violation(verification.quantities(iterate)); !wrong.empty())
      return fmt::format("the guarantee is violated: after Newton step {} {}", iterate.step.step, wrong);
  return refusal_of_a_solution(verification);
}

std::string verification_text(const Verification& v, const std::string& directory)
{
  std::string text =
      line("dual norm",
           fmt::format("from below, degree {} on {} cells ({} refinements), {} degrees of freedom",
                       v.dual_space.degree, v.dual_space.cells, v.refinements, v.dual_space.dofs)) +
      fmt::format("{:>4}  {:>9}  {:>12}  {:>12}  {:>12}  {:>11}  {:>10}\n", "step", "residual", "plain bound",
                  "bound", "dual norm", "effectivity", "identities");
  for (std::size_t i = 0; i < v.iterates.size(); ++i)
  {
    if (begins_load_step(v.iterates, i))
      text += line(fmt::format("load step {}", v.iterates[i].load_step),
                   fmt::format("t = {:.9g}", v.iterates[i].t));
    text += iterate_line(v.iterates[i]);
  }
  const VerifiedIterate& last = v.iterates.back();
  text += line("||sigma||",
               last.norms.sigma > 0
                   ? fmt::format("{:.6g}{}; bound / ||sigma|| = {:.4g}", last.norms.sigma,
                                 v.facts.behind(problem::UnitOf::stress_norm), last.bound / last.norms.sigma)
                   : std::string("0"));
  return text + richer_text(v) + line("status", status_text(v)) + line("results", directory);
}

namespace
{

const char* guarantee(const Verification& v)
{
  const std::string problem = violation(v);
  if (problem.empty()) return "holds";
  return problem == refusal_of_a_solution(v) ? "not certified" : "violated";
}

}  // namespace

std::string verification_json(const Verification& v)
{
  const VerifiedIterate& last = v.iterates.back();
  io::Json object{
      {"schema", verification_schema},
      {"title", v.facts.title},
      {"file", v.facts.file},
      {"d", v.facts.dimension},
      {"p", v.facts.degree},
      {"stress", certify::to_string(v.facts.stress)},
      {"friction", v.facts.friction},
      {"gamma0", v.facts.gamma0},
      {"units", io::units_json(v.facts)},
      {"cells", v.mesh.cells},
      {"dofs", v.mesh.free_dofs},
      {"guarantee", guarantee(v)},
      {"converged", v.converged},
      {"bound", last.bound},
      {"bound_plain", last.bound_plain},
      {"dual_norm", last.dual_norm},
      {"effectivity", io::number_or_null(last.effectivity())},
      {"sigma_norm", last.norms.sigma},
      {"refinements", v.refinements},
      {"dual_space",
       {{"degree", v.dual_space.degree}, {"cells", v.dual_space.cells}, {"dofs", v.dual_space.dofs}}},
      {"richer_solution", richer_json(v)},
      {"iterates", io::Json::array()},
      {"times", io::Json::object()}};
  if (const auto quantities = v.quantities(last); !quantities.empty())
    object["quantities"] = quantities_json(quantities);
  for (const VerifiedIterate& iterate : v.iterates) object["iterates"].push_back(json(v, iterate));
  for (const auto& [stage, seconds] : v.times) object["times"][stage] = seconds;
  return io::json_text(object);
}

}  // namespace tribound::app
