#include "certify/contact_terms.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "contact/traction.h"
#include "fem/polynomials.h"

namespace tribound
{

namespace
{

/// A kinked facet has settled when halving its pieces changes the squared components by less than this part
/// of them. A kink is a point in 2D, where many halvings cost little, and a curve in 3D.
template <int dim>
constexpr double settled = dim == 2 ? 1e-10 : 1e-6;
template <int dim>
constexpr int max_depth = dim == 2 ? 40 : 10;
/// So deep kinks are looked for that no point has seen. Lebesgue's constant is so pessimistic on triangles
/// that every piece near P = 0 might have one.
template <int dim>
constexpr int search_depth = dim == 2 ? max_depth<dim> : 2;

/// The parts of a segment or triangle halved along each edge.
std::array<std::array<Point<1>, 2>, 2> halves(const std::array<Point<1>, 2>& s)
{
  const Point<1> middle = (s[0] + s[1]) / 2;
  return {{{s[0], middle}, {middle, s[1]}}};
}
std::array<std::array<Point<2>, 3>, 4> halves(const std::array<Point<2>, 3>& s)
{
  const Point<2> a = (s[1] + s[2]) / 2;
  const Point<2> b = (s[0] + s[2]) / 2;
  const Point<2> c = (s[0] + s[1]) / 2;
  return {{{s[0], c, b}, {c, s[1], a}, {b, a, s[2]}, {a, b, c}}};
}

/// The range of a function over the points it was seen at, and whether it may change sign near them. Of a
/// polynomial with the given Lebesgue constant Lambda: it keeps within Lambda times half the range of the
/// middle of the range.
class Range
{
 public:
  explicit Range(double lebesgue) : margin_((lebesgue - 1) / 2) {}
  void add(double value)
  {
    lower_ = std::min(lower_, value);
    upper_ = std::max(upper_, value);
  }
  [[nodiscard]] bool may_change_sign() const { return lowest() <= 0 && highest() >= 0; }
  /// With a margin for what lies between the points.
  [[nodiscard]] double lowest() const { return lower_ - margin_ * (upper_ - lower_); }
  /// The square of the values of the other sign that no point has seen.
  [[nodiscard]] double hidden() const
  {
    if (!may_change_sign() || (lower_ <= 0 && upper_ >= 0)) return 0;
    return std::pow(lower_ > 0 ? lowest() : highest(), 2);
  }
  [[nodiscard]] double highest() const { return upper_ + margin_ * (upper_ - lower_); }

