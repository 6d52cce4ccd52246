#pragma once

/// @file facts_json.h
/// Facts as JSON.

#include "io/facts.h"
#include "io/json.h"

namespace tribound
{

/// The `program` of certificate.json and study.json.
[[nodiscard]] Json program_json(const BuildFacts& build);

/// The `mesh` of certificate.json and of `tribound check --json`, see docs/output.md.
[[nodiscard]] Json mesh_json(const MeshFacts& mesh);

}  // namespace tribound
