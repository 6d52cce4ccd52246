#pragma once

/// @file formula.h
/// A formula in x, y, z and the load factor t: parsed once, evaluated at points and enclosed over simplices.

#include <array>
#include <limits>
#include <memory>
#include <span>
#include <string>

#include "tribound/base/error.h"

namespace tribound::problem
{

/// An interval that contains all values of something. Only (-inf, inf) has infinite ends.
struct Enclosure
{
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool contains(double value) const { return lower <= value && value <= upper; }
  [[nodiscard]] bool bounded() const { return lower > -std::numeric_limits<double>::infinity(); }
  /// The largest |value|.
  [[nodiscard]] double magnitude() const { return -lower > upper ? -lower : upper; }
};

/// The affine function a.x + b on R^3.
struct Affine
{
  std::array<double, 3> a{};
  double b = 0.0;
};

/// Which points of a region K count where a switch vanishes, up to rounding, on the boundary of K.
enum class Sides
{
  inside,  ///< those inside: what happens only on the boundary does not count
  closed,  ///< the boundary, too
  around   ///< those near K, too: whatever f may be on any side
};

struct FormulaProgram;

/// A scalar formula in x, y, z (grammar in docs/case-format.md; pi, e and t are constants). Several threads
/// may use one object at once; copies share the parsed formula.
class Formula
{
 public:
  /// What degree() returns for a formula that is not a polynomial.
  static constexpr int not_polynomial = 1'000'000;
  /// The highest order of derivatives that enclose() takes.
  static constexpr int max_order = 15;

  /// The formula `text`, found at `where`, with the given value of t. Throws InputError: empty, a syntax
  /// error or an unknown name (with the position in `text`), more than one result ("1,5"), an assignment, too
  /// long or too deeply nested.
  Formula(std::string text, const Where& where, double t = 1);

  /// The value at `x` (2 or 3 coordinates, z = 0 in 2D; none for a formula without variables). It may be nan
  /// or infinite.
  [[nodiscard]] double operator()(std::span<const double> x) const;

  /// The values at all points, x[i*dim + k]: the same to the last bit as one by one.
  void evaluate(std::span<const double> points, int dim, std::span<double> values) const;

  [[nodiscard]] const std::string& text() const;

  /// Total degree where it is a polynomial (an upper bound: terms that cancel count), otherwise
  /// not_polynomial.
  [[nodiscard]] int degree() const;

  /// Whether it names x, y or z (0, 1, 2).
  [[nodiscard]] bool uses(int variable) const;

  /// Whether it names t.
  [[nodiscard]] bool uses_time() const;

  /// The affine functions at whose zeros the formula may jump or kink: differences of the arguments of
  /// comparisons, min and max, arguments of abs and sign, where they are affine. No two are multiples of each
  /// other.
  [[nodiscard]] std::span<const Affine> switches() const;

  /// Encloses the formula and its derivatives over the convex hull K of `vertices` (dim coordinates each:
  /// those of a cell, of a facet). Coefficient n holds (1/n!) d^n/dt^n f(xi + t (x - c)) at t = 0 for all xi,
  /// x in K, c the mean of the vertices; coefficient 0 holds f on K. As many as `coefficients` has, at most
  /// max_order + 1. Unknown ones, as where f jumps, kinks or is undefined in K, are (-inf, inf). Where a
  /// switch is zero only on the boundary of K (up to rounding), `sides` says which values of f count. Where
  /// it is zero on all of K, all branches that rounding may take count: only x > a is decided by values.
  void enclose(std::span<const double> vertices, int dim, std::span<Enclosure> coefficients,
               Sides sides = Sides::inside) const;

  /// The same for f(X(.)), where enclose() of coordinate k of X would give coordinates[k] followed by zeros.
  /// Missing coordinates are 0.
  void enclose_composed(std::span<const std::array<Enclosure, 3>> coordinates,
                        std::span<Enclosure> coefficients) const;

  /// Encloses the values over the box between `lower` and `upper` (2 or 3 coordinates), its boundary
  /// included.
  [[nodiscard]] Enclosure enclose_box(std::span<const double> lower, std::span<const double> upper) const;

 private:
  std::shared_ptr<const FormulaProgram> program_;
};

/// An upper bound of the distance of a formula from P^{order - 1} on a simplex, in the maximum norm, from
/// what Formula::enclose gives there: half the range, or the remainder of a Taylor polynomial.
[[nodiscard]] double distance_from_polynomials(std::span<const Enclosure> taylor, int order);

}  // namespace tribound::problem
