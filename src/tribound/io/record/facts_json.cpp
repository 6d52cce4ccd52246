#include "tribound/io/record/facts_json.h"

#include "tribound/base/sha256.h"

namespace tribound::io
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

Json effective_case_json(const RunRecord& run)
{
  if (run.effective.text.empty()) return nullptr;
  return {{"file", run.case_file},
          {"sha256", sha256(run.effective.text)},
          {"overrides", run.effective.overrides}};
}

Json balance_json(const certify::Balance& balance)
{
  Json object{{"about", balance.about}, {"rows", Json::array()}};
  for (const certify::BalanceRow& row : balance.rows)
    object["rows"].push_back({{"kind", certify::to_string(row.kind)},
                              {"name", row.name},
                              {"source", row.source},
                              {"force", row.force},
                              {"moment", row.moment ? Json(*row.moment) : Json(nullptr)}});
  object["note"] = text_or_null(certify::moment_note(balance));
  return object;
}

}  // namespace tribound::io
