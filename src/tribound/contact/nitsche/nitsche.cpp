#include "tribound/contact/nitsche/nitsche.h"

#include <algorithm>
#include <cassert>

#include "tribound/contact/nitsche/penalty.h"
#include "tribound/contact/nitsche/traction.h"

namespace tribound::contact
{

namespace
{

/// Column (j, b) is sigma(phi_j e_b) n - gamma phi_j e_b.
template <int dim>
Tensor<dim> augmented_block(const problem::Material& material, double gamma, const Point<dim>& n,
                            double value, const Point<dim>& gradient)
{
  Tensor<dim> block = material.lambda * n * gradient.transpose() + material.mu * gradient * n.transpose();
  block.diagonal().array() += material.mu * gradient.dot(n) - gamma * value;
  return block;
}

}  // namespace

template <int dim>
NitscheForm<dim>::NitscheForm(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                              double gamma0, const DataAccuracy& accuracy)
    : problem_(&problem),
      space_(&space),
      gamma0_(gamma0),
      constraints_(fem::dirichlet(problem, space)),
      data_(problem, space.mesh(), space.degree(), gamma0, accuracy),
      load_(assemble_load(data_, space)),
      facet_rule_(data_.facet_rule()),
      facet_table_(fem::tabulate_on_facets<dim>(space.basis(), facet_rule_.points))
{
  const mesh::Mesh<dim>& mesh = space.mesh();
  std::vector<double> gap(facet_rule_.size());
  std::vector<double> strength(facet_rule_.size());
  for (std::size_t number = 0; number < mesh.boundary().size(); ++number)
  {
    const mesh::BoundaryFacet& facet = mesh.boundary()[number];
    const auto& contact = problem.boundary(facet.tag).contact;
    if (!contact) continue;
    const problem::Material& material = problem.material(mesh.region(facet.cell));
    const mesh::FacetGeometry<dim> geometry = mesh::facet_geometry(mesh, facet.cell, facet.local);
    const double gamma = gamma0 * penalty_modulus(material) / geometry.diameter;
    contact_facets_.push_back({facet, geometry, gamma, &*contact, number});
    data_.contact(number, gap, strength);
    gap_.insert(gap_.end(), gap.begin(), gap.end());
    strength_.insert(strength_.end(), strength.begin(), strength.end());
  }
}

template <int dim>
Tensor<dim> NitscheForm<dim>::inverse_transpose(std::size_t k) const
{
  return mesh::cell_map(space_->mesh(), contact_facets_[k].facet.cell).inverse_transpose;
}

template <int dim>
Point<dim> NitscheForm<dim>::augmented_traction(std::span<const double> u, std::size_t k, int q,
                                                const Tensor<dim>& inverse_transpose) const
{
  const auto& [facet, geometry, gamma, contact, number] = contact_facets_[k];
  const fem::Tabulation<dim>& table = facet_table_.on_facet[facet.local];
  const std::span<const Index> nodes = space_->cell_nodes(facet.cell);
  const problem::Material& material = problem_->material(space_->mesh().region(facet.cell));
  const Tensor<dim> gradient = gradient_at<dim>(nodes, u, table.gradients_at(q), inverse_transpose);
  const Point<dim> value = value_at<dim>(nodes, u, table.values_at(q));
  const double gap = gap_[k * facet_rule_.size() + q];
  return contact::augmented_traction<dim>(material, gamma, gap, geometry.normal, value, gradient);
}

template <int dim>
problem::LawPoint<dim> NitscheForm<dim>::law_point(std::size_t k, std::size_t i) const
{
  return {contact_facets_[k].geometry.normal, strength_[i]};
}

template <int dim>
Tensor<dim> NitscheForm<dim>::traction_derivative(Linearisation kind, std::size_t k, std::size_t i,
                                                  const Point<dim>& augmented, double delta) const
{
  const problem::ContactLaw& law = contact_facets_[k].contact->law;
  if (kind == Linearisation::newton) return problem::tangent<dim>(law, law_point(k, i), augmented, delta);
  const Point<dim>& n = contact_facets_[k].geometry.normal;
  return cone(law).resists_sliding() ? Tensor<dim>::Identity() : Tensor<dim>(n * n.transpose());
}

template <int dim>
std::vector<Point<dim>> NitscheForm<dim>::traction(std::span<const double> u, double delta) const
{
  std::vector<Point<dim>> t;
  t.reserve(n_contact_points());
  for (std::size_t k = 0; k < contact_facets_.size(); ++k)
  {
    const Tensor<dim> j = inverse_transpose(k);
    for (int q = 0; q < n_facet_points(); ++q)
      t.push_back(problem::respond<dim>(contact_facets_[k].contact->law, law_point(k, t.size()),
                                        augmented_traction(u, k, q, j), delta)
                      .traction);
  }
  return t;
}

template <int dim>
std::vector<Point<dim>> NitscheForm<dim>::linearised_traction(Linearisation kind, std::span<const double> u,
                                                              std::span<const double> w, double delta) const
{
  std::vector<Point<dim>> t;
  t.reserve(n_contact_points());
  for (std::size_t k = 0; k < contact_facets_.size(); ++k)
  {
    const Tensor<dim> j = inverse_transpose(k);
    for (int q = 0; q < n_facet_points(); ++q)
    {
      const std::size_t i = t.size();
      const Point<dim> at_w = augmented_traction(w, k, q, j);
      if (kind == Linearisation::closed_sticking)
      {
        t.push_back(traction_derivative(kind, k, i, at_w, delta) * at_w);
        continue;
      }
      const Point<dim> at_u = augmented_traction(u, k, q, j);
      t.push_back(
          problem::respond<dim>(contact_facets_[k].contact->law, law_point(k, i), at_u, delta).traction +
          traction_derivative(kind, k, i, at_u, delta) * (at_w - at_u));
    }
  }
  return t;
}

template <int dim>
void NitscheForm<dim>::add_contact_load(std::span<const Point<dim>> t, std::span<double> vector) const
{
  assert(t.size() == n_contact_points());
  for (std::size_t k = 0; k < contact_facets_.size(); ++k)
  {
    const auto& [facet, geometry, gamma, contact, number] = contact_facets_[k];
    const std::span<const Index> nodes = space_->cell_nodes(facet.cell);
    const double scale = geometry.measure * (dim - 1);  // |F| / |reference facet|
    for (int q = 0; q < n_facet_points(); ++q)
    {
      const auto values = facet_table_.on_facet[facet.local].values_at(q);
      const Point<dim> force = scale * facet_rule_.weights[q] * t[k * facet_rule_.size() + q];
      for (std::size_t i = 0; i < nodes.size(); ++i)
        for (int a = 0; a < dim; ++a) vector[dim * nodes[i] + a] += values[i] * force[a];
    }
  }
}

template <int dim>
void NitscheForm<dim>::add_block_entries(const mesh::BoundaryFacet& facet, std::span<const Tensor<dim>> block,
                                         algebra::Triplets& entries) const
{
  const fem::LagrangeBasis<dim>& basis = space_->basis();
  const std::span<const Index> nodes = space_->cell_nodes(facet.cell);
  const auto free_dof = [&](Index node, int a)
  { return constraints_.fixed[dim * node + a] ? -1 : dim * node + a; };
  for (int i = 0; i < basis.n_nodes(); ++i)
  {
    if (basis.node(i)[facet.local] > 0) continue;  // phi_i vanishes on the facet
    for (int j = 0; j < basis.n_nodes(); ++j)
      for (int a = 0; a < dim; ++a)
        for (int b = 0; b < dim; ++b)
          entries.add(free_dof(nodes[i], a), free_dof(nodes[j], b), block[i * basis.n_nodes() + j](a, b));
  }
}

template <int dim>
algebra::Triplets NitscheForm<dim>::contact_tangent(Linearisation kind, std::span<const double> u,
                                                    double delta) const
{
  const int n = space_->basis().n_nodes();
  algebra::Triplets entries;
  std::vector<Tensor<dim>> column(n);  // M (sigma(phi_j e_b) n - gamma phi_j e_b)
  std::vector<Tensor<dim>> block(static_cast<std::size_t>(n) * n);
  for (std::size_t k = 0; k < contact_facets_.size(); ++k)
  {
    const auto& [facet, geometry, gamma, contact, number] = contact_facets_[k];
    const Tensor<dim> inverse = inverse_transpose(k);
    const fem::Tabulation<dim>& table = facet_table_.on_facet[facet.local];
    const problem::Material& material = problem_->material(space_->mesh().region(facet.cell));
    std::ranges::fill(block, Tensor<dim>::Zero());
    for (int q = 0; q < n_facet_points(); ++q)
    {
      const Tensor<dim> m = traction_derivative(kind, k, k * facet_rule_.size() + q,
                                                augmented_traction(u, k, q, inverse), delta);
      const auto values = table.values_at(q);
      const auto gradients = table.gradients_at(q);
      for (int j = 0; j < n; ++j)
        column[j] =
            m * augmented_block<dim>(material, gamma, geometry.normal, values[j], inverse * gradients[j]);
      const double weight = -geometry.measure * (dim - 1) * facet_rule_.weights[q];
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) block[i * n + j] += weight * values[i] * column[j];
    }
    add_block_entries(facet, block, entries);
  }
  return entries;
}

