#include "tribound/contact/nitsche/rigid_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tribound/base/dense_factors.h"
#include "tribound/base/error.h"
#include "tribound/mesh/bodies.h"
#include "tribound/mesh/describe.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/mesh.h"

namespace tribound::contact
{

template <int dim>
Eigen::MatrixXd fixed_motions(const problem::RigidPart<dim>& part, const RigidModes<dim>& modes)
{
  constexpr int n = RigidModes<dim>::n_modes;
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(std::ranges::count(part.fixed, true), n);
  Eigen::Index row = 0;
  for (int i = 0; i < n; ++i)
    if (!part.fixed[i])
      continue;
    else if (i < dim)
      rows.row(row++) = modes.at(part.point).row(i).normalized();  // the point may be far away
    else
      rows(row++, i) = 1;
  return rows;
}

template <int dim>
RigidParts<dim>::RigidParts(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space)
    : space_(&space)
{
  if (!problem.has_rigid_parts()) return;
  const auto boundaries = problem.boundaries();
  for (int tag = 0; tag < static_cast<int>(boundaries.size()); ++tag)
    if (boundaries[tag].rigid) parts_.push_back({tag, {}, {}, {}});
  const Ranks& ranks = space.mesh().ranks();
  find_nodes(problem);
  find_motions(problem);
  check_bodies(problem);
  ranks.together([&] { check_neighbours(problem); });
}

namespace
{

/// Whether the boundary slides on an obstacle, which holds it along N.
template <int dim>
bool slides(const problem::BoundaryCondition<dim>& boundary)
{
  return boundary.contact && problem::cone(boundary.contact->law).is_bilateral;
}

/// Calls visit(facet, node) for the nodes on each facet where something is fixed.
template <int dim, class Visit>
void for_each_fixed_node(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                         const Visit& visit)
{
  for (const mesh::BoundaryFacet& facet : space.mesh().boundary())
  {
    const problem::BoundaryCondition<dim>& boundary = problem.boundary(facet.tag);
    if (!boundary.fixes_any() && !slides(boundary)) continue;
    const std::span<const Index> nodes = space.cell_nodes(facet.cell);
    for (int i = 0; i < space.basis().n_nodes(); ++i)
      if (space.basis().node(i)[facet.local] == 0) visit(facet, nodes[i]);
  }
}

/// A direction in which a boundary prescribes the displacement.
template <int dim>
struct Prescribed
{
  Point<dim> direction;
  double value;
  std::string name;
};

/// What the condition on a facet prescribes at x.
template <int dim>
std::vector<Prescribed<dim>> prescribed_at(const mesh::Mesh<dim>& mesh, const mesh::BoundaryFacet& facet,
                                           const problem::BoundaryCondition<dim>& boundary,
                                           const Point<dim>& x)
{
  std::vector<Prescribed<dim>> result;
  for (int a = 0; a < dim; ++a)
    if (boundary.clamps(a))
      result.push_back({Point<dim>::Unit(a), boundary.prescribed(a)(x), std::string(1, "xyz"[a])});
  if (slides(boundary))
  {
    const Point<dim> n = boundary.contact->normal
                             ? (*boundary.contact->normal)(x)
                             : mesh::facet_geometry(mesh, facet.cell, facet.local).normal;
    result.push_back(
        {n, boundary.contact->gap ? (*boundary.contact->gap)(x) : 0, "the part along its normal"});
  }
  return result;
}

}  // namespace

/// A part on two bodies would join them, which nothing else here knows.
template <int dim>
void RigidParts<dim>::check_bodies(const problem::Problem<dim>& problem) const
{
  const mesh::Mesh<dim>& mesh = space_->mesh();
  const mesh::Bodies bodies = mesh::number_bodies(mesh);
  std::vector<double> ends(2 * parts_.size(), -std::numeric_limits<double>::infinity());
  for (const mesh::BoundaryFacet& facet : mesh.owned_boundary())
  {
    const Part* const part = on(facet.tag);
    if (part == nullptr) continue;
    double* const end = &ends[2 * (part - parts_.data())];
    end[0] = std::max<double>(end[0], bodies.of_cell[facet.cell]);
    end[1] = std::max<double>(end[1], -bodies.of_cell[facet.cell]);
  }
  mesh.ranks().max(std::span(ends));
  for (std::size_t k = 0; k < parts_.size(); ++k)
    if (ends[2 * k] != -ends[2 * k + 1])
      throw InputError(problem.boundary(parts_[k].tag).where, "is a rigid part on several bodies",
                       "one group of facets for each body, or a tied contact between the bodies");
}

/// A node of a ghost cell may be on a part through a cell that this rank does not have.
template <int dim>
void RigidParts<dim>::find_nodes(const problem::Problem<dim>& problem)
{
  const fem::LagrangeSpace<dim>& space = *space_;
  std::vector<int> part_of(space.n_dofs(), 0);  // number + 1, for every degree of freedom
  for_each_fixed_node(problem, space,
                      [&](const mesh::BoundaryFacet& facet, Index node)
                      {
                        const Part* const part = on(facet.tag);
                        if (part == nullptr) return;
                        for (int a = 0; a < dim; ++a)
                          part_of[dim * node + a] = static_cast<int>(part - parts_.data()) + 1;
                      });
  space.update(std::span(part_of));
  const std::vector<Point<dim>> points = space.node_points();
  std::vector<double> x(space.n_dofs());  // the same on all ranks, to the last digit
  for (Index i = 0; i < space.n_nodes(); ++i) std::ranges::copy(points[i], &x[dim * i]);
  space.update(std::span(x));
  std::vector<char> is_own(space.n_nodes(), 0);
  for (Index k = 0; k < space.n_owned_nodes(); ++k) is_own[space.owned_node(k)] = 1;
  for (Index i = 0; i < space.n_nodes(); ++i)
    if (part_of[dim * i] > 0)
      nodes_.push_back({i, part_of[dim * i] - 1, is_own[i] != 0, Point<dim>(&x[dim * i])});
}

template <int dim>
void RigidParts<dim>::find_motions(const problem::Problem<dim>& problem)
{
  constexpr int n = RigidModes<dim>::n_modes;
  const Ranks& ranks = space_->mesh().ranks();
  std::vector<double> corners(2 * dim * parts_.size(), -std::numeric_limits<double>::infinity());
  for (const Node& node : nodes_)
    for (int a = 0; a < dim; ++a)
    {
      double* const corner = &corners[(static_cast<std::size_t>(node.part) * dim + a) * 2];
      corner[0] = std::max(corner[0], node.x[a]);
      corner[1] = std::max(corner[1], -node.x[a]);
    }
  ranks.max(std::span(corners));
  std::vector<double> grams(parts_.size() * n * n, 0.0);
  const auto gram = [&](std::size_t k) { return Eigen::Map<Eigen::Matrix<double, n, n>>(&grams[k * n * n]); };
  for (std::size_t k = 0; k < parts_.size(); ++k)
  {
    const Eigen::Map<const Eigen::Matrix<double, 2, dim>> corner(&corners[k * dim * 2]);
    parts_[k].modes.centre = (corner.row(0) - corner.row(1)).transpose() / 2;
    parts_[k].modes.size = (corner.row(0) + corner.row(1)).norm() / 2;
    if (!(parts_[k].modes.size > 0 && std::isfinite(parts_[k].modes.size)))
      throw InputError(problem.boundary(parts_[k].tag).where, "is a rigid part without facets",
                       "a boundary of the mesh that has facets");
  }
  for (const Node& node : nodes_)
  {
    if (!node.is_own) continue;
    const typename RigidModes<dim>::ModeMatrix m = parts_[node.part].modes.at(node.x);
    gram(node.part) += m.transpose() * m;
  }
  ranks.sum(std::span(grams));
  for (std::size_t k = 0; k < parts_.size(); ++k)
  {
    Part& part = parts_[k];
    const Eigen::MatrixXd rows = fixed_motions(*problem.boundary(part.tag).rigid, part.modes);
    const Eigen::MatrixXd left = null_space(rows.transpose() * rows, std::max(1.0, rows.squaredNorm()));
    part.motions = left;
    if (left.cols() > 0)
    {
      const SymmetricEigen eigen = symmetric_eigen(left.transpose() * gram(k) * left);
      part.motions *= eigen.vectors * eigen.values.cwiseSqrt().cwiseInverse().asDiagonal();
    }
    part.first = n_motions_;
    n_motions_ += part.motions.cols();
    find_load(problem, gram(k), part);
  }
}

template <int dim>
void RigidParts<dim>::check_neighbours(const problem::Problem<dim>& problem) const
{
  constexpr double rounding = 1e-9;
  std::vector<int> place(space_->n_nodes(), -1);
  for (std::size_t k = 0; k < nodes_.size(); ++k) place[nodes_[k].node] = static_cast<int>(k);
  const auto check = [&](const mesh::BoundaryFacet& facet, Index i)
  {
    if (place[i] < 0) return;
    const Node& node = nodes_[place[i]];
    const Part& part = parts_[node.part];
    if (facet.tag == part.tag) return;
    const problem::BoundaryCondition<dim>& of_part = problem.boundary(part.tag);
    const problem::BoundaryCondition<dim>& other = problem.boundary(facet.tag);
    if (other.rigid)
      throw InputError(other.where,
                       fmt::format("is a rigid part that meets the rigid part \"{}\" at {}", of_part.name,
                                   mesh::describe(node.x)),
                       "one group for both, or a deformable part between them");
    const Eigen::MatrixXd motions = part.at(node.x);
    for (const auto& [direction, value, name] : prescribed_at<dim>(space_->mesh(), facet, other, node.x))
      if ((direction.transpose() * motions).norm() > rounding * part.motions.norm() ||
          std::abs(value) > rounding * part.modes.size)
        throw InputError(
            of_part.where,
            fmt::format("is a rigid part that meets \"{}\" at {}, where that prescribes {}", other.name,
                        mesh::describe(node.x), name),
            fmt::format("rigid.fixed, such as [\"x\", {}] at a plane of symmetry x = 0, with 0 prescribed",
                        dim == 2 ? "\"rz\"" : "\"ry\", \"rz\""));
  };
  for_each_fixed_node(problem, *space_, check);
}

/// `gram`: the products of the modes over the nodes of the part.
template <int dim>
void RigidParts<dim>::find_load(const problem::Problem<dim>& problem, const Eigen::MatrixXd& gram, Part& part)
{
  const problem::RigidPart<dim>& rigid = *problem.boundary(part.tag).rigid;
  Eigen::VectorXd work = part.modes.at(rigid.point).transpose() * rigid.total_force();
  work.tail(work.size() - dim) += rigid.total_moment() / part.modes.size;
  work /= problem.full_circle();
  part.forces = solve_regular(gram, work);
  const Eigen::VectorXd in_motions = part.motions.transpose() * work;
  load_.insert(load_.end(), in_motions.begin(), in_motions.end());
}

template <int dim>
void RigidParts<dim>::add_load(std::span<double> vector) const
{
  for (const Node& node : nodes_)
  {
    const Part& part = parts_[node.part];
    const Point<dim> force = part.modes.at(node.x) * part.forces;
    for (int a = 0; a < dim; ++a) vector[dim * node.node + a] += force[a];
  }
}

template <int dim>
auto RigidParts<dim>::on(int tag) const -> const Part*
{
  const auto found = std::ranges::find(parts_, tag, &Part::tag);
  return found == parts_.end() ? nullptr : &*found;
}

template <int dim>
std::vector<double> RigidParts<dim>::along(std::span<const double> vector) const
{
  std::vector<double> result(n_motions_, 0.0);
  for (const Node& node : nodes_)
  {
    if (!node.is_own) continue;
    const Part& part = parts_[node.part];
    const Eigen::VectorXd work =
        part.at(node.x).transpose() * Point<dim>(&vector[static_cast<std::size_t>(dim) * node.node]);
    for (Eigen::Index i = 0; i < work.size(); ++i) result[part.first + i] += work[i];
  }
  if (!parts_.empty()) space_->mesh().ranks().sum(std::span(result));
  return result;
}

template <int dim>
std::vector<double> RigidParts<dim>::motion(std::size_t i) const
{
  std::vector<double> unit(n_motions_, 0.0);
  unit[i] = 1;
  std::vector<double> result(space_->n_dofs(), 0.0);
  add(unit, result);
  return result;
}

template <int dim>
void RigidParts<dim>::add(std::span<const double> r, std::span<double> vector) const
{
  for (const Node& node : nodes_)
  {
    const Part& part = parts_[node.part];
    const Eigen::Map<const Eigen::VectorXd> of_part(r.data() + part.first, part.motions.cols());
    const Point<dim> value = part.at(node.x) * of_part;
    for (int a = 0; a < dim; ++a) vector[dim * node.node + a] += value[a];
  }
}

template <int dim>
void RigidParts<dim>::set(std::span<const double> r, std::span<double> vector) const
{
  for (const Node& node : nodes_) std::fill_n(&vector[static_cast<std::size_t>(dim) * node.node], dim, 0.0);
  add(r, vector);
}

template <int dim>
std::vector<char> RigidParts<dim>::marks() const
{
  std::vector<char> result(space_->n_dofs(), 0);
  for (const Node& node : nodes_) std::fill_n(&result[static_cast<std::size_t>(dim) * node.node], dim, 1);
  return result;
}

template <int dim>
std::vector<PartMotion<dim>> RigidParts<dim>::motions(const problem::Problem<dim>& problem,
                                                      std::span<const double> u) const
{
  const std::vector<double> r = along(u);
  std::vector<PartMotion<dim>> result;
  result.reserve(parts_.size());
  for (const Part& part : parts_)
  {
    const Eigen::Map<const Eigen::VectorXd> of_part(r.data() + part.first, part.motions.cols());
    const typename RigidModes<dim>::Coefficients z = part.motions * of_part;
    result.push_back({part.tag, part.modes.at(problem.boundary(part.tag).rigid->point) * z,
                      z.template tail<RigidModes<dim>::n_modes - dim>() / part.modes.size});
  }
  return result;
}

template Eigen::MatrixXd fixed_motions(const problem::RigidPart<2>&, const RigidModes<2>&);
template Eigen::MatrixXd fixed_motions(const problem::RigidPart<3>&, const RigidModes<3>&);
template class RigidParts<2>;
template class RigidParts<3>;

}  // namespace tribound::contact
