#pragma once

/// @file document.h
/// Cases of Python as documents: dictionaries, lists, numbers, texts and functions.

#include <pybind11/pybind11.h>

#include <string>

#include "tribound/case/node.h"

namespace tribound::python
{

/// A case as Python has it: TOML or a dictionary, not yet checked.
struct Document
{
  case_file::Node node;
  std::string name;  ///< for messages; paths are relative to its directory
};

/// A value of Python as one of a case, found at `key` of the case `name`. Functions are objects with the
/// attributes `call`, `degree` (None: no polynomial), `uses_time`; see tribound.Function. Throws InputError
/// for what no key of a case takes.
[[nodiscard]] case_file::Node to_node(const pybind11::handle& value, const std::string& name,
                                      const std::string& key = {});

void bind_documents(pybind11::module_& module);

}  // namespace tribound::python
