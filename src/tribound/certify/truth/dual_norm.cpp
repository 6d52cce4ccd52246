#include <algorithm>
#include <cassert>
#include <cmath>

#include "tribound/base/error.h"
#include "tribound/certify/truth/true_error.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/nested.h"
#include "tribound/fem/polynomials.h"

namespace tribound::certify
{

namespace
{

/// Parts per direction into which a contact facet of the refined mesh is cut for the integrals of T(u).
constexpr int contact_cuts = 4;

/// The rule of the given degree on each of the cuts^k equal parts of the reference simplex, k = 1, 2.
template <int k>
fem::Quadrature<k> composite_rule(int degree, int cuts)
{
  const fem::Quadrature<k> rule = fem::quadrature<k>(degree);
  fem::Quadrature<k> composite;
  const auto add = [&](const Point<k>& corner, double size)  // size < 0: turned by 180 degrees
  {
    for (int q = 0; q < rule.size(); ++q)
    {
      composite.points.push_back(corner + size * rule.points[q]);
      composite.weights.push_back(std::pow(std::abs(size), k) * rule.weights[q]);
    }
  };
  const double size = 1.0 / cuts;
  if constexpr (k == 1)
    for (int i = 0; i < cuts; ++i) add(Point<1>(i * size), size);
  else
    for (int i = 0; i < cuts; ++i)
      for (int j = 0; i + j < cuts; ++j)
      {
        add({i * size, j * size}, size);
        if (i + j < cuts - 1) add({(i + 1) * size, (j + 1) * size}, -size);
      }
  return composite;
}

/// (phi_j, phi_i) on the reference facet, for each local facet: [i * n + j].
template <int dim>
std::array<std::vector<double>, dim + 1> reference_facet_masses(const fem::LagrangeBasis<dim>& basis)
{
  const fem::Quadrature<dim - 1> rule = fem::quadrature<dim - 1>(2 * basis.degree());
  const fem::FacetTabulation<dim> table = fem::tabulate_on_facets<dim>(basis, rule.points);
  const int n = basis.n_nodes();
  std::array<std::vector<double>, dim + 1> masses;
  for (int facet = 0; facet <= dim; ++facet)
  {
    masses[facet].assign(static_cast<std::size_t>(n) * n, 0.0);
    for (int q = 0; q < rule.size(); ++q)
    {
      const auto values = table.on_facet[facet].values_at(q);
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) masses[facet][i * n + j] += rule.weights[q] * values[i] * values[j];
    }
  }
  return masses;
}

/// Adds the entries of a cell that lie between free nodes, and all diagonal ones.
void add_block(std::span<const Index> nodes, const std::vector<char>& fixed, std::span<const double> block,
               algebra::Triplets& entries)
{
  const std::size_t n = nodes.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      if (i == j || !(fixed[nodes[i]] || fixed[nodes[j]])) entries.add(nodes[i], nodes[j], block[i * n + j]);
}

}  // namespace

template <int dim>
DualNorm<dim>::DualNorm(const contact::NitscheForm<dim>& form, const RicherSpace& richer)
    : form_(form),
      refined_(mesh::refine_uniformly(form.space().mesh(), richer.refinements)),
      space_(refined_.mesh, richer.degree)
{
  assert(richer.degree >= form.space().degree());
  if (!std::ranges::all_of(form.segments(), &contact::ContactSegment<dim>::is_obstacle_facet))
    throw InputError({}, "the dual norm of the residual is not known for contact between bodies",
                     "take contact with rigid obstacles");
  find_contact_parts();
  find_operators();
}

/// A facet of the refined mesh lies on the facet of its ancestor on which its centre does.
template <int dim>
void DualNorm<dim>::find_contact_parts()
{
  const mesh::Mesh<dim>& mesh = form_.space().mesh();
  std::vector<std::array<int, dim + 1>> whole(mesh.n_cells());  // number of the contact facet, or -1
  for (auto& facets : whole) facets.fill(-1);
  for (std::size_t k = 0; k < form_.segments().size(); ++k)
  {
    const mesh::BoundaryFacet& facet = form_.segments()[k].slave.facet;
    whole[facet.cell][facet.local] = static_cast<int>(k);
  }
  for (const mesh::BoundaryFacet& facet : refined_.mesh.boundary())
  {
    if (!form_.problem().boundary(facet.tag).contact) continue;
    const Point<dim> centre =
        mesh::facet_map(refined_.mesh, facet.cell, facet.local)(Point<dim - 1>::Constant(1.0 / dim));
    const Index ancestor = refined_.ancestor(facet.cell);
    const auto lambda = fem::barycentric<dim>(fem::reference_point(mesh::cell_map(mesh, ancestor), centre));
    const auto local = std::ranges::min_element(lambda) - lambda.begin();
    assert(whole[ancestor][local] >= 0);
    contact_parts_.push_back({facet, whole[ancestor][local]});
  }
}

template <int dim>
void DualNorm<dim>::find_operators()
{
  const fem::Constraints constraints = fem::dirichlet(form_.problem(), space_);
  for (int a = 0; a < dim; ++a)
  {
    std::vector<char> fixed(space_.n_nodes());
    for (Index i = 0; i < space_.n_nodes(); ++i) fixed[i] = constraints.fixed[dim * i + a];
    const auto known = std::ranges::find(operators_, fixed, &Operator::fixed);
    if (known != operators_.end())
      known->components.push_back(a);
    else
      operators_.push_back({std::move(fixed), {a}, nullptr, nullptr});
  }
  const algebra::SolverOptions direct{.method = algebra::LinearMethod::direct,
                                      .package = algebra::DirectPackage::mumps};
  for (Operator& op : operators_)
  {
    op.matrix = std::make_unique<algebra::SparseMatrix>(matrix(op.fixed));
    op.solver = std::make_unique<algebra::LinearSolver>(direct, std::span<const Point<dim>>(),
                                                        algebra::MatrixKind::positive_definite);
  }
}

