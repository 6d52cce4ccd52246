#include "tribound/adapt/merged_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <span>
#include <utility>

namespace tribound::adapt
{

namespace
{

template <int dim>
bool is_inside(const mesh::CellRecord<dim>& cell)
{
  return std::ranges::all_of(cell.tags, [](std::int32_t tag) { return tag == mesh::facet_inside; });
}

/// The local vertices of two cells whose union is a cell, each in the order of the union: the cell's end of
/// the bisected edge, the midpoint of the edge, then the common vertices.
template <int dim>
struct Pair
{
  std::array<std::array<int, dim + 1>, 2> order;

  Pair(const mesh::CellRecord<dim>& first, const mesh::CellRecord<dim>& second)
  {
    const auto place = [](const mesh::CellRecord<dim>& cell, const mesh::VertexName<dim>& name)
    { return static_cast<int>(std::ranges::find(cell.vertices, name) - cell.vertices.begin()); };
    for (int i = 0; i <= dim; ++i)
    {
      if (place(second, first.vertices[i]) > dim) order[0][0] = i;
      if (place(first, second.vertices[i]) > dim) order[1][0] = i;
    }
    const mesh::VertexName<dim> middle =
        mesh::middle(first.vertices[order[0][0]], second.vertices[order[1][0]]);
    order[0][1] = place(first, middle);
    order[1][1] = place(second, middle);
    for (int i = 0, k = 2; i <= dim; ++i)
      if (i != order[0][0] && i != order[0][1])
      {
        order[0][k] = i;
        order[1][k++] = place(second, first.vertices[i]);
      }
  }
};

/// Merges successive pairs.
template <int dim>
class Merger
{
 public:
  Merger(const fem::LagrangeBasis<dim>& basis, FieldCells<dim>& fields)
      : basis_(basis),
        fields_(fields),
        n_u_(static_cast<std::size_t>(dim) * basis.n_nodes()),
        n_stress_(fields.stress.size() / std::max<std::size_t>(fields.cells.size(), 1))
  {
  }

  /// Merges pairs of cells `depth` bisections deep.
  void merge(int depth)
  {
    std::size_t n = 0;
    for (std::size_t c = 0; c < fields_.cells.size(); ++c, ++n)
    {
      move(c, n);
      if (c + 1 < fields_.cells.size() && is_pair(fields_.cells[c], fields_.cells[c + 1], depth))
        unite(n, ++c);
    }
    fields_.cells.resize(n);
    fields_.u.resize(n * n_u_);
    fields_.stress.resize(n * n_stress_);
    if (!fields_.components.empty()) fields_.components.resize(n);
  }

 private:
  static bool is_pair(const mesh::CellRecord<dim>& first, const mesh::CellRecord<dim>& second, int depth)
  {
    return first.name.depth == depth && second.name.depth == depth && is_inside(first) && is_inside(second) &&
           first.name.parent() == second.name.parent();
  }

  void move(std::size_t from, std::size_t to)
  {
    if (from == to) return;
    fields_.cells[to] = fields_.cells[from];
    std::ranges::copy(u_of(from), u_of(to).begin());
    std::ranges::copy(stress_of(from), stress_of(to).begin());
    if (!fields_.components.empty()) fields_.components[to] = fields_.components[from];
  }

  /// Replaces cell `n` by its union with cell `other`.
  void unite(std::size_t n, std::size_t other)
  {
    mesh::CellRecord<dim>& cell = fields_.cells[n];
    const Pair<dim> pair(cell, fields_.cells[other]);
    unite_u(pair, u_of(n), u_of(other));
    unite_stress(stress_of(n), stress_of(other));
    if (!fields_.components.empty()) unite_components(fields_.components[n], fields_.components[other]);
    mesh::CellRecord<dim> whole = cell;
    whole.name = cell.name.parent();
    whole.vertices[0] = cell.vertices[pair.order[0][0]];
    whole.vertices[1] = fields_.cells[other].vertices[pair.order[1][0]];
    for (int k = 2; k <= dim; ++k) whole.vertices[k] = cell.vertices[pair.order[0][k]];
    cell = whole;
  }

