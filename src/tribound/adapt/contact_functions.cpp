#include "tribound/adapt/contact_functions.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "tribound/contact/nitsche/form_history.h"
#include "tribound/contact/nitsche/simplex_map.h"
#include "tribound/fem/degree.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/simplex_parts.h"

namespace tribound::adapt
{

namespace
{

/// How far points of a child may appear to lie outside its parent, in barycentric coordinates. Corners of the
/// segments between bodies are rounded to 1e-12.
constexpr double rounding_outside = 1e-7;

/// Number of values that describe a Piece: its boundary, normal, origin and edges.
template <int dim>
constexpr std::size_t n_place = 1 + dim*(dim + 1);

template <int dim>
using Theta = std::array<double, fem::polynomial_dimension(dim - 1, fem::max_degree + 2)>;

/// Values of the basis of P^degree at s.
template <int dim>
std::span<const double> basis_at(int degree, const Point<dim - 1>& s, Theta<dim>& theta)
{
  const auto values = std::span(theta).first(fem::polynomial_dimension(dim - 1, degree));
  fem::orthonormal_values<dim - 1>(degree, s, values);
  return values;
}

/// The coordinates of the point in the plane of the piece that is nearest to x.
template <int dim>
Point<dim - 1> coordinates(const Eigen::Matrix<double, dim, dim - 1>& jacobian, const Point<dim>& from_origin)
{
  return (jacobian.transpose() * jacobian).inverse() * (jacobian.transpose() * from_origin);
}

}  // namespace

template <int dim>
ContactFunctions<dim>::ContactFunctions(const contact::NitscheForm<dim>& form, std::span<const double> values,
                                        std::size_t n)
    : n_(n), degree_(form.space().degree() + 2), tree_({})
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const fem::Quadrature<dim - 1>& rule = form.facet_rule();
  const std::size_t n_points = rule.size();
  const std::size_t n_basis = fem::polynomial_dimension(dim - 1, degree_);
  coefficients_.assign(form.n_owned_segments() * n_basis * n, 0.0);
  std::vector<double> places;
  Theta<dim> storage;
  for (std::size_t k = 0; k < form.n_owned_segments(); ++k)
  {
    const contact::SegmentSide<dim>& slave = form.segments()[k].slave;
    const contact::SimplexMap<dim - 1, dim> map = contact::simplex_map(mesh, slave);
    const Point<dim> normal = mesh::facet_geometry(mesh, slave.facet.cell, slave.facet.local).normal;
    places.push_back(slave.facet.tag);
    places.insert(places.end(), normal.begin(), normal.end());
    places.insert(places.end(), map.origin.begin(), map.origin.end());
    places.insert(places.end(), map.jacobian.data(), map.jacobian.data() + map.jacobian.size());
    for (std::size_t q = 0; q < n_points; ++q)
    {
      const std::span<const double> theta = basis_at<dim>(degree_, rule.points[q], storage);
      const std::span<const double> at_point = values.subspan((k * n_points + q) * n, n);
      for (std::size_t j = 0; j < n_basis; ++j)
        for (std::size_t i = 0; i < n; ++i)
          coefficients_[(k * n_basis + j) * n + i] += rule.weights[q] * theta[j] * at_point[i];
    }
  }
  const Ranks& ranks = mesh.ranks();
  for (std::vector<double>* numbers : {&places, &coefficients_})
  {
    *numbers = ranks.gather<double>(*numbers);
    ranks.copy_from_first(*numbers);
  }
  set_pieces(places);
}

template <int dim>
void ContactFunctions<dim>::set_pieces(std::span<const double> places)
{
  std::vector<mesh::BoundingBox<dim>> boxes;
  for (std::size_t i = 0; i < places.size(); i += n_place<dim>)
  {
    const Piece& piece = pieces_.emplace_back(
        Piece{static_cast<int>(places[i]), Point<dim>(&places[i + 1]), Point<dim>(&places[i + 1 + dim]),
              Eigen::Matrix<double, dim, dim - 1>(&places[i + 1 + 2 * dim])});
    mesh::BoundingBox<dim>& box = boxes.emplace_back();
    for (const Point<dim - 1>& corner : fem::reference_simplex<dim - 1>())
      box.add(piece.origin + piece.jacobian * corner);
    const Point<dim> margin = Point<dim>::Constant(rounding_outside * box.diagonal());
    box.lower -= margin;
    box.upper += margin;
  }
  tree_ = mesh::BoxTree<dim>(boxes);
}

template <int dim>
std::size_t ContactFunctions<dim>::piece_of(const contact::NitscheForm<dim>& form, std::size_t k) const
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const contact::SegmentSide<dim>& slave = form.segments()[k].slave;
  const Point<dim> normal = mesh::facet_geometry(mesh, slave.facet.cell, slave.facet.local).normal;
  const Point<dim> centre = contact::simplex_map(mesh, slave)(Point<dim - 1>::Constant(1.0 / dim));
  std::size_t found = pieces_.size();
  double deepest = -rounding_outside;
  const auto visit = [&](std::size_t i)
  {
    const Piece& piece = pieces_[i];
    // The two sides of a slit may have the same name: they face each other.
    if (piece.tag != slave.facet.tag || piece.normal.dot(normal) < 1 - rounding_outside) return;
    const Point<dim - 1> s = coordinates<dim>(piece.jacobian, centre - piece.origin);
    const double off_plane = std::abs(piece.normal.dot(centre - piece.origin));
    if (off_plane > rounding_outside * piece.jacobian.norm()) return;
    const double depth = std::min(s.minCoeff(), 1 - s.sum());
    if (depth < deepest) return;
    deepest = depth;
    found = i;
  };
  tree_.traverse([&](const mesh::BoundingBox<dim>& box) { return mesh::square_distance(box, centre) == 0; },
                 visit);
  return found;
}

