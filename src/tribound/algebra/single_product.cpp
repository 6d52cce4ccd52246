#include "tribound/algebra/single_product.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <vector>

#include "tribound/base/parallel.h"

namespace tribound::algebra::detail
{

namespace
{

constexpr const char* making = "making a matrix in single precision";
constexpr const char* key = "tribound_single";  // under which it is kept with the matrix

/// 1 / x, and 0 where that is beyond the range of numbers.
double inverse_of(double x)
{
  return x >= std::numeric_limits<double>::min() ? 1 / x : 0;
}

/// Rows and columns of a sparse matrix with their values.
struct Rows
{
  explicit Rows(Mat a)
  {
    check(MatGetSize(a, &n, nullptr), making);
    check(MatSeqAIJGetCSRAndMemType(a, &begin, &columns, &entries, nullptr), making);
  }

  PetscInt n = 0;
  const PetscInt* begin = nullptr;
  const PetscInt* columns = nullptr;
  PetscScalar* entries = nullptr;
};

/// A / scale in blocks of floats, block row by block row.
class SingleBlocks
{
 public:
  explicit SingleBlocks(Mat a)
  {
    PetscInt size = 1;
    check(MatGetBlockSize(a, &size), making);
    width_ = size % 3 == 0 ? 3 : size % 2 == 0 ? 2 : 1;
  }

  /// The matrix has changed.
  void set_stale() { is_stale_ = true; }

  /// y = A x.
  void multiply(Mat a, std::span<const double> x, std::span<double> y)
  {
    update(a);
    double largest = 0;
    for (const double value : x) largest = std::max(largest, std::abs(value));
    const double inverse = inverse_of(largest);
    std::ranges::transform(x, x_.begin(), [=](double value) { return static_cast<float>(inverse * value); });
    switch (width_)
    {
      case 3:
        return multiply_blocks<3>(scale_ * largest, y);
      case 2:
        return multiply_blocks<2>(scale_ * largest, y);
      default:
        return multiply_blocks<1>(scale_ * largest, y);
    }
  }

 private:
  void update(Mat a)
  {
    if (!is_stale_) return;
    PetscObjectState pattern = 0;
    check(MatGetNonzeroState(a, &pattern), making);
    const Rows rows(a);
    if (pattern != pattern_) find_blocks(rows);
    fill(rows);
    pattern_ = pattern;
    is_stale_ = false;
  }

  /// The blocks with an entry.
  void find_blocks(const Rows& rows)
  {
    const PetscInt n = rows.n / width_;
    begin_.assign(1, 0);
    columns_.clear();
    x_.resize(rows.n);
    std::vector<PetscInt> seen(n, -1);
    for (PetscInt i = 0; i < n; ++i)
    {
      for (PetscInt k = rows.begin[i * width_]; k < rows.begin[(i + 1) * width_]; ++k)
      {
        const PetscInt j = rows.columns[k] / width_;
        if (seen[j] != i) columns_.push_back(j);
        seen[j] = i;
      }
      std::sort(columns_.begin() + begin_.back(), columns_.end());
      begin_.push_back(static_cast<PetscInt>(columns_.size()));
    }
  }

  void fill(const Rows& rows)
  {
    scale_ = 0;
    for (PetscInt k = 0; k < rows.begin[rows.n]; ++k) scale_ = std::max(scale_, std::abs(rows.entries[k]));
    const double inverse = inverse_of(scale_);
    const std::size_t block = std::size_t(width_) * width_;
    entries_.assign(block * columns_.size(), 0.0F);
    std::vector<PetscInt> place(begin_.size() - 1);  // of the block, by its column
    for (std::size_t i = 0; i + 1 < begin_.size(); ++i)
    {
      for (PetscInt k = begin_[i]; k < begin_[i + 1]; ++k) place[columns_[k]] = k;
      for (int r = 0; r < width_; ++r)
        for (PetscInt k = rows.begin[i * width_ + r]; k < rows.begin[i * width_ + r + 1]; ++k)
        {
          const PetscInt column = rows.columns[k];
          entries_[block * place[column / width_] + r * width_ + column % width_] =
              static_cast<float>(inverse * rows.entries[k]);
        }
    }
  }

  template <int width>
  void multiply_blocks(double factor, std::span<double> y) const
  {
    constexpr PetscInt worth_threads = 5'000;
    const auto n = static_cast<PetscInt>(begin_.size()) - 1;
    const int n_threads = n < worth_threads ? 1 : max_threads();
#pragma omp parallel for schedule(static) num_threads(n_threads)
    for (PetscInt i = 0; i < n; ++i)
    {
      float sum[width] = {};
      for (PetscInt k = begin_[i]; k < begin_[i + 1]; ++k)
      {
        const float* block = entries_.data() + std::size_t(width * width) * k;
        const float* x = x_.data() + std::size_t(width) * columns_[k];
        for (int r = 0; r < width; ++r)
          for (int c = 0; c < width; ++c) sum[r] += block[r * width + c] * x[c];
      }
      for (int r = 0; r < width; ++r) y[std::size_t(width) * i + r] = factor * sum[r];
    }
  }

