#include "tribound/mesh/cut_open.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "tribound/base/sorted.h"
#include "tribound/mesh/describe.h"
#include "tribound/mesh/verify.h"

namespace tribound::mesh
{

namespace
{

/// A cut facet, seen from one of its cells.
struct FacetSide
{
  Index facet;
  Index cell;
};

template <int dim>
class Cut
{
 public:
  Cut(MeshData<dim>& data, const Topology<dim>& topology)
      : data_(data),
        topology_(topology),
        joint_(topology.facets.size(), -1),
        slave_(topology.facets.size(), -1)
  {
  }

  /// Marks the facets of the group with number `tag` and distinguishes their sides.
  void add_joint(int tag);
  void open();

 private:
  /// A vertex in 2D, an edge in 3D.
  using Ridge = std::array<Index, dim - 1>;

  /// Adds the facet to `facets` unless it is there.
  void mark(const TaggedFacet<dim>& tagged, std::vector<Index>& facets);
  /// Gives the side of `from` to all sides of facets of the joint that continue it or its opposite.
  void spread(FacetSide from, int tag, const std::map<Ridge, int>& n_facets);
  /// The side of a facet of the joint that is reached around the ridge; nothing if the body ends before.
  [[nodiscard]] std::optional<FacetSide> follow(FacetSide side, const Ridge& ridge, int tag) const;
  [[nodiscard]] std::array<Ridge, dim> ridges(Index facet) const;
  [[nodiscard]] Index across(Index facet, Index cell) const
  {
    const auto [first, second] = topology_.facet_cells[facet];
    return first == cell ? second : first;
  }
  /// Divides the cells around v into parts; all but the first get a copy of it.
  void split(Index v);
  /// Gives the edges between copies the nodes of the original edges.
  void copy_edge_nodes();

