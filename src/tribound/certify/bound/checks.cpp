#include "tribound/certify/bound/checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tribound/base/parallel.h"
#include "tribound/certify/bound/checked_stress.h"
#include "tribound/certify/bound/radial_projection.h"
#include "tribound/fem/evaluation.h"
#include "tribound/mesh/shared_facets.h"

namespace tribound::certify
{

double IdentityDefects::largest() const
{
  double worst = 0;
  for (const double defect : {divergence, jump, neumann, contact, is_symmetric ? symmetry : 0})
    if (!std::isnan(worst) && !(defect <= worst)) worst = defect;  // nan, too
  return worst;
}

namespace
{

/// Whether a facet lies on the axis of an axisymmetric problem.
template <int dim>
bool is_on_axis(const contact::NitscheForm<dim>& form, Index cell, int local)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  return form.problem().is_axisymmetric() &&
         std::ranges::all_of(mesh::facet_vertices(mesh.cell(cell), local),
                             [&](Index v) { return mesh.vertex(v)[0] == 0; });
}

template <int dim>
bool has_facet_on_axis(const contact::NitscheForm<dim>& form, Index cell)
{
  for (int local = 0; local <= dim; ++local)
    if (is_on_axis(form, cell, local)) return true;
  return false;
}

/// ||div sigma_h + Pi^{p-1} f - rho||_T^2; div sigma_h and rho are of degree p-1. The points of the rule
/// follow the numbering of the cell, in which f is given; rho is given by its values at the vertices. Of the
/// radial row of an axisymmetric problem the divergence is no identity, but the hoop stress.
template <int dim>
double squared_divergence_defect(const contact::NitscheForm<dim>& form, Index cell,
                                 const CheckTables<dim>& tables, const CheckedStress<dim>& sigma,
                                 const mesh::CellMap<dim>& map, const std::array<Point<dim>, dim + 1>* rho)
{
  const contact::DiscreteData<dim>& data = form.data();
  std::vector<Point<dim>> moments = sigma.divergence(tables);
  if (data.has_body_force(cell) || rho)
  {
    const fem::Quadrature<dim>& rule = data.cell_rule();
    const bool on_axis = has_facet_on_axis(form, cell);
    std::vector<Point<dim>> at_axis(tables.n_less, Point<dim>::Zero());
    std::vector<Point<dim>>& load = on_axis ? at_axis : moments;
    RadialProjection<dim> projection(sigma.degree() - 1);
    std::vector<double> chi(tables.n_less);
    std::vector<Point<dim>> f(rule.size(), Point<dim>::Zero());
    if (data.has_body_force(cell)) data.body_force(cell, f);
    for (int q = 0; q < rule.size(); ++q)
    {
      const Point<dim>& x = rule.points[q];
      if (rho) f[q] -= (1 - x.sum()) * (*rho)[0];
      for (int i = 0; rho && i < dim; ++i) f[q] -= x[i] * (*rho)[i + 1];
      sigma.truncated_basis_at(map(x), chi);
      const double weight = rule.weights[q] * form.problem().weight(map(x));
      for (int i = 0; i < tables.n_less; ++i) load[i] += weight * std::sqrt(map.det) * chi[i] * f[q];
      if (on_axis) projection.add(chi, weight);
    }
    if constexpr (dim == 2)
      if (on_axis) projection.apply(load);
    for (int i = 0; on_axis && i < tables.n_less; ++i) moments[i] += load[i];
  }
  double sum = 0;
  for (const Point<dim>& moment : moments)
    sum += form.problem().is_axisymmetric() ? moment[1] * moment[1] : moment.squaredNorm();
  return sum;
}

/// How many leading coefficients of the skew part vanish: Lambda is of degree q - 1, on cells with an edge on
/// the axis of degree q - 2.
template <int dim>
int n_symmetric(const contact::NitscheForm<dim>& form, Index cell, const CheckTables<dim>& tables, int degree)
{
  return has_facet_on_axis(form, cell) ? fem::polynomial_dimension(dim, degree - 2) : tables.n_less;
}

/// Sums of squares over the cells, and the square of the norm of sigma_h.
template <int dim>
double check_cells(const contact::NitscheForm<dim>& form, const Stress<dim>& stress,
                   const CheckTables<dim>& tables, const AffineFields<dim>& rho, IdentityDefects& squares)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const auto of_cell = [&](std::size_t cell)
  {
    const auto c = static_cast<Index>(cell);
    const CheckedStress<dim> sigma(mesh, stress, c);
    return Eigen::Array3d(sigma.squared_norm(),
                          sigma.squared_skew_part(n_symmetric(form, c, tables, stress.degree)),
                          std::pow(mesh::cell_diameter(mesh, c), 2) *
                              squared_divergence_defect(form, c, tables, sigma, mesh::cell_map(mesh, c),
                                                        rho.empty() ? nullptr : &rho[cell]));
  };
  const Eigen::Array3d sums =
      parallel_sum<Eigen::Array3d>(mesh.n_owned_cells(), Eigen::Array3d::Zero(), of_cell);
  squares.symmetry = sums[1];
  squares.divergence = sums[2];
  return sums[0];
}

