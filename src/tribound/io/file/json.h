#pragma once

/// @file json.h
/// What the JSON files share; for io alone, whose programs need nlohmann-json.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>

#include "tribound/io/file/csv.h"

namespace tribound::io
{

/// Keys stay in the order in which they were added.
using Json = nlohmann::ordered_json;

/// null for what is not known.
[[nodiscard]] inline Json number_or_null(const std::optional<double>& value)
{
  return value ? Json(*value) : Json(nullptr);
}

/// null for an empty text.
[[nodiscard]] inline Json text_or_null(const std::string& text)
{
  return text.empty() ? Json(nullptr) : Json(text);
}

/// The cells of a row by name.
[[nodiscard]] inline Json row_json(const TableRow& row)
{
  struct Value
  {
    Json operator()(long number) const { return number; }
    Json operator()(const std::optional<double>& number) const { return number_or_null(number); }
    Json operator()(const std::string& text) const { return text; }
  };
  Json object = Json::object();
  for (const TableCell& cell : row) object[cell.name] = std::visit(Value{}, cell.value);
  return object;
}

}  // namespace tribound::io
