#pragma once

/// @file program_facts.h
/// What the program is made of, and what it solves with, in words.

#include <span>
#include <string>

#include "tribound/adapt/level.h"
#include "tribound/algebra/linear_solver.h"
#include "tribound/io/record/facts.h"

namespace tribound::app
{

/// Versions of the program and of the libraries it runs with.
[[nodiscard]] io::BuildFacts library_facts();

/// "direct", "GMRES with multigrid", ...: for people.
[[nodiscard]] std::string describe_solver(algebra::LinearMethod method);
/// The same of the steps on a mesh, at least one.
[[nodiscard]] std::string describe_solver(std::span<const adapt::CertifiedStep> steps);

}  // namespace tribound::app
