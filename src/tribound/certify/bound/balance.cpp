#include "tribound/certify/bound/balance.h"

#include <algorithm>
#include <utility>

#include "tribound/contact/nitsche/contact_moments.h"
#include "tribound/contact/nitsche/residual.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/quadrature.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

namespace
{

/// A force and its moment about a point.
template <int dim>
struct Resultant
{
  static constexpr int n_moments = dim == 2 ? 1 : 3;
  Point<dim> force = Point<dim>::Zero();
  Point<n_moments> moment = Point<n_moments>::Zero();

  /// A force that acts at `arm` from the point.
  void add(const Point<dim>& arm, const Point<dim>& f)
  {
    force += f;
    moment += contact::moment(arm, f);
  }
};

/// Over all ranks.
template <int dim>
void add_up(const Ranks& ranks, std::span<Resultant<dim>> resultants)
{
  std::vector<double> sums;
  for (const Resultant<dim>& r : resultants)
  {
    sums.insert(sums.end(), r.force.begin(), r.force.end());
    sums.insert(sums.end(), r.moment.begin(), r.moment.end());
  }
  ranks.sum(std::span(sums));
  const double* next = sums.data();
  for (Resultant<dim>& r : resultants)
  {
    std::copy_n(next, r.force.size(), r.force.data());
    std::copy_n(next + r.force.size(), r.moment.size(), r.moment.data());
    next += r.force.size() + r.moment.size();
  }
}

template <int dim>
struct Loads
{
  std::vector<Resultant<dim>> regions;
  std::vector<Resultant<dim>> boundaries;
};

/// (f, .) of every region and (g_N, .)_N of every boundary, with the rules of L(v).
template <int dim>
Loads<dim> integrate_loads(const contact::NitscheForm<dim>& form, const Point<dim>& about)
{
  const problem::Problem<dim>& problem = form.problem();
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  Loads<dim> loads;
  loads.regions.resize(problem.regions().size());
  loads.boundaries.resize(problem.boundaries().size());
  const fem::Quadrature<dim>& rule = form.data().cell_rule();
  std::vector<Point<dim>> f(rule.size());
  for (Index c = 0; c < mesh.n_owned_cells(); ++c)
  {
    if (!form.data().has_body_force(c)) continue;
    form.data().body_force(c, f);
    for (const auto& [q, x, dx] : fem::cell_points(mesh::cell_map(mesh, c), rule))
      loads.regions[mesh.region(c)].add(x - about, problem.weight(x) * dx * f[q]);
  }
  const fem::Quadrature<dim - 1>& facet_rule = form.facet_rule();
  std::vector<Point<dim>> g(facet_rule.size());
  for (std::size_t k = 0; k < mesh.n_owned_boundary(); ++k)
  {
    const mesh::BoundaryFacet& facet = mesh.boundary()[k];
    if (facet.tag < 0 || !form.data().has_traction(k)) continue;
    form.data().traction(k, g);
    for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, facet_rule))
      loads.boundaries[facet.tag].add(x - about, problem.weight(x) * dx * g[q]);
  }
  add_up<dim>(mesh.ranks(), loads.regions);
  add_up<dim>(mesh.ranks(), loads.boundaries);
  return loads;
}

/// The integral of t over every boundary in contact, slave or master.
template <int dim>
std::vector<Resultant<dim>> integrate_tractions(const contact::NitscheForm<dim>& form,
                                                std::span<const Point<dim>> t, const Point<dim>& about)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const std::vector<Point<dim - 1>>& points = form.facet_rule().points;
  std::vector<Resultant<dim>> result(form.problem().boundaries().size());
  for (std::size_t k = 0; k < form.n_owned_segments(); ++k)
    form.segments()[k].for_each_side(
        [&](const contact::SegmentSide<dim>& side)
        {
          const auto map = contact::simplex_map(mesh, side);
          for (std::size_t q = 0; q < points.size(); ++q)
            result[side.facet.tag].add(
                map(points[q]) - about,
                side.sign * form.contact_points(static_cast<int>(k))[q].weight * t[k * points.size() + q]);
        });
  add_up<dim>(mesh.ranks(), result);
  return result;
}

/// The integral of -K (u - u_0) over every boundary.
template <int dim>
std::vector<Resultant<dim>> integrate_springs(const contact::NitscheForm<dim>& form,
                                              std::span<const double> u, const Point<dim>& about)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  std::vector<Resultant<dim>> result(form.problem().boundaries().size());
  for (const contact::SpringFacet<dim>& facet : form.springs().facets())
    if (facet.number < mesh.n_owned_boundary())
      for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, form.facet_rule()))
        result[mesh.boundary()[facet.number].tag].add(
            x - about, form.problem().weight(x) * dx * form.springs().traction(facet, u, q));
  add_up<dim>(mesh.ranks(), result);
  return result;
}

