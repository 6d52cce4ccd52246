#pragma once

/// @file resolve.h
/// From the case file to the problem on a mesh.

#include <span>
#include <string>

#include "tribound/case/config.h"
#include "tribound/io/record/facts.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::case_file
{

/// The problem of the case on a mesh with these names of regions and boundaries, and second-order facets.
/// Throws InputError for a group that does not exist (listing the existing ones), for a region without
/// material, for a boundary group of a mesh file that the case omits, and for vectors of wrong length. Sides
/// of a box that are not mentioned are traction-free.
template <int dim>
[[nodiscard]] problem::Problem<dim> resolve(const Config& config, std::span<const std::string> region_names,
                                            std::span<const std::string> boundary_names,
                                            const mesh::QuadraticFacets* quadratic_facets = nullptr);

template <int dim>
[[nodiscard]] problem::Problem<dim> resolve(const Config& config, const mesh::Mesh<dim>& mesh)
{
  return resolve<dim>(config, mesh.region_names(), mesh.boundary_names(),
                      mesh.labels().quadratic_facets.get());
}

/// output.moment_about, by default the centroid. Throws InputError unless it has one number per dimension.
template <int dim>
[[nodiscard]] Point<dim> moment_point(const OutputConfig& output, const mesh::Mesh<dim>& mesh);

/// A summary of the case for reports.
[[nodiscard]] io::CaseFacts case_facts(const Config& config, int dimension);

}  // namespace tribound::case_file
