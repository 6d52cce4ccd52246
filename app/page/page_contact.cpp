#include <algorithm>

#include "app/page/packed_array.h"
#include "app/page/page_level.h"
#include "app/page/page_pairs.h"
#include "app/page/page_profile.h"

namespace tribound::app
{

namespace
{

constexpr int value_bits = 12;
constexpr int corner_bits = 12;  ///< of a facet
constexpr int profile_bits = 20;

/// `displacement`: gaps and slips are round-off relative to this.
io::Json contact_json(const SurfaceContact& contact, double displacement)
{
  const double stress = std::max(largest(contact.pressure), largest(contact.limit));
  const auto column = [](const std::vector<double>& values, double scale)
  { return pack_values(values, scale, value_bits); };
  return {
      {"pressure", column(contact.pressure, stress)}, {"friction", column(contact.friction, stress)},
      {"limit", column(contact.limit, stress)},       {"gap", column(contact.gap, displacement)},
      {"slip", column(contact.slip, displacement)},   {"point_status", pack_integers(contact.point_status)},
      {"status", pack_integers(contact.status)}};
}

/// The boundary name of each face with contact, as an index into `names`.
io::Json boundaries_json(const contact::NitscheForm<3>& form, const Surface& surface)
{
  const std::size_t n_faces = surface.contact.pressure.size() / surface.n_face_points();
  std::vector<Index> tags;
  for (std::size_t face = 0; face < n_faces; ++face)
    tags.push_back(form.space().mesh().boundary()[surface.facets[face]].tag);
  io::Json names = io::Json::array();
  for (const auto& boundary : form.problem().boundaries()) names.push_back(boundary.name);
  return {{"names", names}, {"of_faces", pack_integers(tags)}};
}

/// The faces of the surface that belong to a boundary.
io::Json faces_json(const contact::NitscheForm<3>& form, const Surface& surface, int tag)
{
  std::vector<Index> faces;
  for (std::size_t face = 0; face < surface.n_faces(); ++face)
    if (form.space().mesh().boundary()[surface.facets[face]].tag == tag)
      faces.push_back(static_cast<Index>(face));
  return pack_integers(faces);
}

io::Json side_json(const FaceParts& parts)
{
  if (parts.faces.empty()) return nullptr;
  return {
      {"faces", pack_integers(parts.faces)},
      {"corners", parts.corners.empty() ? io::Json(nullptr) : pack_linear(parts.corners, corner_bits, 2)}};
}

io::Json pairs_json(const contact::NitscheForm<3>& form, std::span<const double> u, const Surface& surface,
                    const PageLimits& limits)
{
  io::Json pairs = io::Json::array();
  for (const PairSurface& pair : sample_pairs(form, u, surface, limits))
  {
    if (pair.values.status.empty()) continue;
    pairs.push_back({{"boundary", form.problem().boundary(pair.tag).name},
                     {"boundary_faces", faces_json(form, surface, pair.tag)},
                     {"subdivision", pair.subdivision},
                     {"slave", side_json(pair.slave)},
                     {"master", side_json(pair.master)},
                     {"values", contact_json(pair.values, largest(surface.displacement))}});
  }
  return pairs;
}

io::Json profile_json(const ContactProfile& profile, const std::string& boundary, bool paired)
{
  const double stress = std::max(largest(profile.pressure), largest(profile.limit));
  const double length = largest(profile.displacement);
  const auto column = [](const std::vector<double>& values, double scale)
  { return pack_values(values, scale, profile_bits); };
  io::Json json{{"boundary", boundary},
                {"paired", paired},
                {"arc", pack_linear(profile.arc, profile_bits)},
                {"points", column(profile.points, largest(profile.points))},
                {"displacement", column(profile.displacement, length)},
                {"normal", column(profile.normal, 1)},
                {"pressure", column(profile.pressure, stress)},
                {"friction", column(profile.friction, stress)},
                {"limit", column(profile.limit, stress)},
                {"gap", column(profile.gap, length)},
                {"slip", column(profile.slip, length)},
                {"status", pack_integers(profile.status)},
                {"bodies", pack_integers(profile.bodies)}};
  if (!profile.damage.empty())
    json.update({{"damage", column(profile.damage, 1)}, {"opening", column(profile.opening, length)}});
  if (!profile.water.empty()) json["water"] = column(profile.water, std::max(stress, largest(profile.water)));
  if (paired)
    json.update({{"opposite", column(profile.opposite, largest(profile.opposite))},
                 {"opposite_displacement", column(profile.opposite_displacement,
                                                  std::max(length, largest(profile.opposite_displacement)))},
                 {"opposite_bodies", pack_integers(profile.opposite_bodies)}});
  return json;
}

io::Json profiles_json(const contact::NitscheForm<2>& form, std::span<const double> u)
{
  io::Json profiles = io::Json::array();
  for (const ContactProfile& profile : contact_profiles(form, u))
    profiles.push_back(profile_json(profile, form.problem().boundary(profile.tag).name,
                                    form.problem().pair_of_slave(profile.tag) != nullptr));
  return profiles;
}

template <int dim>
io::Json interfaces_json(const contact::NitscheForm<dim>& form)
{
  io::Json interfaces = io::Json::array();
  for (const BodyInterface<dim>& interface : body_interfaces(form))
    interfaces.push_back({{"bodies", interface.bodies},
                          {"measure", interface.measure},
                          {"normal", std::vector<double>(interface.normal.begin(), interface.normal.end())},
                          {"axis", std::vector<double>(interface.axis.begin(), interface.axis.end())}});
  return interfaces;
}

}  // namespace

template <int dim>
io::Json page_contact(const contact::NitscheForm<dim>& form, std::span<const double> u,
                      const Surface& surface, const PageLimits& limits)
{
  io::Json json = io::Json::object();
  if (!form.problem().has_contact()) return json;
  if constexpr (dim == 2)
    json["profiles"] = profiles_json(form, u);
  else if (!surface.contact.pressure.empty())
  {
    json["contact"] = contact_json(surface.contact, largest(surface.displacement));
    json["contact"]["boundary"] = boundaries_json(form, surface);
  }
  if (form.problem().pairs().empty()) return json;
  if constexpr (dim == 3) json["pairs"] = pairs_json(form, u, surface, limits);
  json["interfaces"] = interfaces_json(form);
  return json;
}

template io::Json page_contact(const contact::NitscheForm<2>&, std::span<const double>, const Surface&,
                               const PageLimits&);
template io::Json page_contact(const contact::NitscheForm<3>&, std::span<const double>, const Surface&,
                               const PageLimits&);

}  // namespace tribound::app
