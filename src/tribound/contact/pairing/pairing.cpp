#include "tribound/contact/pairing/pairing.h"

#include <algorithm>

#include "tribound/contact/pairing/slave_facet.h"

namespace tribound::contact
{

template <int dim>
std::vector<FacetPair<dim>> overlay(const mesh::Mesh<dim>& mesh, std::span<const std::size_t> slave,
                                    std::span<const std::size_t> master, const problem::Pairing<dim>& pairing,
                                    const Where& where)
{
  const MasterFacets<dim> masters(facet_shapes(mesh, master));
  const auto is_near = [&](std::size_t number)
  {
    return std::ranges::any_of(mesh.cell(mesh.boundary()[number].cell),
                               [&](Index v) { return mesh.has_patch(v); });
  };
  const bool is_shared = mesh.ranks().size() > 1;
  std::vector<FacetPair<dim>> pairs;
  for (const std::size_t number : slave)
  {
    const FacetShape<dim> shape(mesh, number);
    SlaveFacet<dim> facet(shape, pairing, where);
    masters.add_to(facet);
    if (is_shared && !is_near(number) &&
        std::ranges::none_of(facet.candidates(), [&](const auto& found) { return is_near(found.master); }))
      continue;
    facet.append_pairs(pairs);
  }
  return pairs;
}

template std::vector<FacetPair<2>> overlay(const mesh::Mesh<2>&, std::span<const std::size_t>,
                                           std::span<const std::size_t>, const problem::Pairing<2>&,
                                           const Where&);
template std::vector<FacetPair<3>> overlay(const mesh::Mesh<3>&, std::span<const std::size_t>,
                                           std::span<const std::size_t>, const problem::Pairing<3>&,
                                           const Where&);

}  // namespace tribound::contact
