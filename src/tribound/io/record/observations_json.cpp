#include "tribound/io/record/observations_json.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>
#include <string_view>

#include "tribound/io/file/json.h"

namespace tribound::io
{

namespace
{

constexpr std::array axis_names = {"x", "y", "z"};

/// The entries of a symmetric tensor that vary: in 2D without those that z has besides zz.
std::vector<double> entries(const std::array<double, 6>& tensor, std::size_t dim)
{
  return {tensor.begin(), tensor.begin() + (dim == 2 ? 4 : 6)};
}

Json json(const ProbeRow& row)
{
  const std::size_t dim = row.x.size();
  Json object{{"point", row.point},
              {"x", row.x},
              {"body", row.body},
              {"region", row.region},
              {"displacement", row.u},
              {"stress", entries(row.stress, dim)},
              {"equilibrated_stress", nullptr},
              {"difference", number_or_null(row.difference)}};
  if (row.equilibrated) object["equilibrated_stress"] = entries(*row.equilibrated, dim);
  return object;
}

Json json(const SectionRecord& section)
{
  return {{"name", section.name},
          {"measure", section.measure},
          {"force", section.force},
          {"moment", section.moment},
          {"axes", section.axes},
          {"N", section.N},
          {"V", section.V},
          {"M", section.M},
          {"in_equilibrium", section.note.empty()},
          {"note", text_or_null(section.note)}};
}

/// Columns of an array of numbers, of unknown ones where it is null: u_x, u_y; or u where it has one number.
void add_columns(TableRow& row, std::string_view name, const Json& values,
                 std::span<const char* const> endings)
{
  for (std::size_t i = 0; i < endings.size(); ++i)
    row.push_back({endings.size() == 1 ? std::string(name) : fmt::format("{}_{}", name, endings[i]),
                   values.is_array() ? std::optional(values[i].get<double>()) : std::nullopt});
}

/// "level", or "step" and "t".
TableRow place_columns(const Json& level)
{
  if (!level.contains("t")) return {{"level", level.at("level").get<long>()}};
  return {{"step", level.at("step").get<long>()}, {"t", std::optional(level.at("t").get<double>())}};
}

TableRow probe_row(const Json& level, const std::string& name, const Json& first, const Json& point)
{
  constexpr std::array plane = {"xx", "yy", "zz", "xy"};
  constexpr std::array space = {"xx", "yy", "zz", "xy", "yz", "xz"};
  const std::size_t dim = point.at("x").size();
  const std::span<const char* const> axes = std::span(axis_names).first(dim);
  const std::span<const char* const> tensor =
      dim == 2 ? std::span<const char* const>(plane) : std::span<const char* const>(space);
  double square = 0;
  for (std::size_t i = 0; i < dim; ++i)
    square += std::pow(point["x"][i].get<double>() - first["x"][i].get<double>(), 2);
  TableRow row = place_columns(level);
  row.push_back({"probe", name});
  row.push_back({"point", point.at("point").get<long>()});
  row.push_back({"body", point.at("body").get<std::string>()});
  row.push_back({"region", point.at("region").get<std::string>()});
  row.push_back({"distance", std::optional(std::sqrt(square))});
  for (std::size_t i = 0; i < dim; ++i) row.push_back({axes[i], std::optional(point["x"][i].get<double>())});
  add_columns(row, "u", point.at("displacement"), axes);
  add_columns(row, "stress", point.at("stress"), tensor);
  add_columns(row, "equilibrated", point.at("equilibrated_stress"), tensor);
  const Json& difference = point.at("difference");
  row.push_back(
      {"difference", difference.is_number() ? std::optional(difference.get<double>()) : std::nullopt});
  return row;
}

TableRow section_row(const Json& level, const Json& section)
{
  const std::size_t dim = section.at("force").size();
  TableRow row = place_columns(level);
  row.push_back({"section", section.at("name").get<std::string>()});
  row.push_back({"measure", std::optional(section.at("measure").get<double>())});
  for (const auto& [name, value] : section_numbers(section)) row.push_back({name, std::optional(value)});
  add_columns(row, "force", section.at("force"), std::span(axis_names).first(dim));
  add_columns(row, "moment", section.at("moment"), std::span(axis_names).first(dim == 2 ? 1 : 3));
  row.push_back({"in_equilibrium", section.at("in_equilibrium").get<bool>() ? 1L : 0L});
  return row;
}

std::string table_of(const std::vector<TableRow>& rows)
{
  return rows.empty() ? std::string() : csv_text(rows.front(), rows);
}

}  // namespace

void add_observations(Json& object, const LevelRecord& level)
{
  for (const ProbeRecord& probe : level.probes)
  {
    Json points = Json::array();
    for (const ProbeRow& row : probe.rows) points.push_back(json(row));
    object["probes"].push_back({{"name", probe.name}, {"points", points}});
  }
  for (const SectionRecord& section : level.sections) object["sections"].push_back(json(section));
}

std::vector<std::pair<std::string, double>> section_numbers(const Json& section)
{
  std::vector<std::pair<std::string, double>> numbers = {{"N", section.at("N").get<double>()}};
  const auto add = [&](const char* key, std::span<const char* const> endings)
  {
    const Json& values = section.at(key);
    for (std::size_t i = 0; i < values.size(); ++i)
      numbers.emplace_back(values.size() == 1 ? std::string(key) : fmt::format("{}_{}", key, endings[i]),
                           values[i].get<double>());
  };
  add("V", std::array{"1", "2"});
  add("M", std::array{"n", "1", "2"});
  return numbers;
}

std::string probes_csv(const Json& levels)
{
  std::vector<TableRow> rows;
  for (const Json& level : levels)
    for (const Json& probe : level.value("probes", Json::array()))
      for (const Json& point : probe.at("points"))
        rows.push_back(
            probe_row(level, probe.at("name").get<std::string>(), probe.at("points").front(), point));
  return table_of(rows);
}

std::string sections_csv(const Json& levels)
{
  std::vector<TableRow> rows;
  for (const Json& level : levels)
    for (const Json& section : level.value("sections", Json::array()))
      rows.push_back(section_row(level, section));
  return table_of(rows);
}

}  // namespace tribound::io
