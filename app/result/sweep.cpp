#include "app/result/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "app/console/text.h"
#include "tribound/case/sweep_values.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/file/csv.h"
#include "tribound/io/file/json.h"
#include "tribound/io/record/facts.h"
#include "tribound/io/record/level_json.h"
#include "tribound/io/record/observations_json.h"
#include "tribound/io/record/record_json.h"

namespace tribound::app
{

namespace
{

using Figures = std::vector<std::pair<std::string, std::optional<double>>>;

constexpr const char* sweep_schema = "1";

/// Not an object where the file is missing or incomplete.
io::Json read_json(const std::filesystem::path& file)
{
  return io::Json::parse(io::read_text(file), nullptr, false);
}

/// The value at a path such as "/contact/normal", if it is of this type.
std::optional<double> number_at(const io::Json& json, const std::string& path)
{
  const io::Json::json_pointer place(path);
  const bool is_there = json.contains(place) && json.at(place).is_number();
  return is_there ? std::optional(json.at(place).get<double>()) : std::nullopt;
}
std::string text_at(const io::Json& json, const std::string& path)
{
  const io::Json::json_pointer place(path);
  return json.contains(place) && json.at(place).is_string() ? json.at(place).get<std::string>() : "";
}

void add_contact(const io::Json& certificate, Figures& figures)
{
  if (!number_at(certificate, "/contact/normal")) return;
  const io::Json& contact = certificate["contact"];
  figures.emplace_back("contact_normal", number_at(contact, "/normal"));
  figures.emplace_back("contact_tangential", number_at(contact, "/tangential"));
  if (!contact.contains("boundaries")) return;
  for (const auto& [name, part] : contact["boundaries"].items())
    if (const auto factor = number_at(part, "/sliding/sliding_factor"))
      figures.emplace_back("sliding_factor." + name, factor);
}

/// The largest pressure, and the measure of the open part, from contact.csv.
void add_contact_line(const std::filesystem::path& file, Figures& figures)
{
  const auto rows = case_file::parse_csv(io::read_text(file), file.string());
  if (rows.empty()) return;
  const auto column = [&](const char* name) { return std::ranges::find(rows[0], name) - rows[0].begin(); };
  const std::array places = {column("pressure"), column("status"), column("weight")};
  double largest = 0;
  double open = 0;
  for (std::size_t i = 1; i < rows.size(); ++i)
  {
    if (rows[i].size() != rows[0].size()) return;
    largest = std::max(largest, std::stod(rows[i][places[0]]));
    if (rows[i][places[1]] == "0") open += std::stod(rows[i][places[2]]);
  }
  figures.emplace_back("largest_pressure", largest);
  figures.emplace_back("opened", open);
}

void add_reactions(const io::Json& certificate, Figures& figures)
{
  constexpr std::array axes = {"x", "y", "z"};
  if (!certificate.contains(io::Json::json_pointer("/balance/rows"))) return;
  for (const io::Json& row : certificate["balance"]["rows"])
    if (text_at(row, "/kind") == "reaction")
      for (std::size_t i = 0; i < row["force"].size(); ++i)
        figures.emplace_back(fmt::format("reaction_{}.{}", axes[i], text_at(row, "/name")),
                             row["force"][i].get<double>());
}

/// With the ends of their intervals, as in history.csv.
void add_quantities(const io::Json& certificate, Figures& figures)
{
  for (const io::Json& quantity : certificate.value("quantities", io::Json::array()))
  {
    const std::string name = "quantity." + text_at(quantity, "/name");
    figures.emplace_back(name, number_at(quantity, "/value"));
    for (const char* end : {"lower", "upper"})
      figures.emplace_back(fmt::format("{}.{}", name, end), number_at(quantity, fmt::format("/{}", end)));
  }
}

/// N, V and M of sections.
void add_sections(const io::Json& certificate, Figures& figures)
{
  for (const io::Json& section : certificate.value("sections", io::Json::array()))
    for (const auto& [name, value] : io::section_numbers(section))
      figures.emplace_back(fmt::format("section.{}.{}", text_at(section, "/name"), name), value);
}

/// Displacements of probes that are single points of one body.
void add_probes(const io::Json& certificate, Figures& figures)
{
  constexpr std::array axes = {"x", "y", "z"};
  for (const io::Json& probe : certificate.value("probes", io::Json::array()))
    if (const io::Json& points = probe.at("points"); points.size() == 1)
      for (std::size_t i = 0; i < points[0]["displacement"].size(); ++i)
        figures.emplace_back(fmt::format("probe.{}.u_{}", text_at(probe, "/name"), axes[i]),
                             points[0]["displacement"][i].get<double>());
}

/// The certificate of a run; null where there is none of this case.
io::Json certificate_of(const std::filesystem::path& directory, const SweepRun& run)
{
  io::Json certificate = read_json(directory / "certificate.json");
  return text_at(certificate, "/case/sha256") == run.sha256 ? certificate : io::Json(nullptr);
}

/// Whether a run with this exit code wrote the certificate at its end. After a crash or on a full disk it is
/// that of an earlier level.
bool is_final(const io::Json& certificate, int exit_code)
{
  const std::string status = text_at(certificate, "/status");
  if (exit_code == 2) return status == "failed" || status == "not certified";
  return (exit_code == 0 && status == "certified") || (exit_code == 3 && status == "budget");
}

std::string status_without_certificate(const SweepRun& run)
{
  if (run.exit_code == 1) return "bad input";
  return *run.exit_code > 128 ? "crashed" : "failed";
}

/// Every figure of any run, in the order of the first run that has it.
std::vector<std::string> figure_names(const SweepRecord& sweep)
{
  std::vector<std::string> names;
  std::set<std::string> seen;
  for (const SweepRun& run : sweep.runs)
    for (const auto& [name, value] : run.figures)
      if (seen.insert(name).second) names.push_back(name);
  return names;
}

std::optional<double> figure(const SweepRun& run, const std::string& name)
{
  const auto found = std::ranges::find(run.figures, name, [](const auto& f) { return f.first; });
  return found == run.figures.end() ? std::nullopt : found->second;
}

}  // namespace

void read_results(const std::filesystem::path& directory, SweepRun& run)
{
  run.figures.clear();
  run.reason.clear();
  run.units.clear();
  const io::Json certificate = certificate_of(directory, run);
  if (!is_final(certificate, run.exit_code.value()))
  {
    run.status = status_without_certificate(run);
    if (run.status == "crashed") run.reason = fmt::format("ended by signal {}", *run.exit_code - 128);
    return;
  }
  run.status = text_at(certificate, "/status");
  run.reason = text_at(certificate, "/reason");
  if (const io::Json units = certificate.value("units", io::Json(nullptr)); units.is_object())
    run.units = io::json_text(units, -1);
  for (const char* name : {"relative", "bound", "cells", "dofs"})
    run.figures.emplace_back(name, number_at(certificate, std::string("/") + name));
  if (number_at(certificate, "/bound"))
  {
    add_contact(certificate, run.figures);
    add_contact_line(directory / "contact.csv", run.figures);
    add_reactions(certificate, run.figures);
    add_quantities(certificate, run.figures);
    add_sections(certificate, run.figures);
    add_probes(certificate, run.figures);
  }
  double seconds = 0;
  const io::Json times = certificate.value("times", io::Json::object());
  const io::Json stages = io::stages_json({});
  for (const auto& [name, value] : times.items())
    if (name == "setup" || stages.contains(name)) seconds += value.get<double>();
  run.figures.emplace_back("seconds", seconds);
}

std::map<std::string, int> complete_runs(const std::filesystem::path& directory, const SweepRecord& sweep)
{
  std::map<std::string, int> complete;
  const io::Json before = read_json(directory / "sweep.json");
  if (!before.is_object()) return complete;
  for (const io::Json& old : before.value("runs", io::Json::array()))
  {
    const std::string name = text_at(old, "/run");
    const auto run = std::ranges::find(sweep.runs, name, &SweepRun::name);
    const std::optional<double> code = number_at(old, "/exit_code");
    if (run == sweep.runs.end() || !code || text_at(old, "/sha256") != run->sha256 ||
        text_at(old, "/files_sha256") != run->files_sha256)
      continue;
    const io::Json certificate = certificate_of(directory / name, *run);
    const bool complete_before = is_final(certificate, static_cast<int>(*code)) &&
                                 text_at(certificate, "/reason").find("interrupted") == std::string::npos;
    if (complete_before) complete[name] = static_cast<int>(*code);
  }
  return complete;
}

std::string sweep_csv(const SweepRecord& sweep)
{
  const std::vector<std::string> names = figure_names(sweep);
  std::string columns = "run";
  for (const std::string& key : sweep.keys) columns += "," + io::csv_cell(key);
  columns += ",status,reason";
  for (const std::string& name : names) columns += "," + io::csv_cell(name);
  io::CsvTable table(columns);
  for (const SweepRun& run : sweep.runs)
  {
    table.add(run.name);
    for (const std::string& value : run.values) table.add(value);
    table.add(run.status);
    table.add(run.reason);
    for (const std::string& name : names) table.add(figure(run, name));
    table.end_row();
  }
  return table.text();
}

io::Json sweep_object(const SweepRecord& sweep)
{
  io::Json object{{"schema", sweep_schema}, {"program", io::program_json(io::build_facts())},
                  {"title", sweep.title},   {"purpose", sweep.purpose},
                  {"file", sweep.file},     {"keys", sweep.keys},
                  {"titles", sweep.titles}};
  const auto named = std::ranges::find_if(sweep.runs, [](const SweepRun& run) { return !run.units.empty(); });
  object["units"] = named == sweep.runs.end() ? io::Json(nullptr) : io::Json::parse(named->units);
  object["runs"] = io::Json::array();
  for (const SweepRun& run : sweep.runs)
  {
    io::Json row{{"run", run.name}, {"values", io::Json::object()}};
    for (std::size_t i = 0; i < sweep.keys.size(); ++i) row["values"][sweep.keys[i]] = run.values[i];
    row["sha256"] = run.sha256;
    row["files_sha256"] = io::text_or_null(run.files_sha256);
    row["exit_code"] = run.exit_code ? io::Json(*run.exit_code) : io::Json(nullptr);
    row["status"] = run.status;
    row["reason"] = io::text_or_null(run.reason);
    for (const auto& [name, value] : run.figures) row[name] = io::number_or_null(value);
    object["runs"].push_back(row);
  }
  return object;
}

void write_sweep(const std::filesystem::path& directory, const SweepRecord& sweep, const io::Json& object)
{
  io::write_file(directory / "sweep.csv", sweep_csv(sweep));
  io::write_file(directory / "sweep.json", io::json_text(object));
}

std::string sweep_line(const SweepRecord& sweep, const SweepRun& run)
{
  std::string values;
  for (std::size_t i = 0; i < sweep.keys.size(); ++i)
    values += fmt::format("{}{}={}", i == 0 ? "" : "  ", sweep.keys[i], run.values[i]);
  const std::optional<double> relative = figure(run, "relative");
  const std::string bound = relative ? fmt::format(", bound {:.4g} %", 100 * *relative) : std::string{};
  return line("run " + run.name, fmt::format("{}: {}{}", values, run.status, bound));
}

}  // namespace tribound::app
