#pragma once

/// @file page_level.h
/// A level as data of the report page: its surface with the fields, the interior in 3D, contact.

#include <cstddef>
#include <span>

#include "app/page/page_surface.h"
#include "tribound/io/file/json.h"

namespace tribound::app
{

struct PageLevel
{
  int number = 0;
  std::size_t n_triangles = 0;
  io::Json json;
  io::Json volume{};  ///< page_volume() of the last level
};

/// What is the same in the data of every surface: its points with their displacements, its faces, stresses,
/// regions, bodies.
template <int dim>
[[nodiscard]] io::Json surface_json(const contact::NitscheForm<dim>& form, const Surface& surface);

template <int dim>
[[nodiscard]] PageLevel page_level(int number, const contact::NitscheForm<dim>& form,
                                   const adapt::CertifiedLevel<dim>& level, const PageLimits& limits = {});

/// The interior of a body in 3D, which the page cuts by planes: tetrahedra with values at their vertices.
/// Stresses, which are discontinuous, are averaged there by volume. Null beyond PageLimits::volume.
[[nodiscard]] io::Json page_volume(const contact::NitscheForm<3>& form,
                                   const adapt::CertifiedLevel<3>& level);

/// Contact, as members for the data of a level with a given surface: `contact` and `pairs` in 3D, `profiles`
/// in 2D, `interfaces` where bodies are in contact; empty ones are absent.
template <int dim>
[[nodiscard]] io::Json page_contact(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                    const Surface& surface, const PageLimits& limits);

}  // namespace tribound::app
