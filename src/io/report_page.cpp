#include "io/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "io/packed_array.h"
#include "io/page_profile.h"
#include "io/vtu.h"

namespace tribound
{

namespace
{

// Bits per number: beyond what can be seen, and close to what a reader of values wants.
constexpr int point_bits = 24;
constexpr int displacement_bits = 16;
constexpr int stress_bits = 12;
constexpr int component_bits = 10;
constexpr double component_decades = 8;
constexpr int profile_bits = 20;

/// `"name":value` with a comma in front.
std::string member(std::string_view name, const std::string& value)
{
  return fmt::format(",\"{}\":{}", name, value);
}

/// eta_tot and the components, one number per face; what is zero everywhere is left out.
std::string component_members(const Surface& surface, const Estimate& estimate)
{
  std::string members;
  std::vector<double> values(surface.n_faces());
  const auto add = [&](std::string_view name, const auto& value)
  {
    for (std::size_t face = 0; face < values.size(); ++face)
      values[face] = value(estimate.cells[surface.cells[face]]);
    if (std::ranges::none_of(values, [](double x) { return x > 0.0; })) return;
    members += fmt::format("{}\"{}\":{}", members.empty() ? "" : ",", name,
                           pack_logarithmic(values, component_bits, component_decades));
  };
  add("tot", [](const BoundComponents& cell) { return cell.total_sharp(); });
  for (const auto& [name, component] : all_component_names)
    add(name, [c = component](const BoundComponents& cell) { return cell.*c; });
  return members;
}

/// Which region a face lies in, where there are several.
template <int dim>
std::string region_member(const Surface& surface, const Mesh<dim>& mesh)
{
  if (mesh.region_names().size() < 2) return {};
  std::vector<Index> regions;
  for (const Index cell : surface.cells) regions.push_back(mesh.region(cell));
  return member("region", pack_integers(regions));
}

std::string contact_member(const SurfaceContact& contact)
{
  if (contact.pressure.empty()) return {};
  const auto column = [](const std::vector<double>& values) { return pack_linear(values, stress_bits); };
  return member(
      "contact",
      fmt::format(R"({{"pressure":{},"friction":{},"limit":{},"gap":{},"slip":{},"point_status":{},)"
                  R"("status":{}}})",
                  column(contact.pressure), column(contact.friction), column(contact.limit),
                  column(contact.gap), column(contact.slip), pack_integers(contact.point_status),
                  pack_integers(contact.status)));
}

std::string json(const ContactProfile& profile, const std::string& boundary)
{
  const auto column = [](const std::vector<double>& values) { return pack_linear(values, profile_bits); };
  return fmt::format(
      R"({{"boundary":{},"arc":{},"points":{},"displacement":{},"pressure":{},"friction":{},"limit":{},)"
      R"("gap":{},"slip":{},"status":{}}})",
      nlohmann::json(boundary).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
      column(profile.arc), column(profile.points), column(profile.displacement), column(profile.pressure),
      column(profile.friction), column(profile.limit), column(profile.gap), column(profile.slip),
      pack_integers(profile.status));
}

template <int dim>
std::string profiles_member(const NitscheForm<dim>& form, std::span<const double> u)
{
  std::string profiles;
  if constexpr (dim == 2)
    for (const ContactProfile& profile : contact_profiles(form, u))
      profiles += (profiles.empty() ? "" : ",") + json(profile, form.problem().boundary(profile.tag).name);
  return profiles.empty() ? profiles : member("profiles", "[" + profiles + "]");
}

/// The files of a run, in the order in which a reader wants them.
std::vector<std::string> run_files(const RunRecord& run)
{
  std::vector<std::string> names = {"certificate.json", "convergence.csv", "newton.csv", "contact.csv",
                                    "series.pvd"};
  for (const LevelRecord& level : run.levels)
    for (const char* stem : {"level", "contact"}) names.push_back(level_file_name(stem, level.level));
  return names;
}

}  // namespace

template <int dim>
PageLevel page_level(int number, const NitscheForm<dim>& form, const CertifiedLevel<dim>& level,
                     const PageLimits& limits)
{
  const Surface surface = sample_surface(form, level.u, level.stress, limits);
  PageLevel result{number, surface.n_triangles(), {}};
  result.json = fmt::format(
      R"({{"level":{},"dimension":{},"cells":{},"subdivision":{},"merged_below":{},"points":{},)"
      R"("displacement":{},"faces":{},"von_mises":{},"eta":{{{}}}{}{}{}}})",
      number, dim, form.space().mesh().n_cells(), surface.subdivision, surface.merged_below,
      pack_linear(surface.points, point_bits), pack_linear(surface.displacement, displacement_bits),
      pack_integers(surface.faces, surface.n_face_points()), pack_linear(surface.von_mises, stress_bits),
      component_members(surface, level.estimate), region_member(surface, form.space().mesh()),
      contact_member(surface.contact), profiles_member(form, level.u));
  return result;
}

void drop_levels(std::vector<PageLevel>& levels, const PageLimits& limits)
{
  const auto total = [&levels]
  {
    std::size_t n = 0;
    for (const PageLevel& level : levels) n += level.n_triangles;
    return n;
  };
  while (levels.size() > 2 && total() > limits.all_levels)
    levels.erase(std::ranges::max_element(levels.begin() + 1, levels.end() - 1, {}, &PageLevel::n_triangles));
}

void add_true_errors(const std::filesystem::path& page, std::span<const TrueErrors> errors)
{
  std::string text = read_text(page);
  const std::size_t marker = text.rfind(true_errors_marker);
  if (marker == std::string::npos) return;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const TrueErrors& row : errors)
  {
    rows.push_back({{"level", row.level}});
    if (row.stress_error) rows.back()["stress_error"] = *row.stress_error;
    if (row.dual_norm) rows.back()["dual_norm"] = *row.dual_norm;
  }
  text.replace(marker, true_errors_marker.size(),
               R"(<script type="application/json" id="true-errors">)" + rows.dump() + "</script>");
  write_file(page, text);
}

ReportPage::ReportPage(const std::filesystem::path& page_template) : template_(page_template) {}

template <int dim>
void ReportPage::add(int number, const NitscheForm<dim>& form, const CertifiedLevel<dim>& level)
{
  if (template_.empty()) return;
  levels_.push_back(page_level(number, form, level));
  drop_levels(levels_, {});
}

void ReportPage::write(const std::filesystem::path& directory, const RunRecord& run) const
{
  if (template_.empty()) return;
  const std::string head = fmt::format(R"({{"certificate":{},"newton":{},"machine":{},"files":{},"fields":[)",
                                       certificate_json(run), nlohmann::json(newton_csv(run)).dump(),
                                       machine_json(), files_json(directory, run_files(run)));
  std::vector<std::string_view> json = {head};
  for (const PageLevel& level : levels_)
  {
    if (json.size() > 1) json.emplace_back(",\n");
    json.emplace_back(level.json);
  }
  json.emplace_back("]}");
  template_.write(directory / "report.html", "run-data", json);
}

template PageLevel page_level(int, const NitscheForm<2>&, const CertifiedLevel<2>&, const PageLimits&);
template PageLevel page_level(int, const NitscheForm<3>&, const CertifiedLevel<3>&, const PageLimits&);
template void ReportPage::add(int, const NitscheForm<2>&, const CertifiedLevel<2>&);
template void ReportPage::add(int, const NitscheForm<3>&, const CertifiedLevel<3>&);

}  // namespace tribound
