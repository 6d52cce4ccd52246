#include "tribound/contact/nitsche/elasticity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "tribound/contact/nitsche/discrete_data.h"
#include "tribound/fem/evaluation.h"
#include "tribound/mesh/geometry.h"

namespace tribound::contact
{

namespace
{

/// The block a(phi_j e_b, phi_i e_a) = lambda S_ab + mu S_ba + mu tr(S) delta_ab, where
/// S = (d_a phi_i, d_b phi_j)_T = det J J^{-T} R_ij J^{-1}, R the products of reference gradients.
template <int dim>
Tensor<dim> stiffness_block(const problem::Material& material, const mesh::CellMap<dim>& map,
                            const Tensor<dim>& reference)
{
  const Tensor<dim> s = map.det * (map.inverse_transpose * reference * map.inverse_transpose.transpose());
  Tensor<dim> block = material.lambda * s + material.mu * s.transpose();
  block.diagonal().array() += material.mu * s.trace();
  return block;
}

/// A node seen from a cell.
struct LocalNode
{
  Index cell;
  int local;
};

/// The cells around each node: those of node i are cells[begin[i]] ... cells[begin[i + 1] - 1].
struct NodeCells
{
  std::vector<Index> begin;
  std::vector<LocalNode> cells;

  [[nodiscard]] std::span<const LocalNode> around(Index node) const
  {
    return std::span(cells).subspan(begin[node], begin[node + 1] - begin[node]);
  }
};

template <int dim>
NodeCells cells_around_nodes(const fem::LagrangeSpace<dim>& space)
{
  const Index n_cells = space.mesh().n_cells();
  NodeCells result{std::vector<Index>(space.n_nodes() + 1, 0), {}};
  for (Index c = 0; c < n_cells; ++c)
    for (const Index node : space.cell_nodes(c)) ++result.begin[node + 1];
  std::partial_sum(result.begin.begin(), result.begin.end(), result.begin.begin());

  std::vector<Index> next(result.begin.begin(), result.begin.end() - 1);
  result.cells.resize(result.begin.back());
  for (Index c = 0; c < n_cells; ++c)
  {
    const std::span<const Index> nodes = space.cell_nodes(c);
    for (std::size_t i = 0; i < nodes.size(); ++i) result.cells[next[nodes[i]]++] = {c, static_cast<int>(i)};
  }
  return result;
}

/// The rows of the stiffness that belong to one node, one block for each node that shares a cell with it.
template <int dim>
class BlockRow
{
 public:
  BlockRow(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space)
      : problem_(&problem),
        space_(&space),
        reference_(fem::gradient_products(space.basis())),
        index_(space.n_nodes(), -1)
  {
  }

  void assemble(std::span<const LocalNode> cells)
  {
    find_neighbours(cells);
    const int n = space_->basis().n_nodes();
    for (const auto& [c, i] : cells)
    {
      const mesh::CellMap<dim> map = mesh::cell_map(space_->mesh(), c);
      const problem::Material& material = problem_->material(space_->mesh().region(c));
      const std::span<const Index> nodes = space_->cell_nodes(c);
      for (int j = 0; j < n; ++j)
        blocks_[index_[nodes[j]]] += stiffness_block(material, map, reference_[i * n + j]);
    }
    for (const Index j : neighbours_) index_[j] = -1;
  }

  /// Nodes in ascending order, and the block of each.
  [[nodiscard]] std::span<const Index> neighbours() const { return neighbours_; }
  [[nodiscard]] std::span<const Tensor<dim>> blocks() const { return blocks_; }

 private:
  void find_neighbours(std::span<const LocalNode> cells)
  {
    neighbours_.clear();
    for (const LocalNode& cell : cells)
      for (const Index j : space_->cell_nodes(cell.cell))
        if (std::exchange(index_[j], 0) < 0) neighbours_.push_back(j);
    std::ranges::sort(neighbours_);
    for (std::size_t k = 0; k < neighbours_.size(); ++k) index_[neighbours_[k]] = static_cast<Index>(k);
    blocks_.assign(neighbours_.size(), Tensor<dim>::Zero());
  }

