#pragma once

/// @file parameters.h
/// `[parameters]`: numbers by name, for the formulas and numbers of a case.

#include <string>
#include <vector>

#include "tribound/case/keys.h"
#include "tribound/case/node.h"

namespace tribound::case_file
{

struct Parameter
{
  std::string name;
  double value = 0;
  std::string label{};  ///< for tables and charts; empty: the name
  std::string unit{};
};

/// The keys of `[parameters]`.
[[nodiscard]] const Table& parameters_table();

/// The parameters of a document. Throws InputError: a name that formulas know, values that are no numbers.
[[nodiscard]] std::vector<Parameter> read_parameters(const Node& document);

/// The document with numbers in place of the names of parameters: in formulas, and where a number stands,
/// which may be any formula of parameters. Throws InputError for parameters that nothing uses.
[[nodiscard]] Node with_values(Node document, const std::vector<Parameter>& parameters);

/// "parameters.NAME=..." for an assignment to the name of a parameter of the document; others as they are.
[[nodiscard]] std::string parameter_assignment(const Node& document, const std::string& assignment);

}  // namespace tribound::case_file
