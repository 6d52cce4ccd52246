#include "app/result/judgement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>

#include "app/console/text.h"
#include "tribound/io/file/csv.h"
#include "tribound/io/file/json.h"
#include "tribound/io/record/record_json.h"

namespace tribound::app
{

namespace
{

/// "between 7.31 % and 7.9 %".
std::string between(const certify::ErrorInterval& relative)
{
  if (!std::isfinite(relative.upper)) return fmt::format("at least {}", percent(relative.lower));
  return fmt::format("between {} and {}", percent(relative.lower), percent(relative.upper));
}

std::string absolute(const certify::ErrorInterval& error)
{
  return fmt::format("between {:.6g} and {:.6g}", error.lower, error.upper);
}

std::string field_text(const certify::JudgedField& field, std::string_view caption, const std::string& unit)
{
  std::string text = line(caption, (field.relative ? between(*field.relative) + ", " : std::string()) +
                                       absolute(field.error) + unit + ", guaranteed");
  if (field.regions.size() > 1)
    for (const certify::JudgedRegion& region : field.regions)
      text += line("", fmt::format("in \"{}\": {}{}", region.name, absolute(region.error), unit));
  return text;
}

std::string core_text(const certify::ErrorCore& core)
{
  if (core.share < 0.05) return {};
  return line(
      "where",
      fmt::format("at least {:.0f} % of the squared error lies in {:.2g} % of the body, {}, around "
                  "({:.4g})",
                  std::floor(100 * core.share), 100 * core.volume,
                  count(static_cast<long>(core.n_cells), "cell", "cells"), fmt::join(core.centre, ", ")));
}

std::string number_text(const JudgedNumber& number)
{
  const std::string& name = number.interval.name;
  const std::string caption = name.size() < caption_width ? name : name + "  ";
  const std::string unit = number.unit.empty() ? "" : " " + number.unit;
  if (!number.interval.reason.empty())
    return line(caption, (number.theirs ? fmt::format("{:.6g}{}, ", *number.theirs, unit) : std::string()) +
                             "not judged: " + number.interval.reason);
  const std::string exact = number.interval.exact
                                ? fmt::format("exact: {:.6g}{}", number.interval.lower, unit)
                                : fmt::format("exact: between {:.6g} and {:.6g}{}", number.interval.lower,
                                              number.interval.upper, unit);
  const auto wrong = number.wrong_by();
  if (!wrong) return line(caption, fmt::format("{}; theirs is not known: --number {}=VALUE", exact, name));
  const double size = std::max(std::abs(number.interval.lower), std::abs(number.interval.upper));
  const std::string parts =
      size > 0 ? fmt::format(", {} to {}", percent(wrong->lower / size), percent(wrong->upper / size)) : "";
  return line(caption, fmt::format("{:.6g}{}; {}; wrong by {:.3g} to {:.3g}{}", *number.theirs, unit, exact,
                                   wrong->lower, wrong->upper, parts));
}

std::string force_text(const JudgedForce& force, const io::CaseFacts& facts)
{
  const std::string unit = facts.behind(problem::UnitOf::force);
  if (facts.is_axisymmetric)
    return line("force", fmt::format("at \"{}\": axial {:.5g}, in equilibrium {:.5g}{}", force.boundary,
                                     force.theirs[1], force.ours[1], unit));
  return line("force", fmt::format("at \"{}\": ({:.5g}), in equilibrium ({:.5g}){}", force.boundary,
                                   fmt::join(force.theirs, ", "), fmt::join(force.ours, ", "), unit));
}

io::Json json(const certify::ErrorInterval& interval)
{
  return {interval.lower, std::isfinite(interval.upper) ? io::Json(interval.upper) : io::Json(nullptr)};
}

io::Json json(const certify::JudgedField& field, double bound)
{
  io::Json object{{"error", json(field.error)},
                  {"relative", field.relative ? json(*field.relative) : io::Json(nullptr)},
                  {"distance", field.distance},
                  {"bound", bound},
                  {"regions", io::Json::array()},
                  {"core",
                   {{"share", field.core.share},
                    {"volume", field.core.volume},
                    {"cells", field.core.n_cells},
                    {"centre", field.core.centre}}},
                  {"halving_cells", field.halving.size()}};
  for (const certify::JudgedRegion& region : field.regions)
    object["regions"].push_back(
        {{"name", region.name}, {"distance", region.distance}, {"error", json(region.error)}});
  return object;
}

io::Json json(const JudgedNumber& number)
{
  const bool is_known = number.interval.reason.empty();
  const auto wrong = number.wrong_by();
  return {{"name", number.interval.name},
          {"theirs", io::number_or_null(number.theirs)},
          {"lower", is_known ? io::Json(number.interval.lower) : io::Json(nullptr)},
          {"upper", is_known ? io::Json(number.interval.upper) : io::Json(nullptr)},
          {"exact", number.interval.exact},
          {"wrong_by", wrong ? json(*wrong) : io::Json(nullptr)},
          {"rests_on", io::text_or_null(number.interval.basis)},
          {"reason", io::text_or_null(number.interval.reason)}};
}

}  // namespace

std::string percent(double part)
{
  return std::isfinite(part) ? fmt::format("{:.4g} %", 100 * part) : "unknown";
}

std::optional<certify::ErrorInterval> JudgedNumber::wrong_by() const
{
  if (!theirs || !interval.reason.empty()) return std::nullopt;
  return certify::ErrorInterval{
      std::max({0.0, interval.lower - *theirs, *theirs - interval.upper}),
      std::max(std::abs(*theirs - interval.lower), std::abs(*theirs - interval.upper))};
}

void JudgementRecord::balance(const certify::Balance& ours)
{
  if (forces.empty()) return;
  std::vector<double> sum(forces.front().theirs.size(), 0.0);
  const auto add = [](std::vector<double>& to, const std::vector<double>& force)
  { std::ranges::transform(to, force, to.begin(), std::plus<>()); };
  const auto size = [](const std::vector<double>& force)
  { return Eigen::Map<const Eigen::VectorXd>(force.data(), std::ssize(force)).norm(); };
  double largest = 0;
  for (JudgedForce& force : forces)
  {
    add(sum, force.theirs);
    force.ours.assign(sum.size(), 0.0);
  }
  for (const certify::BalanceRow& row : ours.rows)
  {
    if (row.kind == certify::BalanceKind::sum) continue;
    largest = std::max(largest, size(row.force));
    const auto at = std::ranges::find(forces, row.name, &JudgedForce::boundary);
    add(row.source == "body force" || at == forces.end() ? sum : at->ours, row.force);
  }
  imbalance = largest > 0 ? std::optional(size(sum) / largest) : std::nullopt;
}

bool JudgementRecord::is_sharp() const
{
  return judgement && judgement->bound <= sharpness * judgement->displacement.distance;
}

std::string JudgementRecord::status() const
{
  if (!judgement) return "no bound";
  if (!accept) return is_sharp() ? "judged" : "wide";
  const certify::ErrorInterval& relative = *judgement->displacement.relative;
  return relative.upper <= *accept ? "accepted" : relative.lower > *accept ? "rejected" : "undecided";
}

std::string why_wide(const JudgementRecord& record)
{
  if (record.status() != "wide") return {};
  const double part = record.judgement->bound / record.judgement->displacement.distance;
  return fmt::format(": the bound is {} the distance, judge.sharpness = {:g}; {}",
                     part <= 1 ? fmt::format("{:.3g} of", part) : std::string("larger than"),
                     record.sharpness,
                     record.load_step ? "a smaller adapt.tolerance makes it smaller"
                                      : "give [adapt] more levels, unknowns or time");
}

std::string judgement_text(const JudgementRecord& r, const std::string& directory)
{
  std::string text =
      line("theirs", fmt::format("{}: {}", r.solution.name, r.description)) +
      paragraph("read as",
                fmt::format("{}; {} of the case's mesh, nodes {} their places", r.read_as,
                            count(r.their_cells, "cell", "cells"),
                            r.node_distance > 0 ? fmt::format("up to {:.2g}{} from", r.node_distance,
                                                              r.facts.behind(problem::UnitOf::length))
                                                : std::string("at")));
  if (r.judgement)
  {
    const certify::Judgement& j = *r.judgement;
    text += paragraph("errors", "against " + r.target);
    text += field_text(j.displacement, "displacement", r.facts.behind(problem::UnitOf::energy_norm));
    if (j.stress) text += field_text(*j.stress, "stress", r.facts.behind(problem::UnitOf::energy_norm));
    text += core_text(j.displacement.core);
    if (!j.doubt.empty()) text += paragraph("doubt", "their displacement " + j.doubt);
    text += line("to halve it",
                 fmt::format("refine the {} that judged_cells.csv marks",
                             count(static_cast<long>(j.displacement.halving.size()), "cell", "cells")));
  }
  else
    text += paragraph("errors", "not bounded: " + r.reason);
  for (const JudgedNumber& number : r.numbers) text += number_text(number);
  for (const JudgedForce& force : r.forces)
    if (!force.ours.empty()) text += force_text(force, r.facts);
  if (r.imbalance)
    text += line("balance",
                 fmt::format("the forces of their stress miss the loads by {}", percent(*r.imbalance)));
  if (r.penetration)
    text += line("penetration", *r.penetration > 0
                                    ? fmt::format("up to {:.4g}{} on \"{}\"", *r.penetration,
                                                  r.facts.behind(problem::UnitOf::length), r.penetrated)
                                    : std::string("none at the points of contact"));
  if (r.tension && r.tension->n_facets > 0)
    text += line("tension", fmt::format("of their stress in contact up to {:.4g}{} on {}", r.tension->largest,
                                        r.facts.behind(problem::UnitOf::stress),
                                        count(static_cast<long>(r.tension->n_facets), "facet", "facets")));
  return text + paragraph("status", r.status() + why_wide(r)) + line("results", directory);
}

std::optional<double> JudgementRecord::largest_error() const
{
  return judgement ? std::optional(judgement->displacement.relative->upper) : std::nullopt;
}

io::Json judgement_object(const JudgementRecord& r)
{
  io::Json object{
      {"schema", judgement_schema},
      {"title", r.facts.title},
      {"purpose", r.facts.purpose},
      {"file", r.facts.file},
      {"model", io::model_json(r.facts)},
      {"d", r.facts.dimension},
      {"p", r.facts.degree},
      {"friction", r.facts.friction},
      {"units", io::units_json(r.facts)},
      {"solution",
       {{"file", r.solution.name},
        {"sha256", r.solution.sha256},
        {"description", r.description},
        {"cells", r.their_cells}}},
      {"read_as", r.read_as},
      {"node_distance", r.node_distance},
      {"curved_distance", r.curved_distance},
      {"load_step", r.load_step ? io::Json(*r.load_step) : io::Json(nullptr)},
      {"t", io::number_or_null(r.t)},
      {"status", r.status()},
      {"sharpness", r.sharpness},
      {"accept", io::number_or_null(r.accept)},
      {"guaranteed_for", io::text_or_null(r.target)},
      {"reason", io::text_or_null(r.reason)},
      {"cells", r.cells},
      {"displacement", nullptr},
      {"stress", nullptr},
      {"quantities", io::Json::array()},
      {"forces", io::Json::array()},
      {"imbalance", io::number_or_null(r.imbalance)},
      {"penetration", io::number_or_null(r.penetration)},
      {"tension", r.tension ? io::Json{{"largest", r.tension->largest}, {"facets", r.tension->n_facets}}
                            : io::Json(nullptr)},
      {"penetrated", io::text_or_null(r.penetrated)},
      {"rigid_difference", io::Json::array()},
      {"factor", nullptr},
      {"doubt", nullptr}};
  for (const JudgedForce& force : r.forces)
    object["forces"].push_back(
        {{"boundary", force.boundary}, {"theirs", force.theirs}, {"ours", force.ours}});
  for (const JudgedNumber& number : r.numbers) object["quantities"].push_back(json(number));
  if (!r.judgement) return object;
  const certify::Judgement& j = *r.judgement;
  object["displacement"] = json(j.displacement, j.bound);
  if (j.stress) object["stress"] = json(*j.stress, j.bound);
  object["energy_norm"] = j.energy_norm;
  object["factor"] = j.factor;
  object["doubt"] = io::text_or_null(j.doubt);
  for (const certify::RigidDifference& rigid : j.rigid)
    object["rigid_difference"].push_back(
        {{"body", rigid.body}, {"translation", rigid.translation}, {"rotation", rigid.rotation}});
  return object;
}

template <int dim>
std::string judged_cells_csv(const mesh::Mesh<dim>& mesh, const certify::JudgedField& field)
{
  io::CsvTable table(dim == 2 ? "cell,x,y,region,distance,part,marked"
                              : "cell,x,y,z,region,distance,part,marked");
  std::vector<char> marked(field.cells.size(), 0);
  for (const Index c : field.halving) marked[c] = 1;
  const double square = field.distance * field.distance;
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    Point<dim> centre = Point<dim>::Zero();
    for (const Index v : mesh.cell(c)) centre += mesh.vertex(v) / (dim + 1);
    table.add(static_cast<long>(c));
    for (const double x : centre) table.add(x);
    table.add(mesh.region_names()[mesh.region(c)]);
    table.add(field.cells[c]);
    table.add(square > 0 ? field.cells[c] * field.cells[c] / square : 0);
    table.add(static_cast<int>(marked[c]));
    table.end_row();
  }
  return table.text();
}

template std::string judged_cells_csv(const mesh::Mesh<2>&, const certify::JudgedField&);
template std::string judged_cells_csv(const mesh::Mesh<3>&, const certify::JudgedField&);

}  // namespace tribound::app
