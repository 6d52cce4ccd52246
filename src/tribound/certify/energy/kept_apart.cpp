#include "tribound/certify/energy/kept_apart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "tribound/base/dense_factors.h"
#include "tribound/certify/energy/control_point.h"
#include "tribound/certify/energy/traction_fit.h"

namespace tribound::certify
{

namespace
{

using Matrix = Eigen::MatrixXd;

/// The facets that move, with their segments.
template <int dim>
class MovedFacets
{
 public:
  MovedFacets(const contact::NitscheForm<dim>& form, const ObstacleFacets<dim>& facets, MovedSide side);

  /// The coefficients by node of the first part of z.
  [[nodiscard]] std::vector<double> nearest(std::span<const WantedContact> wanted,
                                            std::span<const double> u) const;
  /// q_j by node; 0 where no such direction is free.
  [[nodiscard]] std::vector<double> directions() const;
  /// Multiplies q_j by a_j.
  void scale(std::span<const double> v, std::vector<double>& directions) const;
  /// The degrees of freedom of the function with these coefficients by node.
  [[nodiscard]] std::vector<double> values(std::span<const double> coefficients) const;

 private:
  /// The segments on one facet; all of them on the same side of it.
  struct Facet
  {
    bool is_master;
    std::vector<std::size_t> segments;
  };

  [[nodiscard]] std::vector<char> masters_move(MovedSide side) const;
  void find_tied();
  /// The nodes that move with this one: itself and those tied to it.
  [[nodiscard]] std::vector<Index> together(Index node) const;
  [[nodiscard]] std::array<bool, dim> fixed(std::span<const Index> nodes) const;
  [[nodiscard]] const contact::SegmentSide<dim>& side(const Facet& facet, std::size_t k) const
  {
    return facet.is_master ? *form_.segments()[k].master : form_.segments()[k].slave;
  }
  [[nodiscard]] std::span<const Index> nodes(const Facet& facet) const
  {
    const std::size_t k = facet.segments.front();
    return facet.is_master ? facets_.master_nodes(k) : facets_.nodes(k);
  }
  /// The direction on the facet in which [z]^n grows on segment k.
  [[nodiscard]] Point<dim> away(const Facet& facet, std::size_t k) const
  {
    return side(facet, k).sign * facets_.frames().normal(k);
  }
  [[nodiscard]] Matrix nearest_on(const Facet& facet, std::span<const WantedContact> wanted,
                                  std::span<const double> u) const;
  [[nodiscard]] double factor(const Facet& facet, std::span<const double> v, std::span<const double> q) const;

