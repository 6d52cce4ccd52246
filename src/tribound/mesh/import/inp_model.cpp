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

int InpModel::instance_named(std::string_view name) const
{
  const std::string wanted = capitals(name);
  for (std::size_t i = 1; i < instances.size(); ++i)
    if (capitals(instances[i].name) == wanted) return static_cast<int>(i);
  return -1;
}

std::optional<InpMembers> InpModel::find_members(std::string_view field, int part, int instance,
                                                 InpSets InpPart::*kind) const
{
  if (instance >= 0) part = instances[instance].part;
  std::string_view name = field;
  if (const std::size_t dot = field.find('.'); dot != std::string_view::npos && instance < 0)
    if (const int of_name = instance_named(trimmed(field.substr(0, dot))); of_name > 0)
    {
      instance = of_name;
      part = instances[instance].part;
      name = trimmed(field.substr(dot + 1));
    }
  if (const auto one = integer_of(name)) return InpMembers{*one, *one, 1, instance};
  const int set = (parts[part].*kind).find(name);
  if (set < 0) return {};
  return InpMembers{0, 0, 1, instance, set};
}

namespace
{

struct FamilyName
{
  std::string_view prefix;
  InpFamily family;
};

/// The first that fits counts.
constexpr std::array<FamilyName, 12> family_names = {{{"C3D", InpFamily::solid},
                                                      {"CPS", InpFamily::plane},
                                                      {"CPEG", InpFamily::plane},
                                                      {"CPE", InpFamily::plane},
                                                      {"CAX", InpFamily::plane},
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
    if (const int order = order_of({shape, n}); has_dim(table_of(shape).dim) && (order == 1 || order == 2))
    {
      elements.type = {shape, n};
      return true;
    }
  return false;
}

}  // namespace tribound::mesh
