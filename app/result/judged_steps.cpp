#include "app/result/judged_steps.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

#include "app/console/text.h"
#include "tribound/io/file/json.h"
#include "tribound/io/record/record_json.h"

namespace tribound::app
{

namespace
{

/// A column of the table: its head, and what it has for a step.
struct StepColumn
{
  std::string head;
  std::function<std::string(const JudgementRecord&)> cell;
};

/// "7.31 % to 7.9 %", or with the unit of the column.
std::string range_text(double lower, double upper, bool is_relative)
{
  const auto text = [&](double value) { return is_relative ? percent(value) : fmt::format("{:.4g}", value); };
  return std::isfinite(upper) ? fmt::format("{} to {}", text(lower), text(upper))
                              : fmt::format("at least {}", text(lower));
}

std::string field_cell(const certify::JudgedField& field)
{
  const certify::ErrorInterval& error = field.relative ? *field.relative : field.error;
  return range_text(error.lower, error.upper, field.relative.has_value());
}

std::string wrong_cell(const JudgedNumber& number)
{
  const auto wrong = number.wrong_by();
  if (!wrong) return "-";
  const double size = std::max(std::abs(number.interval.lower), std::abs(number.interval.upper));
  return size > 0 ? range_text(wrong->lower / size, wrong->upper / size, true)
                  : range_text(wrong->lower, wrong->upper, false);
}

std::vector<StepColumn> columns_of(std::span<const JudgementRecord> steps)
{
  using Record = JudgementRecord;
  std::vector<StepColumn> columns = {{"t", [](const Record& step) { return number("{:g}", step.t); }},
                                     {"displacement", [](const Record& step) {
                                        return step.judgement ? field_cell(step.judgement->displacement)
                                                              : std::string("no bound");
                                      }}};
  const auto has_stress = [](const Record& step) { return step.judgement && step.judgement->stress; };
  if (std::ranges::any_of(steps, has_stress))
    columns.push_back({"stress", [=](const Record& step) {
                         return has_stress(step) ? field_cell(*step.judgement->stress) : std::string("-");
                       }});
  for (std::size_t i = 0; i < steps.front().numbers.size(); ++i)
    columns.push_back({steps.front().numbers[i].interval.name,
                       [i](const Record& step) { return wrong_cell(step.numbers[i]); }});
  if (std::ranges::any_of(steps, [](const Record& step) { return step.imbalance.has_value(); }))
    columns.push_back({"loads missed by", [](const Record& step)
                       { return step.imbalance ? percent(*step.imbalance) : std::string("-"); }});
  columns.push_back({"status", [](const Record& step) { return step.status(); }});
  return columns;
}

std::string table_text(std::span<const JudgementRecord> steps)
{
  constexpr std::size_t gap = 2;
  std::vector<std::string> rows = {"step"};
  for (std::size_t i = 0; i < steps.size(); ++i) rows.push_back(fmt::format("{:4}", i + 1));
  for (const StepColumn& column : columns_of(steps))
  {
    std::vector<std::string> cells = {column.head};
    std::ranges::transform(steps, std::back_inserter(cells), column.cell);
    const std::size_t width = std::ranges::max(cells, {}, &std::string::size).size() + gap;
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] += fmt::format("{:>{}}", cells[i], width);
  }
  std::string text;
  for (const std::string& row : rows) text += line(text.empty() ? "errors" : "", row);
  return text;
}

/// What is said of steps: each sentence once, with the steps that it is true of.
std::string sentences(std::span<const JudgementRecord> steps,
                      const std::function<std::string(const JudgementRecord&)>& sentence)
{
  std::vector<std::pair<std::string, std::vector<std::size_t>>> said;
  for (std::size_t i = 0; i < steps.size(); ++i)
  {
    const std::string text = sentence(steps[i]);
    if (text.empty()) continue;
    const auto known = std::ranges::find(said, text, &decltype(said)::value_type::first);
    if (known != said.end())
      known->second.push_back(i + 1);
    else
      said.push_back({text, {i + 1}});
  }
  std::string result;
  for (const auto& [text, numbers] : said)
    result += paragraph(numbers.size() == 1 ? "in step" : "in steps",
                        fmt::format("{}: {}", fmt::join(numbers, ", "), text));
  return result;
}

}  // namespace

std::string common_status(std::span<const JudgementRecord> steps)
{
  for (const char* status : {"rejected", "undecided", "wide", "no bound"})
    if (std::ranges::any_of(steps, [&](const JudgementRecord& step) { return step.status() == status; }))
      return status;
  return steps.back().status();
}

std::size_t worst_step(std::span<const JudgementRecord> steps)
{
  return std::ranges::max_element(steps, {}, &JudgementRecord::largest_error) - steps.begin();
}

std::string judged_steps_text(std::span<const JudgementRecord> steps, const std::string& directory)
{
  const JudgementRecord& last = steps.back();
  return line("theirs", fmt::format("{}, of the last step: {}", last.solution.name, last.description)) +
         table_text(steps) +
         sentences(steps, [](const JudgementRecord& step)
                   { return step.judgement ? "against " + step.target : "not bounded: " + step.reason; }) +
         sentences(steps,
                   [](const JudgementRecord& step)
                   {
                     return step.judgement && !step.judgement->doubt.empty()
                                ? "their displacement " + step.judgement->doubt
                                : std::string();
                   }) +
         sentences(steps, [](const JudgementRecord& step)
                   { return step.status() == "wide" ? "wide" + why_wide(step) : std::string(); }) +
         line("status", common_status(steps)) + line("results", directory);
}

io::Json judged_steps_object(std::span<const JudgementRecord> steps)
{
  const JudgementRecord& last = steps.back();
  io::Json object{{"schema", judgement_schema},          {"title", last.facts.title},
                  {"purpose", last.facts.purpose},       {"file", last.facts.file},
                  {"units", io::units_json(last.facts)}, {"status", common_status(steps)},
                  {"sharpness", last.sharpness},         {"accept", io::number_or_null(last.accept)},
                  {"worst", worst_step(steps) + 1},      {"steps", io::Json::array()}};
  for (const JudgementRecord& step : steps) object["steps"].push_back(judgement_object(step));
  return object;
}

}  // namespace tribound::app
