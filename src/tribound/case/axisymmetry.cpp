#include "tribound/case/axisymmetry.h"

#include <fmt/format.h>

#include "tribound/base/error.h"
#include "tribound/case/dimension.h"

namespace tribound::case_file
{

namespace
{

constexpr auto to_3d = "a model in 3D of a sector, or leave it out";

[[noreturn]] void refuse(const Where& where, std::string_view what, const std::string& right)
{
  throw InputError(where, fmt::format("a case with model = \"axisymmetric\" has no {}", what), right);
}

void check_contact(const problem::Contact& contact, const Where& where)
{
  if (std::holds_alternative<problem::Slider>(contact.law))
    refuse(where, "sliders", "displacement = [0, \"free\"] or [\"free\", 0]");
  if (contact.water) refuse(where, "water in its joints", to_3d);
}

void check_boundary(const BoundaryConfig& boundary)
{
  if (boundary.rigid) refuse(boundary.where, "rigid parts", "displacements, or tractions");
  if (boundary.spring) refuse(boundary.where, "springs", "displacements, or contact");
  if (boundary.contact) check_contact(*boundary.contact, boundary.where);
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
  for (const LoadConfig& load : config.loads)
    if (load.temperature || !load.initial_stress.empty())
      refuse(load.where, "temperatures and initial stresses", "forces per volume: body = [0, -9.81]");
  for (const BoundaryConfig& boundary : config.boundaries) check_boundary(boundary);
  for (const ContactConfig& contact : config.contacts) check_contact(contact.contact, contact.where);
}

}  // namespace tribound::case_file
