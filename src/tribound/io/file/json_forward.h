#pragma once

/// @file json_forward.h
/// The type of JSON values, for headers that only name it: the library header is long.

#include <nlohmann/json_fwd.hpp>

namespace tribound::io
{

/// Keys keep the order in which they were set.
using Json = nlohmann::ordered_json;

}  // namespace tribound::io
