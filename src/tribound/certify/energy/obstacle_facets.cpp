#include "tribound/certify/energy/obstacle_facets.h"

#include <algorithm>
#include <cmath>

#include "tribound/certify/energy/traction_fit.h"
#include "tribound/contact/nitsche/facet_cuts.h"
#include "tribound/contact/nitsche/segment.h"
#include "tribound/fem/bernstein.h"
#include "tribound/mesh/geometry.h"

namespace tribound::certify
{

namespace
{

/// Coordinates on reference facets that differ by less are the same.
constexpr double same = 1e-6;

/// The node of the space on the facet with the coordinates x on the reference facet; -1: none.
template <int dim>
Index node_at(const fem::LagrangeSpace<dim>& space, const mesh::BoundaryFacet& facet, const Point<dim - 1>& x)
{
  const fem::LagrangeBasis<dim>& basis = space.basis();
  for (int i = 0; i < basis.n_nodes(); ++i)
    if (basis.node(i)[facet.local] == 0 &&
        (mesh::cell_to_facet<dim>(facet.local, basis.node_point(i)) - x).cwiseAbs().maxCoeff() <= same)
      return space.cell_nodes(facet.cell)[i];
  return -1;
}

}  // namespace

template <int dim>
std::string laws_unfit(const contact::NitscheForm<dim>& form)
{
  const Ranks& ranks = form.space().mesh().ranks();
  const auto any = [&](const auto& what) { return ranks.any(std::ranges::any_of(form.segments(), what)); };
  using Segment = contact::ContactSegment<dim>;
  const auto turns_with_friction = [](const Segment& segment)
  { return segment.varying_normal != nullptr && problem::cone(segment.contact->law).resists_sliding(); };
  if (form.history() && any(turns_with_friction))
    return "a direction of contact varies along facets that may have slipped in earlier load steps";
  if (any([](const Segment& segment) { return segment.contact->water.has_value(); }))
    return "there is water in a joint";
  if (any([](const Segment& segment) { return problem::cone(segment.contact->law).is_bonded; }))
    return "a contact law has a bond";
  const auto has_both = [](const Segment& segment)
  {
    const problem::FrictionCone cone = problem::cone(segment.contact->law);
    return cone.coefficient > 0 && cone.strength != nullptr && !cone.strength->is_zero();
  };
  if (any(has_both)) return "a contact law has a threshold beside its friction coefficient";
  return {};
}

template <int dim>
std::string obstacles_unfit(const contact::NitscheForm<dim>& form)
{
  if (std::string unfit = laws_unfit(form); !unfit.empty()) return unfit;
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const auto is_torn = [&](const contact::ContactSegment<dim>& segment)
  { return problem::cone(segment.contact->law).is_tied && !contact::is_whole(mesh, segment); };
  if (mesh.ranks().any(std::ranges::any_of(form.segments(), is_torn)))
    return "meshes of tied bodies do not match";
  const auto slides = [](const contact::ContactSegment<dim>& segment)
  { return std::holds_alternative<problem::Slider>(segment.contact->law); };
  if (mesh.ranks().any(std::ranges::any_of(form.segments(), [&](const auto& segment)
                                           { return slides(segment) && segment.varying_normal != nullptr; })))
    return "the direction of a slider varies along facets";
  if (mesh.ranks().any(std::ranges::any_of(form.segments(), [&](const auto& segment)
                                           { return slides(segment) && !contact::is_whole(mesh, segment); })))
    return "meshes of bodies joined by a slider do not match";
  return {};
}

template <int dim>
ObstacleFacets<dim>::ObstacleFacets(const contact::NitscheForm<dim>& form)
    : form_(form),
      frames_(form),
      basis_(form.space().degree()),
      richer_(form.space().degree() + 2),
      n_(basis_.n_nodes()),
      to_values_(fem::values_from_bernstein(basis_)),
      from_values_(fem::bernstein_from_values(basis_)),
      at_richer_nodes_(bernstein_at<dim>(basis_.degree(), richer_.node_points())),
      from_richer_nodes_(bernstein_from_nodes(richer_)),
      raise_(bernstein_raised<dim>(basis_.degree(), richer_.degree()))
{
  const fem::LagrangeSpace<dim>& space = form.space();
  const mesh::Mesh<dim>& mesh = space.mesh();
  const Eigen::MatrixXd from_nodes = bernstein_from_nodes(basis_);
  for (std::size_t k = 0; k < size(); ++k)
  {
    const contact::ContactSegment<dim>& segment = form.segments()[k];
    const auto map = contact::simplex_map(mesh, segment.slave);
    const bool is_tied = problem::cone(segment.contact->law).is_tied;
    const bool matches = contact::is_whole(mesh, segment) && !frames_.turns(k);
    parts_.push_back(matches ? -1 : static_cast<std::ptrdiff_t>(of_parts_.size()));
    if (!matches) add_part(segment);
    for (std::size_t j = 0; j < n_; ++j)
    {
      const Point<dim - 1> s = basis_.node_point(static_cast<int>(j));
      const auto node_of = [&](const contact::SegmentSide<dim>& side)
      { return node_at<dim>(space, side.facet, matches ? side.on_facet(s) : s); };
      nodes_.push_back(node_of(segment.slave));
      master_nodes_.push_back(segment.master ? node_of(*segment.master) : -1);
    }
    std::vector<double> gaps;
    const fem::LagrangeBasis<dim - 1>& of_gap = frames_.turns(k) ? richer_ : basis_;
    for (int j = 0; j < of_gap.n_nodes(); ++j)
    {
      const Point<dim - 1> s = of_gap.node_point(j);
      const bool at_vertex = matches && nodes(k)[j] < mesh.n_vertices();
      const Point<dim> x = at_vertex ? Point<dim>(mesh.vertex(nodes(k)[j])) : map(s);
      gaps.push_back(is_tied ? 0 : segment.gap(s, x, segment.normal_at(x)));
    }
    const Eigen::VectorXd coefficients = (frames_.turns(k) ? from_richer_nodes_ : from_nodes) *
                                         Eigen::Map<const Eigen::VectorXd>(gaps.data(), std::ssize(gaps));
    gaps_.insert(gaps_.end(), coefficients.begin(), coefficients.end());
    gap_begins_.push_back(gaps_.size());
  }
  if (form.history()) set_slips();
}

template <int dim>
std::vector<Point<dim>> ObstacleFacets<dim>::turned(std::size_t k, std::vector<Point<dim>> v) const
{
  if (!frames_.turns(k)) return v;
  const std::vector<Point<dim - 1>> nodes = richer_.node_points();
  using Columns = Eigen::Matrix<double, dim, Eigen::Dynamic>;
  Columns values = Eigen::Map<const Columns>(v[0].data(), dim, std::ssize(v)) * at_richer_nodes_.transpose();
  for (Eigen::Index i = 0; i < values.cols(); ++i)
    values.col(i) = (frames_.at(k, nodes[i]).transpose() * values.col(i)).eval();
  values = (values * from_richer_nodes_.transpose()).eval();
  std::vector<Point<dim>> result(values.cols());
  Eigen::Map<Columns>(result[0].data(), dim, values.cols()) = values;
  return result;
}

/// w is a polynomial of degree p + 2 on each segment.
template <int dim>
void ObstacleFacets<dim>::set_slips()
{
  std::ptrdiff_t n_slipped = 0;
  for (std::size_t k = 0; k < size(); ++k)
  {
    const contact::ContactSegment<dim>& segment = form_.segments()[k];
    const problem::FrictionCone cone = problem::cone(segment.contact->law);
    const auto add_coefficients = [&](const fem::LagrangeBasis<dim - 1>& basis, std::vector<Point<dim>>& to)
    {
      Eigen::Matrix<double, dim, Eigen::Dynamic> values(dim, basis.n_nodes());
      for (int i = 0; i < basis.n_nodes(); ++i)
      {
        const Point<dim> w = form_.history()->at(segment.contact->law, k, basis.node_point(i)).slip;
        values.col(i) = w - w.dot(segment.normal) * segment.normal;
      }
      if (values.isZero(0)) return false;
      values = (values * bernstein_from_nodes(basis).transpose()).eval();
      for (Eigen::Index i = 0; i < values.cols(); ++i) to.push_back(values.col(i));
      return true;
    };
    const bool counts = cone.resists_sliding() && !cone.is_tied && add_coefficients(richer_, slips_);
    slipped_.push_back(counts ? n_slipped++ : -1);
    if (counts && !add_coefficients(basis_, nodal_slips_))
      nodal_slips_.resize(nodal_slips_.size() + n_, Point<dim>::Zero());
  }
}

template <int dim>
void ObstacleFacets<dim>::add_part(const contact::ContactSegment<dim>& segment)
{
  const auto add_side = [&](const contact::SegmentSide<dim>& side)
  {
    std::vector<Point<dim - 1>> points;
    for (std::size_t i = 0; i < n_; ++i)
      points.push_back(side.on_facet(basis_.node_point(static_cast<int>(i))));
    const fem::Tabulation<dim - 1> table = basis_.tabulate(points);
    for (std::size_t j = 0; j < n_; ++j)
      for (std::size_t l = 0; l < n_; ++l)
      {
        double sum = 0;
        for (std::size_t i = 0; i < n_; ++i)
          sum += from_values_[j * n_ + i] * table.values_at(static_cast<int>(i))[l];
        of_parts_.push_back(sum);
      }
  };
  segment.for_each_side(add_side);
}

template <int dim>
std::span<const double> ObstacleFacets<dim>::on_segment(std::size_t k, int side) const
{
  return matches(k) ? std::span<const double>(from_values_)
                    : std::span(of_parts_).subspan(parts_[k] + side * n_ * n_, n_ * n_);
}

template <int dim>
double ObstacleFacets<dim>::gap_remainder() const
{
  const auto& points = form_.facet_rule().points;
  const Eigen::MatrixXd plain = bernstein_at<dim>(basis_.degree(), points);
  const Eigen::MatrixXd rich = bernstein_at<dim>(richer_.degree(), points);
  constexpr double rounding = 1e-14;  // of coordinates, from which gaps are computed
  double largest = 0;
  for (std::size_t k = 0; k < size(); ++k)
    for (int q = 0; q < form_.n_segment_points(); ++q)
    {
      const contact::ContactSegment<dim>& segment = form_.segments()[k];
      if (problem::cone(segment.contact->law).is_tied) continue;
      const Point<dim>& x = form_.contact_points(k)[q].x;
      double rest = segment.gap(points[q], x, segment.normal_at(x));
      for (std::size_t i = 0; i < gap(k).size(); ++i)
        rest -= (frames_.turns(k) ? rich : plain)(q, static_cast<Eigen::Index>(i)) * gap(k)[i];
      if (std::abs(rest) > rounding * x.norm()) largest = std::max(largest, std::abs(rest));
    }
  return largest;
}

template <int dim>
std::vector<Point<dim>> ObstacleFacets<dim>::transformed(std::span<const Index> nodes,
                                                         std::span<const double> matrix,
                                                         std::span<const double> by_node) const
{
  std::vector<Point<dim>> result(n_, Point<dim>::Zero());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = 0; j < nodes.size(); ++j)
      result[i] += matrix[i * n_ + j] * Eigen::Map<const Point<dim>>(&by_node[dim * nodes[j]]);
  return result;
}