template <int dim>
std::vector<ContactState<dim>> NitscheForm<dim>::contact_states(std::span<const double> u, int k,
                                                                const fem::FacetTabulation<dim>& table) const
{
  const auto& [facet, geometry, gamma, contact, number] = contact_facets_[k];
  const Point<dim>& n = geometry.normal;
  const mesh::FacetMap<dim> map = mesh::facet_map(space_->mesh(), facet.cell, facet.local);
  const Tensor<dim> inverse = inverse_transpose(k);
  const std::span<const Index> nodes = space_->cell_nodes(facet.cell);
  const problem::Material& material = problem_->material(space_->mesh().region(facet.cell));

  std::vector<ContactState<dim>> states;
  for (std::size_t q = 0; q < table.points.size(); ++q)
  {
    const fem::Tabulation<dim>& local = table.on_facet[facet.local];
    const Point<dim> x = map(table.points[q]);
    const Point<dim> value = value_at<dim>(nodes, u, local.values_at(q));
    const Tensor<dim> gradient = gradient_at<dim>(nodes, u, local.gradients_at(q), inverse);
    const double gap = problem::gap_at<dim>(*contact, x);
    const problem::LawPoint<dim> point{n, problem::strength_at<dim>(contact->law, x)};
    const Point<dim> p = contact::augmented_traction<dim>(material, gamma, gap, n, value, gradient);
    const auto [traction, limit, status] = problem::respond<dim>(contact->law, point, p);
    states.push_back(
        {x, n, -traction.dot(n), traction, limit, status, gap - value.dot(n), value - value.dot(n) * n});
  }
  return states;
}

