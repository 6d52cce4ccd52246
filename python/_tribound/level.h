#pragma once

/// @file level.h
/// A level of a run, or a load step, in Python.

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "app/command/level_files.h"
#include "tribound/io/record/level_record.h"

namespace tribound::python
{

template <int dim>
struct Level
{
  std::shared_ptr<const app::KeptLevel<dim>> kept;
  std::string record{};  ///< as in `levels` of the certificate, JSON; empty: not yet made
};

/// The level that a hook is called with, as a Level2 or Level3.
template <int dim>
[[nodiscard]] Level<dim> to_level(const std::shared_ptr<const app::KeptLevel<dim>>& kept,
                                  const io::LevelRecord& record);

void bind_levels(pybind11::module_& module);

}  // namespace tribound::python