  const contact::NitscheForm<dim>& form_;
  const ObstacleFacets<dim>& facets_;
  std::map<std::size_t, Facet> moved_;     ///< by the number of the facet
  std::map<Index, std::set<Index>> tied_;  ///< the nodes tied to a node
};

template <int dim>
MovedFacets<dim>::MovedFacets(const contact::NitscheForm<dim>& form, const ObstacleFacets<dim>& facets,
                              MovedSide side)
    : form_(form), facets_(facets)
{
  const std::vector<char> masters_move = this->masters_move(side);
  for (std::size_t k = 0; k < facets.size(); ++k)
  {
    if (facets.matches(k)) continue;
    const contact::ContactSegment<dim>& segment = form.segments()[k];
    const bool is_master = segment.master && masters_move[segment.pair] != 0;
    Facet& facet = moved_[is_master ? segment.master->number : segment.slave.number];
    facet.is_master = is_master;
    facet.segments.push_back(k);
  }
  find_tied();
}

/// Also over several bodies that meet at a node.
template <int dim>
void MovedFacets<dim>::find_tied()
{
  for (std::size_t k = 0; k < facets_.size(); ++k)
  {
    if (!problem::cone(form_.segments()[k].contact->law).is_tied || !facets_.matches(k)) continue;
    for (std::size_t j = 0; j < facets_.nodes(k).size(); ++j)
    {
      std::set<Index> all = {facets_.nodes(k)[j], facets_.master_nodes(k)[j]};
      for (const Index node : {facets_.nodes(k)[j], facets_.master_nodes(k)[j]})
        if (const auto known = tied_.find(node); known != tied_.end())
          all.insert(known->second.begin(), known->second.end());
      for (const Index node : all) tied_[node] = all;
    }
  }
}

template <int dim>
std::vector<Index> MovedFacets<dim>::together(Index node) const
{
  const auto found = tied_.find(node);
  return found == tied_.end() ? std::vector<Index>{node}
                              : std::vector<Index>(found->second.begin(), found->second.end());
}

template <int dim>
std::array<bool, dim> MovedFacets<dim>::fixed(std::span<const Index> nodes) const
{
  std::array<bool, dim> result{};
  for (const Index node : nodes)
    for (int a = 0; a < dim; ++a) result[a] = result[a] || form_.constraints().fixed[dim * node + a] != 0;
  return result;
}

/// By pair. The weights of the sides in {sigma} are inverse to modulus / diameter.
template <int dim>
std::vector<char> MovedFacets<dim>::masters_move(MovedSide side) const
{
  const mesh::Mesh<dim>& mesh = form_.space().mesh();
  const auto diameter = [&](const contact::SegmentSide<dim>& of)
  { return mesh::facet_geometry(mesh, of.facet.cell, of.facet.local).diameter; };
  std::vector<double> costs(form_.problem().pairs().size(),
                            0.0);  // mean logarithms of those of masters / slaves
  for (std::size_t k = 0; k < form_.n_owned_segments(); ++k)
  {
    const contact::ContactSegment<dim>& segment = form_.segments()[k];
    if (facets_.matches(k) || !segment.master) continue;
    const double of_slave = segment.slave.stress_direction.norm();
    costs[segment.pair] +=
        segment.measure * (std::log(of_slave / (1 - of_slave)) +
                           2 * std::log(diameter(*segment.master) / diameter(segment.slave)));
  }
  mesh.ranks().sum(std::span(costs));
  std::vector<char> result(costs.size());
  for (std::size_t i = 0; i < costs.size(); ++i) result[i] = (costs[i] < 0) == (side == MovedSide::preferred);
  return result;
}

/// Coefficients [j, component] of the polynomial on a facet nearest to what z should be there. What is not
/// covered, or hardly, gets a small weight with the value 0.
template <int dim>
Matrix MovedFacets<dim>::nearest_on(const Facet& facet, std::span<const WantedContact> wanted,
                                    std::span<const double> u) const
{
  constexpr double small = 1e-2;
  const fem::Quadrature<dim - 1>& rule = form_.facet_rule();
  const int degree = form_.space().degree();
  const Matrix on_segment = bernstein_at<dim>(degree, rule.points);
  const Eigen::Index n = on_segment.cols();
  Matrix gram = Matrix::Zero(n, n);
  Matrix moments = Matrix::Zero(n, dim);
  const auto add = [&](const Matrix& basis, double det)
  {
    for (int q = 0; q < rule.size(); ++q)
      gram += det * rule.weights[q] * basis.row(q).transpose() * basis.row(q);
  };
  const auto& part = side(facet, facet.segments.front()).part;
  add(on_segment,
      small * form_.segments()[facet.segments.front()].det() / (part ? fem::fraction<dim - 1>(*part) : 1.0));
  for (const std::size_t k : facet.segments)
  {
    const contact::ContactSegment<dim>& segment = form_.segments()[k];
    std::vector<Point<dim - 1>> points;
    for (const Point<dim - 1>& s : rule.points) points.push_back(side(facet, k).on_facet(s));
    const Matrix on_facet = bernstein_at<dim>(degree, points);
    add(on_facet, segment.det());
    const std::vector<Point<dim>> jump = facets_.coefficients(k, u);
    for (int q = 0; q < rule.size(); ++q)
    {
      const contact::ContactPoint<dim>& point = form_.contact_points(k)[q];
      Point<dim> c = Point<dim>::Zero();
      for (Eigen::Index j = 0; j < n; ++j) c += on_segment(q, j) * jump[j];
      const double along = c.dot(point.normal);
      Point<dim> target = Point<dim>::Zero();
      if (wanted[k].closed) target += (along - point.gap) * point.normal;
      if (wanted[k].sticks) target += c - along * point.normal - point.state.slip;
      moments += side(facet, k).sign * segment.det() * rule.weights[q] * on_facet.row(q).transpose() *
                 target.transpose();
    }
  }
  return CholeskyFactors(gram).solve(moments);
}

template <int dim>
std::vector<double> MovedFacets<dim>::nearest(std::span<const WantedContact> wanted,
                                              std::span<const double> u) const
{
  struct Mean
  {
    Point<dim> sum = Point<dim>::Zero();
    int n = 0;
  };
  std::map<Index, Mean> means;
  for (const auto& [number, facet] : moved_)
  {
    if (std::ranges::none_of(facet.segments,
                             [&](std::size_t k) { return wanted[k].closed || wanted[k].sticks; }))
      continue;
    const Matrix coefficients = nearest_on(facet, wanted, u);
    for (std::size_t j = 0; j < nodes(facet).size(); ++j)
    {
      Mean& mean = means[together(nodes(facet)[j]).front()];
      mean.sum += coefficients.row(static_cast<Eigen::Index>(j)).transpose();
      ++mean.n;
    }
  }
  std::vector<double> result(form_.space().n_dofs(), 0.0);
  for (const auto& [first, mean] : means)
  {
    const std::vector<Index> nodes = together(first);
    const std::array<bool, dim> fixed = this->fixed(nodes);
    for (const Index node : nodes)
      for (int a = 0; a < dim; ++a)
        if (!fixed[a]) result[dim * node + a] = mean.sum[a] / mean.n;
  }
  form_.space().update(std::span(result));
  return result;
}

/// The shortest q with n . q >= 1 for all normals, but for 1/0.9 where they are nearly the same, as where
/// directions of contact vary: there are many then.
template <int dim>
Point<dim> away_from(const std::vector<ControlCondition<dim>>& conditions, const std::array<bool, dim>& fixed)
{
  constexpr double nearly = 0.9;
  constexpr std::size_t most = 8;  // the time grows with the third power
  Point<dim> mean = Point<dim>::Zero();
  for (const ControlCondition<dim>& condition : conditions) mean += condition.normal;
  for (int a = 0; a < dim; ++a)
    if (fixed[a]) mean[a] = 0;
  mean.normalize();
  double least = 1;
  for (const ControlCondition<dim>& condition : conditions)
    least = std::min(least, mean.dot(condition.normal));
  if (least >= nearly || (least > 0 && conditions.size() > most)) return mean / least;
  return -moved<dim>(Point<dim>::Zero(), fixed, conditions);
}

template <int dim>
std::vector<double> MovedFacets<dim>::directions() const
{
  constexpr double same = 1e-12;
  std::map<Index, std::vector<ControlCondition<dim>>> conditions;  // on -q_j
  for (const auto& [number, facet] : moved_)
    for (const std::size_t k : facet.segments)
      for (const Index node : nodes(facet))
      {
        std::vector<ControlCondition<dim>>& known = conditions[together(node).front()];
        const Point<dim> n = away(facet, k);
        if (std::ranges::none_of(known, [&](const auto& other) { return (other.normal - n).norm() <= same; }))
          known.push_back({.normal = n, .gap = -1});
      }
  std::vector<double> result(form_.space().n_dofs(), 0.0);
  for (const auto& [first, of_nodes] : conditions)
  {
    const std::vector<Index> nodes = together(first);
    const Point<dim> q = away_from<dim>(of_nodes, fixed(nodes));
    if (std::ranges::all_of(of_nodes, [&](const auto& condition) { return q.dot(condition.normal) > 0; }))
      for (const Index node : nodes) std::ranges::copy(q, &result[dim * node]);
  }
  form_.space().update(std::span(result));
  return result;
}

/// The smallest a such that v - a q, both as degrees of freedom, keeps the bodies apart on this facet.
template <int dim>
double MovedFacets<dim>::factor(const Facet& facet, std::span<const double> v,
                                std::span<const double> q) const
{
  constexpr double least = 1e-6;  // of a direction that helps
  double result = 0;
  for (const std::size_t k : facet.segments)
  {
    const std::vector<Point<dim>> jump = facets_.turned(k, facets_.coefficients(k, v));
    const std::vector<Point<dim>> of_q =
        facets_.turned(k, facet.is_master ? facets_.on_master(k, q) : facets_.on_slave(k, q));
    for (std::size_t j = 0; j < jump.size(); ++j)
    {
      const double excess = facets_.frames().normal(k).dot(jump[j]) - facets_.gap(k)[j];
      if (excess > 0) result = std::max(result, excess / std::max(least, away(facet, k).dot(of_q[j])));
    }
  }
  return result;
}

template <int dim>
void MovedFacets<dim>::scale(std::span<const double> v, std::vector<double>& directions) const
{
  const std::vector<double> q = values(directions);
  std::map<Index, double> factors;
  for (const auto& [number, facet] : moved_)
  {
    const double a = factor(facet, v, q);
    for (const Index node : nodes(facet))
    {
      double& of_nodes = factors[together(node).front()];
      of_nodes = std::max(of_nodes, a);
    }
  }
  for (const auto& [first, a] : factors)
    for (const Index node : together(first))
      for (int c = 0; c < dim; ++c) directions[dim * node + c] *= a;
  form_.space().update(std::span(directions));
}

template <int dim>
std::vector<double> MovedFacets<dim>::values(std::span<const double> coefficients) const
{
  std::vector<double> result(form_.space().n_dofs(), 0.0);
  for (const auto& [number, facet] : moved_)
  {
    const std::vector<Point<dim>> on_facet = facets_.values(nodes(facet), coefficients);
    for (std::size_t i = 0; i < on_facet.size(); ++i)
      for (const Index node : together(nodes(facet)[i])) std::ranges::copy(on_facet[i], &result[dim * node]);
  }
  form_.space().update(std::span(result));
  return result;
}

}  // namespace

template <int dim>
std::vector<double> kept_apart(const contact::NitscheForm<dim>& form, const ObstacleFacets<dim>& facets,
                               MovedSide side, std::span<const WantedContact> wanted,
                               std::span<const double> u)
{
  const MovedFacets<dim> moved(form, facets, side);
  std::vector<double> v(u.begin(), u.end());
  const auto subtract = [&](const std::vector<double>& z)
  {
    for (std::size_t i = 0; i < v.size(); ++i) v[i] -= z[i];
  };
  subtract(moved.values(moved.nearest(wanted, u)));
  std::vector<double> away = moved.directions();
  moved.scale(v, away);
  subtract(moved.values(away));
  return v;
}

template std::vector<double> kept_apart(const contact::NitscheForm<2>&, const ObstacleFacets<2>&, MovedSide,
                                        std::span<const WantedContact>, std::span<const double>);
template std::vector<double> kept_apart(const contact::NitscheForm<3>&, const ObstacleFacets<3>&, MovedSide,
                                        std::span<const WantedContact>, std::span<const double>);

}  // namespace tribound::certify
