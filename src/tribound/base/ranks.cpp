#include "tribound/base/ranks.h"

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <new>
#include <numeric>
#include <string>
#include <thread>

#include "tribound/base/clock.h"
#include "tribound/base/error.h"

namespace tribound
{

struct Ranks::Communicator
{
  Communicator()
  {
    MPI_Comm_dup(MPI_COMM_WORLD, &handle);
    MPI_Comm_dup(MPI_COMM_WORLD, &ending);
    MPI_Comm_split_type(handle, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  }
  ~Communicator()
  {
    int is_over = 0;
    MPI_Finalized(&is_over);
    if (is_over != 0) return;
    MPI_Comm_free(&machine);
    MPI_Comm_free(&ending);
    MPI_Comm_free(&handle);
  }
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;

  MPI_Comm handle = MPI_COMM_NULL;
  MPI_Comm ending = MPI_COMM_NULL;   ///< for all_arrive()
  MPI_Comm machine = MPI_COMM_NULL;  ///< of the ranks on the same machine
};

namespace
{

/// MPI counts in int.
constexpr std::size_t largest_message = std::size_t{1} << 30;

enum class Kind : char
{
  none,
  input,
  solve,
  memory,
  other
};

/// A serialised exception: its kind and its texts, each terminated by a 0.
class Report
{
 public:
  explicit Report(const std::exception_ptr& failure)
  {
    try
    {
      if (failure) std::rethrow_exception(failure);
    }
    catch (const InputError& error)
    {
      kind_ = Kind::input;
      const Where& where = error.where();
      add(where.file);
      add(where.key);
      add(std::to_string(where.line));
      add(std::to_string(where.column));
      add(error.problem());
      add(error.hint());
    }
    catch (const SolveError& error)
    {
      kind_ = Kind::solve;
      add(error.what());
    }
    catch (const std::bad_alloc&)
    {
      kind_ = Kind::memory;
    }
    catch (const std::exception& error)
    {
      kind_ = Kind::other;
      add(error.what());
    }
    catch (...)
    {
      kind_ = Kind::other;
      add("something unknown failed");
    }
  }

  [[nodiscard]] Kind kind() const { return kind_; }
  [[nodiscard]] std::vector<char>& bytes() { return bytes_; }

  /// Throws what rank `from` has thrown.
  [[noreturn]] void rethrow(Kind kind, int from) const
  {
    const std::string who = "process " + std::to_string(from) + ": ";
    const char* next = bytes_.data();
    const auto take = [&next]
    {
      std::string text = next;
      next += text.size() + 1;
      return text;
    };
    if (kind == Kind::memory) throw std::bad_alloc();
    if (kind == Kind::solve) throw SolveError(who + take());
    if (kind == Kind::other) throw std::runtime_error(who + take());
    Where where{take(), take(), 0, 0};
    where.line = std::stoi(take());
    where.column = std::stoi(take());
    std::string problem = take();
    throw InputError(std::move(where), who + problem, take());
  }

 private:
  void add(const std::string& text)
  {
    bytes_.insert(bytes_.end(), text.c_str(), text.c_str() + text.size() + 1);
  }

