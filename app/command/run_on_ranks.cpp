#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <utility>
#include <variant>

#include "app/command/run.h"
#include "app/command/with_case.h"
#include "app/console/console.h"
#include "app/console/text.h"
#include "app/host.h"
#include "app/shared_file.h"
#include "tribound/algebra/blas.h"
#include "tribound/algebra/petsc.h"
#include "tribound/base/error.h"
#include "tribound/base/parallel.h"
#include "tribound/base/rank_failure.h"
#include "tribound/base/ranks.h"
#include "tribound/io/file/output_directory.h"
#include "tribound/io/state/checkpoint.h"
#include "tribound/mesh/box.h"
#include "tribound/mesh/import/read.h"
#include "tribound/mesh/share_out.h"

namespace tribound::app
{

namespace
{

/// A variable set by mpirun or a batch system for the processes they start together: of Open MPI, or of MPICH
/// and its relatives; `otherwise` if there is none.
int launcher_says(std::array<const char*, 2> variables, int otherwise)
{
  for (const char* variable : variables)
    if (const char* value = std::getenv(variable)) return std::atoi(value);
  return otherwise;
}

/// The checkpoint that a run continues from.
struct Checkpoint
{
  std::filesystem::path file;
  io::CheckpointFacts facts;
};

/// The checkpoint of an output directory, or a given one of several there.
std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& place, const Ranks& ranks)
{
  if (place.empty()) return std::nullopt;
  const bool is_file = place.extension() == ".h5" && !std::filesystem::is_directory(place);
  const std::filesystem::path file = is_file ? place : place / io::checkpoint_name;
  return Checkpoint{file, io::read_checkpoint_facts(file, ranks)};
}

/// Whether a checkpoint belongs to an incomplete pass after the first.
bool is_of_unfinished_pass(const std::filesystem::path& file)
{
  const std::filesystem::path directory = file.parent_path();
  return directory.filename() == io::unfinished_pass ||
         (file.filename() == io::checkpoint_name && std::filesystem::exists(directory / io::unfinished_pass));
}

/// The case of a checkpoint, whose results are continued in the same directory.
case_file::Config restarted_config(const CaseRequest& request, const Checkpoint& from)
{
  const io::CheckpointFacts& checkpoint = from.facts;
  std::filesystem::path directory = from.file.has_parent_path() ? from.file.parent_path() : ".";
  if (directory.filename() == io::unfinished_pass) directory /= "..";
  // Before the others, because paths of the effective case are relative to it.
  std::vector<std::string> overrides = {fmt::format("output.directory='{}'", directory.string())};
  overrides.insert(overrides.end(), request.overrides.begin(), request.overrides.end());
  case_file::Config config =
      case_file::parse_config(checkpoint.case_text, (directory / "case.toml").string(), overrides);
  if (config.method.degree != checkpoint.degree)
    throw InputError({},
                     fmt::format("degree is {}, but that of the checkpoint is {}", config.method.degree,
                                 checkpoint.degree),
                     "a run goes on with its degree");
  if (config.history.has_value() == checkpoint.path.empty())
    throw InputError({.file = config.file},
                     checkpoint.path.empty() ? "has load steps, but the run of the checkpoint had none"
                                             : "has no load steps, but the run of the checkpoint had some",
                     "a run goes on with [history], or without");
  return config;
}

/// The work of one process that neither distributes its mesh nor continues a run.
template <int dim>
ExitCode run_alone(const case_file::Config& config, mesh::Mesh<dim> mesh, const Progress& progress,
                   const RunHooks& hooks)
{
  const algebra::Environment environment;  // after the input, so that bad input fails at once
  if (Ranks::world().size() > 1)
    throw InputError(
        {}, fmt::format("{} processes were started by a launcher that is not known", Ranks::world().size()),
        "start them by mpirun");
  return run(config, std::move(mesh), progress, hooks);
}

/// Boxes, of which every rank makes its own cells; where formulas make groups, they are shared out as files
/// are.
bool is_made_in_parts(const case_file::Config& config)
{
  return config.groups.empty() && mesh::n_box_cells(config.mesh).has_value();
}

/// `whole`: on the first rank the mesh or, for boxes, where each rank makes its own cells, a coarser one.
template <int dim>
ExitCode run_shared_out(const Ranks& ranks, const case_file::Config& config,
                        std::optional<mesh::AnyMesh> whole, const std::optional<Checkpoint>& checkpoint,
                        const Progress& progress, const RunHooks& hooks)
{
  using Whole = mesh::Mesh<dim>;
  std::shared_ptr<const Whole> first;
  ranks.on_first([&] { first = std::make_shared<const Whole>(std::get<Whole>(*std::exchange(whole, {}))); });
  if (!checkpoint)
  {
    Whole part = is_made_in_parts(config) ? mesh::share_out<dim>(ranks, config.mesh, first.get())
                                          : mesh::share_out<dim>(ranks, first.get());
    return run(config, std::move(part), progress, hooks, std::move(first));
  }
  const io::CheckpointFacts& facts = checkpoint->facts;
  ranks.on_first(
      [&]
      {
        const std::int64_t n_cells =
            is_made_in_parts(config) ? *mesh::n_box_cells(config.mesh) : first->n_cells();
        if (n_cells != facts.earlier.first_cells)
          throw InputError(first->source(),
                           fmt::format("has {} cells, but the run to restart began with {}", n_cells,
                                       facts.earlier.first_cells),
                           "restart with the mesh that the run began with");
      });
  io::CheckpointCells<dim> read = io::read_checkpoint_cells<dim>(checkpoint->file, facts, ranks);
  mesh::Balanced<dim> balanced =
      mesh::restore<dim>(ranks, first.get(), std::move(read.cells), read.values, io::n_values_of_cell(facts),
                         is_made_in_parts(config) ? mesh::box_facets<dim>(ranks, config.mesh) : nullptr);
  const Restart restart{facts,
                        std::move(balanced.cells),
                        std::move(balanced.values),
                        std::move(read.points),
                        ranks.on_first([&] { return is_of_unfinished_pass(checkpoint->file); }),
                        checkpoint->file};
  return run(config, std::move(balanced.mesh), progress, hooks, std::move(first), &restart);
}

ExitCode run_on(const Ranks& ranks, const CaseRequest& request, const std::string& place,
                const RunHooks& hooks)
{
  constexpr std::int64_t most_to_look_at = 100'000;
  const Progress progress(request.quiet || !ranks.is_first());
  const std::optional<Checkpoint> checkpoint = read_checkpoint(place, ranks);
  case_file::Config config = ranks.together(
      [&] { return checkpoint ? restarted_config(request, *checkpoint) : read_config(request); });
  if (hooks.change) hooks.change(config);
  const bool is_alone = ranks.size() == 1 && !checkpoint;
  std::optional<mesh::AnyMesh> whole;
  const bool is_plane = ranks.on_first(
      [&]
      {
        whole.emplace(read_mesh(config,
                                is_alone || !is_made_in_parts(config)
                                    ? config.mesh
                                    : mesh::coarser_box(config.mesh, most_to_look_at),
                                &stop_on_signals(), request.quiet));
        return std::holds_alternative<mesh::Mesh<2>>(*whole);
      });
  if (is_alone)
    return std::visit([&](auto& mesh) { return run_alone(config, std::move(mesh), progress, hooks); },
                      *whole);
  const auto run_in = is_plane ? run_shared_out<2> : run_shared_out<3>;
  return run_in(ranks, config, std::exchange(whole, {}), checkpoint, progress, hooks);
}

/// One thread for each of several processes, unless the environment sets the number.
void limit_threads()
{
  if (std::getenv("OMP_NUM_THREADS")) return;  // also applies to OpenBLAS
  set_max_threads(1);
  if (!std::getenv("OPENBLAS_NUM_THREADS")) algebra::set_blas_threads(1);
}

}  // namespace

