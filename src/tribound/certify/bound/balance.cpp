#include "tribound/certify/bound/balance.h"

#include <algorithm>
#include <utility>

#include "tribound/certify/equilibrate/stress_tabulation.h"
#include "tribound/contact/nitsche/contact_moments.h"
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
      loads.regions[mesh.region(c)].add(x - about, dx * f[q]);
  }
  const fem::Quadrature<dim - 1>& facet_rule = form.facet_rule();
  std::vector<Point<dim>> g(facet_rule.size());
  for (std::size_t k = 0; k < mesh.n_owned_boundary(); ++k)
  {
    const mesh::BoundaryFacet& facet = mesh.boundary()[k];
    if (facet.tag < 0 || !form.data().has_traction(k)) continue;
    form.data().traction(k, g);
    for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, facet_rule))
      loads.boundaries[facet.tag].add(x - about, dx * g[q]);
  }
  add_up<dim>(mesh.ranks(), loads.regions);
  add_up<dim>(mesh.ranks(), loads.boundaries);
  return loads;
}

/// The points of the facet rule on all facets of the reference cell, facet by facet.
template <int dim>
std::vector<Point<dim>> points_on_facets(const fem::Quadrature<dim - 1>& rule)
{
  std::vector<Point<dim>> points;
  for (int local = 0; local <= dim; ++local)
  {
    const std::vector<Point<dim>> on_facet = fem::points_on_facet<dim>(local, rule.points);
    points.insert(points.end(), on_facet.begin(), on_facet.end());
  }
  return points;
}

/// The integral of sigma_h n over every boundary, without the free components where a displacement is given.
template <int dim>
std::vector<Resultant<dim>> integrate_tractions(const contact::NitscheForm<dim>& form,
                                                const Stress<dim>& stress, const Point<dim>& about)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const fem::Quadrature<dim - 1> rule = fem::quadrature<dim - 1>(stress.degree + 1);  // sigma_h times x
  const StressTabulation<dim> table(stress.degree, points_on_facets<dim>(rule));
  const int n = table.n_points();
  std::vector<Resultant<dim>> result(form.problem().boundaries().size());
  std::vector<double> block(stress.block_size());
  std::vector<double> sigma(static_cast<std::size_t>(dim) * dim * n);
  for (const mesh::BoundaryFacet& facet : mesh.owned_boundary())
  {
    const problem::BoundaryCondition<dim>& condition = form.problem().boundary(facet.tag);
    const bool in_contact = form.problem().is_in_contact(facet.tag);
    if (facet.tag < 0 || (!in_contact && !condition.fixes_any())) continue;
    std::ranges::copy(stress.dis_in(facet.cell), block.begin());
    for (const std::span<const double> part : {stress.lin_in(facet.cell), stress.reg_in(facet.cell)})
      for (std::size_t i = 0; i < part.size(); ++i) block[i] += part[i];
    table.evaluate(make_sorted_cell(mesh, facet.cell), block, sigma);
    const Point<dim> normal = mesh::facet_geometry(mesh, facet.cell, facet.local).normal;
    for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, rule))
    {
      Point<dim> t = Point<dim>::Zero();
      for (int r = 0; r < dim; ++r)
        for (int c = 0; c < dim && (in_contact || condition.fixes(r)); ++c)
          t[r] += sigma[(dim * r + c) * n + facet.local * rule.size() + q] * normal[c];
      result[facet.tag].add(x - about, dx * t);
    }
  }
  add_up<dim>(mesh.ranks(), result);
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
               const Resultant<dim>& resultant, bool has_moment = true)
{
  BalanceRow result{kind, name, source, {resultant.force.begin(), resultant.force.end()}, {}};
  if (has_moment) result.moment.emplace(resultant.moment.begin(), resultant.moment.end());
  return result;
}

/// Adds the sum of all rows; its moment is known if all moments are.
void add_sum(std::vector<BalanceRow>& rows, std::size_t dim, std::size_t n_moments)
{
  BalanceRow sum{BalanceKind::sum, {}, {}, std::vector<double>(dim), std::vector<double>(n_moments)};
  for (const BalanceRow& part : rows)
  {
    for (std::size_t i = 0; i < dim; ++i) sum.force[i] += part.force[i];
    if (!part.moment) sum.moment.reset();
    for (std::size_t i = 0; sum.moment && i < n_moments; ++i) (*sum.moment)[i] += (*part.moment)[i];
  }
  rows.push_back(std::move(sum));
}

}  // namespace

std::string to_string(BalanceKind kind)
{
  constexpr std::array names = {"load", "reaction", "contact", "sum"};
  return names[static_cast<std::size_t>(kind)];
}

std::string moment_note(const Balance& balance)
{
  if (std::ranges::all_of(balance.rows, [](const BalanceRow& row) { return row.moment.has_value(); }))
    return {};
  return "moments of reactions need degree 2 or more: with degree 1 the equilibrated stress is symmetric "
         "only "
         "up to the error";
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
Balance balance(const contact::NitscheForm<dim>& form, const Stress<dim>& stress, const Point<dim>& about)
{
  const problem::Problem<dim>& problem = form.problem();
  const Loads<dim> loads = integrate_loads<dim>(form, about);
  const std::vector<Resultant<dim>> tractions = integrate_tractions<dim>(form, stress, about);
  Balance result{{about.begin(), about.end()}, {}};
  for (int r = 0; r < static_cast<int>(loads.regions.size()); ++r)
    if (!problem.body_force_is_zero(r))
      result.rows.push_back(
          row(BalanceKind::load, problem.regions()[r].name, "body force", loads.regions[r]));
  const auto boundaries = problem.boundaries();
  const auto add =
      [&](BalanceKind kind, const auto& applies, const auto& source, const auto& resultants, bool has_moment)
  {
    for (std::size_t tag = 0; tag < boundaries.size(); ++tag)
      if (applies(boundaries[tag], static_cast<int>(tag)))
        result.rows.push_back(
            row(kind, boundaries[tag].name, source(boundaries[tag]), resultants[tag], has_moment));
  };
  add(
      BalanceKind::load, [](const auto& b, int) { return b.is_loaded(); }, load_source<dim>, loads.boundaries,
      true);
  add(
      BalanceKind::reaction, [](const auto& b, int) { return b.fixes_any(); },
      [](const auto&) { return "displacement"; }, tractions, stress.degree > 1);
  add(
      BalanceKind::contact, [&](const auto&, int tag) { return problem.is_in_contact(tag); },
      [](const auto&) { return "contact"; }, tractions, true);
  add_sum(result.rows, dim, Resultant<dim>::n_moments);
  return result;
}

template Point<2> centroid(const mesh::Mesh<2>&);
template Point<3> centroid(const mesh::Mesh<3>&);
template Balance balance(const contact::NitscheForm<2>&, const Stress<2>&, const Point<2>&);
template Balance balance(const contact::NitscheForm<3>&, const Stress<3>&, const Point<3>&);

}  // namespace tribound::certify