  MeshData<dim>& data_;
  const Topology<dim>& topology_;
  std::vector<int> joint_;              ///< per facet: its group if it is cut, else -1
  std::vector<Index> slave_;            ///< the cell on the slave's side of a cut facet
  std::multimap<Index, Index> copies_;  ///< of a vertex
};

template <int dim>
void Cut<dim>::mark(const TaggedFacet<dim>& tagged, std::vector<Index>& facets)
{
  const auto fail = [&](const std::string& problem, const std::string& hint)
  {
    throw InputError(data_.source,
                     fmt::format("{} of joint \"{}\" {}", describe_facet<dim>(data_, tagged.vertices),
                                 data_.boundary_names[tagged.tag], problem),
                     hint);
  };
  const Index f = topology_.facet(tagged.vertices);
  if (f < 0)
    fail(fmt::format("is not {} of any cell", dim == 2 ? "an edge" : "a face"),
         "the joint must be embedded in the mesh: BooleanFragments or \"Curve{...} In Surface\" in a .geo");
  if (topology_.facet_cells[f][1] < 0)
    fail("lies on the boundary", "a joint is inside; for two boundaries that touch give slave and master");
  if (joint_[f] >= 0 && joint_[f] != tagged.tag)
    fail(fmt::format("is also in joint \"{}\"", data_.boundary_names[joint_[f]]),
         "a facet is part of one joint; take it out of the other");
  if (joint_[f] < 0) facets.push_back(f);
  joint_[f] = tagged.tag;
}

template <int dim>
auto Cut<dim>::ridges(Index facet) const -> std::array<Ridge, dim>
{
  std::array<Ridge, dim> result;
  for (int i = 0; i < dim; ++i) result[i] = facet_vertices(topology_.facets[facet], i);
  return result;
}

template <int dim>
void Cut<dim>::add_joint(int tag)
{
  std::vector<Index> facets;
  for (const TaggedFacet<dim>& tagged : data_.facets)
    if (tagged.tag == tag) mark(tagged, facets);
  std::map<Ridge, int> n_facets;
  for (const Index f : facets)
    for (const Ridge& ridge : ridges(f)) ++n_facets[ridge];
  for (const Index f : facets)
  {
    if (slave_[f] >= 0) continue;
    slave_[f] = std::ranges::min(topology_.facet_cells[f]);
    spread({f, slave_[f]}, tag, n_facets);
  }
}

template <int dim>
void Cut<dim>::spread(FacetSide from, int tag, const std::map<Ridge, int>& n_facets)
{
  std::vector<Index> open{from.facet};
  while (!open.empty())
  {
    const Index f = open.back();
    open.pop_back();
    for (const Ridge& ridge : ridges(f))
    {
      if (n_facets.at(ridge) < 2) continue;
      for (const Index cell : topology_.facet_cells[f])
      {
        const std::optional<FacetSide> next = follow({f, cell}, ridge, tag);
        if (!next) continue;
        const Index slave = cell == slave_[f] ? next->cell : across(next->facet, next->cell);
        if (slave_[next->facet] < 0)
        {
          slave_[next->facet] = slave;
          open.push_back(next->facet);
        }
        else if (slave_[next->facet] != slave)
          throw InputError(data_.source,
                           fmt::format("the two sides of joint \"{}\" cannot be told apart at {}",
                                       data_.boundary_names[tag], describe(data_.vertices[ridge[0]])),
                           "a joint is a surface with two sides that does not branch; give each branch a "
                           "group of its own");
      }
    }
  }
}

template <int dim>
std::optional<FacetSide> Cut<dim>::follow(FacetSide side, const Ridge& ridge, int tag) const
{
  const auto contains_ridge = [&](Index facet)
  {
    const auto& vertices = topology_.facets[facet];
    return std::ranges::all_of(ridge, [&](Index v) { return std::ranges::count(vertices, v) > 0; });
  };
  do
  {
    const auto& facets = topology_.cell_facets[side.cell];
    side.facet = *std::ranges::find_if(
        facets, [&](Index facet) { return facet != side.facet && contains_ridge(facet); });
    if (joint_[side.facet] == tag) return side;
    side.cell = across(side.facet, side.cell);
  } while (side.cell >= 0);
  return std::nullopt;
}

template <int dim>
void Cut<dim>::split(Index v)
{
  const std::span<const Index> star(topology_.vertex_cells.begin() + topology_.vertex_cells_begin[v],
                                    topology_.vertex_cells.begin() + topology_.vertex_cells_begin[v + 1]);
  std::map<Index, Index> vertex_of;  // cell: the copy
  for (const Index first : star)
  {
    if (vertex_of.contains(first)) continue;
    Index copy = v;
    if (!vertex_of.empty())
    {
      copy = static_cast<Index>(data_.vertices.size());
      data_.vertices.push_back(Point<dim>(data_.vertices[v]));
      copies_.emplace(v, copy);
    }
    std::vector<Index> open{first};
    vertex_of[first] = copy;
    while (!open.empty())
    {
      const Index cell = open.back();
      open.pop_back();
      for (const Index facet : topology_.cell_facets[cell])
      {
        const auto& corners = topology_.facets[facet];
        const Index next = across(facet, cell);
        if (joint_[facet] >= 0 || next < 0 || std::ranges::find(corners, v) == corners.end()) continue;
        if (vertex_of.emplace(next, copy).second) open.push_back(next);
      }
    }
  }
  for (const auto& [cell, copy] : vertex_of) std::ranges::replace(data_.cells[cell], v, copy);
}

template <int dim>
void Cut<dim>::copy_edge_nodes()
{
  const auto versions = [&](Index v)
  {
    std::vector<Index> all{v};
    for (auto [it, end] = copies_.equal_range(v); it != end; ++it) all.push_back(it->second);
    return all;
  };
  std::vector<EdgeNode<dim>> all;
  for (const auto& [ends, position] : data_.edge_nodes)
    for (const Index a : versions(ends[0]))
      for (const Index b : versions(ends[1])) all.push_back({{a, b}, position});
  data_.edge_nodes = std::move(all);
}

template <int dim>
void Cut<dim>::open()
{
  std::vector<Index> vertices;
  for (std::size_t f = 0; f < joint_.size(); ++f)
    if (joint_[f] >= 0)
      vertices.insert(vertices.end(), topology_.facets[f].begin(), topology_.facets[f].end());
  sort_and_unite(vertices);
  for (const Index v : vertices) split(v);
  copy_edge_nodes();

  const auto seen_from = [&](Index f, Index cell)
  { return facet_vertices(data_.cells[cell], topology_.local_facet(cell, f)); };
  std::map<int, int> other;  // group of a joint: of its other side
  std::vector<TaggedFacet<dim>> facets;
  for (TaggedFacet<dim>& tagged : data_.facets)
  {
    const Index f = topology_.facet(tagged.vertices);
    if (f < 0)  // an error that others report
      facets.push_back(tagged);
    else if (joint_[f] < 0)
      facets.push_back({seen_from(f, topology_.facet_cells[f][0]), tagged.tag});
    else if (joint_[f] != tagged.tag)
      throw InputError(data_.source,
                       fmt::format("{} of joint \"{}\" is also in group \"{}\"",
                                   describe_facet<dim>(data_, tagged.vertices),
                                   data_.boundary_names[joint_[f]], data_.boundary_names[tagged.tag]),
                       "a facet is in one group; take it out of the other");
    else
    {
      const auto [it, is_new] = other.try_emplace(tagged.tag, static_cast<int>(data_.boundary_names.size()));
      if (is_new)
      {
        const std::string name = data_.boundary_names[tagged.tag];
        if (std::ranges::find(data_.boundary_names, name + ".other") != data_.boundary_names.end())
          throw InputError(
              data_.source, fmt::format("there is a group \"{}.other\"", name),
              fmt::format("it is what the other side of joint \"{}\" is called; rename it", name));
        data_.boundary_names.push_back(name + ".other");
        data_.interfaces.push_back({{{{name}, {name + ".other"}}}});
      }
      facets.push_back({seen_from(f, slave_[f]), tagged.tag});
      facets.push_back({seen_from(f, across(f, slave_[f])), it->second});
    }
  }
  data_.facets = std::move(facets);
}

}  // namespace

template <int dim>
void cut_open(MeshData<dim>& data, std::span<const std::string> joints)
{
  if (joints.empty()) return;
  check_arrays(data);
  const Topology<dim> topology = build_topology<dim>(static_cast<Index>(data.vertices.size()), data.cells);
  check_facets(data, topology);
  Cut<dim> cut(data, topology);
  for (const std::string& name : joints)
    if (const auto it = std::ranges::find(data.boundary_names, name); it != data.boundary_names.end())
      cut.add_joint(static_cast<int>(it - data.boundary_names.begin()));
  cut.open();
}

template void cut_open(MeshData<2>&, std::span<const std::string>);
template void cut_open(MeshData<3>&, std::span<const std::string>);

}  // namespace tribound::mesh
