#include "tribound/algebra/single_product.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
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
constexpr const char* key = "tribound_single";  // under which the blocks are kept with the matrix

/// 1 / x, or 0 for an x below the smallest normal number.
double inverse_of(double x)
{
  return x >= std::numeric_limits<double>::min() ? 1 / x : 0;
}

/// Rows and columns of a sparse matrix with their values.
struct Rows
{
  explicit Rows(Mat a)
  {
    check(MatGetSize(a, &n, &n_columns), making);
    check(MatSeqAIJGetCSRAndMemType(a, &begin, &columns, &entries, nullptr), making);
  }

  PetscInt n = 0;
  PetscInt n_columns = 0;
  const PetscInt* begin = nullptr;
  const PetscInt* columns = nullptr;
  PetscScalar* entries = nullptr;

  /// That of a row with x.
  [[nodiscard]] double product(PetscInt row, std::span<const double> x) const
  {
    double sum = 0;
    for (PetscInt k = begin[row]; k < begin[row + 1]; ++k) sum += entries[k] * x[columns[k]];
    return sum;
  }
};

/// The blocks of A that have entries; A / scale in these as floats, block row by block row, column by column
/// in a block.
class Blocks
{
 public:
  explicit Blocks(Mat a)
  {
    PetscInt rows = 1;
    PetscInt columns = 1;
    check(MatGetBlockSizes(a, &rows, &columns), making);
    height_ = divisor(rows);
    width_ = divisor(columns);
  }

  /// The matrix has changed.
  void set_stale() { is_stale_ = true; }

