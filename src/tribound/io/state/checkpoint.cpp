#include "tribound/io/state/checkpoint.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <system_error>
#include <utility>

#include "tribound/base/error.h"
#include "tribound/fem/nested.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/file/json.h"
#include "tribound/io/state/hdf5_file.h"
#include "tribound/mesh/share_out.h"

namespace tribound::io
{

namespace
{

/// Version of the file format; others cannot be read.
constexpr int format = 3;

constexpr std::array<std::pair<const char*, std::string EarlierLevels::*>, 7> earlier_texts = {
    {{"convergence", &EarlierLevels::convergence},
     {"newton", &EarlierLevels::newton},
     {"levels", &EarlierLevels::levels},
     {"history", &EarlierLevels::history},
     {"steps", &EarlierLevels::steps},
     {"worst_convergence", &EarlierLevels::worst_convergence},
     {"worst_level", &EarlierLevels::worst_level}}};

Json earlier_json(const EarlierLevels& earlier)
{
  Json json{{"first_cells", earlier.first_cells}};
  for (const auto& [name, text] : earlier_texts) json[name] = earlier.*text;
  return json;
}

EarlierLevels earlier_of(const Json& json)
{
  EarlierLevels earlier{.first_cells = json.at("first_cells")};
  for (const auto& [name, text] : earlier_texts) earlier.*text = json.at(name);
  return earlier;
}

Json state_json(const CheckpointFacts& facts)
{
  const adapt::LevelStart& start = facts.start;
  Json json = {{"format", format},
               {"dimension", facts.dimension},
               {"degree", facts.degree},
               {"level", start.level},
               {"delta", start.delta},
               {"accuracy", start.accuracy},
               {"case", facts.case_text},
               {"earlier", earlier_json(facts.earlier)},
               {"logged", {facts.steps.path, facts.steps.last}},
               {"path", facts.path},
               {"functions", facts.n_functions},
               {"cell_values", facts.n_cell_values}};
  if (start.expected) json["expected"] = *start.expected;
  json["is_likely_last"] = start.is_likely_last;
  if (const auto& c = start.friedrichs; c && std::isfinite(c->theta))  // JSON has no infinity
    json["friedrichs"] = {std::isfinite(c->value) ? c->value : 0, c->theta, c->mesh_size, c->cells,
                          std::isfinite(c->korn) ? c->korn : -1};
  return json;
}

CheckpointFacts facts_of(const Json& json)
{
  CheckpointFacts facts;
  facts.dimension = json.at("dimension");
  facts.degree = json.at("degree");
  facts.start.level = json.at("level");
  facts.start.delta = json.at("delta");
  facts.start.accuracy = json.at("accuracy");
  facts.case_text = json.at("case");
  facts.earlier = earlier_of(json.at("earlier"));
  facts.steps = {json.at("logged").at(0), json.at("logged").at(1)};
  facts.path = json.at("path");
  facts.n_functions = json.at("functions");
  facts.n_cell_values = json.at("cell_values");
  if (json.contains("expected")) facts.start.expected = json.at("expected").get<double>();
  facts.start.is_likely_last = json.value("is_likely_last", false);
  if (json.contains("friedrichs"))
  {
    const Json& c = json.at("friedrichs");
    facts.start.friedrichs = {c.at(0), c.at(1), c.at(2), c.at(3), c.at(4)};
    if (facts.start.friedrichs->theta == 0)
      facts.start.friedrichs->value = std::numeric_limits<double>::infinity();
    if (facts.start.friedrichs->korn < 0)
      facts.start.friedrichs->korn = std::numeric_limits<double>::infinity();
  }
  return facts;
}

/// A member of all cells, with `width` numbers each.
template <class T, int dim, class Get>
std::vector<T> column(std::span<const mesh::CellRecord<dim>> cells, const Get& get)
{
  std::vector<T> values;
  for (const mesh::CellRecord<dim>& cell : cells) get(cell, [&values](T value) { values.push_back(value); });
  return values;
}

template <int dim>
void write_cells(Hdf5File& file, std::span<const mesh::CellRecord<dim>> cells)
{
  constexpr int n = dim + 1;
  using Cell = mesh::CellRecord<dim>;
  file.write<std::int64_t>(
      "root", column<std::int64_t, dim>(cells, [](const Cell& c, const auto& put) { put(c.name.root); }), 1);
  file.write<std::uint64_t>("path",
                            column<std::uint64_t, dim>(cells, [](const Cell& c, const auto& put)
                                                       { std::ranges::for_each(c.name.path, put); }),
                            2);
  file.write<std::int32_t>(
      "depth", column<std::int32_t, dim>(cells, [](const Cell& c, const auto& put) { put(c.name.depth); }),
      1);
  file.write<double>("vertices",
                     column<double, dim>(cells,
                                         [](const Cell& c, const auto& put)
                                         {
                                           for (const auto& v : c.vertices)
                                             std::ranges::for_each(v.position, put);
                                         }),
                     n * dim);
  file.write<std::uint64_t>("origins",
                            column<std::uint64_t, dim>(cells,
                                                       [](const Cell& c, const auto& put)
                                                       {
                                                         for (const auto& v : c.vertices) put(v.origin);
                                                       }),
                            n);
  file.write<std::int32_t>("tags",
                           column<std::int32_t, dim>(cells, [](const Cell& c, const auto& put)
                                                     { std::ranges::for_each(c.tags, put); }),
                           n);
  file.write<std::int32_t>(
      "region", column<std::int32_t, dim>(cells, [](const Cell& c, const auto& put) { put(c.region); }), 1);
  file.write<std::int32_t>(
      "bisection_type",
      column<std::int32_t, dim>(cells, [](const Cell& c, const auto& put) { put(c.bisection_type); }), 1);
}

template <int dim>
std::vector<mesh::CellRecord<dim>> read_cells(Hdf5File& file)
{
  constexpr std::size_t n = dim + 1;
  const auto root = file.read<std::int64_t>("root", 1);
  const auto path = file.read<std::uint64_t>("path", 2);
  const auto depth = file.read<std::int32_t>("depth", 1);
  const auto position = file.read<double>("vertices", n * dim);
  const auto origin = file.read<std::uint64_t>("origins", n);
  const auto tags = file.read<std::int32_t>("tags", n);
  const auto region = file.read<std::int32_t>("region", 1);
  const auto type = file.read<std::int32_t>("bisection_type", 1);
  const std::size_t n_cells = root.size();
  file.require(path.size() == 2 * n_cells && depth.size() == n_cells &&
                   position.size() == n_cells * n * dim && origin.size() == n_cells * n &&
                   tags.size() == n_cells * n && region.size() == n_cells && type.size() == n_cells,
               "read");
  std::vector<mesh::CellRecord<dim>> cells(n_cells);
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    mesh::CellRecord<dim>& cell = cells[c];
    cell.name = {root[c], {path[2 * c], path[2 * c + 1]}, depth[c]};
    for (std::size_t i = 0; i < n; ++i)
    {
      std::copy_n(&position[(c * n + i) * dim], dim, cell.vertices[i].position.begin());
      cell.vertices[i].origin = origin[c * n + i];
      cell.tags[i] = tags[c * n + i];
    }
    cell.region = region[c];
    cell.bisection_type = type[c];
  }
  return cells;
}

/// The values on own cells, concatenated by cell; the records may have a different order of vertices.
template <int dim>
std::vector<double> values_of_cells(const fem::LagrangeSpace<dim>& space, const CheckpointFacts& facts,
                                    const CheckpointFields& fields,
                                    std::span<const mesh::CellRecord<dim>> cells, std::span<const Index> own)
{
  const std::size_t n = static_cast<std::size_t>(dim) * space.basis().n_nodes();
  std::vector<std::vector<double>> functions;
  for (const std::span<const double> u : fields.functions)
    functions.push_back(fem::nested_values<dim>(space, u, cells, own));
  std::vector<fem::CellColumn> columns;
  columns.reserve(functions.size() + 1);
  for (const std::vector<double>& function : functions) columns.push_back({function, n});
  columns.push_back({fields.cell_values, static_cast<std::size_t>(facts.n_cell_values)});
  return fem::beside_each_other(columns, own.size());
}

}  // namespace

