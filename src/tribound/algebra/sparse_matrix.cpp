#include <algorithm>

#include "tribound/algebra/petsc_detail.h"
#include "tribound/base/parallel.h"

namespace tribound::algebra
{

using detail::check;
using detail::wrap;

void MatDeleter::operator()(_p_Mat* mat) const
{
  MatDestroy(&mat);
}

namespace
{

/// y = A x in threads.
PetscErrorCode multiply_rows(Mat a, Vec x, Vec y)
{
  PetscFunctionBegin;
  PetscInt n = 0;
  const PetscInt* rows = nullptr;
  const PetscInt* columns = nullptr;
  PetscScalar* entries = nullptr;
  const PetscScalar* in = nullptr;
  PetscScalar* out = nullptr;
  PetscCall(MatGetSize(a, &n, nullptr));
  PetscCall(MatSeqAIJGetCSRAndMemType(a, &rows, &columns, &entries, nullptr));
  PetscCall(VecGetArrayRead(x, &in));
  PetscCall(VecGetArrayWrite(y, &out));
#pragma omp parallel for schedule(static)
  for (PetscInt i = 0; i < n; ++i)
  {
    PetscScalar sum = 0;
    for (PetscInt k = rows[i]; k < rows[i + 1]; ++k) sum += entries[k] * in[columns[k]];
    out[i] = sum;
  }
  PetscCall(VecRestoreArrayWrite(y, &out));
  PetscCall(VecRestoreArrayRead(x, &in));
  PetscFunctionReturn(0);
}

/// From now on products with this matrix use threads, if there are more than one and it is large; PETSc's own
/// use one. The same result for any number of them.
void multiply_in_threads(Mat a)
{
  constexpr PetscInt worth_threads = 10'000;
  PetscInt n = 0;
  check(MatGetSize(a, &n, nullptr), "creating a matrix");
  if (max_threads() > 1 && n >= worth_threads)
    check(MatSetOperation(a, MATOP_MULT, reinterpret_cast<void (*)()>(multiply_rows)), "creating a matrix");
}

}  // namespace

void SparseMatrix::create(int block_size)
{
  Mat mat = nullptr;
  check(MatCreate(detail::communicator(), &mat), "creating a matrix");
  mat_.reset(mat);
  check(MatSetSizes(mat, size_, size_, size_, size_), "creating a matrix");
  check(MatSetType(mat, MATSEQAIJ), "creating a matrix");
  check(MatSetBlockSize(mat, block_size), "creating a matrix");
  check(MatSetOption(mat, MAT_USE_INODES, PETSC_FALSE), "creating a matrix");  // slower than rows one by one
  multiply_in_threads(mat);
}

SparseMatrix::SparseMatrix(Index n, int block_size, Triplets entries) : size_(n)
{
  create(block_size);
  check(MatSetPreallocationCOO(mat_.get(), static_cast<PetscCount>(entries.rows.size()), entries.rows.data(),
                               entries.cols.data()),
        "building the pattern of a matrix");
  set_values(entries.values);
}

SparseMatrix::SparseMatrix(int block_size, const SparseRows& rows)
    : size_(static_cast<Index>(rows.begin.size()) - 1)
{
  create(block_size);
  check(MatSeqAIJSetPreallocationCSR(mat_.get(), rows.begin.data(), rows.columns.data(), rows.values.data()),
        "assembling a matrix");
}

SparseMatrix SparseMatrix::duplicate() const
{
  SparseMatrix copy;
  copy.size_ = size_;
  copy.has_more_ = has_more_;
  Mat mat = nullptr;
  check(MatDuplicate(mat_.get(), MAT_COPY_VALUES, &mat), "copying a matrix");
  copy.mat_.reset(mat);
  multiply_in_threads(mat);
  return copy;
}

std::vector<double> SparseMatrix::multiply(std::span<const double> x) const
{
  std::vector<double> y(size_);
  check(MatMult(mat_.get(), wrap(x).get(), wrap(std::span(y)).get()), "multiplying a matrix");
  return y;
}

std::vector<double> SparseMatrix::diagonal() const
{
  std::vector<double> d(size_);
  check(MatGetDiagonal(mat_.get(), wrap(std::span(d)).get()), "reading a matrix");
  return d;
}

void SparseMatrix::set_values(std::span<const double> values)
{
  check(MatSetValuesCOO(mat_.get(), values.data(), INSERT_VALUES), "assembling a matrix");
}

namespace
{

/// Rows and columns of a matrix, given back at the end.
class Pattern
{
 public:
  explicit Pattern(Mat mat) : mat_(mat)
  {
    check(MatGetRowIJ(mat_, 0, PETSC_FALSE, PETSC_FALSE, &n_, &rows_, &columns_, &done_), "reading a matrix");
    if (!done_) throw SolveError("PETSc does not give the pattern of a matrix");
  }
  ~Pattern() { MatRestoreRowIJ(mat_, 0, PETSC_FALSE, PETSC_FALSE, &n_, &rows_, &columns_, &done_); }
  Pattern(const Pattern&) = delete;
  Pattern& operator=(const Pattern&) = delete;

  /// Whether all entries of the other are among its own; columns are sorted.
  [[nodiscard]] bool contains(const Pattern& other) const
  {
    for (PetscInt i = 0; i < n_; ++i)
      if (!std::includes(columns_ + rows_[i], columns_ + rows_[i + 1], other.columns_ + other.rows_[i],
                         other.columns_ + other.rows_[i + 1]))
        return false;
    return true;
  }

 private:
  Mat mat_;
  PetscInt n_ = 0;
  const PetscInt* rows_ = nullptr;
  const PetscInt* columns_ = nullptr;
  PetscBool done_ = PETSC_FALSE;
};

}  // namespace

SparseMatrix SparseMatrix::sum(const SparseMatrix& a, const SparseMatrix& b)
{
  SparseMatrix result = a.duplicate();
  result.has_more_ = !Pattern(a.mat_.get()).contains(Pattern(b.mat_.get()));
  check(MatAXPY(result.mat_.get(), 1.0, b.mat_.get(),
                result.has_more_ ? DIFFERENT_NONZERO_PATTERN : SUBSET_NONZERO_PATTERN),
        "adding matrices");
  check(MatSetOption(result.mat_.get(), MAT_USE_INODES, PETSC_FALSE), "adding matrices");
  multiply_in_threads(result.mat_.get());
  return result;
}

void SparseMatrix::assign_sum(const SparseMatrix& a, const SparseMatrix& b)
{
  if (has_more_)
  {
    check(MatZeroEntries(mat_.get()), "adding matrices");
    check(MatAXPY(mat_.get(), 1.0, a.mat_.get(), SUBSET_NONZERO_PATTERN), "adding matrices");
  }
  else
    check(MatCopy(a.mat_.get(), mat_.get(), SAME_NONZERO_PATTERN), "copying a matrix");
  check(MatAXPY(mat_.get(), 1.0, b.mat_.get(), SUBSET_NONZERO_PATTERN), "adding matrices");
}

}  // namespace tribound::algebra
