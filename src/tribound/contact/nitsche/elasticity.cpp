#include "tribound/contact/nitsche/elasticity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "tribound/base/parallel.h"
#include "tribound/contact/nitsche/discrete_data.h"
#include "tribound/contact/nitsche/meridian_cells.h"
#include "tribound/fem/evaluation.h"
#include "tribound/fem/polynomials.h"
#include "tribound/mesh/geometry.h"
#include "tribound/problem/weights.h"

namespace tribound::contact
{

namespace
{

template <int dim>
bool vanishes(std::span<const Index> nodes, std::span<const double> u)
{
  return std::ranges::all_of(nodes,
                             [&](Index node)
                             {
                               for (int a = 0; a < dim; ++a)
                                 if (u[dim * node + a] != 0) return false;
                               return true;
                             });
}

}  // namespace

template <int dim>
std::vector<double> apply_stiffness(const problem::Problem<dim>& problem,
                                    const fem::LagrangeSpace<dim>& space, std::span<const double> u,
                                    const std::shared_ptr<const MeridianCells>& known)
{
  const mesh::Mesh<dim>& mesh = space.mesh();
  const fem::Quadrature<dim> rule = fem::quadrature<dim>(2 * space.degree() - 2);
  const fem::Tabulation<dim> table = space.basis().tabulate(rule.points);
  const std::shared_ptr<const MeridianCells> meridian = known ? known : meridian_cells(problem, space);
  std::vector<double> result(space.n_dofs(), 0.0);
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    const mesh::CellMap<dim> map = mesh::cell_map(mesh, c);
    const problem::Material& material = problem.material(mesh.region(c));
    const std::span<const Index> nodes = space.cell_nodes(c);
    if (vanishes<dim>(nodes, u)) continue;  // most cells, if u is only the prescribed displacement
    if (meridian)
    {
      meridian->add_forces(c, u, result);
      continue;
    }
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

/// The norm of 2 mu max |u| / size over the body, with mu the smallest shear modulus and size that of the
/// bounding box.
template <int dim>
double stress_that_matters(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                           std::span<const double> u)
{
  const mesh::Mesh<dim>& mesh = space.mesh();
  double volume = 0;
  std::array<double, 2> largest{-std::numeric_limits<double>::infinity(), 0};
  auto& [minus_mu, displacement] = largest;
  for (Index c = 0; c < mesh.n_owned_cells(); ++c)
  {
    volume += mesh::cell_map(mesh, c).measure() *
              problem::mean_weight<dim>(problem, mesh::points_of(mesh.vertices(), mesh.cell(c)));
    minus_mu = std::max(minus_mu, -problem.material(mesh.region(c)).mu);
  }
  for (std::size_t i = 0; i < u.size(); i += dim)
    displacement = std::max(displacement, Point<dim>(u.data() + i).norm());
  mesh.ranks().max(std::span(largest));
  return -2 * minus_mu * displacement / mesh::box_around(mesh).diagonal() *
         std::sqrt(mesh.ranks().sum(volume));
}

}  // namespace

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
      fem::add_at_point<dim>(space.cell_nodes(c), cell_table.values_at(q),
                             dx * data.problem().weight(x) * f[q], load);
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
                             dx * data.problem().weight(x) * g[q], load);
  }

  return load;
}

