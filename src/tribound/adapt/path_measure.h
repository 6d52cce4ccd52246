#pragma once

/// @file path_measure.h
/// Quantities C(u) that grow along a load path and control it where the load factor is not known beforehand
/// (method section 12.7).

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::adapt
{

/// The measured jump on a contact boundary.
enum class Jump
{
  opening,        ///< the mean of -[u]^n, the contribution of the displacement to the gap
  mouth_opening,  ///< the same at contact::crack_mouth()
  mouth_sliding   ///< [u]^t there, from heel to toe
};

/// A term of a linear functional of u: `factor` times the mean of a component over a boundary or, if no
/// component is given, times a jump.
struct Gauge
{
  std::string boundary;
  std::optional<int> component{};
  Jump jump = Jump::opening;
  double factor = 1;
  Where where{};  ///< for messages
};

/// A quantity reported at every step.
struct Watch
{
  std::string name;
  std::vector<Gauge> gauges;
};

/// The number of its boundary. Throws InputError where there is no such boundary or component, where a
/// boundary whose opening is measured touches nothing, and where a boundary has no heel.
template <int dim>
[[nodiscard]] int gauged_boundary(const problem::Problem<dim>& problem, const Gauge& gauge);

/// c with c.u = the sum of the gauges, complete for own degrees of freedom. Throws as gauged_boundary(). All
/// ranks call it together.
template <int dim>
[[nodiscard]] std::vector<double> functional(const contact::NitscheForm<dim>& form,
                                             std::span<const Gauge> gauges);

/// Length or area of all bonded interfaces, of the full circle. All ranks call it together.
template <int dim>
[[nodiscard]] double bonded_measure(const contact::NitscheForm<dim>& form);

/// C(u): either c.u or the integral of the damage D over all bonded interfaces (length in 2D, area in 3D).
template <int dim>
class PathMeasure
{
 public:
  /// The integral of D.
  PathMeasure() = default;
  /// c.u.
  explicit PathMeasure(std::vector<double> c) : functional_(std::move(c)) {}

  /// With the damage that u causes from the history of the form. All ranks call it together, as
  /// derivatives().
  [[nodiscard]] double value(const contact::NitscheForm<dim>& form, std::span<const double> u) const;
  /// C'(u)[d] for two directions d, which include ghost values.
  [[nodiscard]] std::array<double, 2> derivatives(const contact::NitscheForm<dim>& form,
                                                  std::span<const double> u,
                                                  const std::array<std::span<const double>, 2>& d) const;

 private:
  std::optional<std::vector<double>> functional_;  ///< absent: the damage
};

}  // namespace tribound::adapt
