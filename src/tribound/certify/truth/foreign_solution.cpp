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

#include "tribound/certify/truth/foreign_elements.h"
#include "tribound/fem/degree.h"
#include "tribound/fem/space.h"
#include "tribound/mesh/box_tree.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/import/simplices.h"

namespace tribound::certify
{

namespace
{

template <int dim>
class Carrier : private ForeignElements<dim>
{
 public:
  Carrier(const mesh::ImportedSolution& theirs, const mesh::Mesh<dim>& mesh, bool is_axisymmetric)
      : ForeignElements<dim>(theirs, mesh), is_axisymmetric_(is_axisymmetric)
  {
    if (is_axisymmetric && !theirs.stress.empty() && !theirs.stress_has_zz)
      throw InputError(where_, "has a stress without zz, which in bodies of revolution is the hoop stress",
                       "xx, yy, zz and xy are rr, zz, the hoop stress and rz");
  }

  ForeignSolution<dim> carry()
  {
    if (nodes_.empty()) throw InputError(where_, "has no nodes", "the solution on the mesh of the case");
    theirs_.mesh.cells.empty() ? carry_points() : carry_elements();
    return std::move(result_);
  }

  /// Their function at the nodes of the mesh, wherever their own are.
  ForeignSolution<dim> interpolate()
  {
    if (theirs_.mesh.cells.empty())
      throw InputError(where_, "has no elements: what is between its points is not known",
                       "a format with elements, such as .vtu");
    look_at_elements();
    result_.is_exact = false;
    const Pieces pieces = cut();
    const fem::LagrangeSpace<dim> space(mesh_, result_.degree);
    start(space);
    for (Index c = 0; c < mesh_.n_cells(); ++c)
      for (int i = 0; i < space.basis().n_nodes(); ++i)
        set(space, c, i, terms_at(pieces, c, space.basis().node_point(i)));
    finish("interpolates their function, which is on another mesh, at the nodes of this one");
    return std::move(result_);
  }

 private:
  using Base = ForeignElements<dim>;
  using Base::fail_digits;
  using Base::fail_missing;
  using Base::grid_;
  using Base::look_at_elements;
  using Base::mesh_;
  using Base::nearest;
  using Base::nodes_;
  using Base::number_of;
  using Base::other_mesh;
  using Base::place_of;
  using Base::result_;
  using Base::simplices_;
  using Base::straight_;
  using Base::terms_of;
  using Base::theirs_;
  using Base::tolerance_;
  using Base::where_;
  using typename Base::Place;

  // ---- with elements

  void carry_elements()
  {
    look_at_elements();
    const fem::LagrangeSpace<dim> space(mesh_, result_.degree);
    start(space);
    for (Index c = 0; c < mesh_.n_cells(); ++c)
    {
      const Place place = place_of(mesh::points_of(mesh_.vertices(), mesh_.cell(c)));
      for (int i = 0; i < space.basis().n_nodes(); ++i)
        set(space, c, i, terms_of(place, barycentric<dim>(space.basis().node_point(i))));
    }
    constexpr std::array<std::string_view, fem::max_degree> words = {"linear", "quadratic", "cubic",
                                                                     "quartic"};
    const bool has_other_places =
        std::ranges::any_of(simplices_, [](const auto& nodes) { return nodes && !nodes->are_equidistant(); });
    finish(!result_.is_exact  ? fmt::format("the piecewise {} function that takes their values at the nodes",
                                            words[result_.degree - 1])
           : has_other_places ? "their function, whose nodes are not equidistant"
                              : "their function");
  }

  // ---- on another mesh

  /// Their elements cut into simplices.
  struct Pieces
  {
    std::vector<std::array<Point<dim>, dim + 1>> corners;
    std::vector<Place> places;
    std::optional<mesh::BoxTree<dim>> tree;
  };

  Pieces cut()
  {
    mesh::ImportedMesh bare{.source = theirs_.mesh.source,
                            .nodes = theirs_.mesh.nodes,
                            .node_numbers = theirs_.mesh.node_numbers,
                            .cells = theirs_.mesh.cells};
    const mesh::SimplicialMesh simplicial = mesh::make_simplicial(std::move(bare));
    const auto& data = std::get<mesh::MeshData<dim>>(simplicial.data);
    Pieces pieces;
    std::vector<mesh::BoundingBox<dim>> boxes;
    boxes.reserve(data.cells.size());
    for (const mesh::Cell<dim>& cell : data.cells)
    {
      pieces.corners.push_back(mesh::points_of<dim>(data.vertices, cell));
      pieces.places.push_back(place_of(pieces.corners.back()));
      boxes.push_back(mesh::bounding_box<dim>(pieces.corners.back()));
    }
    pieces.tree.emplace(boxes);
    return pieces;
  }

