#pragma once

/// @file commands.h
/// The commands of the program, run in the process of the interpreter.

#include <pybind11/pybind11.h>

namespace tribound::python
{

void bind_commands(pybind11::module_& module);

}  // namespace tribound::python