 private:
  double margin_;
  double lower_ = std::numeric_limits<double>::infinity();
  double upper_ = -std::numeric_limits<double>::infinity();
};

/// h_F |F| / |Fhat|.
template <int dim>
double norm_scale(const ContactFacet<dim>& contact)
{
  return contact.geometry.diameter * contact.geometry.measure * (dim - 1);
}

/// Adds h_F ||t^n||_F^2 and h_F ||t^t||_F^2 of a traction with the given coefficients.
template <int dim>
void add_squares(std::span<const Point<dim>> traction, const ContactFacet<dim>& contact, double& normal_part,
                 double& tangential_part)
{
  const Point<dim>& n = contact.geometry.normal;
  for (const Point<dim>& coefficient : traction)
  {
    const double normal = coefficient.dot(n);
    normal_part += norm_scale(contact) * normal * normal;
    tangential_part += norm_scale(contact) * (coefficient - normal * n).squaredNorm();
  }
}

}  // namespace

// With theta orthonormal, q(x) = sum_i w_i (sum_j theta_j(x) theta_j(x_i)) q(x_i), because the rule is exact
// for q theta_j. The sum of the absolute values of the weights of the q(x_i) is the largest at a vertex of
// the simplex: for Gauss's points at both ends (Szegoe), for those in collapsed coordinates at the vertex
// into which an edge collapses (found on a lattice, see the test).
template <int k>
double lebesgue_constant(const Quadrature<k>& rule, int degree)
{
  const int n = polynomial_dimension(k, degree);
  std::vector<double> at_vertex(n);
  std::vector<double> at_point(n);
  double largest = 0;
  for (const Point<k>& vertex : reference_simplex<k>())
  {
    orthonormal_values<k>(degree, vertex, at_vertex);
    double sum = 0;
    for (int q = 0; q < rule.size(); ++q)
    {
      orthonormal_values<k>(degree, rule.points[q], at_point);
      sum += std::abs(rule.weights[q] *
                      std::inner_product(at_vertex.begin(), at_vertex.end(), at_point.begin(), 0.0));
    }
    largest = std::max(largest, sum);
  }
  return largest;
}

template <int dim>
ContactTerms<dim>::ContactTerms(const NitscheForm<dim>& form, ContactRule rule)
    : form_(form),
      rule_(rule),
      space_table_(tabulate_on_facets<dim>(form.space().basis(), form.facet_rule().points)),
      n_(polynomial_dimension(dim - 1, form.space().degree())),
      lebesgue_(lebesgue_constant<dim - 1>(form.facet_rule(), form.space().degree() + 2))
{
  const Quadrature<dim - 1>& points = form.facet_rule();
  for (int local = 0; local <= dim; ++local)
  {
    std::vector<Point<dim>> in_cell;
    for (const FacetPoint& s : points.points) in_cell.push_back(facet_to_cell<dim>(local, s));
    stress_table_.emplace_back(form.space().degree(), in_cell);
  }
  theta_.resize(static_cast<std::size_t>(n_) * points.size());
  for (int q = 0; q < points.size(); ++q)
    orthonormal_values<dim - 1>(form.space().degree(), points.points[q],
                                std::span(theta_).subspan(static_cast<std::size_t>(q) * n_, n_));
}

/// Coefficients of a polynomial of degree p on the facet from its values at the points of the rule.
template <int dim>
std::vector<Point<dim>> ContactTerms<dim>::project(std::span<const Point<dim>> values) const
{
  std::vector<Point<dim>> coefficients(n_, Point<dim>::Zero());
  for (std::size_t q = 0; q < values.size(); ++q)
    for (int i = 0; i < n_; ++i)
      coefficients[i] += form_.facet_rule().weights[q] * theta_[q * n_ + i] * values[q];
  return coefficients;
}

template <int dim>
std::vector<Point<dim>> ContactTerms<dim>::normal_trace(int k, std::span<const double> block) const
{
  const auto& [facet, geometry, gamma, contact, number] = form_.contact_facets()[k];
  const int n_points = form_.n_facet_points();
  std::vector<double> entries(static_cast<std::size_t>(dim) * dim * n_points);
  stress_table_[facet.local].evaluate(make_frame(form_.space().mesh(), facet.cell), block, entries);
  std::vector<Point<dim>> values(n_points, Point<dim>::Zero());
  for (int q = 0; q < n_points; ++q)
    for (int r = 0; r < dim; ++r)
      for (int c = 0; c < dim; ++c)
        values[q][r] += entries[(dim * r + c) * n_points + q] * geometry.normal[c];
  return project(values);
}

template <int dim>
auto ContactTerms<dim>::fields(int k, std::span<const double> u, const Stress<dim>& stress) const -> Fields
{
  const auto& [facet, geometry, gamma, contact, number] = form_.contact_facets()[k];
  const Point<dim>& n = geometry.normal;
  const LagrangeSpace<dim>& space = form_.space();
  const Material& material = form_.problem().material(space.mesh().region(facet.cell));
  const std::span<const Index> nodes = space.cell_nodes(facet.cell);
  const Tabulation<dim>& table = space_table_.on_facet[facet.local];
  const Tensor<dim> inverse_transpose = cell_map(space.mesh(), facet.cell).inverse_transpose;
  const int n_points = form_.n_facet_points();

  std::vector<Point<dim>> values(n_points);
  for (int q = 0; q < n_points; ++q)
    values[q] = augmented_traction<dim>(material, gamma, 0, n, value_at<dim>(nodes, u, table.values_at(q)),
                                        gradient_at<dim>(nodes, u, table.gradients_at(q), inverse_transpose));
  return {project(values), normal_trace(k, stress.dis_in(facet.cell))};
}

template <int dim>
auto ContactTerms<dim>::integrate(int k, const Fields& fields, const Piece& piece) const -> Integrals
{
  const auto& [facet, geometry, gamma, contact, number] = form_.contact_facets()[k];
  const Point<dim>& n = geometry.normal;
  const FacetMap<dim> map = facet_map(form_.space().mesh(), facet.cell, facet.local);
  const Quadrature<dim - 1>& rule = form_.facet_rule();
  std::array<double, polynomial_dimension(dim - 1, 4)> theta;
  Integrals result;
  Range normal_range(lebesgue_);
  Range tangential_range(lebesgue_);
  for (int q = 0; q < rule.size(); ++q)
  {
    const FacetPoint s = point_in<dim - 1>(piece, rule.points[q]);
    orthonormal_values<dim - 1>(form_.space().degree(), s, std::span(theta).first(n_));
    const Point<dim> x = map(s);
    Point<dim> p = gamma * gap_at<dim>(*contact, x) * n;
    Point<dim> dis = Point<dim>::Zero();
    for (int i = 0; i < n_; ++i)
    {
      p += theta[i] * fields.augmented[i];
      dis += theta[i] * fields.dis[i];
    }
    const double threshold = threshold_if_any<dim>(contact->friction, x);
    const double p_n = p.dot(n);
    normal_range.add(p_n);
    tangential_range.add((p - p_n * n).norm() - friction_limit(contact->friction, threshold, p_n));

    const Point<dim> difference = contact_traction<dim>(contact->friction, threshold, p, n) - dis;
    const double normal = difference.dot(n);
    const double weight = fraction<dim - 1>(piece) * rule.weights[q];
    result.normal += weight * normal * normal;
    result.tangential += weight * (difference - normal * n).squaredNorm();
  }
  const bool frictionless = std::holds_alternative<Frictionless>(contact->friction);
  result.lowest = normal_range.lowest();
  result.hidden =
      fraction<dim - 1>(piece) * (normal_range.hidden() + (frictionless ? 0 : tangential_range.hidden()));
  result.may_kink = normal_range.may_change_sign() || (!frictionless && tangential_range.may_change_sign());
  return result;
}

/// Halves the piece and those of its parts that may have a kink, until that changes nothing any more.
template <int dim>
auto ContactTerms<dim>::settle(int k, const Fields& fields, const Piece& piece, const Integrals& whole,
                               double tolerance, int depth) const -> Integrals
{
  const auto parts = halves(piece);
  std::array<Integrals, parts.size()> values;
  Integrals sum;
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    values[i] = integrate(k, fields, parts[i]);
    sum.normal += values[i].normal;
    sum.tangential += values[i].tangential;
    sum.hidden += values[i].hidden;
  }
  const double change = std::abs(sum.normal - whole.normal) + std::abs(sum.tangential - whole.tangential);
  const double hidden = depth < search_depth<dim> ? sum.hidden : 0;
  if (change + hidden <= tolerance || depth == max_depth<dim>) return sum;

