#include "tribound/contact/nitsche/nitsche.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "tribound/base/error.h"
#include "tribound/base/parallel.h"
#include "tribound/contact/nitsche/meridian_cells.h"
#include "tribound/fem/evaluation.h"
#include "tribound/mesh/describe.h"
#include "tribound/mesh/geometry.h"

namespace tribound::contact
{

template <int dim>
NitscheForm<dim>::NitscheForm(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                              double gamma0, const DataAccuracy& accuracy)
    : NitscheForm(problem, space, gamma0, contact_segments(problem, space.mesh(), gamma0), accuracy)
{
}

template <int dim>
NitscheForm<dim>::NitscheForm(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                              double gamma0, std::vector<ContactSegment<dim>> segments,
                              const DataAccuracy& accuracy)
    : problem_(&problem),
      space_(&space),
      meridian_(meridian_cells(problem, space)),
      gamma0_(gamma0),
      constraints_(fem::dirichlet(problem, space)),
      segments_(std::move(segments)),
      data_(problem, space.mesh(), space.degree(), segments_, accuracy),
      springs_(problem, space),
      rigid_parts_(problem, space),
      load_(assemble_load(data_, space)),
      n_owned_segments_(std::ranges::count_if(segments_, [&space](const ContactSegment<dim>& segment)
                                              { return is_owned(space.mesh(), segment); })),
      points_(space.mesh().ranks().together([this] { return make_points(); })),
      tables_(space.basis(), segments_, facet_rule().points),
      nodes_(problem.is_axisymmetric() ? SegmentNodes<dim>(facet_rule().points)
                                       : SegmentNodes<dim>(space.degree(), facet_rule().points)),
      node_tables_(space.basis(), segments_, nodes_.nodes()),
      initial_tractions_(space.mesh().ranks().together(
          [this] { return InitialTractions<dim>(*problem_, *space_, segments_, facet_rule().points); }))
{
  add_initial_stress<dim>(data_, space, load_, meridian_);
  springs_.add_rest(load_);
  rigid_parts_.add_load(load_);
  look_for_bonds();
}

template <int dim>
void NitscheForm<dim>::prescribe(std::span<double> u) const
{
  keep_free(u);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] += constraints_.values[i];  // 0 elsewhere
}

template <int dim>
void NitscheForm<dim>::keep_free(std::span<double> vector) const
{
  const std::vector<double> motions = rigid_parts_.along(vector);
  for (std::size_t i = 0; i < vector.size(); ++i)
    if (constraints_.fixed[i]) vector[i] = 0;
  rigid_parts_.set(motions, vector);
}

template <int dim>
NitscheForm<dim> NitscheForm<dim>::with_gamma0(double gamma0) const
{
  NitscheForm other = *this;
  for (ContactSegment<dim>& segment : other.segments_) segment.gamma *= gamma0 / gamma0_;
  other.gamma0_ = gamma0;
  return other;
}

namespace
{

/// Throws where a slider's direction is nearly along the facet: it would hold what the facet cannot push.
template <int dim>
void check_direction(const mesh::Mesh<dim>& mesh, const ContactSegment<dim>& segment, const Point<dim>& x,
                     const Point<dim>& direction)
{
  constexpr double least = 0.3;
  if (!std::holds_alternative<problem::Slider>(segment.contact->law)) return;
  const mesh::BoundaryFacet& facet = segment.slave.facet;
  const double along = direction.dot(mesh::facet_geometry(mesh, facet.cell, facet.local).normal);
  if (along < least)
    throw InputError(
        segment.contact->normal ? segment.contact->normal->components().front().where() : Where{},
        fmt::format("the slider on \"{}\" acts at {} degrees from the normal of the facet at {}",
                    mesh.boundary_names()[facet.tag],
                    std::lround(180 / std::numbers::pi * std::acos(std::max(along, -1.0))),
                    mesh::describe(x)),
        "a normal out of the body, within 72 degrees of those of the facets");
}

}  // namespace

template <int dim>
std::vector<ContactPoint<dim>> NitscheForm<dim>::make_points() const
{
  std::vector<ContactPoint<dim>> points;
  points.reserve(segments_.size() * facet_rule().size());
  for (std::size_t k = 0; k < segments_.size(); ++k)
  {
    const ContactSegment<dim>& segment = segments_[k];
    const SimplexMap<dim - 1, dim> map = simplex_map(space_->mesh(), segment.slave);
    const problem::InterfaceState<dim> fresh = problem::fresh_state<dim>(segment.contact->law);
    for (int q = 0; q < facet_rule().size(); ++q)
    {
      const Point<dim> x = map(facet_rule().points[q]);
      const Point<dim> normal = segment.normal_at(x);
      check_direction<dim>(space_->mesh(), segment, x, normal);
      const auto [gap, strength, water] = data_.contact(segment, k, facet_rule().points[q]);
      points.push_back({x, segment.det() * facet_rule().weights[q] * problem_->weight(x), normal, gap,
                        strength, water, fresh});
    }
  }
  return points;
}

