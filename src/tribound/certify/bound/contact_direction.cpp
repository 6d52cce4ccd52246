/// What a varying direction of contact that is not a polynomial adds to the contact terms (method section
/// 5.6).

#include <algorithm>
#include <cmath>

#include "tribound/certify/bound/contact_pieces.h"
#include "tribound/certify/bound/contact_terms.h"
#include "tribound/fem/evaluation.h"

namespace tribound::certify
{

template <int dim>
void ContactTerms<dim>::add_varying_traction(int k, std::span<const Point<dim>> coefficients,
                                             double& normal_part, double& tangential_part) const
{
  const contact::ContactSegment<dim>& segment = form_.segments()[k];
  double normal = 0;
  double tangential = 0;
  double whole = 0;
  const bool scaled = is_scaled(k);
  for (int q = 0; q < form_.n_segment_points(); ++q)
  {
    const contact::ContactPoint<dim>& point = form_.contact_points(k)[q];
    Point<dim> t = Point<dim>::Zero();
    for (std::size_t i = 0; i < coefficients.size(); ++i) t += theta_[q * n_ + i] * coefficients[i];
    t /= scale(scaled, point.x);
    const Point<dim>& n = point.normal;
    const double t_n = t.dot(n);
    const double weight =
        norm_scale(segment) * form_.facet_rule().weights[q] * form_.problem().weight(point.x);
    normal += weight * t_n * t_n;
    tangential += weight * (t - t_n * n).squaredNorm();
    whole += weight * t.squaredNorm();
  }
  problem::NormalDeviation off{};
  if (segment.varying_normal != nullptr)
    off = deviation_on<dim>(contact::simplex_map(form_.space().mesh(), segment.slave),
                            *segment.varying_normal, fem::reference_simplex<dim - 1>());
  normal_part += std::pow(std::sqrt(normal) + 2 * off.quadratic * std::sqrt(whole), 2);
  tangential_part +=
      std::pow(std::sqrt(tangential) + 2 * tangential_deviation<dim>(off) * std::sqrt(whole), 2);
}

template <int dim>
void ContactTerms<dim>::add_missed(int k, const Piece& piece, std::span<const Point<dim>> augmented,
                                   std::span<const Point<dim>> dis, std::span<const double> weights,
                                   Integrals& integrals) const
{
  const contact::ContactSegment<dim>& segment = form_.segments()[k];
  const problem::NormalDeviation& off = integrals.of_normal;
  double of_augmented = 0;
  double of_dis = 0;
  double largest = 0;
  for (std::size_t q = 0; q < augmented.size(); ++q)
  {
    of_augmented += weights[q] * augmented[q].squaredNorm();
    of_dis += weights[q] * dis[q].squaredNorm();
    largest = std::max(largest, augmented[q].norm());
  }
  // Between bodies the distance of the meshes along N is part of P^n: that of polynomials of degree 1.
  double distance = 0;
  if (!segment.contact->gap)
    for (const Point<dim>& offset : segment.offset) distance = std::max(distance, offset.norm());
  distance *= segment.gamma;
  const Largest on_piece = largest_on(k, piece);
  integrals.deviation = off.quadratic * (kinks_.amplification() * largest + on_piece.scale * distance);

  const double measure = on_piece.weight * fem::fraction<dim - 1>(piece) / mesh::factorial<dim - 1>;
  const problem::FrictionCone friction = problem::cone(segment.contact->law);
  const double pressure = misses * off.quadratic * (std::sqrt(of_augmented) + distance * std::sqrt(measure));
  const double along = misses * tangential_deviation<dim>(off);
  const double rubbing = along * std::sqrt(of_augmented) + friction.coefficient * pressure;
  const double rubbing_open = friction.strength == nullptr ? 0 : along * std::sqrt(of_augmented);
  const double projected = misses * off.quadratic * std::sqrt(of_dis);
  const double projected_along = along * std::sqrt(of_dis);
  integrals.missed = {std::pow(pressure + projected, 2), std::pow(rubbing + projected_along, 2)};
  integrals.missed_open = {std::pow(projected, 2), std::pow(rubbing_open + projected_along, 2)};
}

template <int dim>
void ContactTerms<dim>::resolve_normal(int k, std::vector<Part>& parts) const
{
  // A jump of N is a point in 2D, where halving is cheap, and a curve in 3D.
  constexpr int deepest = dim == 2 ? 30 : 3;
  const contact::ContactSegment<dim>& segment = form_.segments()[k];
  const double allowed = std::pow(form_.data().contact_density(), 2) * segment.measure *
                         largest_on(k, fem::reference_simplex<dim - 1>()).weight;
  const auto is_enough = [&](const Part& part)
  {
    const Missed& missed = is_open(k, part) ? part.integrals.missed_open : part.integrals.missed;
    return norm_scale(segment) * (missed.normal + missed.tangential) <=
           allowed * fem::fraction<dim - 1>(part.data.part);
  };
  for (int depth = 0; depth < deepest && parts.size() < max_pieces; ++depth)
  {
    const std::size_t n_before = parts.size();
    for (std::size_t i = 0; i < n_before; ++i)
    {
      if (is_enough(parts[i])) continue;
      const Part whole = parts[i];
      const auto pieces = halves(whole.data.part);
      std::array<Fields, n_halves> fields;
      for (std::size_t j = 0; j < n_halves; ++j) fields[j] = on_half(whole.fields, j);
      std::array<Integrals, n_halves> values;
      integrate(k, fields, pieces, values);
      for (std::size_t j = 0; j < n_halves; ++j)
      {
        const Part half{
            {pieces[j], whole.data.gap, whole.data.strength, whole.data.water}, fields[j], values[j]};
        if (j == 0)
          parts[i] = half;
        else
          parts.push_back(half);
      }
    }
    if (parts.size() == n_before) break;
  }
}

template void ContactTerms<2>::add_varying_traction(int, std::span<const Point<2>>, double&, double&) const;
template void ContactTerms<2>::add_missed(int, const Piece&, std::span<const Point<2>>,
                                          std::span<const Point<2>>, std::span<const double>,
                                          Integrals&) const;
template void ContactTerms<2>::resolve_normal(int, std::vector<Part>&) const;
template void ContactTerms<3>::add_varying_traction(int, std::span<const Point<3>>, double&, double&) const;
template void ContactTerms<3>::add_missed(int, const Piece&, std::span<const Point<3>>,
                                          std::span<const Point<3>>, std::span<const double>,
                                          Integrals&) const;
template void ContactTerms<3>::resolve_normal(int, std::vector<Part>&) const;

}  // namespace tribound::certify