  /// At a point of a cell, given in its reference coordinates. Where bodies touch, the side of the cell
  /// counts: it is looked for a little inside.
  Terms terms_at(const Pieces& pieces, Index cell, const Point<dim>& xhat)
  {
    const mesh::CellMap<dim> map = mesh::cell_map(mesh_, cell);
    const Point<dim> inside = map(xhat + same_place.back() * (Point<dim>::Constant(1.0 / (dim + 1)) - xhat));
    mesh::BoundingBox<dim> box;
    box.add(inside - Point<dim>::Constant(tolerance_));
    box.add(inside + Point<dim>::Constant(tolerance_));
    Index best = -1;
    double largest = -std::numeric_limits<double>::infinity();  // of the smallest barycentric coordinate
    pieces.tree->traverse([&](const mesh::BoundingBox<dim>& other) { return mesh::meet(box, other); },
                          [&](std::size_t k)
                          {
                            const Point<dim> y = coordinates<dim>(pieces.corners[k], inside);
                            const double smallest = std::min(y.minCoeff(), 1 - y.sum());
                            if (smallest <= largest) return;
                            largest = smallest;
                            best = static_cast<Index>(k);
                          });
    if (best < 0 || largest < -1e-3)
      throw InputError(where_, fmt::format("has no element at ({:.6g})", fmt::join(inside, ", ")),
                       "a mesh that covers that of the case");
    return terms_of(pieces.places[best], barycentric<dim>(coordinates<dim>(pieces.corners[best], map(xhat))));
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
    const std::size_t n_values = static_cast<std::size_t>(mesh_.n_cells()) * space.basis().n_nodes();
    if (!theirs_.stress.empty()) result_.stress.assign(n_values, Tensor<dim>::Zero());
    if (!theirs_.stress.empty() && is_axisymmetric_) result_.hoop.assign(n_values, 0.0);
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
      if (!u.allFinite()) fail_value(term.node, "displacement");
      if (theirs_.stress.empty()) continue;
      const auto& values = theirs_.stress[theirs_.stress_of_elements ? term.entry : term.node];
      for (std::size_t k = 0; k < s.size(); ++k) s[k] += term.weight * values[k];
      if (!std::ranges::all_of(s, [](double value) { return std::isfinite(value); }))
        fail_value(term.node, "stress");
    }
    if (is_axisymmetric_ && is_on_axis(space, cell, i)) u[0] = rounded_on_axis(terms.front().node, u[0]);
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
    const std::size_t place = static_cast<std::size_t>(cell) * space.basis().n_nodes() + i;
    Tensor<dim>& tensor = result_.stress[place];
    if (is_axisymmetric_) result_.hoop[place] = s[2];
    if constexpr (dim == 2)
      tensor << s[0], s[3], s[3], s[1];
    else
      tensor << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  }

  [[nodiscard]] bool is_on_axis(const fem::LagrangeSpace<dim>& space, Index cell, int i) const
  {
    for (int v = 0; v <= dim; ++v)
      if (space.basis().node(i)[v] > 0 && mesh_.vertex(mesh_.cell(cell)[v])[0] > 0) return false;
    return true;
  }

  /// Where u_r is more than rounding, the energy is infinite.
  double rounded_on_axis(Index node, double u_r)
  {
    if (std::abs(u_r) > 1e-6 * scale_)
      throw InputError(where_,
                       fmt::format("moves node {} of the axis by {} away from it", number_of(node), u_r),
                       "a displacement with u_r = 0 on the axis: else its energy is infinite");
    axis_displacement_ = std::max(axis_displacement_, std::abs(u_r));
    return 0;
  }

  void finish(const std::string& function)
  {
    result_.read_as = fmt::format("degree {}, {}", result_.degree, function);
    if (result_.curved_distance > straight_)
      result_.read_as += fmt::format("; on straight cells, from which curved edges are up to {:.3g} away",
                                     result_.curved_distance);
    if (axis_displacement_ > 0)
      result_.read_as += fmt::format("; u_r on the axis, up to {:.3g}, as 0", axis_displacement_);
  }

  [[noreturn]] void fail_value(Index node, std::string_view what) const
  {
    throw InputError(where_, fmt::format("has no {} at node {}", what, number_of(node)),
                     "a number for every node");
  }

  bool is_axisymmetric_;
  double scale_ = 0;              ///< the largest component of their displacement
  double axis_displacement_ = 0;  ///< the largest u_r there
};

}  // namespace

template <int dim>
ForeignSolution<dim> foreign_solution(const mesh::ImportedSolution& theirs, const mesh::Mesh<dim>& mesh,
                                      bool is_axisymmetric)
{
  return Carrier<dim>(theirs, mesh, is_axisymmetric).carry();
}

template <int dim>
ForeignSolution<dim> interpolated_solution(const mesh::ImportedSolution& theirs, const mesh::Mesh<dim>& mesh,
                                           bool is_axisymmetric)
{
  return Carrier<dim>(theirs, mesh, is_axisymmetric).interpolate();
}

template ForeignSolution<2> foreign_solution(const mesh::ImportedSolution&, const mesh::Mesh<2>&, bool);
template ForeignSolution<3> foreign_solution(const mesh::ImportedSolution&, const mesh::Mesh<3>&, bool);
template ForeignSolution<2> interpolated_solution(const mesh::ImportedSolution&, const mesh::Mesh<2>&, bool);
template ForeignSolution<3> interpolated_solution(const mesh::ImportedSolution&, const mesh::Mesh<3>&, bool);

}  // namespace tribound::certify
