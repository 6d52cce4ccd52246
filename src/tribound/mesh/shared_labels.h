#pragma once

/// @file shared_labels.h
/// What a mesh calls its parts, on all ranks.

#include "tribound/base/ranks.h"
#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

/// Sets the labels on all ranks to those that the first has. All ranks call it together.
void copy_labels(const Ranks& ranks, MeshLabels& labels);

}  // namespace tribound::mesh