std::string checkpoint_name_of(int step)
{
  return fmt::format("checkpoint_{:03}.h5", step);
}

int n_values_of_cell(const CheckpointFacts& facts)
{
  const int n_nodes = facts.dimension == 2 ? fem::LagrangeBasis<2>(facts.degree).n_nodes()
                                           : fem::LagrangeBasis<3>(facts.degree).n_nodes();
  return facts.dimension * n_nodes * facts.n_functions + facts.n_cell_values;
}

template <int dim>
void write_checkpoint(const std::filesystem::path& path, const CheckpointFacts& facts,
                      const fem::LagrangeSpace<dim>& space, const CheckpointFields& fields)
{
  const mesh::Mesh<dim>& mesh = space.mesh();
  std::vector<Index> own(mesh.n_owned_cells());
  std::iota(own.begin(), own.end(), 0);
  const std::vector<mesh::CellRecord<dim>> cells =
      mesh.partition() ? mesh::records_of(mesh, own) : mesh::first_records(mesh, 0, mesh.n_cells());
  Hdf5File file(path, Hdf5File::Mode::write, mesh.ranks());
  file.write_text("state", state_json(facts).dump());
  write_cells<dim>(file, cells);
  file.write<double>("values", values_of_cells<dim>(space, facts, fields, cells, own),
                     n_values_of_cell(facts));
  file.write<double>("points", fields.points, fields.point_width);
  file.commit();
}

