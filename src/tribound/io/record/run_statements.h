#pragma once

/// @file run_statements.h
/// What the certificate says of a run in words: what the bound covers, and what it rests on.

#include <span>
#include <string>

#include "tribound/adapt/levels.h"
#include "tribound/algebra/linear_solver.h"
#include "tribound/io/record/facts.h"
#include "tribound/io/record/level_record.h"

namespace tribound::io
{

/// "direct", "GMRES with multigrid", ...: for people.
[[nodiscard]] std::string describe_solver(algebra::LinearMethod method);
/// The same of the steps on a mesh, at least one.
[[nodiscard]] std::string describe_solver(std::span<const adapt::CertifiedStep> steps);

/// Before anything is solved, on the first mesh. On several ranks all call it and the next together.
template <int dim>
[[nodiscard]] certify::Statements run_statements(const adapt::Discretisation<dim>& first,
                                                 const adapt::Method& method);
/// Of a level with at least one Newton step, and its record: its data, and how its systems were solved.
/// `carried`: of a load step whether the history goes from mesh to mesh.
template <int dim>
[[nodiscard]] certify::Statements run_statements(const adapt::LevelView<dim>& view, const LevelRecord& record,
                                                 const CaseFacts& facts, const adapt::Method& method,
                                                 bool carried);

}  // namespace tribound::io
