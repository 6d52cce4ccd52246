#pragma once

/// @file groups.h
/// Sets that overlap, cut into parts that do not.

#include <string>
#include <utility>
#include <vector>

#include "tribound/base/types.h"

namespace tribound::case_file
{

/// Sets of facets, or of cells, by name. Sets with the same members are one, by its first name.
class Groups
{
 public:
  /// The members ascend. Returns the number of the group.
  int add(const std::string& name, std::vector<Index> members);

  [[nodiscard]] std::size_t size() const { return groups_.size(); }
  [[nodiscard]] const std::string& name(int group) const { return groups_[group].name; }
  [[nodiscard]] const std::vector<Index>& members(int group) const { return groups_[group].members; }

  /// Members of the same groups, and of no other.
  struct Part
  {
    std::string name;  ///< that of its first group, joined by those of the others where this is not enough
    std::vector<int> groups{};
    std::vector<Index> members{};

    [[nodiscard]] bool is_in(int group) const;
  };
  [[nodiscard]] std::vector<Part> parts() const;

 private:
  struct Group
  {
    std::string name;
    std::vector<Index> members;
  };

  std::vector<Group> groups_{};
};

}  // namespace tribound::case_file