  const problem::Problem<dim>* problem_;
  const fem::LagrangeSpace<dim>* space_;
  std::vector<Tensor<dim>> reference_;
  std::vector<Index> index_;  ///< per node: its index among the neighbours, or -1
  std::vector<Index> neighbours_;
  std::vector<Tensor<dim>> blocks_;
};

}  // namespace

template <int dim>
algebra::Triplets stiffness(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                            const fem::Constraints& constraints)
{
  const NodeCells cells = cells_around_nodes(space);
  BlockRow<dim> row(problem, space);
  algebra::Triplets entries;
  for (Index i = 0; i < space.n_nodes(); ++i)
  {
    row.assemble(cells.around(i));
    for (int a = 0; a < dim; ++a)
    {
      const Index row_dof = dim * i + a;
      for (std::size_t k = 0; k < row.neighbours().size(); ++k)
        for (int b = 0; b < dim; ++b)
        {
          const Index col_dof = dim * row.neighbours()[k] + b;
          if (row_dof == col_dof || !(constraints.fixed[row_dof] || constraints.fixed[col_dof]))
            entries.add(row_dof, col_dof, row.blocks()[k](a, b));
        }
    }
  }
  return entries;
}

template <int dim>
std::vector<double> apply_stiffness(const problem::Problem<dim>& problem,
                                    const fem::LagrangeSpace<dim>& space, std::span<const double> u)
{
  const mesh::Mesh<dim>& mesh = space.mesh();
  const fem::Quadrature<dim> rule = fem::quadrature<dim>(2 * space.degree() - 2);
  const fem::Tabulation<dim> table = space.basis().tabulate(rule.points);
  std::vector<double> result(space.n_dofs(), 0.0);
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    const mesh::CellMap<dim> map = mesh::cell_map(mesh, c);
    const problem::Material& material = problem.material(mesh.region(c));
    const std::span<const Index> nodes = space.cell_nodes(c);
    for (int q = 0; q < rule.size(); ++q)
    {
      // (sigma(u), grad phi_i)_T, with J^{-1} moved from the test function to sigma
      const auto gradients = table.gradients_at(q);
      const Tensor<dim> stress =
          sigma<dim>(material, fem::gradient_at<dim>(nodes, u, gradients, map.inverse_transpose));
      const Tensor<dim> pulled_back = rule.weights[q] * map.det * (stress * map.inverse_transpose);
      for (int i = 0; i < table.n_nodes; ++i)
      {
        const Point<dim> force = pulled_back * gradients[i];
        for (int a = 0; a < dim; ++a) result[dim * nodes[i] + a] += force[a];
      }
    }
  }
  return result;
}

namespace
{

/// sum_i |u_i| |grad phi_i| at one point of a cell.
template <int dim>
double sum_of_terms(std::span<const Index> nodes, std::span<const double> u,
                    std::span<const Point<dim>> reference_gradients, const Tensor<dim>& inverse_transpose)
{
  double sum = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    sum += Point<dim>(u.data() + static_cast<std::size_t>(dim) * nodes[i]).norm() *
           (inverse_transpose * reference_gradients[i]).norm();
  return sum;
}

/// The norm of 2 mu max |u| / size over the body, mu the smallest and size the distance of two vertices.
template <int dim>
double stress_that_matters(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                           std::span<const double> u)
{
  const mesh::Mesh<dim>& mesh = space.mesh();
  double volume = 0;
  double mu = std::numeric_limits<double>::infinity();
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    volume += mesh::cell_map(mesh, c).measure();
    mu = std::min(mu, problem.material(mesh.region(c)).mu);
  }
  double size = 0;
  for (const Point<dim>& x : mesh.vertices()) size = std::max(size, (x - mesh.vertex(0)).norm());
  double displacement = 0;
  for (std::size_t i = 0; i < u.size(); i += dim)
    displacement = std::max(displacement, Point<dim>(u.data() + i).norm());
  return 2 * mu * displacement / size * std::sqrt(volume);
}

}  // namespace

