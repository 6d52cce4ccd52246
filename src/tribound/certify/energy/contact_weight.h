#pragma once

/// @file contact_weight.h
/// Rigid motions as weights of contact tractions, also beside fixed displacements.

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/certify/energy/contact_resultant.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/mesh/first_facet_finder.h"

namespace tribound::certify
{

/// A motion as a weight on the facets of a resultant. The weight is the jump of functions in H^1_D: 0 on
/// other contact facets, along directions that Gamma_D fixes, and where three bodies meet.
template <int dim>
struct ContactWeight
{
  std::vector<double> at_nodes;       ///< degrees of freedom of the slaves; 0 off these facets
  std::vector<Point<dim>> at_points;  ///< at the contact points of the form
  std::string note{};                 ///< where the weight differs from the motion
  std::string reason{};               ///< why there is no weight; empty: there is one
};

/// Weights that are linear on the facets of the first mesh, so that they are the same functions on all meshes
/// made from it. All ranks construct and call it together.
template <int dim>
class ContactWeights
{
 public:
  /// For forms with these segments, to which obstacles_unfit() has no objection. `junctions`: from
  /// ObstacleFacets of one of them.
  ContactWeights(const contact::NitscheForm<dim>& form, std::span<const char> junctions);

  /// The motion times min(1, d / ramp) at the vertices of the first mesh, with d the distance from where it
  /// would jump. ramp = 0: a tenth of the diagonal of the bounding box of the boundary.
  [[nodiscard]] ContactWeight<dim> operator()(const contact::NitscheForm<dim>& form,
                                              const ContactResultant<dim>& resultant, double ramp) const;

 private:
  /// By vertex of the first mesh.
  [[nodiscard]] std::vector<char> jumps(const contact::NitscheForm<dim>& form,
                                        const ContactResultant<dim>& resultant) const;
  [[nodiscard]] bool is_on(std::size_t facet, const ContactResultant<dim>& resultant) const
  {
    return resultant.has(first_.tags[facet]) && is_contact_[first_.tags[facet]] != 0;
  }
  [[nodiscard]] double diagonal_around(const ContactResultant<dim>& resultant) const;
  struct FirstValues
  {
    std::vector<Point<dim>> values;  ///< at vertices of the first mesh whose facets have segments here
    bool is_motion;                  ///< it jumps nowhere
  };
  [[nodiscard]] FirstValues on_first_mesh(const contact::NitscheForm<dim>& form,
                                          const ContactResultant<dim>& resultant, double ramp) const;
  /// At the vertices of segment k, from values at the vertices of the first mesh.
  [[nodiscard]] std::array<Point<dim>, dim> at_vertices(std::size_t k,
                                                        std::span<const Point<dim>> at_first) const;

  const mesh::FirstFacets& first_;
  std::vector<char> is_contact_;  ///< by boundary: an obstacle or the slave of a pair
  std::vector<typename mesh::FirstFacetFinder<dim>::Place> places_;  ///< of the segments' facets
  std::vector<char> junctions_;                                      ///< by vertex of the first mesh
};

}  // namespace tribound::certify
