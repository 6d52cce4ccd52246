#include "app/page/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/page/packed_array.h"
#include "app/page/page_profile.h"
#include "app/page/page_volume.h"
#include "tribound/io/fields/vtu.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/record/facts_json.h"
#include "tribound/io/record/tables.h"

namespace tribound::app
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

/// Below this part of the largest value of its kind a value is round-off.
constexpr double round_off = 1e-10;
/// Characters up to which the page holds a table.
constexpr std::size_t largest_table = 400'000;

double largest(std::span<const double> values)
{
  double result = 0;
  for (const double value : values) result = std::max(result, std::abs(value));
  return result;
}

/// Packed with 0 in the place of what is round-off beside `scale`.
std::string pack_values(std::vector<double> values, double scale, int bits)
{
  for (double& value : values)
    if (std::abs(value) <= round_off * scale) value = 0;
  return pack_linear(values, bits);
}

/// `"name":value` with a comma in front.
std::string member(std::string_view name, const std::string& value)
{
  return fmt::format(",\"{}\":{}", name, value);
}

/// The components of a stress, component by component.
std::string stress_member(std::span<const std::vector<double>> stress)
{
  double scale = 0;
  for (const std::vector<double>& component : stress) scale = std::max(scale, largest(component));
  std::string components;
  for (const std::vector<double>& component : stress)
    components += (components.empty() ? "" : ",") + pack_values(component, scale, stress_bits);
  return member("stress", "[" + components + "]");
}

/// eta_tot and the components, one number per face; what is zero everywhere is left out.
std::string component_members(const Surface& surface, const certify::Estimate& estimate)
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
  add("tot", [](const certify::BoundComponents& cell) { return cell.total_sharp(); });
  for (const certify::Component& c : certify::all_components)
    add(c.name, [&c](const certify::BoundComponents& cell) { return cell.*c.value; });
  return members;
}

/// In 2D sigma_zz / (sigma_xx + sigma_yy), region by region.
template <int dim>
std::string out_of_plane_member(const problem::Problem<dim>& problem, const mesh::Mesh<dim>& mesh)
{
  if constexpr (dim == 3) return {};
  std::string ratios;
  for (int region = 0; region < static_cast<int>(mesh.region_names().size()); ++region)
    ratios +=
        fmt::format("{}{}", ratios.empty() ? "" : ",", io::out_of_plane_ratio(problem.material(region)));
  return member("out_of_plane", "[" + ratios + "]");
}

/// Which region a face lies in, where there are several.
template <int dim>
std::string region_member(const Surface& surface, const mesh::Mesh<dim>& mesh)
{
  if (mesh.region_names().size() < 2) return {};
  std::vector<Index> regions;
  for (const Index cell : surface.cells) regions.push_back(mesh.region(cell));
  return member("region", pack_integers(regions));
}

std::string contact_member(const SurfaceContact& contact, double displacement)
{
  if (contact.pressure.empty()) return {};
  const double stress = std::max(largest(contact.pressure), largest(contact.limit));
  const auto column = [](const std::vector<double>& values, double scale)
  { return pack_values(values, scale, stress_bits); };
  return member(
      "contact",
      fmt::format(R"({{"pressure":{},"friction":{},"limit":{},"gap":{},"slip":{},"point_status":{},)"
                  R"("status":{}}})",
                  column(contact.pressure, stress), column(contact.friction, stress),
                  column(contact.limit, stress), column(contact.gap, displacement),
                  column(contact.slip, displacement), pack_integers(contact.point_status),
                  pack_integers(contact.status)));
}

std::string json(const ContactProfile& profile, const std::string& boundary)
{
  const double stress = std::max(largest(profile.pressure), largest(profile.limit));
  const double length = largest(profile.displacement);
  const auto column = [](const std::vector<double>& values, double scale)
  { return pack_values(values, scale, profile_bits); };
  return fmt::format(
      R"({{"boundary":{},"arc":{},"points":{},"displacement":{},"normal":{},"pressure":{},"friction":{},)"
      R"("limit":{},"gap":{},"slip":{},"status":{}}})",
      nlohmann::json(boundary).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
      pack_linear(profile.arc, profile_bits), column(profile.points, largest(profile.points)),
      column(profile.displacement, length), column(profile.normal, 1), column(profile.pressure, stress),
      column(profile.friction, stress), column(profile.limit, stress), column(profile.gap, length),
      column(profile.slip, length), pack_integers(profile.status));
}

template <int dim>
std::string profiles_member(const contact::NitscheForm<dim>& form, std::span<const double> u)
{
  std::string profiles;
  if constexpr (dim == 2)
    for (const ContactProfile& profile : contact_profiles(form, u))
      profiles += (profiles.empty() ? "" : ",") + json(profile, form.problem().boundary(profile.tag).name);
  return profiles.empty() ? profiles : member("profiles", "[" + profiles + "]");
}

/// A table of which the page offers a copy; "null" where it is too large.
std::string table(std::string_view text)
{
  std::string packed = pack_text(text);
  return text.empty() || packed.size() > largest_table ? "null" : packed;
}

