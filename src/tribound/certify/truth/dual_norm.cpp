#include <algorithm>
#include <cassert>
#include <cmath>

#include "tribound/base/norm.h"
#include "tribound/certify/truth/cell_products.h"
#include "tribound/certify/truth/true_error.h"
#include "tribound/contact/nitsche/meridian_cells.h"
#include "tribound/contact/nitsche/part_motions.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/nested.h"

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

/// Adds the entries of a block between free nodes, and all diagonal entries.
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
      n_refinements_(richer.refinements),
      refined_(mesh::refine_uniformly(form.space().mesh(), richer.refinements)),
      space_(refined_.mesh, richer.degree),
      meridian_(contact::meridian_cells(form.problem(), space_)),
      springs_(form.problem(), space_),
      parts_(form.problem(), space_)
{
  assert(richer.degree >= form.space().degree());
  segments_ = refined_segments<dim>(form.space().mesh(), form.segments(), refined_);
  find_operators();
}

template <int dim>
class DualNorm<dim>::SideTables
{
 public:
  SideTables(const fem::LagrangeBasis<dim>& basis, const fem::Quadrature<dim - 1>& rule)
      : basis_(basis), rule_(rule), whole_(fem::tabulate_on_facets<dim>(basis, rule.points))
  {
  }

  /// Valid until the next call with the same `memory`.
  const fem::Tabulation<dim>& operator()(const contact::SegmentSide<dim>& side,
                                         fem::Tabulation<dim>& memory) const
  {
    if (!side.part) return whole_.on_facet[side.facet.local];
    return memory = contact::tabulate<dim>(basis_, side, rule_.points);
  }

 private:
  const fem::LagrangeBasis<dim>& basis_;
  const fem::Quadrature<dim - 1>& rule_;
  fem::FacetTabulation<dim> whole_;
};

template <int dim>
void DualNorm<dim>::find_operators()
{
  const fem::Constraints constraints = fem::dirichlet(form_.problem(), space_);
  for (int a = 0; a < dim; ++a)
  {
    std::vector<char> fixed(space_.n_nodes());
    for (Index i = 0; i < space_.n_nodes(); ++i) fixed[i] = constraints.fixed[dim * i + a];
    const auto known = std::ranges::find(operators_, fixed, &Operator::fixed);
    if (known != operators_.end() && !form_.problem().is_axisymmetric())
      known->components.push_back(a);
    else
      operators_.push_back({std::move(fixed), {a}, nullptr, nullptr});
  }
  const algebra::SolverOptions direct{.method = algebra::LinearMethod::direct,
                                      .package = algebra::DirectPackage::mumps};
  for (Operator& op : operators_)
  {
    op.matrix = std::make_unique<algebra::SparseMatrix>(matrix(op.fixed, op.components.front()));
    op.solver = std::make_unique<algebra::LinearSolver>(direct, std::span<const Point<dim>>(),
                                                        algebra::MatrixKind::positive_definite);
  }
  if (parts_.size() == 0) return;
  const int n_whole = form_.problem().is_axisymmetric() ? dim : 1;
  for (int a = 0; a < n_whole; ++a) whole_.push_back(matrix(std::vector<char>(space_.n_nodes(), 0), a));
}

