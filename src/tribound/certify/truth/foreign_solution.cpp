#include "tribound/certify/truth/foreign_solution.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>

#include "tribound/fem/degree.h"
#include "tribound/fem/space.h"
#include "tribound/mesh/box_tree.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/import/middle_rule.h"

namespace tribound::certify
{

namespace
{

/// Distances of nodes that are one, as parts of the size of the mesh. The second is for files with six
/// digits.
constexpr std::array same_place = {1e-6, 1e-5};

/// Finds points by their coordinates: those in a cell of a grid and in its neighbours.
template <int dim>
class PointGrid
{
 public:
  PointGrid(std::span<const Point<dim>> points, double tolerance) : points_(points), tolerance_(tolerance)
  {
    for (std::size_t i = 0; i < points.size(); ++i) cells_[key(points[i])].push_back(static_cast<Index>(i));
  }

  /// The points at most as far as the tolerance, ascending.
  [[nodiscard]] std::vector<Index> near(const Point<dim>& x) const
  {
    std::vector<Index> found;
    for_each_neighbour(key(x),
                       [&](const Key& neighbour)
                       {
                         const auto cell = cells_.find(neighbour);
                         if (cell == cells_.end()) return;
                         for (const Index i : cell->second)
                           if ((points_[i] - x).norm() <= tolerance_) found.push_back(i);
                       });
    std::ranges::sort(found);
    return found;
  }

 private:
  using Key = std::array<std::int64_t, dim>;
  struct Hash
  {
    std::size_t operator()(const Key& key) const
    {
      std::size_t hash = 0;
      for (const std::int64_t k : key) hash = 1000003 * hash + static_cast<std::size_t>(k);
      return hash;
    }
  };

  [[nodiscard]] Key key(const Point<dim>& x) const
  {
    Key key;
    for (int d = 0; d < dim; ++d) key[d] = static_cast<std::int64_t>(std::floor(x[d] / (4 * tolerance_)));
    return key;
  }

  template <class Visit>
  static void for_each_neighbour(const Key& centre, const Visit& visit)
  {
    constexpr int n = dim == 2 ? 9 : 27;
    for (int i = 0; i < n; ++i)
    {
      Key key = centre;
      for (int d = 0, rest = i; d < dim; ++d, rest /= 3) key[d] += rest % 3 - 1;
      visit(key);
    }
  }

  std::span<const Point<dim>> points_;
  double tolerance_;
  std::unordered_map<Key, std::vector<Index>, Hash> cells_;
};

/// A value as weights of nodes of the file, or of entries of the nodes of its elements.
struct Term
{
  Index node;
  std::size_t entry;
  double weight;
};
using Terms = std::vector<Term>;

template <int dim>
Point<dim> in_plane(const Point<3>& x)
{
  return x.head<dim>();
}

template <int dim>
class Carrier
{
 public:
  Carrier(const mesh::ImportedSolution& theirs, const mesh::Mesh<dim>& mesh)
      : theirs_(theirs), mesh_(mesh), where_(theirs.mesh.source)
  {
    for (const Point<dim>& x : mesh.vertices()) box_.add(x);
    for (const Point<3>& x : theirs.mesh.nodes) nodes_.push_back(in_plane<dim>(x));
    choose_tolerance();
  }

  ForeignSolution<dim> carry()
  {
    if (nodes_.empty()) throw InputError(where_, "has no nodes", "the solution on the mesh of the case");
    theirs_.mesh.cells.empty() ? carry_points() : carry_elements();
    return std::move(result_);
  }

 private:
  /// The smallest with which every vertex is found. Digits that are lost count by the largest coordinate.
  void choose_tolerance()
  {
    const double size = std::max({(box_.upper - box_.lower).norm(), box_.upper.cwiseAbs().maxCoeff(),
                                  box_.lower.cwiseAbs().maxCoeff()});
    straight_ = same_place.back() * size;
    for (const double part : same_place)
    {
      tolerance_ = part * size;
      grid_.emplace(nodes_, tolerance_);
      if (std::ranges::none_of(mesh_.vertices(), [&](const auto& x) { return grid_->near(x).empty(); }))
        return;
    }
  }

  [[nodiscard]] Index nearest(std::span<const Index> nodes, const Point<dim>& x) const
  {
    return *std::ranges::min_element(nodes, {}, [&](Index i) { return (nodes_[i] - x).norm(); });
  }

