#pragma once

/// @file json.h
/// Common functions for JSON files; only for io, which links nlohmann-json.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>

#include "tribound/io/file/csv.h"
#include "tribound/io/file/json_forward.h"

namespace tribound::io
{

/// The text of a file; a single line for `indent` -1. Names from a case or a mesh need not be UTF-8; invalid
/// bytes are replaced.
[[nodiscard]] inline std::string json_text(const Json& json, int indent = 2)
{
  return json.dump(indent, ' ', false, Json::error_handler_t::replace) + (indent < 0 ? "" : "\n");
}

/// null for an unknown number.
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
