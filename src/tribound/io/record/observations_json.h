#pragma once

/// @file observations_json.h
/// Probes and sections in the certificate and as tables.

#include <string>
#include <utility>
#include <vector>

#include "tribound/io/file/json_forward.h"
#include "tribound/io/record/level_record.h"

namespace tribound::io
{

/// Adds `probes` and `sections`, if there are any.
void add_observations(Json& object, const LevelRecord& level);

/// N, V, M of an entry of `sections` by name: "V" and "M", in 3D "V_1", "V_2", "M_n", "M_1", "M_2".
[[nodiscard]] std::vector<std::pair<std::string, double>> section_numbers(const Json& section);

/// A row for each point of each probe, or for each section, of each level or load step, which are as in
/// `levels` or `steps` of the certificate; empty where there is none.
[[nodiscard]] std::string probes_csv(const Json& levels);
[[nodiscard]] std::string sections_csv(const Json& levels);

}  // namespace tribound::io
