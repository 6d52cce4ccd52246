#pragma once

/// @file check_json.h
/// `tribound check --json`.

#include <span>
#include <string>

#include "tribound/doctor/findings.h"
#include "tribound/io/record/facts.h"

namespace tribound::app
{

/// What `tribound check` says, as JSON with the fields of docs/output.md.
[[nodiscard]] std::string check_json(const io::CaseFacts& facts, const io::MeshFacts& mesh,
                                     const std::string& solver, std::span<const doctor::Finding> findings);

}  // namespace tribound::app