/// sigma_h n at the points of the rule for jumps, n outward from the cell. From both cells of a facet its
/// vertices come in the same ascending order, also on different ranks.
template <int dim>
void normal_traces(const mesh::Mesh<dim>& mesh, const Stress<dim>& stress, const CheckTables<dim>& tables,
                   Index cell, int local, std::span<Point<dim>> traces)
{
  const CheckedStress<dim> sigma(mesh, stress, cell);
  const Point<dim> normal = mesh::facet_geometry(mesh, cell, local).normal;
  const double* const phi = tables.on_facet[sigma.facet_opposite(mesh.cell(cell)[local])].data();
  for (int q = 0; q < tables.jump_rule.size(); ++q)
    traces[q] = sigma.normal_trace(phi + q * tables.n, normal);
}

/// h_F ||sum of the traces from both sides||_F^2.
template <int dim>
double squared_jump(const mesh::FacetGeometry<dim>& facet, const CheckTables<dim>& tables,
                    std::span<const Point<dim>> here, std::span<const Point<dim>> there)
{
  double sum = 0;
  for (int q = 0; q < tables.jump_rule.size(); ++q)
    sum += tables.jump_rule.weights[q] * (here[q] + there[q]).squaredNorm();
  return facet.diameter * facet.det() * sum;
}

/// sum h_F ||[sigma_h n]||_F^2 over the facets between two own cells.
template <int dim>
double check_jumps(const mesh::Mesh<dim>& mesh, const Stress<dim>& stress, const CheckTables<dim>& tables)
{
  const mesh::Topology<dim>& topology = mesh.topology();
  const auto of_cell = [&](std::size_t cell)
  {
    const auto c = static_cast<Index>(cell);
    std::vector<Point<dim>> here(tables.jump_rule.size());
    std::vector<Point<dim>> there(here.size());
    double sum = 0;
    for (int local = 0; local <= dim; ++local)
    {
      const Index facet = topology.cell_facets[c][local];
      const auto& [first, second] = topology.facet_cells[facet];
      if (first != c || second < 0 || second >= mesh.n_owned_cells()) continue;
      normal_traces<dim>(mesh, stress, tables, first, local, here);
      normal_traces<dim>(mesh, stress, tables, second, topology.local_facet(second, facet), there);
      sum += squared_jump<dim>(mesh::facet_geometry(mesh, c, local), tables, here, there);
    }
    return sum;
  };
  return parallel_sum(mesh.n_owned_cells(), 0.0, of_cell);
}

/// The same over the facets between own cells and those of lower ranks.
template <int dim>
double check_jumps_between_ranks(const mesh::Mesh<dim>& mesh, const Stress<dim>& stress,
                                 const CheckTables<dim>& tables)
{
  if (!mesh.partition()) return 0;
  const mesh::SharedFacets shared = mesh::shared_facets(mesh);
  const int n_points = tables.jump_rule.size();
  std::vector<Point<dim>> here(shared.own.size() * n_points);
  const auto of_facet = [n_points](std::vector<Point<dim>>& traces, std::size_t k)
  { return std::span(traces).subspan(k * n_points, n_points); };
  for (std::size_t k = 0; k < shared.own.size(); ++k)
    normal_traces<dim>(mesh, stress, tables, shared.own[k].cell, shared.own[k].local, of_facet(here, k));
  std::vector<Point<dim>> there = here;
  shared.update(std::span(there.empty() ? nullptr : there.front().data(), there.size() * dim),
                n_points * dim);
  double sum = 0;
  for (std::size_t k = 0; k < shared.own.size(); ++k)
    if (shared.is_of_lower[k] != 0)
      sum += squared_jump<dim>(mesh::facet_geometry(mesh, shared.own[k].cell, shared.own[k].local), tables,
                               of_facet(here, k), of_facet(there, k));
  return sum;
}