/// (grad phi_j, grad phi_i) + sum_{F in C} (1/h_F) (phi_j, phi_i)_F between free nodes; the diagonal
/// everywhere.
template <int dim>
algebra::SparseMatrix DualNorm<dim>::matrix(const std::vector<char>& fixed) const
{
  const int n = space_.basis().n_nodes();
  algebra::Triplets entries;
  entries.reserve(static_cast<std::size_t>(space_.mesh().n_cells()) * n * n);
  std::vector<double> block(static_cast<std::size_t>(n) * n);
  const std::vector<Tensor<dim>> reference = fem::gradient_products(space_.basis());
  for (Index c = 0; c < space_.mesh().n_cells(); ++c)
  {
    const mesh::CellMap<dim> map = mesh::cell_map(space_.mesh(), c);
    const Tensor<dim> metric = map.det * (map.inverse_transpose.transpose() * map.inverse_transpose);
    for (std::size_t k = 0; k < block.size(); ++k) block[k] = metric.cwiseProduct(reference[k]).sum();
    add_block(space_.cell_nodes(c), fixed, block, entries);
  }

  const auto masses = reference_facet_masses(space_.basis());
  for (const auto& [facet, whole] : contact_parts_)
  {
    const double area = mesh::facet_geometry(space_.mesh(), facet.cell, facet.local).det();
    const double h_F = form_.segments()[whole].h;
    for (std::size_t k = 0; k < block.size(); ++k) block[k] = area / h_F * masses[facet.local][k];
    add_block(space_.cell_nodes(facet.cell), fixed, block, entries);
  }
  return {space_.n_nodes(), 1, std::move(entries)};
}

/// vector_i += (T(u), phi_i)_C.
template <int dim>
void DualNorm<dim>::add_contact_load(std::span<const double> u, std::span<double> vector) const
{
  const fem::Quadrature<dim - 1> rule =
      composite_rule<dim - 1>(fem::data_quadrature_degree(space_.degree()), contact_cuts);
  const fem::FacetTabulation<dim> values = fem::tabulate_on_facets<dim>(space_.basis(), rule.points);
  for (const auto& [facet, whole] : contact_parts_)
  {
    const mesh::BoundaryFacet& ancestor = form_.segments()[whole].slave.facet;
    const mesh::CellMap<dim> ancestor_map = mesh::cell_map(form_.space().mesh(), ancestor.cell);
    const auto points = fem::facet_points(refined_.mesh, facet.cell, facet.local, rule);
    std::vector<Point<dim>> in_ancestor;
    std::vector<Point<dim - 1>> on_ancestor;
    for (const auto& [q, x, dx] : points)
    {
      in_ancestor.push_back(fem::reference_point(ancestor_map, x));
      on_ancestor.push_back(mesh::cell_to_facet<dim>(ancestor.local, in_ancestor.back()));
    }
    const fem::Tabulation<dim> table = form_.space().basis().tabulate(in_ancestor);
    const auto states = form_.contact_states(u, whole, {on_ancestor, &table});
    for (const auto& [q, x, dx] : points)
      fem::add_at_point<dim>(space_.cell_nodes(facet.cell), values.on_facet[facet.local].values_at(q),
                             dx * states[q].traction, vector);
  }
}

template <int dim>
std::vector<double> DualNorm<dim>::residual(std::span<const double> u)
{
  constexpr double share = 1e-5;  // of the effect of the data: well below any bound
  if (load_.empty())
    load_ = contact::assemble_load(
        contact::DiscreteData<dim>(form_.problem(), refined_.mesh, space_.degree(), {}, {.share = share}),
        space_);
  return residual(u, load_);
}

template <int dim>
std::vector<double> DualNorm<dim>::residual(std::span<const double> u, std::span<const double> load) const
{
  std::vector<double> r(load.begin(), load.end());
  const std::vector<double> internal = contact::apply_stiffness<dim>(
      form_.problem(), space_, fem::nested_interpolant<dim>(form_.space(), u, refined_, space_));
  for (std::size_t i = 0; i < r.size(); ++i) r[i] -= internal[i];
  add_contact_load(u, r);
  return r;
}

/// With z from an inexact solver <R, z> / ||z|| is still below the dual norm, ||z|| might not be.
template <int dim>
double DualNorm<dim>::of(std::span<const double> r)
{
  constexpr double tolerance = 1e-12;
  double pairing = 0;       // <R, z>
  double norm_squared = 0;  // ||z||_{C,h}^2
  std::vector<double> rhs(space_.n_nodes());
  std::vector<double> z(space_.n_nodes());
  for (Operator& op : operators_)
    for (const int a : op.components)
    {
      double rhs_squared = 0;
      for (Index i = 0; i < space_.n_nodes(); ++i)
      {
        rhs[i] = op.fixed[i] ? 0 : r[dim * i + a];
        rhs_squared += rhs[i] * rhs[i];
      }
      if (rhs_squared == 0) continue;
      std::ranges::fill(z, 0.0);
      op.solver->solve(*op.matrix, rhs, tolerance * std::sqrt(rhs_squared), z);
      const std::vector<double> az = op.matrix->multiply(z);
      for (Index i = 0; i < space_.n_nodes(); ++i)
      {
        pairing += rhs[i] * z[i];
        norm_squared += az[i] * z[i];
      }
    }
  return norm_squared > 0 ? pairing / std::sqrt(norm_squared) : 0;
}

template class DualNorm<2>;
template class DualNorm<3>;

}  // namespace tribound::certify
