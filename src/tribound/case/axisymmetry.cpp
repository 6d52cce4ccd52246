#include "tribound/case/axisymmetry.h"

#include <fmt/format.h>

#include <algorithm>

#include "tribound/base/error.h"
#include "tribound/case/dimension.h"

namespace tribound::case_file
{

namespace
{

[[noreturn]] void refuse(const Where& where, std::string_view what, const std::string& right)
{
  throw InputError(where, fmt::format("a case with model = \"axisymmetric\" has no {}", what), right);
}

void check_contact(const problem::Contact& contact)
{
  if (contact.base)
    refuse(contact.base->where, "bases from heel to toe: nothing slides or turns over across the axis",
           "water = { pressure = \"...\" }, a formula of x; the effective force is that of all joints");
}

/// The part moves along the axis alone: it needs no point.
void check_rigid(RigidConfig& rigid)
{
  constexpr auto right = "the force along the axis, on the full circle: force = [0, -100]";
  if (!rigid.moment.empty())
    refuse(inside(rigid.where, "moment"), "moments on rigid parts, which do not turn", right);
  if (!rigid.force.empty() && !rigid.force[0].is_zero())
    refuse(inside(rigid.where, "force"),
           "radial forces on rigid parts, which keep their distance from the axis", right);
  if (std::ranges::find(rigid.fixed, "rz") == rigid.fixed.end()) rigid.fixed.emplace_back("rz");
}

}  // namespace

Key model_key()
{
  return {"model", one_of({"axisymmetric"})};
}

void read_model(const TableReader& root, Config& config)
{
  const Node* model = root.find("model");
  if (model == nullptr) return;
  (void)to_choice(*model, root.key_of("model").value.words);
  config.is_axisymmetric = true;
  for (const MaterialConfig& material : config.materials)
    if (material.plane == problem::PlaneModel::stress)
      refuse(inside(material.where, "plane"), "plane stress",
             "leave plane out: the stress around the axis follows from the hoop strain");
  for (BoundaryConfig& boundary : config.boundaries)
  {
    if (boundary.rigid) check_rigid(*boundary.rigid);
    if (boundary.contact) check_contact(*boundary.contact);
  }
  for (const ContactConfig& contact : config.contacts) check_contact(contact.contact);
}

}  // namespace tribound::case_file