/// A node of a boundary with fixed components.
struct SupportNode
{
  Index node;
  int tag;         ///< of the boundary
  double measure;  ///< of its facets around the node

  friend auto operator<=>(const SupportNode& a, const SupportNode& b) = default;
};

/// Every node once for each of its boundaries, sorted.
template <int dim>
std::vector<SupportNode> support_nodes(const contact::NitscheForm<dim>& form)
{
  const fem::LagrangeSpace<dim>& space = form.space();
  const mesh::Mesh<dim>& mesh = space.mesh();
  std::vector<SupportNode> found;
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    if (facet.tag < 0 || !form.problem().boundary(facet.tag).fixes_any()) continue;
    const double det = mesh::facet_geometry(mesh, facet.cell, facet.local).det();
    const std::span<const Index> nodes = space.cell_nodes(facet.cell);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (space.basis().node(static_cast<int>(i))[facet.local] == 0)
        found.push_back({nodes[i], facet.tag, det});
  }
  std::ranges::sort(found);
  std::vector<SupportNode> united;
  for (const SupportNode& part : found)
    if (!united.empty() && united.back().node == part.node && united.back().tag == part.tag)
      united.back().measure += part.measure;
    else
      united.push_back(part);
  return united;
}

/// The force of every boundary in its fixed components: what its nodes lack of equilibrium. Where boundaries
/// that fix the same component meet, they share it by the measures of their facets around the node.
template <int dim>
std::vector<Resultant<dim>> sum_reactions(const contact::NitscheForm<dim>& form, std::span<const double> u,
                                          std::span<const Point<dim>> t, const Point<dim>& about)
{
  const fem::LagrangeSpace<dim>& space = form.space();
  const std::vector<double> lacking = contact::unconstrained_residual<dim>(form, u, t);
  const std::vector<Point<dim>> points = space.node_points();
  const std::vector<SupportNode> nodes = support_nodes(form);
  std::vector<char> is_own(space.n_nodes(), 0);
  for (Index k = 0; k < space.n_owned_nodes(); ++k) is_own[space.owned_node(k)] = 1;
  std::vector<Resultant<dim>> result(form.problem().boundaries().size());
  for (auto first = nodes.begin(); first != nodes.end();)
  {
    const auto end =
        std::find_if(first, nodes.end(), [&](const SupportNode& n) { return n.node != first->node; });
    const std::span<const SupportNode> here(first, end);
    first = end;
    if (is_own[here.front().node] == 0) continue;
    for (int c = 0; c < dim; ++c)
    {
      double measure = 0;
      for (const SupportNode& n : here)
        if (form.problem().boundary(n.tag).fixes(c)) measure += n.measure;
      const double force = -lacking[static_cast<std::size_t>(dim) * here.front().node + c];
      for (const SupportNode& n : here)
        if (form.problem().boundary(n.tag).fixes(c))
          result[n.tag].add(points[n.node] - about, n.measure / measure * force * Point<dim>::Unit(c));
    }
  }
  add_up<dim>(space.mesh().ranks(), result);
  return result;
}

/// The given force and moment, as integrals without full_circle().
template <int dim>
Resultant<dim> force_on(const problem::Problem<dim>& problem, const problem::RigidPart<dim>& part,
                        const Point<dim>& about)
{
  Resultant<dim> result;
  result.add(part.point - about, part.total_force() / problem.full_circle());
  result.moment += part.total_moment() / problem.full_circle();
  return result;
}

template <int dim>
std::string load_source(const problem::BoundaryCondition<dim>& condition)
{
  const bool traction = std::ranges::any_of(condition.traction, [](const auto& t) { return !t.is_zero(); });
  if (!condition.pressure) return "traction";
  return traction ? "traction and pressure" : "pressure";
}

template <int dim>
BalanceRow row(BalanceKind kind, const std::string& name, const std::string& source,
               const Resultant<dim>& resultant)
{
  return {kind,
          name,
          source,
          {resultant.force.begin(), resultant.force.end()},
          {resultant.moment.begin(), resultant.moment.end()}};
}

