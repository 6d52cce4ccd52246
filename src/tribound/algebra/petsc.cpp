#include "tribound/algebra/petsc.h"

#include <dmumps_c.h>
#include <mpi.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <system_error>

#include "tribound/algebra/petsc_detail.h"
#include "tribound/base/temporary_directory.h"

namespace tribound::algebra
{

namespace detail
{

/// Set while there is an Environment.
MPI_Comm own_communicator = MPI_COMM_NULL;     // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
MPI_Comm common_communicator = MPI_COMM_NULL;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

void check(PetscErrorCode error, const char* doing)
{
  if (error == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(error, &text, nullptr);
  std::string message = std::string("PETSc failed while ") + doing + ": " + (text ? text : "unknown error");
  if (error == PETSC_ERR_MEM)
    message += " (out of memory: take fewer degrees of freedom or method = \"iterative\")";
  throw SolveError(message);
}

VecHandle wrap(std::span<double> values, MPI_Comm processes)
{
  const auto n = static_cast<PetscInt>(values.size());
  Vec vec = nullptr;
  if (processes == communicator())
    check(VecCreateSeqWithArray(processes, 1, n, values.data(), &vec), "wrapping a vector");
  else
    check(VecCreateMPIWithArray(processes, 1, n, PETSC_DECIDE, values.data(), &vec), "wrapping a vector");
  return VecHandle(vec);
}

VecHandle wrap(std::span<const double> values, MPI_Comm processes)
{
  return wrap(std::span(const_cast<double*>(values.data()), values.size()), processes);  // NOLINT
}

std::vector<double> from_owned_entries(const Sharing& sharing, int block_size, Vec owned)
{
  PetscInt n = 0;
  const PetscScalar* entries = nullptr;
  check(VecGetLocalSize(owned, &n), "reading a vector");
  check(VecGetArrayRead(owned, &entries), "reading a vector");
  const std::span<const double> own(entries, static_cast<std::size_t>(n));
  std::vector<double> all(own.begin(), own.end());
  if (sharing)
  {
    all.assign(block_size * sharing->global.size(), 0.0);
    put_owned_entries(*sharing, block_size, own, std::span(all));
  }
  check(VecRestoreArrayRead(owned, &entries), "reading a vector");
  return all;
}

bool waits_for_others(PetscObject object)
{
  if (std::uncaught_exceptions() == 0) return false;
  MPI_Comm processes = MPI_COMM_NULL;
  int n = 1;
  if (PetscObjectGetComm(object, &processes) == 0) MPI_Comm_size(processes, &n);
  return n > 1;
}

LocalBlocks local_blocks(Mat a)
{
  PetscBool is_sequential = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(a), MATSEQAIJ, &is_sequential),
        "reading a matrix");
  if (is_sequential) return {a};
  LocalBlocks blocks;
  check(MatMPIAIJGetSeqAIJ(a, &blocks.own, &blocks.others, &blocks.columns), "reading a matrix");
  return blocks;
}

MPI_Comm communicator()
{
  assert(own_communicator != MPI_COMM_NULL);
  return own_communicator;
}

MPI_Comm communicator(const Sharing& sharing)
{
  return sharing ? common_communicator : communicator();
}

Options::Options(bool multigrid, const Sharing& sharing)
{
  check(PetscOptionsCreate(&own_), "setting solver options");
  char* of_process = nullptr;
  check(PetscOptionsGetAll(nullptr, &of_process), "setting solver options");
  check(PetscOptionsInsertString(own_, of_process), "setting solver options");
  check(PetscFree(of_process), "setting solver options");
  set_default("-tribound_2d_mat_mumps_icntl_7", "2");  // see configure_mumps()
  if (multigrid)
  {
    // Graded meshes have vertices of high valence: with PETSc's single level of aggressive coarsening the
    // second and third matrix had 2.8 times the entries of the first, and the Galerkin products took four
    // fifths of a first step. Weak couplings must not join aggregates, or iterations grow by a third.
    for (const std::string prefix : {"-tribound_", "-tribound_mg_coarse_"})  // the second below P^p
    {
      set_default(prefix + "pc_gamg_aggressive_coarsening", "20");  // forgotten if set by a call
      set_default(prefix + "pc_gamg_threshold", "0.02");
    }
    set_default("-tribound_mg_coarse_mat_mumps_icntl_14", "40");  // see configure_mumps()
    // Triple products as R A P instead of a scalable algorithm, and rows one by one: both save up to a third.
    // PETSc makes the matrices on the levels, so that only its options reach them.
    if (!sharing) set_default("-matptap_via", "rap");  // not available on several ranks
    set_default("-mat_no_inode", "true");
  }
  check(PetscOptionsPush(own_), "setting solver options");
}

Options::~Options()
{
  PetscOptionsPop();
  PetscOptionsDestroy(&own_);
}

void Options::set_default(const std::string& name, const char* value)
{
  PetscBool is_set = PETSC_FALSE;
  check(PetscOptionsHasName(own_, nullptr, name.c_str(), &is_set), "setting solver options");
  if (!is_set) check(PetscOptionsSetValue(own_, name.c_str(), value), "setting solver options");
}

void configure_mumps(Mat factors, int dim)
{
  check(MatMumpsSetIcntl(factors, 6, 0), "creating a solver");  // the diagonal is good: no column permutation
  check(MatMumpsSetIcntl(factors, 14, 40), "creating a solver");  // room for pivoting, percent
  // In 2D approximate minimum fill takes a quarter of the time of PORD, the ordering that MUMPS chooses; the
  // factorisation then takes 25 % less to 15 % more (p = 1, 2, 4, 100k to 900k degrees of freedom), in 3D
  // 30 % more. PETSc 3.18 overwrites ICNTL(7) when it starts MUMPS, unless it comes as an option: see
  // Options.
  if (dim == 2) check(MatSetOptionsPrefix(factors, "tribound_2d_"), "creating a solver");
}

}  // namespace detail