template <int dim>
void NitscheForm<dim>::look_for_bonds()
{
  bool found = false;
  for (std::size_t k = 0; k < n_owned_segments_ && !found; ++k)
    if (cone(segments_[k].contact->law).is_bonded)
      found =
          std::ranges::any_of(contact_points(k), [](const auto& point) { return point.state.damage < 1; });
  has_bonds_ = space_->mesh().ranks().any(found);
}

template <int dim>
void NitscheForm<dim>::set_history(std::shared_ptr<const ContactHistory<dim>> history)
{
  history_ = std::move(history);
  assert(history_ && history_->states().size() == points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) points_[i].state = history_->states()[i];
  look_for_bonds();
}

template <int dim>
std::vector<problem::LawPoint<dim>> NitscheForm<dim>::law_points(std::size_t k,
                                                                 std::span<const Point<dim - 1>> s,
                                                                 std::span<const Point<dim>> x,
                                                                 std::span<const Point<dim>> n) const
{
  const problem::ContactLaw& law = segments_[k].contact->law;
  const problem::LawPoint<dim> fresh{
      .normal = Point<dim>::Zero(), .gamma = segments_[k].gamma, .state = problem::fresh_state<dim>(law)};
  std::vector<problem::LawPoint<dim>> result(n.size(), fresh);
  for (std::size_t q = 0; q < n.size(); ++q)
  {
    problem::LawPoint<dim>& point = result[q];
    point.normal = n[q];
    point.strength = problem::strength_at<dim>(law, x[q]);
    point.water = problem::water_at<dim>(*segments_[k].contact, x[q]);
    if (history_) point.state = history_->at(law, k, s[q]);
    point.state.slip -= point.state.slip.dot(n[q]) * n[q];
  }
  return result;
}

template <int dim>
auto NitscheForm<dim>::traction_without_gap(std::span<const double> u, std::size_t k) const -> Columns
{
  const SegmentValues<dim> on_segment = at_nodes(k);
  Columns nodal(dim, nodes_.values().rows());
  for (int l = 0; l < nodal.cols(); ++l) nodal.col(l) = on_segment.augmented_traction(u, l);
  return nodal * nodes_.values();
}

template <int dim>
auto NitscheForm<dim>::augmented_traction(std::span<const double> u, std::size_t k) const -> Columns
{
  Columns result = traction_without_gap(u, k);
  if (!initial_tractions_.empty()) result += initial_tractions_.at_points(k);
  for (int q = 0; q < n_segment_points(); ++q)
  {
    const ContactPoint<dim>& point = contact_points(k)[q];
    result.col(q) += segments_[k].gamma * point.gap * point.normal;
  }
  return result;
}

template <int dim>
Point<dim> NitscheForm<dim>::respond(std::size_t k, int q, const Point<dim>& augmented, double delta) const
{
  return problem::respond<dim>(segments_[k].contact->law, law_point(k, q), augmented, delta).traction;
}

template <int dim>
bool NitscheForm<dim>::starts_open(std::size_t k, int q) const
{
  return has_bonds_ && !segments_[k].contact->is_bilateral() && contact_points(k)[q].state.damage >= 1;
}

template <int dim>
Tensor<dim> NitscheForm<dim>::traction_derivative(Linearisation kind, std::size_t k, int q,
                                                  const Point<dim>& augmented, double delta) const
{
  const problem::ContactLaw& law = segments_[k].contact->law;
  if (kind == Linearisation::newton) return problem::tangent<dim>(law, law_point(k, q), augmented, delta);
  if (starts_open(k, q)) return Tensor<dim>::Zero();
  const Point<dim>& n = contact_points(k)[q].normal;
  return cone(law).resists_sliding() ? Tensor<dim>::Identity() : Tensor<dim>(n * n.transpose());
}

template <int dim>
template <class Value, class Evaluate>
std::vector<Value> NitscheForm<dim>::at_contact_points(const Evaluate& evaluate) const
{
  std::vector<Value> result(n_contact_points());
  const std::size_t n = n_segment_points();
  parallel_for(segments_.size(), [&](std::size_t k) { evaluate(k, std::span(result).subspan(k * n, n)); });
  return result;
}

template <int dim>
std::vector<Point<dim>> NitscheForm<dim>::water_pressure() const
{
  std::vector<Point<dim>> pressure;
  pressure.reserve(points_.size());
  for (const ContactPoint<dim>& point : points_) pressure.push_back(point.water * point.normal);
  return pressure;
}

template <int dim>
std::vector<Point<dim>> NitscheForm<dim>::traction(std::span<const double> u, double delta) const
{
  return at_contact_points<Point<dim>>(
      [&](std::size_t k, std::span<Point<dim>> t)
      {
        const Columns at_u = augmented_traction(u, k);
        for (int q = 0; q < n_segment_points(); ++q) t[q] = respond(k, q, at_u.col(q), delta);
      });
}