/// Adds the sum of all rows.
void add_sum(std::vector<BalanceRow>& rows, std::size_t dim, std::size_t n_moments)
{
  BalanceRow sum{BalanceKind::sum, {}, {}, std::vector<double>(dim), std::vector<double>(n_moments)};
  for (const BalanceRow& part : rows)
  {
    for (std::size_t i = 0; i < dim; ++i) sum.force[i] += part.force[i];
    for (std::size_t i = 0; i < n_moments; ++i) sum.moment[i] += part.moment[i];
  }
  rows.push_back(std::move(sum));
}

}  // namespace

std::string to_string(BalanceKind kind)
{
  constexpr std::array names = {"load", "reaction", "spring", "contact", "sum"};
  return names[static_cast<std::size_t>(kind)];
}

template <int dim>
Point<dim> centroid(const mesh::Mesh<dim>& mesh)
{
  Point<dim + 1> sum = Point<dim + 1>::Zero();  // the last entry: the volume
  for (Index c = 0; c < mesh.n_owned_cells(); ++c)
  {
    const mesh::CellMap<dim> map = mesh::cell_map(mesh, c);
    sum.template head<dim>() += map.det * map(Point<dim>::Constant(1.0 / (dim + 1)));
    sum[dim] += map.det;
  }
  mesh.ranks().sum(std::span(sum.data(), sum.size()));
  return sum.template head<dim>() / sum[dim];
}

template <int dim>
Balance balance(const contact::NitscheForm<dim>& form, std::span<const double> u,
                std::span<const Point<dim>> t, const Point<dim>& about)
{
  const problem::Problem<dim>& problem = form.problem();
  const Loads<dim> loads = integrate_loads<dim>(form, about);
  const std::vector<Resultant<dim>> tractions = integrate_tractions<dim>(form, t, about);
  const std::vector<Resultant<dim>> reactions = sum_reactions<dim>(form, u, t, about);
  const std::vector<Resultant<dim>> springs = integrate_springs<dim>(form, u, about);
  Balance result{{about.begin(), about.end()}, {}};
  for (int r = 0; r < static_cast<int>(loads.regions.size()); ++r)
    if (!problem.body_force_is_zero(r))
      result.rows.push_back(
          row(BalanceKind::load, problem.regions()[r].name, "body force", loads.regions[r]));
  const auto boundaries = problem.boundaries();
  const auto add = [&](BalanceKind kind, const auto& applies, const auto& source, const auto& resultants)
  {
    for (std::size_t tag = 0; tag < boundaries.size(); ++tag)
      if (applies(boundaries[tag], static_cast<int>(tag)))
        result.rows.push_back(row(kind, boundaries[tag].name, source(boundaries[tag]), resultants[tag]));
  };
  add(
      BalanceKind::load, [](const auto& b, int) { return b.is_loaded(); }, load_source<dim>,
      loads.boundaries);
  for (const problem::BoundaryCondition<dim>& boundary : boundaries)
    if (boundary.rigid)
      result.rows.push_back(row(BalanceKind::load, boundary.name, "rigid part",
                                force_on<dim>(problem, *boundary.rigid, about)));
  add(
      BalanceKind::reaction,
      [&](const auto& b, int)
      {
        if (problem.is_axisymmetric()) return b.rigid ? b.rigid->fixed[1] : b.fixes(1);
        return b.rigid ? b.rigid->fixes_any() : b.fixes_any();
      },
      [](const auto& b) { return b.rigid ? "guide" : "displacement"; }, reactions);
  add(
      BalanceKind::spring, [](const auto& b, int) { return b.spring.has_value(); },
      [](const auto&) { return "spring"; }, springs);
  add(
      BalanceKind::contact, [&](const auto&, int tag) { return problem.is_in_contact(tag); },
      [](const auto&) { return "contact"; }, tractions);
  if (problem.is_axisymmetric())  // around the axis all but the axial forces cancel
    for (BalanceRow& part : result.rows)
    {
      part.force = {0, problem.full_circle() * part.force[1]};
      part.moment.assign(part.moment.size(), 0.0);
    }
  add_sum(result.rows, dim, Resultant<dim>::n_moments);
  return result;
}

template Point<2> centroid(const mesh::Mesh<2>&);
template Point<3> centroid(const mesh::Mesh<3>&);
template Balance balance(const contact::NitscheForm<2>&, std::span<const double>, std::span<const Point<2>>,
                         const Point<2>&);
template Balance balance(const contact::NitscheForm<3>&, std::span<const double>, std::span<const Point<3>>,
                         const Point<3>&);

}  // namespace tribound::certify