/// The effective case with its text.
std::string case_json(const io::RunRecord& run)
{
  io::Json object = io::effective_case_json(run);
  if (!object.is_null()) object["text"] = run.effective.text;
  return object.dump(-1, ' ', false, io::Json::error_handler_t::replace);
}

/// The files of a run, in the order in which a reader wants them.
std::vector<std::string> run_files(const io::RunRecord& run)
{
  std::vector<std::string> names = {"certificate.json", run.case_file, "convergence.csv", "newton.csv",
                                    "contact.csv",      "adapted.msh", "series.pvd"};
  for (const io::LevelRecord& level : run.levels)
    for (const char* stem : {"level", "contact"}) names.push_back(io::level_file_name(stem, level.level));
  return names;
}

}  // namespace

template <int dim>
PageLevel page_level(int number, const contact::NitscheForm<dim>& form,
                     const adapt::CertifiedLevel<dim>& level, const PageLimits& limits)
{
  const Surface surface = sample_surface(form, level.u, level.stress, limits);
  PageLevel result{number, surface.n_triangles(), {}};
  result.json = fmt::format(
      R"({{"level":{},"dimension":{},"cells":{},"subdivision":{},"merged_below":{},"points":{},)"
      R"("displacement":{},"faces":{},"eta":{{{}}}{}{}{}{}{}}})",
      number, dim, form.space().mesh().n_cells(), surface.subdivision, surface.merged_below,
      pack_linear(surface.points, point_bits, dim), pack_linear(surface.displacement, displacement_bits, dim),
      pack_integers(surface.faces, surface.n_face_points()), component_members(surface, level.estimate),
      stress_member(surface.stress), out_of_plane_member(form.problem(), form.space().mesh()),
      region_member(surface, form.space().mesh()),
      contact_member(surface.contact, largest(surface.displacement)), profiles_member(form, level.u));
  return result;
}

template <int dim>
std::string page_volume(const contact::NitscheForm<dim>& form, const adapt::CertifiedLevel<dim>& level)
{
  if constexpr (dim == 3)
    if (std::cmp_less_equal(form.space().mesh().n_cells(), max_volume_cells))
    {
      const Volume volume = sample_volume(form, level.u, level.stress);
      return fmt::format(R"({{"points":{},"displacement":{},"cells":{}{}}})",
                         pack_linear(volume.points, point_bits, 3),
                         pack_linear(volume.displacement, displacement_bits, 3),
                         pack_integers(volume.cells, 4), stress_member(volume.stress));
    }
  return "null";
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
  io::write_file(page, text);
}

ReportPage::ReportPage(const std::filesystem::path& page_template) : template_(page_template) {}

template <int dim>
void ReportPage::add(int number, const contact::NitscheForm<dim>& form,
                     const adapt::CertifiedLevel<dim>& level)
{
  if (template_.empty()) return;
  if (!levels_.empty() && levels_.back().number == number) levels_.pop_back();
  levels_.push_back(page_level(number, form, level));
  volume_ = page_volume(form, level);
  drop_levels(levels_, {});
}

void ReportPage::write(const std::filesystem::path& directory, const io::RunRecord& run) const
{
  if (template_.empty()) return;
  const std::string contact = levels_.empty() ? "null" : table(read_text(directory / "contact.csv"));
  const std::string head = fmt::format(
      R"({{"certificate":{},"components":{},"case":{},"newton":{},"tables":{{"convergence.csv":{},"contact.csv":{}}},"machine":{},)"
      R"("files":{},"volume":{},"fields":[)",
      io::certificate_json(run), components_json(std::ranges::any_of(run.levels, io::is_regularised)),
      case_json(run), nlohmann::json(io::newton_csv(run.levels)).dump(),
      table(io::convergence_csv(run.levels)), contact, machine_json(), files_json(directory, run_files(run)),
      volume_);
  std::vector<std::string_view> json = {head};
  for (const PageLevel& level : levels_)
  {
    if (json.size() > 1) json.emplace_back(",\n");
    json.emplace_back(level.json);
  }
  json.emplace_back("]}");
  template_.write(directory / "report.html", "run-data", json);
}

template std::string page_volume(const contact::NitscheForm<2>&, const adapt::CertifiedLevel<2>&);
template std::string page_volume(const contact::NitscheForm<3>&, const adapt::CertifiedLevel<3>&);
template PageLevel page_level(int, const contact::NitscheForm<2>&, const adapt::CertifiedLevel<2>&,
                              const PageLimits&);
template PageLevel page_level(int, const contact::NitscheForm<3>&, const adapt::CertifiedLevel<3>&,
                              const PageLimits&);
template void ReportPage::add(int, const contact::NitscheForm<2>&, const adapt::CertifiedLevel<2>&);
template void ReportPage::add(int, const contact::NitscheForm<3>&, const adapt::CertifiedLevel<3>&);

}  // namespace tribound::app