/// (grad phi_j, grad phi_i) + sum_k (1/h_k) ([phi_j], [phi_i])_k + sum_F (1/h_F) (phi_j, phi_i)_F between
/// free nodes, k the segments and F the facets of the coarse mesh on springs; the diagonal everywhere. Of an
/// axisymmetric problem with the weight r, and the rest of the strain of a component.
template <int dim>
algebra::SparseMatrix DualNorm<dim>::matrix(const std::vector<char>& fixed, int component) const
{
  const int n = space_.basis().n_nodes();
  algebra::Triplets entries;
  entries.reserve(static_cast<std::size_t>(space_.mesh().n_cells()) * n * n);
  std::vector<double> block(static_cast<std::size_t>(n) * n);
  const CellProducts<dim> products(form_.problem(), space_);
  for (Index c = 0; c < space_.mesh().n_cells(); ++c)
  {
    products(c, component, block);
    add_block(space_.cell_nodes(c), fixed, block, entries);
  }

  const int exact = 2 * space_.degree() + (form_.problem().is_axisymmetric() ? 1 : 0);
  const fem::Quadrature<dim - 1> rule = fem::quadrature<dim - 1>(exact);
  const SideTables tables(space_.basis(), rule);
  fem::Tabulation<dim> memory;
  for (const RefinedSegment<dim>& segment : segments_)
  {
    std::vector<Index> nodes;
    Eigen::MatrixXd jumps(rule.size(), 0);  // [phi_i] at the points
    segment.for_each_side(
        [&](const contact::SegmentSide<dim>& side)
        {
          const auto on_side = space_.cell_nodes(side.facet.cell);
          const fem::Tabulation<dim>& table = tables(side, memory);
          const auto first = static_cast<Eigen::Index>(nodes.size());
          nodes.insert(nodes.end(), on_side.begin(), on_side.end());
          jumps.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(nodes.size()));
          for (int q = 0; q < rule.size(); ++q)
            for (int i = 0; i < n; ++i) jumps(q, first + i) = side.sign * table.values_at(q)[i];
        });
    const double scale = segment.det() / form_.segments()[segment.whole].h;
    const auto map = contact::simplex_map(form_.space().mesh(), form_.segments()[segment.whole].slave);
    Eigen::VectorXd weights(rule.size());
    for (int q = 0; q < rule.size(); ++q)
      weights[q] =
          rule.weights[q] * form_.problem().weight(map(fem::point_in<dim - 1>(segment.part, rule.points[q])));
    const Eigen::MatrixXd mass = scale * jumps.transpose() * weights.asDiagonal() * jumps;
    add_block(nodes, fixed, std::span(mass.data(), static_cast<std::size_t>(mass.size())), entries);
  }
  add_springs(fixed, entries);
  return {space_.n_nodes(), 1, std::move(entries)};
}

/// Uniform refinement halves the diameters of facets.
template <int dim>
void DualNorm<dim>::add_springs(const std::vector<char>& fixed, algebra::Triplets& entries) const
{
  const int exact = 2 * space_.degree() + (form_.problem().is_axisymmetric() ? 1 : 0);
  const fem::Quadrature<dim - 1> rule = fem::quadrature<dim - 1>(exact);
  const fem::FacetTabulation<dim> tables = fem::tabulate_on_facets<dim>(space_.basis(), rule.points);
  const auto n = static_cast<std::size_t>(space_.basis().n_nodes());
  std::vector<double> block(n * n);
  for (const mesh::BoundaryFacet& facet : space_.mesh().boundary())
  {
    if (!form_.problem().boundary(facet.tag).spring) continue;
    const double h =
        std::ldexp(mesh::facet_geometry(space_.mesh(), facet.cell, facet.local).diameter, n_refinements_);
    std::ranges::fill(block, 0.0);
    for (const auto& [q, x, dx] : fem::facet_points(space_.mesh(), facet.cell, facet.local, rule))
    {
      const std::span<const double> phi = tables.on_facet[facet.local].values_at(q);
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
          block[i * n + j] += form_.problem().weight(x) * dx / h * phi[i] * phi[j];
    }
    add_block(space_.cell_nodes(facet.cell), fixed, block, entries);
  }
}

/// vector_i += (T(u), [phi_i])_C.
template <int dim>
void DualNorm<dim>::add_contact_load(std::span<const double> u, std::span<double> vector) const
{
  const fem::Quadrature<dim - 1> rule =
      composite_rule<dim - 1>(fem::data_quadrature_degree(space_.degree()), contact_cuts);
  const SideTables tables(space_.basis(), rule);
  const fem::LagrangeBasis<dim>& basis = form_.space().basis();
  fem::Tabulation<dim> memory;
  for (const RefinedSegment<dim>& segment : segments_)
  {
    const contact::ContactSegment<dim>& whole = form_.segments()[segment.whole];
    std::vector<Point<dim - 1>> points;
    for (const Point<dim - 1>& s : rule.points) points.push_back(fem::point_in<dim - 1>(segment.part, s));
    const fem::Tabulation<dim> on_slave = contact::tabulate<dim>(basis, whole.slave, points);
    fem::Tabulation<dim> on_master;
    if (whole.master) on_master = contact::tabulate<dim>(basis, *whole.master, points);
    const auto states =
        form_.contact_states(u, segment.whole, {points, &on_slave, &on_master}, contact::WhichData::given);
    segment.for_each_side(
        [&](const contact::SegmentSide<dim>& side)
        {
          const fem::Tabulation<dim>& table = tables(side, memory);
          for (int q = 0; q < rule.size(); ++q)
            fem::add_at_point<dim>(space_.cell_nodes(side.facet.cell), table.values_at(q),
                                   side.sign * segment.det() * rule.weights[q] *
                                       form_.problem().weight(states[q].point) * states[q].traction,
                                   vector);
        });
  }
}

