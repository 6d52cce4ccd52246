#pragma once

/// @file observations.h
/// Probes and sections of a case.

#include <vector>

#include "tribound/io/record/probes.h"
#include "tribound/io/record/sections.h"

namespace tribound::io
{

/// What is read of every solution of a run.
template <int dim>
struct Observations
{
  std::vector<Probe<dim>> probes{};
  std::vector<Section<dim>> sections{};
};

}  // namespace tribound::io
