#include "tribound/certify/bound/contact_terms.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tribound/certify/bound/contact_pieces.h"
#include "tribound/certify/bound/zero_traction.h"
#include "tribound/fem/degree.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/polynomials.h"

namespace tribound::certify
{

namespace
{

/// A facet with kinks has settled when halving its pieces changes the squared components by less than this
/// fraction. A kink is a point in 2D, where many halvings are cheap, and a curve in 3D.
template <int dim>
constexpr double settled = dim == 2 ? 1e-10 : 1e-5;
template <int dim>
constexpr int max_depth = dim == 2 ? 40 : 10;
/// Whether the rule may be inexact for T(u), if P(u) is a polynomial.
template <int dim>
bool is_rough(const Kinks& kinks)
{
  return kinks.possible || (dim == 3 && kinks.slips);
}

/// Adds h_k ||t^n||_k^2 and h_k ||t^t||_k^2 of a traction with the given coefficients.
template <int dim>
void add_squares(std::span<const Point<dim>> traction, const contact::ContactSegment<dim>& segment,
                 double& normal_part, double& tangential_part)
{
  const Point<dim>& n = segment.normal;
  for (const Point<dim>& coefficient : traction)
  {
    const double normal = coefficient.dot(n);
    normal_part += norm_scale(segment) * normal * normal;
    tangential_part += norm_scale(segment) * (coefficient - normal * n).squaredNorm();
  }
}

}  // namespace

template <int dim>
ContactTerms<dim>::ContactTerms(const contact::NitscheForm<dim>& form, ContactRule rule)
    : form_(form),
      rule_(rule),
      degree_(form.space().degree() + (form.problem().is_axisymmetric() ? 1 : 0)),
      n_(fem::polynomial_dimension(dim - 1, degree_)),
      kinks_(form.facet_rule(), degree_ + 2)
{
  fem::require_degree(form.space().degree());
  const fem::Quadrature<dim - 1>& points = form.facet_rule();
  theta_.resize(static_cast<std::size_t>(n_) * points.size());
  for (int q = 0; q < points.size(); ++q)
    fem::orthonormal_values<dim - 1>(degree_, points.points[q],
                                     std::span(theta_).subspan(static_cast<std::size_t>(q) * n_, n_));
  for (const Piece& half : halves(fem::reference_simplex<dim - 1>()))
  {
    const std::vector<double> of_half = coefficients_on(half);
    to_half_.insert(to_half_.end(), of_half.begin(), of_half.end());
  }
}

/// (theta_i o map, theta_j) for the map of the reference simplex onto the part, [i * n + j]: exact.
template <int dim>
std::vector<double> ContactTerms<dim>::coefficients_on(const Piece& part) const
{
  const fem::Quadrature<dim - 1>& rule = form_.facet_rule();
  std::vector<double> result(static_cast<std::size_t>(n_) * n_, 0.0);
  std::array<double, max_n> theta;
  for (int q = 0; q < rule.size(); ++q)
  {
    const FacetPoint s = fem::point_in<dim - 1>(part, rule.points[q]);
    fem::orthonormal_values<dim - 1>(degree_, s, std::span(theta).first(n_));
    for (int i = 0; i < n_; ++i)
      for (int j = 0; j < n_; ++j) result[i * n_ + j] += rule.weights[q] * theta[i] * theta_[q * n_ + j];
  }
  return result;
}

template <int dim>
auto ContactTerms<dim>::changed(const Fields& fields, std::span<const double> coefficients) const -> Fields
{
  Fields result{};
  for (int j = 0; j < n_; ++j)
    for (int i = 0; i < n_; ++i) add_multiple(result[j], coefficients[i * n_ + j], fields[i]);
  return result;
}

template <int dim>
std::vector<Point<dim>> ContactTerms<dim>::coefficients_of(std::span<const Point<dim>> values) const
{
  std::vector<Point<dim>> coefficients(n_, Point<dim>::Zero());
  for (std::size_t q = 0; q < values.size(); ++q)
    for (int i = 0; i < n_; ++i)
      coefficients[i] += form_.facet_rule().weights[q] * theta_[q * n_ + i] * values[q];
  return coefficients;
}

template <int dim>
std::vector<Point<dim>> ContactTerms<dim>::project(int k, std::span<const Point<dim>> t) const
{
  return form_.problem().is_axisymmetric() ? weighted_projection(k, t) : coefficients_of(t);
}

template <int dim>
std::vector<Point<dim>> ContactTerms<dim>::project_plainly(std::span<const Point<dim>> t) const
{
  std::vector<Point<dim>> coefficients = coefficients_of(t);
  coefficients.resize(fem::polynomial_dimension(dim - 1, form_.space().degree()));
  return coefficients;
}

template <int dim>
auto ContactTerms<dim>::fields(int k, std::span<const double> u, const Tractions& t) const -> Fields
{
  const auto without_gap = form_.traction_without_gap(u, k);
  std::vector<Point<dim>> augmented(form_.n_segment_points());
  const auto initial = form_.initial_tractions().at_points(k);
  const bool scaled = is_scaled(k);
  for (int q = 0; q < form_.n_segment_points(); ++q)
    augmented[q] = scale(scaled, form_.contact_points(k)[q].x) * (without_gap.col(q) + initial.col(q));
  const std::vector<Point<dim>> of_augmented = coefficients_of(augmented);
  const std::vector<Point<dim>> of_dis = project(k, on_segment(t.dis, k));
  Fields result{};
  for (int i = 0; i < n_; ++i)
    for (int a = 0; a < dim; ++a)
    {
      result[i][a] = of_augmented[i][a];
      result[i][second + a] = of_dis[i][a];
    }
  return result;
}

/// Halves a piece of the part with the given number.
template <int dim>
auto ContactTerms<dim>::halve(int k, const Fields& fields, std::size_t part, const Piece& piece,
                              const Integrals& whole) const -> Halved
{
  Halved result{part, halves(piece), {}, std::vector<Integrals>(n_halves), 0};
  result.fields.reserve(n_halves);
  Integrals sum;
  for (std::size_t i = 0; i < result.pieces.size(); ++i) result.fields.push_back(on_half(fields, i));
  integrate(k, result.fields, result.pieces, result.values, whole.of_normal);
  for (std::size_t i = 0; i < result.pieces.size(); ++i)
  {
    sum += result.values[i];
    result.change += fem::fraction<dim - 1>(result.pieces[i]) * result.values[i].kinks.hidden;
  }
  result.change += std::abs(sum.normal - whole.normal) + std::abs(sum.tangential - whole.tangential);
  return result;
}

/// Halves the parts on which T is rough, and the rough ones of the halves again, until the change is
/// negligible. If it does not become so, the last change is added.
template <int dim>
void ContactTerms<dim>::settle(int k, std::span<Part> parts) const
{
  double rounding = 0;  // where T is in fact a polynomial, the remainder never settles
  for (const Part& part : parts)
    rounding = std::max(rounding,
                        largest_on(k, part.data.part).weight * std::pow(1e3 * part.integrals.round_off, 2));
  // A bond is not enclosed between the points: its parts are halved at least twice.
  const int least_depth = cone(form_.segments()[k].contact->law).is_bonded ? 2 : 1;
  std::vector<Halved> active;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (Integrals& whole = parts[i].integrals; is_rough<dim>(whole.kinks))
    {
      active.push_back(halve(k, parts[i].fields, i, parts[i].data.part, whole));
      whole = {.kinks = whole.kinks, .deviation = whole.deviation, .of_normal = whole.of_normal};
    }
  for (int depth = 1; !active.empty(); ++depth)
  {
    Integrals total;
    double change = 0;
    for (const Part& part : parts) total += part.integrals;
    for (const Halved& halved : active)
    {
      change += halved.change;
      for (const Integrals& value : halved.values) total += value;
    }
    const double negligible = std::max(rounding, settled<dim> * (total.normal + total.tangential));
    const bool done = change <= negligible && depth >= least_depth;
    const bool last = done || depth == max_depth<dim> || active.size() > max_pieces + parts.size();
    std::vector<Halved> next;
    for (const Halved& halved : active)
    {
      Integrals& sum = parts[halved.part].integrals;
      const bool enough =
          last || (depth >= least_depth && halved.change * static_cast<double>(active.size()) <= negligible);
      for (std::size_t i = 0; i < halved.pieces.size(); ++i)
        if (enough || !is_rough<dim>(halved.values[i].kinks))
          sum += halved.values[i];
        else
          next.push_back(halve(k, halved.fields[i], halved.part, halved.pieces[i], halved.values[i]));
      if (last && !done) sum += {.normal = halved.change, .tangential = halved.change};
    }
    active = std::move(next);
  }
}

template <int dim>
ContactSquares ContactTerms<dim>::operator()(int k, std::span<const double> u, const Tractions& t) const
{
  const contact::ContactSegment<dim>& segment = form_.segments()[k];
  ContactSquares result = linearisation(k, t);
  if (!t.reg.empty()) add_traction(k, on_segment(t.reg, k), result.reg2n, result.reg2t);
  if (problem::cone(segment.contact->law).is_tied && !form_.problem().is_axisymmetric())
    return with_initial_deviation(k, result);  // T = P is its own projection
  const Fields on_k = fields(k, u, t);
  const bool vanishes =
      std::ranges::all_of(on_k, [](const Pair& pair)
                          { return std::ranges::all_of(pair.entries, [](double x) { return x == 0; }); });
  if (vanishes && has_no_traction_at_rest(form_, k)) return with_initial_deviation(k, result);
  std::vector<Part> parts;
  if (form_.data().contact_parts(k).empty())
    parts.push_back({{fem::reference_simplex<dim - 1>(), 0, 0, 0}, on_k, {}});
  for (const contact::ContactDatumPart<dim>& data : form_.data().contact_parts(k))
    parts.push_back({data, changed(on_k, coefficients_on(data.part)), {}});
  if (rule_ == ContactRule::resolved && is_scaled(k)) resolve_radius(k, parts);
  for (Part& part : parts) integrate(k, {&part.fields, 1}, {&part.data.part, 1}, {&part.integrals, 1});
  if (segment.varying_normal != nullptr) resolve_normal(k, parts);
  if (rule_ == ContactRule::resolved) settle(k, parts);
  for (const Part& part : parts) add_part(k, part, result);
  return with_initial_deviation(k, result);
}

/// T is Lipschitz continuous in P: normal part with constant 1, tangential part with 1, and the coefficient
/// of friction times the change of the normal part.
template <int dim>
ContactSquares ContactTerms<dim>::with_initial_deviation(int k, ContactSquares squares) const
{
  const double deviation = form_.initial_tractions().deviation(k);
  if (deviation == 0) return squares;
  const contact::ContactSegment<dim>& segment = form_.segments()[k];
  const double missed =
      std::sqrt(segment.h * segment.measure * largest_on(k, fem::reference_simplex<dim - 1>()).weight) *
      deviation;
  squares.cnt = std::pow(std::sqrt(squares.cnt) + missed, 2);
  squares.frc =
      std::pow(std::sqrt(squares.frc) + (1 + problem::cone(segment.contact->law).coefficient) * missed, 2);
  return squares;
}

/// Where the contact is open for any gap and water pressure between the points, the gap does not matter. P^n
/// + p_w is a polynomial up to gamma delta, the remainder of p_w and the deviation of N; its values at the
/// points contain these, too.
template <int dim>
bool ContactTerms<dim>::is_open(int k, const Part& part) const
{
  const double missed = form_.segments()[k].gamma * part.data.gap + part.data.water;
  return part.integrals.kinks.lowest >
         (1 + kinks_.amplification()) *
             (largest_on(k, part.data.part).scale * missed + part.integrals.deviation);
}

/// T is Lipschitz continuous in g, s and p_w: [.]_- and the projections on balls do not expand, neither does
/// [x]_a in a, and [P^n + p_w]_- - p_w changes by at most the change of p_w, also where it is open. These
/// data are polynomials up to their remainders, so norms on the part K exceed those of the rule by at most 3
/// |K|^{1/2} times the change that the remainders cause.
template <int dim>
void ContactTerms<dim>::add_part(int k, const Part& part, ContactSquares& squares) const
{
  const contact::ContactSegment<dim>& segment = form_.segments()[k];
  const auto& [data, fields, integrals] = part;
  const Largest largest = largest_on(k, data.part);
  const double scale = norm_scale(segment) * (rule_ == ContactRule::resolved ? 1 + largest.missed : 1);
  const double missed =
      misses * std::sqrt(segment.h * segment.measure * fem::fraction<dim - 1>(data.part) * largest.weight);
  const bool open = is_open(k, part);
  const Missed& of_normal = open ? integrals.missed_open : integrals.missed;
  const double closing = open ? 0 : segment.gamma * data.gap;
  const double pressure = closing + data.water;
  const double limit = cone(segment.contact->law).closed_limit(data.strength, open ? 0 : -pressure);
  squares.cnt += std::pow(
      std::sqrt(scale * integrals.normal) + std::sqrt(scale * of_normal.normal) + missed * pressure, 2);
  squares.frc += std::pow(
      std::sqrt(scale * integrals.tangential) + std::sqrt(scale * of_normal.tangential) + missed * limit, 2);
}

template <int dim>
ContactSquares ContactTerms<dim>::linearisation(int k, const Tractions& t) const
{
  ContactSquares result;
  add_traction(k, on_segment(t.lin, k), result.lin2n, result.lin2t);
  return result;
}

template <int dim>
void ContactTerms<dim>::add_traction(int k, std::span<const Point<dim>> t, double& normal,
                                     double& tangential) const
{
  const contact::ContactSegment<dim>& segment = form_.segments()[k];
  if (segment.varying_normal == nullptr && !form_.problem().is_axisymmetric())
    add_squares<dim>(project(k, t), segment, normal, tangential);
  else
    add_varying_traction(k, project(k, t), normal, tangential);
}

template class ContactTerms<2>;
template class ContactTerms<3>;

}  // namespace tribound::certify
