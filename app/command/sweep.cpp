#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <thread>
#include <vector>

#include "app/child_process.h"
#include "app/command/commands.h"
#include "app/console/text.h"
#include "app/page/report_page.h"
#include "app/result/sweep.h"
#include "app/shared_file.h"
#include "tribound/base/sha256.h"
#include "tribound/case/config.h"
#include "tribound/case/node.h"
#include "tribound/case/parameters.h"
#include "tribound/case/sweep_values.h"
#include "tribound/io/file/atomic_file.h"
#include "tribound/io/file/output_directory.h"
#include "tribound/io/record/facts.h"

namespace tribound::app
{

namespace
{

/// Sets an environment variable unless the user has set it.
void limit_threads(int n_threads)
{
  for (const char* name : {"OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"})
    ::setenv(name, fmt::format("{}", n_threads).c_str(), 0);
}

/// Starts this program, in its own process group: Ctrl-C reaches only the sweep, which ends its runs cleanly.
pid_t start(std::vector<std::string> arguments, const std::filesystem::path& log)
{
  const Child child = start_program("/proc/self/exe", std::move(arguments), {.log = log, .own_group = true});
  if (!child.problem.empty())
    throw InputError({.file = log.string()}, "the run " + child.problem, "fewer --jobs");
  return child.process;
}

case_file::SweepTable table_of(const SweepRequest& request)
{
  const std::string& file = request.table;
  if (request.values.empty() == file.empty())
    throw InputError({}, "tribound sweep takes either keys with values or a table",
                     "tribound sweep case.toml 'degree=[1, 2]', or --table runs.csv");
  if (file.empty()) return case_file::sweep_grid(request.values);
  if (std::filesystem::is_directory(file) || ::access(file.c_str(), R_OK) != 0)
    throw InputError({.file = file}, "cannot be read", "the path of a file");
  return case_file::sweep_rows(io::read_text(file), file);
}

/// The keys, parameters with their label and unit: "water level [m]".
std::vector<std::string> titles_of(const std::vector<std::string>& keys, const case_file::Config& config)
{
  std::vector<std::string> titles = keys;
  for (const auto& [name, value, label, unit] :
       case_file::read_parameters(case_file::parse_toml(config.effective.text, config.file)))
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (keys[i] == name)
        titles[i] = (label.empty() ? name : label) + (unit.empty() ? "" : " [" + unit + "]");
  return titles;
}

/// Hashes the files of the runs, the same files once.
class FileHashes
{
 public:
  /// That of the only file of a case, or of the hashes of all; empty without files, or where they cannot be
  /// read, which the run itself will report.
  std::string operator()(const case_file::Config& config)
  {
    std::string hashes;
    std::size_t n_files = 0;
    for (const std::filesystem::path& named : case_file::files_of(config))
    {
      const auto [entry, is_new] = known_.try_emplace(named);
      if (is_new) entry->second = io::hashed_files({&named, 1});
      for (const io::HashedFile& file : entry->second) hashes += file.sha256;
      n_files += entry->second.size();
    }
    return n_files > 1 ? sha256(hashes) : hashes;
  }

 private:
  std::map<std::filesystem::path, std::vector<io::HashedFile>> known_;  ///< by names in cases
};

class Sweep
{
 public:
  explicit Sweep(const SweepRequest& request) : request_(request)
  {
    const std::string& file = request.case_file;
    const case_file::SweepTable table = table_of(request);
    const case_file::Config config = case_file::read_config(file, request.overrides);
    directory_ = config.output.directory / "sweep";
    if (config.output.report) page_ = PageTemplate(find_shared_file("report.html"));
    record_ = {config.title, file, table.keys, {}, titles_of(table.keys, config), config.purpose};
    FileHashes file_hash;
    for (const auto& values : table.rows)
    {
      SweepRun& run = record_.runs.emplace_back();
      run.name = fmt::format("{:04}", record_.runs.size());
      run.values = values;
      run.status = "not run";
      const case_file::Config its_config = case_file::read_config(file, overrides(run));
      run.sha256 = sha256(its_config.effective.text);
      run.files_sha256 = file_hash(its_config);
    }
  }

