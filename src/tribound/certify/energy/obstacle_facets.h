#pragma once

/// @file obstacle_facets.h
/// Displacements and gaps in Bernstein's basis on the segments of Gamma_C.

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tribound/base/types.h"
#include "tribound/certify/energy/contact_frames.h"
#include "tribound/contact/nitsche/nitsche.h"
#include "tribound/fem/lagrange.h"

namespace tribound::certify
{

/// Why v^n - g_h is not a polynomial on some segment of Gamma_C, or why contact there is more than v^n <= g
/// with friction; empty if neither is so. The same on all ranks, which call it together.
template <int dim>
[[nodiscard]] std::string laws_unfit(const contact::NitscheForm<dim>& form);
/// The same, or why [v] = 0 is impossible between tied bodies: their meshes do not match.
template <int dim>
[[nodiscard]] std::string obstacles_unfit(const contact::NitscheForm<dim>& form);

/// The segments of Gamma_C, numbered as in the form. If a segment matches, as a whole facet with one
/// direction of contact, against an obstacle or a facet that matches, its coefficient j belongs to node j,
/// every node of the slave has one of the master opposite, and facets share coefficients on common vertices
/// and edges. Keeps a reference to the form, to which obstacles_unfit() must have no objection.
template <int dim>
class ObstacleFacets
{
 public:
  explicit ObstacleFacets(const contact::NitscheForm<dim>& form);

  [[nodiscard]] std::size_t size() const { return form_.segments().size(); }
  /// Whether segment k is the whole of its facets, and N is constant.
  [[nodiscard]] bool matches(std::size_t k) const { return parts_[k] < 0; }
  /// Nodes of the space on the slave's facet: opposite to those of the master if they match, else in the
  /// order of the basis.
  [[nodiscard]] std::span<const Index> nodes(std::size_t k) const
  {
    return std::span(nodes_).subspan(k * n_, n_);
  }
  /// The nodes on the master's facet; none against an obstacle.
  [[nodiscard]] std::span<const Index> master_nodes(std::size_t k) const
  {
    return std::span(master_nodes_).subspan(k * n_, form_.segments()[k].master ? n_ : 0);
  }
  /// Marks degrees of freedom of slave nodes that have more than one opposite partner or are masters as well.
  /// Segments that do not match give no partner. All ranks together.
  [[nodiscard]] std::vector<char> junctions() const;
  /// Marks degrees of freedom on facets that do not match. All ranks together.
  [[nodiscard]] std::vector<char> between_meshes() const;
  /// Whether a rigid part has a node on Gamma_C. All ranks together.
  [[nodiscard]] bool touch(const contact::RigidParts<dim>& parts) const;
  [[nodiscard]] const ContactFrames<dim>& frames() const { return frames_; }
  /// Coefficients of g_h, the interpolant of g of degree p, where N varies of degree p + 2.
  [[nodiscard]] std::span<const double> gap(std::size_t k) const
  {
    return std::span(gaps_).subspan(gap_begins_[k], gap_begins_[k + 1] - gap_begins_[k]);
  }
  /// Coefficients of M^T v from those of v: of degree p + 2 where N varies, else as they are.
  [[nodiscard]] std::vector<Point<dim>> turned(std::size_t k, std::vector<Point<dim>> v) const;
  /// Coefficients of [u] for a function u of the space.
  [[nodiscard]] std::vector<Point<dim>> coefficients(std::size_t k, std::span<const double> u) const;
  /// Whether friction on segment k counts from a slip w of earlier load steps that is not 0.
  [[nodiscard]] bool has_slipped(std::size_t k) const { return !slipped_.empty() && slipped_[k] >= 0; }
  /// Coefficients of (M^T u)^t - w: of degree p + 2 if has_slipped(k) or where N varies, else p.
  [[nodiscard]] std::vector<Point<dim>> slip(std::size_t k, std::span<const double> u) const;
  [[nodiscard]] bool slip_is_rich(std::size_t k) const { return has_slipped(k) || frames_.turns(k); }
  /// Coefficient j of the interpolant of w of degree p.
  [[nodiscard]] Point<dim> slip_before(std::size_t k, std::size_t j) const
  {
    return has_slipped(k) ? nodal_slips_[slipped_[k] * n_ + j] : Point<dim>(Point<dim>::Zero());
  }
  /// Coefficients of u on the slave, and on the master: 0 against an obstacle.
  [[nodiscard]] std::vector<Point<dim>> on_slave(std::size_t k, std::span<const double> u) const
  {
    return transformed(nodes(k), on_segment(k, 0), u);
  }
  [[nodiscard]] std::vector<Point<dim>> on_master(std::size_t k, std::span<const double> u) const;
  /// Values at the nodes of the slave or of the master as degrees of freedom, from coefficients by node.
  [[nodiscard]] std::vector<Point<dim>> values(std::span<const Index> nodes,
                                               std::span<const double> coefficients) const
  {
    return transformed(nodes, to_values_, coefficients);
  }
  /// Largest |g - g_h| at the contact points of this rank.
  [[nodiscard]] double gap_remainder() const;

 private:
  /// Maps values at the nodes of a side (0: slave) to coefficients on segment k.
  [[nodiscard]] std::span<const double> on_segment(std::size_t k, int side) const;
  void add_part(const contact::ContactSegment<dim>& segment);
  void set_slips();
  [[nodiscard]] std::vector<Point<dim>> transformed(std::span<const Index> nodes,
                                                    std::span<const double> matrix,
                                                    std::span<const double> by_node) const;

  const contact::NitscheForm<dim>& form_;
  ContactFrames<dim> frames_;
  fem::LagrangeBasis<dim - 1> basis_;
  fem::LagrangeBasis<dim - 1> richer_;  ///< of degree p + 2
  std::size_t n_;                       ///< of nodes of the former
  std::vector<double> to_values_;
  std::vector<double> from_values_;
  std::vector<Index> nodes_;
  std::vector<Index> master_nodes_;    ///< opposite; -1 against an obstacle
  std::vector<std::ptrdiff_t> parts_;  ///< where its matrices begin in of_parts_; -1 if it matches
  std::vector<double> of_parts_;
  std::vector<double> gaps_;
  std::vector<std::size_t> gap_begins_{0};  ///< by segment, with the end
  Eigen::MatrixXd at_richer_nodes_;         ///< Bernstein's basis of degree p
  Eigen::MatrixXd from_richer_nodes_;       ///< bernstein_from_nodes(richer_)
  Eigen::MatrixXd raise_;                   ///< bernstein_raised(p, p + 2)
  std::vector<std::ptrdiff_t> slipped_;  ///< number among segments with slips; -1: none; empty: all without
  std::vector<Point<dim>> slips_;        ///< coefficients of w, of degree p + 2
  std::vector<Point<dim>> nodal_slips_;  ///< of its interpolants of degree p
};

}  // namespace tribound::certify
