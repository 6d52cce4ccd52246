#include "tribound/case/interface_reader.h"

#include <array>
#include <string>
#include <utility>

#include "tribound/case/water_reader.h"

namespace tribound::case_file
{

namespace
{

using ReadLaw = problem::ContactLaw (*)(const TableReader& table);

void read_tension(const TableReader& table, problem::Tension& tension)
{
  table.read("tensile_strength", tension.strength);
  table.read("fracture_energy", tension.fracture_energy);
  table.read("unloading", tension.unloading);
}

problem::ContactLaw read_joint(const TableReader& table)
{
  problem::Joint joint;
  read_tension(table, joint.tension);
  table.read("cohesion", joint.cohesion);
  table.read("slip_length", joint.slip_length);
  if (const Node* slip_length = table.find("slip_length"); slip_length != nullptr && joint.cohesion == 0)
    throw InputError(slip_length->where, "slip_length requires a cohesion",
                     "cohesion = 0.7 beside it, or neither");
  table.read("coefficient", joint.coefficient);
  table.read("stick", joint.stick);
  problem::Field threshold(0.0, table.where());
  table.read("threshold", threshold);
  return problem::JointLaw(joint, threshold);
}

problem::ContactLaw read_mixed(const TableReader& table)
{
  problem::Mixed mixed;
  read_tension(table, mixed.tension);
  table.read("shear_ratio", mixed.shear_ratio);
  table.read("coefficient", mixed.coefficient);
  return problem::MixedLaw(mixed);
}

problem::ContactLaw read_endo(const TableReader& table)
{
  problem::Endo endo{};
  table.read("normal_stiffness", endo.normal_stiffness);
  endo.tangential_stiffness = endo.normal_stiffness;
  table.read("tangential_stiffness", endo.tangential_stiffness);
  if (const Node* coefficient = table.find("coefficient"))
    endo.coefficient = to_number_in(*coefficient, positive, "mu, such as 0.8");
  table.read("b_normal", endo.normal_hardening);
  table.read("b_tangential", endo.tangential_hardening);
  table.read("d1", endo.energy);
  return problem::EndoLaw(endo);
}

const std::array laws = {
    KeyGroup{"joint",
             {"tensile_strength", "fracture_energy", "cohesion", "slip_length", "coefficient", "threshold",
              "stick", "unloading"}},
    KeyGroup{"mixed",
             {"tensile_strength", "fracture_energy", "shear_ratio", "coefficient", "unloading"},
             {"tensile_strength", "fracture_energy"}},
    KeyGroup{"endo",
             {"normal_stiffness", "tangential_stiffness", "coefficient", "b_normal", "b_tangential", "d1"},
             {"normal_stiffness", "coefficient", "b_normal", "b_tangential", "d1"}}};
constexpr std::array<ReadLaw, laws.size()> law_readers = {read_joint, read_mixed, read_endo};

/// The constants of all laws.
std::vector<Key> constants()
{
  return {
      {"tensile_strength",
       number_in(not_negative, "the largest tension that it holds, a stress, such as 0.3")},
      {"fracture_energy", number_in(not_negative, "the energy per area that breaking takes, such as 1e-4")},
      {"cohesion", number_in(not_negative, "the shear stress beside friction that it holds, such as 0.7")},
      {"slip_length", number_in(positive, "the slip on which cohesion is lost, a length, such as 2e-3")},
      {"coefficient", number_in(not_negative, "the friction coefficient, such as 0.6")},
      {"threshold", nonnegative_datum()},
      {"stick", truth()},
      {"unloading", one_of({"origin", "vertical"})},
      {"shear_ratio", number_in(positive, "shear strength over tensile strength, such as 1")},
      {"normal_stiffness", number_in(positive, "K_n, stress per length, such as 2e4")},
      {"tangential_stiffness",
       number_in(positive, "K_t, stress per length; that of normal_stiffness where absent")},
      {"b_normal", number_in(positive, "B_n, stress per length")},
      {"b_tangential", number_in(positive, "B_t, stress per length")},
      {"d1", number_in(positive, "D_1, the energy per area that breaking takes")}};
}

}  // namespace

Table interface_table(const std::vector<Key>& others)
{
  std::vector<std::string> words;
  words.reserve(laws.size());
  for (const KeyGroup& law : laws) words.emplace_back(law.word);
  const std::vector<Key> own = {{"law", one_of(words), "\"joint\", \"mixed\" or \"endo\""},
                                {"broken", datum()},
                                {"water", keys_of(water_table())},
                                {"heel", numbers()},
                                {"toe", numbers()}};
  return {.name = "interface",
          .keys = own + constants() + others,
          .relations = {{.key = "heel", .needs = {"toe"}}, {.key = "toe", .needs = {"heel"}}},
          .choice = "law",
          .groups = {laws.begin(), laws.end()}};
}

problem::Contact read_interface(const TableReader& table, std::optional<problem::Field> gap)
{
  const std::size_t law = table.choose();
  problem::Contact contact(law_readers.at(law)(table), std::move(gap));
  table.require_group(law);
  if (const std::string fault = problem::fault(contact.law); !fault.empty())
    throw InputError(table.find("law")->where, fault, "other constants of the law");
  table.read("broken", contact.broken);
  read_water(table, contact);
  return contact;
}

}  // namespace tribound::case_file