  sum = {};
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    if (values[i].may_kink) values[i] = settle(k, fields, parts[i], values[i], tolerance, depth + 1);
    sum.normal += values[i].normal;
    sum.tangential += values[i].tangential;
  }
  return sum;
}

template <int dim>
ContactSquares ContactTerms<dim>::operator()(int k, std::span<const double> u,
                                             const Stress<dim>& stress) const
{
  const Fields on_facet = fields(k, u, stress);
  const ContactFacet<dim>& contact = form_.contact_facets()[k];
  ContactSquares result = linearisation(k, stress);
  const std::span<const ContactDatumPart<dim>> parts = form_.data().contact_parts(contact.number);
  const ContactDatumPart<dim> whole{reference_simplex<dim - 1>(), 0, 0};
  for (const auto& part : parts.empty() ? std::span(&whole, 1) : parts)
  {
    Integrals integrals = integrate(k, on_facet, part.part);
    const double lowest = integrals.lowest;
    if (rule_ == ContactRule::resolved && integrals.may_kink)
      integrals = settle(k, on_facet, part.part, integrals,
                         settled<dim> * (integrals.normal + integrals.tangential + integrals.hidden), 1);
    integrals.lowest = lowest;
    add_part(contact, part, integrals, result);
  }
  if (const auto reg = stress.reg_in(contact.facet.cell); !reg.empty())
    add_squares<dim>(normal_trace(k, reg), contact, result.reg2n, result.reg2t);
  return result;
}

/// T is Lipschitz continuous in g and s: [.]_- and the projections on balls do not expand, and neither does
/// [x]_a in a. Gap and threshold being polynomials up to their remainders, norms on the part K are those of
/// the rule and at most 2 |K|^{1/2} times what the remainders change.
template <int dim>
void ContactTerms<dim>::add_part(const ContactFacet<dim>& contact, const ContactDatumPart<dim>& part,
                                 const Integrals& integrals, ContactSquares& squares) const
{
  const double scale = norm_scale(contact);
  const double missed =
      2 * std::sqrt(contact.geometry.diameter * contact.geometry.measure * fraction<dim - 1>(part.part));
  // Where the contact is open whatever the gap is between the points, the gap does not matter. P^n is a
  // polynomial up to gamma delta, with which it was seen at the points, too.
  const bool open = integrals.lowest > (1 + lebesgue_) * contact.gamma * part.gap;
  const double pressure = open ? 0 : contact.gamma * part.gap;
  const auto* coulomb = std::get_if<Coulomb>(&contact.contact->friction);
  const double limit = coulomb ? coulomb->coefficient * pressure : part.threshold;
  squares.cnt += std::pow(std::sqrt(scale * integrals.normal) + missed * pressure, 2);
  squares.frc += std::pow(std::sqrt(scale * integrals.tangential) + missed * limit, 2);
}

template <int dim>
ContactSquares ContactTerms<dim>::linearisation(int k, const Stress<dim>& stress) const
{
  const ContactFacet<dim>& contact = form_.contact_facets()[k];
  ContactSquares result;
  add_squares<dim>(normal_trace(k, stress.lin_in(contact.facet.cell)), contact, result.lin2n, result.lin2t);
  return result;
}

template double lebesgue_constant(const Quadrature<1>&, int);
template double lebesgue_constant(const Quadrature<2>&, int);
template class ContactTerms<2>;
template class ContactTerms<3>;

}  // namespace tribound
