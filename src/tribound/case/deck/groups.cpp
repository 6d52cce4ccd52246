#include "tribound/case/deck/groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

namespace tribound::case_file
{

int Groups::add(const std::string& name, std::vector<Index> members)
{
  const auto same = std::ranges::find(groups_, members, &Group::members);
  if (same != groups_.end()) return static_cast<int>(same - groups_.begin());
  groups_.push_back({name, std::move(members)});
  return static_cast<int>(groups_.size()) - 1;
}

bool Groups::Part::is_in(int group) const
{
  return std::ranges::binary_search(groups, group);
}

std::vector<Groups::Part> Groups::parts() const
{
  std::map<Index, std::vector<int>> groups_of;
  for (std::size_t g = 0; g < groups_.size(); ++g)
    for (const Index member : groups_[g].members) groups_of[member].push_back(static_cast<int>(g));
  std::map<std::vector<int>, std::vector<Index>> members_of;
  for (const auto& [member, groups] : groups_of) members_of[groups].push_back(member);

  std::vector<Part> result;
  std::set<std::string> names;
  for (auto& [groups, members] : members_of)
  {
    std::string name = groups_[groups[0]].name;
    for (std::size_t i = 1; i < groups.size() && names.contains(name); ++i)
      name += "+" + groups_[groups[i]].name;
    const std::string base = name;
    for (int n = 2; names.contains(name); ++n) name = fmt::format("{} {}", base, n);
    names.insert(name);
    result.push_back({std::move(name), groups, std::move(members)});
  }
  return result;
}

}  // namespace tribound::case_file
