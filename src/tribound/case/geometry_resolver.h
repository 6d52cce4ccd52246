#pragma once

/// @file geometry_resolver.h
/// Gap and direction of a contact from obstacles and shapes.

#include <vector>

#include "tribound/case/config.h"
#include "tribound/mesh/quadratic_facets.h"
#include "tribound/problem/problem.h"

namespace tribound::case_file
{

/// The mesh data for the facets of a contact.
struct ContactFacets
{
  const mesh::QuadraticFacets* quadratic;  ///< null, or empty: the mesh has order 1
  std::vector<int> tags;                   ///< groups of the facets; of a pair, those of the slave
  std::vector<int> master_tags{};          ///< of a pair, groups of the master
};

/// Sets the contact with a rigid obstacle, or with a master, as given by `geometry`. Throws InputError for
/// surfaces of another dimension, and for missing second-order facets.
template <int dim>
void apply_geometry(const Config& config, const GeometryConfig& geometry, const ContactFacets& facets,
                    problem::Contact& contact);

}  // namespace tribound::case_file