template <int dim>
StressNorms stress_norms(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                         std::span<const double> u)
{
  const mesh::Mesh<dim>& mesh = space.mesh();
  const fem::Quadrature<dim> rule = fem::quadrature<dim>(2 * space.degree() - 2);
  const fem::Tabulation<dim> table = space.basis().tabulate(rule.points);
  // Rigid motions prescribed to boxes in 2D and 3D, p = 1 ... 4, nu = 0.3 and 0.4999, left a bound of up
  // to 42.
  constexpr double unit_round_offs = 1000;
  constexpr double negligible = 1e-5;
  StressNorms norms;
  double terms_squared = 0;
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    const mesh::CellMap<dim> map = mesh::cell_map(mesh, c);
    const problem::Material& material = problem.material(mesh.region(c));
    const std::span<const Index> nodes = space.cell_nodes(c);
    const double stiffest = 2 * material.mu + dim * material.lambda;
    for (int q = 0; q < rule.size(); ++q)
    {
      const double weight = rule.weights[q] * map.det;
      const auto gradients = table.gradients_at(q);
      const Tensor<dim> gradient = fem::gradient_at<dim>(nodes, u, gradients, map.inverse_transpose);
      const Tensor<dim> stress = sigma<dim>(material, gradient);
      norms.energy += weight * stress.cwiseProduct(gradient).sum();
      norms.sigma += weight * stress.squaredNorm();
      terms_squared +=
          weight * std::pow(stiffest * sum_of_terms<dim>(nodes, u, gradients, map.inverse_transpose), 2);
    }
  }
  norms.sigma = std::sqrt(norms.sigma);
  const double round_off =
      unit_round_offs * std::numeric_limits<double>::epsilon() * std::sqrt(terms_squared);
  const auto is_loaded = [&]
  {
    const std::vector<double> load =
        assemble_load<dim>(DiscreteData<dim>(problem, mesh, space.degree(), 1.0), space);
    return std::ranges::any_of(load, [](double force) { return force != 0; });
  };
  if (norms.sigma <= round_off && round_off <= negligible * stress_that_matters(problem, space, u) &&
      !is_loaded())
    norms.round_off = round_off;
  return norms;
}

template <int dim>
std::vector<double> assemble_load(const DiscreteData<dim>& data, const fem::LagrangeSpace<dim>& space)
{
  const mesh::Mesh<dim>& mesh = space.mesh();
  std::vector<double> load(space.n_dofs(), 0.0);

  // (f, phi_i)
  const fem::Quadrature<dim>& cell_rule = data.cell_rule();
  const fem::Tabulation<dim> cell_table = space.basis().tabulate(cell_rule.points);
  std::vector<Point<dim>> f(cell_rule.size());
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    if (!data.has_body_force(c)) continue;
    data.body_force(c, f);
    for (const auto& [q, x, dx] : fem::cell_points(mesh::cell_map(mesh, c), cell_rule))
      fem::add_at_point<dim>(space.cell_nodes(c), cell_table.values_at(q), dx * f[q], load);
  }

  // (g_N, phi_i)_N
  const fem::Quadrature<dim - 1>& facet_rule = data.facet_rule();
  const fem::FacetTabulation<dim> facet_table =
      fem::tabulate_on_facets<dim>(space.basis(), facet_rule.points);
  std::vector<Point<dim>> g(facet_rule.size());
  for (std::size_t k = 0; k < mesh.boundary().size(); ++k)
  {
    if (!data.has_traction(k)) continue;
    const mesh::BoundaryFacet& facet = mesh.boundary()[k];
    data.traction(k, g);
    for (const auto& [q, x, dx] : fem::facet_points(mesh, facet.cell, facet.local, facet_rule))
      fem::add_at_point<dim>(space.cell_nodes(facet.cell), facet_table.on_facet[facet.local].values_at(q),
                             dx * g[q], load);
  }
  return load;
}

template algebra::Triplets stiffness(const problem::Problem<2>&, const fem::LagrangeSpace<2>&,
                                     const fem::Constraints&);
template algebra::Triplets stiffness(const problem::Problem<3>&, const fem::LagrangeSpace<3>&,
                                     const fem::Constraints&);
template std::vector<double> apply_stiffness(const problem::Problem<2>&, const fem::LagrangeSpace<2>&,
                                             std::span<const double>);
template std::vector<double> apply_stiffness(const problem::Problem<3>&, const fem::LagrangeSpace<3>&,
                                             std::span<const double>);
template StressNorms stress_norms(const problem::Problem<2>&, const fem::LagrangeSpace<2>&,
                                  std::span<const double>);
template StressNorms stress_norms(const problem::Problem<3>&, const fem::LagrangeSpace<3>&,
                                  std::span<const double>);
template std::vector<double> assemble_load(const DiscreteData<2>&, const fem::LagrangeSpace<2>&);
template std::vector<double> assemble_load(const DiscreteData<3>&, const fem::LagrangeSpace<3>&);

}  // namespace tribound::contact
