#include "tribound/case/group_reader.h"

#include <algorithm>
#include <utility>

#include "tribound/case/table_reader.h"

namespace tribound::case_file
{

namespace
{

const Table& group_table()
{
  static const Table table{.name = "group", .keys = group_keys()};
  return table;
}

void add_group(const Entry& entry, bool is_region, std::vector<mesh::FormulaGroup>& groups)
{
  const auto& keys = std::get<Node::Table>(entry.node.value);
  const Entry* condition = find(keys, "where");
  const Entry* of = find(keys, "of");
  if (condition == nullptr && of == nullptr) return;
  if (condition == nullptr)
    throw InputError(of->node.where, "says of what, but not where", "where = \"y < 1e-6\"");
  mesh::FormulaGroup& group = groups.emplace_back();
  group.name = entry.name;
  group.condition = to_text(condition->node);
  group.where = condition->node.where;
  group.is_region = is_region;
  check_condition(group);
  const auto value = [](std::string_view name) -> const Value&
  { return std::ranges::find(group_table().keys, name, &Key::name)->value; };
  if (of != nullptr) convert(of->node, value("of"), group.of);
}

}  // namespace

std::vector<Key> group_keys()
{
  constexpr auto hint = "a group of the mesh, or an array of them: \"outer\"";
  return {{"where", formula()}, {"of", array_of(text({}, 1), 1, hint) | text()}};
}

bool gives_only_a_group(const Node& node)
{
  const auto* table = std::get_if<Node::Table>(&node.value);
  return table != nullptr && !table->empty() &&
         std::ranges::all_of(*table, [](const Entry& entry)
                             { return std::ranges::count(group_keys(), entry.name, &Key::name) > 0; });
}

std::vector<mesh::FormulaGroup> read_groups(const Node* boundaries, const Node& materials)
{
  std::vector<mesh::FormulaGroup> groups;
  for (const auto& [node, is_region] : {std::pair(boundaries, false), {&materials, true}})
    if (const auto* table = node == nullptr ? nullptr : std::get_if<Node::Table>(&node->value))
      for (const Entry& entry : *table)
        if (entry.node.is_table()) add_group(entry, is_region, groups);
  return groups;
}

}  // namespace tribound::case_file
