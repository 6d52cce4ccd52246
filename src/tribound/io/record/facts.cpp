#include "tribound/io/record/facts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <limits>

#include "tribound/algebra/petsc.h"
#include "tribound/base/parallel.h"
#include "tribound/base/sha256.h"
#include "tribound/base/version.h"
#include "tribound/contact/nitsche/given_data.h"
#include "tribound/doctor/load_facts.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/mesh/geometry.h"
#include "tribound/mesh/gmsh.h"
#include "tribound/mesh/import/read.h"
#include "tribound/problem/weights.h"

namespace tribound::io
{

using problem::UnitOf;

namespace
{

template <int dim>
std::vector<RegionFacts> region_facts(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                      const problem::Units& units)
{
  std::vector<RegionFacts> regions;
  const int dimension = dim + (problem.is_axisymmetric() ? 1 : 0);
  for (std::size_t r = 0; r < mesh.region_names().size(); ++r)
    regions.push_back(
        {mesh.region_names()[r], 0, 0.0, describe(problem.material(static_cast<int>(r)), dimension, units)});
  for (Index c = 0; c < mesh.n_owned_cells(); ++c)
  {
    RegionFacts& region = regions[mesh.region(c)];
    ++region.cells;
    region.measure += problem.full_circle() * mesh::cell_map(mesh, c).measure() *
                      problem::mean_weight<dim>(problem, mesh::points_of(mesh.vertices(), mesh.cell(c)));
  }
  for (RegionFacts& region : regions)
  {
    region.cells = static_cast<long>(mesh.ranks().sum(std::int64_t{region.cells}));
    region.measure = mesh.ranks().sum(region.measure);
  }
  return regions;
}

/// Surfaces and direction of a contact in words, if there are any.
std::string geometry_words(const problem::Contact& contact)
{
  std::string words = contact.geometry.empty() ? "" : ", " + contact.geometry;
  if (contact.normal)
    words += contact.normal->is_constant() ? ", along one direction" : ", along a direction that varies";
  return words;
}

/// The role of a pair on boundary number `tag` in words, or nothing.
template <int dim>
std::string pair_words(const problem::Problem<dim>& problem, int tag, const problem::Units& units)
{
  if (const problem::ContactPair<dim>* pair = problem.pair_of_slave(tag))
    return fmt::format("contact with {}, {}, gap {}{}", fmt::join(pair->master, ", "),
                       problem::words(pair->contact.law, units),
                       pair->contact.gap
                           ? problem::words(*pair->contact.gap, units.behind(UnitOf::length, dim))
                           : "of the meshes",
                       geometry_words(pair->contact));
  if (const problem::ContactPair<dim>* pair = problem.pair_of_master(tag))
    return fmt::format("contact with {}, whose master it is", fmt::join(pair->slave, ", "));
  return {};
}

template <int dim>
std::vector<BoundaryFacts> boundary_facts(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh,
                                          const problem::Units& units)
{
  std::vector<BoundaryFacts> boundaries;
  const int dimension = dim + (problem.is_axisymmetric() ? 1 : 0);
  for (int tag = 0; tag < static_cast<int>(problem.boundaries().size()); ++tag)
  {
    const problem::BoundaryCondition<dim>& condition = problem.boundaries()[tag];
    const std::string paired = pair_words(problem, tag, units);
    boundaries.push_back(
        {condition.name, 0, 0.0, paired.empty() ? describe(condition, units, dimension) : paired});
  }
  boundaries.push_back({"(no group)", 0, 0.0, describe(problem.boundary(-1), units)});
  for (const mesh::BoundaryFacet& facet : mesh.owned_boundary())
  {
    BoundaryFacts& boundary = facet.tag < 0 ? boundaries.back() : boundaries[facet.tag];
    ++boundary.facets;
    boundary.measure += problem.full_circle() * contact::weighted_measure(problem, mesh, facet);
  }
  for (BoundaryFacts& boundary : boundaries)
  {
    boundary.facets = static_cast<long>(mesh.ranks().sum(std::int64_t{boundary.facets}));
    boundary.measure = mesh.ranks().sum(boundary.measure);
  }
  if (boundaries.back().facets == 0) boundaries.pop_back();
  return boundaries;
}

}  // namespace

std::string CaseFacts::unit_of(std::string_view quantity) const
{
  const auto found =
      std::ranges::find(quantity_units, quantity, [](const auto& named) { return named.first; });
  return found == quantity_units.end() ? std::string() : found->second;
}

std::string describe(const problem::Material& material, int dimension, const problem::Units& units)
{
  const auto [E, nu] = doctor::elastic_constants(material, dimension);
  const bool plane_stress = material.plane == problem::PlaneModel::stress;
  const char* model = dimension == 3 ? "" : plane_stress ? ", plane stress" : ", plane strain";
  const std::string expansion =
      material.expansion == 0 ? "" : fmt::format(", alpha = {:.6g}", material.expansion);
  return fmt::format("E = {:.6g}{}, nu = {:.6g}{}{}", E, units.behind(UnitOf::stress, dimension), nu,
                     expansion, model);
}

/// "rigid part, force (0, -100) N, moment 5 N m about (0, 0), without x, rz"
template <int dim>
std::string rigid_words(const problem::RigidPart<dim>& part, const problem::Units& units, int dimension)
{
  const auto list = [](const auto& fields)
  {
    std::string words;
    for (const problem::Field& field : fields) words += (words.empty() ? "" : ", ") + problem::words(field);
    return fields.size() > 1 ? "(" + words + ")" : words;
  };
  std::string words = "rigid part, force " + list(part.force) + units.behind(UnitOf::force, dimension);
  if (!std::ranges::all_of(part.moment, &problem::Field::is_zero))
    words += fmt::format(", moment {}{} about ({:g})", list(part.moment),
                         units.behind(UnitOf::moment, dimension), fmt::join(part.point, ", "));
  std::string fixed;
  for (std::size_t i = 0; i < part.fixed.size(); ++i)
    if (part.fixed[i]) fixed += fmt::format("{}{}", fixed.empty() ? "" : ", ", problem::motion_names<dim>[i]);
  return fixed.empty() ? words : words + ", fixed in " + fixed;
}

template <int dim>
std::string describe(const problem::BoundaryCondition<dim>& condition, const problem::Units& units,
                     int dimension)
{
  const std::string length = units.behind(UnitOf::length, dim);
  const std::string stress = units.behind(UnitOf::stress, dim);
  std::string words;
  const auto add = [&words](const std::string& part) { words += (words.empty() ? "" : ", ") + part; };
  const auto vector = [](const auto& component)
  {
    std::string list;
    for (int i = 0; i < dim; ++i) list += (i == 0 ? "" : ", ") + component(i);
    return "(" + list + ")";
  };
  if (condition.rigid) add(rigid_words(*condition.rigid, units, dimension));
  if (condition.clamps_any())
    add("displacement " +
        vector([&](int i)
               { return condition.clamps(i) ? problem::words(*condition.displacement[i]) : "free"; }) +
        length);
  if (std::ranges::any_of(condition.traction, [](const problem::Field& t) { return !t.is_zero(); }))
    add("traction " + vector([&](int i) { return problem::words(condition.traction[i]); }) + stress);
  if (condition.pressure) add("pressure " + problem::words(*condition.pressure, stress));
  if (condition.spring)
  {
    const std::string per_length = units.behind(UnitOf::body_force, dim);
    add(fmt::format("spring {} along the normal, {} across",
                    problem::words(condition.spring->normal, per_length),
                    problem::words(condition.spring->tangential, per_length)));
    if (std::ranges::any_of(condition.spring->rest,
                            [](const problem::Field& rest) { return !rest.is_zero(); }))
      add("at rest at " + vector([&](int i) { return problem::words(condition.spring->rest[i]); }) + length);
  }
  if (condition.contact)
    add("contact, " + problem::words(condition.contact->law, units) + ", gap " +
        problem::words(*condition.contact->gap, length) + geometry_words(*condition.contact));
  return words.empty() ? "traction-free" : words;
}

template <int dim>
MeshFacts mesh_facts(const problem::Problem<dim>& problem, const fem::LagrangeSpace<dim>& space,
                     const fem::Constraints& constraints, const problem::Units& units)
{
  const mesh::Mesh<dim>& mesh = space.mesh();
  MeshFacts facts;
  facts.vertices = mesh.n_global_vertices();
  facts.cells = mesh.n_global_cells();
  facts.free_dofs = fem::n_free_dofs(space, constraints);
  facts.smallest_cell = std::numeric_limits<double>::infinity();
  for (Index c = 0; c < mesh.n_owned_cells(); ++c)
  {
    const double h = mesh::cell_diameter(mesh, c);
    facts.smallest_cell = std::min(facts.smallest_cell, h);
    facts.largest_cell = std::max(facts.largest_cell, h);
  }
  facts.smallest_cell = -mesh.ranks().max(-facts.smallest_cell);
  facts.largest_cell = mesh.ranks().max(facts.largest_cell);
  facts.regions = region_facts(problem, mesh, units);
  facts.boundaries = boundary_facts(problem, mesh, units);
  return facts;
}

std::vector<HashedFile> hashed_files(std::span<const std::filesystem::path> files)
{
  std::vector<HashedFile> hashed;
  hashed.reserve(files.size());
  for (const std::filesystem::path& named : files)
    for (const std::filesystem::path& file : mesh::with_included(named))
      if (const std::string content = read_text(file); !content.empty())
        hashed.push_back({file.filename().string(), sha256(content)});
  return hashed;
}

BuildFacts build_facts()
{
  BuildFacts facts;
  facts.version = version();
  facts.compiler = compiler();
  facts.eigen = fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
  const algebra::AlgebraVersions algebra = algebra::algebra_versions();
  facts.petsc = algebra.petsc;
  facts.mumps = algebra.mumps;
  facts.mpi = algebra.mpi;
  facts.threads = max_threads();
  facts.blas = algebra.blas.library;
  facts.blas_threads = algebra.blas.threads;
  facts.gmsh = mesh::gmsh_version();
  facts.features = {"2D", "3D", "degrees 1-4", "friction: none, Tresca, Coulomb"};
  return facts;
}

template std::string describe(const problem::BoundaryCondition<2>&, const problem::Units&, int);
template std::string describe(const problem::BoundaryCondition<3>&, const problem::Units&, int);
template MeshFacts mesh_facts(const problem::Problem<2>&, const fem::LagrangeSpace<2>&,
                              const fem::Constraints&, const problem::Units&);
template MeshFacts mesh_facts(const problem::Problem<3>&, const fem::LagrangeSpace<3>&,
                              const fem::Constraints&, const problem::Units&);

}  // namespace tribound::io
