/// @file main.cpp
/// The program: parse the command line, dispatch on the dimension of the mesh, translate errors to exit
/// codes.

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <exception>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/version.h"
#include "io/console.h"
#include "mesh/gmsh.h"
#include "run.h"
#include "solve/petsc.h"
#include "verify.h"

namespace
{

using namespace tribound;

struct Arguments
{
  std::string case_file;
  std::vector<std::string> overrides;
  bool quiet = false;
  int refinements = 2;  ///< of verify
};

void add_case_arguments(CLI::App& command, Arguments& arguments)
{
  command.add_option("case", arguments.case_file, "The case file (TOML)")->required();
  command
      .add_option("--set", arguments.overrides, "Override a key of the case, as key=value; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command.add_flag("-q,--quiet", arguments.quiet, "No progress on the terminal");
}

ExitCode run_command(const Arguments& arguments)
{
  const Progress progress(arguments.quiet);
  const Config config = read_config(arguments.case_file, arguments.overrides);
  AnyMesh mesh = read_mesh(config.mesh);
  const Environment environment;  // behind the input: bad input then fails at once
  return std::visit([&](auto& m) { return run(config, std::move(m), progress); }, mesh);
}

void check_command(const Arguments& arguments)
{
  const Config config = read_config(arguments.case_file, arguments.overrides);
  const AnyMesh mesh = read_mesh(config.mesh);
  const Environment environment;
  std::visit([&](const auto& m) { check(config, m); }, mesh);
}

ExitCode verify_command(const Arguments& arguments)
{
  const Progress progress(arguments.quiet);
  const Config config = read_config(arguments.case_file, arguments.overrides);
  const AnyMesh mesh = read_mesh(config.mesh);
  const Environment environment;
  return std::visit([&](const auto& m) { return verify(config, m, arguments.refinements, progress); }, mesh);
}

void info_command()
{
  const Environment environment;
  print_info(library_facts());
}

/// What is wrong with the command line. CLI11 says that a command is missing even where one is misspelt.
InputError usage_error(const CLI::App& app, const CLI::ParseError& error, std::span<char*> words)
{
  const std::vector<std::string> commands = {"run", "check", "verify", "info"};
  const std::string hint =
      "tribound run case.toml, tribound check case.toml, tribound verify case.toml or tribound info; "
      "more: tribound --help";
  if (!app.get_subcommands().empty()) return {{}, error.what(), hint};
  if (words.size() < 2) return {{}, "a command is missing", hint};
  const std::string near = closest(words[1], commands);
  return {{},
          fmt::format("unknown command \"{}\"", words[1]),
          near.empty() ? hint : fmt::format("did you mean \"{}\"? {}", near, hint)};
}

int report(ExitCode code, const std::string& message)
{
  fmt::print(stderr, "tribound: {}\n", message);
  return static_cast<int>(code);
}

}  // namespace

int main(int argc, char** argv)
{
  CLI::App app("Solves unilateral contact with friction by the Nitsche finite element method.", "tribound");
  app.set_version_flag("--version", std::string("tribound ") + version());
  app.require_subcommand(1);
  Arguments arguments;
  CLI::App* run = app.add_subcommand("run", "Solve a case and write its results");
  CLI::App* check = app.add_subcommand("check", "Read and verify a case without solving it");
  CLI::App* verify = app.add_subcommand(
      "verify", "Compare the bound of a case with the error it bounds (slow: for small cases)");
  CLI::App* info = app.add_subcommand("info", "Versions of the program and its libraries");
  add_case_arguments(*run, arguments);
  add_case_arguments(*check, arguments);
  add_case_arguments(*verify, arguments);
  verify
      ->add_option("--refinements", arguments.refinements,
                   "Uniform refinements of the mesh on which the error is looked for")
      ->check(CLI::Range(1, 5))
      ->capture_default_str();
  try
  {
    app.parse(argc, argv);
  }
  catch (const CLI::ParseError& error)
  {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return report(ExitCode::bad_input, usage_error(app, error, std::span(argv, argc)).what());
  }

  try
  {
    if (*run) return static_cast<int>(run_command(arguments));
    if (*check) check_command(arguments);
    if (*verify) return static_cast<int>(verify_command(arguments));
    if (*info) info_command();
    return 0;
  }
  catch (const InputError& error)
  {
    return report(ExitCode::bad_input, error.what());
  }
  catch (const SolveError& error)
  {
    return report(ExitCode::failed, error.what());
  }
  catch (const std::bad_alloc&)
  {
    return report(ExitCode::failed, "out of memory: take a coarser mesh or a lower degree");
  }
  catch (const std::exception& error)
  {
    return report(ExitCode::failed, error.what());
  }
}
