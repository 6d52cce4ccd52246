#include "app/page/report_page.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/page/packed_array.h"
#include "app/page/page_contact.h"
#include "app/page/page_volume.h"
#include "tribound/io/fields/vtu.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/record/error_bars.h"
#include "tribound/io/record/record_json.h"
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

/// Characters up to which the page holds a table.
constexpr std::size_t largest_table = 400'000;

/// Component by component.
io::Json stress_json(std::span<const std::vector<double>> stress)
{
  double scale = 0;
  for (const std::vector<double>& component : stress) scale = std::max(scale, largest(component));
  io::Json components = io::Json::array();
  for (const std::vector<double>& component : stress)
    components.push_back(pack_values(component, scale, stress_bits));
  return components;
}

/// eta_tot and the components, one number per face; what is zero everywhere is left out.
io::Json eta_json(const Surface& surface, const certify::Estimate& estimate)
{
  io::Json eta = io::Json::object();
  std::vector<double> values(surface.n_faces());
  const auto add = [&](const char* name, const auto& value)
  {
    for (std::size_t face = 0; face < values.size(); ++face)
      values[face] = value(estimate.cells[surface.cells[face]]);
    if (std::ranges::any_of(values, [](double x) { return x > 0.0; }))
      eta[name] = pack_logarithmic(values, component_bits, component_decades);
  };
  add("tot", [](const certify::BoundComponents& cell) { return cell.total_sharp(); });
  for (const certify::Component& c : certify::all_components)
    if (estimate.global.*c.value > 0)
      add(c.name, [&c](const certify::BoundComponents& cell) { return cell.*c.value; });
  return eta;
}

/// sigma_zz / (sigma_xx + sigma_yy), region by region.
io::Json out_of_plane_json(const problem::Problem<2>& problem, const mesh::Mesh<2>& mesh)
{
  io::Json ratios = io::Json::array();
  for (int region = 0; region < static_cast<int>(mesh.region_names().size()); ++region)
    ratios.push_back(io::out_of_plane_ratio(problem.material(region)));
  return ratios;
}

/// Which region a face lies in.
template <int dim>
io::Json region_json(const Surface& surface, const mesh::Mesh<dim>& mesh)
{
  std::vector<Index> regions;
  for (const Index cell : surface.cells) regions.push_back(mesh.region(cell));
  return pack_integers(regions);
}

/// A table of which the page offers a copy; null where it is too large.
io::Json table(std::string_view text)
{
  io::Json packed = pack_text(text);
  return text.empty() || io::json_text(packed, -1).size() > largest_table ? io::Json(nullptr) : packed;
}

io::Json tables_json(const io::RunRecord& run, const std::string& contact)
{
  io::Json tables{{"convergence.csv", table(io::convergence_csv(run))},
                  {"newton.csv", table(io::newton_csv(run))},
                  {"contact.csv", table(contact)}};
  if (io::has_history(run)) tables["history.csv"] = table(io::history_csv(run));
  if (const std::string quantities = io::quantities_csv(io::levels_json(run)); !quantities.empty())
    tables["quantities.csv"] = table(quantities);
  return tables;
}

/// The effective case with its text.
io::Json case_json(const io::RunRecord& run)
{
  io::Json object = io::effective_case_json(run);
  if (!object.is_null()) object["text"] = run.effective.text;
  return object;
}

/// The Newton steps of all levels with the components of the bound.
io::Json newton_json(const io::RunRecord& run)
{
  io::Json steps = io::Json::array();
  for (const io::TableRow& row : io::newton_rows(run.levels)) steps.push_back(io::row_json(row));
  return steps;
}

/// Of all levels together.
std::size_t n_triangles(std::span<const PageLevel> levels)
{
  std::size_t n = 0;
  for (const PageLevel& level : levels) n += level.n_triangles;
  return n;
}

/// The files of a run, in the order in which a reader wants them.
std::vector<std::string> run_files(const io::RunRecord& run)
{
  std::vector<std::string> names = {"certificate.json", run.case_file, "convergence.csv",
                                    "quantities.csv",   "history.csv", "newton.csv",
                                    "contact.csv",      "adapted.msh", "series.pvd"};
  const std::string_view stem = io::has_history(run) ? "step" : "level";
  for (const io::LevelRecord& level : run.levels)
    for (const std::string& name :
         {io::level_file_name(stem, level.level), fmt::format("{}_{:03}.pvtu", stem, level.level),
          io::level_file_name("contact", level.level)})
      names.push_back(name);
  return names;
}

}  // namespace