template <int dim>
std::vector<Point<dim>> NitscheForm<dim>::linearised_traction(Linearisation kind, std::span<const double> u,
                                                              std::span<const double> w, double delta) const
{
  const auto closed_sticking = [&](std::size_t k, std::span<Point<dim>> t)
  {
    const Columns at_w = augmented_traction(w, k);
    for (int q = 0; q < n_segment_points(); ++q)
      if (const ContactPoint<dim>& point = contact_points(k)[q]; starts_open(k, q))
        t[q] = -point.water * point.normal;
      else
        t[q] = traction_derivative(kind, k, q, at_w.col(q), delta) * at_w.col(q);
  };
  const auto newton = [&](std::size_t k, std::span<Point<dim>> t)
  {
    const Columns at_w = augmented_traction(w, k);
    const Columns at_u = augmented_traction(u, k);
    for (int q = 0; q < n_segment_points(); ++q)
      t[q] = respond(k, q, at_u.col(q), delta) +
             traction_derivative(kind, k, q, at_u.col(q), delta) * (at_w.col(q) - at_u.col(q));
  };
  return kind == Linearisation::newton ? at_contact_points<Point<dim>>(newton)
                                       : at_contact_points<Point<dim>>(closed_sticking);
}

template <int dim>
std::vector<problem::InterfaceResponse<dim>> NitscheForm<dim>::advance(std::span<const double> u) const
{
  return at_contact_points<problem::InterfaceResponse<dim>>(
      [&](std::size_t k, std::span<problem::InterfaceResponse<dim>> responses)
      {
        const Columns at_u = augmented_traction(u, k);
        for (int q = 0; q < n_segment_points(); ++q)
          responses[q] =
              problem::advance<dim>(segments_[k].contact->law, law_point(k, q), Point<dim>(at_u.col(q)));
      });
}

template <int dim>
void NitscheForm<dim>::add_contact_load(std::span<const Point<dim>> t, std::span<double> vector) const
{
  assert(t.size() == n_contact_points());
  Columns weighted(dim, n_segment_points());
  for (std::size_t k = 0; k < segments_.size(); ++k)
  {
    for (int q = 0; q < n_segment_points(); ++q)
      weighted.col(q) = contact_points(k)[q].weight * t[k * n_segment_points() + q];
    const Columns nodal = weighted * nodes_.values().transpose();  // (t, theta_l)
    const SegmentValues<dim> on_segment = at_nodes(k);
    for (const auto& side : on_segment.sides())
      for (int l = 0; l < nodal.cols(); ++l)
        fem::add_at_point<dim>(side.nodes, side.table->values_at(l), side.side->sign * nodal.col(l), vector);
  }
}

template <int dim>
std::vector<ContactState<dim>> NitscheForm<dim>::contact_states(std::span<const double> u, std::size_t k,
                                                                const SegmentTable<dim>& table) const
{
  return contact_states(u, k, table, WhichData::discrete);
}

template <int dim>
std::vector<ContactState<dim>> NitscheForm<dim>::contact_states(std::span<const double> u, std::size_t k,
                                                                const SegmentTable<dim>& table,
                                                                WhichData which) const
{
  const ContactSegment<dim>& segment = segments_[k];
  const SimplexMap<dim - 1, dim> map = simplex_map(space_->mesh(), segment.slave);
  const SegmentValues<dim> on_segment(*problem_, *space_, segment, table);

  const bool is_own = table.slave == tables_[k].slave;  // the table is that of the contact points

  std::vector<Point<dim>> initial = initial_tractions_.at(k, table.points);
  if (which == WhichData::given && !initial_tractions_.empty())
    std::ranges::transform(table.points, initial.begin(),
                           [&](const Point<dim - 1>& s)
                           { return initial_traction(*problem_, space_->mesh(), segment, s); });
  std::vector<ContactState<dim>> states;
  states.reserve(table.points.size());
  for (int q = 0; q < static_cast<int>(table.points.size()); ++q)
  {
    const Point<dim> x = map(table.points[q]);
    const Point<dim> n = segment.normal_at(x);
    const Point<dim - 1>& s = table.points[q];
    problem::LawPoint<dim> point = is_own ? law_point(k, q) : law_points(k, {&s, 1}, {&x, 1}, {&n, 1})[0];
    double gap = is_own ? contact_points(k)[q].gap : segment.gap(s, x, n);
    if (!is_own && which == WhichData::discrete)
    {
      const ContactData seen = data_.contact(segment, k, s);
      gap = seen.gap;
      point.strength = seen.strength;
      point.water = seen.water;
    }
    const Point<dim> p = on_segment.augmented_traction(u, q) + initial[q] + segment.gamma * gap * n;
    const auto [traction, limit, status] = problem::respond<dim>(segment.contact->law, point, p);
    const Point<dim> jump = on_segment.jump(u, q);
    const Point<dim> displacement =
        fem::value_at<dim>(space_->cell_nodes(segment.slave.facet.cell), u, table.slave->values_at(q));
    const problem::InterfaceResponse<dim> committed = problem::advance<dim>(segment.contact->law, point, p);
    states.push_back({x, n, -traction.dot(n), traction, limit, status, gap - jump.dot(n),
                      jump - jump.dot(n) * n, displacement, committed.opening, point.water, committed.state});
  }
  return states;
}

template class NitscheForm<2>;
template class NitscheForm<3>;

}  // namespace tribound::contact