/// Moments (t, theta_i)_F of tractions in the orthonormal basis theta of one boundary facet.
template <int dim>
class FacetMoments
{
 public:
  FacetMoments(const mesh::Mesh<dim>& mesh, const mesh::BoundaryFacet& facet, int degree)
      : degree_(degree),
        scale_(1 / std::sqrt(mesh::facet_geometry(mesh, facet.cell, facet.local).det())),
        theta_(fem::polynomial_dimension(dim - 1, degree))
  {
  }

  [[nodiscard]] std::vector<Point<dim>> none() const { return {theta_.size(), Point<dim>::Zero()}; }
  /// moments += weight theta_i t at the point s of the reference facet.
  void add(const Point<dim - 1>& s, double weight, const Point<dim>& t, std::span<Point<dim>> moments)
  {
    fem::orthonormal_values<dim - 1>(degree_, s, theta_);
    for (std::size_t i = 0; i < moments.size(); ++i) moments[i] += weight * scale_ * theta_[i] * t;
  }

 private:
  int degree_;
  double scale_;  ///< normalises theta on the facet
  std::vector<double> theta_;
};

/// From the moments of r g to those of r Pi g on the facets of an axisymmetric problem off the axis.
void project_by_radius(const contact::NitscheForm<2>& form, int degree,
                       std::span<std::vector<Point<2>>> moments)
{
  const mesh::Mesh<2>& mesh = form.space().mesh();
  const fem::Quadrature<1>& rule = form.facet_rule();
  for (std::size_t number = 0; number < moments.size(); ++number)
  {
    if (moments[number].empty()) continue;
    const mesh::BoundaryFacet& facet = mesh.boundary()[number];
    RadialProjection<1> projection(degree);
    std::vector<double> theta(moments[number].size());
    for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, rule))
    {
      fem::orthonormal_values<1>(degree, rule.points[q], theta);
      projection.add(theta, rule.weights[q] * x[0]);
    }
    projection.apply(moments[number]);
  }
}

/// The moments of the traction on each boundary facet: g_N - K (u - u_0), t^k on slaves, -t^k on masters.
/// Empty: no traction. Of axisymmetric problems: r times the projections with the weight r.
template <int dim>
std::vector<std::vector<Point<dim>>> prescribed_moments(const contact::NitscheForm<dim>& form,
                                                        std::span<const Point<dim>> t,
                                                        std::span<const Point<dim>> springs, int degree)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const fem::Quadrature<dim - 1>& rule = form.facet_rule();
  std::vector<std::vector<Point<dim>>> moments(mesh.boundary().size());
  std::vector<Point<dim>> g(rule.size());
  const std::span<const contact::SpringFacet<dim>> spring_facets = form.springs().facets();
  for (std::size_t number = 0; number < mesh.boundary().size(); ++number)
  {
    const contact::SpringFacet<dim>* spring = form.springs().on(number);
    if (spring == nullptr && !form.data().has_traction(number)) continue;
    const mesh::BoundaryFacet& facet = mesh.boundary()[number];
    FacetMoments<dim> on_facet(mesh, facet, degree);
    moments[number] = on_facet.none();
    form.data().traction(number, g);
    if (spring != nullptr)
    {
      const std::size_t first = (spring - spring_facets.data()) * rule.size();
      for (int q = 0; q < rule.size(); ++q) g[q] += springs[first + q];
    }
    for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, rule))
      on_facet.add(rule.points[q], form.problem().weight(x) * dx, g[q], moments[number]);
  }
  for (std::size_t k = 0; k < form.segments().size(); ++k)
    form.segments()[k].for_each_side(
        [&](const contact::SegmentSide<dim>& side)
        {
          FacetMoments<dim> on_facet(mesh, side.facet, degree);
          if (moments[side.number].empty()) moments[side.number] = on_facet.none();
          for (int q = 0; q < rule.size(); ++q)
            on_facet.add(side.on_facet(rule.points[q]), side.sign * form.contact_points(k)[q].weight,
                         t[k * rule.size() + q], moments[side.number]);
        });
  if constexpr (dim == 2)
    if (form.problem().is_axisymmetric()) project_by_radius(form, degree, moments);
  return moments;
}

