#pragma once

/// @file face_centres.h
/// The order of the nodes in the middle of faces.

#include <span>

#include "tribound/mesh/import/imported_mesh.h"

namespace tribound::mesh
{

/// Decks and .med differ in the order of the nodes after those of the edges: the centre of a face becomes the
/// one nearest to the middle of its corners. `x`: the nodes of the mesh.
void order_face_centres(ElementBlock& block, std::span<const Point<3>> x);

}  // namespace tribound::mesh
