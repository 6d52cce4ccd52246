#include "app/command/run_on_ranks.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <variant>

#include "app/command/interrupt.h"
#include "app/command/path_report.h"
#include "app/console/console.h"
#include "tribound/algebra/blas.h"
#include "tribound/algebra/petsc.h"
#include "tribound/base/error.h"
#include "tribound/base/parallel.h"
#include "tribound/base/rank_failure.h"
#include "tribound/base/ranks.h"
#include "tribound/io/state/checkpoint.h"
#include "tribound/mesh/box.h"
#include "tribound/mesh/gmsh.h"
#include "tribound/mesh/share_out.h"

namespace tribound::app
{

namespace
{

/// A variable that mpirun or a batch system sets for the processes they start together: of Open MPI, or of
/// MPICH and its relatives; `otherwise` where there is none.
int launcher_says(std::array<const char*, 2> variables, int otherwise)
{
  for (const char* variable : variables)
    if (const char* value = std::getenv(variable)) return std::atoi(value);
  return otherwise;
}

/// Boxes of which every rank makes its own cells, or none.
struct BoxSource
{
  explicit BoxSource(const mesh::MeshSource& source)
      : box(std::get_if<mesh::BoxMesh>(&source)), boxes(std::get_if<mesh::Boxes>(&source))
  {
  }

  [[nodiscard]] bool is_there() const { return box != nullptr || boxes != nullptr; }
  [[nodiscard]] std::int64_t n_cells() const
  {
    return box ? mesh::n_box_cells(*box) : mesh::n_box_cells(*boxes);
  }
  /// The same with few cells, that one rank makes to look at.
  [[nodiscard]] mesh::MeshSource coarser() const
  {
    constexpr std::int64_t most = 100'000;
    if (box) return mesh::coarser_box(*box, most);
    return mesh::coarser_box(*boxes, most);
  }
  template <int dim>
  [[nodiscard]] mesh::Mesh<dim> share_out(const Ranks& ranks) const
  {
    return box ? mesh::share_out<dim>(ranks, *box) : mesh::share_out<dim>(ranks, *boxes);
  }

  const mesh::BoxMesh* box;
  const mesh::Boxes* boxes;
};

/// The mesh of a run that begins, and that of one that goes on.
template <int dim>
ExitCode run_part(const Ranks& ranks, const case_file::Config& config, std::optional<mesh::AnyMesh> whole,
                  const std::optional<io::CheckpointFacts>& checkpoint, const std::filesystem::path& file,
                  const Progress& progress)
{
  using Whole = mesh::Mesh<dim>;
  const BoxSource by_formula(config.mesh);
  std::shared_ptr<const Whole> first;
  ranks.on_first([&] { first = std::make_shared<const Whole>(std::get<Whole>(*std::exchange(whole, {}))); });
  if (!checkpoint)
  {
    Whole part =
        by_formula.is_there() ? by_formula.share_out<dim>(ranks) : mesh::share_out<dim>(ranks, first.get());
    return run(config, std::move(part), progress, std::move(first));
  }
  ranks.on_first(
      [&]
      {
        const std::int64_t n_cells = by_formula.is_there() ? by_formula.n_cells() : first->n_cells();
        if (n_cells != checkpoint->earlier.first_cells)
          throw InputError(first->source(),
                           fmt::format("has {} cells, but the run to restart began with {}", n_cells,
                                       checkpoint->earlier.first_cells),
                           "restart with the mesh that the run began with");
      });
  io::CheckpointCells<dim> read = io::read_checkpoint_cells<dim>(file, *checkpoint, ranks);
  mesh::Balanced<dim> balanced = mesh::restore<dim>(ranks, first.get(), std::move(read.cells), read.values,
                                                    io::n_values_of_cell(*checkpoint));
  return run(config, std::move(balanced.mesh), progress, std::move(first),
             Restart{*checkpoint, std::move(balanced.cells), std::move(balanced.values),
                     std::move(read.points), file});
}

/// What is to be gone on with: a directory of results with its checkpoint, or one of several there.
std::filesystem::path checkpoint_file(const std::filesystem::path& restart)
{
  const bool is_file = restart.extension() == ".h5" && !std::filesystem::is_directory(restart);
  return is_file ? restart : restart / io::checkpoint_name;
}

/// The case of a checkpoint, whose results go on in the directory.
case_file::Config restarted_config(const RunRequest& request, const std::filesystem::path& file,
                                   const io::CheckpointFacts& checkpoint)
{
  std::filesystem::path directory = file.has_parent_path() ? file.parent_path() : ".";
  if (directory.filename() == unfinished_pass) directory /= "..";
  // Before the others: paths of the effective case lead from there.
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
                     checkpoint.path.empty()
                         ? "goes over load steps, but the run of the checkpoint did not"
                         : "has no load steps, but the run of the checkpoint goes over some",
                     "a run goes on with [history], or without");
  return config;
}

ExitCode run_on(const Ranks& ranks, const RunRequest& request)
{
  const Progress progress(request.quiet || !ranks.is_first());
  std::optional<io::CheckpointFacts> checkpoint;
  const std::filesystem::path file = checkpoint_file(request.restart);
  if (!request.restart.empty()) checkpoint = io::read_checkpoint_facts(file, ranks);
  const case_file::Config config = ranks.together(
      [&]
      {
        return checkpoint ? restarted_config(request, file, *checkpoint)
                          : case_file::read_config(request.case_file, request.overrides);
      });
  std::optional<mesh::AnyMesh> whole;
  const bool is_plane = ranks.on_first(
      [&]
      {
        const BoxSource by_formula(config.mesh);
        if (by_formula.box) mesh::require_valid(*by_formula.box);
        if (by_formula.boxes)
          for (const mesh::NamedBox& named : *by_formula.boxes) mesh::require_valid(named.box);
        whole.emplace(mesh::read_mesh(by_formula.is_there() ? by_formula.coarser() : config.mesh,
                                      case_file::find_seams(config), &stop_on_signals()));
        return std::holds_alternative<mesh::Mesh<2>>(*whole);
      });
  const auto run_in = is_plane ? run_part<2> : run_part<3>;
  return run_in(ranks, config, std::exchange(whole, {}), checkpoint, file, progress);
}

/// One for each of several processes, where the environment does not say how many.
void limit_threads()
{
  if (std::getenv("OMP_NUM_THREADS")) return;  // for OpenBLAS, too
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

ExitCode run_on_ranks(const RunRequest& request)
{
  const algebra::Environment environment;
  if (n_processes() == 1) return run_on(Ranks(), request);
  limit_threads();
  const Ranks ranks = Ranks::world();
  try
  {
    if (ranks.size() != n_processes())
      throw InputError(
          {}, fmt::format("started as {} processes, of which MPI connects {}", n_processes(), ranks.size()),
          "start it by the mpirun of the MPI library it is built with (tribound info), or as one process");
    return run_on(ranks, request);
  }
  catch (...)
  {
    const auto [code, message] = describe(std::current_exception());
    if (!ranks.all_arrive(failure_patience))
    {
      report(code, fmt::format("process {}: {}", ranks.rank(), message));
      Ranks::end_all(static_cast<int>(code));
    }
    if (ranks.is_first()) report(code, message);
    return code;
  }
}

}  // namespace tribound::app
