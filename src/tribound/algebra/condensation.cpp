#include "tribound/algebra/condensation.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <unordered_map>
#include <utility>

#include "tribound/algebra/petsc_detail.h"
// Must follow PETSc's other headers: it is not self-contained.
#include <petscblaslapack.h>

#include "tribound/algebra/dense.h"

namespace tribound::algebra
{

using detail::check;

namespace
{

/// A view of the Schur complement that MUMPS leaves, by columns; on one process only its lower half.
class SchurComplement
{
 public:
  explicit SchurComplement(Mat factors) : factors_(factors)
  {
    check(MatFactorGetSchurComplement(factors_, &schur_, &status_), "condensing a matrix");
    check(MatDenseGetArrayWrite(schur_, &entries_), "condensing a matrix");
  }
  ~SchurComplement()
  {
    MatDenseRestoreArrayWrite(schur_, &entries_);
    MatFactorRestoreSchurComplement(factors_, &schur_, status_);
  }
  SchurComplement(const SchurComplement&) = delete;
  SchurComplement& operator=(const SchurComplement&) = delete;

  [[nodiscard]] double* entries() const { return entries_; }

 private:
  Mat factors_;
  Mat schur_ = nullptr;
  MatFactorSchurStatus status_ = MAT_FACTOR_SCHUR_UNFACTORED;
  double* entries_ = nullptr;
};

/// On several processes MUMPS 5.5 leaves the upper half in place of the lower one.
void fill_lower_half(double* matrix, PetscBLASInt n)
{
  for (PetscBLASInt j = 0; j < n; ++j)
    for (PetscBLASInt i = j + 1; i < n; ++i) matrix[std::size_t(j) * n + i] = matrix[std::size_t(i) * n + j];
}

constexpr const char* not_positive = "the stiffness matrix is not positive definite";

}  // namespace

Condensation::Condensation(int dim, SparseRows k, std::vector<Index> layer, std::vector<Index> trace,
                           std::span<const double> b, Sharing sharing)
    : sharing_(std::move(sharing)), block_size_(dim), layer_(std::move(layer)), trace_(std::move(trace))
{
  if (sharing_) ranks_ = sharing_->ranks;
  find_places(static_cast<Index>(b.size()));
  couple(k);
  factorise(SparseMatrix(dim, std::move(k), sharing_), dim);
  condense();
  set_load(b);
}

/// The unknowns of each rank are in ascending order, one rank after the other.
void Condensation::find_places(Index n_unknowns)
{
  const auto number = [this](Index i)
  { return sharing_ ? detail::global_unknown(*sharing_, block_size_, i) : std::int64_t{i}; };
  const auto of_all = [&](std::span<const Index> own)
  {
    std::vector<std::int64_t> numbers;
    for (const Index i : own) numbers.push_back(number(i));
    numbers = ranks_.gather<std::int64_t>(numbers);
    ranks_.copy_from_first(numbers);
    return numbers;
  };
  all_kept_ = of_all(layer_);
  n_layer_ = all_kept_.size();
  const std::vector<std::int64_t> all_trace = of_all(trace_);
  n_trace_ = all_trace.size();
  all_kept_.insert(all_kept_.end(), all_trace.begin(), all_trace.end());
  std::unordered_map<std::int64_t, int> positions;
  for (std::size_t p = 0; p < all_kept_.size(); ++p) positions[all_kept_[p]] = static_cast<int>(p);
  position_.assign(n_unknowns, -1);
  for (Index i = 0; i < n_unknowns; ++i)
    if (const auto found = positions.find(number(i)); found != positions.end()) position_[i] = found->second;
}

bool Condensation::owns(Index unknown) const
{
  return !sharing_ || detail::is_owned(*sharing_, block_size_, unknown);
}

/// MUMPS keeps the Schur complement on the first rank.
void Condensation::factorise(const SparseMatrix& k, int dim)
{
  const detail::Options options(false, sharing_);
  factors_ = detail::start_cholesky(k, dim);
  std::vector<PetscInt> kept;
  if (ranks_.is_first()) kept.assign(all_kept_.begin(), all_kept_.end());
  IS rows = nullptr;
  check(ISCreateGeneral(detail::communicator(sharing_), static_cast<PetscInt>(kept.size()), kept.data(),
                        PETSC_USE_POINTER, &rows),
        "factorising");
  const PetscErrorCode error = MatFactorSetSchurIS(factors_.get(), rows);
  ISDestroy(&rows);
  check(error, "factorising");
  if (!detail::factorise_cholesky(k, factors_.get())) throw SolveError(not_positive);
}

void Condensation::couple(const SparseRows& k)
{
  for (int row = 0; row + 1 < static_cast<int>(k.begin.size()); ++row)
  {
    const Index i =
        sharing_ ? block_size_ * sharing_->owned[row / block_size_] + row % block_size_ : Index{row};
    if (position_[i] >= 0) continue;
    for (int e = k.begin[row]; e < k.begin[row + 1]; ++e)
      if (const int column = position_[k.columns[e]]; column >= 0)
        coupling_.push_back({i, column, k.values[e]});
  }
}

template <class Work>
std::vector<double> Condensation::by_first(const Work& work) const
{
  std::vector<double> result;
  ranks_.on_first([&] { result = work(); });
  ranks_.copy_from_first(result);
  return result;
}

/// `schur`: MUMPS's ICNTL(26), 0 to solve with the rest only, -1 with the Schur complement, too.
std::vector<std::vector<double>> Condensation::solve_sparse(std::span<const std::vector<double>> b,
                                                            int schur) const
{
  check(MatMumpsSetIcntl(factors_.get(), 26, schur), "solving a linear system");
  std::vector<std::vector<double>> x;
  if (sharing_ || b.size() == 1)
  {
    for (const std::vector<double>& one : b)
      detail::on_owned_entries(sharing_, block_size_, one, x.emplace_back(one.size()),
                               [&](Vec own_b, Vec own_x)
                               { check(MatSolve(factors_.get(), own_b, own_x), "solving a linear system"); });
    return x;
  }
  const auto rows = static_cast<PetscInt>(position_.size());
  const auto columns = static_cast<PetscInt>(b.size());
  const auto dense = [&](double* values)
  {
    Mat result = nullptr;
    check(MatCreateSeqDense(detail::communicator(), rows, columns, values, &result),
          "solving a linear system");
    return MatHandle(result);
  };
  const MatHandle all_b = dense(nullptr);
  const MatHandle all_x = dense(nullptr);
  double* values = nullptr;
  check(MatDenseGetArrayWrite(all_b.get(), &values), "solving a linear system");
  for (std::size_t k = 0; k < b.size(); ++k) std::ranges::copy(b[k], values + k * position_.size());
  check(MatDenseRestoreArrayWrite(all_b.get(), &values), "solving a linear system");
  check(MatMatSolve(factors_.get(), all_b.get(), all_x.get()), "solving a linear system");
  const double* found = nullptr;
  check(MatDenseGetArrayRead(all_x.get(), &found), "solving a linear system");
  for (std::size_t k = 0; k < b.size(); ++k)
    x.emplace_back(found + k * position_.size(), found + (k + 1) * position_.size());
  check(MatDenseRestoreArrayRead(all_x.get(), &found), "solving a linear system");
  return x;
}

std::vector<std::vector<double>> Condensation::solve_held(std::span<const std::vector<double>> b) const
{
  const auto has_forces = [](const std::vector<double>& forces)
  { return std::ranges::any_of(forces, [](double force) { return force != 0; }); };
  if (!ranks_.any(std::ranges::any_of(b, has_forces))) return {b.begin(), b.end()};
  std::vector<std::vector<double>> u = solve_sparse(b, 0);
  for (std::vector<double>& one : u)
    for (std::size_t i = 0; i < one.size(); ++i)
      if (position_[i] >= 0) one[i] = 0;
  return u;
}

/// PETSc factorises the Schur complement where MUMPS has left it, and solves with it between the two passes
/// through the sparse factors.
std::vector<std::vector<double>> Condensation::solve_whole(std::span<const std::vector<double>> b) const
{
  assert(n_layer_ == 0);  // else its factors are there
  return solve_sparse(b, -1);
}

/// With C_LL = L L^T and V = C_GL L^{-T}: S = C_GG - V V^T, W^T = V L^{-1}. L stays where MUMPS has left C.
void Condensation::condense()
{
  const auto n_layer = static_cast<PetscBLASInt>(n_layer_);
  const auto n_trace = static_cast<PetscBLASInt>(n_trace_);
  const PetscBLASInt n = n_layer + n_trace;
  ranks_.on_first(
      [&]
      {
        const SchurComplement schur(factors_.get());
        double* l = schur.entries();
        if (ranks_.size() > 1) fill_lower_half(l, n);
        PetscBLASInt info = 0;
        LAPACKpotrf_("L", &n_layer, l, &n, &info);
        if (info != 0) throw SolveError(not_positive);
        const auto lower = [&](PetscBLASInt column) { return l + std::size_t(column) * n + n_layer; };
        w_.reserve(n_trace_ * n_layer_);
        for (PetscBLASInt j = 0; j < n_layer; ++j) w_.insert(w_.end(), lower(j), lower(j) + n_trace);
        s_.reserve(n_trace_ * n_trace_);
        for (PetscBLASInt j = n_layer; j < n; ++j) s_.insert(s_.end(), lower(j), lower(j) + n_trace);
        const double one = 1;
        const double minus_one = -1;
        BLAStrsm_("R", "L", "T", "N", &n_trace, &n_layer, &one, l, &n, w_.data(), &n_trace);
        BLASsyrk_("L", "N", &n_trace, &n_layer, &minus_one, w_.data(), &n_trace, &one, s_.data(), &n_trace);
        BLAStrsm_("R", "L", "N", "N", &n_trace, &n_layer, &one, l, &n, w_.data(), &n_trace);
        for (std::size_t j = 0; j < n_trace_; ++j)
          for (std::size_t i = 0; i < j; ++i) s_[j * n_trace_ + i] = s_[i * n_trace_ + j];
      });
}

/// With the load c condensed onto layer and trace: u_0 = C_LL^{-1} c_L, g = c_G - W^T c_L.
void Condensation::set_load(std::span<const double> b)
{
  b_.assign(b.begin(), b.end());
  const std::vector<double> of_rest = solve_held({&b_, 1})[0];
  std::vector<double> c(all_kept_.size(), 0.0);
  for (const Entry& entry : coupling_) c[entry.column] -= entry.value * of_rest[entry.row];
  ranks_.sum(std::span(c));
  const std::vector<double> kept = on_layer_and_trace(b_);
  for (std::size_t i = 0; i < c.size(); ++i) c[i] += kept[i];

  const auto n_layer = static_cast<PetscBLASInt>(n_layer_);
  layer_load_ = by_first(
      [&]
      {
        const SchurComplement schur(factors_.get());
        const auto n = static_cast<PetscBLASInt>(n_layer_ + n_trace_);
        std::vector<double> u(c.begin(), c.begin() + n_layer);
        const PetscBLASInt columns = 1;
        PetscBLASInt info = 0;
        LAPACKpotrs_("L", &n_layer, &columns, schur.entries(), &n, u.data(), &n, &info);
        return u;
      });
  load_ = by_first(
      [&]
      {
        std::vector<double> g(c.begin() + n_layer, c.end());
        detail::add_product(-1, w_, n_trace_, n_layer_, false, std::span(c).first(n_layer_), g);
        return g;
      });
}

std::vector<double> Condensation::of_all(std::span<const Index> own, std::span<const double> values) const
{
  std::vector<double> result;
  result.reserve(own.size());
  for (const Index i : own) result.push_back(values[i]);
  result = ranks_.gather<double>(result);
  ranks_.copy_from_first(result);
  return result;
}

std::vector<double> Condensation::on_trace(std::span<const double> values) const
{
  return of_all(trace_, values);
}

std::vector<double> Condensation::on_layer_and_trace(std::span<const double> values) const
{
  std::vector<double> result = of_all(layer_, values);
  const std::vector<double> of_trace = of_all(trace_, values);
  result.insert(result.end(), of_trace.begin(), of_trace.end());
  return result;
}

std::vector<double> Condensation::multiply(std::span<const double> x) const
{
  return by_first(
      [&]
      {
        std::vector<double> y(n_trace_, 0.0);
        detail::add_product(1, s_, n_trace_, n_trace_, false, x, y);
        return y;
      });
}

std::vector<double> Condensation::near(std::span<const double> x) const
{
  std::vector<double> u = by_first(
      [&]
      {
        std::vector<double> layer = layer_load_;
        detail::add_product(-1, w_, n_trace_, n_layer_, true, x, layer);
        return layer;
      });
  u.insert(u.end(), x.begin(), x.end());
  return u;
}

void Condensation::put(std::span<const double> layer_and_trace, std::span<double> u) const
{
  for (std::size_t i = 0; i < u.size(); ++i)
    if (position_[i] >= 0) u[i] = layer_and_trace[position_[i]];
}

std::vector<double> Condensation::expand(std::span<const double> layer_and_trace,
                                         std::span<const double> b) const
{
  std::vector<double> forces(b.begin(), b.end());
  for (const Entry& entry : coupling_) forces[entry.row] -= entry.value * layer_and_trace[entry.column];
  std::vector<double> u = solve_held({&forces, 1})[0];
  put(layer_and_trace, u);
  return u;
}

/// Column i is row i of S + N_GG - N_GL W: its sums run over columns of W^T.
std::vector<double> Condensation::transposed_tangent(std::span<const Entry> n) const
{
  const auto n_trace = static_cast<PetscBLASInt>(n_trace_);
  const PetscBLASInt one = 1;
  std::vector<double> m = s_;
  for (const auto& [place, column, value] : n)
  {
    double* row = m.data() + (place - n_layer_) * n_trace_;
    const double a = -value;
    if (std::cmp_greater_equal(column, n_layer_))
      row[column - n_layer_] += value;
    else
      BLASaxpy_(&n_trace, &a, w_.data() + std::size_t(column) * n_trace_, &one, row, &one);
  }
  return m;
}

std::vector<double> Condensation::solve(const Triplets& n, std::span<const double> r, double tolerance) const
{
  std::vector<Entry> entries;
  for (std::size_t e = 0; e < n.rows.size(); ++e)
    if (n.rows[e] >= 0 && n.cols[e] >= 0 && owns(n.rows[e]))
      entries.push_back({position_[n.rows[e]], position_[n.cols[e]], n.values[e]});
  entries = ranks_.gather<Entry>(entries);
  return by_first([&] { return detail::solve_dense(transposed_tangent(entries), r, tolerance); });
}

}  // namespace tribound::algebra
