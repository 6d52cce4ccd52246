#pragma once

/// @file survey.h
/// What is in a mesh that no case has asked for yet.

#include <string>
#include <vector>

#include "tribound/mesh/import/simplices.h"

namespace tribound::mesh
{

struct SurveyedGroup
{
  std::string name;
  std::size_t n = 0;       ///< cells or facets of the simplicial mesh
  double measure = 0;      ///< volume, area or length
  bool is_inside = false;  ///< between cells: may become a joint
};

struct Survey
{
  int dim = 3;
  std::size_t n_vertices = 0;
  std::size_t n_cells = 0;
  std::size_t n_bodies = 0;  ///< parts connected through facets
  std::vector<SurveyedGroup> regions{};
  std::vector<SurveyedGroup> boundaries{};
};

/// Verifies every body by itself, as the constructor of Mesh does it, and throws InputError as that. Where
/// bodies touch each other, and along which groups of facets inside they are cut, a case says: this is not
/// asked.
[[nodiscard]] Survey survey(const SimplicialMesh& mesh);

}  // namespace tribound::mesh