  /// y = A x, or z + A x if z is given; z may be y.
  void multiply(Mat a, std::span<const double> x, std::span<const double> z, std::span<double> y)
  {
    update(a);
    const double largest = Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()))
                               .lpNorm<Eigen::Infinity>();
    const double inverse = inverse_of(largest);
    std::ranges::transform(x, x_.begin(), [=](double value) { return static_cast<float>(inverse * value); });
    switch (width_)
    {
      case 3:
        return multiply_blocks<3>(scale_ * largest, z, y);
      case 2:
        return multiply_blocks<2>(scale_ * largest, z, y);
      default:
        return multiply_blocks<1>(scale_ * largest, z, y);
    }
  }

  /// Whether multiply_exactly() is there.
  [[nodiscard]] bool are_of_nodes() const { return height_ == n_components && width_ == n_components; }

  /// y = A x in double precision. Where a block is whole, one index serves its nine entries, and the sums of
  /// its columns need not wait for each other. Fourth lanes are those of the next block, and not used.
  void multiply_exactly(Mat a, std::span<const double> x, std::span<double> y)
  {
    using Lanes4 = Eigen::Vector4d;
    constexpr int n = n_components;
    const Rows rows(a);
    find_blocks(a, rows);
    padded_.assign(x.begin(), x.end());
    padded_.push_back(0);
    for_each_row(
        [&](PetscInt i)
        {
          const bool is_last = n * (i + 1) == rows.n;  // nothing follows it in memory
          const PetscInt n_entries = rows.begin[n * (i + 1)] - rows.begin[n * i];
          if (is_last || n_entries != n * n * (begin_[i + 1] - begin_[i]))
          {
            for (PetscInt r = n * i; r < n * (i + 1); ++r) y[r] = rows.product(r, x);
            return;
          }
          std::array<Lanes4, n> sums;
          sums.fill(Lanes4::Zero());
          const double* entries = rows.entries + rows.begin[n * i];
          for (PetscInt k = begin_[i]; k < begin_[i + 1]; ++k, entries += n)
          {
            const Eigen::Map<const Lanes4> of_node(padded_.data() + std::size_t(n) * columns_[k]);
            for (int r = 0; r < n; ++r)
              sums[r] += Eigen::Map<const Lanes4>(entries + r * (n_entries / n)).cwiseProduct(of_node);
          }
          for (int r = 0; r < n; ++r) y[n * i + r] = sums[r].head<n>().sum();
        });
  }

 private:
  static constexpr int n_components = 3;
  static int divisor(PetscInt size) { return size % 3 == 0 ? 3 : size % 2 == 0 ? 2 : 1; }

  /// work(i) for every block row.
  template <class Work>
  void for_each_row(const Work& work) const
  {
    constexpr PetscInt worth_threads = 5'000;
    const auto n = static_cast<PetscInt>(begin_.size()) - 1;
    const int n_threads = n < worth_threads ? 1 : max_threads();
#pragma omp parallel for schedule(static) num_threads(n_threads)
    for (PetscInt i = 0; i < n; ++i) work(i);
  }

  void update(Mat a)
  {
    if (!is_stale_) return;
    const Rows rows(a);
    find_blocks(a, rows);
    fill(rows);
    is_stale_ = false;
  }

  /// The blocks with an entry, unless they are known.
  void find_blocks(Mat a, const Rows& rows)
  {
    PetscObjectState pattern = 0;
    check(MatGetNonzeroState(a, &pattern), making);
    if (pattern == pattern_) return;
    const PetscInt n = rows.n / height_;
    begin_.assign(1, 0);
    columns_.clear();
    x_.resize(rows.n_columns);
    std::vector<PetscInt> seen(rows.n_columns / width_, -1);
    for (PetscInt i = 0; i < n; ++i)
    {
      for (PetscInt k = rows.begin[i * height_]; k < rows.begin[(i + 1) * height_]; ++k)
      {
        const PetscInt j = rows.columns[k] / width_;
        if (seen[j] != i) columns_.push_back(j);
        seen[j] = i;
      }
      std::sort(columns_.begin() + begin_.back(), columns_.end());
      begin_.push_back(static_cast<PetscInt>(columns_.size()));
    }
    place_.resize(rows.n_columns / width_);
    pattern_ = pattern;
    is_stale_ = true;
  }

  void fill(const Rows& rows)
  {
    scale_ = Eigen::Map<const Eigen::VectorXd>(rows.entries, rows.begin[rows.n]).lpNorm<Eigen::Infinity>();
    const double inverse = inverse_of(scale_);
    const std::size_t block = std::size_t(height_) * width_;
    entries_.assign(block * columns_.size() + Lanes::SizeAtCompileTime, 0.0F);
    for (std::size_t i = 0; i + 1 < begin_.size(); ++i)
    {
      for (PetscInt k = begin_[i]; k < begin_[i + 1]; ++k) place_[columns_[k]] = k;
      for (int r = 0; r < height_; ++r)
        for (PetscInt k = rows.begin[i * height_ + r]; k < rows.begin[i * height_ + r + 1]; ++k)
        {
          const PetscInt column = rows.columns[k];
          entries_[block * place_[column / width_] + column % width_ * height_ + r] =
              static_cast<float>(inverse * rows.entries[k]);
        }
    }
  }

  template <int width>
  void multiply_blocks(double factor, std::span<const double> z, std::span<double> y) const
  {
    const std::size_t height = height_;
    for_each_row(
        [&](PetscInt i)
        {
          std::array<Lanes, width> sums;  // one per column: additions need not wait for each other
          sums.fill(Lanes::Zero());
          for (PetscInt k = begin_[i]; k < begin_[i + 1]; ++k)
          {
            const float* block = entries_.data() + height * width * k;
            const float* x = x_.data() + std::size_t(width) * columns_[k];
            for (int c = 0; c < width; ++c) sums[c] += x[c] * Eigen::Map<const Lanes>(block + height * c);
          }
          for (int c = 1; c < width; ++c) sums[0] += sums[c];
          for (std::size_t r = height * i; r < height * (i + 1); ++r)
            y[r] = (z.empty() ? 0 : z[r]) + factor * sums[0][static_cast<int>(r - height * i)];
        });
  }

  /// A column of a block, and what follows it in memory.
  using Lanes = Eigen::Vector4f;

  int height_ = 1;  ///< of a block
  int width_ = 1;
  double scale_ = 1;
  bool is_stale_ = true;
  PetscObjectState pattern_ = -1;  ///< of the matrix whose blocks these are
  std::vector<PetscInt> begin_;    ///< per block row
  std::vector<PetscInt> columns_;  ///< per block
  std::vector<float> entries_;     ///< with padding for Lanes
  std::vector<float> x_;           ///< working space
  std::vector<double> padded_;     ///< working space
  std::vector<PetscInt> place_;    ///< working space: of a block of the row, by its column
};

