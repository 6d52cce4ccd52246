#include "tribound/problem/formula.h"

#include <utility>

#include "tribound/problem/formula_program.h"

namespace tribound::problem
{

Formula::Formula(std::string text, const Where& where)
    : program_(std::make_shared<const FormulaProgram>(parse_formula(std::move(text), where)))
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

std::span<const Affine> Formula::switches() const
{
  return program_->switches;
}

}  // namespace tribound::problem
