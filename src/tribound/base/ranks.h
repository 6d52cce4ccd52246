#pragma once

/// @file ranks.h
/// The processes of one computation.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace tribound
{

/// The processes (ranks) that compute together. The members are collective: all ranks call them in the same
/// order. Whatever decides on a call must be the result of such a call or the same on all ranks. On one rank
/// each member is the identity.
class Ranks
{
 public:
  /// This process alone.
  Ranks() = default;
  /// All processes that were started together. MPI must be running, and must outlive this and its copies.
  [[nodiscard]] static Ranks world();

  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] bool is_first() const { return rank_ == 0; }

  /// Entrywise sums over the ranks, added in rank order: the same bits everywhere.
  void sum(std::span<double> x) const;
  [[nodiscard]] double sum(double x) const;
  void sum(std::span<std::int64_t> x) const;
  [[nodiscard]] std::int64_t sum(std::int64_t x) const;
  /// Sum over the ranks before this one.
  [[nodiscard]] std::int64_t before(std::int64_t x) const;
  /// Entrywise maxima over the ranks.
  void max(std::span<double> x) const;
  [[nodiscard]] double max(double x) const;
  /// Sum over the ranks on the same machine as this one.
  [[nodiscard]] double sum_on_machine(double x) const;
  [[nodiscard]] bool any(bool x) const;
  /// The value of the first rank, for what differs between ranks: clocks, memory and signals.
  [[nodiscard]] bool first_says(bool x) const;

  /// Sends out[r] to rank r (nothing is sent where it is empty); returns what came from each rank.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  [[nodiscard]] std::vector<std::vector<T>> send(const std::vector<std::vector<T>>& out) const
  {
    if (size_ == 1) return out;
    std::vector<std::span<const std::byte>> parcels;
    parcels.reserve(out.size());
    for (const std::vector<T>& items : out) parcels.push_back(std::as_bytes(std::span(items)));
    std::vector<std::vector<T>> in(size_);
    send_bytes(parcels,
               [&in](int r, std::size_t n_bytes)
               {
                 in[r].resize(n_bytes / sizeof(T));
                 return std::as_writable_bytes(std::span(in[r]));
               });
    return in;
  }

  /// Sends the k-th group of `n_each` items to rank rank_of[k]; returns what came, in rank order.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  [[nodiscard]] std::vector<T> send_to(std::span<const int> rank_of, std::span<const T> items,
                                       std::size_t n_each = 1) const
  {
    std::vector<std::vector<T>> out(size_);
    for (std::size_t k = 0; k < rank_of.size(); ++k)
    {
      const std::span<const T> block = items.subspan(k * n_each, n_each);
      out[rank_of[k]].insert(out[rank_of[k]].end(), block.begin(), block.end());
    }
    return joined(send(out));
  }

  struct Outgoing
  {
    int rank;
    std::span<const std::byte> bytes;
  };
  struct Incoming
  {
    int rank;
    std::span<std::byte> bytes;
  };
  /// Exchange between neighbours that know their partners and the sizes; no other rank takes part.
  void transfer(std::span<const Outgoing> out, std::span<const Incoming> in) const;

  /// The items of all ranks in rank order on the first rank; nothing elsewhere.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  [[nodiscard]] std::vector<T> gather(std::span<const T> items) const
  {
    if (size_ == 1) return {items.begin(), items.end()};
    std::vector<std::int64_t> sizes(size_, 0);
    sizes[rank_] = static_cast<std::int64_t>(items.size());
    sum(std::span(sizes));
    std::vector<T> all(is_first() ? std::reduce(sizes.begin(), sizes.end()) : 0);
    std::vector<Incoming> in;
    if (is_first())
      for (std::span<T> rest = all; const std::int64_t n : sizes)
      {
        in.push_back({static_cast<int>(in.size()), std::as_writable_bytes(rest.first(n))});
        rest = rest.subspan(n);
      }
    transfer(std::array{Outgoing{0, std::as_bytes(items)}}, in);
    return all;
  }

  /// Copies the items of the first rank to all ranks.
  void copy_from_first(std::vector<char>& bytes) const;
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void copy_from_first(std::vector<T>& items) const
  {
    if (size_ == 1) return;
    const auto chars = [&items]
    { return std::span(reinterpret_cast<char*>(items.data()), items.size() * sizeof(T)); };
    std::vector<char> bytes(chars().begin(), chars().end());
    copy_from_first(bytes);
    items.resize(bytes.size() / sizeof(T));
    std::ranges::copy(bytes, chars().begin());
  }

  /// work(). If it throws on some ranks, all ranks throw: those their own exceptions, the others that of the
  /// lowest rank that failed, with its number. For everything that may fail on a single rank.
  template <class Work>
  auto together(const Work& work) const
  {
    using Result = std::invoke_result_t<Work>;
    std::exception_ptr failure;
    if constexpr (std::is_void_v<Result>)
    {
      try
      {
        work();
      }
      catch (...)
      {
        failure = std::current_exception();
      }
      agree(failure);
    }
    else
    {
      std::optional<Result> result;
      try
      {
        result.emplace(work());
      }
      catch (...)
      {
        failure = std::current_exception();
      }
      agree(failure);
      return std::move(*result);
    }
  }

  /// Calls work() on the first rank alone and returns its result, plain data, on all ranks. If it throws, all
  /// ranks throw.
  template <class Work>
  auto on_first(const Work& work) const
  {
    using Result = std::invoke_result_t<Work>;
    if constexpr (std::is_void_v<Result>)
      together(
          [&]
          {
            if (is_first()) work();
          });
    else
    {
      static_assert(std::is_trivially_copyable_v<Result>);
      Result result{};
      together(
          [&]
          {
            if (is_first()) result = work();
          });
      std::vector<char> bytes(sizeof(Result));
      std::memcpy(bytes.data(), &result, sizeof(Result));
      copy_from_first(bytes);
      std::memcpy(&result, bytes.data(), sizeof(Result));
      return result;
    }
  }

  /// MPI's communicator, as const MPI_Comm*, for libraries that take one; null on one rank.
  [[nodiscard]] const void* mpi_communicator() const;

  /// For a rank that gives up: whether all ranks call this within `seconds`. If not, the others wait for this
  /// one somewhere else, for ever, unless it calls end_all().
  [[nodiscard]] bool all_arrive(double seconds) const;
  /// Ends the processes of all ranks with this exit code.
  [[noreturn]] static void end_all(int exit_code);

 private:
  struct Communicator;

  template <class T>
  static std::vector<T> joined(const std::vector<std::vector<T>>& parts)
  {
    std::size_t n = 0;
    for (const std::vector<T>& part : parts) n += part.size();
    std::vector<T> all;
    all.reserve(n);
    for (const std::vector<T>& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

  /// Provides the memory for what comes from a rank.
  using Receiver = std::function<std::span<std::byte>(int rank, std::size_t n_bytes)>;
  void send_bytes(std::span<const std::span<const std::byte>> out, const Receiver& receiver) const;
  void agree(const std::exception_ptr& failure) const;
  void copy_from(int root, std::vector<char>& bytes) const;

  std::shared_ptr<const Communicator> communicator_;  ///< null: one rank
  int rank_ = 0;
  int size_ = 1;
};

}  // namespace tribound