/// The blocks kept with the matrix.
Blocks& blocks_of(Mat a)
{
  if (auto* blocks = find_attached<Blocks>(a, key)) return *blocks;
  return attach(a, key, std::make_unique<Blocks>(a));
}

/// work(entries of x, z, y); z may be null, its entries then are, too.
template <class Work>
PetscErrorCode with_entries(Mat a, Vec x, Vec z, Vec y, const Work& work)
{
  PetscFunctionBegin;
  PetscInt n = 0;
  PetscInt n_columns = 0;
  const PetscScalar* in = nullptr;
  const PetscScalar* added = nullptr;
  PetscScalar* out = nullptr;
  PetscCall(MatGetSize(a, &n, &n_columns));
  PetscCall(VecGetArrayRead(x, &in));
  if (z && z != y) PetscCall(VecGetArrayRead(z, &added));
  PetscCall(VecGetArray(y, &out));
  PetscErrorCode error = 0;  // no exception may pass through PETSc
  try
  {
    const PetscScalar* begin = z == y ? out : added;
    work(std::span(in, n_columns), std::span(begin, begin ? n : 0), std::span(out, n));
  }
  catch (const std::bad_alloc&)
  {
    error = PETSC_ERR_MEM;
  }
  catch (const SolveError&)
  {
    error = PETSC_ERR_LIB;
  }
  PetscCall(VecRestoreArray(y, &out));
  if (added) PetscCall(VecRestoreArrayRead(z, &added));
  PetscCall(VecRestoreArrayRead(x, &in));
  PetscFunctionReturn(error);
}

/// y = A x, or z + A x.
PetscErrorCode multiply_and_add_single(Mat a, Vec x, Vec z, Vec y)
{
  return with_entries(a, x, z, y,
                      [a](const auto& in, const auto& added, const auto& out)
                      { blocks_of(a).multiply(a, in, added, out); });
}

PetscErrorCode multiply_single(Mat a, Vec x, Vec y)
{
  return multiply_and_add_single(a, x, nullptr, y);
}

PetscErrorCode multiply_double(Mat a, Vec x, Vec y)
{
  return with_entries(a, x, nullptr, y,
                      [a](const auto& in, const auto& /*added*/, const auto& out)
                      { blocks_of(a).multiply_exactly(a, in, out); });
}

/// The product of a matrix in double precision; on several processes, of its block of own columns.
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

void interpolate_in_single(Mat p)
{
  const Mat own = local_blocks(p).own;
  blocks_of(own).set_stale();
  check(MatSetOperation(own, MATOP_MULT_ADD, reinterpret_cast<void (*)()>(multiply_and_add_single)), making);
}

SingleProduct::SingleProduct(Mat a) : own_(local_blocks(a).own)
{
  check(MatGetOperation(own_, MATOP_MULT, &product_), making);
  PetscInt n = 0;
  MPI_Comm processes = MPI_COMM_NULL;
  check(MatGetLocalSize(a, &n, nullptr), making);
  check(PetscObjectGetComm(reinterpret_cast<PetscObject>(a), &processes), making);
  const auto original = reinterpret_cast<PetscErrorCode (*)(Mat, Vec, Vec)>(product_);
  auto context =
      std::make_unique<Exact>(Exact{a, own_, blocks_of(own_).are_of_nodes() ? multiply_double : original});
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
