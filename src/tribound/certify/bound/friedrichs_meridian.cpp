#include "tribound/certify/bound/friedrichs_meridian.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <unordered_map>
#include <utility>
#include <vector>

#include "tribound/certify/bound/constants.h"
#include "tribound/contact/nitsche/segment.h"
#include "tribound/mesh/geometry.h"
#include "tribound/problem/weights.h"

namespace tribound::certify
{

namespace
{

constexpr double infinite = std::numeric_limits<double>::infinity();

/// How the path of a cell continues to its root.
struct Step
{
  double length = infinite;  ///< L_T, as far as is known
  double entry = 0;          ///< c_{T,F} of the facet F towards the root
  Index parent = -1;         ///< the next cell; -1: F is the root
};

/// A cell that a path may reach.
struct Reached
{
  Step step;
  Index cell;

  bool operator<(const Reached& other) const  // the shortest path comes first out of the queue
  {
    return step.length > other.step.length;
  }
};

/// Parts of facets of two bodies that lie opposite each other, from the side of the first.
struct Bridge
{
  double exit;   ///< c_{T,k} of the part k in the cell of the first
  double entry;  ///< that in the cell of the other
  Index next;    ///< that cell
  double jump;   ///< the square of the constant of what lies between them
};

/// The paths of all cells, shortest first.
class Paths
{
 public:
  Paths(const problem::Problem<2>& problem, const mesh::Mesh<2>& mesh)
      : problem_(problem), mesh_(mesh), steps_(mesh.n_cells())
  {
    for (const contact::ContactSegment<2>& segment : contact::contact_segments(problem, mesh, 1.0))
      if (segment.master) add_bridges(segment);
    start_at_roots();
    while (!queue_.empty())
    {
      const auto [step, cell] = queue_.top();
      queue_.pop();
      if (steps_[cell].length < infinite) continue;
      steps_[cell] = step;
      order_.push_back(cell);
      reach_from(cell);
    }
  }

  /// Only if all cells have paths.
  [[nodiscard]] bool is_complete() const { return order_.size() == steps_.size(); }

  /// C_z^2; S_F of a root is S_T of its cell.
  [[nodiscard]] double largest_square() const
  {
    std::vector<double> sums(steps_.size(), 0.0);  // S_T
    double largest = 0;
    for (auto cell = order_.rbegin(); cell != order_.rend(); ++cell)
    {
      const Step& step = steps_[*cell];
      sums[*cell] += weighted_area(*cell) * step.length;
      if (step.parent >= 0) sums[step.parent] += sums[*cell];
      largest =
          std::max(largest, std::pow(poincare_constant(mesh::cell_diameter(mesh_, *cell)), 2) + sums[*cell]);
    }
    return largest;
  }

 private:
  [[nodiscard]] double weighted_area(Index cell) const
  {
    return mesh::cell_map(mesh_, cell).measure() *
           mean_weight<2>(problem_, mesh::points_of(mesh_.vertices(), mesh_.cell(cell)));
  }
  /// |F|_r
  [[nodiscard]] double weighted_length(Index cell, int local) const
  {
    return mesh::facet_geometry(mesh_, cell, local).measure *
           mean_weight<2>(problem_,
                          mesh::points_of(mesh_.vertices(), mesh::facet_vertices(mesh_.cell(cell), local)));
  }
  /// c_{T,F}, or of a part of F with the given |k|_r c_{T,k}.
  [[nodiscard]] double crossing(Index cell, int local, double length) const
  {
    return meridian_trace_constant(mesh::cell_diameter(mesh_, cell),
                                   mesh::facet_geometry(mesh_, cell, local).measure,
                                   mesh::cell_map(mesh_, cell).measure()) /
           std::sqrt(length);
  }
  [[nodiscard]] double crossing(Index cell, int local) const
  {
    return crossing(cell, local, weighted_length(cell, local));
  }

  void add_bridges(const contact::ContactSegment<2>& segment)
  {
    const auto length = [&](const contact::SegmentSide<2>& side)
    {
      const auto map = contact::simplex_map(mesh_, side);
      return map.measure * problem_.weight(map(Point<1>::Constant(0.5)));
    };
    const auto& [slave, master] = std::pair(segment.slave.facet, segment.master->facet);
    const double on_slave = crossing(slave.cell, slave.local, length(segment.slave));
    const double on_master = crossing(master.cell, master.local, length(*segment.master));
    const double jump = segment.h / length(segment.slave);
    across_.emplace(slave.cell, Bridge{on_slave, on_master, master.cell, jump});
    across_.emplace(master.cell, Bridge{on_master, on_slave, slave.cell, jump});
  }

  void start_at_roots()
  {
    for (const mesh::BoundaryFacet& facet : mesh_.boundary())
    {
      const auto& condition = problem_.boundary(facet.tag);
      const bool is_fixed = condition.clamps(1);
      const double length = weighted_length(facet.cell, facet.local);
      if (length == 0 || !(is_fixed || condition.is_in_norm())) continue;
      const double root =
          is_fixed ? 0 : mesh::facet_geometry(mesh_, facet.cell, facet.local).diameter / length;
      const double entry = crossing(facet.cell, facet.local);
      queue_.push({{root + entry * entry, entry, -1}, facet.cell});
    }
  }

  void reach_from(Index cell)
  {
    for (int local = 0; local < 3; ++local)
    {
      const Index facet = mesh_.topology().cell_facets[cell][local];
      const auto [first, second] = mesh_.topology().facet_cells[facet];
      const Index next = first == cell ? second : first;
      if (next >= 0)
        reach(cell,
              {crossing(cell, local), crossing(next, mesh_.topology().local_facet(next, facet)), next, 0});
    }
    const auto [first, last] = across_.equal_range(cell);
    for (auto bridge = first; bridge != last; ++bridge) reach(cell, bridge->second);
  }

  void reach(Index cell, const Bridge& bridge)
  {
    const auto& [exit, entry, next, jump] = bridge;
    if (steps_[next].length < infinite) return;
    const Step& step = steps_[cell];
    const double before = step.length - step.entry * step.entry;
    const double through = step.entry + exit;
    queue_.push({{before + through * through + jump + entry * entry, entry, cell}, next});
  }

  const problem::Problem<2>& problem_;
  const mesh::Mesh<2>& mesh_;
  std::unordered_multimap<Index, Bridge> across_;  ///< by cell
  std::vector<Step> steps_;
  std::vector<Index> order_;  ///< cells after those towards their roots
  std::priority_queue<Reached> queue_;
};

}  // namespace

double meridian_friedrichs(const problem::Problem<2>& problem, const mesh::Mesh<2>& mesh)
{
  double radius = 0;
  for (const Point<2>& x : mesh.vertices()) radius = std::max(radius, x[0]);
  const Paths paths(problem, mesh);
  return paths.is_complete() ? std::max(radius, std::sqrt(paths.largest_square())) : infinite;
}

}  // namespace tribound::certify