template <int dim>
std::vector<double> DualNorm<dim>::residual(std::span<const double> u)
{
  constexpr double share = 1e-5;  // of the effect of the data: well below any bound
  if (load_.empty())
  {
    const contact::DiscreteData<dim> data(form_.problem(), refined_.mesh, space_.degree(), {},
                                          {.share = share});
    load_ = contact::assemble_load(data, space_);
    contact::add_initial_stress<dim>(data, space_, load_, meridian_);
    springs_.add_rest(load_);
    parts_.add_load(load_);
  }
  return residual(u, load_);
}

template <int dim>
std::vector<double> DualNorm<dim>::residual(std::span<const double> u, std::span<const double> load) const
{
  std::vector<double> r(load.begin(), load.end());
  const std::vector<double> fine = fem::nested_interpolant<dim>(form_.space(), u, refined_, space_);
  std::vector<double> internal = contact::apply_stiffness<dim>(form_.problem(), space_, fine, meridian_);
  springs_.add_forces(fine, internal);
  for (std::size_t i = 0; i < r.size(); ++i) r[i] -= internal[i];
  add_contact_load(u, r);
  return r;
}

template <int dim>
std::vector<double> DualNorm<dim>::riesz(std::span<const double> functional)
{
  constexpr double tolerance = 1e-12;
  std::vector<double> result(space_.n_dofs(), 0.0);
  std::vector<double> rhs(space_.n_nodes());
  std::vector<double> z(space_.n_nodes());
  for (Operator& op : operators_)
    for (const int a : op.components)
    {
      for (Index i = 0; i < space_.n_nodes(); ++i) rhs[i] = op.fixed[i] ? 0 : functional[dim * i + a];
      if (norm(rhs) == 0) continue;
      std::ranges::fill(z, 0.0);
      op.solver->solve(*op.matrix, rhs, tolerance * norm(rhs), z);
      for (Index i = 0; i < space_.n_nodes(); ++i) result[dim * i + a] = z[i];
    }
  return result;
}

template <int dim>
std::vector<double> DualNorm<dim>::product(std::span<const double> z) const
{
  std::vector<double> result(space_.n_dofs(), 0.0);
  std::vector<double> component(space_.n_nodes());
  for (const Operator& op : operators_)
    for (const int a : op.components)
    {
      for (Index i = 0; i < space_.n_nodes(); ++i) component[i] = z[dim * i + a];
      const algebra::SparseMatrix& of_component =
          whole_.empty() ? *op.matrix : whole_[whole_.size() == 1 ? 0 : a];
      const std::vector<double> az = of_component.multiply(component);
      for (Index i = 0; i < space_.n_nodes(); ++i) result[dim * i + a] = az[i];
    }
  return result;
}

/// With z from an inexact solver, <R, z> / ||z|| is still below the dual norm; ||z|| might not be.
template <int dim>
double DualNorm<dim>::of(std::span<const double> r)
{
  std::vector<double> z = riesz(r);
  if (parts_.size() > 0)
  {
    const auto forces = [this](std::span<const double> w) { return product(w); };
    const auto held = [this](std::span<const double> f) { return riesz(f); };
    contact::move_parts(parts_, contact::part_motions(parts_, forces, held), forces, r, z);
  }
  const std::vector<double> az = product(z);
  double pairing = 0;       // <R, z>
  double norm_squared = 0;  // ||z||_{C,h}^2
  for (std::size_t i = 0; i < z.size(); ++i)
  {
    pairing += r[i] * z[i];
    norm_squared += az[i] * z[i];
  }
  return norm_squared > 0 ? pairing / std::sqrt(norm_squared) : 0;
}

template class DualNorm<2>;
template class DualNorm<3>;

}  // namespace tribound::certify
