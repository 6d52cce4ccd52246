#include "tribound/certify/equilibrate/facet_data.h"

#include <cmath>

#include "tribound/certify/equilibrate/frame.h"
#include "tribound/fem/polynomials.h"
#include "tribound/fem/quadrature.h"

namespace tribound::certify
{

namespace
{

/// Hat functions and facet basis at the points of the facet rule, for one way in which the ascending order of
/// the facet's vertices differs from the order of the cell.
template <int dim, int p>
struct FacetTable
{
  std::array<int, dim>
      order;  ///< order[i]: place among the facet's vertices, in cell order, of the i-th ascending
  std::vector<std::array<double, dim>> hat;
  std::vector<std::array<double, Sizes<dim, p>::facet>> basis;
};

template <int dim, int p>
FacetTable<dim, p> make_table(const std::array<int, dim>& order, const fem::Quadrature<dim - 1>& rule)
{
  FacetTable<dim, p> table{order, {}, {}};
  for (const Point<dim - 1>& s : rule.points)
  {
    std::array<double, dim> in_cell_order;
    in_cell_order[0] = 1 - s.sum();
    for (int i = 1; i < dim; ++i) in_cell_order[i] = s[i - 1];
    std::array<double, dim> hat;
    for (int i = 0; i < dim; ++i) hat[i] = in_cell_order[order[i]];
    Point<dim - 1> sorted;
    for (int i = 1; i < dim; ++i) sorted[i - 1] = hat[i];
    table.hat.push_back(hat);
    fem::orthonormal_values<dim - 1>(p, sorted, table.basis.emplace_back());
  }
  return table;
}

template <int dim, int p>
class FacetTables
{
 public:
  explicit FacetTables(const fem::Quadrature<dim - 1>& rule) : rule_(rule) {}

  /// The table of local facet `local` of the frame's cell (numbered as in Mesh::cell).
  const FacetTable<dim, p>& operator()(const Frame<dim>& frame, int local)
  {
    std::array<int, dim> order;
    for (int i = 0, n = 0; i <= dim; ++i)
      if (frame.local[i] != local) order[n++] = frame.local[i] - (frame.local[i] > local);
    for (const auto& table : tables_)
      if (table.order == order) return table;
    return tables_.emplace_back(make_table<dim, p>(order, rule_));
  }

 private:
  const fem::Quadrature<dim - 1>& rule_;
  std::vector<FacetTable<dim, p>> tables_;
};

/// moments += weight lambda_v theta_i t for one point.
template <int dim, int p>
void add_point(typename FacetData<dim, p>::Moments& moments, const FacetTable<dim, p>& table, int q,
               double weight, const Point<dim>& t)
{
  constexpr int n = Sizes<dim, p>::facet;
  for (int v = 0; v < dim; ++v)
    for (int c = 0; c < dim; ++c)
      for (int i = 0; i < n; ++i)
        moments[v][c * n + i] += weight * table.hat[q][v] * table.basis[q][i] * t[c];
}

}  // namespace

template <int dim, int p>
FacetData<dim, p>::FacetData(const contact::NitscheForm<dim>& form, std::span<const double> u,
                             std::span<const Point<dim>> t, double delta)
    : number_(form.space().mesh().topology().facets.size(), -1),
      on_contact_(form.space().mesh().n_vertices(), 0),
      n_parts_(delta > 0 ? 3 : 2)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const fem::Quadrature<dim - 1>& rule = form.facet_rule();
  FacetTables<dim, p> tables(rule);
  const std::vector<Point<dim>> t_u = form.traction(u);
  const std::vector<Point<dim>> t_delta = delta > 0 ? form.traction(u, delta) : t_u;
  std::size_t contact_point = 0;  // contact facets come in the order of Mesh::boundary()
  std::vector<Point<dim>> load(rule.size());
  for (std::size_t number = 0; number < mesh.boundary().size(); ++number)
  {
    const mesh::BoundaryFacet& facet = mesh.boundary()[number];
    const problem::BoundaryCondition<dim>& boundary = form.problem().boundary(facet.tag);
    Condition& condition = conditions_.emplace_back();
    number_[mesh.topology().cell_facets[facet.cell][facet.local]] = static_cast<int>(conditions_.size()) - 1;
    for (int c = 0; c < dim; ++c) condition.fixed[c] = boundary.fixes(c);
    if (!boundary.contact && !boundary.is_loaded()) continue;

    const Frame<dim> frame = make_frame(mesh, facet.cell);
    const FacetTable<dim, p>& table = tables(frame, facet.local);
    const int opposite = static_cast<int>(std::ranges::find(frame.local, facet.local) - frame.local.begin());
    const double scale = std::sqrt(frame.facet_scale(opposite));  // |F| / |Fhat| times theta's normalisation
    condition.moments = static_cast<int>(discretisation_.size());
    Moments& moments = discretisation_.emplace_back();
    if (boundary.contact)
    {
      for (Index v : frame.vertices)
        if (v != mesh.cell(facet.cell)[facet.local]) on_contact_[v] = 1;
      condition.contact = static_cast<int>(linearisation_.size());
      Moments& linearisation = linearisation_.emplace_back();
      Moments* const regularisation = delta > 0 ? &regularisation_.emplace_back() : nullptr;
      for (int q = 0; q < rule.size(); ++q, ++contact_point)
      {
        const auto add = [&](Moments& part, const Point<dim>& traction)
        { add_point<dim, p>(part, table, q, scale * rule.weights[q], traction); };
        add(moments, t_u[contact_point]);
        add(linearisation, t[contact_point] - t_delta[contact_point]);
        if (regularisation) add(*regularisation, t_delta[contact_point] - t_u[contact_point]);
      }
      continue;
    }
    form.data().traction(number, load);
    for (int q = 0; q < rule.size(); ++q)
      add_point<dim, p>(moments, table, q, scale * rule.weights[q], load[q]);
  }
}

template <int dim, int p>
bool FacetData<dim, p>::fixes_any(Index facet) const
{
  const auto& fixed = conditions_[number_[facet]].fixed;
  return std::ranges::find(fixed, true) != fixed.end();
}

template class FacetData<2, 1>;
template class FacetData<2, 2>;
template class FacetData<2, 3>;
template class FacetData<2, 4>;
template class FacetData<3, 1>;
template class FacetData<3, 2>;
template class FacetData<3, 3>;
template class FacetData<3, 4>;

}  // namespace tribound::certify
