#include "io/facts_json.h"

namespace tribound
{

Json program_json(const BuildFacts& build)
{
  return {{"name", "tribound"},         {"version", build.version},
          {"compiler", build.compiler}, {"petsc", build.petsc},
          {"mumps", build.mumps},       {"gmsh", build.gmsh},
          {"blas", build.blas},         {"blas_threads", build.blas_threads},
          {"mpi", build.mpi},           {"eigen", build.eigen},
          {"features", build.features}};
}

Json mesh_json(const MeshFacts& mesh)
{
  Json object{
      {"vertices", mesh.vertices},         {"cells", mesh.cells},      {"smallest_cell", mesh.smallest_cell},
      {"largest_cell", mesh.largest_cell}, {"regions", Json::array()}, {"boundaries", Json::array()}};
  for (const RegionFacts& region : mesh.regions)
    object["regions"].push_back({{"name", region.name},
                                 {"cells", region.cells},
                                 {"measure", region.measure},
                                 {"material", region.material}});
  for (const BoundaryFacts& boundary : mesh.boundaries)
    object["boundaries"].push_back({{"name", boundary.name},
                                    {"facets", boundary.facets},
                                    {"measure", boundary.measure},
                                    {"condition", boundary.condition}});
  return object;
}

}  // namespace tribound