int n_processes()
{
  return launcher_says({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}, 1);
}

bool is_first_process()
{
  return launcher_says({"OMPI_COMM_WORLD_RANK", "PMI_RANK"}, 0) == 0;
}

std::pair<ExitCode, std::string> describe(const std::exception_ptr& failure)
{
  try
  {
    std::rethrow_exception(failure);
  }
  catch (const InputError& error)
  {
    return {ExitCode::bad_input, error.what()};
  }
  catch (const std::bad_alloc&)
  {
    return {ExitCode::failed, "out of memory: take a coarser mesh or a lower degree"};
  }
  catch (const std::exception& error)
  {
    return {ExitCode::failed, error.what()};
  }
}

int report(ExitCode code, const std::string& message)
{
  fmt::print(stderr, "tribound: {}\n", message);
  return static_cast<int>(code);
}

ExitCode run(const CaseRequest& request, const std::string& restart, const RunHooks& hooks)
{
  if (request.case_file.empty() == restart.empty())
    throw InputError({}, "tribound run takes either a case file or --restart with a directory",
                     "tribound run case.toml, or tribound run --restart out/case");
  if (n_processes() == 1 && restart.empty()) return run_on(Ranks(), request, restart, hooks);
  const algebra::Environment environment;
  if (n_processes() == 1) return run_on(Ranks(), request, restart, hooks);
  limit_threads();
  const Ranks ranks = Ranks::world();
  try
  {
    if (ranks.size() != n_processes())
      throw InputError(
          {}, fmt::format("started as {} processes, of which MPI connects {}", n_processes(), ranks.size()),
          "start it by the mpirun of the MPI library it is built with (tribound info), or as one process");
    return run_on(ranks, request, restart, hooks);
  }
  catch (...)
  {
    const auto [code, message] = describe(std::current_exception());
    if (!ranks.all_arrive(failure_patience))
    {
      report(code, fmt::format("process {}: {}", ranks.rank(), message));
      Ranks::end_all(static_cast<int>(code));
    }
    if (host().is_present) throw;
    if (ranks.is_first()) report(code, message);
    return code;
  }
}

void info(bool prints)
{
  const algebra::Environment environment;
  if (prints) print(info_text(io::build_facts(), find_shared_file("report.html").string()));
}

}  // namespace tribound::app
