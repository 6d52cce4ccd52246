#include "tribound/certify/bound/friedrichs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "tribound/algebra/cholesky.h"
#include "tribound/base/dense_factors.h"
#include "tribound/certify/bound/constants.h"
#include "tribound/certify/bound/friedrichs_flux.h"
#include "tribound/certify/bound/friedrichs_pairs.h"
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

/// kappa with ||e||_T <= kappa h_T ||grad e||_T for every e whose means over the facets of T vanish. The mean
/// of e over T: |T| mean^2 <= h_T^2 / (2 d (d+1) (d+2)) ||grad e||^2, from div((x - g) e) = d e + (x -
/// g).grad e with the barycentre g; the rest: h_T / j_{1,1} in triangles [LS10], h_T / pi in convex cells
/// [PW60]. In 2D this is the constant of [CGR12].
template <int dim>
constexpr double kappa_squared()
{
  constexpr double root = dim == 2 ? bessel_zero : 3.1415926535;  // rounded down
  return 1.0 / (2 * dim * (dim + 1) * (dim + 2)) + 1 / (root * root);
}

/// The mesh of the proof. Refined uniformly, all facets are similar to those they are parts of.
template <int dim>
struct ProofMesh
{
  const mesh::Mesh<dim>& mesh;
  double facet_scale;  ///< h_F of the facet of the given mesh / diameter of its part here
  PairTerms pairs{};   ///< empty where no body needs the others
};

/// A and M over the facet means that are not fixed, with the same sparsity pattern.
struct Pencil
{
  Index n = 0;
  std::vector<Index> number;  ///< of each facet, -1 where fixed
  algebra::Triplets a;
  std::vector<double> m;  ///< the values of M
};

/// 1 for each facet on which Gamma_D fixes the component.
template <int dim>
std::vector<char> fixed_facets(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                               int component)
{
  std::vector<char> fixed(mesh.topology().facets.size(), 0);
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
    if (problem.boundary(facet.tag).fixes(component))
      fixed[mesh.topology().cell_facets[facet.cell][facet.local]] = 1;
  return fixed;
}

