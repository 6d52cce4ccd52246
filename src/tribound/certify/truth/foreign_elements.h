#pragma once

/// @file foreign_elements.h
/// The elements of another program, found by the coordinates of their nodes. Internal to
/// foreign_solution.cpp.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "tribound/certify/truth/foreign_nodes.h"
#include "tribound/certify/truth/foreign_solution.h"
#include "tribound/certify/truth/point_grid.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/import/middle_rule.h"

namespace tribound::certify
{

/// Distances of nodes that are one, as parts of the size of the mesh. The second is for files with six
/// digits.
inline constexpr std::array same_place = {1e-6, 1e-5};

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

/// Finds the element in which a cell lies, and a value at a node of the cell as a sum of values of the file.
template <int dim>
class ForeignElements
{
 public:
  ForeignElements(const mesh::ImportedSolution& theirs, const mesh::Mesh<dim>& mesh)
      : theirs_(theirs), mesh_(mesh), where_(theirs.mesh.source)
  {
    for (const Point<dim>& x : mesh.vertices()) box_.add(x);
    for (const Point<3>& x : theirs.mesh.nodes) nodes_.push_back(in_plane<dim>(x));
    choose_tolerance();
  }

 protected:
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

  void look_at_elements()
  {
    index_elements();
    result_.degree = 1;
    result_.is_exact = true;
    for (const mesh::ElementBlock& block : theirs_.mesh.cells)
    {
      const bool is_simplex = mesh::is_simplex(block.type.shape);
      result_.degree = std::max(result_.degree, is_simplex ? mesh::order_of(block.type) : 2);
      if (is_simplex)
      {
        const auto& nodes = simplices_.emplace_back(std::in_place, block, nodes_, straight_);
        result_.curved_distance = std::max(result_.curved_distance, nodes->curved_distance());
        continue;
      }
      simplices_.emplace_back();
      result_.is_exact = false;
      if (mesh::has_middles(block.type)) measure_curves(block);
    }
    if (result_.curved_distance > straight_) result_.is_exact = false;
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

  void measure_curves(const mesh::ElementBlock& block)
  {
    const mesh::ShapeTable& table = mesh::table_of(block.type.shape);
    for (std::size_t e = 0; e < block.size(); ++e)
      for (int k = 0; k < table.n_edges; ++k)
      {
        const auto nodes = block.element(e);
        const Point<dim> middle = (nodes_[nodes[table.edges[k][0]]] + nodes_[nodes[table.edges[k][1]]]) / 2;
        result_.curved_distance =
            std::max(result_.curved_distance, (nodes_[nodes[table.n_corners + k]] - middle).norm());
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

  Place place_of(const std::array<Point<dim>, dim + 1>& cell)
  {
    std::array<Index, dim + 1> clusters;
    for (int v = 0; v <= dim; ++v) clusters[v] = cluster_at(cell[v]);
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
    throw InputError(where_,
                     fmt::format("has no element with the corners of the cell at ({:.6g})",
                                 fmt::join(centre_of(cell), ", ")),
                     other_mesh);
  }

  [[nodiscard]] static Point<dim> centre_of(const std::array<Point<dim>, dim + 1>& cell)
  {
    Point<dim> centre = Point<dim>::Zero();
    for (const Point<dim>& x : cell) centre += x / (dim + 1);
    return centre;
  }

  Index cluster_at(const Point<dim>& x)
  {
    const std::vector<Index> found = grid_->near(x);
    if (found.empty()) fail_missing(x);
    const Index node = nearest(found, x);
    result_.node_distance = std::max(result_.node_distance, (nodes_[node] - x).norm());
    return clusters_[node];
  }

  /// At a point of the cell.
  [[nodiscard]] Terms terms_of(const Place& place, const Barycentric<dim>& lambda) const
  {
    const mesh::ElementBlock& block = theirs_.mesh.cells[place.element.block];
    const auto& simplices = simplices_[place.element.block];
    Barycentric<dim> of_corners{};
    for (int v = 0; simplices && v <= dim; ++v) of_corners[place.corners[v]] = lambda[v];
    Terms terms;
    for (const auto& [slot, weight] :
         simplices ? simplices->rule(of_corners) : quadratic_rule(block.type, place, lambda))
      terms.push_back({block.element(place.element.number)[slot], place.element.entry + slot, weight});
    return terms;
  }

  /// Of the quadratic function on a cell that is cut from an element.
  [[nodiscard]] static ValueRule quadratic_rule(const mesh::ElementType& type, const Place& place,
                                                const Barycentric<dim>& lambda)
  {
    static constexpr mesh::ElementType quadratic = dim == 2 ? mesh::ElementType{mesh::Shape::triangle, 6}
                                                            : mesh::ElementType{mesh::Shape::tetrahedron, 10};
    ValueRule rule;
    for (const mesh::NodeIndex& node : mesh::simplex_nodes(quadratic))
    {
      const double weight = mesh::shape_function(node, lambda);
      if (std::abs(weight) <= no_weight) continue;
      std::vector<int> ends;
      for (int v = 0; v <= dim; ++v)
        if (node[v] > 0) ends.push_back(place.corners[v]);
      const ValueRule at_node =
          ends.size() == 1 ? ValueRule{{ends[0], 1.0}} : mesh::middle_rule(type, ends[0], ends[1]);
      for (const auto& [slot, part] : at_node) rule.emplace_back(slot, weight * part);
    }
    return rule;
  }

  [[nodiscard]] std::int64_t number_of(Index node) const
  {
    const auto& numbers = theirs_.mesh.node_numbers;
    return static_cast<std::size_t>(node) < numbers.size() ? numbers[node] : node + 1;
  }

  /// Tells meshes of another size or at another place from others.
  [[noreturn]] void fail_missing(const Point<dim>& x) const
  {
    mesh::BoundingBox<dim> box;
    for (const Point<dim>& node : nodes_) box.add(node);
    const double size = (box.upper - box.lower).norm() / (box_.upper - box_.lower).norm();
    const Point<dim> shift = (box.upper + box.lower - box_.upper - box_.lower) / 2;
    std::string hint = other_mesh;
    if (std::abs(size - 1) > 1e-3)
      hint = fmt::format("their mesh is {:.4g} times as large: other units?", size);
    else if (shift.norm() > tolerance_)
      hint = fmt::format("their mesh is shifted by ({:.4g})", fmt::join(shift, ", "));
    throw InputError(where_, fmt::format("has no node at ({:.9g}), a vertex of the mesh", fmt::join(x, ", ")),
                     hint);
  }

  static constexpr const char* other_mesh =
      "the solution on the mesh of the case; on another one it is judged with --interpolate";

  const mesh::ImportedSolution& theirs_;
  const mesh::Mesh<dim>& mesh_;
  Where where_;
  mesh::BoundingBox<dim> box_{};
  double tolerance_ = 0;
  double straight_ = 0;  ///< edges whose middles are no farther away count as straight
  std::vector<Point<dim>> nodes_{};
  std::optional<PointGrid<dim>> grid_{};
  std::vector<Index> clusters_{};
  std::unordered_map<Index, std::vector<Element>> elements_of_{};
  std::vector<std::optional<ForeignNodes<dim>>> simplices_{};  ///< per block; none for other shapes
  ForeignSolution<dim> result_{};
};

}  // namespace tribound::certify
