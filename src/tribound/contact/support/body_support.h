#pragma once

/// @file body_support.h
/// What stops the rigid motions of a body: displacement conditions, contact that pushes, friction.

#include <Eigen/Core>
#include <optional>
#include <string>

#include "tribound/contact/support/body.h"
#include "tribound/contact/support/rigid_modes.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/mesh.h"
#include "tribound/problem/problem.h"

namespace tribound::contact
{

/// A displacement component of a boundary that a motion changes, and that may be fixed to stop it.
struct Remedy
{
  std::string boundary;
  int component = 0;

  friend bool operator==(const Remedy&, const Remedy&) = default;
};

/// `x on boundary "left"`.
[[nodiscard]] std::string describe(const Remedy& remedy);

/// One body with the conditions on its boundary. Keeps references.
template <int dim>
class BodySupport
{
 public:
  using Coefficients = typename RigidModes<dim>::Coefficients;

  BodySupport(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh, const Body<dim>& body)
      : problem_(problem), mesh_(mesh), body_(body)
  {
  }

  /// Calls visit(condition, normal, x) at each vertex x of each facet of the body that is held or in contact.
  template <class Visit>
  void for_each_facet_vertex(Visit visit) const;

  /// Sum of r r^T over the rows r of what displacement conditions stop of a motion z: its fixed components.
  [[nodiscard]] Eigen::MatrixXd dirichlet_gram() const;
  /// The same for closed contact: z^n, and all of z where there is friction and it counts.
  [[nodiscard]] Eigen::MatrixXd contact_gram(bool with_friction) const;

  /// Motions that displacement conditions leave.
  [[nodiscard]] MotionBasis left_by_displacements() const;
  /// Motions that would be left even if contact could pull as well: without friction only friction stops
  /// them, with friction nothing does.
  [[nodiscard]] MotionBasis left_by_contact(bool with_friction) const;

  /// The boundary component to fix against the motion z: the one with the largest mean of (z_c n_c)^2, that
  /// is of the motion into a wall or a plane of symmetry; one that carries no load where there is a choice.
  /// Nothing where every boundary that z changes is in contact or in no group.
  [[nodiscard]] std::optional<Remedy> remedy(const Coefficients& motion) const;

 private:
  const problem::Problem<dim>& problem_;
  const mesh::Mesh<dim>& mesh_;
  const Body<dim>& body_;
};

template <int dim>
template <class Visit>
void BodySupport<dim>::for_each_facet_vertex(Visit visit) const
{
  for (const mesh::BoundaryFacet& facet : body_.facets)
  {
    const problem::BoundaryCondition<dim>& condition = problem_.boundary(facet.tag);
    if (!condition.contact && !condition.fixes_any()) continue;
    const Point<dim> n = mesh::facet_geometry(mesh_, facet.cell, facet.local).normal;
    for (const Index v : mesh::facet_vertices(mesh_.cell(facet.cell), facet.local))
      visit(condition, n, mesh_.vertex(v));
  }
}

}  // namespace tribound::contact
