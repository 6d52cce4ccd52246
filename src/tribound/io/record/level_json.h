#pragma once

/// @file level_json.h
/// The record of a level or a load step as JSON, see docs/output.md.

#include "tribound/io/file/json_forward.h"
#include "tribound/io/record/level_record.h"

namespace tribound::io
{

/// One entry of `levels` or `steps` of certificate.json.
[[nodiscard]] Json level_json(const LevelRecord& level);

/// Adds the data of a load step besides bound and figures.
void add_load_step(Json& object, const LevelRecord& level);

/// Adds bound and figures, which the certificate has for the last level and for each.
void add_results(Json& object, const LevelRecord& level);

/// `balance` of the certificate.
[[nodiscard]] Json balance_json(const certify::Balance& balance);

/// Seconds by stage.
[[nodiscard]] Json stages_json(const StageTimes& times);

}  // namespace tribound::io