  /// Ends the runs that would be orphaned by an exception.
  ~Sweep()
  {
    end_all();
    for (const auto& [child, run] : running_) ::waitpid(child, nullptr, 0);
  }
  Sweep(const Sweep&) = delete;
  Sweep& operator=(const Sweep&) = delete;

  ExitCode run()
  {
    using namespace std::chrono_literals;
    const io::OutputDirectory owned(directory_);
    io::remove_results(directory_, {"report.pdf"});
    if (request_.resume)
      for (const auto& [name, code] : complete_runs(directory_, record_))
      {
        SweepRun& run = *std::ranges::find(record_.runs, name, &SweepRun::name);
        run.exit_code = code;
        read_results(directory_ / name, run);
        print(sweep_line(record_, run) + line("", "kept from an earlier sweep"));
      }
    limit_threads(std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / request_.jobs));
    const std::atomic<bool>& stop = stop_on_signals();
    write();
    while (next_ < record_.runs.size() || !running_.empty())
    {
      if (stop && !interrupted_)
      {
        interrupted_ = true;
        next_ = record_.runs.size();
        end_all();
      }
      if (next_ < record_.runs.size() && static_cast<int>(running_.size()) < request_.jobs)
      {
        start_next();
        continue;
      }
      int status = 0;
      const pid_t child = ::waitpid(-1, &status, WNOHANG);
      if (child > 0 && running_.contains(child))
        finish(child, status);
      else
        std::this_thread::sleep_for(10ms);
    }
    write();
    print(line("results", (directory_ / "sweep.csv").string()));
    return exit_code();
  }

 private:
  /// The --set of a run.
  std::vector<std::string> overrides(const SweepRun& run) const
  {
    std::vector<std::string> result = request_.overrides;
    for (std::size_t i = 0; i < record_.keys.size(); ++i)
      result.push_back(record_.keys[i] + "=" + run.values[i]);
    result.push_back("output.directory=" + case_file::to_inline_toml({(directory_ / run.name).string(), {}}));
    return result;
  }

  void start_next()
  {
    SweepRun& run = record_.runs[next_++];
    if (run.exit_code) return;  // done in an earlier sweep
    const std::filesystem::path directory = directory_ / run.name;
    std::filesystem::create_directories(directory);
    io::remove_results(directory,
                       {"certificate.json", "contact.csv"});  // a run that ends early would keep them
    std::vector<std::string> arguments = {"tribound", "run", request_.case_file, "--quiet"};
    for (const std::string& assignment : overrides(run))
    {
      arguments.emplace_back("--set");
      arguments.push_back(assignment);
    }
    running_[start(std::move(arguments), directory / "log.txt")] = &run;
  }

  /// Records a run that has ended.
  void finish(pid_t child, int status)
  {
    SweepRun& run = *running_.at(child);
    running_.erase(child);
    run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    read_results(directory_ / run.name, run);
    if (interrupted_ && run.exit_code != 1 && run.figures.empty())  // ended before its first level
    {
      run.exit_code.reset();
      run.status = "not run";
      run.reason.clear();
    }
    write();
    print(sweep_line(record_, run));
  }

  void write() const { write_sweep_results(page_, directory_, record_); }

  void end_all() const
  {
    for (const auto& [child, run] : running_) ::kill(child, SIGTERM);
  }

  ExitCode exit_code() const
  {
    const auto some = [&](const auto& property) { return std::ranges::any_of(record_.runs, property); };
    if (some([](const SweepRun& run) { return run.exit_code == 1; })) return ExitCode::bad_input;
    if (some([](const SweepRun& run) { return run.exit_code == 2 || run.exit_code > 3; }))
      return ExitCode::failed;
    if (some([](const SweepRun& run) { return run.exit_code != 0; })) return ExitCode::budget_used_up;
    return ExitCode::success;
  }

  const SweepRequest& request_;
  std::filesystem::path directory_;
  PageTemplate page_;
  SweepRecord record_;
  std::map<pid_t, SweepRun*> running_;
  std::size_t next_ = 0;
  bool interrupted_ = false;
};

}  // namespace

ExitCode sweep(const SweepRequest& request)
{
  return Sweep(request).run();
}

}  // namespace tribound::app
