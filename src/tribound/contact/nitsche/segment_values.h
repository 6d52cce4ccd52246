#pragma once

/// @file segment_values.h
/// Finite element functions on contact segments: [u], {sigma(u)} and P(u).

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "tribound/contact/nitsche/segment.h"
#include "tribound/fem/space.h"

namespace tribound::contact
{

/// The basis functions of the cell of a side at points with these coordinates on the segment.
template <int dim>
[[nodiscard]] fem::Tabulation<dim> tabulate(const fem::LagrangeBasis<dim>& basis,
                                            const SegmentSide<dim>& side,
                                            std::span<const Point<dim - 1>> points);

/// Points of a segment, and the basis functions of the cells of its sides there. A view.
template <int dim>
struct SegmentTable
{
  std::span<const Point<dim - 1>> points;  ///< coordinates on the segment
  const fem::Tabulation<dim>* slave = nullptr;
  const fem::Tabulation<dim>* master = nullptr;  ///< against an obstacle null
};

/// The basis functions at the same points of each segment. Whole facets share their tables.
template <int dim>
class SegmentTables
{
 public:
  SegmentTables(const fem::LagrangeBasis<dim>& basis, std::span<const ContactSegment<dim>> segments,
                std::span<const Point<dim - 1>> points);

  /// The table of segment k; valid as long as this object.
  [[nodiscard]] SegmentTable<dim> operator[](std::size_t k) const
  {
    const auto [slave, master] = tables_of_[k];
    return {points_, &tables_[slave], master < 0 ? nullptr : &tables_[master]};
  }
  [[nodiscard]] std::size_t n_points() const { return points_.size(); }

 private:
  std::vector<Point<dim - 1>> points_;
  std::vector<fem::Tabulation<dim>> tables_;   ///< of whole facets first, by their local numbers
  std::vector<std::array<int, 2>> tables_of_;  ///< of slave and master; -1: none
};

/// P^p on a segment by values at the nodes of its Lagrange basis theta. It contains [u], {sigma(u)} and P(u)
/// without the gap, so these are evaluated only at the nodes, which are fewer than the points of a rule. On a
/// meridian u_r / r is no polynomial, and the nodes are the points.
template <int dim>
class SegmentNodes
{
 public:
  /// theta at the given points.
  SegmentNodes(int degree, std::span<const Point<dim - 1>> points);
  /// The nodes are the points.
  explicit SegmentNodes(std::span<const Point<dim - 1>> points);

  [[nodiscard]] std::span<const Point<dim - 1>> nodes() const { return nodes_; }
  /// (l, q): theta_l at point q.
  [[nodiscard]] Eigen::Map<const Eigen::MatrixXd> values() const
  {
    return {values_.data(), std::ssize(nodes_), std::ssize(values_) / std::ssize(nodes_)};
  }
  /// (q, i n + l): theta_i theta_l at point q, with n the number of nodes.
  [[nodiscard]] Eigen::Map<const Eigen::MatrixXd> products() const
  {
    return {products_.data(), std::ssize(values_) / std::ssize(nodes_),
            std::ssize(nodes_) * std::ssize(nodes_)};
  }

 private:
  // No Eigen matrices of dynamic size: their allocation depends on the instruction set for which a program is
  // compiled.
  void multiply(int n_nodes);

  std::vector<Point<dim - 1>> nodes_;
  std::vector<double> values_;
  std::vector<double> products_;
};

/// Evaluates functions of a space on one segment at the points of its table. Keeps references to all its
/// arguments.
template <int dim>
class SegmentValues
{
 public:
  struct Side
  {
    const SegmentSide<dim>* side;
    const fem::Tabulation<dim>* table;
    const problem::Material* material;
    std::span<const Index> nodes;
    Tensor<dim> inverse_transpose;  ///< J^{-T} of the cell
  };

  SegmentValues(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                const ContactSegment<dim>& segment, const SegmentTable<dim>& table);

  [[nodiscard]] std::span<const Side> sides() const { return std::span(sides_).first(n_sides_); }
  /// [u] at point q.
  [[nodiscard]] Point<dim> jump(std::span<const double> u, int q) const;
  /// {C eps(u)} - gamma [u]^n n - gamma_t [u]^t at point q: P(u) without gap and initial stress.
  [[nodiscard]] Point<dim> augmented_traction(std::span<const double> u, int q) const;
  /// Its derivative by node i of a side; column b is for component b.
  [[nodiscard]] Tensor<dim> augmented_derivative(const Side& side, int i, int q) const;

 private:
  /// The distance from the axis of point q on a side.
  [[nodiscard]] double radius(const Side& side, int q) const;

  const mesh::Mesh<dim>& mesh_;
  std::span<const Point<dim - 1>> points_;
  bool is_axisymmetric_;
  Tensor<dim> gamma_;  ///< gamma n n^T + gamma_t (I - n n^T)
  std::array<Side, 2> sides_;
  std::size_t n_sides_;
};

}  // namespace tribound::contact
