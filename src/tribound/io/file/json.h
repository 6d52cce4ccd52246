#pragma once

/// @file json.h
/// What the JSON files share; for io alone, whose programs need nlohmann-json.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

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

}  // namespace tribound::io