using detail::check;

namespace
{

/// Sets an environment variable in its scope, unless it has a value already or the value given is empty.
class Variable
{
 public:
  Variable(const char* name, const std::string& value)
      : name_(value.empty() || std::getenv(name) ? nullptr : name)
  {
    if (name_) ::setenv(name_, value.c_str(), 1);
  }
  ~Variable()
  {
    if (name_) ::unsetenv(name_);
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

/// Whether mpirun or a batch system has started this process and chosen how MPI runs.
bool is_launched()
{
  constexpr std::array variables = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"};
  return std::ranges::any_of(variables, [](const char* name) { return std::getenv(name) != nullptr; });
}

/// If alone, Open MPI puts its files into `directory`: in the common one a starting process may fail because
/// an ending one removes it. It also starts no daemon and looks for no network, which takes longer than MPI
/// itself and would only serve further processes. Child processes inherit none of these settings.
bool start_mpi(bool alone, const std::filesystem::path& directory)
{
  const Variable files("OMPI_MCA_orte_tmpdir_base", directory.string());
  const Variable no_daemon("OMPI_MCA_ess_singleton_isolated", alone ? "1" : "");
  const Variable no_network("OMPI_MCA_pml", alone ? "ob1" : "");
  const Variable to_itself("OMPI_MCA_btl", alone ? "self" : "");
  int provided = 0;
  return MPI_Init_thread(nullptr, nullptr, MPI_THREAD_MULTIPLE, &provided) == MPI_SUCCESS;
}

}  // namespace

Libraries::Libraries()
{
  PetscBool has_petsc = PETSC_FALSE;
  check(PetscInitialized(&has_petsc), "starting");
  if (!has_petsc) choose_blas_kernels();  // otherwise BLAS may have been called already
  int has_mpi = 0;
  MPI_Initialized(&has_mpi);
  if (has_mpi == 0)
  {
    const bool alone = !is_launched();
    if (alone) session_directory_ = make_temporary_directory();
    started_mpi_ = start_mpi(alone, session_directory_);
    if (!started_mpi_) throw SolveError("MPI does not start");
  }
  if (!has_petsc)
  {
    check(PetscOptionsSetValue(nullptr, "-no_signal_handler", "true"),
          "starting");  // the program handles signals
    check(PetscInitializeNoArguments(), "starting");
    started_petsc_ = true;
  }
}

Libraries::~Libraries()
{
  if (started_petsc_) PetscFinalize();
  if (started_mpi_) MPI_Finalize();
  std::error_code none;
  if (!session_directory_.empty()) std::filesystem::remove_all(session_directory_, none);
}

Environment::Environment()
{
  PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
  MPI_Comm_dup(MPI_COMM_SELF, &detail::own_communicator);
  MPI_Comm_dup(MPI_COMM_WORLD, &detail::common_communicator);
}

Environment::~Environment()
{
  MPI_Comm_free(&detail::common_communicator);
  MPI_Comm_free(&detail::own_communicator);
  PetscPopErrorHandler();
}

AlgebraVersions algebra_versions()
{
  AlgebraVersions versions;
  PetscInt major = 0;
  PetscInt minor = 0;
  PetscInt subminor = 0;
  if (PetscGetVersionNumber(&major, &minor, &subminor, nullptr) == 0)
    versions.petsc = std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(subminor);
  versions.mumps = MUMPS_VERSION;
  int length = 0;
  char library[MPI_MAX_LIBRARY_VERSION_STRING];
  MPI_Get_library_version(library, &length);
  versions.mpi = std::string(library).substr(0, std::string(library).find(','));
  versions.blas = blas_facts();
  return versions;
}

}  // namespace tribound::algebra
