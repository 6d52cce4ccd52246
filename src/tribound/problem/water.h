#pragma once

/// @file water.h
/// Water in a joint (method section 12.6): its pressure p_w >= 0 acts on the body as -p_w n, and the law of
/// the interface holds for the effective traction T + p_w n [T43].

#include <array>
#include <optional>
#include <variant>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/base/types.h"
#include "tribound/problem/field.h"

namespace tribound::problem
{

/// The line from the heel to the toe of a base, along which water seeps and resultants are looked for; as
/// many coordinates as the mesh has dimensions.
struct BaseLine
{
  std::vector<double> heel;  ///< upstream
  std::vector<double> toe;
  Where where{};  ///< for messages

  /// L = |toe - heel|.
  [[nodiscard]] double length() const;
  /// The unit vector from the heel to the toe; 0 behind the last coordinate.
  [[nodiscard]] std::array<double, 3> direction() const;
  /// s = (x - heel) . direction.
  template <int dim>
  [[nodiscard]] double along(const Point<dim>& x) const
  {
    const std::array<double, 3> e = direction();
    double s = 0;
    for (int i = 0; i < dim; ++i) s += e[i] * (x[i] - heel[i]);
    return s;
  }
};

/// Drains at a distance from the heel.
struct Drain
{
  double at;          ///< X, 0 < X < L, length
  double efficiency;  ///< E in [0, 1]: 0 leaves the pressures of the undrained base, 1 that of the toe
  bool from_full_head = false;  ///< E counts from the pressure of the heel, not from that without the drain
};

/// Pressures in the base of a hydraulic structure. With s the distance from the heel along heel -> toe, and
/// the last coordinate y the height,
///     p_heel = weight max(0, head - y_heel),   p_toe = weight max(0, tail - y_toe);
/// p_w falls linearly from p_heel at s = a0, through the drain if it works, to p_toe at s = L, and is
/// constant before and behind; a0 = a if the crack carries full pressure, else 0. At the drain
///     p_d = p_toe + (1 - E) (p_heel - p_toe) (L - X) / (L - a0),   without the last factor from the full
///     head.
/// A crack whose tip a reaches X disables the drain.
struct Seepage
{
  Field head;          ///< level of the water upstream, a height; no function of place
  Field tail{};        ///< the same downstream
  double weight;       ///< per volume, > 0
  BaseLine line;       ///< of positive length
  bool crack = false;  ///< whether an open crack from the heel carries the full pressure
  std::optional<Drain> drain{};
};

/// The pressure of water in a joint: given, or by levels.
class Water
{
 public:
  /// p_w = `pressure`, a stress, >= 0.
  explicit Water(Field pressure);
  /// By levels at t = 1, without a crack.
  explicit Water(Seepage seepage);

  /// p_w.
  [[nodiscard]] const Field& pressure() const { return pressure_; }
  /// Null where the pressure is given.
  [[nodiscard]] const Seepage* seepage() const { return seepage_ ? &*seepage_ : nullptr; }
  /// Whether p_w depends on the tip of the crack: it carries pressure or may disable a drain.
  [[nodiscard]] bool follows_crack() const { return seepage_ && (seepage_->crack || seepage_->drain); }
  /// a, the distance of the tip of the crack from the heel.
  [[nodiscard]] double crack_tip() const { return tip_; }

  /// The same at the load factor t, and with the tip of the crack at a. Throw InputError for levels that are
  /// not finite or vary in space.
  [[nodiscard]] Water at(double t) const;
  [[nodiscard]] Water with_crack_tip(double a) const;
  [[nodiscard]] bool uses_time() const;

  /// p_w at x. Throws InputError naming the point where a given pressure is negative.
  template <int dim>
  [[nodiscard]] double operator()(const Point<dim>& x) const;

 private:
  /// p_w by levels.
  [[nodiscard]] Field from_levels() const;

  std::optional<Seepage> seepage_;
  double tip_ = 0;
  Field pressure_;
};

}  // namespace tribound::problem
