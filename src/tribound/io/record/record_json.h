#pragma once

/// @file record_json.h
/// The record of a run as JSON.

#include "tribound/io/file/json_forward.h"
#include "tribound/io/record/facts.h"
#include "tribound/io/record/report.h"

namespace tribound::io
{

/// `program` of certificate.json and study.json.
[[nodiscard]] Json program_json(const BuildFacts& build);

/// `units` of all JSON files: the label of each kind of number, and of each quantity; null where the case
/// names no units.
[[nodiscard]] Json units_json(const CaseFacts& facts);
/// "axisymmetric", or null.
[[nodiscard]] Json model_json(const CaseFacts& facts);

/// `mesh` of certificate.json and of `tribound check --json`, see docs/output.md.
[[nodiscard]] Json mesh_json(const MeshFacts& mesh);

/// `case` of the certificate: the effective case, whose file has this name, and the files that it names, by
/// their hashes; null where there is none.
[[nodiscard]] Json effective_case_json(const EffectiveCase& effective, const std::string& file);

/// `levels` of the certificate, including earlier ones; for a history, the passes; and `steps`.
[[nodiscard]] Json levels_json(const RunRecord& run);
[[nodiscard]] Json steps_json(const RunRecord& run);

/// `path` of the certificate, and `history_check` of a run that has one.
[[nodiscard]] Json path_json(const adapt::PathEnd& path);
[[nodiscard]] Json check_json(const RunRecord& run);

/// certificate.json, see docs/output.md; unknown numbers are null.
[[nodiscard]] Json certificate(const RunRecord& run);

}  // namespace tribound::io
