#pragma once

/// @file commands.h
/// The commands of the program, and how they end.

#include <atomic>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tribound/mesh/source.h"

namespace tribound::case_file
{
struct Node;
}

namespace tribound::app
{

struct RunHooks;

/// Exit codes, a contract with scripts.
enum class ExitCode
{
  success = 0,         ///< certified: the identities hold, the tolerance is reached
  bad_input = 1,       ///< InputError
  failed = 2,          ///< no convergence, singular matrix, identity violated, a result not written
  budget_used_up = 3,  ///< the certificate is valid, the tolerance is not reached
  rejected = 4         ///< of judge: the error of their solution is above the threshold
};

/// The exit code of a failure, and its message.
[[nodiscard]] std::pair<ExitCode, std::string> describe(const std::exception_ptr& failure);
/// Prints the message to stderr.
int report(ExitCode code, const std::string& message);

/// The number of processes started together by mpirun or a batch system, as given by the environment, by
/// default 1, and whether this is the first of them.
[[nodiscard]] int n_processes();
[[nodiscard]] bool is_first_process();

/// To be called before anything else. Writing to a closed pipe does not end the program, children can be
/// waited for whatever the parent ignores, and a crash, even in a library, ends the program with a message
/// and exit code 2.
void prepare_signals();

/// From now on SIGINT and SIGTERM set the returned flag: the run then ends with the certificate of its last
/// complete level. A second signal ends the program at once.
[[nodiscard]] const std::atomic<bool>& stop_on_signals();

/// From now on the flag is set, as by a signal; then again as it was at first.
void request_stop();
void forget_stop();

/// The case of a command. All commands throw InputError for bad input.
struct CaseRequest
{
  std::string case_file;               ///< of a document: the name that messages give
  std::vector<std::string> overrides;  ///< key=value
  bool quiet = false;
  const case_file::Node* document = nullptr;  ///< the case, in place of the file
};

/// `tribound run`: solves the case and writes its results, see app/command/run.h, on all processes that were
/// started together, possibly one. With `restart`, an output directory or a checkpoint in one, it continues
/// the case there instead. The first process reads the mesh, prints, and writes everything that is not
/// written by each. A failure on all processes is reported by the first; a failure on one process alone ends
/// all. On a single process it throws InputError, SolveError and WriteError.
[[nodiscard]] ExitCode run(const CaseRequest& request, const std::string& restart, const RunHooks& hooks);

/// `tribound check`: reads and verifies everything `run` would, and prints a summary with the findings of the
/// doctor, as text or as JSON.
void check(const CaseRequest& request, bool as_json);

/// `tribound verify`: solves the case on its mesh without adaptation. For every Newton iterate it computes
/// the bound, and the dual norm of the residual from below; for the last one also the errors against a
/// solution of higher degree on the mesh refined `refinements` times; over load steps the iterates of each.
/// The intervals of the quantities at every iterate are compared with those of that solution. Prints a table
/// and writes verify.json. Throws InputError also when the spaces would be too large. Throws SolveError also
/// when the bound is below the dual norm of any iterate, when intervals do not intersect or when Newton's
/// method does not converge; verify.json is written before.
[[nodiscard]] ExitCode verify(const CaseRequest& request, int refinements);

/// `tribound study`: solves the case adaptively and with uniform refinement, each with Newton's method
/// stopped by the bound and run to its tolerance; computes a reference solution of higher degree on a mesh
/// adapted to it; measures the errors of all levels against it, and the bounds against the dual norm of the
/// residual. Writes study.csv, study.json and a directory per variant into output.directory, see
/// docs/output.md, and draws the figures.
///
/// Returns success when the adaptive variants reach adapt.tolerance, else budget_used_up, also after an
/// interruption; failed when an effectivity is below 1 or a variant has no solution.
[[nodiscard]] ExitCode study(const CaseRequest& request);

/// The values a case is solved with: all combinations of `values`, keys with values, or the rows of the file
/// `table`.
struct SweepRequest : CaseRequest
{
  std::vector<std::string> values;
  std::string table;
  int jobs = 1;         ///< processes at a time
  bool resume = false;  ///< keep the completed runs of an earlier sweep
};

/// `tribound sweep`: solves all these cases, one process each, each into its own directory below `sweep` in
/// output.directory. Throws InputError for invalid values before anything is solved. Success: all certified;
/// budget_used_up: some not, or interrupted; failed: some failed; bad_input: some were rejected.
[[nodiscard]] ExitCode sweep(const SweepRequest& request);

/// What `judge` compares with the case.
struct JudgeRequest : CaseRequest
{
  std::vector<std::string> solutions{};  ///< files of another program; several: of a load step each
  std::string field{};                   ///< its displacement; empty: a usual name
  std::string stress{};                  ///< its stress; empty: a usual name, if there is one
  bool steps = false;                  ///< every load step of the case, each with the step that belongs to it
  std::optional<int> step{};           ///< of the file; absent: the last
  std::optional<int> load_step{};      ///< of the case; absent: the last
  bool interpolate = false;            ///< on another mesh than that of the case: the interpolant is judged
  std::vector<std::string> numbers{};  ///< NAME=VALUE of quantities that they have computed, a value a step
  std::optional<double> accept{};      ///< the largest relative error
};

/// `tribound judge`: bounds the error of the solution in a file, which is on the mesh of the case, from both
/// sides: solves the case on meshes that follow the error in the energy norm, until its own bound is small
/// beside the distance of theirs (judge.sharpness) or a limit of [adapt] is met. Prints the judgement and
/// writes it, with the run, to `judge` in output.directory. Success: judged, or the error is at most
/// `accept`; budget_used_up: the interval is wider than asked for, or not narrow enough to decide; rejected:
/// it is larger; of several load steps that of the worst. Throws InputError for a solution on another mesh.
[[nodiscard]] ExitCode judge(const JudgeRequest& request);

/// `tribound report`: prints report.html in a directory of results, and judgement.html where it is there.
/// With `pdf`, Chromium prints them to report.pdf and judgement.pdf beside them; else the text says how a
/// reader does. Throws InputError where there is no page with its result, or no Chromium, and WriteError
/// where nothing is printed.
struct ReportRequest
{
  std::string directory;
  bool pdf = false;
};

void print_report(const ReportRequest& request);

/// `tribound mesh`: the mesh of a file, with the options of [mesh], for Gmsh and for other cases.
struct MeshRequest
{
  mesh::MeshFile input{};
  std::string output{};  ///< a .msh
  bool quiet = false;
};

/// Reads and verifies the mesh, writes it with the elements it came with, and prints what is in it; notes go
/// to stderr. Throws InputError and WriteError.
void write_mesh(const MeshRequest& request);

struct ImportRequest
{
  std::string deck;
  std::string directory{};              ///< where to write; empty: here
  std::vector<std::string> accepted{};  ///< keywords that may be dropped although the answer depends on them
  bool quiet = false;
};

/// `tribound import`: writes the case and the mesh that a deck stands for, NAME.toml and NAME.msh for
/// NAME.inp, and checks them; prints what the case does otherwise. Throws InputError where one of the files
/// exists, and see case/deck/import_deck.h.
void import_deck(const ImportRequest& request);

/// The cases available to `init`, in the order of app/templates.
[[nodiscard]] std::vector<std::string> template_names();

/// `tribound init`: writes the commented case NAME.toml, with NAME.geo where it needs one, into the directory
/// and prints what to do next. Throws InputError for an unknown name, when one of the files exists (then none
/// is written), and when a file cannot be written.
void init(const std::string& name, const std::filesystem::path& directory);

/// `tribound info`: starts MPI, as on all processes, and prints versions.
void info(bool prints);

}  // namespace tribound::app
