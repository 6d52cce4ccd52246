#include "tribound/io/record/run_statements.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tribound/io/record/error_bars.h"

namespace tribound::io
{

std::string describe_solver(algebra::LinearMethod method)
{
  switch (method)
  {
    case algebra::LinearMethod::condensed:
      return "direct, condensed onto the contact boundary";
    case algebra::LinearMethod::iterative:
      return "GMRES with multigrid";
    default:
      return "direct";
  }
}

std::string describe_solver(std::span<const adapt::CertifiedStep> steps)
{
  const bool fell_back = std::ranges::any_of(steps, [](const auto& s) { return s.step.fell_back; });
  return describe_solver(steps.back().step.method) +
         (fell_back ? ", as GMRES with multigrid failed on this mesh" : "");
}

namespace
{

/// What the author of the case leaves out comes first.
void add_not_covered(certify::Statements& statements, const CaseFacts& facts)
{
  statements.not_covered.insert(statements.not_covered.begin(), facts.not_covered.begin(),
                                facts.not_covered.end());
}

}  // namespace

template <int dim>
certify::Statements run_statements(const adapt::Discretisation<dim>& first, const CaseFacts& facts,
                                   const adapt::Method& method)
{
  certify::Statements statements = certify::statements(first.form, method.contact_rule);
  add_not_covered(statements, facts);
  statements.assumptions.emplace_back("linear_solver", describe_solver(algebra::choose_method(
                                                           method.solver, dim, first.space.n_global_dofs())));
  return statements;
}

template <int dim>
certify::Statements run_statements(const adapt::LevelView<dim>& view, const LevelRecord& record,
                                   const CaseFacts& facts, const adapt::Method& method, bool carried)
{
  const adapt::CertifiedLevel<dim>& level = view.level;
  certify::Statements statements =
      certify::statements(view.discrete.form, method.contact_rule, level.friedrichs);
  add_not_covered(statements, facts);
  if (!record.load_step && view.discrete.form.problem().uses_time())
    statements.assumptions.emplace_back("load_factor", "t = 1 in all formulas, without [history]");
  if (std::string energy = words_of_guarantee(record, facts); !energy.empty())
    statements.covered.push_back(std::move(energy));
  if (level.solved() && certify::is_round_off(level.estimate, level.norms))
    statements.assumptions.emplace_back(
        "stress",
        fmt::format("zero as far as can be known: here norms of stresses up to {:.3g}{} are nothing but "
                    "rounding, and so is the bound",
                    level.norms.round_off, facts.behind(problem::UnitOf::stress_norm)));
  statements.assumptions.emplace_back(
      "linear_solver",
      describe_solver(level.steps) +
          (level.tightened ? ", beyond solver.tolerance on the last mesh, where it was too loose" : ""));
  const adapt::Stopping criterion = method.stopping.criterion;
  if (record.load_step)
    certify::add_history(
        statements, criterion != adapt::Stopping::tolerance && criterion != adapt::Stopping::last_bounded,
        carried);
  return statements;
}

template certify::Statements run_statements(const adapt::Discretisation<2>&, const CaseFacts&,
                                            const adapt::Method&);
template certify::Statements run_statements(const adapt::Discretisation<3>&, const CaseFacts&,
                                            const adapt::Method&);
template certify::Statements run_statements(const adapt::LevelView<2>&, const LevelRecord&, const CaseFacts&,
                                            const adapt::Method&, bool);
template certify::Statements run_statements(const adapt::LevelView<3>&, const LevelRecord&, const CaseFacts&,
                                            const adapt::Method&, bool);

}  // namespace tribound::io