  [[noreturn]] void fail_digits(const Point<dim>& x) const
  {
    throw InputError(where_,
                     fmt::format("does not tell two nodes at ({:.9g}) from each other", fmt::join(x, ", ")),
                     "coordinates with more digits");
  }

  // ---- with elements

  void carry_elements()
  {
    index_elements();
    result_.degree = 1;
    result_.is_exact = true;
    for (const mesh::ElementBlock& block : theirs_.mesh.cells)
    {
      if (!is_linear_simplex(block.type)) result_.degree = 2;
      if (!is_simplex(block.type)) result_.is_exact = false;
    }
    measure_curves();
    if (result_.curved_distance > straight_) result_.is_exact = false;
    const fem::LagrangeSpace<dim> space(mesh_, result_.degree);
    start(space);
    for (Index c = 0; c < mesh_.n_cells(); ++c)
    {
      const Place place = place_of(c);
      for (int i = 0; i < space.basis().n_nodes(); ++i)
        set(space, c, i, terms_of(place, space.basis().node(i)));
    }
    finish(result_.is_exact ? "their function"
                            : "the piecewise quadratic function that takes their values at the nodes");
  }

  [[nodiscard]] static bool is_simplex(const mesh::ElementType& type)
  {
    return type.shape == mesh::Shape::triangle || type.shape == mesh::Shape::tetrahedron;
  }
  [[nodiscard]] static bool is_linear_simplex(const mesh::ElementType& type)
  {
    return is_simplex(type) && !mesh::has_middles(type);
  }

  /// Nodes in one place are one cluster, named by the first of them.
  void index_elements()
  {
    clusters_.resize(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) clusters_[i] = grid_->near(nodes_[i]).front();
    std::size_t entry = 0;
    for (std::size_t b = 0; b < theirs_.mesh.cells.size(); ++b)
    {
      const mesh::ElementBlock& block = theirs_.mesh.cells[b];
      const mesh::ShapeTable& table = mesh::table_of(block.type.shape);
      if (table.dim != dim)
        throw InputError(where_, fmt::format("is in {}D, the mesh in {}D", table.dim, dim),
                         "the solution on the mesh of the case");
      for (std::size_t e = 0; e < block.size(); ++e, entry += block.type.n_nodes)
        for (int corner = 0; corner < table.n_corners; ++corner)
        {
          const auto nodes = block.element(e);
          std::vector<Element>& elements = elements_of_[clusters_[nodes[corner]]];
          if (elements.empty() || elements.back().block != b || elements.back().number != e)
            elements.push_back({b, e, entry});
          else if (std::ranges::count(nodes.first(table.n_corners), nodes[corner]) <
                   2)  // a prism as hexahedron has
            fail_digits(nodes_[nodes[corner]]);
        }
    }
  }

  void measure_curves()
  {
    for (const mesh::ElementBlock& block : theirs_.mesh.cells)
    {
      const mesh::ShapeTable& table = mesh::table_of(block.type.shape);
      if (!mesh::has_middles(block.type)) continue;
      for (std::size_t e = 0; e < block.size(); ++e)
        for (int k = 0; k < table.n_edges; ++k)
        {
          const auto nodes = block.element(e);
          const Point<dim> middle = (nodes_[nodes[table.edges[k][0]]] + nodes_[nodes[table.edges[k][1]]]) / 2;
          result_.curved_distance =
              std::max(result_.curved_distance, (nodes_[nodes[table.n_corners + k]] - middle).norm());
        }
    }
  }

  struct Element
  {
    std::size_t block;
    std::size_t number;
    std::size_t entry;  ///< of its first node among those of all elements
  };
  /// Where a cell lies: in an element, with its vertices at these corners.
  struct Place
  {
    Element element;
    std::array<int, dim + 1> corners;
  };

