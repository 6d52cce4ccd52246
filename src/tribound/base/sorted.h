#pragma once

/// @file sorted.h
/// Sorted lists without repetitions.

#include <algorithm>
#include <functional>
#include <vector>

namespace tribound
{

/// Sorts the items by their keys and keeps one of each key. Keys are compared by < and ==.
template <class Item, class Key = std::identity>
void sort_and_unite(std::vector<Item>& items, Key key = {})
{
  std::ranges::sort(items, {}, key);
  const auto is_same = [&](const Item& a, const Item& b)
  { return std::invoke(key, a) == std::invoke(key, b); };
  items.erase(std::unique(items.begin(), items.end(), is_same),  // clang 14 fails at std::ranges::unique
              items.end());
}

}  // namespace tribound
