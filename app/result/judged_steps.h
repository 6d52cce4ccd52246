#pragma once

/// @file judged_steps.h
/// The report of `tribound judge --steps`: the judgements of all load steps. Plain data in, text out.

#include <span>
#include <string>

#include "app/result/judgement.h"

namespace tribound::app
{

/// The worst: "rejected", "undecided" or "wide", "no bound", else that of all. Of one step: its own.
[[nodiscard]] std::string common_status(std::span<const JudgementRecord> steps);
/// The place of the step with the largest error; of the last one if none has a bound.
[[nodiscard]] std::size_t worst_step(std::span<const JudgementRecord> steps);

/// A row for each step, as printed; `directory`: of the files.
[[nodiscard]] std::string judged_steps_text(std::span<const JudgementRecord> steps,
                                            const std::string& directory);
/// The fields of docs/output.md.
[[nodiscard]] io::Json judged_steps_object(std::span<const JudgementRecord> steps);

}  // namespace tribound::app