void copy_checkpoint(const std::filesystem::path& from, const std::filesystem::path& to)
{
  const std::filesystem::path temporary = temporary_name(to, ::getpid());
  std::error_code error;
  std::filesystem::remove(temporary, error);
  std::filesystem::create_hard_link(from, temporary, error);
  if (error)  // not supported by this file system
    std::filesystem::copy_file(from, temporary, std::filesystem::copy_options::overwrite_existing, error);
  if (!error) std::filesystem::rename(temporary, to, error);
  if (error) throw WriteError(to, "cannot be written: " + error.message(), hint_for_writing(error.value()));
}

namespace
{

CheckpointFacts facts_in(const std::filesystem::path& path, const std::string& text)
{
  try
  {
    const Json json = Json::parse(text);
    if (json.at("format") != format)
      throw InputError({.file = path.string()}, "is a checkpoint of another version of Tribound",
                       "start the run anew, or restart it with the version that wrote it");
    return facts_of(json);
  }
  catch (const Json::exception& error)
  {
    throw InputError({.file = path.string()}, std::string("is a damaged checkpoint: ") + error.what(),
                     "start the run anew");
  }
}

}  // namespace

CheckpointFacts read_checkpoint_facts(const std::filesystem::path& path, const Ranks& ranks)
{
  CheckpointFacts facts = facts_in(path, Hdf5File(path, Hdf5File::Mode::read, ranks).read_text("state"));
  if (facts.steps.last > 0) add_steps(facts.earlier, read_steps(path, facts.steps, ranks));
  return facts;
}

template <int dim>
CheckpointCells<dim> read_checkpoint_cells(const std::filesystem::path& path, const CheckpointFacts& facts,
                                           const Ranks& ranks)
{
  Hdf5File file(path, Hdf5File::Mode::read, ranks);
  CheckpointCells<dim> result;
  result.cells = read_cells<dim>(file);
  const int n_values = n_values_of_cell(facts);
  result.values = file.read<double>("values", n_values);
  if (!facts.path.empty()) result.points = ranks.gather<double>(file.read<double>("points", 2 * dim + 3));
  ranks.copy_from_first(result.points);
  file.require(facts.dimension == dim && result.values.size() == result.cells.size() * n_values, "read");
  return result;
}

template void write_checkpoint(const std::filesystem::path&, const CheckpointFacts&,
                               const fem::LagrangeSpace<2>&, const CheckpointFields&);
template void write_checkpoint(const std::filesystem::path&, const CheckpointFacts&,
                               const fem::LagrangeSpace<3>&, const CheckpointFields&);
template CheckpointCells<2> read_checkpoint_cells(const std::filesystem::path&, const CheckpointFacts&,
                                                  const Ranks&);
template CheckpointCells<3> read_checkpoint_cells(const std::filesystem::path&, const CheckpointFacts&,
                                                  const Ranks&);

}  // namespace tribound::io
