#include "tribound/mesh/import/inp_model.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>

namespace tribound::mesh
{

void InpSet::add(const InpMembers& more)
{
  if (!members.empty())
  {
    InpMembers& last = members.back();
    const bool is_next = more.set < 0 && last.set < 0 && more.instance == last.instance && !more.may_miss &&
                         !last.may_miss && more.first == more.last && more.first == last.last + 1;
    if (is_next)
    {
      last.last = more.last;
      return;
    }
  }
  members.push_back(more);
}

int InpSets::find(std::string_view name) const
{
  const auto found = by_name.find(capitals(name));
  return found == by_name.end() ? -1 : found->second;
}

int InpSets::add(std::string_view name, const InpPlace& place)
{
  const auto [it, is_new] = by_name.try_emplace(capitals(name), static_cast<int>(all.size()));
  if (is_new) all.push_back({std::string(name), place});
  return it->second;
}

namespace
{

struct FamilyName
{
  std::string_view prefix;
  InpFamily family;
};

/// The first that fits counts.
constexpr std::array<FamilyName, 11> family_names = {{{"C3D", InpFamily::solid},
                                                      {"CPS", InpFamily::plane},
                                                      {"CPEG", InpFamily::plane},
                                                      {"CPE", InpFamily::plane},
                                                      {"M3D", InpFamily::shell},
                                                      {"SFM3D", InpFamily::shell},
                                                      {"STRI", InpFamily::shell},
                                                      {"DS", InpFamily::shell},
                                                      {"S", InpFamily::shell},
                                                      {"T3D", InpFamily::truss},
                                                      {"T2D", InpFamily::truss}}};

}  // namespace

bool find_type(std::string_view name, InpElements& elements)
{
  const auto* family =
      std::ranges::find_if(family_names, [&](const FamilyName& f) { return name.starts_with(f.prefix); });
  if (family == family_names.end()) return false;
  const std::string_view rest = name.substr(family->prefix.size());
  int n = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), n);
  if (error != std::errc{}) return false;
  if (family->family == InpFamily::solid && rest.starts_with("15V")) n = 18;
  elements.family = family->family;
  const auto has_dim = [&](int dim)
  {
    return family->family == InpFamily::solid   ? dim == 3
           : family->family == InpFamily::truss ? dim == 1
                                                : dim == 2;
  };
  for (const Shape shape : {Shape::segment, Shape::triangle, Shape::quadrilateral, Shape::tetrahedron,
                            Shape::hexahedron, Shape::prism, Shape::pyramid})
    if (has_dim(table_of(shape).dim) && is_known({shape, n}))
    {
      elements.type = {shape, n};
      return true;
    }
  return false;
}

}  // namespace tribound::mesh