template <int dim>
ContactResultants<dim> contact_resultants(const NitscheForm<dim>& form, std::span<const Point<dim>> t,
                                          int tag)
{
  ContactResultants<dim> sum;
  Point<dim> tangential = Point<dim>::Zero();
  for (std::size_t k = 0; k < form.contact_facets().size(); ++k)
  {
    const ContactFacet<dim>& contact = form.contact_facets()[k];
    if (tag >= 0 && contact.facet.tag != tag) continue;
    const Point<dim>& n = contact.geometry.normal;
    for (int q = 0; q < form.n_facet_points(); ++q)
    {
      const double weight = contact.geometry.measure * (dim - 1) * form.facet_rule().weights[q];
      const Point<dim>& traction = t[k * form.n_facet_points() + q];
      const Point<dim> t_t = traction - traction.dot(n) * n;
      sum.force += weight * traction;
      sum.normal += weight * traction.dot(n);
      sum.abs_tangential += weight * t_t.norm();
      tangential += weight * t_t;
      if constexpr (dim == 2) sum.tangential += weight * (-n[1] * traction[0] + n[0] * traction[1]);
    }
  }
  if constexpr (dim == 3) sum.tangential = tangential.norm();
  return sum;
}

template class NitscheForm<2>;
template class NitscheForm<3>;
template ContactResultants<2> contact_resultants(const NitscheForm<2>&, std::span<const Point<2>>, int);
template ContactResultants<3> contact_resultants(const NitscheForm<3>&, std::span<const Point<3>>, int);

}  // namespace tribound::contact
