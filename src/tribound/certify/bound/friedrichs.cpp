#include "tribound/certify/bound/friedrichs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "tribound/certify/bound/constants.h"
#include "tribound/certify/bound/eigenvalue_bound.h"
#include "tribound/certify/bound/friedrichs_flux.h"
#include "tribound/certify/bound/friedrichs_meridian.h"
#include "tribound/certify/bound/friedrichs_pairs.h"
#include "tribound/certify/bound/friedrichs_potential.h"
#include "tribound/certify/bound/korn.h"
#include "tribound/contact/nitsche/segment.h"
#include "tribound/contact/support/assembly.h"
#include "tribound/fem/space.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/partition.h"
#include "tribound/mesh/refine.h"

namespace tribound::certify
{

namespace
{

/// kappa with ||e||_T <= kappa h_T ||grad e||_T for every e with zero means over the facets of T. For the
/// mean of e over T, |T| mean^2 <= h_T^2 / (2 d (d+1) (d+2)) ||grad e||^2, from div((x - g) e) = d e + (x -
/// g).grad e with the barycentre g. For the rest, h_T / j_{1,1} in triangles [LS10], h_T / pi in convex cells
/// [PW60]. In 2D this is the constant of [CGR12].
template <int dim>
constexpr double kappa_squared()
{
  constexpr double root = dim == 2 ? bessel_zero : 3.1415926535;  // rounded down
  return 1.0 / (2 * dim * (dim + 1) * (dim + 2)) + 1 / (root * root);
}

/// The mesh of the proof. After uniform refinement, all facets are similar to their parents.
template <int dim>
struct ProofMesh
{
  const mesh::Mesh<dim>& mesh;
  double facet_scale;  ///< h_F of the facet of the given mesh / diameter of its part here
  PairTerms pairs{};   ///< empty if no body needs the others
};

/// 1 for each facet on which Gamma_D fixes the component.
template <int dim>
std::vector<char> fixed_facets(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                               int component)
{
  std::vector<char> fixed(mesh.topology().facets.size(), 0);
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
    if (problem.boundary(facet.tag).clamps(component))
      fixed[mesh.topology().cell_facets[facet.cell][facet.local]] = 1;
  return fixed;
}

/// A = sum_T w_T (grad ., grad .)_T + sum_{F in C} (|F|/h_F) mean_F(.) mean_F(.) + the couplings of pairs, M
/// = sum_T (., .)_T for the Crouzeix-Raviart functions phi_i = 1 - d lambda_i, which have mean 1 on facet i
/// and 0 on the others; C the obstacles and springs.
template <int dim>
Pencil assemble(const problem::Problem<dim>& problem, const ProofMesh<dim>& proof,
                const std::vector<char>& fixed)
{
  const mesh::Mesh<dim>& mesh = proof.mesh;
  const auto& cell_facets = mesh.topology().cell_facets;
  Pencil pencil;
  std::vector<Index>& number = pencil.number;
  number.assign(fixed.size(), -1);
  for (std::size_t f = 0; f < fixed.size(); ++f)
    if (!fixed[f]) number[f] = pencil.n++;
  const auto add = [&](Index i, Index j, double a, double m)
  {
    if (i < 0 || j < 0) return;
    pencil.a.add(i, j, a);
    pencil.m.push_back(m);
  };

  const std::size_t n_entries = (dim + 1) * (dim + 1) * static_cast<std::size_t>(mesh.n_cells());
  pencil.a.reserve(n_entries);
  pencil.m.reserve(n_entries);
  constexpr double mass =
      static_cast<double>(dim * dim) / ((dim + 1) * (dim + 2));  // d^2 (lambda_i, lambda_j)
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    const mesh::CellMap<dim> map = mesh::cell_map(mesh, c);
    const double volume = map.measure();
    const double stiffness = dim * dim * volume * (proof.pairs.cells.empty() ? 1 : proof.pairs.cells[c]);
    const std::array<Point<dim>, dim + 1> gradients = map.barycentric_gradients();
    for (int i = 0; i <= dim; ++i)
      for (int j = 0; j <= dim; ++j)
        add(number[cell_facets[c][i]], number[cell_facets[c][j]], stiffness * gradients[i].dot(gradients[j]),
            volume * (1 - 2.0 * dim / (dim + 1) + mass * (i == j ? 2 : 1)));
  }
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    if (!problem.boundary(facet.tag).is_in_norm()) continue;
    const mesh::FacetGeometry<dim> geometry = mesh::facet_geometry(mesh, facet.cell, facet.local);
    const Index i = number[cell_facets[facet.cell][facet.local]];
    add(i, i, geometry.measure / (proof.facet_scale * geometry.diameter), 0);
  }
  for (const auto& [slave, master, weight] : proof.pairs.couplings)
  {
    add(number[slave], number[slave], weight, 0);
    add(number[master], number[master], weight, 0);
    add(number[slave], number[master], -weight, 0);
    add(number[master], number[slave], -weight, 0);
  }
  return pencil;
}

/// The smallest theta(fixed facets, pencil) of all components. Components fixed on the same facets have the
/// same theta.
template <int dim, class Theta>
double theta_of_components(const problem::Problem<dim>& problem, const ProofMesh<dim>& proof, Theta theta)
{
  std::array<std::vector<char>, dim> fixed;
  double smallest = std::numeric_limits<double>::infinity();
  for (int a = 0; a < dim; ++a)
  {
    fixed[a] = fixed_facets(problem, proof.mesh, a);
    if (std::find(fixed.begin(), fixed.begin() + a, fixed[a]) == fixed.begin() + a)
      smallest = std::min(smallest, theta(fixed[a], assemble(problem, proof, fixed[a])));
  }
  return smallest;
}

