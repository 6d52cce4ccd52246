#include "tribound/mesh/shared_vertices.h"

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace tribound::mesh
{

template <int dim>
SharedVertices<dim>::SharedVertices(const Partition<dim>& partition, std::span<const TwinFacets<dim>> twins)
    : ranks_(partition.ranks), names_(partition.vertices)
{
  for (Index v = 0; v < static_cast<Index>(names_.size()); ++v)
  {
    const std::span<const int> others = partition.sharers_of(v);
    if (others.empty()) continue;
    sharers_[v].assign(others.begin(), others.end());
    shared_[names_[v]] = v;
  }
  for (const TwinFacets<dim>& pair : twins)
    for (int which = 0; which < 2; ++which)
      for (const Index v : pair.vertices[which])
      {
        shared_[names_[v]] = v;
        const Index ghost = pair.cells[which] - partition.n_owned_cells;
        if (ghost < 0) continue;
        std::vector<int>& ranks = sharers_[v];
        const auto place = std::ranges::lower_bound(ranks, partition.ghost_owners[ghost]);
        if (place == ranks.end() || *place != partition.ghost_owners[ghost])
          ranks.insert(place, partition.ghost_owners[ghost]);
      }
}

template <int dim>
std::span<const int> SharedVertices<dim>::sharers_of(Index v) const
{
  const auto found = sharers_.find(v);
  return found == sharers_.end() ? std::span<const int>{} : found->second;
}

template <int dim>
void SharedVertices<dim>::add_middle(Index a, Index b, bool is_news)
{
  const auto m = static_cast<Index>(names_.size());
  names_.push_back(middle(names_[a], names_[b]));
  std::vector<int> both;
  std::ranges::set_intersection(sharers_of(a), sharers_of(b), std::back_inserter(both));
  if (shared_.contains(names_[a]) && shared_.contains(names_[b])) shared_[names_[m]] = m;
  if (both.empty()) return;
  sharers_[m] = std::move(both);
  if (is_news) news_.push_back({a, b, m});
}

template <int dim>
bool SharedVertices<dim>::exchange(const std::function<void(Index, Index)>& halve)
{
  using Edge = std::array<VertexName<dim>, 2>;
  if (!ranks_.any(!news_.empty())) return false;
  std::vector<std::vector<Edge>> out(ranks_.size());
  for (const auto& [a, b, m] : news_)
    for (const int rank : sharers_of(m)) out[rank].push_back({names_[a], names_[b]});
  news_.clear();
  for (const std::vector<Edge>& edges : ranks_.send(out))
    for (const auto& [a, b] : edges) halve(shared_.at(a), shared_.at(b));
  return true;
}

template class SharedVertices<2>;
template class SharedVertices<3>;

}  // namespace tribound::mesh
