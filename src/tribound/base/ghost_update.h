#pragma once

/// @file ghost_update.h
/// Copies the values of items that several ranks have from their owners to the others.

#include <cassert>
#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "tribound/base/ranks.h"
#include "tribound/base/types.h"

namespace tribound
{

/// Items such as cells or nodes. A rank owns some, and has copies (ghosts) of some that other ranks own.
class GhostUpdate
{
 public:
  /// Without ghosts.
  GhostUpdate() = default;
  /// Local item ghosts[k] belongs to rank owners[k], where it has the local number find(keys[k]). All ranks
  /// call it together.
  template <class Key, class Find>
  GhostUpdate(const Ranks& ranks, std::span<const Index> ghosts, std::span<const int> owners,
              std::span<const Key> keys, const Find& find)
      : ranks_(ranks)
  {
    assert(ghosts.size() == owners.size() && ghosts.size() == keys.size());
    std::vector<std::vector<Key>> asked(ranks.size());
    std::vector<std::vector<Index>> received(ranks.size());
    for (std::size_t k = 0; k < ghosts.size(); ++k)
    {
      asked[owners[k]].push_back(keys[k]);
      received[owners[k]].push_back(ghosts[k]);
    }
    std::vector<std::vector<Index>> sent(ranks.size());
    const std::vector<std::vector<Key>> wanted = ranks.send(asked);
    for (int r = 0; r < ranks.size(); ++r)
      for (const Key& key : wanted[r]) sent[r].push_back(find(key));
    set_neighbours(sent, received);
  }

  /// Sets values[n_per_item * item + i] of every ghost to its owner's. The neighbours call it together.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void operator()(std::span<T> values, int n_per_item = 1) const
  {
    update(std::as_writable_bytes(values), sizeof(T) * n_per_item);
  }

 private:
  /// The items that go to or come from another rank.
  struct Neighbour
  {
    int rank;
    std::vector<Index> items;
  };

  void set_neighbours(std::vector<std::vector<Index>>& sent, std::vector<std::vector<Index>>& received);
  void update(std::span<std::byte> values, std::size_t item_size) const;

  Ranks ranks_;
  std::vector<Neighbour> to_;
  std::vector<Neighbour> from_;
};

}  // namespace tribound
