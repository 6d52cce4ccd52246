#include "tribound/contact/support/body_support.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <variant>

namespace tribound::contact
{

namespace
{

/// What is known of fixing a component of a boundary against a motion z.
struct Candidate
{
  double into = 0;   ///< integral of (z_c n_c)^2
  double along = 0;  ///< integral of z_c^2
  double measure = 0;
  bool loaded = false;
};

/// Whether `a` is the better choice. A component tangential to its boundary stops a motion as well, but
/// ranks below every normal one.
bool better(const Candidate& a, const Candidate& b)
{
  constexpr double tie = 1e-9;
  if (a.loaded != b.loaded) return !a.loaded;
  const double into = a.into / a.measure - b.into / b.measure;
  if (std::abs(into) > tie) return into > 0;
  return a.along / a.measure - b.along / b.measure > tie;
}

}  // namespace

std::string describe(const Remedy& remedy)
{
  return fmt::format("{} on boundary \"{}\"", "xyz"[remedy.component], remedy.boundary);
}

template <int dim>
Eigen::MatrixXd BodySupport<dim>::dirichlet_gram() const
{
  constexpr int n = RigidModes<dim>::n_modes;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(n, n);
  for_each_facet_vertex(
      [&](const problem::BoundaryCondition<dim>& condition, const Point<dim>&, const Point<dim>& x)
      {
        const auto z = body_.modes.at(x);
        for (int a = 0; a < dim; ++a)
          if (condition.fixes(a)) gram += z.row(a).transpose() * z.row(a);
      });
  return gram;
}

template <int dim>
Eigen::MatrixXd BodySupport<dim>::contact_gram(bool with_friction) const
{
  constexpr int n_modes = RigidModes<dim>::n_modes;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(n_modes, n_modes);
  for_each_facet_vertex(
      [&](const problem::BoundaryCondition<dim>& condition, const Point<dim>& n, const Point<dim>& x)
      {
        if (!condition.contact) return;
        const auto z = body_.modes.at(x);
        const auto z_n = n.transpose() * z;
        if (with_friction && cone(condition.contact->law).resists_sliding())
          gram += z.transpose() * z;
        else
          gram += z_n.transpose() * z_n;
      });
  return gram;
}

template <int dim>
MotionBasis BodySupport<dim>::left_by_displacements() const
{
  const Eigen::MatrixXd gram = dirichlet_gram();
  return null_space(gram, gram.trace());
}

template <int dim>
MotionBasis BodySupport<dim>::left_by_contact(bool with_friction) const
{
  const Eigen::MatrixXd gram = dirichlet_gram() + contact_gram(with_friction);
  return null_space(gram, gram.trace());
}

template <int dim>
std::optional<Remedy> BodySupport<dim>::remedy(const Coefficients& motion) const
{
  constexpr double negligible = 1e-12;
  std::map<std::pair<int, int>, Candidate> candidates;  // by boundary and component
  for (const mesh::BoundaryFacet& facet : body_.facets)
  {
    const problem::BoundaryCondition<dim>& condition = problem_.boundary(facet.tag);
    if (facet.tag < 0 || condition.contact) continue;
    const mesh::FacetGeometry<dim> geometry = mesh::facet_geometry(mesh_, facet.cell, facet.local);
    for (const Index v : mesh::facet_vertices(mesh_.cell(facet.cell), facet.local))
    {
      const Point<dim> z = body_.modes.at(mesh_.vertex(v)) * motion;
      for (int c = 0; c < dim; ++c)
      {
        if (condition.fixes(c)) continue;
        Candidate& candidate = candidates[{facet.tag, c}];
        candidate.along += geometry.measure * z[c] * z[c];
        candidate.into += geometry.measure * z[c] * z[c] * geometry.normal[c] * geometry.normal[c];
        candidate.measure += geometry.measure;
        candidate.loaded = condition.is_loaded();
      }
    }
  }
  std::optional<Remedy> best;
  Candidate score;
  for (const auto& [key, candidate] : candidates)
  {
    if (candidate.along <= negligible * motion.squaredNorm() * candidate.measure) continue;
    if (best && !better(candidate, score)) continue;
    best = Remedy{problem_.boundary(key.first).name, key.second};
    score = candidate;
  }
  return best;
}

template class BodySupport<2>;
template class BodySupport<3>;

}  // namespace tribound::contact
