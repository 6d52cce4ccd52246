#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <span>
#include <utility>

#include "tribound/algebra/petsc_detail.h"
#include "tribound/algebra/sparse_rows.h"
#include "tribound/base/parallel.h"

namespace tribound::algebra
{

using detail::check;
using detail::wrap;

void MatDeleter::operator()(_p_Mat* mat) const
{
  if (!detail::waits_for_others(reinterpret_cast<PetscObject>(mat))) MatDestroy(&mat);
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

/// From now on products with this matrix use threads, if there are several and the matrix is large; PETSc's
/// own use one. The result does not depend on their number.
void multiply_in_threads(Mat a)
{
  constexpr PetscInt worth_threads = 10'000;
  PetscInt n = 0;
  check(MatGetSize(a, &n, nullptr), "creating a matrix");
  if (max_threads() > 1 && n >= worth_threads)
    check(MatSetOperation(a, MATOP_MULT, reinterpret_cast<void (*)()>(multiply_rows)), "creating a matrix");
}

}  // namespace

void detail::require_numbered(std::int64_t n_rows)
{
  constexpr PetscInt most = std::numeric_limits<PetscInt>::max();
  if (n_rows > most)
    throw SolveError(fmt::format(
        "the matrix has {} rows, of which this PETSc can number {}: lower adapt.max_dofs or raise "
        "the tolerance",
        n_rows, most));
}

void SparseMatrix::create()
{
  if (sharing_) detail::require_numbered(block_size_ * sharing_->n);
  const auto n = static_cast<PetscInt>(sharing_ ? sharing_->owned.size() * block_size_ : size_);
  Mat mat = nullptr;
  check(MatCreate(detail::communicator(sharing_), &mat), "creating a matrix");
  mat_.reset(mat);
  check(MatSetSizes(mat, n, n, PETSC_DETERMINE, PETSC_DETERMINE), "creating a matrix");
  check(MatSetType(mat, sharing_ ? MATMPIAIJ : MATSEQAIJ), "creating a matrix");
  check(MatSetBlockSize(mat, block_size_), "creating a matrix");
}

/// Called once there are entries: on several ranks PETSc 3.18 crashes if the first option is set earlier.
void SparseMatrix::settle()
{
  check(MatSetOption(mat_.get(), MAT_USE_INODES, PETSC_FALSE),
        "creating a matrix");  // slower than rows one by one
  if (!sharing_) multiply_in_threads(mat_.get());
}

SparseMatrix::SparseMatrix(Index n, int block_size, Triplets entries, Sharing sharing)
    : size_(n), block_size_(block_size), sharing_(std::move(sharing))
{
  if (!sharing_)
  {
    take(pattern_of(n, entries, places_));
    set_values(entries.values);
    return;
  }
  create();
  for (std::size_t k = 0; k < entries.rows.size(); ++k)
  {
    int& row = entries.rows[k];
    int& col = entries.cols[k];
    const bool counts = row >= 0 && col >= 0 && detail::is_owned(*sharing_, block_size_, row);
    row = counts ? detail::global_unknown(*sharing_, block_size_, row) : -1;
    col = counts ? detail::global_unknown(*sharing_, block_size_, col) : -1;
  }
  check(MatSetPreallocationCOO(mat_.get(), static_cast<PetscCount>(entries.rows.size()), entries.rows.data(),
                               entries.cols.data()),
        "building the pattern of a matrix");
  set_values(entries.values);
  settle();
}

SparseMatrix::SparseMatrix(int block_size, SparseRows rows, Sharing sharing)
    : size_(static_cast<Index>(rows.begin.size()) - 1), block_size_(block_size), sharing_(std::move(sharing))
{
  if (!sharing_)
  {
    take(std::move(rows));
    return;
  }
  create();
  size_ = static_cast<Index>(sharing_->global.size()) * block_size;
  for (int& column : rows.columns) column = detail::global_unknown(*sharing_, block_size_, column);
  check(MatMPIAIJSetPreallocationCSR(mat_.get(), rows.begin.data(), rows.columns.data(), rows.values.data()),
        "assembling a matrix");
  settle();
}

SparseMatrix::SparseMatrix(const SparseMatrix& like, SparseRows rows)
    : size_(like.size_), block_size_(like.block_size_)
{
  take(std::move(rows));
}

void SparseMatrix::take(SparseRows rows)
{
  rows_ = std::move(rows);
  Mat mat = nullptr;
  check(MatCreateSeqAIJWithArrays(detail::communicator(), size_, size_, rows_.begin.data(),
                                  rows_.columns.data(), rows_.values.data(), &mat),
        "creating a matrix");
  mat_.reset(mat);
  check(MatSetBlockSize(mat, block_size_), "creating a matrix");
  settle();
}

std::int64_t SparseMatrix::global_size() const
{
  return sharing_ ? block_size_ * sharing_->n : size_;
}

SparseMatrix SparseMatrix::duplicate() const
{
  if (!sharing_)
  {
    SparseMatrix copy(*this, rows_);
    copy.places_ = places_;
    return copy;
  }
  SparseMatrix copy;
  copy.size_ = size_;
  copy.block_size_ = block_size_;
  copy.sharing_ = sharing_;
  copy.has_more_ = has_more_;
  Mat mat = nullptr;
  check(MatDuplicate(mat_.get(), MAT_COPY_VALUES, &mat), "copying a matrix");
  copy.mat_.reset(mat);
  copy.settle();
  return copy;
}

std::vector<double> SparseMatrix::multiply(std::span<const double> x) const
{
  std::vector<double> y(size_);
  detail::on_owned_entries(sharing_, block_size_, x, y,
                           [&](Vec own_x, Vec own_y)
                           { check(MatMult(mat_.get(), own_x, own_y), "multiplying a matrix"); });
  return y;
}

std::vector<double> SparseMatrix::diagonal() const
{
  std::vector<double> own(sharing_ ? sharing_->owned.size() * block_size_ : size_);
  check(MatGetDiagonal(mat_.get(), wrap(std::span(own), detail::communicator(sharing_)).get()),
        "reading a matrix");
  if (!sharing_) return own;
  std::vector<double> d(size_);
  detail::put_owned_entries<double>(*sharing_, block_size_, own, d);
  return d;
}

namespace
{

/// Tells PETSc that the values have changed.
void tell_changed(Mat mat)
{
  PetscScalar* values = nullptr;
  check(MatSeqAIJGetArray(mat, &values), "assembling a matrix");
  check(MatSeqAIJRestoreArray(mat, &values), "assembling a matrix");
}

}  // namespace

void SparseMatrix::set_values(std::span<const double> values)
{
  if (sharing_)
  {
    check(MatSetValuesCOO(mat_.get(), values.data(), INSERT_VALUES), "assembling a matrix");
    return;
  }
  assert(values.size() == places_.size());
  std::ranges::fill(rows_.values, 0.0);
  for (std::size_t k = 0; k < values.size(); ++k)
    if (places_[k] >= 0) rows_.values[places_[k]] += values[k];
  tell_changed(mat_.get());
}

namespace
{

/// Rows and columns of a matrix, returned to PETSc on destruction.
class Pattern
{
 public:
  /// `names`: of the columns, ascending; null: their numbers.
  explicit Pattern(Mat mat, const PetscInt* names = nullptr) : mat_(mat), names_(names)
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
    const auto name = [](const Pattern& pattern)
    { return [names = pattern.names_](PetscInt column) { return names ? names[column] : column; }; };
    for (PetscInt i = 0; i < n_; ++i)
      if (!std::ranges::includes(row(i), other.row(i), {}, name(*this), name(other))) return false;
    return true;
  }