  Place place_of(Index cell)
  {
    std::array<Index, dim + 1> clusters;
    for (int v = 0; v <= dim; ++v) clusters[v] = cluster_at(mesh_.cell(cell)[v]);
    for (const Element& element : elements_of_[clusters[0]])
    {
      const mesh::ElementBlock& block = theirs_.mesh.cells[element.block];
      const int n_corners = mesh::table_of(block.type.shape).n_corners;
      Place place{element, {}};
      bool has_all = true;
      for (int v = 0; v <= dim && has_all; ++v)
      {
        int corner = 0;
        while (corner < n_corners && clusters_[block.element(element.number)[corner]] != clusters[v])
          ++corner;
        has_all = corner < n_corners;
        place.corners[v] = corner;
      }
      if (has_all) return place;
    }
    Point<dim> centre = Point<dim>::Zero();
    for (const Index v : mesh_.cell(cell)) centre += mesh_.vertex(v) / (dim + 1);
    throw InputError(
        where_,
        fmt::format("has no element with the corners of the cell at ({:.6g})", fmt::join(centre, ", ")),
        "the solution on the mesh of the case; on another one it is not judged");
  }

  Index cluster_at(Index vertex)
  {
    const Point<dim>& x = mesh_.vertex(vertex);
    const std::vector<Index> found = grid_->near(x);
    if (found.empty()) fail_missing(x);
    const Index node = nearest(found, x);
    result_.node_distance = std::max(result_.node_distance, (nodes_[node] - x).norm());
    return clusters_[node];
  }

  [[nodiscard]] Terms terms_of(const Place& place, const std::array<int, dim + 1>& node) const
  {
    const mesh::ElementBlock& block = theirs_.mesh.cells[place.element.block];
    std::vector<int> ends;
    for (int v = 0; v <= dim; ++v)
      if (node[v] > 0) ends.push_back(place.corners[v]);
    const auto rule = ends.size() == 1 ? std::vector<std::pair<int, double>>{{ends[0], 1.0}}
                                       : mesh::middle_rule(block.type, ends[0], ends[1]);
    Terms terms;
    for (const auto& [slot, weight] : rule)
      terms.push_back({block.element(place.element.number)[slot], place.element.entry + slot, weight});
    return terms;
  }

  // ---- without

  /// The largest degree whose nodes are all there.
  void carry_points()
  {
    for (int degree = fem::max_degree; degree >= 1; --degree)
    {
      const fem::LagrangeSpace<dim> space(mesh_, degree);
      if (!try_points(space)) continue;
      finish(fmt::format("the function of degree {} with their values at its nodes", degree));
      return;
    }
    for (const Point<dim>& x : mesh_.vertices())
      if (grid_->near(x).empty()) fail_missing(x);
  }

  bool try_points(const fem::LagrangeSpace<dim>& space)
  {
    const std::vector<Point<dim>> places = space.node_points();
    std::vector<Index> rows(places.size());
    for (std::size_t n = 0; n < places.size(); ++n)
    {
      const std::vector<Index> found = grid_->near(places[n]);
      if (found.empty()) return false;
      rows[n] = nearest(found, places[n]);
      result_.node_distance = std::max(result_.node_distance, (nodes_[rows[n]] - places[n]).norm());
      require_one_value(found);
    }
    result_.degree = space.degree();
    start(space);
    for (Index c = 0; c < mesh_.n_cells(); ++c)
      for (int i = 0; i < space.basis().n_nodes(); ++i)
      {
        const Index row = rows[space.cell_nodes(c)[i]];
        for (int j = 0; j < i; ++j)
          if (rows[space.cell_nodes(c)[j]] == row) fail_digits(nodes_[row]);
        set(space, c, i, {{row, 0, 1.0}});
      }
    return true;
  }

  /// Rows in one place may belong to either of two bodies.
  void require_one_value(const std::vector<Index>& rows) const
  {
    for (const Index row : rows)
      if ((theirs_.displacement[row] - theirs_.displacement[rows.front()]).norm() > 0)
        throw InputError(where_,
                         fmt::format("has two rows at ({:.6g}), and does not say to which body they belong",
                                     fmt::join(nodes_[row], ", ")),
                         "a format with elements, such as .vtu, or coordinates with more digits");
  }

  // ---- both

  void start(const fem::LagrangeSpace<dim>& space)
  {
    result_.u.assign(space.n_dofs(), std::numeric_limits<double>::quiet_NaN());
    if (!theirs_.stress.empty())
      result_.stress.assign(static_cast<std::size_t>(mesh_.n_cells()) * space.basis().n_nodes(),
                            Tensor<dim>::Zero());
    scale_ = 0;
    for (const Point<3>& u : theirs_.displacement)
      if (u.allFinite()) scale_ = std::max(scale_, u.cwiseAbs().maxCoeff());
  }