/// The square of the stress on a facet that lies on the axis, where tau = 0.
double squared_on_axis(const mesh::Mesh<2>& mesh, const mesh::BoundaryFacet& facet,
                       const fem::Quadrature<1>& rule, const CheckedStress<2>& tau)
{
  double sum = 0;
  for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, rule))
    for (int k = 0; k < 2; ++k) sum += dx * tau.normal_trace_at(x, Point<2>::Unit(k)).squaredNorm();
  return sum;
}

/// sum h_F ||Pi^p_F (sigma_h n) - prescribed||_F^2 over the free components.
template <int dim>
void check_boundary(const contact::NitscheForm<dim>& form, std::span<const Point<dim>> t,
                    const Stress<dim>& stress, IdentityDefects& squares)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const fem::Quadrature<dim - 1>& rule = form.facet_rule();
  const auto prescribed = prescribed_moments<dim>(form, t, stress.tractions.springs, stress.degree);
  std::vector<char> in_contact(mesh.boundary().size(), 0);
  for (const contact::ContactSegment<dim>& segment : form.segments())
    segment.for_each_side([&](const contact::SegmentSide<dim>& side) { in_contact[side.number] = 1; });
  for (std::size_t number = 0; number < mesh.n_owned_boundary(); ++number)
  {
    const mesh::BoundaryFacet& facet = mesh.boundary()[number];
    const problem::BoundaryCondition<dim>& boundary = form.problem().boundary(facet.tag);
    const mesh::FacetGeometry<dim> geometry = mesh::facet_geometry(mesh, facet.cell, facet.local);
    const CheckedStress<dim> sigma(mesh, stress, facet.cell);
    if constexpr (dim == 2)
      if (is_on_axis(form, facet.cell, facet.local))
      {
        squares.jump += geometry.diameter * squared_on_axis(mesh, facet, rule, sigma);
        continue;
      }
    FacetMoments<dim> on_facet(mesh, facet, stress.degree);
    std::vector<Point<dim>> moments = on_facet.none();
    for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, rule))
      on_facet.add(rule.points[q], dx, sigma.normal_trace_at(x, geometry.normal), moments);
    for (std::size_t i = 0; i < prescribed[number].size(); ++i) moments[i] -= prescribed[number][i];
    double& sum = in_contact[number] ? squares.contact : squares.neumann;
    for (const Point<dim>& moment : moments)
      for (int c = 0; c < dim; ++c)
        if (!boundary.fixes(c)) sum += geometry.diameter * moment[c] * moment[c];
  }
}

}  // namespace

template <int dim>
IdentityDefects check_identities(const contact::NitscheForm<dim>& form, std::span<const Point<dim>> t,
                                 const Stress<dim>& stress, const AffineFields<dim>& rho)
{
  const CheckTables<dim> tables(stress.degree);
  IdentityDefects squares;
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const double own_norm_squared = check_cells(form, stress, tables, rho, squares);
  squares.jump = check_jumps(mesh, stress, tables) + check_jumps_between_ranks(mesh, stress, tables);
  check_boundary(form, t, stress, squares);
  std::array sums{own_norm_squared, squares.divergence, squares.jump,
                  squares.neumann,  squares.contact,    squares.symmetry};
  mesh.ranks().sum(std::span(sums));
  squares = {sums[1], sums[2], sums[3], sums[4], sums[5]};
  const auto relative = [&](double sum) { return sum == 0 ? 0 : std::sqrt(sum / sums[0]); };
  return {relative(squares.divergence), relative(squares.jump),     relative(squares.neumann),
          relative(squares.contact),    relative(squares.symmetry), stress.is_symmetric()};
}

template IdentityDefects check_identities(const contact::NitscheForm<2>&, std::span<const Point<2>>,
                                          const Stress<2>&, const AffineFields<2>&);
template IdentityDefects check_identities(const contact::NitscheForm<3>&, std::span<const Point<3>>,
                                          const Stress<3>&, const AffineFields<3>&);

}  // namespace tribound::certify
