#include "app/program_facts.h"

#include <algorithm>

#include "app/shared_file.h"
#include "tribound/algebra/petsc.h"
#include "tribound/base/parallel.h"
#include "tribound/mesh/gmsh.h"

namespace tribound::app
{

io::BuildFacts library_facts()
{
  const algebra::AlgebraVersions algebra = algebra::algebra_versions();
  io::BuildFacts build = io::build_facts();
  build.petsc = algebra.petsc;
  build.mumps = algebra.mumps;
  build.mpi = algebra.mpi;
  build.threads = max_threads();
  build.blas = algebra.blas.library;
  build.blas_threads = algebra.blas.threads;
  build.gmsh = mesh::gmsh_version();
  build.features = {"2D", "3D", "degrees 1-4", "friction: none, Tresca, Coulomb"};
  build.report_page = find_shared_file("report.html").string();
  return build;
}

std::string describe_solver(algebra::LinearMethod method)
{
  switch (method)
  {
    case algebra::LinearMethod::condensed:
      return "direct, condensed onto the contact boundary";
    case algebra::LinearMethod::iterative:
      return "GMRES with multigrid";
    default:
      return "direct";
  }
}

std::string describe_solver(std::span<const adapt::CertifiedStep> steps)
{
  const bool fell_back = std::ranges::any_of(steps, [](const auto& s) { return s.step.fell_back; });
  return describe_solver(steps.back().step.method) +
         (fell_back ? ", as GMRES with multigrid failed on this mesh" : "");
}

}  // namespace tribound::app