  static void unite_components(certify::BoundComponents& first, const certify::BoundComponents& second)
  {
    const double stress = std::hypot(first.stress(), second.stress());
    for (const certify::Component& c : certify::all_components)
      first.*c.value = std::hypot(first.*c.value, second.*c.value);
    if (first.mor > 0) first.str_mor = stress;
  }

  void unite_u(const Pair<dim>& pair, std::span<double> first, std::span<const double> second)
  {
    std::vector<double> whole(n_u_);
    for (const int half : {0, 1})
    {
      const std::span<const double> u = half == 0 ? first : second;
      const auto& [nodes, table] = values_in(half, pair.order[half]);
      for (std::size_t q = 0; q < nodes.size(); ++q)
        for (int a = 0; a < dim; ++a)
        {
          double value = 0;
          for (int i = 0; i < basis_.n_nodes(); ++i)
            value += table.values_at(static_cast<int>(q))[i] * u[dim * i + a];
          whole[dim * nodes[q] + a] = value;
        }
    }
    std::ranges::copy(whole, first.begin());
  }

  /// Nodes of the union in one half, and the basis of the half at these.
  struct HalfNodes
  {
    std::vector<int> nodes;
    fem::Tabulation<dim> table;
  };

  /// Vertices 0 and 1 of the union are the ends of the edge. Its point with barycentric coordinates l lies in
  /// the half at the end with the larger one; there it has the coordinates l_own - l_other, 2 l_other, l_2,
  /// ...
  const HalfNodes& values_in(int half, const std::array<int, dim + 1>& order)
  {
    const auto [entry, is_new] = tables_.try_emplace({half, order});
    if (!is_new) return entry->second;
    std::vector<Point<dim>> points;
    for (int i = 0; i < basis_.n_nodes(); ++i)
    {
      std::array<int, dim + 1> l = basis_.node(i);
      if (half == 1) std::swap(l[0], l[1]);
      if (l[0] < l[1]) continue;
      l[0] -= l[1];
      l[1] *= 2;
      std::array<double, dim + 1> in_half{};
      for (int k = 0; k <= dim; ++k) in_half[order[k]] = static_cast<double>(l[k]) / basis_.degree();
      points.emplace_back(in_half.data() + 1);
      entry->second.nodes.push_back(i);
    }
    entry->second.table = basis_.tabulate(points);
    return entry->second;
  }

  /// In an orthonormal basis that begins with the constant: the mean, on twice the volume.
  void unite_stress(std::span<double> first, std::span<const double> second) const
  {
    const std::size_t n = n_stress_ / (dim * dim);
    for (std::size_t i = 0; i < n_stress_; ++i)
      first[i] = i % n == 0 ? (first[i] + second[i]) / std::sqrt(2.0) : 0.0;
  }

  std::span<double> u_of(std::size_t c) { return std::span(fields_.u).subspan(c * n_u_, n_u_); }
  std::span<double> stress_of(std::size_t c)
  {
    return std::span(fields_.stress).subspan(c * n_stress_, n_stress_);
  }

  const fem::LagrangeBasis<dim>& basis_;
  FieldCells<dim>& fields_;
  std::size_t n_u_;       ///< numbers per cell
  std::size_t n_stress_;  ///< numbers per cell
  std::map<std::pair<int, std::array<int, dim + 1>>, HalfNodes> tables_;
};

}  // namespace

template <int dim>
bool merge_cells(const Ranks& ranks, const fem::LagrangeBasis<dim>& basis, std::int64_t most,
                 FieldCells<dim>& fields)
{
  Merger<dim> merger(basis, fields);
  int depth = 0;
  for (const mesh::CellRecord<dim>& cell : fields.cells) depth = std::max(depth, cell.name.depth);
  const auto few = [&] { return ranks.sum(static_cast<std::int64_t>(fields.cells.size())) <= most; };
  for (depth = static_cast<int>(ranks.max(depth)); depth > 0 && !few(); --depth) merger.merge(depth);
  return few();
}

template bool merge_cells(const Ranks&, const fem::LagrangeBasis<2>&, std::int64_t, FieldCells<2>&);
template bool merge_cells(const Ranks&, const fem::LagrangeBasis<3>&, std::int64_t, FieldCells<3>&);

}  // namespace tribound::adapt