/// C^2 <= 1/theta + kappa^2 H^2 [CG14, Liu15], without separation of eigenvalues since only the supremum is
/// needed. The interpolant I w with the facet means of w satisfies ||w - I w|| <= kappa H ||grad(w - I w)||,
/// grad I w is the cell means of grad w, and ||w||_F^2 >= |F| mean_F(w)^2. Only the fraction w_T of the
/// gradients may be available.
template <int dim>
FriedrichsConstant constant_on(const problem::Problem<dim>& problem, const ProofMesh<dim>& proof)
{
  FriedrichsConstant result{};
  result.theta = theta_of_components(problem, proof,
                                     [](const std::vector<char>&, Pencil pencil)
                                     { return proved_theta(std::move(pencil), dim); });
  result.cells = proof.mesh.n_cells();
  for (Index c = 0; c < result.cells; ++c)
    result.mesh_size = std::max(result.mesh_size, mesh::cell_diameter(proof.mesh, c));
  const double least = proof.pairs.cells.empty() ? 1 : std::ranges::min(proof.pairs.cells);
  result.value =
      std::sqrt(1 / result.theta + kappa_squared<dim>() * result.mesh_size * result.mesh_size / least);
  return result;
}

/// What fixes the bodies in every component: Gamma_D and obstacles, or only pairs.
enum class Held
{
  not_all,
  with_pairs,
  each
};

template <int dim>
Held held(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
          std::span<const contact::ContactSegment<dim>> segments)
{
  Held result = Held::each;
  for (const auto& assembly : contact::find_assemblies<dim>(fem::LagrangeSpace<dim>(mesh, 1), segments))
  {
    std::array<bool, dim> of_any{};
    for (const contact::Body<dim>& body : assembly.bodies)
    {
      std::array<bool, dim> of_body{};
      for (const mesh::BoundaryFacet& facet : body.facets)
        for (int a = 0; a < dim; ++a)
          of_body[a] =
              of_body[a] || problem.boundary(facet.tag).clamps(a) || problem.boundary(facet.tag).is_in_norm();
      for (int a = 0; a < dim; ++a) of_any[a] = of_any[a] || of_body[a];
      if (std::ranges::count(of_body, false) > 0) result = Held::with_pairs;
    }
    if (std::ranges::count(of_any, false) > 0) return Held::not_all;
  }
  return result;
}

template <int dim>
FriedrichsConstant without_factors(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh)
{
  const double theta = theta_of_components<dim>(
      problem, {mesh, 1},
      [&](const std::vector<char>& fixed, Pencil pencil)
      {
        return flux_theta<dim>(problem, mesh, fixed,
                               potential_means<dim>(problem, mesh, fixed, std::move(pencil)));
      });
  return {1 / std::sqrt(theta), theta, 0, mesh.n_cells()};
}

template <int dim>
FriedrichsConstant with_factors(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                Index most_cells, const PairTerms& pairs)
{
  const FriedrichsConstant here = constant_on<dim>(problem, {mesh, 1, pairs});
  if (here.value * here.value <= 2 / here.theta) return here;
  // kappa^2 H^2 > 1/theta: refine, for the proof alone. The norm keeps the h_F of the given mesh.
  if (mesh::count_after_refinement(mesh, 1).cells > most_cells) return here;
  const mesh::Refined<dim> refined = mesh::refine_uniformly(mesh);
  const PairTerms finer_pairs =
      pairs.cells.empty()
          ? PairTerms{}
          : pair_terms<dim>(refined.mesh, contact::contact_segments(problem, refined.mesh, 1.0), 2);
  const FriedrichsConstant finer = constant_on<dim>(problem, {refined.mesh, 2, finer_pairs});
  return finer.value < here.value ? finer : here;
}

/// C_F without K.
template <int dim>
FriedrichsConstant of_gradients(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                Index most_factorised)
{
  const FriedrichsConstant none{std::numeric_limits<double>::infinity(), 0, 0, mesh.n_cells()};
  if (mesh.partition()) return none;
  if constexpr (dim == 2)
    if (problem.is_axisymmetric())
    {
      const double value = meridian_friedrichs(problem, mesh);
      return {value, 1 / (value * value), 0, mesh.n_cells()};
    }
  const std::vector<contact::ContactSegment<dim>> segments = contact::contact_segments(problem, mesh, 1.0);
  const Held bodies = held<dim>(problem, mesh, segments);
  if (bodies == Held::not_all) return none;
  if (bodies == Held::each && mesh.n_cells() > most_factorised) return without_factors(problem, mesh);
  try
  {
    return with_factors(problem, mesh, most_factorised,
                        bodies == Held::with_pairs ? pair_terms<dim>(mesh, segments, 1) : PairTerms{});
  }
  catch (const SolveError&)  // such as memory for the factors: there is a bound without them, but for pairs
  {
    return bodies == Held::each ? without_factors(problem, mesh) : none;
  }
}

}  // namespace

template <int dim>
FriedrichsConstant friedrichs_constant(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                       Index most_factorised)
{
  FriedrichsConstant result = of_gradients(problem, mesh, most_factorised);
  if (!problem.is_axisymmetric()) result.korn = korn_constant(problem, mesh);
  return result;
}

template <int dim>
double friedrichs_kappa()
{
  return std::sqrt(kappa_squared<dim>());
}

template double friedrichs_kappa<2>();
template double friedrichs_kappa<3>();
template FriedrichsConstant friedrichs_constant(const problem::Problem<2>&, const mesh::Mesh<2>&, Index);
template FriedrichsConstant friedrichs_constant(const problem::Problem<3>&, const mesh::Mesh<3>&, Index);

}  // namespace tribound::certify