/// A = sum_T w_T (grad ., grad .)_T + sum_{F in C} (|F|/h_F) mean_F(.) mean_F(.) + the couplings of pairs,
/// M = sum_T (., .)_T of the Crouzeix-Raviart functions phi_i = 1 - d lambda_i, which have mean 1 on facet i
/// and 0 on the others; C the obstacles.
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
    std::array<Point<dim>, dim + 1> gradients;  // of -lambda_i
    gradients[0] = map.inverse_transpose.rowwise().sum();
    for (int i = 0; i < dim; ++i) gradients[i + 1] = -map.inverse_transpose.col(i);
    for (int i = 0; i <= dim; ++i)
      for (int j = 0; j <= dim; ++j)
        add(number[cell_facets[c][i]], number[cell_facets[c][j]], stiffness * gradients[i].dot(gradients[j]),
            volume * (1 - 2.0 * dim / (dim + 1) + mass * (i == j ? 2 : 1)));
  }
  for (const mesh::BoundaryFacet& facet : mesh.boundary())
  {
    if (!problem.boundary(facet.tag).contact) continue;
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

double dot(std::span<const double> x, std::span<const double> y)
{
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
  return sum;
}

/// An approximation of the smallest eigenvalue of A w = lambda M w: the largest of A^{-1} M by Lanczos'
/// method in the inner product of M. Without orthogonalisation: lost orthogonality repeats eigenvalues and
/// does not spoil the extreme ones [Paige80].
double smallest_eigenvalue(const algebra::SparseMatrix& a, const algebra::SparseMatrix& m, int dim)
{
  constexpr int max_steps = 200;
  constexpr double accuracy = 1e-9;
  const algebra::SparseCholesky cholesky(a, dim);
  if (!cholesky.positive_definite()) return 0;
  const auto n = static_cast<std::size_t>(a.size());
  std::vector<double> v(n, 1.0);
  std::vector<double> previous(n, 0.0);
  std::vector<double> mv = m.multiply(v);
  std::vector<double> w(n);
  std::vector<double> diagonal;
  std::vector<double> off_diagonal;  // entry i couples i and i + 1, the last one a step not yet made
  double beta = std::sqrt(dot(v, mv));
  double largest = 0;
  for (int k = 0; k < max_steps; ++k)
  {
    for (std::size_t i = 0; i < n; ++i)
    {
      v[i] /= beta;
      mv[i] /= beta;
    }
    cholesky.solve(mv, w);
    diagonal.push_back(dot(w, mv));
    for (std::size_t i = 0; i < n; ++i) w[i] -= diagonal.back() * v[i] + (k > 0 ? beta : 0) * previous[i];

    const double before = largest;
    largest = tridiagonal_eigenvalues(Eigen::Map<Eigen::VectorXd>(diagonal.data(), k + 1),
                                      Eigen::Map<Eigen::VectorXd>(off_diagonal.data(), k))[k];
    if (k > 1 && largest - before <= accuracy * largest) break;

    std::swap(previous, v);
    std::swap(v, w);
    mv = m.multiply(v);
    beta = std::sqrt(std::max(0.0, dot(v, mv)));
    if (beta <= accuracy * largest) break;  // v spans an invariant space
    off_diagonal.push_back(beta);
  }
  return 1 / largest;
}

/// Rounding in the factors of A - theta M, of the order of eps a_ii on the diagonal, changes the smallest
/// eigenvalue by this part of it, if its vector is spread over the body; times 100, to be sure.
double rounding_of(const Pencil& pencil, double lambda)
{
  double trace = 0;
  double volume = 0;
  for (std::size_t k = 0; k < pencil.m.size(); ++k)
  {
    if (pencil.a.rows[k] == pencil.a.cols[k]) trace += pencil.a.values[k];
    volume += pencil.m[k];
  }
  return 100 * std::numeric_limits<double>::epsilon() * trace / (lambda * volume);
}

/// A theta for which A - theta M is proved to be positive definite, as close below the smallest eigenvalue as
/// possible; 0 if there is none. What the proof needs is the factorisation alone, not the eigenvalue.
double proved_theta(Pencil pencil, int dim)
{
  if (pencil.n == 0) return std::numeric_limits<double>::infinity();  // no function is left
  algebra::SparseMatrix shifted(pencil.n, 1, pencil.a);
  algebra::Triplets mass{pencil.a.rows, pencil.a.cols, pencil.m};
  const double lambda = smallest_eigenvalue(shifted, {pencil.n, 1, std::move(mass)}, dim);
  std::vector<double> values(pencil.m.size());
  for (double shortfall = std::max(1e-6, rounding_of(pencil, lambda)); shortfall < 1; shortfall *= 10)
  {
    const double theta = (1 - shortfall) * lambda;
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = pencil.a.values[k] - theta * pencil.m[k];
    shifted.set_values(values);
    if (algebra::SparseCholesky(shifted, dim).positive_definite()) return theta;
  }
  return 0;
}

/// Facet means of phi with A phi = M 1, roughly: conjugate gradients, preconditioned by the diagonal.
std::vector<double> potential_means(Pencil pencil)
{
  constexpr double tolerance = 1e-4;
  constexpr int max_steps = 5000;
  const auto n = static_cast<std::size_t>(pencil.n);
  std::vector<double> r(n, 0.0);
  for (std::size_t k = 0; k < pencil.m.size(); ++k) r[pencil.a.rows[k]] += pencil.m[k];
  const algebra::SparseMatrix a(pencil.n, 1, std::move(pencil.a));
  const std::vector<double> diagonal = a.diagonal();
  std::vector<double> x(n, 0.0);
  std::vector<double> z(n);
  std::vector<double> p(n, 0.0);
  double first = 0;
  double rz = 0;
  for (int step = 0; step < max_steps; ++step)
  {
    for (std::size_t i = 0; i < n; ++i) z[i] = r[i] / diagonal[i];
    const double before = rz;
    rz = dot(r, z);
    if (step == 0) first = rz;
    if (!(rz > tolerance * tolerance * first)) break;
    for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + (step > 0 ? rz / before : 0) * p[i];
    const std::vector<double> ap = a.multiply(p);
    const double length = rz / dot(p, ap);
    for (std::size_t i = 0; i < n; ++i)
    {
      x[i] += length * p[i];
      r[i] -= length * ap[i];
    }
  }
  std::vector<double> means(pencil.number.size(), 0.0);
  for (std::size_t f = 0; f < means.size(); ++f)
    if (pencil.number[f] >= 0) means[f] = std::max(0.0, x[pencil.number[f]]);
  return means;
}

/// The smallest theta(fixed facets, pencil) of all components. Components that are fixed on the same facets
/// have the same.
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
/// needed: the interpolant I w with the facet means of w has ||w - I w|| <= kappa H ||grad(w - I w)||, grad I
/// w is the cell means of grad w, and ||w||_F^2 >= |F| mean_F(w)^2. Of the gradients there may be no more
/// than w_T.
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

/// What holds the bodies in every component: Gamma_D and obstacles, or only by way of pairs.
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
              of_body[a] || problem.boundary(facet.tag).fixes(a) || problem.boundary(facet.tag).contact;
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
      { return flux_theta<dim>(problem, mesh, fixed, potential_means(std::move(pencil))); });
  return {1 / std::sqrt(theta), theta, 0, mesh.n_cells()};
}

template <int dim>
FriedrichsConstant with_factors(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                Index most_cells, const PairTerms& pairs)
{
  const FriedrichsConstant here = constant_on<dim>(problem, {mesh, 1, pairs});
  if (here.value * here.value <= 2 / here.theta) return here;
  // kappa^2 H^2 > 1/theta: a finer mesh, for the proof alone. The norm keeps the h_F of the given mesh.
  if (mesh::count_after_refinement(mesh, 1).cells > most_cells) return here;
  const mesh::Refined<dim> refined = mesh::refine_uniformly(mesh);
  const PairTerms finer_pairs =
      pairs.cells.empty()
          ? PairTerms{}
          : pair_terms<dim>(refined.mesh, contact::contact_segments(problem, refined.mesh, 1.0), 2);
  const FriedrichsConstant finer = constant_on<dim>(problem, {refined.mesh, 2, finer_pairs});
  return finer.value < here.value ? finer : here;
}

}  // namespace

template <int dim>
FriedrichsConstant friedrichs_constant(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                       Index most_cells_factorised)
{
  const FriedrichsConstant none{std::numeric_limits<double>::infinity(), 0, 0, mesh.n_cells()};
  if (mesh.partition()) return none;
  const std::vector<contact::ContactSegment<dim>> segments = contact::contact_segments(problem, mesh, 1.0);
  const Held bodies = held<dim>(problem, mesh, segments);
  if (bodies == Held::not_all) return none;
  if (bodies == Held::each && mesh.n_cells() > most_cells_factorised) return without_factors(problem, mesh);
  try
  {
    return with_factors(problem, mesh, most_cells_factorised,
                        bodies == Held::with_pairs ? pair_terms<dim>(mesh, segments, 1) : PairTerms{});
  }
  catch (const SolveError&)  // such as memory for the factors: there is a bound without them, but for pairs
  {
    return bodies == Held::each ? without_factors(problem, mesh) : none;
  }
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
