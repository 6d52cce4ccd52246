#include <algorithm>

#include "app/console/console.h"
#include "tribound/io/file/json.h"
#include "tribound/io/record/record_json.h"

namespace tribound::app
{

namespace
{

constexpr const char* check_schema = "1";

io::Json finding_json(const doctor::Finding& finding)
{
  io::Json numbers = io::Json::object();
  for (const auto& [name, value] : finding.numbers) numbers[name] = value;
  return {{"code", finding.code},
          {"severity", doctor::to_string(finding.severity)},
          {"text", finding.text},
          {"numbers", numbers},
          {"where", finding.where.empty() ? io::Json(nullptr) : io::Json(finding.where)},
          {"advice", io::text_or_null(finding.advice)}};
}

}  // namespace

std::string check_json(const io::CaseFacts& facts, const io::MeshFacts& mesh, const std::string& solver,
                       std::span<const doctor::Finding> findings)
{
  io::Json object{
      {"schema", check_schema},     {"title", facts.title},           {"file", facts.file},
      {"d", facts.dimension},       {"model", io::model_json(facts)}, {"p", facts.degree},
      {"friction", facts.friction}, {"gamma0", facts.gamma0},         {"dofs", mesh.free_dofs},
      {"solver", solver},           {"units", io::units_json(facts)}, {"mesh", io::mesh_json(mesh)}};
  object["warnings"] = std::ranges::count(findings, doctor::Severity::warning, &doctor::Finding::severity);
  object["findings"] = io::Json::array();
  for (const doctor::Finding& finding : findings) object["findings"].push_back(finding_json(finding));
  return io::json_text(object);
}

}  // namespace tribound::app