template <int dim>
std::vector<Point<dim>> ObstacleFacets<dim>::on_master(std::size_t k, std::span<const double> u) const
{
  return transformed(master_nodes(k), on_segment(k, 1), u);
}

template <int dim>
std::vector<Point<dim>> ObstacleFacets<dim>::slip(std::size_t k, std::span<const double> u) const
{
  const Point<dim>& normal = frames_.normal(k);
  std::vector<Point<dim>> result = turned(k, coefficients(k, u));
  for (Point<dim>& c : result) c -= c.dot(normal) * normal;
  if (!has_slipped(k)) return result;
  const auto n = static_cast<std::size_t>(richer_.n_nodes());
  std::vector<Point<dim>> raised(n, Point<dim>::Zero());
  for (std::size_t i = 0; i < n; ++i)
  {
    for (std::size_t j = 0; j < n_; ++j) raised[i] += raise_(i, j) * result[j];
    raised[i] -= slips_[slipped_[k] * n + i];
  }
  return raised;
}

template <int dim>
bool ObstacleFacets<dim>::touch(const contact::RigidParts<dim>& parts) const
{
  if (parts.empty()) return false;
  const std::vector<char> on_parts = parts.marks();
  const auto is_on_part = [&](Index node)
  { return node >= 0 && on_parts[static_cast<std::size_t>(dim) * node] != 0; };
  return form_.space().mesh().ranks().any(std::ranges::any_of(nodes_, is_on_part) ||
                                          std::ranges::any_of(master_nodes_, is_on_part));
}