template <int dim>
PageLevel page_level(int number, const contact::NitscheForm<dim>& form,
                     const adapt::CertifiedLevel<dim>& level, const PageLimits& limits)
{
  const mesh::Mesh<dim>& mesh = form.space().mesh();
  const Surface surface = sample_surface(form, level.u, level.stress, limits);
  PageLevel result{number,
                   surface.n_triangles(),
                   {{"level", number},
                    {"dimension", dim},
                    {"cells", mesh.n_global_cells()},
                    {"subdivision", surface.subdivision},
                    {"merged_below", surface.merged_below},
                    {"points", pack_linear(surface.points, point_bits, dim)},
                    {"displacement", pack_linear(surface.displacement, displacement_bits, dim)},
                    {"faces", pack_integers(surface.faces, surface.n_face_points())},
                    {"eta", eta_json(surface, level.estimate)},
                    {"stress", stress_json(surface.stress)}}};
  io::Json& json = result.json;
  if (mesh.region_names().size() > 1) json["region"] = region_json(surface, mesh);
  if (!surface.bodies.empty() && std::ranges::max(surface.bodies) > 0)
    json["body"] = pack_integers(surface.bodies);
  if constexpr (dim == 2) json["out_of_plane"] = out_of_plane_json(form.problem(), mesh);
  json.update(page_contact(form, level.u, surface, limits));
  return result;
}

template <int dim>
io::Json page_volume(const contact::NitscheForm<dim>& form, const adapt::CertifiedLevel<dim>& level)
{
  if constexpr (dim == 3)
    if (std::cmp_less_equal(form.space().mesh().n_global_cells(), max_volume_cells))
    {
      const Volume volume = sample_volume(form, level.u, level.stress);
      return {{"points", pack_linear(volume.points, point_bits, 3)},
              {"displacement", pack_linear(volume.displacement, displacement_bits, 3)},
              {"cells", pack_integers(volume.cells, 4)},
              {"bodies", pack_integers(volume.bodies)},
              {"stress", stress_json(volume.stress)}};
    }
  return nullptr;
}

void add_true_errors(const std::filesystem::path& page, std::span<const TrueErrors> errors)
{
  std::string text = read_text(page);
  const std::size_t marker = text.rfind(true_errors_marker);
  if (marker == std::string::npos) return;
  io::Json rows = io::Json::array();
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
  constexpr PageLimits limits{.subdivided = 6000, .stresses = 6000, .segments = 6000};
  if (!levels_.empty() && n_triangles(levels_) + n_triangles(form, limits) > limits.earlier) return;
  levels_.push_back(page_level(number, form, level, limits));
}

template <int dim>
void ReportPage::add_last(int number, const contact::NitscheForm<dim>& form,
                          const adapt::CertifiedLevel<dim>& level)
{
  if (template_.empty()) return;
  std::erase_if(levels_, [number](const PageLevel& other) { return other.number == number; });
  levels_.push_back(page_level(number, form, level));
  volume_ = page_volume(form, level);
}

void ReportPage::write(const std::filesystem::path& directory, const io::RunRecord& run) const
{
  if (template_.empty()) return;
  io::Json fields = io::Json::array();
  for (const PageLevel& level : levels_) fields.push_back(level.json);
  template_.write(
      directory / "report.html", "run-data",
      {{"certificate", io::certificate(run)},
       {"components", components_json(io::run_kind(run.levels))},
       {"case", case_json(run)},
       {"newton", newton_json(run)},
       {"tables", tables_json(run, levels_.empty() ? std::string{} : read_text(directory / "contact.csv"))},
       {"machine", machine_json()},
       {"files", files_json(directory, run_files(run))},
       {"volume", volume_},
       {"fields", std::move(fields)}});
}

template io::Json page_volume(const contact::NitscheForm<2>&, const adapt::CertifiedLevel<2>&);
template io::Json page_volume(const contact::NitscheForm<3>&, const adapt::CertifiedLevel<3>&);
template PageLevel page_level(int, const contact::NitscheForm<2>&, const adapt::CertifiedLevel<2>&,
                              const PageLimits&);
template PageLevel page_level(int, const contact::NitscheForm<3>&, const adapt::CertifiedLevel<3>&,
                              const PageLimits&);
template void ReportPage::add(int, const contact::NitscheForm<2>&, const adapt::CertifiedLevel<2>&);
template void ReportPage::add(int, const contact::NitscheForm<3>&, const adapt::CertifiedLevel<3>&);
template void ReportPage::add_last(int, const contact::NitscheForm<2>&, const adapt::CertifiedLevel<2>&);
template void ReportPage::add_last(int, const contact::NitscheForm<3>&, const adapt::CertifiedLevel<3>&);

}  // namespace tribound::app
