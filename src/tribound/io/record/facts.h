#pragma once

/// @file facts.h
/// Facts about a case, its mesh and the program, as plain data for the report and the console.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tribound/certify/equilibrate/stress.h"
#include "tribound/fem/space.h"
#include "tribound/problem/problem.h"
#include "tribound/problem/units.h"

namespace tribound::io
{

/// A file by its contents.
struct HashedFile
{
  std::string name;    ///< for people
  std::string sha256;  ///< FIPS 180-4, 64 hexadecimal digits
};

/// The solved case: the case file with every --set applied.
struct EffectiveCase
{
  std::string text;                    ///< TOML; a case file for output.directory
  std::vector<std::string> overrides;  ///< as given
  std::vector<HashedFile> files = {};  ///< that it names; empty until they are read
};

struct CaseFacts
{
  std::string title;
  std::string file;
  int dimension = 0;
  int degree = 0;
  certify::PatchStress stress = certify::PatchStress::rows;  ///< of the bound
  std::string friction;                                      ///< friction_name(); empty without contact
  double gamma0 = 0.0;
  problem::Units units{};
  /// The units of the [[quantity]] tables, by name; empty for pure numbers, and where no units are named.
  std::vector<std::pair<std::string, std::string>> quantity_units{};
  /// What the computation is for, in the words of its author.
  std::string purpose{};
  /// What the case leaves out of the problem that it stands for, in the words of its author.
  std::vector<std::string> not_covered{};
  /// Whether the mesh is the meridian of a body of revolution.
  bool is_axisymmetric = false;

  /// Of the body: 3 for one of revolution.
  [[nodiscard]] int body_dimension() const { return is_axisymmetric ? 3 : dimension; }
  /// "MPa"; empty where no units are named.
  [[nodiscard]] std::string label(problem::UnitOf what) const { return units.label(what, body_dimension()); }
  /// " MPa", to be appended to a number; empty where no units are named.
  [[nodiscard]] std::string behind(problem::UnitOf what) const
  {
    return units.behind(what, body_dimension());
  }
  /// The unit of the [[quantity]] of this name; empty: none.
  [[nodiscard]] std::string unit_of(std::string_view quantity) const;
};

struct RegionFacts
{
  std::string name;
  long cells = 0;
  double measure = 0.0;  ///< area or volume
  std::string material;  ///< such as "E = 1, nu = 0.3, plane strain"
};

struct BoundaryFacts
{
  std::string name;
  long facets = 0;
  double measure = 0.0;   ///< length or area
  std::string condition;  ///< such as "displacement (0, free)" or "contact, Tresca friction"
};

struct MeshFacts
{
  long vertices = 0;
  long cells = 0;
  long free_dofs = 0;
  double smallest_cell = 0.0;  ///< min h_T
  double largest_cell = 0.0;   ///< max h_T
  std::vector<RegionFacts> regions;
  std::vector<BoundaryFacts> boundaries;  ///< the groups, then the facets without a group if there are any
};

/// Versions and features of the program and its libraries.
struct BuildFacts
{
  std::string version;  ///< of Tribound
  std::string compiler;
  std::string petsc;
  std::string mumps;
  std::string gmsh;
  std::string blas;
  int blas_threads = 0;  ///< 0: unknown
  int processes = 1;     ///< that compute together
  int threads = 1;       ///< of each, besides those of the BLAS
  std::string mpi;
  std::string eigen;
  std::vector<std::string> features;
};

/// The mesh of `space` with the data of `problem` on its parts, in words with `units`.
template <int dim>
[[nodiscard]] MeshFacts mesh_facts(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                                   const fem::Constraints& constraints, const problem::Units& units = {});

/// The files by their names without directories, decks with those that they include; without those that
/// cannot be read.
[[nodiscard]] std::vector<HashedFile> hashed_files(std::span<const std::filesystem::path> files);

/// Facts about the program and the libraries it runs with.
[[nodiscard]] BuildFacts build_facts();

/// "E = ..., nu = ...", with the plane model in 2D. Bodies of revolution are of dimension 3.
[[nodiscard]] std::string describe(const problem::Material& material, int dimension,
                                   const problem::Units& units = {});

/// The conditions on a part of the boundary, in words. `dimension`: that of the body.
template <int dim>
[[nodiscard]] std::string describe(const problem::BoundaryCondition<dim>& condition,
                                   const problem::Units& units = {}, int dimension = dim);

}  // namespace tribound::io
