#pragma once

/// @file petsc_detail.h
/// What the files of this folder that use PETSc share. Includes PETSc's own headers.

#include <petscksp.h>

#include <memory>
#include <span>
#include <string>

#include "tribound/algebra/petsc.h"
#include "tribound/base/error.h"

namespace tribound::algebra::detail
{

/// Turns a PETSc error code into a SolveError.
void check(PetscErrorCode error, const char* doing);

struct VecDeleter
{
  void operator()(_p_Vec* vec) const { VecDestroy(&vec); }
};
using VecHandle = std::unique_ptr<_p_Vec, VecDeleter>;

/// A communicator of this process alone, private to the library: messages of other parts of the program do
/// not interfere.
[[nodiscard]] MPI_Comm communicator();
/// The same for the ranks that share nodes.
[[nodiscard]] MPI_Comm communicator(const Sharing& sharing);

/// A PETSc vector on the caller's memory: the entries that this process has.
[[nodiscard]] VecHandle wrap(std::span<double> values, MPI_Comm processes = communicator());
/// The same for reading: PETSc has no vectors of const.
[[nodiscard]] VecHandle wrap(std::span<const double> values, MPI_Comm processes = communicator());

/// The entries of a rank's own nodes, in their order, and back; `block_size` per node.
template <class T>
[[nodiscard]] std::vector<T> owned_entries(const fem::NodeNumbers& nodes, int block_size,
                                           std::span<const T> values)
{
  std::vector<T> result;
  result.reserve(nodes.owned.size() * block_size);
  for (const Index node : nodes.owned)
    for (int a = 0; a < block_size; ++a) result.push_back(values[block_size * node + a]);
  return result;
}
template <class T>
void put_owned_entries(const fem::NodeNumbers& nodes, int block_size, std::span<const T> owned,
                       std::span<T> values)
{
  auto next = owned.begin();
  for (const Index node : nodes.owned)
    for (int a = 0; a < block_size; ++a) values[block_size * node + a] = *next++;
}
/// Calls operation(x, y), which computes y from x, with PETSc vectors of the entries that this process owns.
/// The arguments x and y have entries for all its unknowns; those of ghosts in y stay as they are.
template <class Operation>
void on_owned_entries(const Sharing& sharing, int block_size, std::span<const double> x, std::span<double> y,
                      const Operation& operation)
{
  if (!sharing) return operation(wrap(x).get(), wrap(y).get());
  const MPI_Comm processes = communicator(sharing);
  const std::vector<double> own_x = owned_entries(*sharing, block_size, x);
  std::vector<double> own_y(own_x.size());
  operation(wrap(own_x, processes).get(), wrap(std::span(own_y), processes).get());
  put_owned_entries<double>(*sharing, block_size, own_y, y);
}
/// The reverse: entries for all unknowns from a vector of what this process owns; 0 for those of ghosts.
[[nodiscard]] std::vector<double> from_owned_entries(const Sharing& sharing, int block_size, Vec owned);
/// Throws SolveError if a matrix has more rows on all ranks than a PetscInt can number.
void require_numbered(std::int64_t n_rows);
/// The number of an unknown in PETSc's rows.
[[nodiscard]] inline PetscInt global_unknown(const fem::NodeNumbers& nodes, int block_size, int unknown)
{
  return static_cast<PetscInt>(block_size * nodes.global[unknown / block_size] + unknown % block_size);
}
/// Whether this process owns it.
[[nodiscard]] inline bool is_owned(const fem::NodeNumbers& nodes, int block_size, int unknown)
{
  const std::int64_t own = nodes.global[unknown / block_size] - nodes.first;
  return own >= 0 && own < static_cast<std::int64_t>(nodes.owned.size());
}

/// Whether destroying an object of several processes would wait for the others while this process alone may
/// be leaving by an exception. Such an object is not destroyed.
[[nodiscard]] bool waits_for_others(PetscObject object);

/// The part of a matrix that a process has: its rows, with the columns of own unknowns and, separately, those
/// of others.
struct LocalBlocks
{
  Mat own = nullptr;
  Mat others = nullptr;               ///< null for a sequential matrix
  const PetscInt* columns = nullptr;  ///< of `others`, as the whole matrix numbers them, ascending
};
[[nodiscard]] LocalBlocks local_blocks(Mat a);

/// What attach() has stored with a matrix under a key; null if nothing.
template <class T>
[[nodiscard]] T* find_attached(Mat a, const char* key)
{
  PetscContainer container = nullptr;
  void* found = nullptr;
  check(PetscObjectQuery(reinterpret_cast<PetscObject>(a), key, reinterpret_cast<PetscObject*>(&container)),
        "using a matrix");
  if (container) check(PetscContainerGetPointer(container, &found), "using a matrix");
  return static_cast<T*>(found);
}

/// Stores an object with a matrix, which destroys it in the end.
template <class T>
T& attach(Mat a, const char* key, std::unique_ptr<T> object)
{
  PetscContainer container = nullptr;
  check(PetscContainerCreate(PETSC_COMM_SELF, &container), "using a matrix");
  check(PetscContainerSetPointer(container, object.get()), "using a matrix");
  check(PetscContainerSetUserDestroy(container,
                                     [](void* owned) -> PetscErrorCode
                                     {
                                       delete static_cast<T*>(owned);  // NOLINT
                                       return 0;
                                     }),
        "using a matrix");
  T& result = *object.release();  // the container has it
  const PetscErrorCode error =
      PetscObjectCompose(reinterpret_cast<PetscObject>(a), key, reinterpret_cast<PetscObject>(container));
  check(PetscContainerDestroy(&container), "using a matrix");  // the matrix has it
  check(error, "using a matrix");
  return result;
}

/// PETSc's options while this is alive: those of the process, unchanged, and defaults of the library for
/// those that the process does not set. To surround whatever reads options: setting up solvers.
class Options
{
 public:
  Options(bool multigrid, const Sharing& sharing);
  ~Options();
  Options(const Options&) = delete;
  Options& operator=(const Options&) = delete;

 private:
  void set_default(const std::string& name, const char* value);

  PetscOptions own_ = nullptr;
};

/// Message for tangent matrices of Newton's method that the factors cannot solve with.
inline constexpr const char* singular_tangent =
    "the tangent matrix is singular to working precision: contact that alone holds a body may have opened or "
    "slid (fix a displacement component, or raise nitsche.gamma0)";

/// Settings common to all factorisations by MUMPS; `factors` are not yet started, `dim` is that of the mesh.
void configure_mumps(Mat factors, int dim);
/// MUMPS's Cholesky factors of a symmetric matrix without pivoting, not yet computed.
[[nodiscard]] MatHandle start_cholesky(const SparseMatrix& a, int dim);
/// Computes them, with an Options object alive. False: a pivot is not positive. Throws SolveError when the
/// memory does not suffice.
[[nodiscard]] bool factorise_cholesky(const SparseMatrix& a, Mat factors);
/// Counts one more for n_factorisations().
void count_factorisation();

}  // namespace tribound::algebra::detail
