#include "tribound/io/record/sections.h"

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "tribound/certify/equilibrate/equilibrate.h"
#include "tribound/contact/nitsche/contact_moments.h"
#include "tribound/fem/quadrature.h"
#include "tribound/fem/simplex_parts.h"
#include "tribound/io/fields/tensor_field.h"
#include "tribound/io/record/section_cuts.h"
#include "tribound/mesh/geometry.h"

namespace tribound::io
{

namespace
{

/// a(s), see read_sections().
template <int dim>
auto axial(const Tensor<dim>& s)
{
  if constexpr (dim == 2)
    return Point<1>(s(1, 0) - s(0, 1));
  else
    return Point<3>(s(2, 1) - s(1, 2), s(0, 2) - s(2, 0), s(1, 0) - s(0, 1));
}

/// The integrals of a section.
template <int dim>
struct SectionSum
{
  static constexpr int n_moments = dim == 2 ? 1 : 3;
  double measure = 0;
  Point<dim> force = Point<dim>::Zero();
  Point<n_moments> moment = Point<n_moments>::Zero();

  void add_up(const Ranks& ranks)
  {
    std::vector<double> sums = {measure};
    sums.insert(sums.end(), force.begin(), force.end());
    sums.insert(sums.end(), moment.begin(), moment.end());
    ranks.sum(std::span(sums));
    measure = sums[0];
    std::copy_n(&sums[1], dim, force.data());
    std::copy_n(&sums[1 + dim], n_moments, moment.data());
  }
  /// From one radian to the full circle, around which moments cancel.
  void turn(double full_circle)
  {
    measure *= full_circle;
    force *= full_circle;
    moment.setZero();
  }
};

/// Integrates over what sections have of cells.
template <int dim>
class SectionIntegrals
{
 public:
  SectionIntegrals(const contact::NitscheForm<dim>& form, const certify::Stress<dim>& stress)
      : problem_(form.problem()),
        space_(stress.degree == form.space().degree() ? form.space()
                                                      : richer_.emplace(form.space().mesh(), stress.degree)),
        sigma_h_(equilibrated_stress_field(space_, stress)),
        facet_rule_(fem::quadrature<dim - 1>(stress.degree + 1)),
        cell_rule_(fem::quadrature<dim>(stress.degree)),
        takes_away_(stress.is_symmetric())
  {
  }

  [[nodiscard]] SectionSum<dim> of(const Section<dim>& section) const
  {
    SectionSum<dim> sum;
    for_each_cut<dim>(space_.mesh(), section,
                      [&](Index c, const mesh::CellMap<dim>& map, const CellCut<dim>& cut)
                      {
                        for (const Piece<dim>& piece : cut.on_plane) add(section, c, map, piece, sum);
                        for (const fem::Part<dim>& part : cut.behind)
                          if (takes_away_) take_away(c, map, part, sum);
                      });
    sum.add_up(space_.mesh().ranks());
    if (problem_.is_axisymmetric()) sum.turn(problem_.full_circle());
    return sum;
  }

 private:
  void add(const Section<dim>& section, Index c, const mesh::CellMap<dim>& map, const Piece<dim>& piece,
           SectionSum<dim>& sum) const
  {
    std::vector<Point<dim>> points(facet_rule_.size(), piece[0]);
    for (int q = 0; q < facet_rule_.size(); ++q)
      for (int k = 1; k < dim; ++k) points[q] += facet_rule_.points[q][k - 1] * (piece[k] - piece[0]);
    const std::vector<Tensor<dim>> sigma = values_at<dim>(sigma_h_, space_.basis(), c, points);
    const double scale = scale_of<dim>(map, piece);
    for (int q = 0; q < facet_rule_.size(); ++q)
    {
      const double weight = scale * facet_rule_.weights[q];
      const Point<dim> force = weight * sigma[q] * section.normal;
      sum.measure += problem_.weight(map(points[q])) * weight;
      sum.force += force;
      sum.moment += contact::moment(Point<dim>(map(points[q]) - section.point), force);
    }
  }

  void take_away(Index c, const mesh::CellMap<dim>& map, const fem::Part<dim>& part,
                 SectionSum<dim>& sum) const
  {
    std::vector<Point<dim>> points;
    points.reserve(cell_rule_.points.size());
    for (const Point<dim>& s : cell_rule_.points) points.push_back(fem::point_in<dim>(part, s));
    const std::vector<Tensor<dim>> sigma = values_at<dim>(sigma_h_, space_.basis(), c, points);
    const double scale = map.det * fem::fraction<dim>(part);
    for (int q = 0; q < cell_rule_.size(); ++q)
      sum.moment -= scale * cell_rule_.weights[q] * axial<dim>(sigma[q]);
  }