template <int dim>
std::vector<char> ObstacleFacets<dim>::junctions() const
{
  const fem::LagrangeSpace<dim>& space = form_.space();
  constexpr Index unknown = -2;
  constexpr Index between_nodes = -3;
  std::vector<Index> opposite(space.n_dofs() / dim, unknown);
  std::vector<char> result(space.n_dofs(), 0);
  const auto mark = [&](Index node) { std::fill_n(&result[dim * node], dim, 1); };
  for (std::size_t i = 0; i < nodes_.size(); ++i)
  {
    Index& known = opposite[nodes_[i]];
    const bool is_known = known != unknown && known != between_nodes;
    const Index partner = matches(i / n_) ? master_nodes_[i] : between_nodes;
    if (is_known && partner != between_nodes && known != partner) mark(nodes_[i]);
    if (!is_known) known = partner;
  }
  for (const Index node : master_nodes_)
    if (node >= 0 && opposite[node] != unknown) mark(node);
  space.update(std::span(result));
  return result;
}

template <int dim>
std::vector<char> ObstacleFacets<dim>::between_meshes() const
{
  std::vector<char> result(form_.space().n_dofs(), 0);
  for (std::size_t k = 0; k < size(); ++k)
    for (const std::span<const Index> side : {nodes(k), master_nodes(k)})
      for (const Index node : side)
        if (!matches(k)) std::fill_n(&result[dim * node], dim, 1);
  form_.space().update(std::span(result));
  return result;
}

template <int dim>
std::vector<Point<dim>> ObstacleFacets<dim>::coefficients(std::size_t k, std::span<const double> u) const
{
  std::vector<Point<dim>> result = on_slave(k, u);
  const std::vector<Point<dim>> opposite = on_master(k, u);
  for (std::size_t j = 0; j < n_; ++j) result[j] -= opposite[j];
  return result;
}

template std::string laws_unfit(const contact::NitscheForm<2>&);
template std::string laws_unfit(const contact::NitscheForm<3>&);
template std::string obstacles_unfit(const contact::NitscheForm<2>&);
template std::string obstacles_unfit(const contact::NitscheForm<3>&);
template class ObstacleFacets<2>;
template class ObstacleFacets<3>;

}  // namespace tribound::certify
