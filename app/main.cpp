/// @file main.cpp
/// The program: parses the command line, executes the command, translates errors to exit codes.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/command/commands.h"
#include "app/command/run.h"
#include "app/console/text.h"
#include "app/result/case_schema.h"
#include "app/shared_file.h"
#include "tribound/base/error.h"
#include "tribound/base/memory.h"
#include "tribound/base/version.h"

namespace
{

using namespace tribound;
using namespace tribound::app;

struct Arguments : SweepRequest
{
  JudgeRequest judge;
  int refinements = 2;                ///< of verify
  bool json = false;                  ///< of check
  std::string start = "block";        ///< of init: the case to start from
  std::string directory;              ///< of init
  std::string deck;                   ///< of import
  std::vector<std::string> accepted;  ///< of import
  std::string restart;                ///< of run: an output directory, or a checkpoint there
  MeshRequest mesh;
  ReportRequest report;
};

void add_set_option(CLI::App& command, Arguments& arguments)
{
  command
      .add_option("--set", arguments.overrides, "Override a key of the case, as key=value; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

CLI::Option* add_case_arguments(CLI::App& command, Arguments& arguments)
{
  CLI::Option* file = command.add_option("case", arguments.case_file, "The case file (TOML)");
  add_set_option(command, arguments);
  command.add_flag("-q,--quiet", arguments.quiet, "No progress; of a run only warnings and status");
  return file;
}

constexpr const char* case_commands = "Working on a case";
constexpr const char* program_commands = "Starting out";

constexpr const char* help_footer = R"(Examples:
  tribound init block                         write block.toml, a commented case to start from
  tribound mesh part.step part.msh --size 2   mesh a CAD geometry, or convert a mesh
  tribound check block.toml                   examine it: supports, units, mesh, expected cost
  tribound run block.toml                     solve it, write out/block
  tribound run block.toml --set degree=3 --set boundary.bottom.contact.coefficient=0.5
  tribound sweep block.toml 'degree=[1,2]' boundary.bottom.contact.coefficient=0.1:0.8:8 --jobs 2
  tribound judge block.toml --solution theirs.vtu --accept 0.05
  tribound report out/block --pdf             print the result: out/block/report.pdf
  tribound COMMAND --help                     the options of a command

Exit codes:
  0  certified: the bound is below the tolerance and all identities hold; for other commands: done
  1  bad input; the message names the file, the key, what is wrong and what would be right
  2  failed: no convergence, a singular matrix, an identity violated, a full disk
  3  budget used up or interrupted: the certificate is valid, the tolerance is not reached
  4  judge: the error of the solution is larger than --accept

The manual: man tribound. The guide, with case-format.md, output.md and troubleshooting.md:
  )";

void describe_sweep(CLI::App& sweep, Arguments& arguments)
{
  sweep.add_option("case", arguments.case_file, "The case file (TOML)")->required();
  sweep
      .add_option(
          "values", arguments.values,
          "Keys with values: key=0.1:0.8:8 (first, last, how many), key=[1, 2], key=value; all combinations, "
          "the first key varying slowest")
      ->type_name("KEY=VALUES");
  sweep
      .add_option("--table", arguments.table,
                  "A file of comma-separated values instead: a line of keys, a line per run")
      ->type_name("FILE");
  sweep.add_option("--jobs", arguments.jobs, "Runs at a time")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  sweep.add_flag("--resume", arguments.resume, "Keep the runs that an earlier sweep has completed");
  add_set_option(sweep, arguments);
}

void describe_judge(CLI::App& command, Arguments& arguments)
{
  JudgeRequest& request = arguments.judge;
  command.group(case_commands);
  add_case_arguments(command, arguments)->required();
  command
      .add_option(
          "--solution", request.solutions,
          "A file with their displacement at the nodes of the mesh of the case; with --steps it may be "
          "repeated")
      ->required()
      ->allow_extra_args(false)
      ->type_name("FILE");
  command.add_flag("--interpolate", request.interpolate,
                   "Judge the interpolant of a solution on another mesh");
  command.add_option("--field", request.field, "The name of their displacement in the file")
      ->type_name("NAME");
  command.add_option("--stress", request.stress, "The name of their stress in the file")->type_name("NAME");
  command.add_flag(
      "--steps", request.steps,
      "Judge every load step of the case by the step of the file, or the file, that belongs to it");
  command.add_option("--step", request.step, "The step of the file; default: the last")->type_name("N");
  command.add_option("--load-step", request.load_step, "The load step of the case; default: the last")
      ->type_name("N");
  command
      .add_option("--number", request.numbers,
                  "What they have computed for a quantity of the case; with --steps a value for each; may be "
                  "repeated")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  command
      .add_option("--accept", request.accept, "The largest relative error that is acceptable, such as 0.05")
      ->check(CLI::PositiveNumber);
}

void describe_mesh(CLI::App& command, MeshRequest& request)
{
  mesh::ImportOptions& options = request.input.options;
  command.add_option("input", request.input.path, "A mesh, a deck or a CAD geometry")->required();
  command.add_option("output", request.output, "The mesh to write (.msh)")->required();
  command.add_option("--size", options.size, "Largest edge, where a geometry is meshed")
      ->check(CLI::PositiveNumber);
  command.add_option("--merge", options.merge, "Make one node of those of a body within this distance")
      ->check(CLI::PositiveNumber);
  command.add_flag("--ignore-elements", options.ignore_elements,
                   "Leave out elements of a deck without a counterpart: shells, beams, springs, ...");
  command.add_option("--region-array", options.region_array, "The array of cells that has the regions")
      ->type_name("NAME");
  command.add_option("--boundaries", options.boundaries, "The sets that become boundaries; default: all")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("A,B");
  command.add_flag("-q,--quiet", request.quiet, "Print neither what is in the mesh nor notes");
}

void describe_report(CLI::App& command, ReportRequest& request)
{
  command.group(case_commands);
  command.add_option("directory", request.directory, "A directory of results")->required();
  command.add_flag("--pdf", request.pdf, "Print the page to report.pdf beside it, by Chromium");
}

/// Commands and options as shown by --help.
void describe_command_line(CLI::App& app, Arguments& arguments)
{
  app.set_version_flag("--version", std::string("tribound ") + version());
  app.require_subcommand(1);
  app.footer(help_footer + guide_directory().string());
  CLI::App* init = app.add_subcommand("init", "Write a commented case to start from");
  CLI::App* info = app.add_subcommand("info", "Versions of the program and its libraries");
  CLI::App* schema = app.add_subcommand("schema", "Print the case format as a JSON Schema, for editors");
  CLI::App* mesh = app.add_subcommand("mesh", "Convert a mesh, or mesh a CAD geometry, and check it");
  for (CLI::App* command : {init, mesh, info, schema}) command->group(program_commands);
  describe_mesh(*mesh, arguments.mesh);
  CLI::App* check = app.add_subcommand("check", "Check a case without solving it and report what to correct");
  CLI::App* run = app.add_subcommand("run", "Solve a case and write its results");
  CLI::App* verify = app.add_subcommand(
      "verify", "Compare the bound of a case with the error it bounds (slow: for small cases)");
  CLI::App* study = app.add_subcommand(
      "study", "Measure what adaptation and the stopping of Newton's method bring, with figures (slow)");
  for (CLI::App* command : {check, run, verify, study})
  {
    command->group(case_commands);
    add_case_arguments(*command, arguments)->required(command != run);
  }
  run->add_option(
         "--restart", arguments.restart,
         "Go on with a run from the checkpoint in its directory of results, or another one there, in place "
         "of a case")
      ->type_name("PLACE");
  CLI::App* sweep = app.add_subcommand("sweep", "Solve a case with other values of some of its keys");
  sweep->group(case_commands);
  describe_sweep(*sweep, arguments);
  describe_judge(*app.add_subcommand("judge", "Bound the error of another program's solution of the case"),
                 arguments);
  describe_report(*app.add_subcommand("report", "Print the report of a result, for paper"), arguments.report);
  init->add_option("name", arguments.start,
                   fmt::format("The case to start from: {}", fmt::join(template_names(), ", ")))
      ->capture_default_str();
  CLI::App* import = app.add_subcommand("import", "Make a case of a deck for CalculiX or Abaqus");
  import->group(program_commands);
  import->add_option("deck", arguments.deck, "The deck (.inp)")->required();
  import
      ->add_option("--accept", arguments.accepted,
                   "A keyword that may be dropped although the answer depends on it; may be repeated")
      ->type_name("KEYWORD")
      ->allow_extra_args(false);
  import->add_flag("-q,--quiet", arguments.quiet, "Print nothing, and do not check the case");
  for (CLI::App* command : {init, import})
    command->add_option("--directory", arguments.directory, "Where to write; default: here");
  check->add_flag("--json", arguments.json, "Print what was found as JSON");
  verify
      ->add_option("--refinements", arguments.refinements,
                   "Uniform refinements of the mesh on which the error is looked for")
      ->check(CLI::Range(1, 5))
      ->capture_default_str();
}

/// With less address space, OpenBLAS requests its memory forever.
void require_address_space()
{
  constexpr double least = 1e9;
  const double limit = address_space_limit();
  if (limit >= least) return;
  throw InputError({}, fmt::format("the address space is limited to {:.3g} GB (ulimit -v)", 1e-9 * limit),
                   "the libraries alone need 1 GB: ulimit -v unlimited, or more memory for the job");
}

/// Executes the command line.
ExitCode dispatch(const CLI::App& app, const Arguments& arguments)
{
  require_address_space();
  const std::string command = app.get_subcommands().front()->get_name();
  if (command == "run") return run(arguments, arguments.restart, {});
  if (command == "judge")
  {
    JudgeRequest request = arguments.judge;
    static_cast<CaseRequest&>(request) = arguments;
    return judge(request);
  }
  if (n_processes() > 1)
  {
    const bool needs_one = command == "verify" || command == "study" || command == "sweep";
    if (!is_first_process() && command == "info") info(false);
    if (!is_first_process()) return needs_one ? ExitCode::bad_input : ExitCode::success;
    if (needs_one)
      throw InputError(
          {}, fmt::format("tribound {} runs as one process, but was started as {}", command, n_processes()),
          "start it without mpirun, or with -n 1; tribound run takes any number of processes");
  }
  if (command == "verify") return verify(arguments, arguments.refinements);
  if (command == "study") return study(arguments);
  if (command == "sweep") return sweep(arguments);
  if (command == "check") check(arguments, arguments.json);
  if (command == "mesh") write_mesh(arguments.mesh);
  if (command == "report") print_report(arguments.report);
  if (command == "import")
    import_deck({arguments.deck, arguments.directory, arguments.accepted, arguments.quiet});
  if (command == "init") init(arguments.start, arguments.directory);
  if (command == "info") info(true);
  if (command == "schema") print(case_schema());
  return ExitCode::success;
}

/// The error in the command line. CLI11 reports a missing command even where one is misspelt.
InputError usage_error(const CLI::App& app, const CLI::ParseError& error, std::span<char*> words)
{
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
  const std::string hint = fmt::format(
      "the commands are {}, as in tribound run case.toml; more: tribound --help", fmt::join(commands, ", "));
  if (!app.get_subcommands().empty())
    return {{}, error.what(), hint + "; a key of the case is set by --set, as in --set degree=3"};
  if (words.size() < 2) return {{}, "a command is missing", hint};
  const std::string near = closest(words[1], commands);
  return {{},
          fmt::format("unknown command \"{}\"", words[1]),
          near.empty() ? hint : fmt::format("did you mean \"{}\"? {}", near, hint)};
}

}  // namespace

int main(int argc, char** argv)
{
  prepare_signals();
  CLI::App app("Solves unilateral contact with friction by the Nitsche finite element method.", "tribound");
  Arguments arguments;
  describe_command_line(app, arguments);
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
    return static_cast<int>(dispatch(app, arguments));
  }
  catch (...)
  {
    const auto [code, message] = describe(std::current_exception());
    // Run on several processes, what reaches this is wrong on all of them.
    return is_first_process() ? report(code, message) : static_cast<int>(code);
  }
}