 private:
  [[nodiscard]] std::span<const PetscInt> row(PetscInt i) const
  {
    return {columns_ + rows_[i], columns_ + rows_[i + 1]};
  }

  Mat mat_;
  const PetscInt* names_;
  PetscInt n_ = 0;
  const PetscInt* rows_ = nullptr;
  const PetscInt* columns_ = nullptr;
  PetscBool done_ = PETSC_FALSE;
};

/// Whether the pattern of `a` contains that of `b`, as far as this process has them.
bool contains_pattern(Mat a, Mat b)
{
  const detail::LocalBlocks of_a = detail::local_blocks(a);
  const detail::LocalBlocks of_b = detail::local_blocks(b);
  if (!Pattern(of_a.own).contains(Pattern(of_b.own))) return false;
  return !of_a.others || Pattern(of_a.others, of_a.columns).contains(Pattern(of_b.others, of_b.columns));
}

}  // namespace

SparseMatrix SparseMatrix::sum(const SparseMatrix& a, const SparseMatrix& b)
{
  if (!a.sharing_) return {a, algebra::sum(a.rows_, b.rows_)};
  SparseMatrix result = a.duplicate();
  result.has_more_ = a.sharing_->ranks.any(!contains_pattern(a.mat_.get(), b.mat_.get()));
  check(MatAXPY(result.mat_.get(), 1.0, b.mat_.get(),
                result.has_more_ ? DIFFERENT_NONZERO_PATTERN : SUBSET_NONZERO_PATTERN),
        "adding matrices");
  result.settle();
  return result;
}

void SparseMatrix::assign_sum(const SparseMatrix& a, const SparseMatrix& b)
{
  if (!sharing_)
  {
    algebra::assign_sum(a.rows_, b.rows_, rows_);
    return tell_changed(mat_.get());
  }
  const auto add = [this](const SparseMatrix& term)
  { check(MatAXPY(mat_.get(), 1.0, term.mat_.get(), SUBSET_NONZERO_PATTERN), "adding matrices"); };
  if (has_more_)
  {
    check(MatZeroEntries(mat_.get()), "adding matrices");
    add(a);
  }
  else
    check(MatCopy(a.mat_.get(), mat_.get(), SAME_NONZERO_PATTERN), "copying a matrix");
  add(b);
}

}  // namespace tribound::algebra
