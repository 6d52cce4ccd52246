#include "app/command/run_on_ranks.h"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <memory>
#include <new>
#include <optional>
#include <type_traits>
#include <variant>

#include "app/command/interrupt.h"
#include "app/console/console.h"
#include "tribound/algebra/petsc.h"
#include "tribound/base/error.h"
#include "tribound/base/ranks.h"
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

ExitCode run_on(const Ranks& ranks, const std::string& case_file, std::span<const std::string> overrides,
                bool quiet)
{
  const Progress progress(quiet || !ranks.is_first());
  const case_file::Config config =
      ranks.together([&] { return case_file::read_config(case_file, overrides); });
  std::optional<mesh::AnyMesh> whole;
  const bool is_plane = ranks.on_first(
      [&]
      {
        whole.emplace(mesh::read_mesh(config.mesh, &stop_on_signals()));
        return std::holds_alternative<mesh::Mesh<2>>(*whole);
      });
  const auto run_part = [&]<int dim>(std::integral_constant<int, dim>)
  {
    using Whole = mesh::Mesh<dim>;
    auto first = whole ? std::make_shared<const Whole>(std::get<Whole>(*std::exchange(whole, {}))) : nullptr;
    return run(config, mesh::share_out<dim>(ranks, std::move(first)), progress);
  };
  return is_plane ? run_part(std::integral_constant<int, 2>()) : run_part(std::integral_constant<int, 3>());
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

ExitCode run_on_all_ranks(const std::string& case_file, std::span<const std::string> overrides, bool quiet)
{
  constexpr double patience = 20;  // seconds, for those that still write files
  const algebra::Environment environment;
  const Ranks ranks = Ranks::world();
  try
  {
    if (ranks.size() != n_processes())
      throw InputError(
          {}, fmt::format("started as {} processes, of which MPI connects {}", n_processes(), ranks.size()),
          "start it by the mpirun of the MPI library it is built with (tribound info), or as one "
          "process");
    return run_on(ranks, case_file, overrides, quiet);
  }
  catch (...)
  {
    const auto [code, message] = describe(std::current_exception());
    if (!ranks.all_arrive(patience))
    {
      report(code, fmt::format("process {}: {}", ranks.rank(), message));
      Ranks::end_all(static_cast<int>(code));
    }
    if (ranks.is_first()) report(code, message);
    return code;
  }
}

}  // namespace tribound::app