template <int dim>
StressNorms stress_norms(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                         std::span<const double> u, const DiscreteData<dim>* data,
                         const std::shared_ptr<const MeridianCells>& known)
{
  const mesh::Mesh<dim>& mesh = space.mesh();
  std::optional<DiscreteData<dim>> made;
  const auto make_data = [&]
  {
    if (data == nullptr)
      data = &made.emplace(problem, mesh, space.degree(), std::span<const ContactSegment<dim>>{});
  };
  const bool is_stressed = problem.has_initial_stress();
  const fem::Quadrature<dim> rule = fem::quadrature<dim>(
      is_stressed ? fem::data_quadrature_degree(space.degree()) : 2 * space.degree() - 2);
  const fem::Tabulation<dim> table = space.basis().tabulate(rule.points);
  if (is_stressed) make_data();
  std::vector<double> theta(fem::polynomial_dimension(dim, space.degree() + 1) * rule.size());
  const std::size_t n_theta = theta.size() / rule.size();
  for (int q = 0; q < rule.size(); ++q)
    fem::orthonormal_values<dim>(space.degree() + 1, rule.points[q],
                                 std::span(theta).subspan(q * n_theta, n_theta));
  // For rigid motions prescribed to boxes in 2D and 3D, p = 1 ... 4, nu = 0.3 and 0.4999, the bound was up to
  // 42.
  constexpr double unit_round_offs = 1000;
  constexpr double negligible = 1e-5;
  const std::shared_ptr<const MeridianCells> meridian = known ? known : meridian_cells(problem, space);
  const auto of_cell = [&](std::size_t c)
  {
    if (meridian)
    {
      if constexpr (dim == 2)
      {
        const auto [energy, sigma_squared, terms] =
            meridian->squares(static_cast<Index>(c), u, is_stressed ? &data->initial_stress() : nullptr);
        return Eigen::Array3d(energy, sigma_squared, terms);
      }
    }
    const mesh::CellMap<dim> map = mesh::cell_map(mesh, static_cast<Index>(c));
    const problem::Material& material = problem.material(mesh.region(static_cast<Index>(c)));
    std::span<const Tensor<dim>> projected;  // of sigma_0
    if (is_stressed) projected = data->initial_stress().coefficients(static_cast<Index>(c));
    const std::span<const Index> nodes = space.cell_nodes(static_cast<Index>(c));
    const double stiffest = 2 * material.mu + dim * material.lambda;
    Eigen::Array3d sums = Eigen::Array3d::Zero();
    for (int q = 0; q < rule.size(); ++q)
    {
      const auto gradients = table.gradients_at(q);
      const Tensor<dim> gradient = fem::gradient_at<dim>(nodes, u, gradients, map.inverse_transpose);
      const Tensor<dim> stress = sigma<dim>(material, gradient);
      Tensor<dim> initial = Tensor<dim>::Zero();
      for (std::size_t j = 0; j < projected.size(); ++j) initial += theta[q * n_theta + j] * projected[j];
      const double terms =
          stiffest * sum_of_terms<dim>(nodes, u, gradients, map.inverse_transpose) + initial.norm();
      sums += rule.weights[q] * map.det *
              Eigen::Array3d(stress.cwiseProduct(gradient).sum(), (stress + initial).squaredNorm(),
                             terms * terms);
    }
    return sums;
  };
  Eigen::Array3d sums = parallel_sum<Eigen::Array3d>(mesh.n_owned_cells(), Eigen::Array3d::Zero(), of_cell);
  mesh.ranks().sum(std::span(sums.data(), sums.size()));
  StressNorms norms{.energy = sums[0], .sigma = std::sqrt(sums[1])};
  const double round_off = unit_round_offs * std::numeric_limits<double>::epsilon() * std::sqrt(sums[2]);
  const auto is_loaded = [&]
  {
    make_data();
    const std::vector<double> load = assemble_load<dim>(*data, space);
    return mesh.ranks().any(std::ranges::any_of(load, [](double force) { return force != 0; }));
  };
  if (norms.sigma <= round_off && round_off <= negligible * stress_that_matters(problem, space, u) &&
      !is_loaded())
    norms.round_off = round_off;
  return norms;
}

template <int dim>
std::vector<double> cell_energies(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                                  std::span<const double> u,
                                  const std::shared_ptr<const MeridianCells>& known)
{
  const mesh::Mesh<dim>& mesh = space.mesh();
  const fem::Quadrature<dim> rule = fem::quadrature<dim>(2 * space.degree() - 2);
  const fem::Tabulation<dim> table = space.basis().tabulate(rule.points);
  const std::shared_ptr<const MeridianCells> meridian = known ? known : meridian_cells(problem, space);
  std::vector<double> energies(mesh.n_owned_cells(), 0.0);
  parallel_for(energies.size(),
               [&](std::size_t c)
               {
                 const auto cell = static_cast<Index>(c);
                 if (meridian)
                 {
                   energies[c] = meridian->squares(cell, u).energy;
                   return;
                 }
                 const mesh::CellMap<dim> map = mesh::cell_map(mesh, cell);
                 for (int q = 0; q < rule.size(); ++q)
                 {
                   const Tensor<dim> gradient = fem::gradient_at<dim>(
                       space.cell_nodes(cell), u, table.gradients_at(q), map.inverse_transpose);
                   energies[c] +=
                       rule.weights[q] * map.det *
                       sigma<dim>(problem.material(mesh.region(cell)), gradient).cwiseProduct(gradient).sum();
                 }
               });
  return energies;
}

