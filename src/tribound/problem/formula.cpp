#include "tribound/problem/formula.h"

#include <utility>

#include "tribound/problem/formula_program.h"

namespace tribound::problem
{

Formula::Formula(std::string text, const Where& where, double t)
    : program_(std::make_shared<const FormulaProgram>(parse_formula(std::move(text), where, t)))
{
}

const std::string& Formula::text() const
{
  return program_->text;
}

int Formula::degree() const
{
  return program_->degree;
}

bool Formula::uses(int variable) const
{
  return program_->uses.at(variable);
}

bool Formula::uses_time() const
{
  return program_->uses_time;
}

std::span<const Affine> Formula::switches() const
{
  return program_->switches;
}

}  // namespace tribound::problem
