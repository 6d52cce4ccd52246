#include "app/result/check_json.h"

#include <algorithm>

#include "tribound/io/record/facts_json.h"

namespace tribound
{

namespace
{

constexpr const char* check_schema = "1";

Json finding_json(const Finding& finding)
{
  Json numbers = Json::object();
  for (const auto& [name, value] : finding.numbers) numbers[name] = value;
  return {{"code", finding.code},
          {"severity", to_string(finding.severity)},
          {"text", finding.text},
          {"numbers", numbers},
          {"where", finding.where.empty() ? Json(nullptr) : Json(finding.where)},
          {"advice", text_or_null(finding.advice)}};
}

}  // namespace

std::string check_json(const CaseFacts& facts, const MeshFacts& mesh, const std::string& solver,
                       std::span<const Finding> findings)
{
  Json object{{"schema", check_schema}, {"title", facts.title},   {"file", facts.file},
              {"d", facts.dimension},   {"p", facts.degree},      {"friction", facts.friction},
              {"gamma0", facts.gamma0}, {"dofs", mesh.free_dofs}, {"solver", solver},
              {"mesh", mesh_json(mesh)}};
  object["warnings"] = std::ranges::count(findings, Severity::warning, &Finding::severity);
  object["findings"] = Json::array();
  for (const Finding& finding : findings) object["findings"].push_back(finding_json(finding));
  // Names from a file need not be UTF-8.
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace tribound
