#include "tribound/contact/support/support.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <variant>

#include "tribound/contact/support/holds.h"

namespace tribound::contact
{

namespace
{

/// The effect of fixing a component of a boundary against a motion z.
struct Fixing
{
  double into = 0;   ///< integral of (z_c n_c)^2
  double along = 0;  ///< integral of z_c^2
  double measure = 0;
  bool loaded = false;
};

/// Whether `a` is the better choice. A component tangential to its boundary also stops a motion, but ranks
/// below every normal one.
bool better(const Fixing& a, const Fixing& b)
{
  constexpr double tie = 1e-9;
  if (a.loaded != b.loaded) return !a.loaded;
  const double into = a.into / a.measure - b.into / b.measure;
  if (std::abs(into) > tie) return into > 0;
  return a.along / a.measure - b.along / b.measure > tie;
}

/// r^T r for rows r at points of boundaries and pairs, as the mean for each boundary and pair, so that one
/// with few facets counts as much as one with many.
class MeanGrams
{
 public:
  using Key = std::pair<int, int>;  ///< boundary and body; pair and -1

  /// Adds rows for the given coefficients of motions, at one more point of `key`.
  template <class Rows>
  void add(const Key& key, const std::vector<int>& coefficients, const Rows& rows)
  {
    auto [it, is_new] = sums_.try_emplace(key);
    auto& [gram, count] = it->second;
    if (is_new) gram.setZero(n_, n_);
    gram(coefficients, coefficients) += rows.transpose() * rows;
    ++count;
  }

  explicit MeanGrams(int n_motions) : n_(n_motions) {}

  [[nodiscard]] Eigen::MatrixXd sum() const
  {
    Eigen::MatrixXd total = Eigen::MatrixXd::Zero(n_, n_);
    for (const auto& [key, entry] : sums_) total += entry.first / static_cast<double>(entry.second);
    return total;
  }

 private:
  int n_;
  std::map<Key, std::pair<Eigen::MatrixXd, long>> sums_;
};

/// Adds rows(law, n, M) with [z] = M z at the corners of the segments.
template <int dim, class Rows>
void add_segments(const mesh::Mesh<dim>& mesh, std::span<const ContactSegment<dim>> segments,
                  const Assembly<dim>& assembly, MeanGrams& grams, const Rows& rows)
{
  for_each_corner(mesh, segments, assembly,
                  [&](const AssemblySegment& entry, const ContactSegment<dim>& segment, const Point<dim>& n,
                      const std::vector<int>& coefficients, const auto& z)
                  {
                    const auto key = segment.pair < 0 ? MeanGrams::Key(segment.slave.facet.tag, entry.slave)
                                                      : MeanGrams::Key(segment.pair, -1);
                    grams.add(key, coefficients, rows(problem::cone(segment.contact->law), n, z));
                  });
}

}  // namespace

std::string describe(const Remedy& remedy)
{
  return fmt::format("{} on boundary \"{}\"", "xyz"[remedy.component], remedy.boundary);
}

template <int dim>
Eigen::MatrixXd Support<dim>::fixed_gram() const
{
  constexpr int of_hoops = -2;  // no boundary has this number
  MeanGrams grams(assembly_.n_motions());
  for (int b = 0; b < static_cast<int>(assembly_.bodies.size()); ++b)
    for (const mesh::BoundaryFacet& facet : assembly_.bodies[b].facets)
    {
      const problem::BoundaryCondition<dim>& condition = problem_.boundary(facet.tag);
      if (problem_.is_axisymmetric())  // hoop stress holds what moves away from the axis
        for (const Index v : mesh::facet_vertices(mesh_.cell(facet.cell), facet.local))
          grams.add({of_hoops, b}, assembly_.coefficients(b), assembly_.modes.at(mesh_.vertex(v)).row(0));
      if (!condition.holds_any()) continue;
      for_each_hold(condition, mesh_, facet, assembly_.modes,
                    [&](const auto& rows) {
                      grams.add({facet.tag, b}, assembly_.coefficients(b), rows);
                    });
    }
  add_segments(mesh_, segments_, assembly_, grams,
               [](const problem::FrictionCone& law, const Point<dim>& n, const auto& z)
               {
                 if (law.glues()) return Eigen::MatrixXd(z);
                 return law.is_bilateral ? Eigen::MatrixXd(n.transpose() * z) : Eigen::MatrixXd(0, z.cols());
               });
  return grams.sum();
}

template <int dim>
Eigen::MatrixXd Support<dim>::contact_gram(bool with_friction) const
{
  MeanGrams grams(assembly_.n_motions());
  add_segments(mesh_, segments_, assembly_, grams,
               [&](const problem::FrictionCone& law, const Point<dim>& n, const auto& z)
               {
                 if (law.glues() || law.is_bilateral) return Eigen::MatrixXd(0, z.cols());
                 return with_friction && law.resists_sliding() ? Eigen::MatrixXd(z)
                                                               : Eigen::MatrixXd(n.transpose() * z);
               });
  return grams.sum();
}

template <int dim>
MotionBasis Support<dim>::left_by_fixing() const
{
  const Eigen::MatrixXd gram = fixed_gram();
  return null_space(gram, gram.trace());
}

template <int dim>
MotionBasis Support<dim>::left_by_contact(bool with_friction) const
{
  const Eigen::MatrixXd gram = fixed_gram() + contact_gram(with_friction);
  return null_space(gram, gram.trace());
}

template <int dim>
std::optional<Remedy> Support<dim>::remedy(const Eigen::VectorXd& motion) const
{
  constexpr double negligible = 1e-12;
  std::map<std::pair<int, int>, Fixing> candidates;  // by boundary and component
  for (int b = 0; b < static_cast<int>(assembly_.bodies.size()); ++b)
    for (const mesh::BoundaryFacet& facet : assembly_.bodies[b].facets)
    {
      if (facet.tag < 0 || problem_.is_in_contact(facet.tag)) continue;
      const problem::BoundaryCondition<dim>& condition = problem_.boundary(facet.tag);
      const mesh::FacetGeometry<dim> geometry = mesh::facet_geometry(mesh_, facet.cell, facet.local);
      for (const Index v : mesh::facet_vertices(mesh_.cell(facet.cell), facet.local))
      {
        const Point<dim> z = assembly_.modes.at(mesh_.vertex(v)) * assembly_.part(motion, b);
        for (int c = 0; c < dim; ++c)
        {
          if (condition.fixes(c)) continue;
          Fixing& candidate = candidates[{facet.tag, c}];
          candidate.along += geometry.measure * z[c] * z[c];
          candidate.into += geometry.measure * z[c] * z[c] * geometry.normal[c] * geometry.normal[c];
          candidate.measure += geometry.measure;
          candidate.loaded = condition.is_loaded();
        }
      }
    }
  std::optional<Remedy> best;
  Fixing score;
  for (const auto& [key, candidate] : candidates)
  {
    if (candidate.along <= negligible * motion.squaredNorm() * candidate.measure) continue;
    if (best && !better(candidate, score)) continue;
    best = Remedy{problem_.boundary(key.first).name, key.second};
    score = candidate;
  }
  return best;
}

template class Support<2>;
template class Support<3>;

}  // namespace tribound::contact
