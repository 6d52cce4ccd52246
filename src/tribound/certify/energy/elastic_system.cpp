#include "tribound/certify/energy/elastic_system.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "tribound/algebra/petsc.h"
#include "tribound/contact/nitsche/elasticity.h"

namespace tribound::certify
{

template <int dim>
struct ElasticSystem<dim>::Factors
{
  std::optional<algebra::SparseMatrix> springs;
  algebra::SparseMatrix matrix;
  algebra::LinearSolver linear;
};

namespace
{

/// A spring at each degree of freedom that is given as a row, as stiff as the body there. There are as many
/// springs as free motions to stop: if the load does no work in these, no spring does.
template <int dim>
void add_springs(algebra::SparseRows& rows, const fem::LagrangeSpace<dim>& space,
                 std::span<const Index> supports)
{
  for (const Index row : supports)
  {
    const Index column = dim * space.owned_node(row / dim) + row % dim;
    const auto first = rows.columns.begin() + rows.begin[row];
    const auto found = std::lower_bound(first, rows.columns.begin() + rows.begin[row + 1], column);
    rows.values[found - rows.columns.begin()] *= 2;
  }
}

template <int dim>
algebra::SparseMatrix matrix_of(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                                const contact::Springs<dim>& elastic, const std::vector<char>& fixed,
                                const std::optional<algebra::SparseMatrix>& springs,
                                std::span<const Index> supports)
{
  const fem::Constraints constraints{.fixed = fixed, .values = std::vector<double>(fixed.size(), 0.0)};
  algebra::SparseRows rows = contact::stiffness(problem, space, constraints, &elastic);
  add_springs<dim>(rows, space, supports);
  algebra::SparseMatrix stiffness(dim, std::move(rows), space.numbers());
  return springs ? algebra::SparseMatrix::sum(stiffness, *springs) : std::move(stiffness);
}

}  // namespace

template <int dim>
ElasticSystem<dim>::ElasticSystem(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                                  std::vector<char> fixed, const algebra::SolverOptions& solver,
                                  algebra::Triplets springs, std::span<const Index> supports)
    : problem_(problem),
      space_(space),
      elastic_(problem, space),
      parts_(problem, space),
      fixed_(std::move(fixed))
{
  std::optional<algebra::SparseMatrix> added;
  if (space.mesh().ranks().any(!springs.rows.empty()))
    added.emplace(space.n_dofs(), dim, std::move(springs), space.numbers());
  algebra::SparseMatrix matrix = matrix_of(problem, space, elastic_, fixed_, added, supports);
  factors_ = std::make_unique<Factors>(
      Factors{std::move(added), std::move(matrix),
              algebra::LinearSolver(solver, space, algebra::MatrixKind::positive_definite)});
}

template <int dim>
ElasticSystem<dim>::~ElasticSystem() = default;

template <int dim>
std::vector<double> ElasticSystem<dim>::internal_forces(std::span<const double> u) const
{
  std::vector<double> internal = contact::apply_stiffness(problem_, space_, u);
  elastic_.add_forces(u, internal);
  if (factors_->springs)
  {
    const std::vector<double> of_springs = factors_->springs->multiply(u);
    for (std::size_t i = 0; i < internal.size(); ++i) internal[i] += of_springs[i];
  }
  return internal;
}

template <int dim>
void ElasticSystem<dim>::release(std::span<double> vector) const
{
  for (std::size_t i = 0; i < vector.size(); ++i)
    if (fixed_[i] != 0) vector[i] = 0;
}

template <int dim>
std::vector<double> ElasticSystem<dim>::solve(std::span<const double> b, std::span<const double> start,
                                              double tolerance) const
{
  const std::vector<double> internal = internal_forces(start);
  const double scale = space_.norm(b) + space_.norm(internal);
  std::vector<double> r(b.begin(), b.end());
  for (std::size_t i = 0; i < r.size(); ++i) r[i] -= internal[i];
  release(r);
  std::vector<double> u(r.size(), 0.0);
  (void)factors_->linear.solve(factors_->matrix, r, tolerance * scale, u);
  release(u);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] += start[i];
  if (parts_.size() > 0) move_parts(b, u);
  return u;
}

/// Moves the parts, and all else with them, so that the forces on them are those of b up to rounding.
template <int dim>
void ElasticSystem<dim>::move_parts(std::span<const double> b, std::span<double> u) const
{
  constexpr double tight = 1e-13;  // of the forces that a motion of a part causes
  const auto held = [&](std::vector<double> r)
  {
    release(r);
    std::vector<double> others(r.size(), 0.0);
    (void)factors_->linear.solve(factors_->matrix, r, tight * space_.norm(r), others);
    release(others);
    return others;
  };
  const auto forces = [this](std::span<const double> w) { return internal_forces(w); };
  if (motions_.empty()) motions_ = contact::part_motions(parts_, forces, held);
  contact::move_parts(parts_, motions_, forces, b, u);
}

template class ElasticSystem<2>;
template class ElasticSystem<3>;

}  // namespace tribound::certify