  Kind kind_ = Kind::none;
  std::vector<char> bytes_;
};

}  // namespace

Ranks Ranks::world()
{
  Ranks ranks;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks.size_);
  MPI_Comm_rank(MPI_COMM_WORLD, &ranks.rank_);
  if (ranks.size_ > 1) ranks.communicator_ = std::make_shared<const Communicator>();
  return ranks;
}

void Ranks::sum(std::span<double> x) const
{
  if (size_ == 1) return;
  const int n = static_cast<int>(x.size());
  std::vector<double> all(x.size() * size_);
  MPI_Allgather(x.data(), n, MPI_DOUBLE, all.data(), n, MPI_DOUBLE, communicator_->handle);
  std::ranges::fill(x, 0.0);
  for (std::size_t i = 0; i < all.size(); ++i) x[i % x.size()] += all[i];
}

double Ranks::sum(double x) const
{
  sum(std::span(&x, 1));
  return x;
}

void Ranks::sum(std::span<std::int64_t> x) const
{
  if (size_ > 1)
    MPI_Allreduce(MPI_IN_PLACE, x.data(), static_cast<int>(x.size()), MPI_INT64_T, MPI_SUM,
                  communicator_->handle);
}

std::int64_t Ranks::sum(std::int64_t x) const
{
  sum(std::span(&x, 1));
  return x;
}

std::int64_t Ranks::before(std::int64_t x) const
{
  std::int64_t sum = 0;
  if (size_ > 1) MPI_Exscan(&x, &sum, 1, MPI_INT64_T, MPI_SUM, communicator_->handle);
  return is_first() ? 0 : sum;
}

void Ranks::max(std::span<double> x) const
{
  if (size_ > 1)
    MPI_Allreduce(MPI_IN_PLACE, x.data(), static_cast<int>(x.size()), MPI_DOUBLE, MPI_MAX,
                  communicator_->handle);
}

double Ranks::max(double x) const
{
  if (size_ > 1) MPI_Allreduce(MPI_IN_PLACE, &x, 1, MPI_DOUBLE, MPI_MAX, communicator_->handle);
  return x;
}

double Ranks::sum_on_machine(double x) const
{
  if (size_ > 1) MPI_Allreduce(MPI_IN_PLACE, &x, 1, MPI_DOUBLE, MPI_SUM, communicator_->machine);
  return x;
}

bool Ranks::any(bool x) const
{
  int result = x ? 1 : 0;
  if (size_ > 1) MPI_Allreduce(MPI_IN_PLACE, &result, 1, MPI_INT, MPI_MAX, communicator_->handle);
  return result != 0;
}

bool Ranks::first_says(bool x) const
{
  int result = x ? 1 : 0;
  if (size_ > 1) MPI_Bcast(&result, 1, MPI_INT, 0, communicator_->handle);
  return result != 0;
}

void Ranks::send_bytes(std::span<const std::span<const std::byte>> out, const Receiver& receiver) const
{
  std::vector<std::int64_t> n_out;
  for (const auto& parcel : out) n_out.push_back(static_cast<std::int64_t>(parcel.size()));
  std::vector<std::int64_t> n_in(size_);
  MPI_Alltoall(n_out.data(), 1, MPI_INT64_T, n_in.data(), 1, MPI_INT64_T, communicator_->handle);
  std::vector<Incoming> incoming;
  std::vector<Outgoing> outgoing;
  for (int r = 0; r < size_; ++r)
  {
    incoming.push_back({r, receiver(r, n_in[r])});
    outgoing.push_back({r, out[r]});
  }
  transfer(outgoing, incoming);
}

void Ranks::transfer(std::span<const Outgoing> out, std::span<const Incoming> in) const
{
  std::vector<MPI_Request> requests;
  const auto in_messages = [](auto bytes, const auto& each)
  {
    for (; !bytes.empty(); bytes = bytes.subspan(std::min(bytes.size(), largest_message)))
      each(bytes.data(), static_cast<int>(std::min(bytes.size(), largest_message)));
  };
  for (const auto& [rank, bytes] : in)
    in_messages(bytes, [&, r = rank](std::byte* data, int n)
                { MPI_Irecv(data, n, MPI_BYTE, r, 0, communicator_->handle, &requests.emplace_back()); });
  for (const auto& [rank, bytes] : out)
    in_messages(bytes, [&, r = rank](const std::byte* data, int n)
                { MPI_Isend(data, n, MPI_BYTE, r, 0, communicator_->handle, &requests.emplace_back()); });
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

void Ranks::copy_from(int root, std::vector<char>& bytes) const
{
  auto n = static_cast<std::int64_t>(bytes.size());
  MPI_Bcast(&n, 1, MPI_INT64_T, root, communicator_->handle);
  bytes.resize(n);
  for (std::span<char> rest = bytes; !rest.empty();)
  {
    const std::span<char> message = rest.first(std::min(rest.size(), largest_message));
    MPI_Bcast(message.data(), static_cast<int>(message.size()), MPI_BYTE, root, communicator_->handle);
    rest = rest.subspan(message.size());
  }
}

void Ranks::copy_from_first(std::vector<char>& bytes) const
{
  if (size_ > 1) copy_from(0, bytes);
}

void Ranks::agree(const std::exception_ptr& failure) const
{
  if (size_ > 1)
  {
    Report report(failure);
    std::vector<Kind> kinds(size_, report.kind());
    const Kind own = report.kind();
    MPI_Allgather(&own, 1, MPI_CHAR, kinds.data(), 1, MPI_CHAR, communicator_->handle);
    const auto failed = std::ranges::find_if(kinds, [](Kind kind) { return kind != Kind::none; });
    if (failed == kinds.end()) return;
    const int from = static_cast<int>(failed - kinds.begin());
    copy_from(from, report.bytes());
    if (!failure) report.rethrow(*failed, from);
  }
  if (failure) std::rethrow_exception(failure);
}

const void* Ranks::mpi_communicator() const
{
  return size_ > 1 ? &communicator_->handle : nullptr;
}

bool Ranks::all_arrive(double seconds) const
{
  if (size_ == 1) return true;
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibarrier(communicator_->ending, &request);
  const Clock::time_point begin = Clock::now();
  int is_done = 0;
  while (true)
  {
    MPI_Test(&request, &is_done, MPI_STATUS_IGNORE);
    if (is_done != 0 || seconds_since(begin) > seconds) return is_done != 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

void Ranks::end_all(int exit_code)
{
  MPI_Abort(MPI_COMM_WORLD, exit_code);
  std::_Exit(exit_code);
}

}  // namespace tribound
