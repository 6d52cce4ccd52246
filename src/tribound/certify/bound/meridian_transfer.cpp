#include "tribound/certify/bound/meridian_transfer.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tribound/base/dense_factors.h"
#include "tribound/certify/bound/constants.h"
#include "tribound/contact/nitsche/facet_cuts.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/polynomials.h"

namespace tribound::certify
{

namespace
{

/// Moments and squares of q on a facet, with the weight r.
struct RadialMoments
{
  mesh::BoundaryFacet facet;
  Eigen::MatrixXd moments;  ///< (r q, theta_i), a row for each i
  double square = 0;        ///< (r q, q)
};

/// theta_i of P^p at points of the reference facet, a column for each.
template <class Points>
Eigen::MatrixXd basis_at(int degree, const Points& points)
{
  Eigen::MatrixXd theta(degree + 1, static_cast<Eigen::Index>(points.size()));
  for (std::size_t q = 0; q < points.size(); ++q)
    fem::orthonormal_values<1>(degree, points[q],
                               std::span(theta.col(static_cast<Eigen::Index>(q)).data(), degree + 1));
  return theta;
}

/// Pi_k t at the contact points of segment k, a row for each; theta at the points of the rule.
Eigen::MatrixXd projected(const contact::NitscheForm<2>& form, std::size_t k, const Eigen::MatrixXd& theta,
                          std::span<const Point<2>> t)
{
  const auto points = form.contact_points(k);
  Eigen::VectorXd weights(theta.cols());
  Eigen::MatrixXd values(theta.cols(), 2);
  for (Eigen::Index q = 0; q < theta.cols(); ++q)
  {
    weights[q] = points[q].weight;
    values.row(q) = t[k * points.size() + q].transpose();
  }
  const Eigen::MatrixXd weighted = theta * weights.asDiagonal();
  return theta.transpose() * CholeskyFactors(weighted * theta.transpose()).solve(weighted * values);
}

/// ||q - Pi_F q||_{r,F}^2, up to rounding, which is added.
double lost_square(const contact::NitscheForm<2>& form, const RadialMoments& of, const Eigen::MatrixXd& theta)
{
  Eigen::VectorXd weights(theta.cols());
  for (const auto& [q, x, dx] :
       fem::facet_points(form.space().mesh(), of.facet.cell, of.facet.local, form.facet_rule()))
    weights[q] = x[0] * dx;
  const Eigen::MatrixXd products = theta * weights.asDiagonal() * theta.transpose();
  const double kept = of.moments.cwiseProduct(CholeskyFactors(products).solve(of.moments)).sum();
  constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();
  return std::max(0.0, of.square - kept) + rounding * of.square;
}

}  // namespace

std::map<Index, double> meridian_transfers(const contact::NitscheForm<2>& form, std::span<const Point<2>> t)
{
  const mesh::Mesh<2>& mesh = form.space().mesh();
  const int degree = form.space().degree();
  const std::vector<Point<1>>& rule = form.facet_rule().points;
  const Eigen::MatrixXd theta = basis_at(degree, rule);
  std::map<std::size_t, RadialMoments> facets;
  for (std::size_t k = 0; k < form.segments().size(); ++k)
  {
    const contact::ContactSegment<2>& segment = form.segments()[k];
    if (contact::is_whole(mesh, segment)) continue;
    const Eigen::MatrixXd q = projected(form, k, theta, t);
    segment.for_each_side(
        [&](const contact::SegmentSide<2>& side)
        {
          if (side.facet.cell >= mesh.n_owned_cells()) return;
          RadialMoments& of_facet = facets[side.number];
          of_facet.facet = side.facet;
          if (of_facet.moments.size() == 0) of_facet.moments = Eigen::MatrixXd::Zero(degree + 1, 2);
          std::vector<Point<1>> places;
          for (const Point<1>& s : rule) places.push_back(side.on_facet(s));
          const Eigen::MatrixXd on_facet = basis_at(degree, places);
          const double stretch = contact::simplex_map(mesh, side).measure / segment.measure;
          for (Eigen::Index i = 0; i < q.rows(); ++i)
          {
            const double weight = form.contact_points(k)[i].weight;
            of_facet.moments += side.sign * weight * on_facet.col(i) * q.row(i);
            of_facet.square += weight / stretch * q.row(i).squaredNorm();
          }
        });
  }
  std::map<Index, double> result;
  for (const auto& [number, of_facet] : facets)
  {
    const auto& [cell, local, tag] = of_facet.facet;
    const double constant = meridian_trace_constant(mesh::cell_diameter(mesh, cell),
                                                    mesh::facet_geometry(mesh, cell, local).measure,
                                                    mesh::cell_map(mesh, cell).measure());
    result[cell] += constant * std::sqrt(lost_square(form, of_facet, theta));
  }
  return result;
}

}  // namespace tribound::certify
