#pragma once

/// @file repeated_patches.h
/// Factors that patches which are translates of each other share: most patches of a structured mesh.

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace tribound::certify
{

/// A patch by the number of its facets and its cells in their order: for each its shape, its facets and which
/// of them is the outer one. Patches with the same key have the same matrix. Empty: a patch that is not
/// compared.
using PatchKey = std::vector<std::uintptr_t>;

/// The factored matrices of patches that come twice. One object per thread.
template <class Matrix>
class RepeatedPatches
{
 public:
  /// Null where there is none.
  [[nodiscard]] const Matrix* find(const PatchKey& key) const
  {
    const auto found = factors_.find(key);
    return found == factors_.end() ? nullptr : &found->second;
  }

  /// Takes the factors if the patch came before and the memory allows it. Returns where they are then.
  const Matrix* keep(const PatchKey& key, Matrix& factors)
  {
    if (key.empty() || !came_before(key) || bytes_ + factors.bytes() > most_bytes) return &factors;
    factors.trim();
    bytes_ += factors.bytes();
    return &factors_.emplace(key, std::exchange(factors, {})).first->second;
  }

 private:
  static constexpr std::size_t most_bytes = std::size_t{64} << 20;
  static constexpr std::size_t table_size = 4096;  // a patch whose entry is overwritten is new again

  /// Remembers the patch.
  bool came_before(const PatchKey& key)
  {
    std::uint64_t hash = key.size();
    for (const std::uintptr_t word : key) hash = (hash ^ word) * 0x9e3779b97f4a7c15U ^ (hash >> 29);
    return std::exchange(last_[hash % table_size], hash) == hash;
  }

  std::map<PatchKey, Matrix> factors_;
  std::size_t bytes_ = 0;
  std::vector<std::uint64_t> last_ = std::vector<std::uint64_t>(table_size, 0);  ///< hashes
};

}  // namespace tribound::certify