  void set(const fem::LagrangeSpace<dim>& space, Index cell, int i, const Terms& terms)
  {
    Point<dim> u = Point<dim>::Zero();
    std::array<double, 6> s{};
    for (const Term& term : terms)
    {
      u += term.weight * in_plane<dim>(theirs_.displacement[term.node]);
      if (theirs_.stress.empty()) continue;
      const auto& values = theirs_.stress[theirs_.stress_of_elements ? term.entry : term.node];
      for (std::size_t k = 0; k < s.size(); ++k) s[k] += term.weight * values[k];
    }
    if (!u.allFinite()) fail_value(terms, "displacement");
    const Index node = space.cell_nodes(cell)[i];
    for (int d = 0; d < dim; ++d)
    {
      double& value = result_.u[dim * static_cast<std::size_t>(node) + d];
      if (std::abs(value - u[d]) > 1e-6 * scale_)
        throw InputError(where_,
                         fmt::format("has two displacements at node {}, {} and {}",
                                     number_of(terms.front().node), value, u[d]),
                         "a displacement that is continuous on each body");
      value = u[d];
    }
    if (theirs_.stress.empty()) return;
    Tensor<dim>& tensor = result_.stress[static_cast<std::size_t>(cell) * space.basis().n_nodes() + i];
    if constexpr (dim == 2)
      tensor << s[0], s[3], s[3], s[1];
    else
      tensor << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    if (!tensor.allFinite()) fail_value(terms, "stress");
  }

  void finish(const std::string& function)
  {
    result_.read_as = fmt::format("degree {}, {}", result_.degree, function);
    if (result_.curved_distance > straight_)
      result_.read_as += fmt::format("; on straight cells, from which curved edges are up to {:.3g} away",
                                     result_.curved_distance);
  }

  [[nodiscard]] std::int64_t number_of(Index node) const
  {
    const auto& numbers = theirs_.mesh.node_numbers;
    return static_cast<std::size_t>(node) < numbers.size() ? numbers[node] : node + 1;
  }

  [[noreturn]] void fail_value(const Terms& terms, std::string_view what) const
  {
    throw InputError(where_, fmt::format("has no {} at node {}", what, number_of(terms.front().node)),
                     "a number for every node");
  }

  /// Tells meshes of another size or at another place from others.
  [[noreturn]] void fail_missing(const Point<dim>& x) const
  {
    mesh::BoundingBox<dim> box;
    for (const Point<dim>& node : nodes_) box.add(node);
    const double size = (box.upper - box.lower).norm() / (box_.upper - box_.lower).norm();
    const Point<dim> shift = (box.upper + box.lower - box_.upper - box_.lower) / 2;
    std::string hint = "the solution on the mesh of the case; on another one it is not judged";
    if (std::abs(size - 1) > 1e-3)
      hint = fmt::format("their mesh is {:.4g} times as large: other units?", size);
    else if (shift.norm() > tolerance_)
      hint = fmt::format("their mesh is shifted by ({:.4g})", fmt::join(shift, ", "));
    throw InputError(where_, fmt::format("has no node at ({:.9g}), a vertex of the mesh", fmt::join(x, ", ")),
                     hint);
  }

  const mesh::ImportedSolution& theirs_;
  const mesh::Mesh<dim>& mesh_;
  Where where_;
  mesh::BoundingBox<dim> box_{};
  double tolerance_ = 0;
  double straight_ = 0;  ///< edges whose middles are no farther away count as straight
  double scale_ = 0;     ///< the largest component of their displacement
  std::vector<Point<dim>> nodes_{};
  std::optional<PointGrid<dim>> grid_{};
  std::vector<Index> clusters_{};
  std::unordered_map<Index, std::vector<Element>> elements_of_{};
  ForeignSolution<dim> result_{};
};

}  // namespace

template <int dim>
ForeignSolution<dim> foreign_solution(const mesh::ImportedSolution& theirs, const mesh::Mesh<dim>& mesh)
{
  return Carrier<dim>(theirs, mesh).carry();
}

template ForeignSolution<2> foreign_solution(const mesh::ImportedSolution&, const mesh::Mesh<2>&);
template ForeignSolution<3> foreign_solution(const mesh::ImportedSolution&, const mesh::Mesh<3>&);

}  // namespace tribound::certify