template <int dim>
void ContactFunctions<dim>::evaluate(const contact::NitscheForm<dim>& form, std::size_t k, std::size_t piece,
                                     std::span<double> values) const
{
  const std::size_t n_basis = fem::polynomial_dimension(dim - 1, degree_);
  const auto points = form.contact_points(k);
  Theta<dim> storage;
  for (std::size_t q = 0; q < points.size(); ++q)
  {
    const Point<dim - 1> s = coordinates<dim>(pieces_[piece].jacobian, points[q].x - pieces_[piece].origin);
    const std::span<const double> theta = basis_at<dim>(degree_, s, storage);
    for (std::size_t j = 0; j < n_basis; ++j)
      for (std::size_t i = 0; i < n_; ++i)
        values[q * n_ + i] += theta[j] * coefficients_[(piece * n_basis + j) * n_ + i];
  }
}

template <int dim>
std::vector<double> ContactFunctions<dim>::at_points_of(const contact::NitscheForm<dim>& form,
                                                        const Fresh& fresh) const
{
  assert(form.space().degree() + 2 == degree_);
  const std::size_t n_each = n_ * form.n_segment_points();
  std::vector<double> values(n_each * form.segments().size(), 0.0);
  for (std::size_t k = 0; k < form.segments().size(); ++k)
  {
    const std::span<double> of_segment = std::span(values).subspan(k * n_each, n_each);
    const std::size_t piece = piece_of(form, k);
    if (piece < pieces_.size())
      evaluate(form, k, piece, of_segment);
    else if (fresh)
      fresh(form.segments()[k], of_segment);
  }
  return values;
}

template <int dim>
std::shared_ptr<const contact::ContactHistory<dim>> carried_history(
    const contact::ContactHistory<dim>& history, const contact::NitscheForm<dim>& from,
    const contact::NitscheForm<dim>& to)
{
  constexpr std::size_t n = dim + 2;
  const auto append = [](const problem::InterfaceState<dim>& state, auto place)
  {
    *place++ = state.damage;
    *place++ = state.slipped;
    return std::ranges::copy(state.slip, place).out;
  };
  std::vector<double> values(n * from.n_owned_contact_points());
  auto place = values.begin();
  for (std::size_t k = 0; k < from.n_owned_segments(); ++k)
    for (const Point<dim - 1>& s : from.facet_rule().points) place = append(history.uncut(k, s), place);
  const auto fresh = [&](const contact::ContactSegment<dim>& segment, std::span<double> at_points)
  {
    auto at = at_points.begin();
    while (at != at_points.end()) at = append(problem::fresh_state<dim>(segment.contact->law), at);
  };
  const std::vector<double> carried = ContactFunctions<dim>(from, values, n).at_points_of(to, fresh);

  std::vector<problem::InterfaceState<dim>> states;
  states.reserve(to.n_contact_points());
  for (std::size_t i = 0; i < carried.size(); i += n)
    states.push_back({carried[i], carried[i + 1], Point<dim>(&carried[i + 2])});
  return contact::history_from_values<dim>(to, std::move(states));
}

template <int dim>
std::vector<Point<dim>> carried_vectors(std::span<const Point<dim>> vectors,
                                        const contact::NitscheForm<dim>& from,
                                        const contact::NitscheForm<dim>& to)
{
  std::vector<double> values;
  values.reserve(dim * from.n_owned_contact_points());
  for (const Point<dim>& v : vectors.first(from.n_owned_contact_points()))
    values.insert(values.end(), v.begin(), v.end());
  const std::vector<double> carried = ContactFunctions<dim>(from, values, dim).at_points_of(to);
  std::vector<Point<dim>> result;
  result.reserve(to.n_contact_points());
  for (std::size_t i = 0; i < carried.size(); i += dim) result.push_back(Point<dim>(&carried[i]));
  return result;
}

template class ContactFunctions<2>;
template class ContactFunctions<3>;
template std::shared_ptr<const contact::ContactHistory<2>> carried_history(const contact::ContactHistory<2>&,
                                                                           const contact::NitscheForm<2>&,
                                                                           const contact::NitscheForm<2>&);
template std::shared_ptr<const contact::ContactHistory<3>> carried_history(const contact::ContactHistory<3>&,
                                                                           const contact::NitscheForm<3>&,
                                                                           const contact::NitscheForm<3>&);
template std::vector<Point<2>> carried_vectors(std::span<const Point<2>>, const contact::NitscheForm<2>&,
                                               const contact::NitscheForm<2>&);
template std::vector<Point<3>> carried_vectors(std::span<const Point<3>>, const contact::NitscheForm<3>&,
                                               const contact::NitscheForm<3>&);

}  // namespace tribound::adapt
