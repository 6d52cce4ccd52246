#include "tribound/base/ghost_update.h"

#include <cstring>
#include <utility>

namespace tribound
{

void GhostUpdate::set_neighbours(std::vector<std::vector<Index>>& sent,
                                 std::vector<std::vector<Index>>& received)
{
  for (int r = 0; r < ranks_.size(); ++r)
  {
    if (!sent[r].empty()) to_.push_back({r, std::move(sent[r])});
    if (!received[r].empty()) from_.push_back({r, std::move(received[r])});
  }
}

void GhostUpdate::update(std::span<std::byte> values, std::size_t item_size) const
{
  std::size_t n_out = 0;
  std::size_t n_in = 0;
  for (const Neighbour& to : to_) n_out += to.items.size();
  for (const Neighbour& from : from_) n_in += from.items.size();
  if (n_out + n_in == 0) return;

  std::vector<std::byte> out_buffer(n_out * item_size);
  std::vector<std::byte> in_buffer(n_in * item_size);
  const auto item = [&](Index i) { return values.subspan(i * item_size, item_size).data(); };
  std::vector<Ranks::Outgoing> out;
  std::span<std::byte> rest = out_buffer;
  for (const auto& [rank, items] : to_)
  {
    const std::size_t n_bytes = items.size() * item_size;
    for (std::size_t k = 0; k < items.size(); ++k)
      std::memcpy(rest.data() + k * item_size, item(items[k]), item_size);
    out.push_back({rank, rest.first(n_bytes)});
    rest = rest.subspan(n_bytes);
  }
  std::vector<Ranks::Incoming> in;
  rest = in_buffer;
  for (const auto& [rank, items] : from_)
  {
    in.push_back({rank, rest.first(items.size() * item_size)});
    rest = rest.subspan(items.size() * item_size);
  }
  ranks_.transfer(out, in);

  const std::byte* next = in_buffer.data();
  for (const auto& [rank, items] : from_)
    for (const Index i : items)
    {
      std::memcpy(item(i), next, item_size);
      next += item_size;
    }
}

}  // namespace tribound