  const problem::Problem<dim>& problem_;
  std::optional<fem::LagrangeSpace<dim>> richer_;
  const fem::LagrangeSpace<dim>& space_;  ///< of the degree of the stress
  TensorField<dim> sigma_h_;
  fem::Quadrature<dim - 1> facet_rule_;
  fem::Quadrature<dim> cell_rule_;
  bool takes_away_;
};

/// n, then in 2D n turned by +90 degrees; in 3D t_1, the axis of coordinates most across n (the first of
/// these) projected to the plane, and t_2 = n x t_1.
template <int dim>
std::array<Point<dim>, dim> axes_of(const Point<dim>& n)
{
  if constexpr (dim == 2)
    return {n, Point<2>(-n[1], n[0])};
  else
  {
    constexpr double alike = 1e-9;
    int across = 0;
    for (int i = 1; i < 3; ++i)
      if (std::abs(n[i]) < std::abs(n[across]) - alike) across = i;
    const Point<3> t = (Point<3>::Unit(across) - n[across] * n).normalized();
    return {n, t, mesh::cross(n, t)};
  }
}

template <int dim>
SectionRecord record_of(const Section<dim>& section, const SectionSum<dim>& sum, bool is_axisymmetric,
                        const std::string& note)
{
  SectionRecord record{.name = section.name,
                       .measure = sum.measure,
                       .force = {sum.force.begin(), sum.force.end()},
                       .moment = {sum.moment.begin(), sum.moment.end()},
                       .axes = {},
                       .N = sum.force.dot(section.normal),
                       .V = {},
                       .M = {},
                       .note = note};
  const auto axes = axes_of<dim>(section.normal);
  for (int k = 0; k < dim; ++k)
  {
    record.axes.insert(record.axes.end(), axes[k].begin(), axes[k].end());
    if (k > 0) record.V.push_back(sum.force.dot(axes[k]));
    if constexpr (dim == 3) record.M.push_back(sum.moment.dot(axes[k]));
  }
  if constexpr (dim == 2) record.M.push_back(sum.moment[0]);
  if (is_axisymmetric) record.force[0] = 0;  // around the axis the radial forces cancel
  return record;
}

}  // namespace

template <int dim>
void check_sections(const mesh::Mesh<dim>& mesh, std::span<const Section<dim>> sections)
{
  for (const Section<dim>& section : sections)
  {
    const auto cuts = [&](const Section<dim>& of)
    {
      bool any = false;
      for_each_cut<dim>(mesh, of, [&](Index, const mesh::CellMap<dim>&, const CellCut<dim>&) { any = true; });
      return mesh.ranks().any(any);
    };
    if (cuts(section)) continue;
    Section<dim> whole = section;
    whole.within.reset();
    if (section.within && cuts(whole))
      throw InputError(section.where, "has no part where within is positive",
                       "a formula that is positive on what is meant, at the centroids of what the plane cuts "
                       "out of cells");
    throw InputError(section.where,
                     "cuts no cell: no part of the body is behind the plane, or none touches it",
                     "a plane through the body; on a side of the body the outward normal");
  }
}

template <int dim>
std::vector<SectionRecord> read_sections(const contact::NitscheForm<dim>& form,
                                         const adapt::CertifiedLevel<dim>& level,
                                         std::span<const Section<dim>> sections)
{
  if (sections.empty()) return {};
  std::string note;
  std::optional<certify::Stress<dim>> own;
  const bool is_axisymmetric = form.problem().is_axisymmetric();
  if (level.stress.degree == 1)
    note = "moments need degree 2 or more: the stress is not symmetric on average";
  if (level.stress.degree > 1 && !level.stress.is_symmetric() && !is_axisymmetric) try
    {
      own = certify::equilibrate<dim>(form, level.u, level.traction, 0, 0, certify::PatchStress::afw);
    }
    catch (const SolveError& error)
    {
      note = std::string("moments need a weakly symmetric stress, and there is none: ") + error.what();
    }
  const SectionIntegrals<dim> integrals(form, own ? *own : level.stress);
  std::vector<SectionRecord> records;
  records.reserve(sections.size());
  for (const Section<dim>& section : sections)
    records.push_back(record_of<dim>(section, integrals.of(section), is_axisymmetric, note));
  return records;
}

template void check_sections(const mesh::Mesh<2>&, std::span<const Section<2>>);
template void check_sections(const mesh::Mesh<3>&, std::span<const Section<3>>);
template std::vector<SectionRecord> read_sections(const contact::NitscheForm<2>&,
                                                  const adapt::CertifiedLevel<2>&,
                                                  std::span<const Section<2>>);
template std::vector<SectionRecord> read_sections(const contact::NitscheForm<3>&,
                                                  const adapt::CertifiedLevel<3>&,
                                                  std::span<const Section<3>>);

}  // namespace tribound::io
