#pragma once

/// @file run_statements.h
/// The statements of the certificate on a run: what the bound covers, and which assumptions it makes.

#include <span>
#include <string>

#include "tribound/adapt/levels.h"
#include "tribound/algebra/linear_solver.h"
#include "tribound/io/record/facts.h"
#include "tribound/io/record/level_record.h"

namespace tribound::io
{

/// "direct", "GMRES with multigrid", ...: for human readers.
[[nodiscard]] std::string describe_solver(algebra::LinearMethod method);
/// The same for the steps on a mesh, at least one.
[[nodiscard]] std::string describe_solver(std::span<const adapt::CertifiedStep> steps);

/// On the first mesh, before anything is solved. All ranks call it and the next one together.
template <int dim>
[[nodiscard]] certify::Statements run_statements(const adapt::Discretisation<dim>& first,
                                                 const CaseFacts& facts, const adapt::Method& method);
/// For a level with at least one Newton step, and its record: its data, and how its systems were solved.
/// `carried`: for a load step, whether the history is transferred between meshes.
template <int dim>
[[nodiscard]] certify::Statements run_statements(const adapt::LevelView<dim>& view, const LevelRecord& record,
                                                 const CaseFacts& facts, const adapt::Method& method,
                                                 bool carried);

}  // namespace tribound::io
