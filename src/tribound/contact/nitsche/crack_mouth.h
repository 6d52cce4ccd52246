#pragma once

/// @file crack_mouth.h
/// Where the opening of a crack in the base of a hydraulic structure is measured (method section 12.6).

#include <algorithm>
#include <vector>

#include "tribound/contact/nitsche/nitsche.h"

namespace tribound::contact
{

/// The contact points nearest to the heel: one or, by symmetry, several; none if nothing lies opposite.
struct CrackMouth
{
  std::vector<std::size_t> points;  ///< numbers of the points, including those of ghosts
  double n = 0;                     ///< number of points over all ranks, each counted once
};

/// For the interface whose slave has boundary number `tag`, which has a Contact::base. All ranks together.
template <int dim>
[[nodiscard]] CrackMouth crack_mouth(const NitscheForm<dim>& form, int tag);

/// The mean over the mouth of value(i), with i the number of a contact point; 0 if there are no points. All
/// ranks together; each gets it.
template <int dim, class Value>
[[nodiscard]] double mean_at(const CrackMouth& mouth, const NitscheForm<dim>& form, const Value& value)
{
  double sum = 0;
  for (const std::size_t i : mouth.points)
    if (i < form.n_owned_contact_points()) sum += value(i);
  return form.space().mesh().ranks().sum(sum) / std::max(mouth.n, 1.0);
}

}  // namespace tribound::contact
