#pragma once

/// @file problem.h
/// The continuous problem of method section 1: material, loads, and what holds on each part of the boundary.

#include <array>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/base/types.h"
#include "tribound/problem/contact_law.h"
#include "tribound/problem/field.h"
#include "tribound/problem/material.h"
#include "tribound/problem/normal_field.h"
#include "tribound/problem/rigid_part.h"
#include "tribound/problem/spring.h"
#include "tribound/problem/water.h"

namespace tribound::problem
{

/// The entries of a symmetric tensor: xx, yy, xy in 2D, xx, yy, zz, xy, yz, xz in 3D.
template <int dim>
inline constexpr int n_symmetric = dim*(dim + 1) / 2;

/// The symmetric tensor whose entry number i is 1, the others 0.
template <int dim>
[[nodiscard]] Tensor<dim> symmetric_unit(int i);

/// What a region of the body is made of, the force on it, and the stress that it has without deformation,
///     sigma_0 = initial stress - beta (temperature - reference) I,  beta = thermal_modulus(material).
template <int dim>
struct Region
{
  std::string name{};  ///< of the mesh; empty: every region without an entry of its own
  Material material;
  std::array<Field, dim> body_force{};                   ///< force per volume
  std::array<Field, n_symmetric<dim>> initial_stress{};  ///< without that of the temperature
  Field temperature{};
  Field reference_temperature{};  ///< at which the region is free of thermal stress
  Field initial_stress_zz{};      ///< 2D, plane strain; of bodies of revolution around the axis

  /// Whether sigma_0 can be non-zero.
  [[nodiscard]] bool has_initial_stress() const;
};

/// Contact with a rigid obstacle or another body.
struct Contact
{
  ContactLaw law;
  /// Initial distance g along N; negative: interference, as of a press fit. Absent, between bodies alone: the
  /// distance that the meshes have.
  std::optional<Field> gap;
  /// N, by which normal and tangential parts are taken; absent: the outward normal of each facet.
  std::optional<NormalField> normal{};
  /// What gap and N were made from, in words, such as "obstacle floor"; empty: both were given.
  std::string geometry{};
  /// Nonzero where the bond is broken before the first step; absent: nowhere.
  std::optional<Field> broken{};
  /// The signed distance from the true surface of the body; absent: the facets are the true surface.
  std::optional<Field> true_surface{};
  std::optional<Water> water{};    ///< in the joint; absent: none
  std::optional<BaseLine> base{};  ///< along which the figures of a hydraulic structure are taken

  explicit Contact(ContactLaw l, std::optional<Field> g = Field(0.0)) : law(std::move(l)), gap(std::move(g))
  {
  }

  /// Whether it holds tension along N, too.
  [[nodiscard]] bool is_bilateral() const { return cone(law).is_bilateral; }
};

/// How the projection Pi of a slave onto its master finds a partner.
template <int dim>
struct Pairing
{
  /// e, of any length; absent: the outward normal of each slave facet.
  std::optional<Point<dim>> direction{};
  double reach = std::numeric_limits<double>::infinity();  ///< largest |Pi(x) - x|
};

/// Contact between two parts of the boundaries of elastic bodies, each all facets of some named boundaries
/// without other conditions. Where nothing of the master lies opposite, the slave is traction-free.
template <int dim>
struct ContactPair
{
  std::vector<std::string> slave;
  std::vector<std::string> master;
  Contact contact;
  Pairing<dim> pairing{};
  Where where{};  ///< for messages
};

/// The side of a pair that a boundary belongs to; pair -1: none.
struct PairSide
{
  int pair = -1;
  bool is_slave = false;
};

/// The conditions on one named part of the boundary.
template <int dim>
struct BoundaryCondition
{
  std::string name;                                    ///< of the mesh
  std::array<std::optional<Field>, dim> displacement;  ///< fixed components (Gamma_D)
  std::array<Field, dim> traction;                     ///< g_N on the free components
  std::optional<Field> pressure;                       ///< adds -pressure n to g_N
  std::optional<Spring<dim>> spring;                   ///< on the free components
  std::optional<Contact> contact;                      ///< Gamma_C
  Where where;                                         ///< for messages
  std::optional<RigidPart<dim>> rigid = {};            ///< every component is fixed, up to its motion