/// Only Pi^{p-1} sigma_0 counts, since grad phi is in P^{p-1}.
template <int dim>
void add_initial_stress(const DiscreteData<dim>& data, const fem::LagrangeSpace<dim>& space,
                        std::span<double> vector, const std::shared_ptr<const MeridianCells>& known)
{
  if (!data.problem().has_initial_stress()) return;
  const mesh::Mesh<dim>& mesh = space.mesh();
  if constexpr (dim == 2)
    if (const auto meridian = known ? known : meridian_cells(data.problem(), space))
    {
      for (Index c = 0; c < mesh.n_cells(); ++c)
        if (data.initial_stress().acts_on(c)) meridian->add_initial_forces(c, data.initial_stress(), vector);
      return;
    }
  const int degree = space.degree() - 1;
  const fem::Quadrature<dim> rule = fem::quadrature<dim>(2 * degree);
  const fem::Tabulation<dim> table = space.basis().tabulate(rule.points);
  std::vector<double> theta(fem::polynomial_dimension(dim, degree));
  for (Index c = 0; c < mesh.n_cells(); ++c)
  {
    const std::span<const Tensor<dim>> coefficients = data.initial_stress().coefficients(c);
    if (coefficients.empty()) continue;
    const std::span<const Tensor<dim>> used = coefficients.first(std::min(theta.size(), coefficients.size()));
    const mesh::CellMap<dim> map = mesh::cell_map(mesh, c);
    const std::span<const Index> nodes = space.cell_nodes(c);
    for (int q = 0; q < rule.size(); ++q)
    {
      fem::orthonormal_values<dim>(degree, rule.points[q], theta);
      Tensor<dim> stress = Tensor<dim>::Zero();
      for (std::size_t j = 0; j < used.size(); ++j) stress += theta[j] * used[j];
      stress = (rule.weights[q] * map.det) * stress * map.inverse_transpose;
      for (std::size_t i = 0; i < nodes.size(); ++i)
        Eigen::Map<Point<dim>>(&vector[static_cast<std::size_t>(dim) * nodes[i]]) -=
            stress * table.gradients_at(q)[i];
    }
  }
}

template std::vector<double> apply_stiffness(const problem::Problem<2>&, const fem::LagrangeSpace<2>&,
                                             std::span<const double>,
                                             const std::shared_ptr<const MeridianCells>&);
template std::vector<double> apply_stiffness(const problem::Problem<3>&, const fem::LagrangeSpace<3>&,
                                             std::span<const double>,
                                             const std::shared_ptr<const MeridianCells>&);
template StressNorms stress_norms(const problem::Problem<2>&, const fem::LagrangeSpace<2>&,
                                  std::span<const double>, const DiscreteData<2>*,
                                  const std::shared_ptr<const MeridianCells>&);
template StressNorms stress_norms(const problem::Problem<3>&, const fem::LagrangeSpace<3>&,
                                  std::span<const double>, const DiscreteData<3>*,
                                  const std::shared_ptr<const MeridianCells>&);
template std::vector<double> cell_energies(const problem::Problem<2>&, const fem::LagrangeSpace<2>&,
                                           std::span<const double>,
                                           const std::shared_ptr<const MeridianCells>&);
template std::vector<double> cell_energies(const problem::Problem<3>&, const fem::LagrangeSpace<3>&,
                                           std::span<const double>,
                                           const std::shared_ptr<const MeridianCells>&);
template void add_initial_stress(const DiscreteData<2>&, const fem::LagrangeSpace<2>&, std::span<double>,
                                 const std::shared_ptr<const MeridianCells>&);
template void add_initial_stress(const DiscreteData<3>&, const fem::LagrangeSpace<3>&, std::span<double>,
                                 const std::shared_ptr<const MeridianCells>&);
template std::vector<double> assemble_load(const DiscreteData<2>&, const fem::LagrangeSpace<2>&);
template std::vector<double> assemble_load(const DiscreteData<3>&, const fem::LagrangeSpace<3>&);

}  // namespace tribound::contact
