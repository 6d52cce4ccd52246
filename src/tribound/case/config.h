#pragma once

/// @file config.h
/// The case file as plain data: what the user wrote, checked for form (keys, types, ranges) but not yet
/// against a mesh. The format is described in docs/case-format.md.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tribound/base/error.h"
#include "tribound/problem/field.h"

namespace tribound::case_file
{

/// A mesh read through Gmsh (.msh of any version, .geo).
struct MeshFile
{
  std::filesystem::path path;  ///< relative paths are relative to the case file
  Where where;
};

/// The structured box mesh; its length tells the dimension. Boundaries: left right (x), bottom top (y), back
/// front (z) in 3D, where back is z = lower and front is z = upper; region: "box".
struct BoxMesh
{
  std::vector<double> lower;
  std::vector<double> upper;
  std::vector<int> cells;
  Where where;
};

using MeshSource = std::variant<MeshFile, BoxMesh>;

enum class PlaneModel
{
  strain,
  stress
};

/// Linear elastic material of a region; an empty region name means every region without one of its own.
struct MaterialConfig
{
  std::string region;
  double E = 0.0;   ///< Young's modulus, stress units, > 0
  double nu = 0.0;  ///< Poisson's ratio in (-1, 0.5)
  PlaneModel plane = PlaneModel::strain;
  Where where;
};

/// Body force of a region; an empty name means every region without one of its own.
struct LoadConfig
{
  std::string region;
  std::vector<problem::Expression> body;  ///< force per volume, dim components
  Where where;
};

struct Frictionless
{
};

/// |sigma^t| <= s(x).
struct Tresca
{
  problem::Expression threshold;  ///< s >= 0, stress units
};

/// |sigma^t| <= mu_F |sigma^n|.
struct Coulomb
{
  double coefficient = 0.0;  ///< mu_F >= 0
};

using FrictionLaw = std::variant<Frictionless, Tresca, Coulomb>;

/// Unilateral contact with a rigid obstacle.
struct Contact
{
  FrictionLaw friction;
  problem::Expression gap;  ///< initial distance g >= 0 along the outward normal
};

/// One [boundary.<name>] table.
struct BoundaryConfig
{
  std::string name;
  std::vector<std::optional<problem::Expression>>
      displacement;                             ///< empty: none given; nullopt: "free" component
  std::vector<problem::Expression> traction;    ///< empty: none given
  std::optional<problem::Expression> pressure;  ///< acts against the outward normal
  std::optional<Contact> contact;
  Where where;
};

struct NitscheConfig
{
  std::optional<double> gamma0;  ///< > 0; default_gamma0(degree) where absent
};

/// gamma_0 of method section 2: 10 up to degree 3, above max(10, 3 p^2).
[[nodiscard]] double default_gamma0(int degree);

enum class Stopping
{
  adaptive,        ///< eta_lin is a fraction of the rest, summed over the mesh
  adaptive_local,  ///< the same on every cell
  tolerance
};

struct NewtonConfig
{
  Stopping stopping = Stopping::adaptive;
  double gamma_lin = 0.1;    ///< adaptive: eta_lin <= gamma_lin * (the other components)
  double tolerance = 1e-10;  ///< relative residual
  int max_steps = 50;
  bool damping = true;  ///< false: always full steps (for comparisons; may cycle)
  bool finish = true;   ///< converge to `tolerance` on the last level, whatever `stopping`
};

/// The regularised variant, method section 7.
struct RegularisationConfig
{
  double delta = 1.0;      ///< > 0, the first one: multiple of the mean contact traction of the first step
  double factor = 0.25;    ///< in (0, 1): each update shrinks delta by it
  double gamma_reg = 0.1;  ///< eta_reg <= gamma_reg * (the discretisation components)
  int max_updates = 20;    ///< of delta on a mesh
};

enum class Marking
{
  doerfler,
  maximum,
  uniform  ///< every cell
};

struct AdaptConfig
{
  double tolerance = 0.01;  ///< of eta_tot / ||sigma(u_h)||
  Marking marking = Marking::doerfler;
  double theta = 0.5;
  int max_levels = 30;
  long max_dofs = 2'000'000;
  bool separate_contact = false;     ///< mark for the body and for the contact conditions, each by its share
  std::optional<long> max_cells;     ///< no limit where absent
  std::optional<double> max_time;    ///< seconds; no limit where absent
  std::optional<double> max_memory;  ///< GB (1e9 bytes); nine tenths of the machine's where absent
};

enum class ContactRule
{
  resolved,
  reference
};

struct CertifyConfig
{
  ContactRule contact_rule = ContactRule::resolved;
};

enum class LinearMethod
{
  automatic,
  direct,
  iterative
};

enum class DirectPackage
{
  automatic,
  mumps,
  umfpack
};

struct SolverConfig
{
  LinearMethod method = LinearMethod::automatic;
  DirectPackage package = DirectPackage::automatic;
  double tolerance = 1e-10;  ///< relative residual of an iterative solve
  int max_iterations = 500;
};

/// `tribound study`.
struct StudyConfig
{
  std::optional<int> reference_degree;  ///< of the reference solution; min(p + 1, 4) where absent
  double reference_factor = 0.2;        ///< its relative bound is at most so much of the smallest one studied
  long max_reference_dofs = 500'000;
  long dual_norm_dofs = 100'000;  ///< of the spaces in which dual norms are looked for; 0: none
  bool figures = true;            ///< whether to draw them
};

struct OutputConfig
{
  std::filesystem::path directory;  ///< relative to the working directory; default_directory() of the case
  bool vtu = true;
  bool report = true;                ///< the page report.html
  bool mesh = true;                  ///< the last mesh, adapted.msh
  std::vector<double> moment_about;  ///< point of the moments in the balance; empty: centroid of the body
  Where moment_about_where;
};

/// Where results go if the case does not say: out/block for block.toml.
[[nodiscard]] std::filesystem::path default_directory(const std::filesystem::path& case_file);

/// What is solved: the case file with every --set.
struct EffectiveCase
{
  std::string text;                    ///< TOML; a case file that stands in output.directory
  std::vector<std::string> overrides;  ///< as given
};

struct Config
{
  std::string file;  ///< the case file, for messages
  std::string title;
  int degree = 1;  ///< p = 1, 2, 3, 4
  MeshSource mesh;
  std::vector<MaterialConfig> materials;
  std::vector<LoadConfig> loads;
  std::vector<BoundaryConfig> boundaries;
  NitscheConfig nitsche;
  NewtonConfig newton;
  std::optional<RegularisationConfig> regularisation;  ///< the plain method where absent
  AdaptConfig adapt;
  CertifyConfig certify;
  SolverConfig solver;
  StudyConfig study;
  OutputConfig output;
  EffectiveCase effective;

  [[nodiscard]] double gamma0() const { return nitsche.gamma0.value_or(default_gamma0(degree)); }
};

/// The names of the friction laws in use, such as "tresca", "none+coulomb", or "" without contact.
[[nodiscard]] std::string friction_name(const Config& config);

/// Reads a case file; each override is "dotted.key=TOML value" (a bare word is taken as a string).
/// Throws InputError.
[[nodiscard]] Config read_config(const std::filesystem::path& file,
                                 std::span<const std::string> overrides = {});

/// The same from text; `name` stands for the file in messages.
[[nodiscard]] Config parse_config(std::string_view text, std::string name = "case",
                                  std::span<const std::string> overrides = {});

}  // namespace tribound::case_file