  /// Whether the component is prescribed, on a rigid part up to its motion.
  [[nodiscard]] bool fixes(int component) const { return rigid || displacement[component]; }
  [[nodiscard]] bool fixes_any() const;
  /// Whether all functions compared, whose rigid parts move, vanish in the component.
  [[nodiscard]] bool clamps(int component) const { return !rigid && displacement[component]; }
  [[nodiscard]] bool clamps_any() const { return !rigid && fixes_any(); }
  /// u_D in a component that is fixed; on a rigid part 0.
  [[nodiscard]] const Field& prescribed(int component) const;
  /// Whether displacement, a spring or what guides a rigid part holds anything here.
  [[nodiscard]] bool holds_any() const
  {
    return rigid ? rigid->fixes_any() : fixes_any() || spring.has_value();
  }
  /// Whether the norm of the residual has the trace here: on obstacles and springs.
  [[nodiscard]] bool is_in_norm() const { return contact.has_value() || spring.has_value(); }
  /// K without the components that are fixed.
  [[nodiscard]] Tensor<dim> on_free(Tensor<dim> stiffness) const;
  /// A matrix M such that motions with M z = 0 are free at x: the components that are fixed, or where a
  /// spring is.
  [[nodiscard]] Tensor<dim> held(const Point<dim>& x, const Point<dim>& n) const;
  /// The same wherever the spring may act on a facet: nothing here does work in motions with M z = 0.
  [[nodiscard]] Tensor<dim> acting(const Point<dim>& n) const;
  /// The diagonal matrix with 1 for components that are clamped.
  [[nodiscard]] Tensor<dim> clamped() const;
  /// Whether g_N can be non-zero.
  [[nodiscard]] bool is_loaded() const;
  /// g_N at x with outward unit normal n; components that are fixed are 0.
  [[nodiscard]] Point<dim> load(const Point<dim>& x, const Point<dim>& n) const;
};

/// Displacement components fixed on a boundary; std::nullopt leaves one free.
template <int dim>
[[nodiscard]] BoundaryCondition<dim> with_displacement(const std::string& name,
                                                       std::array<std::optional<Field>, dim> displacement);
/// g_N on a boundary.
template <int dim>
[[nodiscard]] BoundaryCondition<dim> with_traction(const std::string& name, std::array<Field, dim> traction);
/// Contact on a boundary.
template <int dim>
[[nodiscard]] BoundaryCondition<dim> with_contact(const std::string& name, ContactLaw law, Field gap = 0.0);

/// The strength s(x) >= 0 of the law's friction cone, 0 where it has none. A negative value counts as 0 if it
/// may be 0 within the rounding of x: "y" on a floor y = 0 whose points have rounded coordinates. Otherwise
/// throws InputError naming the point.
template <int dim>
[[nodiscard]] double strength_at(const ContactLaw& law, const Point<dim>& x);

/// p_w >= 0, the pressure of the water at x; 0 without water. Throws InputError as Water does.
template <int dim>
[[nodiscard]] double water_at(const Contact& contact, const Point<dim>& x)
{
  return contact.water ? (*contact.water)(x) : 0.0;
}

/// The problem on a mesh whose regions and boundaries carry the given names. Regions and boundaries are
/// referred to by their position in these lists, so that refinement, which inherits tags, leaves the problem
/// valid.
template <int dim>
class Problem
{
 public:
  /// Throws InputError for a group that does not exist (listing those that do), for a region without entry,
  /// for a boundary with two conditions, in two pairs or in a pair and with a condition, and for a tied pair
  /// with a gap. Boundaries without condition are traction-free.
  Problem(std::span<const std::string> region_names, std::span<const std::string> boundary_names,
          const std::vector<Region<dim>>& regions, const std::vector<BoundaryCondition<dim>>& boundaries,
          std::vector<ContactPair<dim>> pairs = {});

  /// The same on a mesh: whatever has region_names() and boundary_names().
  template <class Mesh>
  Problem(const Mesh& mesh, const std::vector<Region<dim>>& regions,
          const std::vector<BoundaryCondition<dim>>& boundaries, std::vector<ContactPair<dim>> pairs = {})
      : Problem(mesh.region_names(), mesh.boundary_names(), regions, boundaries, std::move(pairs))
  {
  }

