#include "tribound/io/record/level_json.h"

#include "tribound/io/file/json.h"
#include "tribound/io/record/error_bars.h"
#include "tribound/io/record/observations_json.h"

namespace tribound::io
{

namespace
{

Json json(const std::optional<certify::Bound>& bound, const certify::RunKind& kind)
{
  if (!bound) return nullptr;
  Json object;
  for (const certify::Component& c : certify::components_of_run(kind))
    object[c.name] = bound->global.*c.value;
  return object;
}

Json json(const std::optional<certify::IdentityDefects>& identities)
{
  if (!identities) return nullptr;
  return {{"divergence", identities->divergence},
          {"jump", identities->jump},
          {"neumann", identities->neumann},
          {"contact", identities->contact},
          {"symmetry", identities->is_symmetric ? Json(identities->symmetry) : Json(nullptr)}};
}

Json json(const Resultants& resultants)
{
  return {{"resolution", resultants.resolution}, {"normal", resultants.normal},
          {"tangential", resultants.tangential}, {"abs_tangential", resultants.abs_tangential},
          {"force", resultants.force},           {"moment", resultants.moment}};
}

Json json(const std::optional<Sliding>& sliding)
{
  if (!sliding) return nullptr;
  return {{"coefficient", sliding->coefficient},
          {"sliding_factor", sliding->sliding_factor},
          {"safety_factor", number_or_null(sliding->safety_factor)}};
}

Json json(const PairFigures& pair)
{
  return {{"master", pair.master},
          {"law", pair.law},
          {"segments", pair.segments},
          {"covered", pair.covered},
          {"covered_share", pair.covered_share},
          {"covered_master", pair.covered_master},
          {"gap", {{"smallest", pair.smallest_gap}, {"largest", pair.largest_gap}}},
          {"largest_tension", pair.largest_tension},
          {"moment_on_master", pair.moment_on_master}};
}

Json json(const adapt::CertifiedStep& record, bool regularised)
{
  Json object{{"step", record.step.step},
              {"degree", record.step.degree},
              {"gamma0", record.step.gamma0},
              {"residual", record.step.residual},
              {"damping", record.step.damping},
              {"linear_iterations", record.step.linear_iterations},
              {"factorised", record.step.factorised},
              {"seconds", record.step.seconds},
              {"total", number_or_null(bound_value(record.bound, &certify::Bound::total))},
              {"accepted", record.accepted}};
  if (regularised) object["delta"] = record.step.delta;
  return object;
}

void add(Json& object, const HydraulicFigures& figures)
{
  object["effective_normal"] = figures.effective_normal;
  object["uplift"] = figures.uplift;
  object["resultant_x"] = number_or_null(figures.resultant_x);
  object["resultant_x_total"] = number_or_null(figures.resultant_x_total);
  object["in_kernel"] = figures.in_kernel ? Json(*figures.in_kernel) : Json(nullptr);
  object["sliding_safety"] = number_or_null(figures.sliding_safety);
  object["sff_intact"] = number_or_null(figures.sff_intact);
  object["sff_now"] = number_or_null(figures.sff_now);
  object["overturning"] = number_or_null(figures.overturning);
  object["crack_tip"] = number_or_null(figures.crack_tip);
  object["crack_farthest"] = number_or_null(figures.crack_farthest);
  object["cmod"] = number_or_null(figures.cmod);
  object["csd"] = number_or_null(figures.csd);
}

Json json(const InterfaceFigures& figures)
{
  Json object{{"measure", figures.measure},       {"opened", figures.opened},
              {"slipping", figures.slipping},     {"broken", figures.broken},
              {"process", figures.process},       {"damage", figures.damage},
              {"dissipated", figures.dissipated}, {"dissipated_friction", figures.rubbed},
              {"stored", figures.stored}};
  if (figures.hydraulic) add(object, *figures.hydraulic);
  return object;
}

}  // namespace

Json balance_json(const certify::Balance& balance)
{
  Json object{{"about", balance.about}, {"rows", Json::array()}};
  for (const certify::BalanceRow& row : balance.rows)
    object["rows"].push_back({{"kind", certify::to_string(row.kind)},
                              {"name", row.name},
                              {"source", row.source},
                              {"force", row.force},
                              {"moment", row.moment}});
  return object;
}

Json stages_json(const StageTimes& times)
{
  Json object;
  for (const auto& [name, seconds] : stages) object[name] = times.*seconds;
  return object;
}

void add_results(Json& object, const LevelRecord& level)
{
  object["cells"] = level.cells;
  object["dofs"] = level.dofs;
  object["bound"] = number_or_null(bound_value(level.bound, &certify::Bound::total_sharp));
  object["bound_plain"] = number_or_null(bound_value(level.bound, &certify::Bound::total));
  object["relative"] = number_or_null(relative_bound(level));
  object["components"] = json(level.bound, run_kind(level));
  if (is_regularised(level))
    object["regularisation"] = {{"delta", number_or_null(last_delta(level))},
                                {"updates", *level.delta_updates}};
  object["identities"] = json(level.identities);
  object["energy"] = level.figures.energy;
  if (level.figures.spring_energy) object["spring_energy"] = *level.figures.spring_energy;
  for (const RigidFigures& part : level.figures.rigid_parts)
    object["rigid_parts"].push_back(
        {{"boundary", part.boundary}, {"displacement", part.displacement}, {"rotation", part.rotation}});
  object["sigma_norm"] = level.figures.sigma_norm;
  add_energy_error(object, level);
  object["max_displacement"] = level.figures.max_displacement;
  if (!level.figures.bodies.empty()) object["bodies"] = Json::array();
  for (const BodyFigures& body : level.figures.bodies)
    object["bodies"].push_back({{"name", body.name},
                                {"cells", body.cells},
                                {"energy", body.energy},
                                {"bound", level.bound ? Json(body.bound) : Json(nullptr)}});
  add_observations(object, level);
  object["contact"] = nullptr;
  if (level.figures.boundary_contact.empty()) return;
  Json contact = json(level.figures.contact);
  for (const Resultants& part : level.figures.boundary_contact)
  {
    Json& boundary = contact["boundaries"][part.boundary];
    boundary = json(part);
    boundary["sliding"] = json(sliding(part));
    if (part.pair) boundary.update(json(*part.pair));
  }
  object["contact"] = contact;
}

void add_load_step(Json& object, const LevelRecord& level)
{
  const LoadStepRecord& step = *level.load_step;
  object["t"] = step.t;
  object["control"] = step.control;
  object["cuts"] = step.cuts;
  object["passes"] = step.passes;
  object["relative_path"] = number_or_null(bound_along_path(level));
  object["largest_sigma"] = step.largest_sigma;
  object["dissipated"] = step.dissipated;
  object["dissipated_friction"] = step.rubbed;
  object["stored"] = step.all.stored;
  object["work"] = step.work;
  object["energy_balance"] = step.balance;
  object["effective_normal"] = step.effective_normal;
  object["effective_tangential"] = step.tangential;
  object["balance"] = level.balance ? balance_json(*level.balance) : Json(nullptr);
  for (const auto& [name, value] : step.watched) object["watch"][name] = value;
  object["interfaces"] = Json::object();
  for (const InterfaceFigures& figures : step.interfaces)
    object["interfaces"][figures.boundary] = json(figures);
}

Json level_json(const LevelRecord& level)
{
  Json object;
  object[level.load_step && !level.load_step_number ? "step" : "level"] = level.level;
  if (level.load_step_number) object["step"] = *level.load_step_number;
  if (level.load_step) add_load_step(object, level);
  add_results(object, level);
  object["finishing_steps"] = level.finishing_steps;
  object["solver"] =
      level.newton.empty() ? Json(nullptr) : algebra::to_string(level.newton.back().step.method);
  object["newton"] = Json::array();
  for (const adapt::CertifiedStep& record : level.newton)
    object["newton"].push_back(json(record, is_regularised(level)));
  object["times"] = stages_json(level.times.stages);
  object["times"].update({{"level", level.times.level},
                          {"solve_cpu", level.times.solve_cpu},
                          {"certify_cpu", level.times.certify_cpu},
                          {"output_cpu", level.times.output_cpu},
                          {"level_cpu", level.times.level_cpu},
                          {"factorisations", level.times.factorisations}});
  return object;
}

}  // namespace tribound::io
