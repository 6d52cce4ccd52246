#include "tribound/contact/nitsche/nitsche.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <optional>
#include <utility>

#include "tribound/base/parallel.h"
#include "tribound/fem/evaluation.h"

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
      gamma0_(gamma0),
      constraints_(fem::dirichlet(problem, space)),
      segments_(std::move(segments)),
      data_(problem, space.mesh(), space.degree(), segments_, accuracy),
      load_(assemble_load(data_, space)),
      n_owned_segments_(std::ranges::count_if(segments_, [&space](const ContactSegment<dim>& segment)
                                              { return is_owned(space.mesh(), segment); })),
      points_(make_points()),
      tables_(space.basis(), segments_, facet_rule().points)
{
  look_for_bonds();
}

template <int dim>
NitscheForm<dim> NitscheForm<dim>::with_gamma0(double gamma0) const
{
  NitscheForm other = *this;
  for (ContactSegment<dim>& segment : other.segments_) segment.gamma *= gamma0 / gamma0_;
  other.gamma0_ = gamma0;
  return other;
}

template <int dim>
std::vector<ContactPoint<dim>> NitscheForm<dim>::make_points() const
{
  std::vector<ContactPoint<dim>> points;
  points.reserve(segments_.size() * facet_rule().size());
  std::vector<double> gap(facet_rule().size());
  std::vector<double> strength(facet_rule().size());
  for (std::size_t k = 0; k < segments_.size(); ++k)
  {
    const ContactSegment<dim>& segment = segments_[k];
    const SimplexMap<dim - 1, dim> map = simplex_map(space_->mesh(), segment.slave);
    data_.contact(segment, k, gap, strength);
    const problem::InterfaceState<dim> fresh = problem::fresh_state<dim>(segment.contact->law);
    for (int q = 0; q < facet_rule().size(); ++q)
    {
      const Point<dim> x = map(facet_rule().points[q]);
      points.push_back(
          {x, segment.det() * facet_rule().weights[q], segment.normal_at(x), gap[q], strength[q], fresh});
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
problem::LawPoint<dim> NitscheForm<dim>::law_point(std::size_t k, const Point<dim - 1>& s,
                                                   const Point<dim>& x, const Point<dim>& n) const
{
  const problem::ContactLaw& law = segments_[k].contact->law;
  problem::LawPoint<dim> point{n, problem::strength_at<dim>(law, x), segments_[k].gamma,
                               history_ ? history_->at(law, k, s) : problem::fresh_state<dim>(law)};
  point.state.slip -= point.state.slip.dot(n) * n;
  return point;
}

template <int dim>
Point<dim> NitscheForm<dim>::augmented_traction(const SegmentValues<dim>& values, std::span<const double> u,
                                                std::size_t k, int q) const
{
  const ContactPoint<dim>& point = contact_points(k)[q];
  return values.augmented_traction(u, q) + segments_[k].gamma * point.gap * point.normal;
}

template <int dim>
Point<dim> NitscheForm<dim>::respond(std::size_t k, int q, const Point<dim>& augmented, double delta) const
{
  return problem::respond<dim>(segments_[k].contact->law, law_point(k, q), augmented, delta).traction;
}

template <int dim>
Tensor<dim> NitscheForm<dim>::traction_derivative(Linearisation kind, std::size_t k, int q,
                                                  const Point<dim>& augmented, double delta) const
{
  const problem::ContactLaw& law = segments_[k].contact->law;
  if (kind == Linearisation::newton) return problem::tangent<dim>(law, law_point(k, q), augmented, delta);
  const auto& [x, weight, n, gap, strength, state] = contact_points(k)[q];
  if (has_bonds_ && !cone(law).is_tied && state.damage >= 1) return Tensor<dim>::Zero();
  return cone(law).resists_sliding() ? Tensor<dim>::Identity() : Tensor<dim>(n * n.transpose());
}

template <int dim>
template <class Value, class Evaluate>
std::vector<Value> NitscheForm<dim>::at_contact_points(const Evaluate& evaluate) const
{
  std::vector<Value> result(n_contact_points());
  parallel_for(segments_.size(),
               [&](std::size_t k)
               {
                 const SegmentValues<dim> on_segment = values(k);
                 for (int q = 0; q < n_segment_points(); ++q)
                   result[k * n_segment_points() + q] = evaluate(on_segment, k, q);
               });
  return result;
}

template <int dim>
std::vector<Point<dim>> NitscheForm<dim>::traction(std::span<const double> u, double delta) const
{
  return at_contact_points<Point<dim>>(
      [&](const SegmentValues<dim>& on_segment, std::size_t k, int q) -> Point<dim>
      { return respond(k, q, augmented_traction(on_segment, u, k, q), delta); });
}

template <int dim>
std::vector<Point<dim>> NitscheForm<dim>::linearised_traction(Linearisation kind, std::span<const double> u,
                                                              std::span<const double> w, double delta) const
{
  return at_contact_points<Point<dim>>(
      [&](const SegmentValues<dim>& on_segment, std::size_t k, int q) -> Point<dim>
      {
        const Point<dim> at_w = augmented_traction(on_segment, w, k, q);
        if (kind == Linearisation::closed_sticking)
          return traction_derivative(kind, k, q, at_w, delta) * at_w;
        const Point<dim> at_u = augmented_traction(on_segment, u, k, q);
        return respond(k, q, at_u, delta) + traction_derivative(kind, k, q, at_u, delta) * (at_w - at_u);
      });
}

template <int dim>
std::vector<problem::InterfaceResponse<dim>> NitscheForm<dim>::advance(std::span<const double> u) const
{
  return at_contact_points<problem::InterfaceResponse<dim>>(
      [&](const SegmentValues<dim>& on_segment, std::size_t k, int q)
      {
        return problem::advance<dim>(segments_[k].contact->law, law_point(k, q),
                                     augmented_traction(on_segment, u, k, q));
      });
}

template <int dim>
void NitscheForm<dim>::add_contact_load(std::span<const Point<dim>> t, std::span<double> vector) const
{
  assert(t.size() == n_contact_points());
  for (std::size_t k = 0; k < segments_.size(); ++k)
  {
    const SegmentValues<dim> on_segment = values(k);
    for (const auto& side : on_segment.sides())
      for (int q = 0; q < n_segment_points(); ++q)
        fem::add_at_point<dim>(side.nodes, side.table->values_at(q),
                               side.side->sign * contact_points(k)[q].weight * t[k * n_segment_points() + q],
                               vector);
  }
}

template <int dim>
void NitscheForm<dim>::add_tangent_block(Linearisation kind, std::span<const double> u, std::size_t k,
                                         double delta, const SegmentValues<dim>& on_segment,
                                         std::span<Tensor<dim>> block) const
{
  const fem::LagrangeBasis<dim>& basis = space_->basis();
  std::vector<Tensor<dim>> columns(basis.n_nodes() * on_segment.sides().size());  // DT(u)[phi_j e_b]
  for (int q = 0; q < n_segment_points(); ++q)
  {
    const Tensor<dim> m = traction_derivative(kind, k, q, augmented_traction(on_segment, u, k, q), delta);
    auto column = columns.begin();
    for (const auto& side : on_segment.sides())
      for (int j = 0; j < basis.n_nodes(); ++j) *column++ = m * on_segment.augmented_derivative(side, j, q);
    auto entry = block.begin();
    for (const auto& side : on_segment.sides())
      for (int i = 0; i < basis.n_nodes(); ++i)
      {
        if (basis.node(i)[side.side->facet.local] > 0) continue;  // phi_i vanishes on the facet
        const double tested = -side.side->sign * contact_points(k)[q].weight * side.table->values_at(q)[i];
        for (const Tensor<dim>& of_j : columns) *entry++ += tested * of_j;
      }
  }
}

template <int dim>
std::vector<std::size_t> NitscheForm<dim>::first_on_facets() const
{
  const auto facets = [](const ContactSegment<dim>& segment)
  {
    return std::pair(segment.slave.number,
                     segment.master ? std::optional(segment.master->number) : std::nullopt);
  };
  std::vector<std::size_t> first;
  for (std::size_t k = 0; k < segments_.size(); ++k)
    if (k == 0 || facets(segments_[k]) != facets(segments_[k - 1])) first.push_back(k);
  first.push_back(segments_.size());
  return first;
}

template <int dim>
std::size_t NitscheForm<dim>::n_block_entries(std::size_t k) const
{
  const fem::LagrangeBasis<dim>& basis = space_->basis();
  std::size_t n_sides = 0;
  std::size_t n_rows = 0;
  segments_[k].for_each_side(
      [&](const SegmentSide<dim>& side)
      {
        ++n_sides;
        for (int i = 0; i < basis.n_nodes(); ++i) n_rows += basis.node(i)[side.facet.local] == 0 ? 1 : 0;
      });
  return n_rows * n_sides * basis.n_nodes() * dim * dim;
}

template <int dim>
void NitscheForm<dim>::put_block_entries(const SegmentValues<dim>& on_segment,
                                         std::span<const Tensor<dim>> block, std::size_t position,
                                         algebra::Triplets& entries) const
{
  const fem::LagrangeBasis<dim>& basis = space_->basis();
  const auto free_dof = [&](Index node, int a)
  { return constraints_.fixed[dim * node + a] ? -1 : dim * node + a; };
  auto entry = block.begin();
  for (const auto& row : on_segment.sides())
    for (int i = 0; i < basis.n_nodes(); ++i)
    {
      if (basis.node(i)[row.side->facet.local] > 0) continue;
      for (const auto& column : on_segment.sides())
        for (const Index node : column.nodes)
        {
          for (int a = 0; a < dim; ++a)
            for (int b = 0; b < dim; ++b)
              entries.put(position++, free_dof(row.nodes[i], a), free_dof(node, b), (*entry)(a, b));
          ++entry;
        }
    }
}

template <int dim>
algebra::Triplets NitscheForm<dim>::contact_tangent(Linearisation kind, std::span<const double> u,
                                                    double delta) const
{
  const std::vector<std::size_t> first = first_on_facets();
  const std::size_t n_blocks = first.size() - 1;
  std::vector<std::size_t> begin{0};
  for (std::size_t g = 0; g < n_blocks; ++g) begin.push_back(begin.back() + n_block_entries(first[g]));
  algebra::Triplets entries;
  entries.resize(begin.back());
  parallel_for(n_blocks,
               [&](std::size_t g)
               {
                 std::vector<Tensor<dim>> block((begin[g + 1] - begin[g]) / (dim * dim), Tensor<dim>::Zero());
                 for (std::size_t k = first[g]; k < first[g + 1]; ++k)
                   add_tangent_block(kind, u, k, delta, values(k), block);
                 put_block_entries(values(first[g]), block, begin[g], entries);
               });
  return entries;
}

template <int dim>
std::vector<ContactState<dim>> NitscheForm<dim>::contact_states(std::span<const double> u, std::size_t k,
                                                                const SegmentTable<dim>& table) const
{
  const ContactSegment<dim>& segment = segments_[k];
  const SimplexMap<dim - 1, dim> map = simplex_map(space_->mesh(), segment.slave);
  const SegmentValues<dim> on_segment(*problem_, *space_, segment, table);

  const bool is_own = table.slave == tables_[k].slave;  // at the contact points

  std::vector<ContactState<dim>> states;
  states.reserve(table.points.size());
  for (int q = 0; q < static_cast<int>(table.points.size()); ++q)
  {
    const Point<dim> x = map(table.points[q]);
    const Point<dim> n = segment.normal_at(x);
    const double gap = segment.gap(table.points[q], x, n);
    const problem::LawPoint<dim> point = is_own ? law_point(k, q) : law_point(k, table.points[q], x, n);
    const Point<dim> p = on_segment.augmented_traction(u, q) + segment.gamma * gap * n;
    const auto [traction, limit, status] = problem::respond<dim>(segment.contact->law, point, p);
    const Point<dim> jump = on_segment.jump(u, q);
    const Point<dim> displacement =
        fem::value_at<dim>(space_->cell_nodes(segment.slave.facet.cell), u, table.slave->values_at(q));
    const problem::InterfaceResponse<dim> committed = problem::advance<dim>(segment.contact->law, point, p);
    states.push_back({x, n, -traction.dot(n), traction, limit, status, gap - jump.dot(n),
                      jump - jump.dot(n) * n, displacement, committed.opening, committed.state});
  }
  return states;
}

template <int dim>
ContactResultants<dim> contact_resultants(const NitscheForm<dim>& form, std::span<const Point<dim>> t,
                                          int tag)
{
  ContactResultants<dim> sum;
  Point<dim> tangential = Point<dim>::Zero();
  for (std::size_t i = 0; i < form.n_owned_contact_points(); ++i)
  {
    if (tag >= 0 && form.segments()[i / form.n_segment_points()].slave.facet.tag != tag) continue;
    const auto& [x, weight, n, gap, strength, state] = form.contact_points()[i];
    const Point<dim> t_t = t[i] - t[i].dot(n) * n;
    sum.force += weight * t[i];
    sum.normal += weight * t[i].dot(n);
    sum.abs_tangential += weight * t_t.norm();
    tangential += weight * t_t;
    if constexpr (dim == 2) sum.tangential += weight * (-n[1] * t[i][0] + n[0] * t[i][1]);
  }
  std::array<double, 2 * dim + 3> sums{sum.normal, sum.tangential, sum.abs_tangential};
  std::ranges::copy(sum.force, sums.begin() + 3);
  std::ranges::copy(tangential, sums.begin() + 3 + dim);
  form.space().mesh().ranks().sum(std::span(sums));
  sum.normal = sums[0];
  sum.tangential = sums[1];
  sum.abs_tangential = sums[2];
  std::copy_n(sums.begin() + 3, dim, sum.force.data());
  std::copy_n(sums.begin() + 3 + dim, dim, tangential.data());
  if constexpr (dim == 3) sum.tangential = tangential.norm();
  return sum;
}

template class NitscheForm<2>;
template class NitscheForm<3>;
template ContactResultants<2> contact_resultants(const NitscheForm<2>&, std::span<const Point<2>>, int);
template ContactResultants<3> contact_resultants(const NitscheForm<3>&, std::span<const Point<3>>, int);

}  // namespace tribound::contact
