#include "tribound/contact/nitsche/crack_tip.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
#include <type_traits>
#include <utility>

#include "tribound/mesh/geometry.h"

namespace tribound::contact
{

namespace
{

template <int dim>
bool is_cracked(const problem::InterfaceResponse<dim>& response)
{
  return response.state.damage >= 1 && response.opening > 0;
}

/// A contact point on the base line.
struct PointOnLine
{
  double s;
  bool cracked;
};

/// A facet of the interface: its corners, and whether all its points are cracked.
struct Face
{
  std::array<std::array<double, 3>, 3> corners;
  double measure;
  bool cracked;
};

/// The items of the own segments of the contact.
std::vector<PointOnLine> own_items(const NitscheForm<2>& form, const problem::Contact& contact,
                                   std::span<const problem::InterfaceResponse<2>> responses)
{
  std::vector<PointOnLine> points;
  for (std::size_t i = 0; i < form.n_owned_contact_points(); ++i)
    if (form.segments()[i / form.n_segment_points()].contact == &contact)
      points.push_back({contact.base->along<2>(form.contact_points()[i].x), is_cracked<2>(responses[i])});
  return points;
}

std::vector<Face> own_items(const NitscheForm<3>& form, const problem::Contact& contact,
                            std::span<const problem::InterfaceResponse<3>> responses)
{
  std::map<std::size_t, Face> faces;  // by number of the slave facet, which may have several segments
  const mesh::Mesh<3>& mesh = form.space().mesh();
  const std::size_t n = form.n_segment_points();
  for (std::size_t k = 0; k < form.n_owned_segments(); ++k)
  {
    const ContactSegment<3>& segment = form.segments()[k];
    if (segment.contact != &contact) continue;
    const auto [face, is_new] = faces.try_emplace(segment.slave.number, Face{{}, 0, true});
    const auto vertices =
        mesh::facet_vertices(mesh.cell(segment.slave.facet.cell), segment.slave.facet.local);
    for (int i = 0; is_new && i < 3; ++i)
    {
      const Point<3> x = mesh.vertex(vertices[i]);
      face->second.corners[i] = {x[0], x[1], x[2]};
    }
    face->second.measure += segment.measure;
    face->second.cracked =
        face->second.cracked && std::ranges::all_of(responses.subspan(k * n, n), is_cracked<3>);
  }
  std::vector<Face> result;
  result.reserve(faces.size());
  for (const auto& [number, face] : faces) result.push_back(face);
  return result;
}

CrackTip tip_of(std::vector<PointOnLine> points, const problem::BaseLine& line)
{
  std::ranges::sort(points, {}, &PointOnLine::s);
  const auto next = std::ranges::find(points, false, &PointOnLine::cracked);
  double tip = line.length();
  if (next == points.begin())
    tip = 0;
  else if (next != points.end())
    tip = (std::prev(next)->s + next->s) / 2;
  return {tip, tip};
}

using Corner = std::array<double, 3>;
using Edge = std::pair<Corner, Corner>;

Edge edge_of(const Face& face, int i)
{
  return std::minmax(face.corners[(i + 1) % 3], face.corners[(i + 2) % 3]);
}

Point<3> point(const Corner& corner)
{
  return Point<3>(corner.data());
}

/// Whether the rim edge opposite corner i faces upstream.
bool looks_upstream(const Face& face, int i, const Point<3>& downstream)
{
  constexpr double least_cosine = 0.5;
  const Point<3> begin = point(face.corners[(i + 1) % 3]);
  const Point<3> along = (point(face.corners[(i + 2) % 3]) - begin).normalized();
  const Point<3> inwards = point(face.corners[i]) - begin;
  const Point<3> normal = inwards - inwards.dot(along) * along;
  return normal.dot(downstream) > least_cosine * normal.norm();
}

CrackTip tip_of(const std::vector<Face>& faces, const problem::BaseLine& line)
{
  std::map<Edge, std::vector<std::size_t>> faces_at;
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (int i = 0; i < 3; ++i) faces_at[edge_of(faces[f], i)].push_back(f);
  const Point<3> downstream = point(line.direction());
  std::vector<std::size_t> connected;
  std::vector<bool> found(faces.size());
  const auto add = [&](std::size_t f)
  {
    if (!faces[f].cracked || found[f]) return;
    found[f] = true;
    connected.push_back(f);
  };
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (int i = 0; i < 3; ++i)
      if (faces_at[edge_of(faces[f], i)].size() == 1 && looks_upstream(faces[f], i, downstream)) add(f);
  for (std::size_t j = 0; j < connected.size(); ++j)
    for (int i = 0; i < 3; ++i)
      for (const std::size_t f : faces_at[edge_of(faces[connected[j]], i)]) add(f);

  double all = 0;
  double cracked = 0;
  CrackTip tip;
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    all += faces[f].measure;
    if (!found[f]) continue;
    cracked += faces[f].measure;
    for (const Corner& corner : faces[f].corners)
      tip.farthest = std::max(tip.farthest, line.along<3>(point(corner)));
  }
  tip.distance = cracked == 0 ? 0 : line.length() * cracked / all;
  return tip;
}

}  // namespace

template <int dim>
std::vector<CrackTip> crack_tips(const NitscheForm<dim>& form,
                                 std::span<const problem::InterfaceResponse<dim>> responses)
{
  assert(responses.size() == form.n_contact_points());
  const Ranks& ranks = form.space().mesh().ranks();
  std::vector<CrackTip> tips;
  for (const problem::Contact* contact : form.problem().contacts())
  {
    CrackTip& tip = tips.emplace_back();
    if (!contact->base) continue;
    const auto own = own_items(form, *contact, responses);
    using Item = typename std::remove_cvref_t<decltype(own)>::value_type;
    const std::vector<Item> all = ranks.gather<Item>(std::span<const Item>(own));
    tip = ranks.on_first([&] { return tip_of(all, *contact->base); });
  }
  return tips;
}

template std::vector<CrackTip> crack_tips(const NitscheForm<2>&,
                                          std::span<const problem::InterfaceResponse<2>>);
template std::vector<CrackTip> crack_tips(const NitscheForm<3>&,
                                          std::span<const problem::InterfaceResponse<3>>);

}  // namespace tribound::contact
