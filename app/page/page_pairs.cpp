#include "app/page/page_pairs.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "tribound/base/dense_factors.h"
#include "tribound/mesh/bodies.h"

namespace tribound::app
{

namespace
{

using Segment = contact::ContactSegment<3>;

/// For each index in Mesh::boundary(), the face that shows the facet, -1 if there is none.
std::vector<Index> faces_of_facets(const Surface& surface, std::size_t n_facets)
{
  std::vector<Index> face_of(n_facets, -1);
  for (std::size_t face = 0; face < surface.facets.size(); ++face)
    face_of[surface.facets[face]] = static_cast<Index>(face);
  return face_of;
}

void add_part(FaceParts& parts, Index face, const contact::SegmentSide<3>& side)
{
  parts.faces.push_back(face);
  for (const Point<2>& corner : fem::reference_simplex<2>())
  {
    Point<2> s = side.on_facet(corner);
    if (turns_the_other_way(side.facet.local)) std::swap(s[0], s[1]);
    parts.corners.insert(parts.corners.end(), {s[0], s[1]});
  }
}

/// The segments between bodies whose slave has this boundary number and whose faces are shown.
std::vector<std::size_t> shown_segments(const contact::NitscheForm<3>& form, int tag,
                                        std::span<const Index> face_of)
{
  std::vector<std::size_t> shown;
  for (std::size_t k = 0; k < form.segments().size(); ++k)
    if (const Segment& segment = form.segments()[k]; segment.master && segment.slave.facet.tag == tag &&
                                                     face_of[segment.slave.number] >= 0 &&
                                                     face_of[segment.master->number] >= 0)
      shown.push_back(k);
  return shown;
}

PairSurface segments_of(const contact::NitscheForm<3>& form, std::span<const double> u, int tag,
                        std::span<const std::size_t> shown, std::span<const Index> face_of, int k)
{
  PairSurface result{.tag = tag, .subdivision = k};
  std::vector<Point<2>> points = lattice_points(k, false);
  const std::size_t n_points = points.size();
  const std::vector<Point<2>> middles = triangle_middles(k, false);
  points.insert(points.end(), middles.begin(), middles.end());
  result.values.resize(shown.size() * n_points, shown.size() * middles.size());
  constexpr std::size_t batch = 512;  // tables of all segments at once would be large
  for (std::size_t first = 0; first < shown.size(); first += batch)
  {
    const std::span<const std::size_t> numbers = shown.subspan(first, std::min(batch, shown.size() - first));
    std::vector<Segment> segments;
    for (const std::size_t number : numbers) segments.push_back(form.segments()[number]);
    const contact::SegmentTables<3> tables(form.space().basis(), segments, points);
    for (std::size_t i = 0; i < numbers.size(); ++i)
    {
      add_part(result.slave, face_of[segments[i].slave.number], segments[i].slave);
      add_part(result.master, face_of[segments[i].master->number], *segments[i].master);
      const std::vector<contact::ContactState<3>> states = form.contact_states(u, numbers[i], tables[i]);
      for (std::size_t q = 0; q < n_points; ++q)
        result.values.set_point((first + i) * n_points + q, states[q]);
      for (std::size_t m = 0; m < middles.size(); ++m)
        result.values.status[(first + i) * middles.size() + m] =
            static_cast<Index>(states[n_points + m].status);
    }
  }
  return result;
}

/// Sums over the segments on a face.
struct FaceMean
{
  double measure = 0;
  SurfaceContact values;                      ///< weighted by the measure; for one point
  std::array<double, 4> measure_of_status{};  ///< by ContactStatus
};

void add(FaceMean& mean, const contact::ContactState<3>& state, double weight)
{
  SurfaceContact point;
  point.resize(1, 0);
  point.set_point(0, state);
  if (mean.measure == 0) mean.values.resize(1, 0);
  mean.measure += weight;
  mean.measure_of_status[static_cast<std::size_t>(state.status)] += weight;
  for (const auto column : value_columns) (mean.values.*column)[0] += weight * (point.*column)[0];
}

/// Means over whole faces, of the slave or of the master.
PairSurface means_of(const contact::NitscheForm<3>& form, std::span<const double> u, int tag,
                     std::span<const std::size_t> shown, std::span<const Index> face_of, bool of_slave)
{
  std::map<Index, FaceMean> means;
  for (const std::size_t k : shown)
  {
    const Segment& segment = form.segments()[k];
    FaceMean& mean = means[face_of[of_slave ? segment.slave.number : segment.master->number]];
    const std::vector<contact::ContactState<3>> states = form.contact_states(u, k);
    for (std::size_t q = 0; q < states.size(); ++q) add(mean, states[q], form.contact_points(k)[q].weight);
  }
  PairSurface result{.tag = tag};
  result.values.resize(3 * means.size(), means.size());
  std::size_t i = 0;
  for (const auto& [face, mean] : means)
  {
    (of_slave ? result.slave : result.master).faces.push_back(face);
    const auto status = std::ranges::max_element(mean.measure_of_status) - mean.measure_of_status.begin();
    for (std::size_t corner = 3 * i; corner < 3 * i + 3; ++corner)
    {
      for (const auto column : value_columns)
        (result.values.*column)[corner] = (mean.values.*column)[0] / mean.measure;
      result.values.point_status[corner] = static_cast<Index>(status);
    }
    result.values.status[i++] = static_cast<Index>(status);
  }
  return result;
}

}  // namespace

std::vector<PairSurface> sample_pairs(const contact::NitscheForm<3>& form, std::span<const double> u,
                                      const Surface& surface, const PageLimits& limits)
{
  const std::vector<Index> face_of = faces_of_facets(surface, form.space().mesh().boundary().size());
  const auto n_segments = static_cast<std::size_t>(std::ranges::count_if(
      form.segments(), [](const Segment& segment) { return segment.master.has_value(); }));
  const int k = subdivision(n_segments, form.space().degree(), limits.subdivided);
  std::vector<PairSurface> pairs;
  for (int tag = 0; tag < static_cast<int>(form.problem().boundaries().size()); ++tag)
  {
    if (form.problem().pair_of_slave(tag) == nullptr) continue;
    const std::vector<std::size_t> shown = shown_segments(form, tag, face_of);
    if (n_segments <= limits.segments)
      pairs.push_back(segments_of(form, u, tag, shown, face_of, k));
    else
      for (const bool of_slave : {true, false})
        pairs.push_back(means_of(form, u, tag, shown, face_of, of_slave));
  }
  return pairs;
}

template <int dim>
std::vector<BodyInterface<dim>> body_interfaces(const contact::NitscheForm<dim>& form)
{
  const std::vector<int> body_of = mesh::number_bodies(form.space().mesh()).of_cell;
  std::map<std::array<Index, 2>, std::pair<BodyInterface<dim>, Tensor<dim>>> of_bodies;
  for (const contact::ContactSegment<dim>& segment : form.segments())
  {
    if (!segment.master) continue;
    const std::array<Index, 2> bodies = {body_of[segment.slave.facet.cell],
                                         body_of[segment.master->facet.cell]};
    if (bodies[0] == bodies[1]) continue;
    auto& [interface, squares] =
        of_bodies.try_emplace(bodies, BodyInterface<dim>{bodies}, Tensor<dim>::Zero()).first->second;
    interface.measure += segment.measure;
    interface.normal += segment.measure * segment.normal;
    squares += segment.measure * segment.normal * segment.normal.transpose();
  }
  std::vector<BodyInterface<dim>> interfaces;
  for (auto& [bodies, sums] : of_bodies)
  {
    auto& [interface, squares] = sums;
    interface.normal /= interface.measure;
    interface.axis = symmetric_eigen(squares).vectors.col(0);
    interfaces.push_back(interface);
  }
  return interfaces;
}

template std::vector<BodyInterface<2>> body_interfaces(const contact::NitscheForm<2>&);
template std::vector<BodyInterface<3>> body_interfaces(const contact::NitscheForm<3>&);

}  // namespace tribound::app