  /// The same with all data at the load factor t.
  [[nodiscard]] Problem at(double t) const;
  /// The same with the tip of the crack in contact i of contacts() at the distance tips[i] from its heel.
  [[nodiscard]] Problem with_crack_tips(std::span<const double> tips) const;
  /// Whether any datum names t.
  [[nodiscard]] bool uses_time() const;
  /// The same on the meridian of bodies of revolution, whose points are (r, z): the hoop strain u_r / r
  /// counts among the strains, and every integral has the weight r. Rigid parts move along z alone. Only in
  /// 2D.
  [[nodiscard]] Problem axisymmetric() const;
  [[nodiscard]] bool is_axisymmetric() const { return is_axisymmetric_; }
  /// The weight of integrals at x: r of an axisymmetric problem, else 1.
  [[nodiscard]] double weight(const Point<dim>& x) const { return is_axisymmetric_ ? x[0] : 1.0; }
  /// What such integrals are multiplied by for the whole body: 2 pi, else 1.
  [[nodiscard]] double full_circle() const { return is_axisymmetric_ ? 2 * std::numbers::pi : 1.0; }

  [[nodiscard]] const Material& material(int region) const { return regions_[region].material; }
  /// f in the region; force per volume.
  [[nodiscard]] const std::array<Field, dim>& body_force(int region) const
  {
    return regions_[region].body_force;
  }
  [[nodiscard]] Point<dim> body_force(int region, const Point<dim>& x) const;
  /// Whether f is the same everywhere in the region.
  [[nodiscard]] bool body_force_is_constant(int region) const;
  /// The largest degree of the loads in regions and on boundaries, as Field::degree(), without springs.
  [[nodiscard]] int load_degree() const;
  /// That of K u_0.
  [[nodiscard]] int spring_load_degree() const;
  [[nodiscard]] bool has_springs() const;
  [[nodiscard]] bool has_rigid_parts() const;
  /// Whether f vanishes identically in the region.
  [[nodiscard]] bool body_force_is_zero(int region) const;
  /// sigma_0 in the region at x: sigma(u) = C eps(u) + sigma_0.
  [[nodiscard]] Tensor<dim> initial_stress(int region, const Point<dim>& x) const;
  /// Its entry zz in 2D; 0 in plane stress and in 3D.
  [[nodiscard]] double initial_stress_zz(int region, const Point<dim>& x) const;
  /// Whether sigma_0 can be non-zero in some region.
  [[nodiscard]] bool has_initial_stress() const;
  /// The same problem with sigma_0 = 0: what differences of solutions obey.
  [[nodiscard]] Problem without_initial_stress() const;

  /// The condition on boundary number `tag`; a negative tag means a facet in no group: traction-free.
  [[nodiscard]] const BoundaryCondition<dim>& boundary(int tag) const
  {
    return tag < 0 ? unnamed_ : boundaries_[tag];
  }
  [[nodiscard]] std::span<const BoundaryCondition<dim>> boundaries() const { return boundaries_; }
  /// The contact of boundary number `tag` with an obstacle or, as a slave, with its master; null for others.
  [[nodiscard]] const Contact* contact(int tag) const;
  /// All of them: with obstacles in the order of the boundaries, then those of the pairs.
  [[nodiscard]] std::vector<const Contact*> contacts() const;
  /// The pair whose slave the boundary is, and that whose master it is, or null.
  [[nodiscard]] const ContactPair<dim>* pair_of_slave(int tag) const;
  [[nodiscard]] const ContactPair<dim>* pair_of_master(int tag) const;
  /// In the order of the mesh, each with the name it has there.
  [[nodiscard]] std::span<const Region<dim>> regions() const { return regions_; }
  [[nodiscard]] std::span<const ContactPair<dim>> pairs() const { return pairs_; }
  /// Whether boundary number `tag` touches an obstacle or is the slave or the master of a pair.
  [[nodiscard]] bool is_in_contact(int tag) const;
  /// Whether there are obstacles or pairs.
  [[nodiscard]] bool has_contact() const;

 private:
  /// visit(datum) for every number, formula or function of the problem but those of the water.
  template <class Self, class Visit>
  static void for_each_datum(Self& problem, const Visit& visit);
  /// visit(contact) in the order of contacts().
  template <class Self, class Visit>
  static void for_each_contact(Self& problem, const Visit& visit);

  std::vector<Region<dim>> regions_;
  std::vector<BoundaryCondition<dim>> boundaries_;
  std::vector<ContactPair<dim>> pairs_;
  std::vector<PairSide> sides_;  ///< of each boundary
  BoundaryCondition<dim> unnamed_;
  bool is_axisymmetric_ = false;
};

/// The position of `name` among the groups of a mesh. Throws InputError listing them; `kind` is "region" or
/// "boundary".
[[nodiscard]] int group_number(const std::string& name, std::span<const std::string> groups,
                               const Where& where, std::string_view kind);

/// "a", "b", "c", each in quotes.
[[nodiscard]] std::string quoted_list(std::span<const std::string> names);

}  // namespace tribound::problem
