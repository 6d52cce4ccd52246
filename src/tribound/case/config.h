#pragma once

/// @file config.h
/// The case file as plain data: the user's input, checked for form (keys, types, ranges) but not yet against
/// a mesh. The format is described in docs/case-format.md.

#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tribound/adapt/loop.h"
#include "tribound/adapt/method.h"
#include "tribound/base/error.h"
#include "tribound/case/geometry.h"
#include "tribound/case/history.h"
#include "tribound/case/node.h"
#include "tribound/io/record/facts.h"
#include "tribound/mesh/formula_groups.h"
#include "tribound/mesh/seams.h"
#include "tribound/mesh/source.h"
#include "tribound/problem/problem.h"
#include "tribound/problem/quantity.h"
#include "tribound/problem/units.h"

namespace tribound::case_file
{

/// Linear elastic material of a region; an empty name means every region without its own entry.
struct MaterialConfig
{
  std::string region;
  double E = 0.0;   ///< Young's modulus, stress units, > 0
  double nu = 0.0;  ///< Poisson's ratio in (-1, 0.5)
  problem::PlaneModel plane = problem::PlaneModel::strain;
  std::optional<double> alpha{};  ///< strain per temperature
  Where where;
};

/// Body force, temperature and initial stress of a region; an empty name means every region without its own
/// entry.
struct LoadConfig
{
  std::string region;
  std::vector<problem::Field> body;  ///< force per volume, dim components; empty: none
  std::optional<problem::Field> temperature{};
  problem::Field reference_temperature{};
  std::vector<problem::Field> initial_stress{};  ///< xx, yy, xy or xx, yy, zz, xy, yz, xz; empty: none
  Where where;                                   ///< of the table
};

/// `spring` of a boundary.
struct SpringConfig
{
  problem::Field normal = 0.0;
  problem::Field tangential = 0.0;
  std::vector<problem::Field> rest;  ///< empty: 0
  Where where;
};

/// `rigid` of a boundary.
struct RigidConfig
{
  std::vector<problem::Field> force;   ///< empty: 0
  std::vector<problem::Field> moment;  ///< empty: 0
  std::vector<double> point;           ///< empty: none given
  std::vector<std::string> fixed;      ///< motions: "x", ..., "rz"
  Where where;
};

/// One [boundary.<name>] table.
struct BoundaryConfig
{
  std::string name;
  std::vector<std::optional<problem::Field>> displacement;  ///< empty: none given; nullopt: "free" component
  std::vector<problem::Field> traction;                     ///< empty: none given
  std::optional<problem::Field> pressure;                   ///< acts against the outward normal
  std::optional<SpringConfig> spring;
  std::optional<problem::Contact> contact;
  GeometryConfig geometry;  ///< of the contact
  Where where;
  std::optional<RigidConfig> rigid;
};

/// One [[contact]] table.
struct ContactConfig
{
  std::vector<std::string> slave;   ///< name; of the joint if this is one
  std::vector<std::string> master;  ///< name; of the other side of the joint if this is one
  std::string joint;                ///< empty: none
  problem::Contact contact{problem::Frictionless()};
  GeometryConfig geometry;
  std::vector<double> direction;  ///< of the pairing; empty: along the normals of the slave
  double reach = std::numeric_limits<double>::infinity();
  Where where;
};

/// One [[quantity]] table.
struct QuantityConfig
{
  std::string name{};
  problem::QuantityKind kind = problem::QuantityKind::energy;
  std::string boundary{};           ///< empty: none given
  std::vector<double> direction{};  ///< empty: the outward normal
  std::vector<double> point{};      ///< of a moment; empty: the origin
  double ramp = 0;                  ///< 0: none given
  Where where;
};

/// One [probe.<name>] table: a point, or points along a line.
struct ProbeConfig
{
  std::string name{};
  std::vector<double> point{};  ///< empty for a line
  std::vector<double> from{};
  std::vector<double> to{};
  int n_points = 1;
  Where where;
};

/// One [section.<name>] table.
struct SectionConfig
{
  std::string name{};
  std::vector<double> point{};
  std::vector<double> normal{};  ///< of any length but 0
  std::optional<problem::Field> within{};
  Where where;
};

/// `tribound study`.
struct StudyConfig
{
  std::optional<int> reference_degree;  ///< of the reference solution; min(p + 1, 4) where absent
  double reference_factor = 0.2;        ///< largest relative bound, over the smallest one studied
  long max_reference_dofs = 500'000;
  long dual_norm_dofs = 100'000;  ///< of the spaces in which dual norms are computed; 0: none
  bool figures = true;            ///< whether to draw them
};

/// `tribound judge`.
struct JudgeConfig
{
  double sharpness = 0.1;  ///< of the bound over the distance of what is judged
};

/// The levels whose fields a run writes.
enum class FieldLevels
{
  last,  ///< when the run ends
  all    ///< each as soon as it is complete
};

/// When a run writes a checkpoint.
enum class Checkpoints
{
  none,
  last,  ///< after each refinement, or after each load step, replacing the previous one
  all    ///< after each load step, in a separate file
};

struct OutputConfig
{
  std::filesystem::path directory;  ///< relative to the working directory; default_directory() of the case
  bool vtu = true;
  FieldLevels levels = FieldLevels::last;
  bool report = true;  ///< the page report.html
  bool mesh = true;    ///< the last mesh, adapted.msh
  Checkpoints checkpoints = Checkpoints::none;
  std::vector<double> moment_about;  ///< point of the moments in the balance; empty: centroid of the body
  Where moment_about_where;
};

/// The default output directory: out/block for block.toml.
[[nodiscard]] std::filesystem::path default_directory(const std::filesystem::path& case_file);

struct Config
{
  std::string file;  ///< the case file, for messages
  std::string title;
  std::string purpose;
  std::vector<std::string> not_covered;  ///< added to that of the certificate
  problem::Units units;                  ///< of [units]
  bool is_axisymmetric = false;
  mesh::MeshSource mesh;
  std::vector<mesh::FormulaGroup> groups;  ///< that the mesh gets before anything is looked for in it
  std::vector<MaterialConfig> materials;
  std::vector<LoadConfig> loads;
  std::vector<BoundaryConfig> boundaries;
  std::vector<ContactConfig> contacts;
  std::vector<SurfaceConfig> obstacles;
  std::vector<SurfaceConfig> shapes;
  std::vector<QuantityConfig> quantities;
  std::vector<ProbeConfig> probes;
  std::vector<SectionConfig> sections;
  std::optional<HistoryConfig> history;  ///< absent: one step without history, t = 1
  adapt::Method method;
  adapt::AdaptOptions adapt;
  StudyConfig study;
  JudgeConfig judge;
  OutputConfig output;
  io::EffectiveCase effective;
};

/// The files that the case names and whose contents decide the result: of the mesh, and of surfaces. Those
/// that a deck includes are not among them.
[[nodiscard]] std::vector<std::filesystem::path> files_of(const Config& config);

/// Finds where the contacts of the case separate the bodies of a mesh. Throws InputError for a boundary that
/// the mesh does not have. Keeps a reference.
[[nodiscard]] mesh::FindSeams find_seams(const Config& config);

/// The names of the friction laws in use, such as "tresca", "none+coulomb", or "" without contact.
[[nodiscard]] std::string friction_name(const Config& config);

/// Reads a case file; each override is "dotted.key=TOML value" (a bare word is taken as a string).
/// Throws InputError.
[[nodiscard]] Config read_config(const std::filesystem::path& file,
                                 std::span<const std::string> overrides = {});

/// The same from a document that a program has made; paths are relative to the directory of `name`, which
/// messages give for the file. Functions cannot stand in the effective case, so checkpoints, which are
/// restarted from that, are refused.
[[nodiscard]] Config make_config(Node document, std::string name = "case",
                                 std::span<const std::string> overrides = {});

/// The same from text; messages give `name` for the file.
[[nodiscard]] Config parse_config(std::string_view text, std::string name = "case",
                                  std::span<const std::string> overrides = {});

}  // namespace tribound::case_file
