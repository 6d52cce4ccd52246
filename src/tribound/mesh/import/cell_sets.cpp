#include "tribound/mesh/import/cell_sets.h"

#include <fmt/format.h>

#include <algorithm>

namespace tribound::mesh
{

std::vector<Index> set_of_cells(const ImportedMesh& mesh)
{
  std::size_t n = 0;
  for (const ElementBlock& block : mesh.cells) n += block.size();
  std::vector<Index> result(n, -1);
  for (std::size_t s = 0; s < mesh.cell_sets.size(); ++s)
    for (const Index cell : mesh.cell_sets[s].cells) result[cell] = static_cast<Index>(s);
  return result;
}

std::int64_t number_of_cell(const ImportedMesh& mesh, Index cell)
{
  auto block = mesh.cells.begin();
  for (; static_cast<std::size_t>(cell) >= block->size(); ++block) cell -= static_cast<Index>(block->size());
  return block->numbers[cell];
}

bool are_disjoint(std::span<const CellSet> sets, std::size_t n)
{
  std::vector<char> is_taken(n, 0);
  return std::ranges::all_of(
      sets, [&](const CellSet& set)
      { return std::ranges::all_of(set.cells, [&](Index c) { return is_taken[c]++ == 0; }); });
}

std::vector<CellSet> partition_of(std::vector<CellSet> sets, std::size_t n)
{
  const auto has_all = [n](const CellSet& set) { return set.cells.size() == n; };
  std::erase_if(sets, [](const CellSet& set) { return set.cells.empty(); });
  if (!std::ranges::all_of(sets, has_all)) std::erase_if(sets, has_all);
  std::size_t n_members = 0;
  for (const CellSet& set : sets) n_members += set.cells.size();
  return n_members == n && are_disjoint(sets, n) ? sets : std::vector<CellSet>{};
}

std::string fault_of_partition(std::span<const CellSet> sets, std::size_t n,
                               const std::function<std::int64_t(Index)>& number)
{
  std::vector<const CellSet*> set_of(n, nullptr);
  for (const CellSet& set : sets)
    for (const Index cell : set.cells)
    {
      if (set_of[cell])
        return fmt::format("element {} is in \"{}\" and in \"{}\"", number(cell), set_of[cell]->name,
                           set.name);
      set_of[cell] = &set;
    }
  const auto none = std::ranges::find(set_of, nullptr);
  return none == set_of.end()
             ? ""
             : fmt::format("element {} is in no set", number(static_cast<Index>(none - set_of.begin())));
}

}  // namespace tribound::mesh
