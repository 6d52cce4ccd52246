#include "tribound/case/interface_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "tribound/case/water_reader.h"

namespace tribound::case_file
{

namespace
{

using problem::Unloading;

using ReadLaw = problem::ContactLaw (*)(const TableReader& table);

void read_tension(const TableReader& table, problem::Tension& tension)
{
  table.read("tensile_strength", tension.strength,
             number_in(not_negative, "the largest tension that it holds, a stress, such as 0.3"));
  table.read("fracture_energy", tension.fracture_energy,
             number_in(not_negative, "the energy per area that breaking takes, such as 1e-4"));
  table.read("unloading", tension.unloading, one_of<Unloading>({"origin", "vertical"}));
}

void read_coefficient(const TableReader& table, double& coefficient)
{
  table.read("coefficient", coefficient, number_in(not_negative, "the friction coefficient, such as 0.6"));
}

problem::ContactLaw read_joint(const TableReader& table)
{
  problem::Joint joint;
  read_tension(table, joint.tension);
  table.read("cohesion", joint.cohesion,
             number_in(not_negative, "the shear stress beside friction that it holds, such as 0.7"));
  if (const Node* slip_length = table.find("slip_length"))
  {
    joint.slip_length =
        to_number_in(*slip_length, positive, "the slip on which cohesion is lost, a length, such as 2e-3");
    if (joint.cohesion == 0)
      throw InputError(slip_length->where, "without cohesion there is nothing to lose by slip",
                       "cohesion = 0.7 beside it, or neither");
  }
  read_coefficient(table, joint.coefficient);
  table.read("stick", joint.stick, to_bool);
  problem::Field threshold(0.0, table.where());
  table.read("threshold", threshold, to_nonnegative_field);
  return problem::JointLaw(joint, threshold);
}

problem::ContactLaw read_mixed(const TableReader& table)
{
  constexpr auto both = "tensile_strength and fracture_energy, which this law needs";
  (void)table.require("tensile_strength", both);
  (void)table.require("fracture_energy", both);
  problem::Mixed mixed;
  read_tension(table, mixed.tension);
  table.read("shear_ratio", mixed.shear_ratio,
             number_in(positive, "shear strength over tensile strength, such as 1"));
  read_coefficient(table, mixed.coefficient);
  return problem::MixedLaw(mixed);
}

problem::ContactLaw read_endo(const TableReader& table)
{
  const auto number = [&](std::string_view key, const std::string& meaning)
  { return to_number_in(table.require(key, meaning), positive, meaning); };
  problem::Endo endo{};
  endo.normal_stiffness = number("normal_stiffness", "K_n, stress per length, such as 2e4");
  endo.tangential_stiffness = endo.normal_stiffness;
  table.read("tangential_stiffness", endo.tangential_stiffness,
             number_in(positive, "K_t, stress per length; that of normal_stiffness where absent"));
  endo.coefficient = number("coefficient", "mu, such as 0.8");
  endo.normal_hardening = number("b_normal", "B_n, stress per length");
  endo.tangential_hardening = number("b_tangential", "B_t, stress per length");
  endo.energy = number("d1", "D_1, the energy per area that breaking takes");
  return problem::EndoLaw(endo);
}

const std::array laws = {
    KeyGroup{"joint",
             {"tensile_strength", "fracture_energy", "cohesion", "slip_length", "coefficient", "threshold",
              "stick", "unloading"}},
    KeyGroup{"mixed", {"tensile_strength", "fracture_energy", "shear_ratio", "coefficient", "unloading"}},
    KeyGroup{"endo",
             {"normal_stiffness", "tangential_stiffness", "coefficient", "b_normal", "b_tangential", "d1"}}};
constexpr std::array<ReadLaw, laws.size()> read_law = {read_joint, read_mixed, read_endo};

/// The law that the table names, a position in `laws`.
std::size_t choose_law(const TableReader& table)
{
  std::vector<std::string> names;
  names.reserve(laws.size());
  for (const KeyGroup& law : laws) names.emplace_back(law.name);
  const std::size_t chosen = to_choice(table.require("law", "\"joint\", \"mixed\" or \"endo\""), names);
  refuse_keys_of_others(table, "law", laws, chosen);
  return chosen;
}

}  // namespace

std::vector<std::string_view> interface_keys(std::initializer_list<std::string_view> others)
{
  std::vector<std::string_view> keys = {"law", "broken", "water", "heel", "toe"};
  for (const KeyGroup& law : laws)
    for (const std::string_view key : law.keys)
      if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
  keys.insert(keys.end(), others.begin(), others.end());
  return keys;
}

problem::Contact read_interface(const TableReader& table, std::optional<problem::Field> gap)
{
  problem::Contact contact(read_law.at(choose_law(table))(table), std::move(gap));
  if (const std::string fault = problem::fault(contact.law); !fault.empty())
    throw InputError(table.find("law")->where, fault, "other constants of the law");
  table.read("broken", contact.broken, to_field);
  read_water(table, contact);
  return contact;
}

}  // namespace tribound::case_file