  int width_ = 1;
  double scale_ = 1;
  bool is_stale_ = true;
  PetscObjectState pattern_ = -1;  ///< of the matrix whose blocks these are
  std::vector<PetscInt> begin_;    ///< per block row
  std::vector<PetscInt> columns_;  ///< per block
  std::vector<float> entries_;
  std::vector<float> x_;  ///< working space
};

/// Those kept with the matrix.
SingleBlocks& blocks_of(Mat a)
{
  if (auto* blocks = find_attached<SingleBlocks>(a, key)) return *blocks;
  return attach(a, key, std::make_unique<SingleBlocks>(a));
}

PetscErrorCode multiply_single(Mat a, Vec x, Vec y)
{
  PetscFunctionBegin;
  PetscInt n = 0;
  const PetscScalar* in = nullptr;
  PetscScalar* out = nullptr;
  PetscCall(MatGetSize(a, &n, nullptr));
  PetscCall(VecGetArrayRead(x, &in));
  PetscCall(VecGetArrayWrite(y, &out));
  PetscErrorCode error = 0;  // no exception may pass through PETSc
  try
  {
    blocks_of(a).multiply(a, std::span(in, n), std::span(out, n));
  }
  catch (const std::bad_alloc&)
  {
    error = PETSC_ERR_MEM;
  }
  catch (const SolveError&)
  {
    error = PETSC_ERR_LIB;
  }
  PetscCall(VecRestoreArrayWrite(y, &out));
  PetscCall(VecRestoreArrayRead(x, &in));
  PetscFunctionReturn(error);
}

/// The product that a matrix had, or that of its own columns where others are with other processes.
struct Exact
{
  Mat a;
  Mat own;
  PetscErrorCode (*product)(Mat, Vec, Vec);
};

PetscErrorCode multiply_exactly(Mat shell, Vec x, Vec y)
{
  PetscFunctionBegin;
  Exact* exact = nullptr;
  PetscCall(MatShellGetContext(shell, &exact));
  PetscCall(MatSetOperation(exact->own, MATOP_MULT, reinterpret_cast<void (*)()>(exact->product)));
  const PetscErrorCode error = MatMult(exact->a, x, y);
  PetscCall(MatSetOperation(exact->own, MATOP_MULT, reinterpret_cast<void (*)()>(multiply_single)));
  PetscFunctionReturn(error);
}

PetscErrorCode destroy_exact(Mat shell)
{
  PetscFunctionBegin;
  Exact* exact = nullptr;
  PetscCall(MatShellGetContext(shell, &exact));
  delete exact;  // NOLINT(cppcoreguidelines-owning-memory)
  PetscFunctionReturn(0);
}

}  // namespace

void multiply_in_single(Mat a)
{
  const Mat own = local_blocks(a).own;
  blocks_of(own).set_stale();
  check(MatSetOperation(own, MATOP_MULT, reinterpret_cast<void (*)()>(multiply_single)), making);
}

SingleProduct::SingleProduct(Mat a) : own_(local_blocks(a).own)
{
  check(MatGetOperation(own_, MATOP_MULT, &product_), making);
  PetscInt n = 0;
  MPI_Comm processes = MPI_COMM_NULL;
  check(MatGetLocalSize(a, &n, nullptr), making);
  check(PetscObjectGetComm(reinterpret_cast<PetscObject>(a), &processes), making);
  auto context =
      std::make_unique<Exact>(Exact{a, own_, reinterpret_cast<PetscErrorCode (*)(Mat, Vec, Vec)>(product_)});
  Mat shell = nullptr;
  check(MatCreateShell(processes, n, n, PETSC_DETERMINE, PETSC_DETERMINE, context.get(), &shell), making);
  exact_.reset(shell);
  check(MatShellSetOperation(shell, MATOP_DESTROY, reinterpret_cast<void (*)()>(destroy_exact)), making);
  (void)context.release();  // the shell has it
  check(MatShellSetOperation(shell, MATOP_MULT, reinterpret_cast<void (*)()>(multiply_exactly)), making);
  multiply_in_single(a);
}

SingleProduct::~SingleProduct()
{
  MatSetOperation(own_, MATOP_MULT, product_);
}

}  // namespace tribound::algebra::detail
