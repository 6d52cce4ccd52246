/// Integrals of the contact terms over pieces of segments, and what may hide between their points (method
/// section 5).

#include <algorithm>
#include <cmath>
#include <optional>

#include "tribound/certify/bound/contact_pieces.h"
#include "tribound/certify/bound/contact_terms.h"

namespace tribound::certify
{

namespace
{

/// D is the polynomial through the values at the contact points: it is 0 or 1 if they all are.
template <int dim>
Bond bond_on(const contact::NitscheForm<dim>& form, int k)
{
  if (!cone(form.segments()[k].contact->law).is_bonded) return Bond::none;
  const std::span<const contact::ContactPoint<dim>> points = form.contact_points(k);
  if (std::ranges::all_of(points, [](const auto& point) { return point.state.damage <= 0; }))
    return Bond::fresh;
  return std::ranges::all_of(points, [](const auto& point) { return point.state.damage >= 1; })
             ? Bond::broken
             : Bond::damaged;
}

/// A law that breaks at `factor` times the traction.
problem::ContactLaw with_strength_times(double factor, problem::ContactLaw law)
{
  if (auto* joint = std::get_if<problem::JointLaw>(&law))
  {
    joint->tension.strength *= factor;
    joint->cohesion *= factor;
  }
  if (auto* mixed = std::get_if<problem::MixedLaw>(&law)) mixed->tension.strength *= factor;
  return law;
}

}  // namespace

template <int dim>
struct ContactTerms<dim>::PointsOnPiece
{
  const contact::SimplexMap<dim - 1, dim>& map;
  std::span<const FacetPoint> points;
  std::span<const Point<dim>> places;
  std::span<const Point<dim>> normals;
  std::span<const double> gaps;
};

template <int dim>
void ContactTerms<dim>::integrate(int k, std::span<const Fields> fields, std::span<const Piece> pieces,
                                  std::span<Integrals> results,
                                  const std::optional<problem::NormalDeviation>& known) const
{
  const contact::ContactSegment<dim>& segment = form_.segments()[k];
  const contact::SimplexMap<dim - 1, dim> map = contact::simplex_map(form_.space().mesh(), segment.slave);
  const std::vector<FacetPoint>& of_rule = form_.facet_rule().points;
  const std::size_t n_points = of_rule.size();
  std::vector<FacetPoint> points(pieces.size() * n_points);
  std::vector<Point<dim>> places(points.size());
  std::vector<Point<dim>> normals(points.size());
  std::vector<double> gaps(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    points[i] = fem::point_in<dim - 1>(pieces[i / n_points], of_rule[i % n_points]);
    places[i] = map(points[i]);
  }
  segment.directions_and_gaps(points, places, normals, gaps);
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    const auto of_piece = [&](const auto& all) { return std::span(all).subspan(i * n_points, n_points); };
    results[i] =
        integrate(k, fields[i], pieces[i],
                  {map, of_piece(points), of_piece(places), of_piece(normals), of_piece(gaps)}, known);
  }
}

template <int dim>
auto ContactTerms<dim>::integrate(int k, const Fields& fields, const Piece& piece, PointsOnPiece points,
                                  const std::optional<problem::NormalDeviation>& known) const -> Integrals
{
  const contact::ContactSegment<dim>& segment = form_.segments()[k];
  const fem::Quadrature<dim - 1>& rule = form_.facet_rule();
  const problem::ContactLaw& law = segment.contact->law;
  const double tangential_weight = problem::tangential_weight(law);
  const bool scaled = is_scaled(k);
  const Largest largest = largest_on(k, piece);
  Integrals result;
  const std::vector<problem::LawPoint<dim>> law_points =
      form_.law_points(k, points.points, points.places, points.normals);
  std::vector<Point<dim>> augmented(rule.size());
  std::vector<Point<dim>> projected(rule.size());
  for (int q = 0; q < rule.size(); ++q)
  {
    Pair values;
    for (int i = 0; i < n_; ++i) add_multiple(values, theta_[q * n_ + i], fields[i]);
    const Point<dim>& n = points.normals[q];
    const double closing = segment.gamma * points.gaps[q];
    const double m = scale(scaled, points.places[q]);
    const Point<dim>& p = augmented[q] = closing * n + augmented_of(values) / m;
    projected[q] = dis_of(values) / m;
    result.round_off =
        std::max(result.round_off, 1e-14 * (p.norm() + std::abs(closing) + law_points[q].water));
  }
  std::vector<Point<dim>> tractions(rule.size());
  problem::tractions<dim>(law, law_points, augmented, tractions);
  std::vector<double> strengths(rule.size());
  for (int q = 0; q < rule.size(); ++q)
  {
    const problem::LawPoint<dim>& point = law_points[q];
    const Point<dim> difference = tractions[q] - projected[q];
    const double normal = difference.dot(point.normal);
    const double weight =
        fem::fraction<dim - 1>(piece) * rule.weights[q] * form_.problem().weight(points.places[q]);
    result.normal += weight * normal * normal;
    result.tangential += weight * (difference - normal * point.normal).squaredNorm();
    augmented[q] += point.water * point.normal + tangential_weight * point.gamma * point.state.slip;
    const double m = scale(scaled, points.places[q]);
    augmented[q] *= m;
    strengths[q] = m * point.strength;
  }
  const bool turns = segment.varying_normal != nullptr;
  const Bond bond = bond_on(form_, k);
  std::optional<problem::ContactLaw> of_m_p;  // a fresh bond is compared with m P
  if (scaled && bond == Bond::fresh) of_m_p = with_strength_times(1 / largest.square_weight, law);
  result.kinks = kinks_(of_m_p ? *of_m_p : law, points.normals.first(turns ? rule.size() : 1), augmented,
                        strengths, bond, largest.scale * result.round_off);
  result.kinks.hidden *= largest.square_weight;
  if (!turns) return result;
  std::vector<double> weights(rule.size());
  for (int q = 0; q < rule.size(); ++q)
  {
    const double m = scale(scaled, points.places[q]);
    augmented[q] -= m * (segment.gamma * points.gaps[q] + law_points[q].water) * points.normals[q];
    projected[q] *= m;
    weights[q] =
        fem::fraction<dim - 1>(piece) * rule.weights[q] * form_.problem().weight(points.places[q]) / (m * m);
  }
  result.of_normal = known ? *known : deviation_on<dim>(points.map, *segment.varying_normal, piece);
  add_missed(k, piece, augmented, projected, weights, result);
  return result;
}

template void ContactTerms<2>::integrate(int, std::span<const Fields>, std::span<const Piece>,
                                         std::span<Integrals>,
                                         const std::optional<problem::NormalDeviation>&) const;
template void ContactTerms<3>::integrate(int, std::span<const Fields>, std::span<const Piece>,
                                         std::span<Integrals>,
                                         const std::optional<problem::NormalDeviation>&) const;

}  // namespace tribound::certify
