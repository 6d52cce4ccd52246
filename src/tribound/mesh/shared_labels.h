#pragma once

/// @file shared_labels.h
/// The names of a mesh's parts, on all ranks.

#include "tribound/base/ranks.h"
#include "tribound/mesh/mesh.h"

namespace tribound::mesh
{

/// Sets the labels on all ranks to those of the first. All ranks call it together.
void copy_labels(const Ranks& ranks, MeshLabels& labels);

}  // namespace tribound::mesh
